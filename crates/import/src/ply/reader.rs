//! The bytes of a PLY file: text, and binary in either byte order.

use super::attributes::{Means, Sums};
use super::faces::Faces;
use super::header::{Element, Problem, parse_header};
use super::values::Values;
use crate::ImportError;
use crate::assembly::{origin_of, positions_from};
use enfilade_geometry::Mesh;
use enfilade_math::{DVec3, Vec2, Vec3};
use std::path::Path;

const COORDINATES: [&str; 3] = ["x", "y", "z"];
const NORMAL: [&str; 3] = ["nx", "ny", "nz"];
const U: &[&str] = &["u", "s", "texture_u", "s0"];
const V: &[&str] = &["v", "t", "texture_v", "t0"];
const RED: [&str; 3] = ["red", "diffuse_red", "r"];
const GREEN: [&str; 3] = ["green", "diffuse_green", "g"];
const BLUE: [&str; 3] = ["blue", "diffuse_blue", "b"];
const INDICES: [&str; 2] = ["vertex_indices", "vertex_index"];
const TEXCOORD: [&str; 1] = ["texcoord"];

/// The content of a PLY file.
#[derive(Debug, PartialEq)]
pub(crate) struct PlyFile {
    /// Mesh of the file, with texture coordinates as they are. Without faces it has no triangles.
    pub mesh: Mesh,
    /// The point from which its positions count: zero unless they are far from the origin of their coordinates.
    pub origin: DVec3,
    /// Mean of the colours of the vertices, or of the faces, 0 … 1 as they are written; `None` when they have none.
    pub mean_color: Option<[f64; 3]>,
    /// Means of the attributes of vertices and faces, where they were wanted.
    pub means: Means,
    /// Elements that were skipped, such as edges.
    pub skipped: Vec<String>,
    /// Elements and their properties that are not read.
    pub unused: Vec<(String, Vec<String>)>,
    /// Pictures that comments name.
    pub pictures: Vec<String>,
    /// Warning about data after the last row, if there are any.
    pub trailing: Option<String>,
}

/// Reads the elements `vertex`, `face` and `tristrips`, in any order; the means of attributes where they are `wanted`. The unit of the file
/// decides what is far.
///
/// # Errors
/// When the header or a value is not what the format calls for, or a face refers to a vertex that is not there.
pub(crate) fn read(bytes: &[u8], file: &Path, wanted: bool, meters_per_unit: f64) -> Result<PlyFile, ImportError> {
    let error = |(place, problem): Problem| ImportError::malformed(file, place, problem);
    let (header, body) = parse_header(bytes).map_err(error)?;
    let mut values = Values::new(&header, body);
    let (mut mesh, mut points, mut faces) = (Mesh::default(), Vec::new(), Faces::default());
    let (mut of_vertices, mut of_faces, mut skipped, mut unused) = (None, None, Vec::new(), Vec::new());
    let mut means = wanted.then(Means::default);
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => {
                of_vertices = read_vertices(element, &mut values, &mut points, &mut mesh, means.as_mut()).map_err(error)?;
                unused.extend(element.unread(&[&COORDINATES, &NORMAL, U, V, &RED, &GREEN, &BLUE]));
            }
            "face" => {
                of_faces = read_faces(element, &mut values, &mut faces, means.as_mut()).map_err(error)?;
                unused.extend(element.unread(&[&INDICES, &TEXCOORD, &RED, &GREEN, &BLUE]));
            }
            "tristrips" => {
                read_strips(element, &mut values, &mut faces).map_err(error)?;
                unused.extend(element.unread(&[&INDICES]));
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
    let origin = origin_of(points.iter().copied(), meters_per_unit);
    mesh.positions = positions_from(origin, &points);
    faces.cut_into(&mut mesh).map_err(error)?;
    let means = means.unwrap_or_default();
    let trailing = values.trailing();
    Ok(PlyFile { mesh, origin, mean_color: of_vertices.or(of_faces), means, skipped, unused, pictures: header.pictures, trailing })
}

impl Element {
    fn index_of(&self, names: &[&str]) -> Option<usize> {
        self.properties.iter().position(|p| names.contains(&p.name.as_str()))
    }

    /// The list of the corners of a face.
    fn indices(&self) -> Result<usize, Problem> {
        let problem = || format!("the elements {} have no vertex_indices; export the file with them", self.name);
        self.index_of(&INDICES).ok_or_else(|| ("header".to_string(), problem()))
    }

    /// The element with its properties that are none of `read`; `None` where all are read, or there is no row.
    fn unread(&self, read: &[&[&str]]) -> Option<(String, Vec<String>)> {
        let names = self.properties.iter().map(|p| p.name.clone());
        let unread: Vec<String> = names.filter(|name| !read.iter().any(|names| names.contains(&name.as_str()))).collect();
        (self.count > 0 && !unread.is_empty()).then(|| (self.name.clone(), unread))
    }
}

/// Reads the vertices, their positions as `points`, and returns the mean of their colours, if they have any.
fn read_vertices(
    element: &Element,
    values: &mut Values,
    points: &mut Vec<DVec3>,
    mesh: &mut Mesh,
    means: Option<&mut Means>,
) -> Result<Option<[f64; 3]>, Problem> {
    let [x, y, z] = COORDINATES.map(|n| element.index_of(&[n]));
    let (Some(x), Some(y), Some(z)) = (x, y, z) else {
        return Err(("header".into(), "the vertices have no x, y and z; export the file with them".into()));
    };
    let normal = NORMAL.map(|n| element.index_of(&[n]));
    let uv = [U, V].map(|names| element.index_of(names));
    let (mut colors, mut attributes) = (Colors::of(element), Sums::new(element, means.is_some()));
    let mut row = vec![0.0; element.properties.len()];
    for _ in 0..element.count {
        element.row(values, &mut |i, value| {
            row[i] = value;
            attributes.add(i, value);
        })?;
        points.push(DVec3::new(row[x], row[y], row[z]));
        if let [Some(a), Some(b), Some(c)] = normal {
            mesh.normals.push(Vec3::new(row[a] as f32, row[b] as f32, row[c] as f32));
        }
        if let [Some(a), Some(b)] = uv {
            mesh.uvs.push(Vec2::new(row[a] as f32, row[b] as f32));
        }
        colors.add(&row);
    }
    if let Some(means) = means {
        attributes.finish(means);
    }
    Ok(colors.mean())
}

/// The sum of the colours of an element's rows.
struct Colors<'e> {
    element: &'e Element,
    places: Option<[usize; 3]>,
    sum: [f64; 3],
}

impl<'e> Colors<'e> {
    fn of(element: &'e Element) -> Self {
        let places = [RED, GREEN, BLUE].map(|names| element.index_of(&names));
        let places = if let [Some(r), Some(g), Some(b)] = places { Some([r, g, b]) } else { None };
        Self { element, places, sum: [0.0; 3] }
    }

    fn add(&mut self, row: &[f64]) {
        for (i, sum) in self.places.iter().flatten().zip(&mut self.sum) {
            *sum += row[*i] / self.element.properties[*i].kind.full();
        }
    }

    fn mean(&self) -> Option<[f64; 3]> {
        let rows = self.element.count as f64;
        self.places.filter(|_| rows > 0.0).map(|_| self.sum.map(|s| (s / rows).clamp(0.0, 1.0)))
    }
}

/// Reads the polygons and returns the mean of their colours, if they have any.
fn read_faces(element: &Element, values: &mut Values, faces: &mut Faces, means: Option<&mut Means>) -> Result<Option<[f64; 3]>, Problem> {
    let indices = element.indices()?;
    let texcoord = element.index_of(&TEXCOORD);
    let (mut colors, mut attributes) = (Colors::of(element), Sums::new(element, means.is_some()));
    let mut row = vec![0.0; element.properties.len()];
    let (mut polygon, mut uvs) = (Vec::new(), Vec::new());
    for number in 0..element.count {
        polygon.clear();
        uvs.clear();
        element.row(values, &mut |i, value| match i {
            i if i == indices => polygon.push(value),
            i if Some(i) == texcoord => uvs.push(value),
            i => {
                row[i] = value;
                attributes.add(i, value);
            }
        })?;
        faces.push(number, &polygon, texcoord.map(|_| uvs.as_slice()));
        colors.add(&row);
    }
    if let Some(means) = means {
        attributes.finish(means);
    }
    Ok(colors.mean())
}

fn read_strips(element: &Element, values: &mut Values, faces: &mut Faces) -> Result<(), Problem> {
    let indices = element.indices()?;
    let mut strip = Vec::new();
    for number in 0..element.count {
        strip.clear();
        element.row(values, &mut |i, value| {
            if i == indices {
                strip.push(value);
            }
        })?;
        faces.push_strip(number, &strip);
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
        let ply = read(text.as_bytes(), Path::new("a.ply"), false, 1.0).unwrap();
        assert_eq!((ply.mesh.positions[2], ply.mesh.triangles.len(), ply.mean_color), (Vec3::new(1.0, 1.0, 2.0), 2, None));
        for big in [false, true] {
            assert_eq!(read(&binary(big), Path::new("a.ply"), false, 1.0).unwrap(), ply);
        }
    }

    #[test]
    fn damage_is_named() {
        let message = |bytes: &[u8]| read(bytes, Path::new("a.ply"), false, 1.0).unwrap_err().to_string();
        let whole = binary(false);
        assert!(message(&whole[..whole.len() - 3]).contains("cut short"));
        assert!(message(b"ply\nformat ascii 1.0\nelement vertex 1\n").contains("header does not end"));
        let text = format!("ply\nformat ascii 1.0\n{HEADER}0 0 2 9\n1 0 2 9\n1 1 2 9\n0 1 2 9\n3 0 1 7\n");
        assert!(message(text.as_bytes()).contains("face 0: it refers to vertex 7, but there are 4"));
        assert!(message(b"ply\nformat ascii 1.0\nelements 3\n").contains("\"elements 3\" is not understood; expected format, element"));
    }

    /// A text file of the header's two elements, whose body begins in line 11.
    fn text(body: &str) -> Result<PlyFile, String> {
        read(format!("ply\nformat ascii 1.0\n{HEADER}{body}").as_bytes(), Path::new("a.ply"), false, 1.0).map_err(|e| e.to_string())
    }

    #[test]
    fn rows_that_are_longer_or_shorter_than_the_header_says_are_refused_with_their_line() {
        let error = |body: &str| text(body).unwrap_err();
        let longer = error("0 0 2 9\n1 0 2 9 255\n1 1 2 9\n0 1 2 9\n4 0 1 2 3\n");
        assert!(longer.starts_with("a.ply: line 12: found 5 values in a row of \"vertex\", expected 4 by the header"), "{longer}");
        let longer = error("0 0 2 9\n1 0 2 9\n1 1 2 9\n0 1 2 9\n3 0 1 2 3\n");
        assert!(longer.starts_with("a.ply: line 15: found 5 values in a row of \"face\", expected 4"), "{longer}");
        let shorter = error("0 0 2 9\n1 0 2\n1 1 2 9\n0 1 2 9\n4 0 1 2 3\n");
        assert!(shorter.starts_with("a.ply: line 12: found 3 values in the row, expected more by the header"), "{shorter}");
        let shorter = error("0 0 2 9\n1 0 2 9\n1 1 2 9\n0 1 2 9\n4 0 1 2\n");
        assert!(shorter.starts_with("a.ply: line 15: found 4 values in the row"), "{shorter}");
        assert!(error("0 0 2 9\n1 0 2 9\n").starts_with("a.ply: line 13: the file is cut short"));
        assert!(error("0 0 2 9\n1 zero 2 9\n").starts_with("a.ply: line 12: \"zero\" is not a number"));
    }

    #[test]
    fn rows_over_several_lines_are_read_and_what_follows_the_last_is_told() {
        let plain = text("0 0 2 9\n1 0 2 9\n1 1 2 9\n0 1 2 9\n4 0 1 2 3\n").unwrap();
        assert_eq!(plain.trailing, None);
        let wrapped = text("0 0 2 9\r\n\r\n1 0\r\n 2 9 \r\n1 1 2 9\n0 1 2 9\n4 0 1\n2 3").unwrap();
        assert_eq!(wrapped, plain);
        let more = text("0 0 2 9\n1 0 2 9\n1 1 2 9\n0 1 2 9\n4 0 1 2 3\n3 0 1 2\n\n3 0 2 3\n").unwrap();
        assert_eq!(more.trailing.as_deref(), Some("2 lines follow the last row that the header announces; they were left out"));
        let binary = read(&[binary(false), vec![1; 9]].concat(), Path::new("a.ply"), false, 1.0).unwrap();
        assert_eq!(binary.trailing.as_deref(), Some("9 bytes follow the last row that the header announces; they were left out"));
        assert_eq!(read(&[self::binary(true), vec![0, b'\n']].concat(), Path::new("a.ply"), false, 1.0).unwrap(), plain);
    }

    #[test]
    fn lines_may_end_with_a_carriage_return_alone() {
        let plain = text("0 0 2 9\n1 0 2 9\n1 1 2 9\n0 1 2 9\n4 0 1 2 3\n").unwrap();
        let read = |bytes: &[u8]| read(bytes, Path::new("a.ply"), false, 1.0).map_err(|e| e.to_string());
        let returns = |text: &str| text.replace('\n', "\r").into_bytes();
        let header = format!("ply\nformat ascii 1.0\n{HEADER}");
        assert_eq!(read(&returns(&format!("{header}0 0 2 9\n1 0 2 9\n1 1 2 9\n0 1 2 9\n4 0 1 2 3\n"))).unwrap(), plain);
        let error = read(&returns(&format!("{header}0 0 2 9\n1 0 2 9 255\n"))).unwrap_err();
        assert!(error.starts_with("a.ply: line 12: found 5 values in a row"), "{error}");
        // The first byte of the body equals a line feed.
        let header = "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar x\nproperty uchar y\nproperty uchar z\n\
                      element face 1\nproperty list uchar uchar vertex_indices\nend_header\n";
        let mesh = read(&[returns(header), b"\n\0\0\x01\0\0\x02\x03\0\x03\0\x01\x02".to_vec()].concat()).unwrap().mesh;
        assert_eq!((mesh.positions[0], mesh.triangles), (Vec3::X * 10.0, vec![[0, 1, 2]]));
    }

    #[test]
    fn faces_may_come_before_vertices_and_as_strips() {
        let vertices = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
        let strips = "element tristrips 1\nproperty list int int vertex_indices\n";
        let faces = "element face 2\nproperty list uchar int vertex_indices\n";
        let points = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
        let triangles = |text: String| {
            read(format!("ply\nformat ascii 1.0\n{text}").as_bytes(), Path::new("a.ply"), false, 1.0).unwrap().mesh.triangles
        };
        let expected = vec![[0, 1, 2], [2, 1, 3]];
        assert_eq!(triangles(format!("{faces}{vertices}end_header\n3 0 1 2\n3 2 1 3\n{points}")), expected);
        assert_eq!(triangles(format!("{vertices}{strips}end_header\n{points}4 0 1 2 3\n")), expected);
        assert_eq!(triangles(format!("{strips}{vertices}end_header\n8 0 1 2 -1 2 1 3 -1\n{points}")), expected);
    }

    #[test]
    fn corners_with_texture_coordinates_of_their_own_are_vertices_of_their_own() {
        let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar alpha\n\
                    element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\nproperty uchar red\n\
                    property uchar green\nproperty uchar blue\nend_header\n0 0 0 1\n1 0 0 1\n0 1 0 1\n\
                    3 0 1 2 6 0 0 1 0 0 1 255 0 0\n3 2 1 0 6 0 1 1 0 0.5 0.5 255 0 0\n";
        let ply = read(text.as_bytes(), Path::new("a.ply"), false, 1.0).unwrap();
        assert_eq!(ply.mesh.triangles, [[0, 1, 2], [2, 1, 3]]);
        assert_eq!(ply.mesh.uvs, [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::splat(0.5)]);
        assert_eq!((ply.mean_color, ply.unused), (Some([1.0, 0.0, 0.0]), vec![("vertex".to_string(), vec!["alpha".to_string()])]));
    }
}
