//! Gardens and open country: rings of trees, a lawn, hills with fields and woods.

use super::{Surroundings, View, hazed};
use enfilade_math::{Rgb, Vec2};
use enfilade_textures::noise::{fbm, smoothstep};

/// A ring of trees: how high they rise in degrees, how hazy they are, how many crowns there are around the full circle.
pub(super) struct Trees {
    pub height_deg: f32,
    pub depth: f32,
    pub crowns: i32,
    pub seed: u32,
}

impl Surroundings {
    pub(super) fn garden(&self, view: &View, sky: Rgb) -> Rgb {
        let mut color = sky;
        for (k, (height_deg, depth)) in [(9.0, 0.3), (12.0, 0.12), (6.0, 0.0)].into_iter().enumerate() {
            let trees = Trees { height_deg, depth, crowns: 9 + 7 * k as i32, seed: self.seed ^ (k as u32 * 77 + 5) };
            color = self.trees(view, color, &trees);
        }
        self.lawn(view, color)
    }

    pub(super) fn country(&self, view: &View, sky: Rgb) -> Rgb {
        let mut color = sky;
        for k in 0..4u32 {
            let depth = 0.66 - 0.19 * k as f32;
            let ridge =
                7.0 - 2.2 * k as f32 + (3.2 - 0.5 * k as f32) * fbm(Vec2::new(view.turn, 0.4), [4 + 3 * k as i32, 2], 5, self.seed ^ k);
            let place = Vec2::new(view.turn, view.elevation_deg / 60.0);
            // Fields and woods on the slopes.
            let wood = smoothstep(0.1, 0.3, fbm(place, [20 + 9 * k as i32, 30], 3, self.seed ^ (k + 40)));
            let field =
                Rgb::new(0.14, 0.16, 0.05).lerp(Rgb::new(0.24, 0.20, 0.10), 0.5 + 0.5 * fbm(place, [9, 14], 2, self.seed ^ (k + 60)));
            let slope = self.level(field.lerp(Rgb::new(0.045, 0.065, 0.025), wood)) * 0.8;
            color = color.lerp(hazed(slope, view.haze, depth), smoothstep(-0.06, 0.06, ridge - view.elevation_deg));
        }
        let hedge = Trees { height_deg: 1.2, depth: 0.08, crowns: 40, seed: self.seed ^ 91 };
        self.lawn(view, self.trees(view, color, &hedge))
    }

    /// Crowns over `behind`.
    pub(super) fn trees(&self, view: &View, behind: Rgb, trees: &Trees) -> Rgb {
        if view.elevation_deg > 2.2 * trees.height_deg + 4.0 {
            return behind;
        }
        let place = Vec2::new(view.turn, view.elevation_deg / 180.0 + 0.5);
        let crown = trees.height_deg * (0.75 + 0.6 * fbm(Vec2::new(view.turn, 0.3), [trees.crowns, 2], 5, trees.seed));
        let clump = fbm(place, [56, 28], 4, trees.seed ^ 3);
        let twigs = fbm(place, [230, 115], 2, trees.seed ^ 4);
        let lit = (0.55 + 0.4 * clump + 0.25 * twigs + 0.25 * smoothstep(0.0, crown.max(1.0), view.elevation_deg)).max(0.1);
        let tone = Rgb::new(0.065, 0.095, 0.027).lerp(Rgb::new(0.10, 0.11, 0.04), 0.5 + 0.5 * fbm(place, [24, 12], 2, trees.seed ^ 9));
        let tree = hazed(self.leaves(tone * lit), view.haze, trees.depth);
        behind.lerp(tree, smoothstep(-0.4, 0.7, crown + 1.4 * clump + 0.9 * twigs - view.elevation_deg))
    }

    /// Grass below the horizon.
    pub(super) fn lawn(&self, view: &View, behind: Rgb) -> Rgb {
        let place = Vec2::new(view.turn, view.elevation_deg / 180.0 + 0.5);
        let uneven = 1.0 + 0.25 * fbm(place, [40, 80], 4, self.seed ^ 2) + 0.12 * fbm(place, [300, 200], 2, self.seed ^ 8);
        let grass = self.level(Rgb::new(0.075, 0.10, 0.036) * uneven);
        behind.lerp(grass, smoothstep(-0.8, -2.6, view.elevation_deg))
    }
}
