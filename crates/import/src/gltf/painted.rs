//! Colours of vertices as a picture, for materials without other textures: a scene has none, but it has textures.
//!
//! Each triangle gets a square of 2×2 texels, three of which are its corners and the fourth what makes bilinear filtering of them linear.
//! Squares follow one another along Morton's curve: triangles that are neighbours in the file mostly are in space and in the picture too,
//! so that smaller copies of the picture mix neighbours.

use enfilade_geometry::Mesh;
use enfilade_math::Vec2;
use enfilade_scene::{Image, Pixels};

/// Meshes of more triangles are not painted: their picture would take more than 200 MB.
const MOST: usize = 1 << 22;

/// The mesh with vertices of its own for each triangle and their places in a picture of its colours. `None` for one that is too large, or
/// whose triangles have vertices that are not there.
pub(super) fn painted(mesh: &Mesh, colors: &[[f32; 4]], name: &str) -> Option<(Mesh, Image)> {
    let count = mesh.triangles.len();
    if count > MOST || mesh.triangles.iter().flatten().any(|&i| i as usize >= colors.len().min(mesh.positions.len())) {
        return None;
    }
    // Powers of two, so that the places of texels are exact.
    let bits = count.next_power_of_two().trailing_zeros();
    let [width, height] = [2usize << bits.div_ceil(2), 2 << (bits / 2)];
    let mut texels = vec![[0.0; 3]; width * height];
    let mut painted = Mesh::default();
    for (i, corners) in mesh.triangles.iter().enumerate() {
        let (x, y) = (2 * every_second_bit(i), 2 * every_second_bit(i >> 1));
        let [a, b, c] = corners.map(|corner| colors[corner as usize]).map(|[r, g, b, _]| [r, g, b].map(|v| v.clamp(0.0, 1.0)));
        let rest = [0, 1, 2].map(|k| b[k] + c[k] - a[k]);
        for (color, [dx, dy]) in [(a, [0, 0]), (b, [1, 0]), (c, [0, 1]), (rest, [1, 1])] {
            texels[(y + dy) * width + x + dx] = color;
        }
        for (&corner, [dx, dy]) in corners.iter().zip([[0, 0], [1, 0], [0, 1]]) {
            painted.positions.push(mesh.positions[corner as usize]);
            painted.normals.extend(mesh.normals.get(corner as usize));
            let at = |texel: usize, texels: usize| (texel as f32 + 0.5) / texels as f32;
            painted.uvs.push(Vec2::new(at(x + dx, width), 1.0 - at(y + dy, height)));
        }
        painted.triangles.push([0, 1, 2].map(|k| 3 * i as u32 + k));
    }
    let pixels = Pixels::RgbF32(texels);
    Some((painted, Image { name: name.to_string(), width: width as u32, height: height as u32, pixels }))
}

/// The number that the bits at even places make.
fn every_second_bit(index: usize) -> usize {
    (0..usize::BITS / 2).map(|bit| (index >> (2 * bit) & 1) << bit).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::{Rgb, Vec3};
    use enfilade_scene::{TextureRef, Wrap};

    #[test]
    fn colours_are_linear_over_each_triangle() {
        let positions: Vec<Vec3> = (0..9).map(|i| Vec3::new(i as f32, (i * i % 5) as f32, 0.0)).collect();
        let colors: Vec<[f32; 4]> = (0..9).map(|i| [i as f32 / 8.0, (i % 2) as f32, (i * 7 % 9) as f32 / 9.0, 1.0]).collect();
        let triangles = (0..7).map(|i| [i, i + 2, i + 1]).collect();
        let mesh = Mesh { positions, triangles, ..Mesh::default() };
        let (painted, image) = painted(&mesh, &colors, "colours").unwrap();
        assert_eq!((image.width, image.height, painted.positions.len(), painted.normals.len()), (8, 4, 21, 0));
        let texture = TextureRef { wrap: [Wrap::Clamp; 2], ..TextureRef::new(0) };
        for (old, new) in mesh.triangles.iter().zip(&painted.triangles) {
            for weights in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.2, 0.5, 0.3], [0.5, 0.0, 0.5]] {
                let uv = (0..3).fold(Vec2::ZERO, |sum, k| sum + painted.uvs[new[k] as usize] * weights[k]);
                let color = |c: usize| (0..3).map(|k| colors[old[k] as usize][c] * weights[k]).sum::<f32>();
                let difference = image.sample(&texture, uv).0 - Rgb::new(color(0), color(1), color(2));
                assert!(difference.to_array().iter().all(|d| d.abs() < 1e-5), "{old:?} {weights:?} {difference:?}");
            }
            assert_eq!(old.map(|i| mesh.positions[i as usize]), new.map(|i| painted.positions[i as usize]));
        }
    }

    #[test]
    fn vertices_that_are_not_there_are_not_painted() {
        let mesh = Mesh { positions: vec![Vec3::ZERO; 3], triangles: vec![[0, 1, 3]], ..Mesh::default() };
        assert!(painted(&mesh, &[[1.0; 4]; 4], "").is_none());
    }
}
