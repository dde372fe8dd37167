//! What stands, hangs and lies in a home: one file per family, or a folder for the families of one kind of room.
//!
//! A piece of furniture lives in its own space: the middle of its footprint on the floor is the origin, x is to the right,
//! y to the front, z up.

mod armchair;
pub mod bathroom;
pub mod bedroom;
mod bookshelf;
mod catalogue;
mod ceiling_dome;
mod chair;
pub mod children;
pub mod clutter;
mod coffee_table;
mod curtain;
pub mod dining;
mod dining_table;
mod door;
mod electric;
pub mod form;
pub mod hall;
pub mod joinery;
pub mod kitchen;
mod lamp;
pub mod laundry;
pub mod living;
mod ornament;
#[cfg(test)]
mod piece_tests;
mod plant;
mod radiator;
mod rug;
mod side_table;
mod sofa;
pub mod soft;
pub mod study;
#[cfg(test)]
mod surface_tests;
pub mod tableware;
mod television;
mod wall_art;
mod window;

pub use armchair::Armchair;
pub use bookshelf::Bookshelf;
pub use catalogue::{FAMILIES, Family, Place, family_named};
pub use ceiling_dome::CeilingDome;
pub use chair::Chair;
pub use coffee_table::CoffeeTable;
pub use curtain::Curtains;
pub use dining_table::DiningTable;
pub use door::{Door, Passage};
pub use electric::{Socket, Switch};
pub use lamp::{FloorLamp, Pendant, TableLamp};
pub use ornament::{Basket, BookStack, Bowl, Candles, Magazines, Mug, Tray, Vase};
pub use plant::Plant;
pub use radiator::Radiator;
pub use rug::Rug;
pub use side_table::SideTable;
pub use sofa::Sofa;
pub use television::TelevisionBench;
pub use wall_art::{Mirror, PictureOnWall};
pub use window::Window;

use crate::builder::Builder;
use crate::shape::{Reshape, bevelled_box, lathe};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A family of things that a home can have; its fields are what varies.
pub trait Furniture {
    /// One of its many variants.
    fn random(rng: &mut Rng) -> Self
    where
        Self: Sized;

    /// Width (x), depth (y) and height (z) of the box that holds it.
    fn size(&self) -> Vec3;

    /// Free depth before its front that people need to use it, metres.
    fn reach(&self) -> f32 {
        0.0
    }

    /// Fits what reaches up to the ceiling to a room of this height, metres.
    fn fit(&mut self, _height: f32) {}

    /// Where small things can stand on it, in its own space.
    fn surfaces(&self) -> Vec<Surface> {
        Vec::new()
    }

    /// Adds its parts. `rng` decides what the fields leave open: creases, tilts, grain.
    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng);
}

/// A level rectangle on which small things can stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Its corner with the smallest x and y, in the thing's own space.
    pub min: Vec2,
    /// Its corner with the largest.
    pub max: Vec2,
    /// Where it lies.
    pub z: f32,
    /// Free height above it; infinite under the open sky of the room.
    pub headroom: f32,
}

/// A bevelled board between two corners.
pub fn board(min: [f32; 3], max: [f32; 3], bevel: f32) -> Mesh {
    let (min, max) = (Vec3::from_array(min), Vec3::from_array(max));
    bevelled_box(max - min, bevel).moved(0.5 * (min + max))
}

/// Moves the grain of a board to a place of its own.
pub fn grained(mesh: Mesh, rng: &mut Rng) -> Mesh {
    mesh.uv_moved(Vec2::new(rng.range(0.0, 1.6), rng.range(0.0, 0.8)))
}

/// A round leg from the floor to `height`, its radii at the foot and at the top, whose foot stands `splay` off its top.
pub fn leg(height: f32, radii: [f32; 2], splay: Vec2) -> Mesh {
    let [foot, top] = radii;
    let rim = 0.25 * foot;
    let profile = [[0.0, 0.0], [foot - rim, 0.0], [foot, rim], [top, height], [0.0, height]].map(Vec2::from_array);
    lathe(&profile, 16).deformed(|p| p + (splay * (1.0 - p.z / height)).extend(0.0)).smoothed(40.0)
}

/// Cuts off what reaches below the floor: the slanting end of a leg.
pub fn standing(mut mesh: Mesh) -> Mesh {
    mesh.positions.iter_mut().for_each(|p| p.z = p.z.max(0.0));
    mesh
}

/// The pose of something that stands at `at` in another thing's space, turned by `yaw`.
pub fn on(pose: DAffine3, at: Vec3, yaw: f32) -> DAffine3 {
    pose * DAffine3::from_translation(at.as_dvec3()) * DAffine3::from_rotation_z(f64::from(yaw))
}

/// How far things stand above what carries them: contact without faces in one plane.
pub const CONTACT: f32 = 0.0005;
