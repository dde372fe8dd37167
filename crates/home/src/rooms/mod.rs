//! The furnishing of each kind of room: one file per kind.
//!
//! They ask a [`Furnisher`] for things, which finds their places. Things that several kinds of rooms share have files of their own:
//! `fittings`, `electric`, `blinds`, `table`, `groups`; `wishes` are the costs of places.

mod bathroom;
mod bedroom;
mod blinds;
mod bookshop;
mod cafe;
mod ceiling;
mod childrens;
mod classroom;
mod corridor;
mod dining;
mod electric;
mod fittings;
mod furnisher;
mod groups;
mod gym;
mod hall;
mod hotel;
mod kitchen;
mod living;
mod meeting;
mod office;
mod placed;
mod reception;
mod shop;
mod stations;
mod store;
mod study;
mod table;
mod television;
#[cfg(test)]
mod tests;
mod wishes;

pub use furnisher::Furnisher;

use crate::HomeConfig;
use crate::life::Furnished;
use crate::plan::FloorPlan;
use crate::room::kind;
use crate::shell::{self, ShellFinish};
use enfilade_furniture::assets::Library;
use enfilade_furniture::{Builder, DecorConfig, RoomKind};

/// Builds all rooms of a home and what is in them; returns the parts and the floor of each.
pub fn furnish(b: &mut Builder, plan: &FloorPlan, decor: &DecorConfig, config: &HomeConfig, library: &Library) -> Vec<Furnished> {
    let furniture = config.stream(config.furniture, 3);
    let (shape, look) = (config.stream(config.layout, 5), config.stream(config.materials, 6));
    let home = decor.palette();
    let mut rooms = Vec::new();
    for (i, room) in plan.rooms.iter().enumerate() {
        let palette = decor.room(&home, i as u64);
        let palette = if kind::row(room.kind).shell.pale { palette.with_pale_walls() } else { palette };
        b.enter_room(palette, room.windows().next().is_none());
        let first = b.part_count();
        let mut f = Furnisher::new(b, plan, room, &palette, library, config.clutter, furniture.fork(i as u64));
        // Things that belong to the room whoever lives in it come first, then the furniture of its kind of room, then extras that still
        // fit.
        f.fittings();
        content(&mut f);
        f.extras();
        f.sockets();
        // The shell is built last, because it depends on the furniture: the accent wall is behind certain things, and there is no skirting
        // behind built-in ones.
        let (accent, built_in, floor) = (f.accent, std::mem::take(&mut f.built_in), f.floor.clone());
        rooms.push(Furnished { parts: first..f.b.part_count(), floor });
        let mut shape = shape.fork(i as u64);
        let finish = ShellFinish::usual(room.kind, accent, &mut shape, &mut look.fork(i as u64));
        shell::build(b, room, &finish, &built_in, &mut shape);
    }
    rooms
}

/// Furnishes one room.
fn content(f: &mut Furnisher) {
    match f.room.kind {
        RoomKind::Living => living::furnish(f),
        RoomKind::Kitchen => kitchen::furnish(f),
        RoomKind::Dining => dining::furnish(f),
        RoomKind::Bedroom => bedroom::furnish(f),
        RoomKind::Children => childrens::furnish(f),
        RoomKind::Study => study::furnish(f),
        RoomKind::Bathroom => bathroom::furnish(f),
        RoomKind::Toilet => bathroom::furnish_toilet(f),
        RoomKind::Hall => hall::furnish(f),
        RoomKind::Laundry => bathroom::furnish_laundry(f),
        RoomKind::Office => office::furnish(f),
        RoomKind::OpenOffice => office::furnish_open(f),
        RoomKind::Meeting => meeting::furnish(f),
        RoomKind::Classroom => classroom::furnish(f),
        RoomKind::ComputerLab => classroom::furnish_lab(f),
        RoomKind::Corridor => corridor::furnish(f),
        RoomKind::Cafe => cafe::furnish(f),
        RoomKind::Library => bookshop::furnish_library(f),
        RoomKind::Bookshop => bookshop::furnish(f),
        RoomKind::Shop => shop::furnish(f),
        RoomKind::Reception => reception::furnish(f),
        RoomKind::HotelRoom => hotel::furnish(f),
        RoomKind::Gym => gym::furnish(f),
        RoomKind::Storeroom => store::furnish(f),
        RoomKind::Workshop => store::furnish_workshop(f),
    }
}
