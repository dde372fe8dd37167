//! The bytes of a PLY file: text, and binary in either byte order.

use super::header::{Element, Encoding, Kind, Problem, parse_header};
use crate::{ImportError, polygon};
use enfilade_geometry::Mesh;
use enfilade_math::{Vec2, Vec3};
use std::path::Path;

/// What a PLY file holds.
#[derive(Debug, PartialEq)]
pub(crate) struct PlyFile {
    /// Its mesh, with texture coordinates as they are. Without faces it has no triangles.
    pub mesh: Mesh,
    /// Mean of the vertices' colours, 0 … 1 as they are written; `None` when they have none.
    pub mean_color: Option<[f64; 3]>,
    /// Elements that were skipped, such as edges and strips of triangles.
    pub skipped: Vec<String>,
    /// True when faces have texture coordinates of their own, which are not read.
    pub has_face_uvs: bool,
}

/// Reads the `vertex` and `face` elements.
///
/// # Errors
/// When the header or a value is not what the format calls for, or a face refers to a vertex that is not there.
pub(crate) fn read(bytes: &[u8], file: &Path) -> Result<PlyFile, ImportError> {
    let error = |(place, problem): Problem| ImportError::malformed(file, place, problem);
    let (header, body) = parse_header(bytes).map_err(error)?;
    let mut values = Values { encoding: header.encoding, bytes: body, at: 0 };
    let mut mesh = Mesh::default();
    let (mut mean_color, mut skipped, mut has_face_uvs) = (None, Vec::new(), false);
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => mean_color = read_vertices(element, &mut values, &mut mesh).map_err(error)?,
            "face" => {
                has_face_uvs = element.index_of(&["texcoord"]).is_some();
                read_faces(element, &mut values, &mut mesh).map_err(error)?;
            }
            name => {
                if element.count > 0 {
                    skipped.push(name.to_string());
                }
                if !element.properties.is_empty() {
                    (0..element.count).try_for_each(|_| element.row(&mut values, &mut |_, _| ())).map_err(error)?;
                }
            }
        }
    }
    Ok(PlyFile { mesh, mean_color, skipped, has_face_uvs })
}

/// The numbers of the body, one after the other.
struct Values<'b> {
    encoding: Encoding,
    bytes: &'b [u8],
    at: usize,
}

impl Values<'_> {
    fn next(&mut self, kind: Kind) -> Result<f64, Problem> {
        if self.encoding == Encoding::Text {
            return self.next_word();
        }
        let place = self.at;
        let bytes = self.bytes.get(place..place + kind.size());
        let bytes =
            bytes.ok_or_else(|| (format!("byte {place} of the body"), "the file is cut short; copy or export it again".to_string()))?;
        self.at += kind.size();
        let mut le = [0u8; 8];
        le[..kind.size()].copy_from_slice(bytes);
        if self.encoding == Encoding::Big {
            le[..kind.size()].reverse();
        }
        let word = u32::from_le_bytes([le[0], le[1], le[2], le[3]]);
        Ok(match kind {
            Kind::I8 => f64::from(le[0] as i8),
            Kind::U8 => f64::from(le[0]),
            Kind::I16 => f64::from(word as u16 as i16),
            Kind::U16 => f64::from(word as u16),
            Kind::I32 => f64::from(word as i32),
            Kind::U32 => f64::from(word),
            Kind::F32 => f64::from(f32::from_bits(word)),
            Kind::F64 => f64::from_le_bytes(le),
        })
    }

    fn next_word(&mut self) -> Result<f64, Problem> {
        let rest = &self.bytes[self.at..];
        let start = rest.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(rest.len());
        let length = rest[start..].iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len() - start);
        let word = String::from_utf8_lossy(&rest[start..start + length]);
        let place = || format!("byte {} of the body", self.at + start);
        let value = match word.as_ref() {
            "" => Err((place(), "the file is cut short; copy or export it again".to_string())),
            word => word.parse().map_err(|_| (place(), format!("{word:?} is not a number"))),
        };
        self.at += start + length;
        value
    }
}

impl Element {
    /// Reads one row and hands every value over with the index of its property. List items come one by one.
    fn row(&self, values: &mut Values, take: &mut dyn FnMut(usize, f64)) -> Result<(), Problem> {
        for (i, property) in self.properties.iter().enumerate() {
            let count = property.list.map_or(Ok(1.0), |kind| values.next(kind))?;
            if !(0.0..=1e6).contains(&count) {
                let problem = format!("a list of {count} items in property {}; the file is damaged", property.name);
                return Err((format!("byte {} of the body", values.at), problem));
            }
            for _ in 0..count as u64 {
                take(i, values.next(property.kind)?);
            }
        }
        Ok(())
    }

    fn index_of(&self, names: &[&str]) -> Option<usize> {
        self.properties.iter().position(|p| names.contains(&p.name.as_str()))
    }
}

/// Reads the vertices and returns the mean of their colours, if they have any.
fn read_vertices(element: &Element, values: &mut Values, mesh: &mut Mesh) -> Result<Option<[f64; 3]>, Problem> {
    let [x, y, z] = ["x", "y", "z"].map(|n| element.index_of(&[n]));
    let (Some(x), Some(y), Some(z)) = (x, y, z) else { return Err(("header".into(), "the vertices have no x, y and z".into())) };
    let normal = ["nx", "ny", "nz"].map(|n| element.index_of(&[n]));
    let uv = [&["u", "s", "texture_u", "s0"], &["v", "t", "texture_v", "t0"]].map(|names| element.index_of(names));
    let color = [["red", "diffuse_red", "r"], ["green", "diffuse_green", "g"], ["blue", "diffuse_blue", "b"]];
    let color = color.map(|names| element.index_of(&names));
    let mut sum = [0.0; 3];
    let mut row = vec![0.0; element.properties.len()];
    for _ in 0..element.count {
        element.row(values, &mut |i, value| row[i] = value)?;
        mesh.positions.push(Vec3::new(row[x] as f32, row[y] as f32, row[z] as f32));
        if let [Some(a), Some(b), Some(c)] = normal {
            mesh.normals.push(Vec3::new(row[a] as f32, row[b] as f32, row[c] as f32));
        }
        if let [Some(a), Some(b)] = uv {
            mesh.uvs.push(Vec2::new(row[a] as f32, row[b] as f32));
        }
        if let [Some(r), Some(g), Some(b)] = color {
            [r, g, b].iter().zip(&mut sum).for_each(|(&i, sum)| *sum += row[i] / element.properties[i].kind.full());
        }
    }
    let colored = color.iter().all(Option::is_some) && element.count > 0;
    Ok(colored.then(|| sum.map(|s| (s / element.count as f64).clamp(0.0, 1.0))))
}

fn read_faces(element: &Element, values: &mut Values, mesh: &mut Mesh) -> Result<(), Problem> {
    let indices = element.index_of(&["vertex_indices", "vertex_index"]);
    let indices = indices.ok_or_else(|| ("header".to_string(), "the faces have no vertex_indices".to_string()))?;
    let vertices = mesh.positions.len();
    let mut face: Vec<u32> = Vec::new();
    for number in 0..element.count {
        face.clear();
        let mut bad = None;
        element.row(values, &mut |i, value| {
            if i == indices {
                face.push(value as u32);
                bad = bad.or((!(0.0..vertices as f64).contains(&value)).then_some(value));
            }
        })?;
        if let Some(index) = bad {
            return Err((format!("face {number}"), format!("it refers to vertex {index}, but there are {vertices}, counted from 0")));
        }
        let points: Vec<Vec3> = face.iter().map(|&i| mesh.positions[i as usize]).collect();
        mesh.triangles.extend(polygon::triangulate(&points).into_iter().map(|t| t.map(|i| face[i])));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "element vertex 4\nproperty float x\nproperty float y\nproperty double z\nproperty uchar red\n\
                          element face 1\nproperty list uchar int vertex_indices\nend_header\n";

    fn binary(big: bool) -> Vec<u8> {
        let name = if big { "big" } else { "little" };
        let mut bytes = format!("ply\nformat binary_{name}_endian 1.0\ncomment a b c\n{HEADER}").into_bytes();
        let order = |mut b: Vec<u8>| {
            if big {
                b.reverse();
            }
            b
        };
        for (x, y) in [(0.0f32, 0.0f32), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
            bytes.extend(order(x.to_le_bytes().to_vec()));
            bytes.extend(order(y.to_le_bytes().to_vec()));
            bytes.extend(order(2.0f64.to_le_bytes().to_vec()));
            bytes.push(9);
        }
        bytes.push(4);
        (0..4i32).for_each(|i| bytes.extend(order(i.to_le_bytes().to_vec())));
        bytes
    }

    #[test]
    fn text_and_binary_of_both_orders_give_the_same_mesh() {
        let text = format!("ply\nformat ascii 1.0\n{HEADER}0 0 2 9\n1 0 2 9\n1 1 2 9\n0 1 2 9\n4 0 1 2 3\n");
        let ply = read(text.as_bytes(), Path::new("a.ply")).unwrap();
        assert_eq!((ply.mesh.positions[2], ply.mesh.triangles.len(), ply.mean_color), (Vec3::new(1.0, 1.0, 2.0), 2, None));
        for big in [false, true] {
            assert_eq!(read(&binary(big), Path::new("a.ply")).unwrap(), ply);
        }
    }

    #[test]
    fn damage_is_named() {
        let message = |bytes: &[u8]| read(bytes, Path::new("a.ply")).unwrap_err().to_string();
        let whole = binary(false);
        assert!(message(&whole[..whole.len() - 3]).contains("cut short"));
        assert!(message(b"ply\nformat ascii 1.0\nelement vertex 1\n").contains("header does not end"));
        let text = format!("ply\nformat ascii 1.0\n{HEADER}0 0 2 9\n1 0 2 9\n1 1 2 9\n0 1 2 9\n3 0 1 7\n");
        assert!(message(text.as_bytes()).contains("face 0: it refers to vertex 7, but there are 4"));
    }
}
