//! The surface that a camera ray shows where surfaces are partly transparent: one of them drawn by opacity, and the expected reflectance.
//!
//! All other rays draw for themselves ([`AlphaTest::Stochastic`](crate::prepared::AlphaTest)). A camera ray draws with a number that is
//! stratified over its pixel, and the stored reflectance, which no denoiser touches, has no noise from the draw at all: the illumination
//! has it instead.

use crate::prepared::RenderScene;
use crate::texture::Cone;
use enfilade_geometry::Hit;
use enfilade_math::{Ray, Rgb};
use std::cell::RefCell;

/// The surface that a camera ray shows.
pub(crate) struct Seen {
    /// The hit from which its path continues; `None` where it shows the background.
    pub hit: Option<Hit>,
    /// The expected value of the diffuse reflectance there, which is zero for the background; `None` where there is nothing to draw.
    pub reflectance: Option<Rgb>,
}

impl RenderScene<'_> {
    /// The surface that a camera ray with the cone `cone` at its origin shows. `number`, uniform on [0,1), decides where there is something
    /// to draw.
    pub(crate) fn seen(&self, ray: &Ray, cone: &Cone, number: impl FnOnce() -> f32) -> Seen {
        // Find the first surface that is all there, and the others before it.
        let partly = RefCell::new(Vec::new());
        let whole = self.bvh.closest_filtered(ray, |hit| {
            let opacity = self.opacity(hit);
            if opacity > 0.0 && opacity < 1.0 {
                partly.borrow_mut().push((*hit, opacity));
            }
            opacity >= 1.0
        });
        let mut partly = partly.into_inner();
        if let Some(whole) = &whole {
            partly.retain(|(hit, _)| hit.t < whole.t);
        }
        if partly.is_empty() {
            return Seen { hit: whole, reflectance: None };
        }

        // Go through them from near to far, with the share of rays that get as far as each.
        partly.sort_by(|(a, _), (b, _)| a.t.total_cmp(&b.t).then(a.triangle.cmp(&b.triangle)));
        partly.extend(whole.map(|hit| (hit, 1.0)));
        let number = number();
        let mut seen = Seen { hit: None, reflectance: None };
        let (mut expected, mut left) = (Rgb::BLACK, 1.0);
        for (hit, opacity) in partly {
            let beyond = left * (1.0 - opacity);
            expected += self.surface(&hit, ray.direction, cone).bsdf(self).reflectance * (left - beyond);
            if number >= beyond && seen.hit.is_none() {
                seen.hit = Some(hit);
            }
            left = beyond;
        }
        seen.reflectance = Some(expected);
        seen
    }
}
