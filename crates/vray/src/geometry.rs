//! V-Ray's geometry pass as the geometry layers of a frame.

use crate::entities::{Entities, Entity};
use crate::error::VrayError;
use crate::exr_file::VrayImage;
use crate::notes::Notes;
use enfilade_frame::{F16_LIMIT, Frame, Layer, Values, f16};
use enfilade_math::DVec3;
use enfilade_scene::Pose;

/// Length below which a normal is meaningless.
const SHORT: f64 = 1e-6;

/// The camera, units and entities of an image.
pub(crate) struct Placed<'a> {
    pub pose: &'a Pose,
    /// Metres per unit of V-Ray's scene.
    pub meters_per_unit: f64,
    /// Metres per unit of the dataset.
    pub meters_in_dataset: f64,
    pub entities: &'a Entities,
}

/// A pixel as it is stored.
struct Pixel {
    entity: i16,
    /// Units of the dataset.
    position: [f32; 3],
    distance_m: f32,
    depth_z_m: f32,
    /// In the world and in camera axes, without and with bump.
    normals: [[f16; 3]; 4],
    tex_coord: [f16; 3],
}

const VOID: Pixel = Pixel {
    entity: -1,
    position: [f32::NAN; 3],
    distance_m: f32::NAN,
    depth_z_m: f32::NAN,
    normals: [[f16::NAN; 3]; 4],
    tex_coord: [f16::ZERO; 3],
};

/// How many values were fixed, by reason.
#[derive(Default)]
struct Fixed {
    strangers: usize,
    lights: usize,
    nowhere: usize,
    zero: usize,
    turned: usize,
    no_uv: usize,
}

/// Adds the geometry layers to the frame. They are what our own renderer would store: where nothing of the scene was hit the layers'
/// sentinels, normals of unit length that face the camera, texture coordinates of two components.
///
/// # Errors
/// When a render element is missing, or numbers of entities are not whole.
pub(crate) fn add_geometry(frame: &mut Frame, image: &VrayImage, placed: &Placed<'_>, notes: &mut Notes) -> Result<(), VrayError> {
    let ids = image.ids("VRayRenderEntityID")?;
    let elements = ["VRayPosition", "VRayNormal", "VRayNormalBump", "VRayTexCoord"].map(|name| image.triples(name));
    let [positions, normals, bumps, uvs] = elements;
    let (positions, normals, bumps, uvs) = (positions?, normals?, bumps?, uvs?);
    let mut fixed = Fixed::default();
    let pixel = |i: usize| placed.pixel(ids[i], [positions[i], normals[i], bumps[i], uvs[i]].map(point), &mut fixed);
    let pixels: Vec<Pixel> = (0..ids.len()).map(pixel).collect();
    fixed.tell(&image.name(), notes);
    insert(frame, &pixels);
    Ok(())
}

fn insert(frame: &mut Frame, pixels: &[Pixel]) {
    let singles = |of: fn(&Pixel) -> f32| Values::F32(pixels.iter().map(of).collect());
    frame.insert(Layer::DepthMeters, singles(|p| p.distance_m));
    frame.insert(Layer::DepthZMeters, singles(|p| p.depth_z_m));
    frame.insert(Layer::Position, Values::F32(pixels.iter().flat_map(|p| p.position).collect()));
    for (i, layer) in [Layer::NormalWorld, Layer::NormalCam, Layer::NormalBumpWorld, Layer::NormalBumpCam].into_iter().enumerate() {
        frame.insert(layer, Values::F16(pixels.iter().flat_map(|p| p.normals[i]).collect()));
    }
    frame.insert(Layer::TexCoord, Values::F16(pixels.iter().flat_map(|p| p.tex_coord).collect()));
    frame.insert(Layer::RenderEntityId, Values::I16(pixels.iter().map(|p| p.entity).collect()));
}

impl Placed<'_> {
    fn pixel(&self, id: i64, [position, normal, bump, uv]: [DVec3; 4], fixed: &mut Fixed) -> Pixel {
        let entity = match self.entities.of(id) {
            Entity::Part(part) => part,
            Entity::Void => return VOID,
            Entity::Stranger => {
                fixed.strangers += 1;
                return VOID;
            }
            Entity::Light => {
                fixed.lights += 1;
                return VOID;
            }
        };
        let away = position * self.meters_per_unit - self.pose.position;
        let distance = away.length();
        let stored = if self.meters_in_dataset == self.meters_per_unit {
            position
        } else {
            position * (self.meters_per_unit / self.meters_in_dataset)
        };
        if !(distance.is_finite() && distance > 0.0) {
            fixed.nowhere += 1;
            return VOID;
        }
        let camera_from_world = self.pose.world_from_camera.transpose();
        let (smooth, turned) = facing(normal, away / distance, &mut fixed.zero);
        fixed.turned += usize::from(turned);
        let bump = facing(if turned { -bump } else { bump }, away / distance, &mut fixed.zero).0;
        let halves = |n: DVec3| n.as_vec3().to_array().map(f16::from_f32);
        let finite = |v: f64| f16::from_f32((v as f32).clamp(-F16_LIMIT, F16_LIMIT));
        fixed.no_uv += usize::from(!uv.truncate().is_finite());
        Pixel {
            entity,
            position: stored.as_vec3().to_array(),
            distance_m: distance as f32,
            depth_z_m: -(camera_from_world * away).z as f32,
            normals: [smooth, camera_from_world * smooth, bump, camera_from_world * bump].map(halves),
            tex_coord: if uv.truncate().is_finite() { [finite(uv.x), finite(uv.y), f16::ZERO] } else { [f16::ZERO; 3] },
        }
    }
}

/// A normal of unit length that faces the camera, and whether it had to be turned around; `toward` is the direction of view.
fn facing(normal: DVec3, toward: DVec3, zero: &mut usize) -> (DVec3, bool) {
    let length = normal.length();
    if !(length.is_finite() && length > SHORT) {
        *zero += 1;
        return (DVec3::ZERO, false);
    }
    let unit = normal / length;
    let away = unit.dot(toward) > 0.0;
    (if away { -unit } else { unit }, away)
}

impl Fixed {
    fn tell(&self, place: &str, notes: &mut Notes) {
        let nothing = "the pixels count as void";
        notes.count(
            &format!("nodes that are no part of the dataset are seen; {nothing} (entities --hide-nodes-not-in-mesh)"),
            place,
            self.strangers,
        );
        notes.count(&format!("lights are seen; {nothing} (entities --hide-lights)"), place, self.lights);
        notes.count(&format!("surfaces have no position; {nothing}"), place, self.nowhere);
        notes.count("normals have no length and stay zero, which verify will tell", place, self.zero);
        notes.count("normals face away from the camera and are turned around", place, self.turned);
        notes.count("texture coordinates are no numbers and become 0", place, self.no_uv);
    }
}

fn point(v: [f32; 3]) -> DVec3 {
    DVec3::from(v.map(f64::from))
}
