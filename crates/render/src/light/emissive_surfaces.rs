//! Finds the emissive surfaces of a scene and cuts them into patches.

use super::bounds::LightBounds;
use super::emitter::{Emission, Patch};
use crate::triangle::Triangle;
use crate::triangles::Triangles;
use enfilade_math::{Vec2, Vec3};
use enfilade_scene::{Alpha, ColorParam, Scene};

/// Two triangles make a rectangle when its corners and right angles are off by no more than this fraction of a side.
const RECTANGLE_TOLERANCE: f32 = 1e-4;
/// About the number of texels along a side of a patch, and the largest number of patches along a side.
const TEXELS_PER_PATCH: f32 = 4.0;
const MAX_PATCHES_PER_SIDE: u32 = 32;
/// The most patches a part is cut into beyond one a triangle.
const MAX_PATCHES_PER_PART: usize = 4096;
/// Texture lookups along each side of a patch, for its mean radiance.
const LOOKUPS: u32 = 8;
/// A patch counts for at least this fraction of the part's mean radiance, so that what the lookups missed is found.
const DARKEST: f32 = 0.01;

/// The emissive surfaces of a scene.
#[derive(Debug, Default)]
pub(super) struct EmissiveSurfaces {
    pub patches: Vec<Patch>,
    /// Bounds of each patch.
    pub bounds: Vec<LightBounds>,
    /// Part of each patch; the patches of a part follow each other.
    pub part_of_patch: Vec<u32>,
    /// By part: first triangle and first entry of `pieces`; `None` for parts that do not emit.
    parts: Vec<Option<(u32, u32)>>,
    /// Pieces of each triangle of the emissive parts.
    pieces: Vec<Pieces>,
}

/// The patches of a triangle or of a rectangle of two.
#[derive(Clone, Copy, Debug)]
struct Pieces {
    first_patch: u32,
    /// Pieces along each side.
    grid: [u16; 2],
    shape: Outline,
}

#[derive(Clone, Copy, Debug)]
enum Outline {
    /// Never sampled: no area.
    None,
    Triangle,
    /// `second` when this is the second of its two triangles.
    Rectangle {
        second: bool,
    },
}

impl EmissiveSurfaces {
    pub fn new(scene: &Scene, triangles: &Triangles<'_>) -> Self {
        let mut found = Self { parts: vec![None; scene.parts.len()], ..Self::default() };
        let mut first = 0usize;
        for (part, data) in scene.parts.iter().enumerate() {
            let count = scene.meshes[data.mesh as usize].triangles.len();
            let range = first..first + count;
            first += count;
            let material = &scene.materials[data.material as usize];
            if material.emission.factor.is_black() {
                continue;
            }
            found.parts[part] = Some((range.start as u32, found.pieces.len() as u32));
            let even = material.emission.texture.is_none() && material.alpha == Alpha::Opaque;
            PartCutter { scene, triangles, emission: &material.emission, two_sided: material.emits_both_sides, even, cut_so_far: 0 }
                .add(range, &mut found);
            found.part_of_patch.resize(found.patches.len(), part as u32);
        }
        found
    }

    /// The patch at a point of a triangle, given by its weights of the second and third corner.
    #[inline]
    pub fn patch_at(&self, triangles: &Triangles<'_>, triangle: u32, [b, c]: [f32; 2]) -> Option<u32> {
        let (first_triangle, first_piece) = (*self.parts.get(triangles.get(triangle).part as usize)?)?;
        let pieces = &self.pieces[(first_piece + triangle - first_triangle) as usize];
        let [columns, rows] = pieces.grid.map(u32::from);
        let cell = |v: f32, n: u32| ((v.max(0.0) * n as f32) as u32).min(n - 1);
        match pieces.shape {
            Outline::None => None,
            Outline::Triangle => Some(pieces.first_patch + piece_of_triangle([b, c], columns)),
            Outline::Rectangle { second } => {
                if columns * rows == 1 {
                    return Some(pieces.first_patch);
                }
                let t = triangles.get(triangle);
                let q = t.position([1.0 - b - c, b, c]);
                let rectangle = rectangle_of(&triangles.get(triangle - u32::from(second)), &triangles.get(triangle + u32::from(!second)))?;
                let [s, r] = rectangle.coordinates(q);
                Some(pieces.first_patch + cell(r, rows) * columns + cell(s, columns))
            }
        }
    }
}

/// Cuts one emissive part into patches.
struct PartCutter<'a> {
    scene: &'a Scene,
    triangles: &'a Triangles<'a>,
    emission: &'a ColorParam,
    two_sided: bool,
    /// Emits the same everywhere.
    even: bool,
    cut_so_far: usize,
}

impl PartCutter<'_> {
    fn triangle(&self, index: usize) -> Triangle {
        self.triangles.get(index as u32)
    }

    fn add(mut self, range: std::ops::Range<usize>, found: &mut EmissiveSurfaces) {
        let first_patch_of_part = found.patches.len();
        let mut index = range.start;
        while index < range.end {
            let rectangle = if index + 1 < range.end { rectangle_of(&self.triangle(index), &self.triangle(index + 1)) } else { None };
            let first_patch = found.patches.len() as u32;
            if let Some(rectangle) = rectangle {
                let grid = self.add_rectangle(index, &rectangle, found);
                for second in [false, true] {
                    found.pieces.push(Pieces { first_patch, grid, shape: Outline::Rectangle { second } });
                }
                index += 2;
            } else {
                let n = self.add_triangle(index, found);
                let shape = if n == 0 { Outline::None } else { Outline::Triangle };
                found.pieces.push(Pieces { first_patch, grid: [n; 2], shape });
                index += 1;
            }
        }
        // The darkest patches still count a little.
        let of_part = &mut found.bounds[first_patch_of_part..];
        let (power, area) = of_part
            .iter()
            .zip(&found.patches[first_patch_of_part..])
            .fold((0.0f64, 0.0f64), |(power, area), (b, p)| (power + f64::from(b.power), area + f64::from(p.area())));
        if self.emission.texture.is_some() && area > 0.0 {
            let min_radiance = DARKEST * (power / area) as f32;
            for (bounds, patch) in of_part.iter_mut().zip(&found.patches[first_patch_of_part..]) {
                bounds.power = bounds.power.max(min_radiance * patch.area());
            }
        }
    }

    fn add_triangle(&mut self, index: usize, found: &mut EmissiveSurfaces) -> u16 {
        let triangle = self.triangle(index);
        let Some((normal, sides)) = self.outward(&triangle) else { return 0 };
        let emission = self.emission_of(sides);
        let [b, c] = [triangle.uvs[1] - triangle.uvs[0], triangle.uvs[2] - triangle.uvs[0]];
        let n = self.pieces_per_side(b).max(self.pieces_per_side(c)).max(self.pieces_per_side(c - b));
        let n = self.within_budget([n, n])[0];
        for piece in 0..n * n {
            let weights = corners_of_piece(piece, n);
            let corners = weights.map(|[b, c]| triangle.position([1.0 - b - c, b, c]));
            let patch = Patch::of_triangle(index as u32, corners, normal, emission);
            let uvs = weights.map(|[b, c]| triangle.uv([1.0 - b - c, b, c]));
            let mean = self.mean(|i, j| {
                // Lookups of the square folded onto the triangle.
                let (i, j) = if i + j > 1.0 { (1.0 - i, 1.0 - j) } else { (i, j) };
                uvs[0] * (1.0 - i - j) + uvs[1] * i + uvs[2] * j
            });
            found.patches.push(patch);
            found.bounds.push(patch.light_bounds(mean, sides != Sides::One));
        }
        n as u16
    }

    fn add_rectangle(&mut self, index: usize, rectangle: &Rectangle, found: &mut EmissiveSurfaces) -> [u16; 2] {
        let (first, second) = (self.triangle(index), self.triangle(index + 1));
        let Some((normal, sides)) = self.outward(&first) else { return [0; 2] };
        let sides = match self.outward(&second) {
            Some((other, second_sides)) if second_sides == sides && (other.dot(normal) > 0.0 || sides == Sides::Both) => sides,
            _ => Sides::Unsure,
        };
        let emission = self.emission_of(sides);
        let uv_at = |s: f32, r: f32| {
            let whole = Patch::of_rectangle(0, rectangle.corner, rectangle.sides, normal, emission);
            let (triangle, [b, c]) =
                whole.locate(rectangle.corner + rectangle.sides[0] * s + rectangle.sides[1] * r, |k| [first, second][k as usize].corners);
            [first, second][triangle as usize].uv([1.0 - b - c, b, c])
        };
        let grid = self.within_budget([
            self.pieces_per_side(uv_at(1.0, 0.0) - uv_at(0.0, 0.0)),
            self.pieces_per_side(uv_at(0.0, 1.0) - uv_at(0.0, 0.0)),
        ]);
        let [columns, rows] = grid.map(|n| n as f32);
        for cell in 0..grid[0] * grid[1] {
            let (s, r) = ((cell % grid[0]) as f32 / columns, (cell / grid[0]) as f32 / rows);
            let corner = rectangle.corner + rectangle.sides[0] * s + rectangle.sides[1] * r;
            let patch =
                Patch::of_rectangle(index as u32, corner, [rectangle.sides[0] / columns, rectangle.sides[1] / rows], normal, emission);
            let mean = self.mean(|i, j| uv_at(s + i / columns, r + j / rows));
            found.patches.push(patch);
            found.bounds.push(patch.light_bounds(mean, sides != Sides::One));
        }
        grid.map(|n| n as u16)
    }

    /// Unit normal of the emitting side, and which sides emit; `None` without area.
    fn outward(&self, triangle: &Triangle) -> Option<(Vec3, Sides)> {
        let winding = triangle.cross().try_normalize()?;
        let inside_out = triangle.normals.map(|n| n.dot(winding) < 0.0);
        let agree = inside_out[0] == inside_out[1] && inside_out[1] == inside_out[2];
        let sides = match (self.two_sided, agree) {
            (true, _) => Sides::Both,
            (false, true) => Sides::One,
            (false, false) => Sides::Unsure,
        };
        Some((if inside_out[0] { -winding } else { winding }, sides))
    }

    fn emission_of(&self, sides: Sides) -> Emission {
        if self.even && sides != Sides::Unsure {
            Emission::Even { radiance: self.emission.factor, two_sided: sides == Sides::Both }
        } else {
            Emission::Varied
        }
    }

    /// The number of pieces that a side is cut into, by its texels.
    fn pieces_per_side(&self, uv_side: Vec2) -> u32 {
        let Some(texture) = self.emission.texture else { return 1 };
        let image = &self.scene.images[texture.image as usize];
        let on_image = texture.transform(uv_side) - texture.transform(Vec2::ZERO);
        let texels = (on_image * Vec2::new(image.width as f32, image.height as f32)).length();
        ((texels / TEXELS_PER_PATCH) as u32).clamp(1, MAX_PATCHES_PER_SIDE)
    }

    fn within_budget(&mut self, grid: [u32; 2]) -> [u32; 2] {
        let pieces = (grid[0] * grid[1]) as usize;
        if pieces == 1 || self.cut_so_far + pieces > MAX_PATCHES_PER_PART {
            return [1; 2];
        }
        self.cut_so_far += pieces;
        grid
    }

    /// Mean luminance over a patch, from its texture coordinates by fractions of its sides.
    fn mean(&self, uv: impl Fn(f32, f32) -> Vec2) -> f32 {
        let Some(texture) = &self.emission.texture else { return self.emission.factor.luminance() };
        let image = &self.scene.images[texture.image as usize];
        let at = |k: u32| (k as f32 + 0.5) / LOOKUPS as f32;
        let sum: f32 = (0..LOOKUPS * LOOKUPS)
            .map(|k| (self.emission.factor * image.sample(texture, uv(at(k % LOOKUPS), at(k / LOOKUPS))).0).luminance().max(0.0))
            .sum();
        sum / (LOOKUPS * LOOKUPS) as f32
    }
}

/// The sides of a patch that emit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sides {
    One,
    Both,
    /// Vertex normals disagree about what is outside.
    Unsure,
}

/// A rectangle in the world: a corner and two orthogonal sides.
struct Rectangle {
    corner: Vec3,
    sides: [Vec3; 2],
}

impl Rectangle {
    /// A point of the rectangle as fractions of the two sides.
    fn coordinates(&self, q: Vec3) -> [f32; 2] {
        self.sides.map(|side| (q - self.corner).dot(side) / side.length_squared())
    }
}

/// The rectangle that two triangles make up, if they do: corners a b c and a c d in some rotation.
fn rectangle_of(first: &Triangle, second: &Triangle) -> Option<Rectangle> {
    if first.part != second.part {
        return None;
    }
    // The corner of the first opposite to the diagonal, and the one of the second.
    let (i, j) = (0..3).flat_map(|i| (0..3).map(move |j| (i, j))).find(|&(i, j)| {
        first.corners[(i + 1) % 3] == second.corners[(j + 2) % 3] && first.corners[(i + 2) % 3] == second.corners[(j + 1) % 3]
    })?;
    let corner = first.corners[i];
    let sides = [first.corners[(i + 1) % 3] - corner, first.corners[(i + 2) % 3] - corner];
    let size = sides[0].length().min(sides[1].length());
    let closes = (corner + sides[0] + sides[1]).distance(second.corners[j]) <= RECTANGLE_TOLERANCE * size;
    let square = sides[0].dot(sides[1]).abs() <= RECTANGLE_TOLERANCE * sides[0].length() * sides[1].length();
    let turned = first.cross().dot(second.cross()) > 0.0;
    (size > 0.0 && closes && square && turned).then_some(Rectangle { corner, sides })
}

/// The number of the piece that contains a point, in a triangle that is cut into n pieces along each side: a cell of the grid of weights
/// has two pieces.
fn piece_of_triangle([b, c]: [f32; 2], n: u32) -> u32 {
    if n == 1 {
        return 0;
    }
    let (x, y) = (b.max(0.0) * n as f32, c.max(0.0) * n as f32);
    let row = (y as u32).min(n - 1);
    let column = (x as u32).min(n - 1 - row);
    let upper = x - column as f32 + y - row as f32 > 1.0 && column + row + 1 < n;
    // Row r has n − r pieces that point up and one fewer that point down.
    let before = row * (2 * n - row);
    before + 2 * column + u32::from(upper)
}

/// Weights (second, third corner) of the corners of a piece; the inverse of [`piece_of_triangle`].
fn corners_of_piece(piece: u32, n: u32) -> [[f32; 2]; 3] {
    let mut row = 0;
    while row + 1 < n && (row + 1) * (2 * n - row - 1) <= piece {
        row += 1;
    }
    let within = piece - row * (2 * n - row);
    let (column, upper) = (within / 2, within % 2 == 1);
    let at = |x: u32, y: u32| [x as f32 / n as f32, y as f32 / n as f32];
    if upper {
        [at(column + 1, row + 1), at(column, row + 1), at(column + 1, row)]
    } else {
        [at(column, row), at(column + 1, row), at(column, row + 1)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::Rng;

    #[test]
    fn the_pieces_of_a_triangle_hold_their_own_points() {
        for n in [1, 2, 3, 7, 16] {
            for piece in 0..n * n {
                let corners = corners_of_piece(piece, n);
                let middle = [0, 1].map(|k| (corners[0][k] + corners[1][k] + corners[2][k]) / 3.0);
                assert_eq!(piece_of_triangle(middle, n), piece, "{n}");
            }
            let mut rng = Rng::new(1);
            for _ in 0..1000 {
                let (b, c) = (rng.next_f32(), rng.next_f32());
                let (b, c) = if b + c > 1.0 { (1.0 - b, 1.0 - c) } else { (b, c) };
                assert!(piece_of_triangle([b, c], n) < n * n);
            }
        }
    }

    #[test]
    fn two_triangles_are_a_rectangle_only_with_right_angles() {
        let triangle = |corners: [[f32; 3]; 3]| Triangle {
            corners: corners.map(Vec3::from),
            normals: [Vec3::Z; 3],
            uvs: [Vec2::ZERO; 3],
            part: 0,
            material: 0,
            winding: Vec3::Z,
            uv_density: 0.0,
            slack: 0.0,
        };
        let (a, b, c, d) = ([0.0, 0.0, 1.0], [2.0, 0.0, 1.0], [2.0, 1.0, 1.0], [0.0, 1.0, 1.0]);
        let rectangle = rectangle_of(&triangle([a, b, c]), &triangle([a, c, d])).unwrap();
        assert!((rectangle.sides[0].cross(rectangle.sides[1]).length() - 2.0).abs() < 1e-6);
        assert_eq!(rectangle.coordinates(Vec3::new(1.0, 0.5, 1.0)), [0.5, 0.5]);
        assert!(rectangle_of(&triangle([c, a, b]), &triangle([d, a, c])).is_some());
        // A sheared one, one turned over, and two that share no side.
        assert!(rectangle_of(&triangle([a, b, [3.0, 1.0, 1.0]]), &triangle([a, [3.0, 1.0, 1.0], [1.0, 1.0, 1.0]])).is_none());
        assert!(rectangle_of(&triangle([a, b, c]), &triangle([a, d, c])).is_none());
        assert!(rectangle_of(&triangle([a, b, c]), &triangle([b, c, [9.0, 9.0, 9.0]])).is_none());
    }
}
