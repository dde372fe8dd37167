//! The table of all families: the place of each thing, its rooms, and a function that draws one of its variants.

use super::bathroom::{
    BathMat, Bathtub, FoldedTowels, MirrorCabinet, PaperHolder, PedalBin, Shower, SoapDispenser, Toilet, ToiletBrush, Toiletries,
    ToothbrushMug, TowelRadiator, TowelRail, TowelShelf, Washbasin,
};
use super::bedroom::{Bed, Bench, Dresser, DressingTable, FoldedClothes, LaundryBasket, Nightstand, Wardrobe};
use super::children::{Crib, Globe, Guitar, MusicKeyboard, PlayTable, PlushBear, Toy, ToyChair, ToyChest};
use super::clutter::{
    BoardGame, BookRow, Cable, Figurine, FoldedBlanket, MagazineRack, OpenBook, Phone, PhotoFrame, PillarCandles, RemoteControl,
    ScatterCushion, StorageBasket, Tablet, TissueBox,
};
use super::dining::{BarStool, DiningBench, GlassCabinet, LongTable, ShellChair, Sideboard, SpindleChair, UpholsteredChair};
use super::gym::{DumbbellRack, ExerciseBall, ExerciseBike, ExerciseMat, MirrorWall, Treadmill, WeightBench};
use super::hall::{
    Backpack, CardboardBox, CoatHooks, CoatStand, Console, Handbag, KeyBoard, ShoeCabinet, Shoes, ShoppingBag, StorageBox, Suitcase,
    TallMirror, UmbrellaStand,
};
use super::kitchen::{FittedKitchen, KitchenIsland, Refrigerator};
use super::laundry::{Bucket, DryingRack, IroningBoard, Vacuum, WashingMachine};
use super::living::{
    Blind, CeilingLamp, Chesterfield, CornerSofa, CubeShelf, DayBed, Fireplace, FloorCushion, GameConsole, Pouf, RecordPlayer, Speaker,
    Stove, WallClock, WallLamp, WallShelf,
};
use super::office::{
    CeilingPanel, ComputerCase, ConferenceTable, Copier, ExitSign, Extinguisher, OfficeCabinet, Partition, ProjectionScreen, Projector,
    TubeLamp, WallDisplay, WaterDispenser,
};
use super::school::{ClassBoard, Lockers, StackingChair, StudentDesk};
use super::shop::{BistroTable, BookAisle, BottleFridge, CakeCase, ClothesRail, Counter, DisplayTable, EspressoMachine, Gondola, Till};
use super::store::{SteelRack, StepLadder, ToolBoard, Workbench};
use super::study::{Desk, DeskLamp, FilingCabinet, Keyboard, Laptop, Monitor, Mouse, OfficeChair, PaperStack, PenCup, Printer, WallBoard};
use super::tableware::{
    Bottle, Bread, Cookware, Crockery, CuttingBoard, Drinkware, FruitBowl, HerbPot, Jar, KitchenMachine, KitchenRoll, KnifeBlock, Piece,
    PlaceSetting, SpiceRack, UtensilJar, WasteBin,
};
use super::{
    Armchair, Basket, BookStack, Bookshelf, Bowl, Candles, Chair, CoffeeTable, DiningTable, FloorLamp, FlowerVase, Foliage, Furniture,
    HangingPlant, Magazines, Mirror, Mug, Pendant, PictureOnWall, Plant, Radiator, Rug, SideTable, Socket, Sofa, Switch, TableLamp,
    TelevisionBench, Tray, Vase,
};
use crate::builder::Class;
use crate::room_kind::RoomKind;
use crate::room_kind::RoomKind::{
    Bathroom, Bedroom, Bookshop, Cafe, Children, Classroom, ComputerLab, Corridor, Dining, Gym, Hall, Kitchen, Laundry, Library, Living,
    Meeting, Office, OpenOffice, Reception, Shop, Storeroom, Study, Workshop,
};
use enfilade_math::{Bounds3, Rng, Vec3};

/// Where a thing stands, hangs or lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// On the floor with its back to a wall, or fixed to that wall at a height of its own.
    AgainstWall,
    /// On the floor; it is seen from all sides.
    Free,
    /// On the floor, best in a corner.
    Corner,
    /// On a wall at a height of the room's choice: the origin is the middle of its back, on the wall's face.
    OnWall,
    /// Under the ceiling, which has the origin.
    Ceiling,
    /// On a [`super::Surface`] of another thing.
    OnSurface,
    /// Flat on the floor: others may stand on it.
    Underfoot,
}

impl Place {
    /// The box, in a thing's own space, around a thing of this [`Furniture::size`].
    pub fn bounds(self, size: Vec3) -> Bounds3 {
        let low = match self {
            Self::OnWall => Vec3::new(-0.5 * size.x, 0.0, -0.5 * size.z),
            Self::Ceiling => Vec3::new(-0.5 * size.x, -0.5 * size.y, -size.z),
            Self::AgainstWall | Self::Free | Self::Corner | Self::OnSurface | Self::Underfoot => {
                Vec3::new(-0.5 * size.x, -0.5 * size.y, 0.0)
            }
        };
        Bounds3 { min: low, max: low + size }
    }
}

/// One row of the catalogue.
#[derive(Clone, Copy, Debug)]
pub struct Family {
    /// The family's name, which is also used for its objects in a scene.
    pub name: &'static str,
    /// The class of the thing itself; things on it have classes of their own.
    pub class: Class,
    /// Place of the thing in a room.
    pub place: Place,
    /// The rooms in which people expect it, besides those that name it in [`RoomKind::things`].
    pub rooms: &'static [RoomKind],
    /// Draws a variant of the family.
    pub random: fn(&mut Rng) -> Box<dyn Furniture>,
}

impl Family {
    /// True where people expect the family in rooms of this kind.
    pub fn is_in(&self, kind: RoomKind) -> bool {
        self.rooms.contains(&kind) || kind.things().contains(&self.name)
    }
}

const fn family<F: Furniture + 'static>(name: &'static str, class: Class, place: Place, rooms: &'static [RoomKind]) -> Family {
    Family { name, class, place, rooms, random: |rng| Box::new(F::random(rng)) }
}

/// Rooms in which people sit, sleep or work.
const DWELLING: &[RoomKind] = &[Living, Dining, Bedroom, Children, Study];
const ANY: &[RoomKind] = &[Living, Dining, Kitchen, Bedroom, Children, Study, Bathroom, Hall, Laundry];

/// Rooms of offices, schools and shops.
const WORK: &[RoomKind] =
    &[Office, OpenOffice, Meeting, Classroom, ComputerLab, Corridor, Library, Bookshop, Shop, Reception, Gym, Storeroom, Workshop];

/// All families.
pub static FAMILIES: &[Family] = &[
    // Living and dining.
    family::<Armchair>("armchair", Class::Chair, Place::Free, &[Living, Bedroom, Study]),
    family::<Bookshelf>("bookshelf", Class::Bookshelf, Place::AgainstWall, &[Living, Study, Children, Hall]),
    family::<Chair>("chair", Class::Chair, Place::Free, &[Dining, Living, Kitchen, Bedroom]),
    family::<CoffeeTable>("coffee_table", Class::Table, Place::Free, &[Living]),
    family::<DiningTable>("dining_table", Class::Table, Place::Free, &[Dining, Living, Kitchen]),
    family::<SideTable>("side_table", Class::Table, Place::Free, &[Living, Bedroom]),
    family::<Sofa>("sofa", Class::Sofa, Place::AgainstWall, &[Living, Study]),
    family::<TelevisionBench>("tv_bench", Class::Cabinet, Place::AgainstWall, &[Living]),
    // Bedroom.
    family::<Bed>("bed", Class::Bed, Place::AgainstWall, &[Bedroom, Children]),
    family::<Nightstand>("nightstand", Class::NightStand, Place::AgainstWall, &[Bedroom, Children]),
    family::<Wardrobe>("wardrobe", Class::Cabinet, Place::AgainstWall, &[Bedroom, Children, Hall]),
    family::<Dresser>("dresser", Class::Dresser, Place::AgainstWall, &[Bedroom, Children, Hall]),
    family::<DressingTable>("dressing_table", Class::Table, Place::AgainstWall, &[Bedroom]),
    family::<Bench>("bench", Class::OtherFurniture, Place::Free, &[Bedroom, Hall]),
    family::<FoldedClothes>("clothes", Class::Clothes, Place::OnSurface, &[Bedroom, Children, Laundry]),
    family::<LaundryBasket>("laundry_basket", Class::OtherProp, Place::Corner, &[Bedroom, Bathroom, Laundry]),
    // Bathroom.
    family::<Bathtub>("bathtub", Class::Bathtub, Place::AgainstWall, &[Bathroom]),
    family::<Shower>("shower", Class::OtherStructure, Place::AgainstWall, &[Bathroom]),
    family::<Washbasin>("washbasin", Class::Sink, Place::AgainstWall, &[Bathroom]),
    family::<Toilet>("toilet", Class::Toilet, Place::AgainstWall, &[Bathroom]),
    family::<MirrorCabinet>("mirror_cabinet", Class::Cabinet, Place::OnWall, &[Bathroom]),
    family::<TowelRadiator>("towel_radiator", Class::OtherStructure, Place::AgainstWall, &[Bathroom]),
    family::<TowelRail>("towel_rail", Class::OtherProp, Place::OnWall, &[Bathroom]),
    family::<TowelShelf>("towel_shelf", Class::Shelves, Place::OnWall, &[Bathroom]),
    family::<FoldedTowels>("towel", Class::Towel, Place::OnSurface, &[Bathroom, Laundry]),
    family::<BathMat>("bath_mat", Class::FloorMat, Place::Underfoot, &[Bathroom]),
    family::<PaperHolder>("paper_holder", Class::OtherProp, Place::OnWall, &[Bathroom]),
    family::<SoapDispenser>("soap_dispenser", Class::OtherProp, Place::OnSurface, &[Bathroom, Kitchen]),
    family::<ToothbrushMug>("toothbrush_mug", Class::OtherProp, Place::OnSurface, &[Bathroom]),
    family::<Toiletries>("bottle", Class::OtherProp, Place::OnSurface, &[Bathroom, Bedroom]),
    family::<ToiletBrush>("toilet_brush", Class::OtherProp, Place::Corner, &[Bathroom]),
    family::<PedalBin>("bin", Class::OtherProp, Place::Corner, &[Bathroom, Bedroom, Study]),
    // Hall.
    family::<CoatHooks>("coat_hooks", Class::OtherProp, Place::OnWall, &[Hall]),
    family::<CoatStand>("coat_stand", Class::OtherFurniture, Place::Corner, &[Hall]),
    family::<Console>("console", Class::Table, Place::AgainstWall, &[Hall, Living]),
    family::<KeyBoard>("key_board", Class::OtherProp, Place::OnWall, &[Hall]),
    family::<ShoeCabinet>("shoe_cabinet", Class::Cabinet, Place::AgainstWall, &[Hall]),
    family::<Shoes>("shoes", Class::OtherProp, Place::Free, &[Hall, Bedroom]),
    family::<TallMirror>("tall_mirror", Class::Mirror, Place::AgainstWall, &[Hall, Bedroom]),
    family::<UmbrellaStand>("umbrella_stand", Class::OtherProp, Place::Corner, &[Hall]),
    family::<Backpack>("backpack", Class::Bag, Place::Free, &[Hall, Children, Study, Bedroom]),
    family::<Handbag>("handbag", Class::Bag, Place::OnSurface, &[Hall, Bedroom]),
    family::<ShoppingBag>("shopping_bag", Class::Bag, Place::Free, &[Hall, Kitchen]),
    family::<Suitcase>("suitcase", Class::Bag, Place::Corner, &[Hall, Bedroom]),
    family::<CardboardBox>("cardboard_box", Class::Box, Place::Free, &[Hall, Laundry, Study]),
    family::<StorageBox>("storage_box", Class::Box, Place::OnSurface, &[Hall, Bedroom, Children, Study, Laundry]),
    // Laundry.
    family::<WashingMachine>("washing_machine", Class::OtherFurniture, Place::AgainstWall, &[Laundry, Bathroom, Kitchen]),
    family::<DryingRack>("drying_rack", Class::OtherFurniture, Place::Free, &[Laundry, Bathroom]),
    family::<IroningBoard>("ironing_board", Class::OtherFurniture, Place::Free, &[Laundry, Bedroom]),
    family::<Vacuum>("vacuum_cleaner", Class::OtherProp, Place::Corner, &[Laundry, Hall]),
    family::<Bucket>("bucket", Class::OtherProp, Place::Corner, &[Laundry, Bathroom]),
    // Light, walls, floors.
    family::<FloorLamp>("floor_lamp", Class::Lamp, Place::Corner, &[Living, Bedroom, Study]),
    family::<Pendant>("pendant", Class::Lamp, Place::Ceiling, ANY),
    family::<TableLamp>("table_lamp", Class::Lamp, Place::OnSurface, DWELLING),
    family::<Mirror>("mirror", Class::Mirror, Place::OnWall, &[Living, Bedroom, Hall]),
    family::<PictureOnWall>("picture", Class::Picture, Place::OnWall, DWELLING),
    family::<Radiator>("radiator", Class::OtherStructure, Place::AgainstWall, ANY),
    family::<Rug>("rug", Class::FloorMat, Place::Underfoot, DWELLING),
    family::<Switch>("switch", Class::OtherProp, Place::OnWall, ANY),
    family::<Socket>("socket", Class::OtherProp, Place::OnWall, ANY),
    // Small things.
    family::<Basket>("basket", Class::OtherProp, Place::Corner, DWELLING),
    family::<BookStack>("books", Class::Books, Place::OnSurface, DWELLING),
    family::<Bowl>("bowl", Class::OtherProp, Place::OnSurface, &[Living, Dining, Kitchen, Hall]),
    family::<Candles>("candlestick", Class::OtherProp, Place::OnSurface, &[Living, Dining, Bedroom]),
    family::<Magazines>("magazines", Class::Paper, Place::OnSurface, &[Living, Bedroom, Study]),
    family::<Mug>("mug", Class::OtherProp, Place::OnSurface, &[Living, Dining, Kitchen, Study]),
    family::<Plant>("plant", Class::OtherProp, Place::Corner, DWELLING),
    Family {
        random: |rng| Box::new(Plant::small(rng.range(0.09, 0.14), rng.range(0.05, 0.07))),
        ..family::<Plant>("small_plant", Class::OtherProp, Place::OnSurface, ANY)
    },
    family::<Tray>("tray", Class::OtherProp, Place::OnSurface, &[Living, Dining, Kitchen]),
    family::<Vase>("vase", Class::OtherProp, Place::OnSurface, &[Living, Dining, Bedroom, Hall]),
    // Kitchen.
    family::<FittedKitchen>("kitchen_unit", Class::Cabinet, Place::AgainstWall, &[Kitchen]),
    family::<KitchenIsland>("kitchen_island", Class::Cabinet, Place::Free, &[Kitchen]),
    family::<Refrigerator>("refrigerator", Class::Refrigerator, Place::AgainstWall, &[Kitchen]),
    family::<KitchenMachine>("kitchen_machine", Class::OtherProp, Place::OnSurface, &[Kitchen]),
    family::<Cookware>("cookware", Class::OtherProp, Place::OnSurface, &[Kitchen]),
    family::<CuttingBoard>("cutting_board", Class::OtherProp, Place::OnSurface, &[Kitchen]),
    family::<KnifeBlock>("knife_block", Class::OtherProp, Place::OnSurface, &[Kitchen]),
    family::<UtensilJar>("utensil_jar", Class::OtherProp, Place::OnSurface, &[Kitchen]),
    family::<Crockery>("crockery", Class::OtherProp, Place::OnSurface, &[Kitchen, Dining]),
    family::<Drinkware>("glass", Class::OtherProp, Place::OnSurface, &[Kitchen, Dining, Living, Bedroom]),
    family::<Piece>("cutlery", Class::OtherProp, Place::OnSurface, &[Kitchen, Dining]),
    family::<PlaceSetting>("place_setting", Class::OtherProp, Place::OnSurface, &[Dining]),
    family::<Bottle>("drink_bottle", Class::OtherProp, Place::OnSurface, &[Kitchen, Dining, Living]),
    family::<Jar>("jar", Class::OtherProp, Place::OnSurface, &[Kitchen]),
    family::<SpiceRack>("spice_rack", Class::OtherProp, Place::OnSurface, &[Kitchen]),
    family::<FruitBowl>("fruit_bowl", Class::OtherProp, Place::OnSurface, &[Kitchen, Dining]),
    family::<Bread>("bread", Class::OtherProp, Place::OnSurface, &[Kitchen]),
    family::<HerbPot>("herbs", Class::OtherProp, Place::OnSurface, &[Kitchen]),
    family::<KitchenRoll>("kitchen_roll", Class::Paper, Place::OnSurface, &[Kitchen]),
    family::<WasteBin>("waste_bin", Class::OtherFurniture, Place::Corner, &[Kitchen, Study, Bathroom]),
    // Dining.
    family::<LongTable>("long_table", Class::Table, Place::Free, &[Dining, Kitchen]),
    family::<SpindleChair>("spindle_chair", Class::Chair, Place::Free, &[Dining, Kitchen, Study]),
    family::<UpholsteredChair>("upholstered_chair", Class::Chair, Place::Free, &[Dining, Living, Study, Bedroom]),
    family::<ShellChair>("shell_chair", Class::Chair, Place::Free, &[Dining, Kitchen, Study, Children]),
    family::<DiningBench>("dining_bench", Class::OtherFurniture, Place::Free, &[Dining, Kitchen]),
    family::<BarStool>("bar_stool", Class::Chair, Place::Free, &[Kitchen]),
    family::<Sideboard>("sideboard", Class::Cabinet, Place::AgainstWall, &[Dining, Living, Hall]),
    family::<GlassCabinet>("glass_cabinet", Class::Cabinet, Place::AgainstWall, &[Dining, Living]),
    // Study.
    family::<Desk>("desk", Class::Desk, Place::AgainstWall, &[Study, Children, Bedroom]),
    family::<OfficeChair>("office_chair", Class::Chair, Place::Free, &[Study, Children]),
    family::<Monitor>("monitor", Class::OtherProp, Place::OnSurface, &[Study]),
    family::<Keyboard>("keyboard", Class::OtherProp, Place::OnSurface, &[Study]),
    family::<Mouse>("mouse", Class::OtherProp, Place::OnSurface, &[Study]),
    family::<Laptop>("laptop", Class::OtherProp, Place::OnSurface, &[Study, Living, Dining, Bedroom]),
    family::<Printer>("printer", Class::OtherProp, Place::OnSurface, &[Study]),
    family::<DeskLamp>("desk_lamp", Class::Lamp, Place::OnSurface, &[Study, Children, Bedroom]),
    family::<PaperStack>("paper", Class::Paper, Place::OnSurface, &[Study]),
    family::<PenCup>("pen_cup", Class::OtherProp, Place::OnSurface, &[Study, Children]),
    family::<FilingCabinet>("filing_cabinet", Class::Cabinet, Place::AgainstWall, &[Study]),
    Family {
        random: |rng| Box::new(WallBoard { cork: true, ..WallBoard::random(rng) }),
        ..family::<WallBoard>("pin_board", Class::OtherStructure, Place::OnWall, &[Study, Children, Kitchen])
    },
    Family {
        random: |rng| Box::new(WallBoard { cork: false, ..WallBoard::random(rng) }),
        ..family::<WallBoard>("whiteboard", Class::Whiteboard, Place::OnWall, &[Study, Children])
    },
    // Children.
    family::<Crib>("crib", Class::Bed, Place::AgainstWall, &[Children, Bedroom]),
    family::<PlayTable>("play_table", Class::Table, Place::Free, &[Children]),
    family::<ToyChair>("toy_chair", Class::Chair, Place::Free, &[Children]),
    family::<ToyChest>("toy_chest", Class::Box, Place::AgainstWall, &[Children]),
    family::<Toy>("toy", Class::OtherProp, Place::OnSurface, &[Children]),
    family::<PlushBear>("plush_toy", Class::OtherProp, Place::OnSurface, &[Children, Bedroom]),
    family::<Globe>("globe", Class::OtherProp, Place::OnSurface, &[Children, Study]),
    family::<Guitar>("guitar", Class::OtherProp, Place::Corner, &[Children, Living, Study, Bedroom]),
    family::<MusicKeyboard>("music_keyboard", Class::OtherFurniture, Place::AgainstWall, &[Children, Living, Study]),
    // More of the living room.
    family::<CornerSofa>("corner_sofa", Class::Sofa, Place::AgainstWall, &[Living]),
    family::<Chesterfield>("chesterfield", Class::Sofa, Place::AgainstWall, &[Living, Study]),
    Family {
        random: |rng| Box::new(Chesterfield { seats: 1, ..Chesterfield::random(rng) }),
        ..family::<Chesterfield>("club_chair", Class::Chair, Place::Free, &[Living, Study])
    },
    family::<DayBed>("day_bed", Class::Sofa, Place::AgainstWall, &[Living, Study]),
    family::<Pouf>("pouf", Class::OtherFurniture, Place::Free, &[Living, Bedroom, Children]),
    family::<FloorCushion>("floor_cushion", Class::Pillow, Place::Free, &[Living, Children]),
    family::<WallShelf>("wall_shelf", Class::Shelves, Place::OnWall, DWELLING),
    family::<CubeShelf>("cube_shelf", Class::Shelves, Place::AgainstWall, DWELLING),
    family::<Fireplace>("fireplace", Class::OtherStructure, Place::AgainstWall, &[Living]),
    family::<Stove>("stove", Class::OtherStructure, Place::AgainstWall, &[Living]),
    family::<Blind>("blind", Class::Blinds, Place::OnWall, ANY),
    family::<CeilingLamp>("ceiling_lamp", Class::Lamp, Place::Ceiling, ANY),
    family::<WallLamp>("wall_lamp", Class::Lamp, Place::OnWall, &[Living, Bedroom, Hall]),
    family::<WallClock>("wall_clock", Class::OtherProp, Place::OnWall, &[Living, Kitchen, Dining, Study, Hall]),
    family::<RecordPlayer>("record_player", Class::OtherProp, Place::OnSurface, &[Living]),
    family::<Speaker>("speaker", Class::OtherProp, Place::OnSurface, &[Living, Study]),
    Family {
        random: |rng| Box::new(Speaker::tall(rng)),
        ..family::<Speaker>("floor_speaker", Class::OtherProp, Place::AgainstWall, &[Living])
    },
    family::<GameConsole>("game_console", Class::OtherProp, Place::OnSurface, &[Living, Children]),
    family::<Foliage>("foliage", Class::OtherProp, Place::Corner, DWELLING),
    family::<HangingPlant>("hanging_plant", Class::OtherProp, Place::Ceiling, &[Living, Kitchen, Bedroom, Study]),
    family::<FlowerVase>("flower_vase", Class::OtherProp, Place::OnSurface, &[Living, Dining, Kitchen, Bedroom, Hall]),
    // Things that lie about.
    family::<BookRow>("book_row", Class::Books, Place::OnSurface, &[Living, Study, Children, Bedroom]),
    family::<OpenBook>("open_book", Class::Books, Place::OnSurface, &[Living, Study, Bedroom]),
    family::<MagazineRack>("magazine_rack", Class::OtherFurniture, Place::Free, &[Living]),
    family::<RemoteControl>("remote_control", Class::OtherProp, Place::OnSurface, &[Living]),
    family::<Phone>("phone", Class::OtherProp, Place::OnSurface, DWELLING),
    family::<Tablet>("tablet", Class::OtherProp, Place::OnSurface, DWELLING),
    family::<Cable>("cable", Class::OtherProp, Place::OnSurface, &[Study, Living]),
    family::<TissueBox>("tissue_box", Class::Box, Place::OnSurface, &[Living, Bedroom, Study, Bathroom]),
    family::<StorageBasket>("storage_basket", Class::OtherProp, Place::OnSurface, ANY),
    family::<PhotoFrame>("photo_frame", Class::Picture, Place::OnSurface, &[Living, Bedroom, Study, Hall]),
    family::<PillarCandles>("candle", Class::OtherProp, Place::OnSurface, &[Living, Dining, Bathroom]),
    family::<Figurine>("figurine", Class::OtherProp, Place::OnSurface, &[Living, Study, Hall]),
    family::<BoardGame>("board_game", Class::Box, Place::OnSurface, &[Living, Children]),
    family::<FoldedBlanket>("folded_blanket", Class::OtherProp, Place::OnSurface, &[Living, Bedroom]),
    family::<ScatterCushion>("cushion", Class::Pillow, Place::OnSurface, &[Living, Bedroom]),
    // Offices, and what public buildings share.
    family::<CeilingPanel>("ceiling_panel", Class::Lamp, Place::Ceiling, WORK),
    family::<TubeLamp>("tube_lamp", Class::Lamp, Place::Ceiling, WORK),
    family::<Partition>("partition", Class::OtherStructure, Place::Free, &[OpenOffice]),
    family::<OfficeCabinet>("office_cabinet", Class::Cabinet, Place::AgainstWall, &[Office, OpenOffice, Classroom, Meeting]),
    Family {
        random: |rng| Box::new(OfficeCabinet::open(rng)),
        ..family::<OfficeCabinet>("binder_shelf", Class::Shelves, Place::AgainstWall, &[Office, OpenOffice])
    },
    family::<ConferenceTable>("conference_table", Class::Table, Place::Free, &[Meeting]),
    family::<WallDisplay>("wall_display", Class::Television, Place::OnWall, &[Meeting, Reception]),
    family::<ProjectionScreen>("projection_screen", Class::OtherStructure, Place::OnWall, &[Meeting, Classroom, ComputerLab]),
    family::<Projector>("projector", Class::OtherProp, Place::Ceiling, &[Meeting, Classroom, ComputerLab]),
    family::<Copier>("copier", Class::OtherProp, Place::AgainstWall, &[OpenOffice, Library]),
    family::<WaterDispenser>("water_dispenser", Class::OtherProp, Place::AgainstWall, &[OpenOffice, Corridor, Reception]),
    family::<ComputerCase>("computer_case", Class::OtherProp, Place::Free, &[ComputerLab]),
    family::<Extinguisher>("fire_extinguisher", Class::OtherProp, Place::OnWall, WORK),
    family::<ExitSign>("exit_sign", Class::OtherProp, Place::OnWall, &[Corridor]),
    // Schools.
    family::<StackingChair>("stacking_chair", Class::Chair, Place::Free, &[Classroom, Meeting, Office, Cafe, Library, Reception]),
    family::<StudentDesk>("student_desk", Class::Desk, Place::Free, &[Classroom, Library]),
    family::<ClassBoard>("class_board", Class::Whiteboard, Place::OnWall, &[Classroom, Meeting]),
    family::<Lockers>("lockers", Class::Cabinet, Place::AgainstWall, &[Corridor]),
    // Shops, cafés and libraries.
    family::<Gondola>("gondola", Class::Shelves, Place::Free, &[Shop]),
    family::<BookAisle>("book_aisle", Class::Bookshelf, Place::Free, &[Library, Bookshop]),
    family::<Counter>("counter", Class::Counter, Place::Free, &[Shop, Cafe, Bookshop, Reception, Library]),
    family::<Till>("till", Class::OtherProp, Place::OnSurface, &[Shop]),
    family::<EspressoMachine>("espresso_machine", Class::OtherProp, Place::OnSurface, &[Cafe]),
    family::<CakeCase>("cake_case", Class::OtherProp, Place::OnSurface, &[Cafe]),
    family::<ClothesRail>("clothes_rail", Class::OtherFurniture, Place::Free, &[Shop]),
    family::<BottleFridge>("bottle_fridge", Class::Refrigerator, Place::AgainstWall, &[Shop, Cafe]),
    family::<DisplayTable>("display_table", Class::Table, Place::Free, &[Shop, Bookshop]),
    family::<BistroTable>("bistro_table", Class::Table, Place::Free, &[Cafe]),
    // Gyms.
    family::<Treadmill>("treadmill", Class::OtherFurniture, Place::AgainstWall, &[Gym]),
    family::<ExerciseBike>("exercise_bike", Class::OtherFurniture, Place::AgainstWall, &[Gym]),
    family::<WeightBench>("weight_bench", Class::OtherFurniture, Place::Free, &[Gym]),
    family::<DumbbellRack>("dumbbell_rack", Class::OtherFurniture, Place::AgainstWall, &[Gym]),
    family::<ExerciseMat>("exercise_mat", Class::FloorMat, Place::Underfoot, &[Gym]),
    family::<ExerciseBall>("exercise_ball", Class::OtherProp, Place::Corner, &[Gym]),
    family::<MirrorWall>("mirror_wall", Class::Mirror, Place::OnWall, &[Gym]),
    // Storerooms and workshops.
    family::<SteelRack>("steel_rack", Class::Shelves, Place::AgainstWall, &[Storeroom, Workshop]),
    family::<Workbench>("workbench", Class::Table, Place::AgainstWall, &[Workshop]),
    family::<ToolBoard>("tool_board", Class::OtherProp, Place::OnWall, &[Workshop]),
    family::<StepLadder>("step_ladder", Class::OtherProp, Place::Free, &[Storeroom, Workshop]),
];

/// The family of this name.
pub fn family_named(name: &str) -> Option<&'static Family> {
    FAMILIES.iter().find(|f| f.name == name)
}
