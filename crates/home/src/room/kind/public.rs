//! The rooms of offices, schools, shops, cafés, libraries and hotels.

use super::homes::{FITTINGS, SHELL, WAYS, WINDOWS};
use super::row::{Blinds, Ceiling, Daylight, Fittings, Row, Shell, Ways, WindowWidth, Windows, norm_of};
use RoomKind::{HotelRoom, OpenOffice, Reception};
use enfilade_furniture::{Class, Finish, RoomKind};

/// What most rooms of offices and schools have in common: a ribbon of windows, a ceiling of tiles, a floor that is easy to clean.
const RIBBON: Windows = Windows { sill: [0.75, 0.95], drawn_sill: 0.85, width: WindowWidth::Ribbon, ..WINDOWS };
const OFFICE_SHELL: Shell = Shell {
    boards: 0.0,
    coverings: &[Finish::CarpetTile, Finish::CarpetTile, Finish::CarpetTile, Finish::Vinyl],
    pale: true,
    ceiling: Ceiling::Grid,
    ..SHELL
};
const SCHOOL_SHELL: Shell = Shell { coverings: &[Finish::Vinyl, Finish::Vinyl, Finish::CarpetTile, Finish::ParquetFloor], ..OFFICE_SHELL };
const SHOP_SHELL: Shell =
    Shell { boards: 0.25, pale: true, coverings: &[Finish::Vinyl, Finish::FloorTile, Finish::Concrete, Finish::Terrazzo], ..SHELL };
const OFFICE_FITTINGS: Fittings = Fittings { blinds: 0.6, blind: Blinds::Plain, on_sill: Some(0.3), ..FITTINGS };
const SCHOOL_FITTINGS: Fittings = Fittings { blinds: 0.3, ..OFFICE_FITTINGS };
const SHOP_FITTINGS: Fittings = Fittings { blinds: 0.0, on_sill: Some(0.2), radiators: false, ..FITTINGS };
/// The first room of a building without a corridor.
const FIRST: Ways = Ways { through: 0.3, entrance: 1, ..WAYS };
const SHOWCASE: Windows = Windows { sill: [0.35, 0.6], drawn_sill: 0.5, width: WindowWidth::Ribbon, daylight: Daylight::Wide, ..WINDOWS };

/// Rooms for work with hands, and for what is stored.
const PLAIN: Windows = Windows { often: 0.4, width: WindowWidth::Small, sill: [1.3, 1.6], daylight: Daylight::Shuns(0.1), ..WINDOWS };
const RAW_SHELL: Shell = Shell {
    boards: 0.0,
    coverings: &[Finish::Concrete, Finish::Concrete, Finish::Vinyl, Finish::FloorTile],
    pale: true,
    ceiling: Ceiling::Concrete,
    ..SHELL
};
const RAW_FITTINGS: Fittings = Fittings { blinds: 0.0, on_sill: Some(0.1), ..FITTINGS };

pub(super) static ROWS: [Row; 15] = [
    Row {
        kind: RoomKind::Office,
        words: &["office", "buro", "büro", "bureau", "study"],
        norm: norm_of([10.0, 17.0], 2.6, 1.8, true),
        ways: WAYS,
        windows: RIBBON,
        shell: Shell { accent: 0.3, ..OFFICE_SHELL },
        fittings: OFFICE_FITTINGS,
        views: 3,
        prized: None,
        needs: &[("desk", &["desk"])],
    },
    Row {
        kind: OpenOffice,
        words: &["openoffice", "openplan", "openspace", "workspace", "coworking", "grossraum", "großraum"],
        norm: norm_of([48.0, 90.0], 5.6, 2.2, true),
        ways: Ways { from: &[(OpenOffice, 0.2), (Reception, 0.2)], ..FIRST },
        windows: Windows { daylight: Daylight::Wide, ..RIBBON },
        shell: Shell { accent: 0.3, ..OFFICE_SHELL },
        fittings: OFFICE_FITTINGS,
        views: 4,
        prized: None,
        needs: &[("desk", &["desk"])],
    },
    Row {
        kind: RoomKind::Meeting,
        words: &["meeting", "conference", "besprechung", "konferenz", "sitzung", "reunion", "seminar"],
        norm: norm_of([16.0, 32.0], 3.3, 1.8, true),
        ways: WAYS,
        windows: RIBBON,
        shell: Shell { accent: 0.5, ..OFFICE_SHELL },
        fittings: OFFICE_FITTINGS,
        views: 3,
        prized: None,
        needs: &[("table", &["conference_table"])],
    },
    Row {
        kind: RoomKind::Classroom,
        words: &["classroom", "class", "lecture", "klasse", "unterricht", "salledecours"],
        norm: norm_of([48.0, 70.0], 6.0, 1.6, true),
        ways: FIRST,
        windows: RIBBON,
        shell: SCHOOL_SHELL,
        fittings: SCHOOL_FITTINGS,
        views: 4,
        prized: Some((Class::Whiteboard, 2.0)),
        needs: &[("desks", &["student_desk"]), ("board", &["class_board"])],
    },
    Row {
        kind: RoomKind::ComputerLab,
        words: &["computer", "edv", "itroom", "lab"],
        norm: norm_of([40.0, 64.0], 5.4, 1.7, true),
        ways: FIRST,
        windows: RIBBON,
        shell: SCHOOL_SHELL,
        fittings: Fittings { blinds: 0.8, ..SCHOOL_FITTINGS },
        views: 4,
        prized: None,
        needs: &[("desks", &["desk"])],
    },
    Row {
        kind: RoomKind::Corridor,
        words: &["corridor", "hall", "flur", "gang", "couloir", "entr", "foyer", "aisle", "passage"],
        norm: norm_of([14.0, 40.0], 1.7, 12.0, false),
        ways: Ways { is_way: true, through: 0.0, entrance: 0, ..WAYS },
        windows: Windows { often: 0.8, width: WindowWidth::Small, daylight: Daylight::Shuns(0.12), ..WINDOWS },
        shell: Shell { coverings: &[Finish::Vinyl, Finish::Vinyl, Finish::CarpetTile, Finish::Terrazzo], ..OFFICE_SHELL },
        fittings: Fittings { blinds: 0.0, on_sill: Some(0.1), ..FITTINGS },
        views: 3,
        prized: None,
        needs: &[],
    },
    Row {
        kind: RoomKind::Cafe,
        words: &["cafe", "café", "coffee", "bistro", "canteen", "kantine", "restaurant", "lounge", "bar"],
        norm: norm_of([40.0, 75.0], 5.0, 1.9, true),
        ways: FIRST,
        windows: SHOWCASE,
        shell: Shell {
            boards: 0.45,
            coverings: &[Finish::FloorTile, Finish::Terrazzo, Finish::Concrete, Finish::ParquetFloor],
            accent: 0.8,
            ceiling: Ceiling::Concrete,
            ..SHELL
        },
        fittings: SHOP_FITTINGS,
        views: 4,
        prized: Some((Class::Counter, 3.0)),
        needs: &[("counter", &["counter"]), ("tables", &["bistro_table"])],
    },
    Row {
        kind: RoomKind::Library,
        words: &["library", "biblio", "bucherei", "bücherei", "reading"],
        norm: norm_of([45.0, 80.0], 5.6, 1.8, true),
        ways: FIRST,
        windows: Windows { daylight: Daylight::Wide, ..RIBBON },
        shell: Shell { coverings: &[Finish::CarpetTile, Finish::CarpetTile, Finish::Vinyl, Finish::ParquetFloor], ..OFFICE_SHELL },
        fittings: OFFICE_FITTINGS,
        views: 4,
        prized: Some((Class::Bookshelf, 2.2)),
        needs: &[("shelves", &["book_aisle", "bookshelf"])],
    },
    Row {
        kind: RoomKind::Bookshop,
        words: &["bookshop", "bookstore", "buchhandlung", "librairie", "books"],
        norm: norm_of([38.0, 70.0], 5.0, 1.8, true),
        ways: FIRST,
        windows: SHOWCASE,
        shell: Shell { boards: 0.5, coverings: &[Finish::CarpetTile, Finish::Carpet, Finish::ParquetFloor, Finish::Vinyl], ..SHOP_SHELL },
        fittings: SHOP_FITTINGS,
        views: 4,
        prized: Some((Class::Bookshelf, 2.2)),
        needs: &[("shelves", &["book_aisle", "bookshelf"]), ("counter", &["counter"])],
    },
    Row {
        kind: RoomKind::Shop,
        words: &["shop", "store", "laden", "magasin", "boutique", "supermarket", "market", "sales"],
        norm: norm_of([45.0, 85.0], 5.4, 1.8, true),
        ways: FIRST,
        windows: SHOWCASE,
        shell: Shell { ceiling: Ceiling::Grid, ..SHOP_SHELL },
        fittings: SHOP_FITTINGS,
        views: 4,
        prized: Some((Class::Shelves, 2.2)),
        needs: &[("shelves or rails", &["gondola", "clothes_rail"]), ("counter", &["counter"])],
    },
    Row {
        kind: Reception,
        words: &["reception", "waiting", "lobby", "foyer", "empfang", "wartezimmer", "accueil"],
        norm: norm_of([22.0, 45.0], 4.0, 1.8, true),
        ways: Ways { from: &[(OpenOffice, 0.2)], ..FIRST },
        windows: Windows { daylight: Daylight::Wide, ..RIBBON },
        shell: Shell {
            boards: 0.15,
            coverings: &[Finish::CarpetTile, Finish::Vinyl, Finish::Terrazzo, Finish::FloorTile],
            accent: 1.0,
            ..OFFICE_SHELL
        },
        fittings: OFFICE_FITTINGS,
        views: 4,
        prized: Some((Class::Counter, 2.2)),
        needs: &[("counter", &["counter"]), ("seats", &["sofa", "armchair", "stacking_chair", "chesterfield"])],
    },
    Row {
        kind: HotelRoom,
        words: &["hotel", "guest", "suite", "bedroom", "zimmer", "chambre"],
        norm: norm_of([17.0, 26.0], 3.2, 1.8, true),
        ways: Ways { through: 0.4, entrance: 1, ..WAYS },
        windows: Windows { daylight: Daylight::Wide, ..WINDOWS },
        shell: Shell { boards: 0.3, coverings: &[Finish::Carpet, Finish::CarpetTile, Finish::ParquetFloor], accent: 1.0, ..SHELL },
        fittings: Fittings { curtains: 1.0, blinds: 0.2, blind: Blinds::Sleeping, on_sill: Some(0.1), ..FITTINGS },
        views: 4,
        prized: None,
        needs: &[("bed", &["bed"]), ("desk", &["desk", "dressing_table", "console"])],
    },
    Row {
        kind: RoomKind::Gym,
        words: &["gym", "fitness", "exercise", "sport", "workout", "turnhalle"],
        norm: norm_of([40.0, 75.0], 5.2, 1.8, true),
        ways: FIRST,
        windows: Windows { daylight: Daylight::Wide, ..RIBBON },
        shell: Shell { coverings: &[Finish::Rubber, Finish::Vinyl, Finish::ParquetFloor, Finish::CarpetTile], accent: 0.6, ..OFFICE_SHELL },
        fittings: SHOP_FITTINGS,
        views: 4,
        prized: Some((Class::OtherFurniture, 2.0)),
        needs: &[("machines", &["treadmill", "exercise_bike"])],
    },
    Row {
        kind: RoomKind::Storeroom,
        words: &["storeroom", "storage", "warehouse", "lager", "depot", "archive", "stock"],
        norm: norm_of([12.0, 26.0], 2.8, 2.0, false),
        ways: WAYS,
        windows: PLAIN,
        shell: RAW_SHELL,
        fittings: RAW_FITTINGS,
        views: 3,
        prized: Some((Class::Shelves, 2.2)),
        needs: &[("racks", &["steel_rack"])],
    },
    Row {
        kind: RoomKind::Workshop,
        words: &["workshop", "werkstatt", "garage", "atelier", "hobby"],
        norm: norm_of([18.0, 36.0], 3.6, 1.8, true),
        ways: FIRST,
        windows: WINDOWS,
        shell: RAW_SHELL,
        fittings: RAW_FITTINGS,
        views: 4,
        prized: Some((Class::Table, 2.5)),
        needs: &[("workbench", &["workbench"])],
    },
];
