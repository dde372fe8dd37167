//! Smooth random functions of the plane.

use enfilade_math::{Vec2, hash_u32};

/// Uniform on [0,1) from a lattice point.
pub fn lattice(x: i32, y: i32, seed: u32) -> f32 {
    uniform(x, row(y, seed))
}

/// The hash that the lattice points of a row share.
fn row(y: i32, seed: u32) -> u32 {
    hash_u32((y as u32).wrapping_add(seed.wrapping_mul(0x85eb_ca6b)))
}

fn uniform(x: i32, row: u32) -> f32 {
    (hash_u32((x as u32).wrapping_mul(0x9e37_79b1) ^ row) >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// Value noise on [−1,1] with features one unit apart; repeats after `period` units.
pub fn noise(p: Vec2, period: [i32; 2], seed: u32) -> f32 {
    // Rounds down, except that whole negative numbers give one less; their weight is then one, which leads to the same value.
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

/// A smooth function of the unit square, kept as a table that is read quickly: for what varies slowly over a picture.
pub struct Field {
    side: usize,
    values: Vec<f32>,
}

impl Field {
    /// Tables `value`, which must tile the unit square, with `side` × `side` entries: at least five across its smallest feature.
    pub fn new(side: usize, value: impl Fn(Vec2) -> f32) -> Self {
        let at = |i: usize| Vec2::new((i % side) as f32, (i / side) as f32) / side as f32;
        Self { side, values: (0..side * side).map(|i| value(at(i))).collect() }
    }

    /// The value at a point of the plane.
    pub fn at(&self, uv: Vec2) -> f32 {
        let p = (uv - uv.floor()) * self.side as f32;
        let (x, y) = (p.x as usize % self.side, p.y as usize % self.side);
        let (x1, y1) = ((x + 1) % self.side, (y + 1) % self.side);
        let (fx, fy) = (p.x.fract(), p.y.fract());
        let row = |y: usize| self.values[y * self.side + x] * (1.0 - fx) + self.values[y * self.side + x1] * fx;
        row(y) * (1.0 - fy) + row(y1) * fy
    }
}

/// The nearest points of a jittered lattice.
#[derive(Clone, Copy, Debug)]
pub struct Near {
    /// Distance to the nearest point, in cells.
    pub first: f32,
    /// Distance to the next one.
    pub second: f32,
    /// Hash of the nearest point.
    pub id: u32,
}

/// The cell of `p` among one random point per unit cell (Worley 1996, "A cellular texture basis function"); repeats after `period`
/// units.
pub fn cells(p: Vec2, period: [i32; 2], seed: u32) -> Near {
    let (x, y) = (p.x.floor() as i32, p.y.floor() as i32);
    let f = p - Vec2::new(x as f32, y as f32);
    let mut near = Near { first: f32::MAX, second: f32::MAX, id: 0 };
    for dy in -1..=1 {
        let key = row((y + dy).rem_euclid(period[1]), seed);
        for dx in -1..=1 {
            let hash = hash_u32(((x + dx).rem_euclid(period[0]) as u32).wrapping_mul(0x9e37_79b1) ^ key);
            let at = Vec2::new((hash & 0xffff) as f32, (hash >> 16) as f32) * (1.0 / 65_536.0) + Vec2::new(dx as f32, dy as f32);
            let d = at.distance_squared(f);
            if d < near.first {
                near = Near { first: d, second: near.first, id: hash };
            } else if d < near.second {
                near.second = d;
            }
        }
    }
    Near { first: near.first.sqrt(), second: near.second.sqrt(), ..near }
}

/// 0 below `low`, 1 above `high`, smooth between; falling where `low` is above `high`.
pub fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_is_its_function_between_and_beyond_its_entries() {
        let value = |uv: Vec2| fbm(uv, [3, 2], 2, 9);
        let field = Field::new(64, value);
        for k in 0..500 {
            let uv = Vec2::new((k as f32 * 0.618).fract(), (k as f32 * 0.755).fract());
            assert!((field.at(uv) - value(uv)).abs() < 0.03 && (field.at(uv) - field.at(uv + Vec2::new(2.0, -1.0))).abs() < 1e-3);
        }
    }

    #[test]
    fn cells_tile_and_have_one_point_each() {
        let mut ids = std::collections::BTreeSet::new();
        for k in 0..4000 {
            let p = Vec2::new((k % 63) as f32 / 63.0, (k / 63) as f32 / 63.0) * 6.0;
            let (a, b) = (cells(p, [6, 6], 3), cells(p + Vec2::new(6.0, -12.0), [6, 6], 3));
            assert!((a.first - b.first).abs() < 1e-4 && a.id == b.id && a.first <= a.second);
            ids.insert(a.id);
        }
        assert_eq!(ids.len(), 36);
    }

    #[test]
    fn noise_tiles_the_unit_square() {
        for i in 0..50 {
            let v = i as f32 / 50.0;
            let seam = fbm(Vec2::new(0.0, v), [5, 3], 4, 7) - fbm(Vec2::new(1.0, v), [5, 3], 4, 7);
            assert!(seam.abs() < 1e-4, "{seam}");
        }
    }
}
