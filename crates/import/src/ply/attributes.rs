//! Means of what vertices and faces have beyond their geometry, by Mitsuba's names.
//!
//! `red green blue` and `r g b` are `vertex_color` (of faces `face_color`); `heat_0 heat_1 heat_2`, or `_x _y _z`, are `vertex_heat`,
//! `heat_r heat_g heat_b` are `vertex_heat_color`, and `heat_0` or `heat_1` alone is a number.

use super::header::Element;
use enfilade_math::{Rgb, linear_from_srgb};

/// Endings of the names of properties that belong together.
const ENDINGS: [[&str; 3]; 4] = [["_x", "_y", "_z"], ["_r", "_g", "_b"], ["_0", "_1", "_2"], ["_1", "_2", "_3"]];

/// Means by name.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Means(Vec<(String, Rgb)>);

impl Means {
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The mean of an attribute; a number is grey.
    pub(crate) fn get(&self, name: &str) -> Option<Rgb> {
        self.0.iter().find(|(known, _)| known == name).map(|(_, mean)| *mean)
    }
}

/// An element's attributes while its rows are read.
pub(super) struct Sums<'e> {
    element: &'e Element,
    /// Name, and the properties of red, green and blue.
    attributes: Vec<(String, [usize; 3])>,
    /// By property.
    sums: Vec<f64>,
}

impl<'e> Sums<'e> {
    /// `element` is `vertex` or `face`. Where they are not `wanted` there are none.
    pub(super) fn new(element: &'e Element, wanted: bool) -> Self {
        let at = |name: String| element.properties.iter().position(|p| p.name == name && p.list.is_none());
        let mut attributes = Vec::new();
        if !wanted {
            return Self { element, attributes, sums: Vec::new() };
        }
        for names in [["red", "green", "blue"], ["r", "g", "b"]] {
            if let [Some(r), Some(g), Some(b)] = names.map(|n| at(n.to_string())) {
                attributes.push((format!("{}_color", element.name), [r, g, b]));
            }
        }
        for [first, second, third] in ENDINGS {
            for (i, property) in element.properties.iter().enumerate().filter(|(_, p)| p.list.is_none()) {
                let Some(stem) = property.name.strip_suffix(first).filter(|stem| !stem.is_empty()) else { continue };
                let suffix = if first == "_r" { "_color" } else { "" };
                let [g, b] = [second, third].map(|ending| at(format!("{stem}{ending}")));
                attributes.push((format!("{}_{stem}{suffix}", element.name), [i, g.unwrap_or(i), b.or(g).unwrap_or(i)]));
            }
        }
        Self { element, attributes, sums: vec![0.0; element.properties.len()] }
    }

    /// Adds the value of a property. Whole numbers are encoded in sRGB, as Mitsuba has them.
    pub(super) fn add(&mut self, property: usize, value: f64) {
        if !self.attributes.is_empty() {
            let full = self.element.properties[property].kind.full();
            self.sums[property] += if full > 1.0 { f64::from(linear_from_srgb((value / full) as f32)) } else { value };
        }
    }

    /// The means, added to those of other elements.
    pub(super) fn finish(self, means: &mut Means) {
        let mean = |i: usize| (self.sums[i] / self.element.count.max(1) as f64) as f32;
        for (name, rgb) in &self.attributes {
            let mean = Rgb::from(rgb.map(mean));
            if [mean.r, mean.g, mean.b].iter().all(|v| v.is_finite()) && means.get(name).is_none() {
                means.0.push((name.clone(), mean.map(|v| v.max(0.0))));
            }
        }
    }
}
