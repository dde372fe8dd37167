//! The rooms of homes.
//!
//! The order of the rows is that in which names of other programs are tried: a `KidsBedroom` is a children's room.

use super::row::{Blinds, Ceiling, Daylight, Fittings, Row, Shell, Ways, WindowWidth, Windows, norm_of};
use RoomKind::{Bathroom, Bedroom, Dining, Kitchen, Living};
use enfilade_furniture::{Class, Finish, RoomKind};

/// What most rooms have in common.
pub(super) const WAYS: Ways = Ways { is_way: false, through: 5.0, from: &[], open_to: &[], entrance: 3, swings_out: false };
pub(super) const WINDOWS: Windows =
    Windows { sill: [0.7, 0.92], drawn_sill: 0.8, often: 1.0, width: WindowWidth::Usual, daylight: Daylight::Usual, bay: false };
pub(super) const SHELL: Shell = Shell {
    boards: 0.65,
    coverings: &[Finish::ParquetFloor, Finish::ParquetFloor, Finish::Concrete],
    walls: Finish::WallPaint,
    pale: false,
    accent: 0.0,
    ceiling: Ceiling::Plaster,
};
pub(super) const FITTINGS: Fittings =
    Fittings { curtains: 0.0, blinds: 0.3, blind: Blinds::Plain, on_sill: Some(0.9), radiators: true, sockets: true };

/// What wet rooms have in common.
const WET_WAYS: Ways = Ways { through: 9.0, from: &[(Living, 1.6), (Dining, 1.6)], entrance: 4, ..WAYS };
const WET_WINDOWS: Windows = Windows { sill: [1.2, 1.45], drawn_sill: 1.3, often: 0.8, width: WindowWidth::Small, ..WINDOWS };
const WET_SHELL: Shell = Shell {
    boards: 0.0,
    coverings: &[Finish::FloorTile, Finish::FloorTile, Finish::FloorTile, Finish::Terrazzo, Finish::Concrete],
    ..SHELL
};
const WET_FITTINGS: Fittings = Fittings { blinds: 0.6, blind: Blinds::Private, on_sill: Some(0.5), sockets: false, ..FITTINGS };

/// Floors of kitchens and halls without boards.
const HARD: &[Finish] = &[Finish::FloorTile, Finish::FloorTile, Finish::Terrazzo, Finish::Concrete, Finish::ParquetFloor];
const SOFT: &[Finish] = &[Finish::Carpet, Finish::ParquetFloor];
/// Rooms in which a household spends the day are entered from each other.
const DAY: &[(RoomKind, f32)] = &[(Living, 0.15), (Dining, 0.15), (Kitchen, 0.15)];

pub(super) static ROWS: [Row; 10] = [
    Row {
        kind: Living,
        words: &["livingdining", "livingkitchen", "living", "lounge", "wohn", "salon", "sejour"],
        norm: norm_of([18.0, 27.0], 3.6, 1.6, true),
        ways: Ways { through: 0.5, from: DAY, open_to: &[(Dining, 0.8), (Kitchen, 0.5)], entrance: 1, ..WAYS },
        windows: Windows { sill: [0.45, 0.7], drawn_sill: 0.6, width: WindowWidth::Wide, daylight: Daylight::Wide, bay: true, ..WINDOWS },
        shell: Shell { accent: 1.0, ..SHELL },
        fittings: Fittings { curtains: 1.0, blinds: 0.2, blind: Blinds::Slats, ..FITTINGS },
        views: 4,
        prized: None,
        needs: &[("sofa", &["sofa", "corner_sofa", "chesterfield", "day_bed"])],
    },
    Row {
        kind: Kitchen,
        words: &["diningkitchen", "kitchen", "kuche", "kueche", "küche", "cuisine"],
        norm: norm_of([7.5, 12.0], 2.2, 1.8, true),
        ways: Ways { through: 3.0, from: DAY, open_to: &[(Living, 0.5), (Dining, 0.6)], entrance: 2, ..WAYS },
        windows: Windows { sill: [1.06, 1.14], drawn_sill: 1.1, ..WINDOWS },
        shell: Shell { boards: 0.4, coverings: HARD, ..SHELL },
        fittings: Fittings { blinds: 0.5, on_sill: None, radiators: false, sockets: false, ..FITTINGS },
        views: 3,
        prized: Some((Class::Cabinet, 2.5)),
        needs: &[("fitted units", &["kitchen_unit"]), ("refrigerator", &["kitchen_unit", "refrigerator"])],
    },
    Row {
        kind: Dining,
        words: &["dining", "esszimmer"],
        norm: norm_of([9.0, 13.5], 2.7, 1.7, true),
        ways: Ways { through: 0.9, from: DAY, open_to: &[(Living, 0.8), (Kitchen, 0.6)], entrance: 2, ..WAYS },
        windows: Windows { bay: true, ..WINDOWS },
        shell: Shell { accent: 0.5, ..SHELL },
        fittings: Fittings { curtains: 0.8, blinds: 0.2, blind: Blinds::Slats, ..FITTINGS },
        views: 3,
        prized: None,
        needs: &[("table", &["dining_table", "long_table"])],
    },
    Row {
        kind: RoomKind::Children,
        words: &["kids", "child", "kinder"],
        norm: norm_of([9.5, 13.5], 2.45, 1.7, true),
        ways: WAYS,
        windows: WINDOWS,
        shell: Shell { coverings: SOFT, accent: 1.0, ..SHELL },
        fittings: Fittings { curtains: 0.8, blinds: 0.4, blind: Blinds::Sleeping, ..FITTINGS },
        views: 3,
        prized: None,
        needs: &[("bed", &["bed"])],
    },
    Row {
        kind: Bedroom,
        words: &["nanny", "elderly", "bedroom", "schlaf", "chambre", "guestroom"],
        norm: norm_of([12.0, 16.5], 2.75, 1.6, true),
        ways: WAYS,
        windows: Windows { bay: true, ..WINDOWS },
        shell: Shell { coverings: SOFT, accent: 1.0, ..SHELL },
        fittings: Fittings { curtains: 1.0, blinds: 0.4, blind: Blinds::Sleeping, ..FITTINGS },
        views: 3,
        prized: None,
        needs: &[("bed", &["bed"])],
    },
    Row {
        kind: Bathroom,
        words: &["bathroom", "bath", "shower", "bad", "salledebain"],
        norm: norm_of([4.6, 7.5], 1.75, 2.2, false),
        ways: Ways { from: &[(Living, 1.6), (Dining, 1.6), (Bedroom, 0.8), (RoomKind::HotelRoom, 0.1)], ..WET_WAYS },
        windows: Windows { daylight: Daylight::Shuns(0.04), ..WET_WINDOWS },
        shell: Shell { walls: Finish::WallTile, ..WET_SHELL },
        fittings: WET_FITTINGS,
        views: 2,
        prized: None,
        needs: &[("toilet", &["toilet"]), ("washbasin", &["washbasin"]), ("tub or shower", &["bathtub", "shower"])],
    },
    Row {
        kind: RoomKind::Toilet,
        words: &["toilet", "wc", "washroom", "restroom"],
        norm: norm_of([1.6, 2.4], 0.95, 2.2, false),
        ways: Ways { swings_out: true, ..WET_WAYS },
        windows: Windows { daylight: Daylight::Shuns(0.12), ..WET_WINDOWS },
        shell: WET_SHELL,
        fittings: WET_FITTINGS,
        views: 1,
        prized: None,
        needs: &[("toilet", &["toilet"])],
    },
    Row {
        kind: RoomKind::Laundry,
        words: &["laundry", "utility", "storage", "storeroom", "abstell"],
        norm: norm_of([3.0, 5.0], 1.5, 2.2, false),
        ways: Ways { from: &[(Living, 1.6), (Dining, 1.6), (Kitchen, 0.3), (Bathroom, 0.3)], ..WET_WAYS },
        windows: Windows { often: 0.3, daylight: Daylight::Shuns(0.12), ..WET_WINDOWS },
        shell: Shell { coverings: &[Finish::FloorTile, Finish::Concrete], ..WET_SHELL },
        fittings: Fittings { blinds: 0.3, blind: Blinds::Plain, ..WET_FITTINGS },
        views: 1,
        prized: None,
        needs: &[],
    },
    Row {
        kind: RoomKind::Study,
        words: &["study", "office", "library", "arbeits", "workroom", "bureau"],
        norm: norm_of([7.5, 11.5], 2.25, 1.8, true),
        ways: WAYS,
        windows: WINDOWS,
        shell: Shell { accent: 0.5, ..SHELL },
        fittings: Fittings { curtains: 0.6, blinds: 0.5, blind: Blinds::Slats, ..FITTINGS },
        views: 3,
        prized: None,
        needs: &[("desk", &["desk"])],
    },
    Row {
        kind: RoomKind::Hall,
        words: &["hall", "corridor", "entr", "aisle", "foyer", "flur", "diele", "couloir"],
        norm: norm_of([3.6, 9.5], 1.2, 7.0, false),
        ways: Ways { is_way: true, through: 0.0, entrance: 0, ..WAYS },
        windows: Windows { often: 0.3, width: WindowWidth::Small, daylight: Daylight::Shuns(0.12), ..WINDOWS },
        shell: Shell { boards: 0.5, coverings: HARD, accent: 0.5, ..SHELL },
        fittings: FITTINGS,
        views: 2,
        prized: None,
        needs: &[],
    },
];
