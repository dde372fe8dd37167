//! A model of a library as a piece of furniture: it is placed like ours, carries things, and gives as much light.

use crate::builder::{Builder, Class};
use crate::lamplight::Glow;
use crate::models::{Body, BodyPart, Model};
use crate::pieces::{FAMILIES, Family, Furniture, Place, Surface, family_named};
use crate::shape::{Reshape, sphere};
use enfilade_math::{DAffine3, Rng, Vec3};
use std::sync::Arc;

/// Classes of the things that people put others on.
const CARRY: [Class; 8] =
    [Class::Table, Class::Desk, Class::Cabinet, Class::Dresser, Class::NightStand, Class::Bookshelf, Class::Shelves, Class::Counter];

/// Nobody puts small things on what is higher, metres.
const REACHED: f32 = 1.6;

/// A model of a library in place of one of our own.
#[derive(Clone, Debug)]
pub struct Borrowed {
    /// The number of the model in the library, so that its meshes are stored once.
    pub number: usize,
    /// The model.
    pub model: Arc<Model>,
    /// The family that it replaces a piece of.
    pub family: &'static Family,
    /// Free depth before it, as our own wants.
    pub reach: f32,
}

impl Borrowed {
    /// From the model's space, on whose floor it stands, to the space of its place.
    fn lift(&self) -> Vec3 {
        let size = self.model.size;
        match self.family.place {
            Place::OnWall => Vec3::new(0.0, 0.5 * size.y, -0.5 * size.z),
            Place::Ceiling => Vec3::new(0.0, 0.0, -size.z),
            Place::AgainstWall => Vec3::new(0.0, 0.0, self.model.elevation),
            Place::Free | Place::Corner | Place::OnSurface | Place::Underfoot => Vec3::ZERO,
        }
    }

    /// The light of a whole lamp of its family, as ours give it.
    fn glow(&self) -> Glow {
        match self.family.name {
            "ceiling_panel" | "tube_lamp" => Glow::WORK,
            "ceiling_lamp" => Glow::CEILING,
            "pendant" | "floor_lamp" | "table_lamp" => Glow::WITH_SHADE,
            _ => Glow::BULB,
        }
    }
}

impl Furniture for Borrowed {
    /// A plain block: there is no model to draw at random.
    fn random(rng: &mut Rng) -> Self {
        let size = Vec3::new(rng.range(0.3, 0.6), rng.range(0.3, 0.6), rng.range(0.3, 0.6));
        let family = family_named("storage_box").unwrap_or(&FAMILIES[0]);
        let model = Model::new("block".into(), size, vec![family.name], Box::new(move || Body::block(size).map(Arc::new)));
        Self { number: usize::MAX, model: Arc::new(model), family, reach: 0.0 }
    }

    fn size(&self) -> Vec3 {
        let lifted = if self.family.place == Place::AgainstWall { self.model.elevation } else { 0.0 };
        self.model.size + Vec3::new(0.0, 0.0, lifted)
    }

    fn reach(&self) -> f32 {
        self.reach
    }

    fn surfaces(&self) -> Vec<Surface> {
        let (lift, body) = (self.lift(), self.model.body().ok().filter(|_| CARRY.contains(&self.family.class)));
        let raised = |s: &Surface| Surface { min: s.min + lift.truncate(), max: s.max + lift.truncate(), z: s.z + lift.z, ..*s };
        body.map_or_else(Vec::new, |body| body.surfaces().iter().map(raised).filter(|s| s.z < REACHED).collect())
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _: &mut Rng) {
        let Ok(body) = self.model.body() else { return };
        let object = b.object(self.family.name, self.family.class, pose * DAffine3::from_translation(self.lift().as_dvec3()));
        let lamp = self.family.class == Class::Lamp;
        let shining = |part: &BodyPart| lamp && body.shines(part);
        let lights = body.bulbs.len() + body.parts.iter().filter(|part| shining(part)).count();
        let glow = self.glow();
        let each = Glow { lumens: glow.lumens / lights.max(1) as f32, ..glow };
        let loaned = b.loan(&object, self.number, &self.model, body);
        for (part, mesh) in body.parts.iter().zip(&loaned.meshes) {
            if shining(part) {
                b.glow(&object, &part.name, part.mesh.clone(), each);
            } else {
                b.loaned_part(&object, &part.name, *mesh, loaned.materials[part.material]);
            }
        }
        for (k, bulb) in body.bulbs.iter().enumerate() {
            b.glow(&object, &format!("light source {}", k + 1), sphere(0.5 * bulb.diameter, 12).moved(bulb.at), each);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lamplight::LampLight;
    use crate::materials::Materials;
    use crate::models::Bulb;
    use crate::names::object_of;
    use crate::palette::Palette;
    use crate::shape::bevelled_box;
    use enfilade_math::{Bounds3, DMat3, Rgb};
    use enfilade_scene::{Bsdf, ColorParam, Image, Material, Part, Pixels, Scene, TextureRef};
    use std::collections::BTreeMap;

    /// A box with a picture on it, its front toward −y.
    fn body(size: Vec3) -> Result<Body, String> {
        let skin = ColorParam { factor: Rgb::WHITE, texture: Some(TextureRef::new(0)) };
        let scene = Scene {
            meshes: vec![bevelled_box(size, 0.0).into()],
            parts: vec![Part { name: "body".into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY }],
            materials: vec![Material::new("skin", Bsdf::Diffuse { reflectance: skin })],
            images: vec![Image { name: "skin".into(), width: 1, height: 1, pixels: Pixels::RgbF32(vec![[0.5; 3]]) }.into()],
            ..Scene::default()
        };
        Body::new(scene, DMat3::from_rotation_z(std::f64::consts::PI), None)
    }

    #[test]
    fn models_hang_stand_and_share_their_pictures() {
        let mut b = Builder::new(Materials::new(Palette::all()[0], LampLight::default(), Rng::new(1)));
        let size = Vec3::new(0.6, 0.2, 0.4);
        let model = Arc::new(Model::new("thing".into(), size, vec!["mirror_cabinet"], Box::new(move || body(size).map(Arc::new))));
        for name in ["mirror_cabinet", "nightstand", "pendant", "nightstand"] {
            let family = family_named(name).unwrap();
            let thing = Borrowed { number: 7, model: Arc::clone(&model), family, reach: 0.0 };
            thing.build(&mut b, DAffine3::IDENTITY, &mut Rng::new(1));
            assert_eq!(thing.surfaces().len(), usize::from(name != "pendant"), "{name}");
        }
        assert_eq!(b.models().len(), 4);
        let (scene, labels) = b.finish();
        assert_eq!((scene.parts.len(), scene.meshes.len(), scene.materials.len(), scene.images.len()), (4, 1, 1, 1));
        assert_eq!(labels.parts.iter().map(|l| l.semantic).collect::<Vec<_>>(), [3, 32, 35, 32]);
        assert_eq!(scene.validate(), Ok(()));
        for (part, name) in scene.parts.iter().zip(["mirror_cabinet", "nightstand", "pendant", "nightstand"]) {
            let filled = Bounds3::from_points(scene.world_positions(part));
            let expected = family_named(name).unwrap().place.bounds(size);
            assert!((filled.min - expected.min).abs().max_element() < 1e-5, "{name}: {filled:?}");
        }
    }

    /// The box with a bulb in it.
    fn lamp(size: Vec3) -> Result<Arc<Body>, String> {
        let mut body = body(size)?;
        body.bulbs.push(Bulb { at: 0.5 * size, diameter: 0.05 });
        Ok(Arc::new(body))
    }

    /// Luminous flux of each of these lamps, lumens, read from the names of its materials.
    fn lumens(lamps: impl IntoIterator<Item = Box<dyn Furniture>>) -> Vec<f32> {
        let mut b = Builder::new(Materials::new(Palette::all()[0], LampLight::default(), Rng::new(1)));
        lamps.into_iter().for_each(|lamp| lamp.build(&mut b, DAffine3::IDENTITY, &mut Rng::new(1)));
        let (scene, _) = b.finish();
        let mut sums: BTreeMap<&str, f32> = BTreeMap::new();
        for part in &scene.parts {
            let words = scene.materials[part.material as usize].name.split_once("lamp ");
            let given = words.and_then(|(_, rest)| rest.split(' ').next()?.parse::<f32>().ok());
            *sums.entry(object_of(&part.name)).or_default() += given.unwrap_or(0.0);
        }
        sums.into_values().collect()
    }

    #[test]
    fn lamps_give_as_much_light_as_ours() {
        let size = Vec3::splat(0.3);
        for family in FAMILIES.iter().filter(|family| family.class == Class::Lamp) {
            let ours = lumens((0..40).map(|seed| (family.random)(&mut Rng::new(seed))));
            let model = Arc::new(Model::new("lamp".into(), size, vec![family.name], Box::new(move || lamp(size))));
            let thing: Box<dyn Furniture> = Box::new(Borrowed { number: 7, model, family, reach: 0.0 });
            let [given] = lumens([thing])[..] else { panic!("{}: one lamp", family.name) };
            let (min, max) = ours.iter().fold((f32::INFINITY, 0.0f32), |(min, max), lm| (min.min(*lm), max.max(*lm)));
            assert!((min..=max).contains(&given), "{}: {given} lm, ours {min} to {max}", family.name);
            let shaded = ["pendant", "floor_lamp", "table_lamp"].contains(&family.name);
            assert!(!shaded || ours.contains(&given), "{}: {given} lm, ours {ours:?}", family.name);
        }
    }
}
