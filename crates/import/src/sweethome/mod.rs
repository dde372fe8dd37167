//! Homes (`.sh3d`) and furniture libraries (`.sh3f`, or `.zip`) of Sweet Home 3D.
//!
//! Both are archives, read in memory. A home is described by its `Home.xml`, which versions from 5.3 on write; the older form, Java
//! objects, is an error with the advice to save the home again. Lengths are centimetres, which [`crate::ImportOptions::meters_per_unit`]
//! multiplies; the plan's x is the world's x, and the plan's y, which runs down the plan, the world's −y.
//!
//! | element | what becomes of it |
//! |---|---|
//! | `wall` | `wall_<number>.left`, `.right` and `.top`, straight, round or sloping; corners of joined walls meet; side and top colours, pictures, shininess. Walls of upper levels reach down to the ceiling below |
//! | `baseboard` | `wall_<number>.left_baseboard`, `.right_baseboard`; what is not painted itself is painted as its wall |
//! | `doorOrWindow` | a piece, and a rectangular hole through the walls along it (`wallWidth`, `wallLeft`, `wallHeight`, `wallTop`) with jambs, sill and head. Other shapes of `cutOutShape` are cut as the rectangle around them, with a warning |
//! | `room` | `<name>.floor` and `<name>.ceiling`, single sheets; where floors overlap, the later room has the place; staircases open the floor above and the ceiling below them by their rectangle. Ceilings of the highest level have the height of the nearest wall |
//! | `level` | elevation, height, floor thickness; what is on hidden levels is left out |
//! | `pieceOfFurniture`, `light`, `shelfUnit`, `furnitureGroup` | `<name> (<catalogId>)`, with `.<material>` where a model has several parts; turned, pitched, rolled, mirrored, sized; whole colour or picture, and those of single materials (a transparent one hides its parts). Pictures run across the front and over the top of a piece, in centimetres; those of single materials follow the model's own texture coordinates, where it has them |
//! | `transformation` | parts on the hinge, rail or ball (`sweethome3d_opening_on_hinge_1` and similar) move; the size of the piece is that of the moved model. Lamps stay |
//! | models | OBJ with its materials and pictures, also within a further archive. Where a model is 3DS, Collada or LWS, broken or missing, it is replaced by a box of the piece's size, with a warning. Materials that no library defines, as those of many models that come with Sweet Home 3D, are what Java 3D, on which it is built, has under their names, else grey. Opaque parts named `sweethome3d_window_pane…` are thin glass, half of whose light takes their colour; those named `sweethome3d_window_mirror…` mirrors; those named `sweethome3d_light…` are not seen in a `light`, nor are lines |
//! | `lightSource` | a point light with the intensity of Sweet Home 3D's photographs: 5·π·power²·(255·colour)·(255·home's light) W/sr per cm² |
//! | `ceillingLightColor` | such a light 25 cm below the ceiling in the middle of each room, unless it is black |
//! | `environment` | the sky's colour from everywhere; the ground as a plane 20 m beyond the rooms, unless a level is below it |
//! | cameras | the visitor's, the stored ones, and the one above the home, in this order; fisheye and spherical lenses become pinholes |
//! | dropped with a warning | moved limbs of mannequins, pieces of kinds that are not known, camera paths, sky pictures and the sun; lines, dimensions and labels of the plan |
//!
//! What has neither colour nor picture has a reflectance of 0.8.
//!
//! A library becomes a scene with its pieces beside one another in rows, each named `<name> (<id>)`, under a white sky;
//! [`catalogue`] lists them for callers that want single ones. The format follows Sweet Home 3D's own reader,
//! `com.eteks.sweethome3d.io.DefaultFurnitureCatalog`:
//!
//! | key | meaning |
//! |---|---|
//! | `name#N`, `category#N`, `creator#N`, `license#N` | as named; `license` alone applies to all pieces |
//! | `model#N` | the model within the archive |
//! | `width#N`, `depth#N`, `height#N`, `elevation#N` | centimetres; the model is scaled to them |
//! | `modelRotation#N` | a matrix, row by row, that turns the model upright, its front toward +z |
//! | `lightSourceX#N`, `…Y`, `…Z`, `…Diameter` | lamps: centimetres from the left, the front and below |
//! | `doorOrWindow#N`, `staircaseCutOutShape#N` | what kind of piece it is |

mod catalogue;
mod home;
mod model;
mod opening;
mod outline;
mod paint;
mod piece;
mod plan;
mod properties;
mod room;
mod surface;
mod view;
mod wall;
mod xml;

use crate::archive::Archive;
use crate::assembly::Assembly;
use crate::{Format, ImportError, Imported, UpAxis};

pub(crate) use surface::{Hole, subtract, without_holes};

pub use catalogue::{CatalogueKind, CatalogueLight, CataloguePiece, catalogue};

const HOME: &str = "Home.xml";

/// Imports a home or a library of furniture.
pub(crate) fn load(mut assembly: Assembly) -> Result<Imported, ImportError> {
    let file = assembly.file().to_path_buf();
    let bytes = assembly.read_scene_file()?;
    let archive = Archive::new(&file, bytes).map_err(|e| assembly.malformed("whole file", format!("{e}; copy or save it again")))?;
    load_archive(&archive, assembly)
}

/// True for an archive with a home or a furniture library.
pub(crate) fn is_of_sweethome(archive: &Archive) -> bool {
    // A file `Home` at the top is a home of old.
    archive.find(HOME).is_some() || archive.find(catalogue::NAME).is_some() || archive.names().iter().any(|name| name == "Home")
}

/// Imports the home or the library of furniture that an archive holds.
pub(crate) fn load_archive(archive: &Archive, assembly: Assembly) -> Result<Imported, ImportError> {
    if let Some(entry) = archive.find(HOME) {
        let bytes = archive.read(entry).map_err(|e| assembly.malformed(HOME, format!("cannot be read ({e}); save the home again")))?;
        let text = crate::xml::xml_text(&bytes);
        return plan::load(&text, archive, assembly.inside(Format::SweetHome, UpAxis::Y, archive, entry));
    }
    if archive.find("Home").is_some() {
        let problem =
            "the home is stored as Java objects alone, as versions before 5.3 of Sweet Home 3D did; open it in a newer one and save it";
        return Err(assembly.malformed("Home", problem));
    }
    if let Some(entry) = archive.find(catalogue::NAME) {
        return catalogue::load(archive, assembly.inside(Format::SweetHome, UpAxis::Y, archive, entry));
    }
    let problem =
        "found neither Home.xml nor a furniture catalogue; expected a home (.sh3d) or a furniture library (.sh3f) of Sweet Home 3D";
    Err(assembly.malformed("whole file", problem))
}
