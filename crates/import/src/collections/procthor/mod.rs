//! Houses of ProcTHOR.
//!
//! Made from ProcTHOR's own code (`procthor/utils/types.py`, `generation/`, schema 1.0.0 and, with `boundingBox`, the one before) and
//! AI2-THOR's, which builds the houses in Unity (`ProceduralTools.cs`: which wall an opening is measured from, how objects are turned,
//! that `position` is the middle of the box around an object). Metres, y up, left-handed: x is mirrored, as Unity's glTF exporter does, so
//! that exported models fit.
//!
//! | in the file | what becomes of it |
//! |---|---|
//! | `rooms` | `<roomType> floor (<id>)` from `floorPolygon`, and a ceiling of that outline at the top of the room's walls |
//! | `walls` | `wall (<id>)` from the four corners of `polygon`, with the holes of doors and windows. The two sheets of a wall between rooms are 5 mm inside of their rooms, since Unity shows a sheet from its front alone. `empty` walls are left out |
//! | `doors`, `windows` | holes by `holePolygon` (or `boundingBox`), measured from the start of `wall0` and the end of `wall1`; frames and leaves where there is a model |
//! | `objects` and their `children` | the model `<assetId>.glb`, `.gltf` or `.obj` of a folder `procthor-assets`, `assets`, `models` or `objects` beside the house or in the three folders above, by the middle of its box; without a model a box of the size in `asset-database.json`, sought there too, with a warning that counts them; without that they are left out, with a warning that counts them |
//! | categories | the object type of `asset-database.json`, else what the object's `id` begins with |
//! | materials | `color` if it is stated, else plaster or wood of one colour: the pictures are within AI2-THOR |
//! | `proceduralParameters.lights` | point and directional lights; Unity's strength × colour as W/sr or W/m², because Unity states no unit |

pub(crate) mod house;
mod models;
mod shell;
mod space;

use super::json;
use super::objects::Objects;
use crate::assembly::Assembly;
use crate::{ImportError, Imported};
use enfilade_math::{DVec3, Rgb};
use enfilade_scene::Light;
use house::{House, Thing};
use models::Library;
use space::{MIRROR, turn};

/// Imports a house.
pub(super) fn load(bytes: &[u8], mut a: Assembly) -> Result<Imported, ImportError> {
    let file = a.file().to_path_buf();
    let house: House = json::parse(bytes, &file, "a house of ProcTHOR")?;
    let mut objects = Objects::default();
    house.rooms.report("rooms", &mut a);
    house.walls.report("walls", &mut a);
    house.doors.report("doors", &mut a);
    house.windows.report("windows", &mut a);
    house.objects.report("objects", &mut a);
    shell::add(&house, &mut objects, &mut a)?;
    let mut library = Library::beside(&file, &mut a)?;
    for opening in house.doors.iter().chain(&house.windows) {
        if let Some((middle, turn)) = shell::stand_of(opening, &house) {
            library.opening(opening, middle, turn, &mut objects, &mut a)?;
        }
    }
    let mut stack: Vec<&Thing> = house.objects.iter().rev().collect();
    while let Some(thing) = stack.pop() {
        thing.children.report(&format!("children of {}", thing.id), &mut a);
        library.thing(thing, &mut objects, &mut a)?;
        stack.extend(thing.children.iter().rev());
    }
    library.finish(&mut a);
    objects.finish(&mut a);
    add_lights(&house, &mut a);
    a.finish()
}

fn add_lights(house: &House, a: &mut Assembly) {
    let lights = house.parameters.as_ref().map_or(&[][..], |parameters| &parameters.lights);
    if let Some(parameters) = &house.parameters {
        parameters.lights.report("proceduralParameters.lights", a);
    }
    for lamp in lights {
        let color = lamp.rgb.map_or(DVec3::ONE, |c| DVec3::new(c.r, c.g, c.b)) * lamp.intensity.max(0.0);
        let [r, g, b] = color.as_vec3().to_array();
        let (name, strength) = (lamp.id.clone(), Rgb::new(r, g, b));
        if lamp.r#type.eq_ignore_ascii_case("directional") {
            let direction = (turn(lamp.rotation.unwrap_or_default()) * DVec3::Z * MIRROR).as_vec3();
            a.push_light(Light::Directional { name, direction, irradiance: strength, angular_radius_rad: 0.0 });
        } else {
            a.push_light(Light::Point { name, position: (lamp.position.point() * MIRROR).as_vec3(), intensity: strength });
        }
    }
    if !lights.is_empty() {
        a.warn("proceduralParameters.lights", "Unity's lights have no unit; their strengths were taken as W/sr and W/m²");
    }
}
