//! The furnishing of each kind of room: one file per kind.
//!
//! They ask a [`Furnisher`] for things, which finds their places. Things that several kinds of rooms share have files of their own:
//! `fittings`, `electric`, `blinds`, `table`, `groups`; `wishes` are the costs of places.

mod bathroom;
mod bedroom;
mod blinds;
mod childrens;
mod dining;
mod electric;
mod fittings;
mod furnisher;
mod groups;
mod hall;
mod kitchen;
mod living;
mod study;
mod table;
#[cfg(test)]
mod tests;
mod wishes;

pub use furnisher::Furnisher;

use crate::HomeConfig;
use crate::plan::FloorPlan;
use crate::shell::{self, ShellFinish};
use enfilade_furniture::assets::Library;
use enfilade_furniture::{Builder, DecorConfig, RoomKind};

/// Builds all rooms of a home and what is in them.
pub fn furnish(b: &mut Builder, plan: &FloorPlan, decor: &DecorConfig, config: &HomeConfig, library: &Library) {
    let furniture = config.stream(config.furniture, 3);
    let (shape, look) = (config.stream(config.layout, 5), config.stream(config.materials, 6));
    let home = decor.palette();
    for (i, room) in plan.rooms.iter().enumerate() {
        let palette = decor.room(&home, i as u64);
        b.enter_room(palette, room.windows().next().is_none());
        let mut f = Furnisher::new(b, plan, room, &palette, library, config.clutter, furniture.fork(i as u64));
        // Things that belong to the room whoever lives in it come first, then the furniture of its kind of room, then extras that still
        // fit.
        f.fittings();
        content(&mut f);
        f.extras();
        f.sockets();
        // The shell is built last, because it depends on the furniture: the accent wall is behind certain things, and there is no skirting
        // behind built-in ones.
        let (accent, built_in) = (f.accent, std::mem::take(&mut f.built_in));
        let mut shape = shape.fork(i as u64);
        let finish = ShellFinish::usual(room.kind, accent, &mut shape, &mut look.fork(i as u64));
        shell::build(b, room, &finish, &built_in, &mut shape);
    }
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
    }
}
