//! Constant primvars: one value for all of a prim, inherited by the prims below it.

use super::primvar::{Primvar, Sizes};
use super::stage::Prim;
use super::value::Value;
use crate::assembly::Assembly;
use std::collections::HashMap;
use std::rc::Rc;

/// Longer values are not those of a colour.
const MAX_NUMBERS: usize = 4;

/// Values by the names of their primvars.
#[derive(Clone, Debug, Default)]
pub(super) struct Constants(Rc<HashMap<Rc<str>, Value>>);

impl Constants {
    /// Values that the prims below a prim inherit.
    pub(super) fn below(&self, prim: &Prim) -> Self {
        let mut all = self.clone();
        for name in prim.properties().iter().filter(|p| p.starts_with("primvars:") && !p.ends_with(":indices")) {
            let is_constant = prim.property(name, "interpolation").and_then(Value::as_text).unwrap_or("constant") == "constant";
            match prim.value(name) {
                Some(value @ Value::Numbers(n)) if is_constant && (1..=MAX_NUMBERS).contains(&n.data.len()) => {
                    Rc::make_mut(&mut all.0).insert(name.clone(), value.clone());
                }
                _ => (),
            }
        }
        all
    }

    /// Value of a prim's own primvar, its mean with a warning where it varies, or the inherited value.
    pub(super) fn value<const N: usize>(&self, prim: &Prim, name: &str, sizes: Sizes, a: &mut Assembly) -> Option<[f64; N]> {
        let Some(own) = Primvar::<N>::read(prim, name, "constant", sizes, a) else { return self.0.get(name)?.as_tuple() };
        if !own.is_constant() {
            let name = name.trim_start_matches("primvars:");
            a.warn(&prim.path, format!("its {name} varies over the surface; the mean was taken"));
        }
        Some(own.mean())
    }
}
