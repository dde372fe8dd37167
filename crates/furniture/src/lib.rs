//! Furniture: shapes and materials, and one file per family of things made from them.
//!
//! From the bottom up: [`shape`] makes meshes; [`Materials`] and [`Palette`] are what things are made of, [`LampLight`] is the brightness
//! of lights; `pieces` has one file per family of things, which [`FAMILIES`] lists; [`Builder`] names, labels and collects their parts.
//! [`models`] are things that others have made, from which [`assets`] takes those that may replace ours. [`meet`] and [`touch`] test
//! whether things run into each other; [`cloth`] falls on things and comes to rest.
//!
//! ```
//! use enfilade_furniture::{Builder, LampLight, Materials, Palette, family_named, pose};
//! use enfilade_math::Rng;
//!
//! let mut rng = Rng::new(7);
//! let mut builder = Builder::new(Materials::new(Palette::all()[0], LampLight::default(), rng.fork(1)));
//! let sofa = (family_named("sofa").unwrap().random)(&mut rng);
//! sofa.build(&mut builder, pose(0.0, 0.0, 0.0, 0.0), &mut rng);
//! let (scene, labels) = builder.finish();
//! assert!(scene.parts.iter().any(|part| part.name.starts_with("sofa_1/")));
//! assert_eq!(scene.parts.len(), labels.parts.len());
//! ```

pub mod assets;
mod builder;
pub mod cloth;
mod joint;
mod lamplight;
mod materials;
pub mod meet;
pub mod models;
mod names;
mod palette;
mod pieces;
mod room_kind;
pub mod shape;
mod surface;
pub mod touch;

pub use builder::{Builder, Class, Object, is_among, pose};
pub use joint::{Axis, Joint, JointKind, Jointed};
pub use lamplight::{Exposure, Glow, LampLight};
pub use materials::{CARPET_TILE_M, CEILING_TILE_M, Finish, Materials, Surfacing};
pub use names::{family_of, object_of};
pub use palette::{DecorConfig, Palette};
pub use pieces::bedroom::Bed;
pub use pieces::dining::{LongTable, ShellChair, SpindleChair, UpholsteredChair};
pub use pieces::gym;
pub use pieces::kitchen;
pub use pieces::left::left_thing;
pub use pieces::living::{Blind, BlindKind, CeilingLamp, CornerSofa};
pub use pieces::office;
pub use pieces::school;
pub use pieces::shop;
pub use pieces::store;
pub use pieces::study;
pub use pieces::{
    Armchair, Basket, BookStack, Bookshelf, Bowl, Candles, CeilingDome, Chair, CoffeeTable, Curtains, DiningTable, Door, FAMILIES, Family,
    FloorLamp, Furniture, Leaf, Magazines, Mirror, Mug, Passage, Pendant, PictureOnWall, Place, Plant, Radiator, Rug, SideTable, Socket,
    Switch, TableLamp, TelevisionBench, TelevisionSet, Tray, Vase, WallOpening, Window, board, family_named,
};
pub use room_kind::RoomKind;
pub use surface::{CONTACT, Surface, on};
