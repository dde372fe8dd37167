//! Other textures for the materials of a class: the table of what each class comes in.
//!
//! The textures are those of generated homes, in colours of the variation.

use super::groups::{Group, Wooden};
use super::mapping::Mapping;
use super::oklab::Oklch;
use super::palette::{Made, draw};
use super::recolor::is_cut;
use crate::config::ColorRange;
use enfilade_furniture::{DecorConfig, Finish, Materials, Palette};
use enfilade_math::{Rgb, Rng};
use enfilade_scene::{Bsdf, Material, Scene};
use enfilade_textures::{Pattern, WoodTone};

/// Least area of a group that gets another texture, square metres: handles, feet and buttons keep their own.
const LEAST_M2: f32 = 0.25;

/// A texture that a class may have.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// Probability among those of the class.
    share: f64,
    /// Name in records.
    pub name: &'static str,
    /// The surface of homes that it is.
    finish: Finish,
    /// How it lies on the parts.
    pub mapping: Mapping,
    /// What its colours are those of; what the class is made of unless given.
    made: Option<Made>,
}

const fn look(share: f64, name: &'static str, finish: Finish, mapping: Mapping, made: Option<Made>) -> Look {
    Look { share, name, finish, mapping, made }
}

const PLAIN: Mapping = Mapping::Upright;
const GRAIN: Mapping = Mapping::Grain;
const WOOD: Option<Made> = Some(Made::Wood);
const LEATHER: Option<Made> = Some(Made::Leather);

const WALLS: [Look; 4] = [
    look(0.45, "rolled paint", Finish::WallPaint, PLAIN, None),
    look(0.25, "lime plaster", Finish::Plaster, PLAIN, None),
    look(0.22, "wallpaper", Finish::Wallpaper, PLAIN, None),
    look(0.08, "brick", Finish::Brick, PLAIN, Some(Made::Brick)),
];
const CEILINGS: [Look; 2] =
    [look(0.85, "rolled paint", Finish::CeilingPaint, PLAIN, None), look(0.15, "lime plaster", Finish::Plaster, PLAIN, None)];
const FLOORS: [Look; 6] = [
    look(0.35, "planks", Finish::PlankFloor, GRAIN, WOOD),
    look(0.15, "herringbone parquet", Finish::ParquetFloor, PLAIN, WOOD),
    look(0.2, "tiles", Finish::FloorTile, PLAIN, None),
    look(0.05, "terrazzo", Finish::Terrazzo, PLAIN, None),
    look(0.07, "concrete", Finish::Concrete, PLAIN, None),
    look(0.18, "carpet", Finish::Carpet, PLAIN, None),
];
const VENEERS: [Look; 1] = [look(1.0, "veneer", Finish::Wood, GRAIN, WOOD)];
const FRONTS: [Look; 2] = [look(0.7, "veneer", Finish::Wood, GRAIN, WOOD), look(0.3, "lacquer", Finish::ColoredLacquer(0), PLAIN, None)];
const SEATS: [Look; 4] = [
    look(0.45, "upholstery", Finish::SofaCloth, PLAIN, None),
    look(0.15, "boucle", Finish::Boucle, PLAIN, None),
    look(0.2, "velvet", Finish::Velvet, PLAIN, None),
    look(0.2, "leather", Finish::Leather, PLAIN, LEATHER),
];
const BEDDING: [Look; 3] = [
    look(0.45, "linen", Finish::CurtainLinen, PLAIN, None),
    look(0.4, "patterned cotton", Finish::BedLinen(1), PLAIN, None),
    look(0.15, "knit", Finish::KnittedThrow, PLAIN, None),
];
const CURTAINS: [Look; 3] = [
    look(0.6, "linen", Finish::CurtainLinen, PLAIN, None),
    look(0.2, "velvet", Finish::Velvet, PLAIN, None),
    look(0.2, "patterned cotton", Finish::BedLinen(1), PLAIN, None),
];
const RUGS: [Look; 3] = [
    look(0.5, "patterned rug", Finish::RugWool, Mapping::Whole, None),
    look(0.35, "carpet", Finish::Carpet, PLAIN, None),
    look(0.15, "felt", Finish::Felt, PLAIN, None),
];
const TOWELS: [Look; 1] = [look(1.0, "terry", Finish::Towel(1), PLAIN, None)];
const BAGS: [Look; 2] = [look(0.5, "leather", Finish::Leather, PLAIN, LEATHER), look(0.5, "felt", Finish::Felt, PLAIN, None)];
const CLOTHES: [Look; 1] = [look(1.0, "twill", Finish::Clothes(9), PLAIN, None)];

/// The textures of a class; none for classes that only change their colours.
fn looks(group: &Group, wooden: Wooden) -> &'static [Look] {
    match (group.class, group.made) {
        ("floor", _) => &FLOORS,
        ("wall", Made::Wall) => &WALLS,
        (_, Made::Ceiling) => &CEILINGS,
        // A brown chair may be of leather.
        ("chair" | "bed", Made::Wood) if wooden == Wooden::Brown => &[],
        (_, Made::Wood) => &VENEERS,
        (_, Made::Joinery | Made::Door) => &FRONTS,
        ("sofa" | "chair", _) => &SEATS,
        ("bed" | "pillow", _) => &BEDDING,
        ("curtain", _) => &CURTAINS,
        ("floormat", _) => &RUGS,
        ("towel", _) => &TOWELS,
        ("bag", _) => &BAGS,
        ("clothes", _) => &CLOTHES,
        _ => &[],
    }
}

/// Whether a material can have another texture: a plain opaque body, none of whose holes are in a picture.
fn may_change(material: &Material) -> bool {
    let is_body = matches!(
        material.bsdf,
        Bsdf::Diffuse { .. } | Bsdf::RoughDiffuse { .. } | Bsdf::Plastic { .. } | Bsdf::Principled(_) | Bsdf::Disney(_)
    );
    is_body && !is_cut(material)
}

/// A texture for a group, drawn from those of its class; `None` where its class or its material has none.
pub fn choose(group: &Group, material: &Material, wooden: Wooden, rng: &mut Rng) -> Option<&'static Look> {
    let looks = looks(group, wooden);
    if group.area_m2 < LEAST_M2 || looks.is_empty() || !may_change(material) {
        return None;
    }
    let place = rng.next_f64();
    let mut end = 0.0;
    let found = looks.iter().find(|look| {
        end += look.share;
        place < end
    });
    found.or(looks.last())
}

impl Look {
    /// What its colours are those of, on something made of `made`.
    pub fn made(&self, made: Made) -> Made {
        // Boards that become tiles have the colours of floors.
        self.made.unwrap_or(if made == Made::Wood { Made::Floor } else { made })
    }

    /// The surface in about the colour `target`, with a figure, where it has one, in another one of the same table. `materials` makes it
    /// and adds its pictures to the scene, unless they are there.
    pub fn material(&self, scene: &mut Scene, materials: &mut Materials, made: Made, target: Rgb, rng: &Rng) -> Material {
        let colors = &mut rng.clone();
        let figure = draw(self.made(made), &ColorRange::default(), colors).rgb().map(|v| v.clamp(0.02, 0.8));
        materials.enter_room(palette(target.map(|v| v.clamp(0.02, 0.8)), figure, colors));
        // The material itself goes to the place of the one that it replaces.
        let count = scene.materials.len();
        let made = materials.get(scene, self.finish);
        let material = scene.materials[made as usize].clone();
        scene.materials.truncate(count);
        material
    }
}

/// Patterns of printed and woven cotton.
const PATTERNS: [Pattern; 6] = [Pattern::PinStripes, Pattern::Stripes, Pattern::Gingham, Pattern::Dots, Pattern::Sprigs, Pattern::Tartan];

/// The colours of a room in which everything is of about one colour.
fn palette(target: Rgb, figure: Rgb, rng: &mut Rng) -> Palette {
    let decor = DecorConfig { seed: rng.next_u64() >> 1, realism: 1.0 };
    let tone = nearest_wood(target);
    let pale = target.lerp(Rgb::splat(0.75), 0.6);
    let other = decor.palette();
    let mut art = other.art;
    // Lacquer, felt and clothes.
    art[3] = target;
    Palette {
        wall: target,
        accent_wall: target,
        floor: tone,
        wood: tone,
        sofa: target,
        armchair: target,
        rug: [target, figure],
        curtain: target,
        accents: [target, figure, target],
        linen: [target, if target.luminance() > 0.4 { figure } else { pale }],
        linen_pattern: PATTERNS[rng.below(PATTERNS.len())],
        leather: target,
        art,
        ..other
    }
}

/// The kind of wood whose colour is nearest: dark woods have other rings and pores than pale ones.
fn nearest_wood(target: Rgb) -> WoodTone {
    let target = Oklch::of(target);
    let away = |tone: &WoodTone| {
        let color = Oklch::of(tone.light.lerp(tone.dark, 0.4));
        (color.lightness - target.lightness).abs() + 0.002 * (color.hue_deg - target.hue_deg).abs()
    };
    WoodTone::ALL.into_iter().min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(WoodTone::OAK)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_every_class_add_up() {
        let tables: [&[Look]; 12] =
            [&WALLS, &CEILINGS, &FLOORS, &VENEERS, &FRONTS, &SEATS, &BEDDING, &CURTAINS, &RUGS, &TOWELS, &BAGS, &CLOTHES];
        for table in tables {
            assert!((table.iter().map(|look| look.share).sum::<f64>() - 1.0).abs() < 1e-9, "{table:?}");
        }
    }

    #[test]
    fn dark_walnut_and_pale_birch_are_found_by_their_colours() {
        let nearest = |tone: WoodTone| nearest_wood(tone.light.lerp(tone.dark, 0.4));
        assert!(WoodTone::ALL.into_iter().all(|tone| nearest(tone) == tone));
    }
}
