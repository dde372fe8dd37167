//! The tables that a material's lobes look things up in, made once per scene.

use super::coat::{Bounces, CoatSpec, CoatTable};
use super::energy::GlassTable;
use super::ggx;
use enfilade_scene::{Bsdf, Distribution, ScalarParam};
use std::sync::Arc;

/// The tables of one material.
#[derive(Clone, Debug, Default)]
pub struct Tables {
    /// The coat over its diffuse base.
    pub coat: Option<Arc<CoatTable>>,
    /// The border of its transparent body, where that is rough.
    pub glass: Option<Arc<GlassTable>>,
    /// Tables of the two materials that it blends, if it does.
    pub blended: Option<Box<[Tables; 2]>>,
    /// True where rough diffuse surfaces scatter by Lambert's law.
    pub lambertian: bool,
}

/// Makes tables, each kind once.
#[derive(Debug, Default)]
pub struct TableMaker {
    lambertian: bool,
    coats: Vec<Arc<CoatTable>>,
    glasses: Vec<Arc<GlassTable>>,
}

impl TableMaker {
    /// Tables for scenes whose rough diffuse surfaces scatter by Lambert's law.
    pub fn lambertian() -> Self {
        Self { lambertian: true, ..Self::default() }
    }

    /// The tables of a material.
    pub fn tables(&mut self, bsdf: &Bsdf) -> Tables {
        let square = |v: f32| v.clamp(0.0, 1.0).powi(2);
        match bsdf {
            Bsdf::Plastic { eta, alpha, .. } => {
                Tables { coat: self.coat(*eta, fixed(alpha), alpha.distribution, Bounces::Single), ..Tables::default() }
            }
            Bsdf::Dielectric { eta, alpha, .. } if alpha.distribution == Distribution::Ggx => {
                Tables { glass: self.glass(*eta, fixed(alpha)), ..Tables::default() }
            }
            Bsdf::Principled(p) => {
                let alpha = fixed(&p.roughness).map(square);
                let body = p.solid && p.transmission.factor > 0.0;
                Tables {
                    coat: self.coat(p.ior, alpha, Distribution::Ggx, Bounces::All),
                    glass: if body { self.glass(p.ior, alpha) } else { None },
                    ..Tables::default()
                }
            }
            Bsdf::Blend { first, second, .. } => {
                Tables { blended: Some(Box::new([self.tables(first), self.tables(second)])), ..Tables::default() }
            }
            Bsdf::RoughDiffuse { .. } => Tables { lambertian: self.lambertian, ..Tables::default() },
            Bsdf::Diffuse { .. } | Bsdf::Conductor { .. } | Bsdf::Dielectric { .. } | Bsdf::ThinDielectric { .. } | Bsdf::Disney(_) => {
                Tables::default()
            }
        }
    }

    /// An index of one or less is no coat.
    fn coat(&mut self, eta: f32, alpha: Option<f32>, distribution: Distribution, bounces: Bounces) -> Option<Arc<CoatTable>> {
        let spec = CoatSpec { eta, alpha, distribution, bounces };
        if eta.is_nan() || eta <= 1.0 {
            return None;
        }
        if let Some(known) = self.coats.iter().find(|t| t.spec() == spec) {
            return Some(Arc::clone(known));
        }
        let table = Arc::new(CoatTable::new(spec));
        self.coats.push(Arc::clone(&table));
        Some(table)
    }

    /// Smooth borders lose nothing.
    fn glass(&mut self, eta: f32, alpha: Option<f32>) -> Option<Arc<GlassTable>> {
        if alpha.is_some_and(|a| a < ggx::SMOOTH_ALPHA) {
            return None;
        }
        if let Some(known) = self.glasses.iter().find(|t| t.eta == eta) {
            return Some(Arc::clone(known));
        }
        let table = Arc::new(GlassTable::new(eta));
        self.glasses.push(Arc::clone(&table));
        Some(table)
    }
}

/// The value of a parameter that is the same everywhere.
fn fixed(p: &ScalarParam) -> Option<f32> {
    p.texture.is_none().then_some(p.factor)
}
