//! The directions in which rays are cast, with neighbours together.

use enfilade_math::{DVec3, warp};

/// Rays of a fan, about, and of one of its sixteen tiles.
const FAN: f64 = 256.0;

/// Unit vectors spread evenly over the sphere, in groups of neighbours: fans, each of tiles.
pub(super) struct Rays {
    pub directions: Vec<DVec3>,
    pub fans: Vec<Fan>,
}

/// A group of tiles with the cone around all their rays.
pub(super) struct Fan {
    pub cone: Cone,
    pub tiles: Vec<Tile>,
}

/// A group of rays, `directions[first..last]`, with the cone around them.
pub(super) struct Tile {
    pub cone: Cone,
    pub first: usize,
    pub last: usize,
}

/// All directions around `axis` (a unit vector) up to an angle.
pub(super) struct Cone {
    pub axis: DVec3,
    /// Tangent of the angle.
    pub tan: f64,
}

impl Rays {
    /// `count` points of the Fibonacci sphere (see [`warp::fibonacci_sphere`]).
    ///
    /// The sphere is cut into bands by inclination, a band into fans by azimuth, and a fan four by four into tiles.
    pub fn new(count: usize) -> Self {
        let bands = (std::f64::consts::PI / (2.0 * std::f64::consts::TAU * FAN / count as f64).sqrt()).round().max(1.0);
        let fans_of = |band: f64| (2.0 * bands * (std::f64::consts::PI * (band + 0.5) / bands).sin()).round().max(3.0);
        let mut first_fan = vec![0];
        for band in 0..bands as usize {
            first_fan.push(first_fan[band] + fans_of(band as f64) as usize);
        }
        let tile_of = |d: DVec3| {
            let row = (d.z.clamp(-1.0, 1.0).acos() / std::f64::consts::PI * 4.0 * bands).min(4.0 * bands - 1.0) as usize;
            let fans = (first_fan[row / 4 + 1] - first_fan[row / 4]) as f64;
            let azimuth = d.y.atan2(d.x) / std::f64::consts::TAU + 0.5;
            let column = (azimuth * 4.0 * fans).min(4.0 * fans - 1.0) as usize;
            16 * (first_fan[row / 4] + column / 4) + 4 * (row % 4) + column % 4
        };
        let points: Vec<(usize, DVec3)> = (0..count).map(|k| warp::fibonacci_sphere(k, count)).map(|d| (tile_of(d), d)).collect();

        // Sort by tile; points of one tile keep their order.
        let mut ends = vec![0; 16 * first_fan[bands as usize] + 1];
        points.iter().for_each(|(tile, _)| ends[tile + 1] += 1);
        (1..ends.len()).for_each(|i| ends[i] += ends[i - 1]);
        let (mut next, mut directions) = (ends.clone(), vec![DVec3::ZERO; count]);
        for (tile, d) in points {
            directions[next[tile]] = d;
            next[tile] += 1;
        }
        let tile = |i: usize| Tile { cone: Cone::around(&directions[ends[i]..ends[i + 1]]), first: ends[i], last: ends[i + 1] };
        let fan = |f: usize| Fan {
            cone: Cone::around(&directions[ends[16 * f]..ends[16 * f + 16]]),
            tiles: (16 * f..16 * f + 16).filter(|i| ends[*i] < ends[i + 1]).map(tile).collect(),
        };
        let fans = (0..first_fan[bands as usize]).map(fan).collect();
        Self { directions, fans }
    }
}

impl Cone {
    /// The cone around unit vectors; one that no leap fits into when they are not all on one side of a plane.
    fn around(directions: &[DVec3]) -> Self {
        let axis = directions.iter().sum::<DVec3>().try_normalize().unwrap_or(DVec3::Z);
        let cos = directions.iter().map(|d| d.dot(axis)).fold(1.0, f64::min);
        let tan = if cos > 0.0 { (1.0 - cos * cos).sqrt() / cos } else { f64::INFINITY };
        Self { axis, tan: tan + 1e-9 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_direction_is_in_one_tile_and_in_its_cones() {
        for count in [64, 1000, 40_000] {
            let rays = Rays::new(count);
            let mut expected: Vec<[u64; 3]> = (0..count).map(|k| warp::fibonacci_sphere(k, count).to_array().map(f64::to_bits)).collect();
            let mut found: Vec<[u64; 3]> = rays.directions.iter().map(|d| d.to_array().map(f64::to_bits)).collect();
            expected.sort_unstable();
            found.sort_unstable();
            assert_eq!(found, expected);
            let mut next = 0;
            for fan in &rays.fans {
                for tile in &fan.tiles {
                    assert_eq!(tile.first, next);
                    next = tile.last;
                    for d in &rays.directions[tile.first..tile.last] {
                        for cone in [&tile.cone, &fan.cone] {
                            let along = d.dot(cone.axis);
                            assert!((*d - along * cone.axis).length() <= along * cone.tan);
                        }
                    }
                }
            }
            assert_eq!(next, count);
        }
        let tiles = Rays::new(40_000).fans.iter().map(|fan| fan.tiles.len()).sum::<usize>();
        assert!((1500..4000).contains(&tiles), "{tiles} tiles for 40,000 rays");
    }
}
