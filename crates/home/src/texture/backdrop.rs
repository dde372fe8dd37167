//! What stands outside the window: trees and grass painted into the sky's picture.

use super::noise::{fbm, smoothstep};
use enfilade_math::{Rgb, Vec2, Vec3};
use enfilade_scene::{Image, Pixels, direction_from_uv};
use rayon::prelude::*;
use std::f32::consts::{PI, TAU};

/// Paints a garden with trees over the lower part of an equirectangular sky.
///
/// `world_from_map` turns the map's directions into the world's, `irradiance` is that of the sun and sky together on level ground in
/// the units of the picture. Directions that face away from `outward`, the way out of the window, become black: no light from
/// there can enter a room whose only opening is that window, and a renderer need not look for any.
pub fn paint_surroundings(sky: &mut Image, world_from_map: impl Fn(Vec3) -> Vec3 + Sync, irradiance: Rgb, outward: Vec3, seed: u32) {
    let (width, height) = (sky.width, sky.height);
    let Pixels::RgbF32(texels) = &mut sky.pixels else { return };
    let diffuse = |albedo: Rgb| albedo * irradiance / PI;
    texels.par_iter_mut().enumerate().for_each(|(i, texel)| {
        let (x, y) = (i as u32 % width, i as u32 / width);
        let uv = Vec2::new((x as f32 + 0.5) / width as f32, (y as f32 + 0.5) / height as f32);
        let d = world_from_map(direction_from_uv(uv));
        if d.dot(outward) < -0.03 {
            *texel = [0.0; 3];
            return;
        }
        if d.z > 0.35 {
            return;
        }
        let azimuth = d.y.atan2(d.x) / TAU + 0.5;
        let elevation = d.z.asin().to_degrees();
        let place = Vec2::new(azimuth, elevation / 180.0 + 0.5);
        let mut color = Rgb::from(*texel);
        let haze = color;
        for (layer, (height, depth)) in [(7.0, 0.55), (10.0, 0.25), (5.0, 0.0)].into_iter().enumerate() {
            let own = seed ^ (layer as u32 * 77 + 5);
            let crown = height * (0.75 + 0.55 * fbm(Vec2::new(azimuth, 0.3), [9 + 7 * layer as i32, 2], 5, own));
            let clump = fbm(place, [56, 28], 4, own ^ 3);
            let lit = (0.55 + 0.4 * clump + 0.25 * smoothstep(0.0, crown.max(1.0), elevation)).max(0.12);
            let leaves = Rgb::new(0.065, 0.095, 0.027).lerp(Rgb::new(0.10, 0.11, 0.04), 0.5 + 0.5 * fbm(place, [24, 12], 2, own ^ 9));
            let tree = diffuse(leaves * lit).lerp(haze, depth);
            color = color.lerp(tree, smoothstep(-0.5, 0.9, crown + 1.4 * clump - elevation));
        }
        let grass = diffuse(Rgb::new(0.075, 0.10, 0.036) * (1.0 + 0.3 * fbm(place, [40, 80], 4, seed ^ 2)));
        color = color.lerp(grass, smoothstep(-0.8, -2.6, elevation));
        *texel = color.to_array();
    });
}
