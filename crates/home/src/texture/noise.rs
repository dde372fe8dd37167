//! Smooth random functions of the plane.

use enfilade_math::{Vec2, hash_u32};

/// Uniform on [0,1) from a lattice point.
pub fn lattice(x: i32, y: i32, seed: u32) -> f32 {
    uniform(x, row(y, seed))
}

/// What the lattice points of a row have in common.
fn row(y: i32, seed: u32) -> u32 {
    hash_u32((y as u32).wrapping_add(seed.wrapping_mul(0x85eb_ca6b)))
}

fn uniform(x: i32, row: u32) -> f32 {
    (hash_u32((x as u32).wrapping_mul(0x9e37_79b1) ^ row) >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// Value noise on [−1,1] with features one unit apart; repeats after `period` units.
pub fn noise(p: Vec2, period: [i32; 2], seed: u32) -> f32 {
    // Rounds down, but for whole negative numbers, where the weight of one leads to the same value.
    let below = |v: f32| v as i32 - i32::from(v < 0.0);
    let cell = [below(p.x), below(p.y)];
    let f = p - Vec2::new(cell[0] as f32, cell[1] as f32);
    let w = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let wrap = |c: i32, n: i32| if (0..n).contains(&c) { c } else { c.rem_euclid(n) };
    let (x0, y0) = (wrap(cell[0], period[0]), wrap(cell[1], period[1]));
    let (x1, y1) = (wrap(x0 + 1, period[0]), wrap(y0 + 1, period[1]));
    let (row0, row1) = (row(y0, seed), row(y1, seed));
    let low = uniform(x0, row0) * (1.0 - w.x) + uniform(x1, row0) * w.x;
    let high = uniform(x0, row1) * (1.0 - w.x) + uniform(x1, row1) * w.x;
    2.0 * (low * (1.0 - w.y) + high * w.y) - 1.0
}

/// Sum of `octaves` of noise over the unit square, which it tiles: `cells` features across at first, twice as many at half the
/// strength each time. Roughly on [−1,1].
pub fn fbm(uv: Vec2, cells: [i32; 2], octaves: u32, seed: u32) -> f32 {
    let (mut sum, mut weight, mut total) = (0.0, 1.0, 0.0);
    let mut period = cells;
    for octave in 0..octaves {
        let p = uv * Vec2::new(period[0] as f32, period[1] as f32);
        sum += weight * noise(p, period, seed.wrapping_add(octave));
        total += weight;
        weight *= 0.5;
        period = period.map(|c| c * 2);
    }
    sum / total * 1.6
}

/// 0 below `low`, 1 above `high`, smooth between.
pub fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_tiles_the_unit_square() {
        for i in 0..50 {
            let v = i as f32 / 50.0;
            let seam = fbm(Vec2::new(0.0, v), [5, 3], 4, 7) - fbm(Vec2::new(1.0, v), [5, 3], 4, 7);
            assert!(seam.abs() < 1e-4, "{seam}");
        }
    }
}
