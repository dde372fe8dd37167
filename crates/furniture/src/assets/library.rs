//! The models of a library by family, and the choice of one to replace a piece of furniture.

use super::range::believable;
use crate::builder::Class;
use crate::models::Model;
use crate::pieces::{FAMILIES, Family, family_named};
use enfilade_math::{Rng, Vec3};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Mutex, PoisonError};

/// Why nobody knows what a model is.
const NAMELESS: &str = "its name does not tell what it is";

/// The models that a home may have; none by default.
#[derive(Debug, Default)]
pub struct Library {
    /// By family, each with its number.
    models: BTreeMap<&'static str, Vec<(usize, Arc<Model>)>>,
    share: f32,
    unfit: Vec<String>,
    broken: Mutex<Vec<String>>,
}

impl Library {
    /// A library of `models`, which are taken for `share` of the things for which one fits.
    pub fn new(models: Vec<Model>, share: f32) -> Self {
        let mut ranges: BTreeMap<&'static str, [Vec3; 2]> = BTreeMap::new();
        let mut library = Self { share, ..Self::default() };
        for (number, model) in models.into_iter().enumerate() {
            let model = Arc::new(model);
            let mut used = false;
            for family in FAMILIES.iter().filter(|family| model.families.contains(&family.name)) {
                let [low, high] = *ranges.entry(family.name).or_insert_with(|| believable(family));
                let lights = family.class != Class::Lamp || model.shines;
                if lights && model.size.cmpge(low).all() && model.size.cmple(high).all() {
                    library.models.entry(family.name).or_default().push((number, Arc::clone(&model)));
                    used = true;
                }
            }
            if !used {
                library.unfit.push(misfit(&model, &ranges));
            }
        }
        // Those whose name alone is missing come last: there are many, and most are not meant for homes.
        library.unfit.sort_by_key(|line| line.contains(NAMELESS));
        library
    }

    /// Number of different models that can be used.
    pub fn usable(&self) -> usize {
        let numbers: BTreeSet<usize> = self.models.values().flatten().map(|(number, _)| *number).collect();
        numbers.len()
    }

    /// The models that fit nowhere, and why.
    pub fn unfit(&self) -> &[String] {
        &self.unfit
    }

    /// Faults of models that were chosen but could not be used.
    pub fn broken(&self) -> Vec<String> {
        self.broken.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// A model of `family` of a size that `fits`, with its number; `None` leaves the family to our own. Without models of it no random
    /// number is drawn.
    pub fn pick(&self, family: &Family, fits: impl Fn(Vec3) -> bool, rng: &mut Rng) -> Option<(usize, Arc<Model>)> {
        let models = self.models.get(family.name)?;
        self.draw(models.iter().filter(|(_, model)| fits(model.size)).collect(), rng)
    }

    /// A fitting model, drawn by its weight; `None` where the drawing decides for no model.
    fn draw(&self, fitting: Vec<&(usize, Arc<Model>)>, rng: &mut Rng) -> Option<(usize, Arc<Model>)> {
        let total: f32 = fitting.iter().map(|(_, model)| model.weight).sum();
        if total <= 0.0 || rng.next_f32() >= self.share {
            return None;
        }
        let mut at = rng.range(0.0, total);
        let (number, model) = fitting.iter().find(|(_, model)| {
            at -= model.weight;
            at < 0.0
        })?;
        match model.body() {
            Ok(_) => Some((*number, Arc::clone(model))),
            Err(problem) => {
                let mut broken = self.broken.lock().unwrap_or_else(PoisonError::into_inner);
                if !broken.iter().any(|known| known == problem) {
                    broken.push(problem.to_string());
                }
                None
            }
        }
    }
}

/// Why a model fits nowhere.
fn misfit(model: &Model, ranges: &BTreeMap<&'static str, [Vec3; 2]>) -> String {
    let measures = |v: Vec3| format!("{:.2} x {:.2} x {:.2} m", v.x, v.y, v.z);
    let expected = model.families.iter().filter_map(|name| {
        let [low, high] = ranges.get(name)?;
        Some(format!("{name} from {} to {}", measures(*low), measures(*high)))
    });
    let expected: Vec<String> = expected.collect();
    let file = &model.file;
    let lamp = model.families.iter().any(|name| family_named(name).is_some_and(|family| family.class == Class::Lamp));
    let dark = if lamp && !model.shines { "; it has no light source and nothing that glows" } else { "" };
    if expected.is_empty() {
        return format!("{file}: {NAMELESS}; give it a family or class in assets.toml");
    }
    format!("{file}: {} fits none of: {}{dark}", measures(model.size), expected.join("; "))
}
