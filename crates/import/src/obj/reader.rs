//! Reading the OBJ text: vertices, faces, groups and material names. Mitsuba's `obj` shapes use it as well.

use super::file::{Face, Group, NONE, ObjFile};
use super::{groups, text};
use crate::ImportError;
use enfilade_math::{DVec3, Vec2, Vec3};
use enfilade_scene::decoded_text;
use std::collections::HashMap;
use std::path::Path;

/// Note on colours of vertices.
pub(super) const COLORS_DROPPED: &str = "vertex colours dropped";

impl ObjFile {
    /// Parses the bytes of `file`.
    ///
    /// # Errors
    /// A number or index that makes no sense, with its line.
    pub(crate) fn parse(bytes: &[u8], file: &Path) -> Result<Self, ImportError> {
        let text = decoded_text(bytes);
        let mut parser = Parser {
            file,
            obj: Self::default(),
            by_key: HashMap::new(),
            object: 0,
            object_name: None,
            name: None,
            material: None,
            smoothing: 0,
            current: None,
            dangling: [Dangling::default(); 2],
        };
        let mut continued = String::new();
        for (number, line) in text::lines(&text).enumerate() {
            let line =
                text::without_comment(line, |keyword| ["o", "g", "usemtl", "mtllib"].iter().any(|k| keyword.eq_ignore_ascii_case(k)));
            if let Some(start) = line.strip_suffix('\\') {
                continued.push_str(start);
                continued.push(' ');
            } else if continued.is_empty() {
                parser.line(line, number + 1)?;
            } else {
                let whole = std::mem::take(&mut continued) + line;
                parser.line(&whole, number + 1)?;
            }
        }
        parser.check()?;
        groups::split(&mut parser.obj.groups);
        Ok(parser.obj)
    }
}

/// Corners that refer to texture coordinates or normals that the file lacks.
#[derive(Clone, Copy, Default)]
struct Dangling {
    count: usize,
    /// Line and index, as it is written, of the first of them.
    first: Option<(usize, i64)>,
}

struct Parser<'p> {
    file: &'p Path,
    obj: ObjFile,
    by_key: HashMap<(usize, Option<String>, Option<String>), usize>,
    object: usize,
    object_name: Option<String>,
    name: Option<String>,
    material: Option<String>,
    smoothing: u32,
    current: Option<usize>,
    /// Indices without a value, of texture coordinates and of normals.
    dangling: [Dangling; 2],
}

impl Parser<'_> {
    fn line(&mut self, line: &str, number: usize) -> Result<(), ImportError> {
        let line = line.trim();
        let (keyword, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        let rest = rest.trim();
        let text = || (!rest.is_empty()).then(|| rest.to_string());
        match &*keyword.to_ascii_lowercase() {
            "" | "vp" => (),
            // "off" is 0; groups without a number, as some programs write, are one.
            "s" => self.smoothing = if rest.eq_ignore_ascii_case("off") { 0 } else { rest.parse().unwrap_or(1) },
            "v" => {
                let position = DVec3::from_array(self.numbers(rest, 3, number, false)?);
                if !position.as_vec3().is_finite() {
                    let problem = format!("the vertex {rest:?} is not finite; clean the mesh in the program that made it");
                    return Err(self.error(number, problem));
                }
                if let [_, _, _, red, green, blue] = rest.split_whitespace().collect::<Vec<_>>()[..] {
                    self.note(COLORS_DROPPED);
                    let channel = |word: &str| word.parse::<f32>().ok().filter(|v| v.is_finite());
                    let color = channel(red).zip(channel(green)).zip(channel(blue)).map(|((r, g), b)| Vec3::new(r, g, b));
                    self.obj.colors.resize(self.obj.positions.len(), None);
                    self.obj.colors.push(color);
                }
                self.obj.positions.push(position);
            }
            "vt" => {
                let [u, v, _] = self.numbers(rest, 1, number, true)?;
                self.obj.uvs.push(Vec2::new(u as f32, v as f32));
            }
            "vn" => {
                let n = self.numbers(rest, 3, number, true)?;
                self.obj.normals.push(Vec3::from(n.map(|v| v as f32)));
            }
            "f" | "fo" => self.face(rest, number)?,
            "o" | "g" => {
                self.name = text();
                if keyword.eq_ignore_ascii_case("o") {
                    self.object += 1;
                    self.object_name = self.name.clone();
                }
                self.current = None;
            }
            "usemtl" => {
                self.material = text();
                self.current = None;
            }
            "mtllib" => self.obj.libraries.extend(text()),
            "l" | "p" => self.note("points and lines have no surface and were left out"),
            _ => self.note(&format!("{keyword:?} statements ignored")),
        }
        Ok(())
    }

    fn face(&mut self, rest: &str, number: usize) -> Result<(), ImportError> {
        let index = match self.current {
            Some(index) => index,
            None => self.open_group(),
        };
        let first = self.obj.groups[index].corners.len();
        for word in rest.split_whitespace() {
            let corner = self.corner(word, number)?;
            self.obj.groups[index].corners.push(corner);
        }
        let group = &mut self.obj.groups[index];
        if group.corners.len() - first < 3 {
            group.corners.truncate(first);
            self.note("faces with fewer than three corners left out");
        } else {
            group.faces.push(Face { first: first as u32, line: number as u32, smoothing: self.smoothing });
        }
        Ok(())
    }

    fn open_group(&mut self) -> usize {
        let key = (self.object, self.name.clone(), self.material.clone());
        let groups = &mut self.obj.groups;
        let index = *self.by_key.entry(key.clone()).or_insert_with(|| {
            groups.push(Group {
                object: key.0,
                object_name: self.object_name.clone(),
                name: key.1,
                around: Vec::new(),
                material: key.2,
                corners: Vec::new(),
                faces: Vec::new(),
            });
            groups.len() - 1
        });
        self.current = Some(index);
        index
    }

    /// One corner `v`, `v/vt`, `v//vn` or `v/vt/vn`; negative indices count back from the last vertex so far.
    fn corner(&mut self, word: &str, number: usize) -> Result<[u32; 3], ImportError> {
        let counts = [self.obj.positions.len(), self.obj.uvs.len(), self.obj.normals.len()];
        let mut corner = [NONE; 3];
        let mut fields = word.split('/');
        for k in 0..3 {
            let field = fields.next().unwrap_or_default();
            if field.is_empty() && k > 0 {
                continue;
            }
            let index: i64 = text::whole(field)
                .ok_or_else(|| self.error(number, format!("{word:?} is not a corner; expected v/vt/vn as whole numbers")))?;
            let absolute = if index < 0 { (counts[k] as i64).saturating_add(index) } else { index - 1 };
            match u32::try_from(absolute).ok().filter(|&i| i != NONE) {
                Some(index) => corner[k] = index,
                None if k > 0 => self.dangles(k, number, index),
                None => {
                    let problem = format!(
                        "the face refers to index {index}, but there are {} so far, counted from 1; export the file again",
                        counts[k]
                    );
                    return Err(self.error(number, problem));
                }
            }
        }
        Ok(corner)
    }

    /// Counts a corner whose index of kind `k`, 1 for texture coordinates and 2 for normals, leads to nothing.
    fn dangles(&mut self, k: usize, line: usize, index: i64) {
        let dangling = &mut self.dangling[k - 1];
        dangling.count += 1;
        // Faces are checked group by group, not line by line.
        if dangling.first.is_none_or(|(first, _)| line < first) {
            dangling.first = Some((line, index));
        }
    }

    /// Checks every index of every face, which may come before the vertices that it refers to. Those of texture coordinates and normals
    /// that the file lacks are taken out, with a note.
    fn check(&mut self) -> Result<(), ImportError> {
        let counts = [self.obj.positions.len(), self.obj.uvs.len(), self.obj.normals.len()];
        let mut groups = std::mem::take(&mut self.obj.groups);
        for group in &mut groups {
            for i in 0..group.faces.len() {
                let (line, range) = (group.faces[i].line, group.range_of(i));
                for corner in &mut group.corners[range] {
                    for k in 0..3 {
                        if corner[k] == NONE || (corner[k] as usize) < counts[k] {
                            continue;
                        }
                        let written = i64::from(corner[k]) + 1;
                        if k == 0 {
                            let problem =
                                format!("the face refers to vertex {written}, but there are only {}; export the file again", counts[k]);
                            return Err(self.error(line as usize, problem));
                        }
                        self.dangles(k, line as usize, written);
                        corner[k] = NONE;
                    }
                }
            }
        }
        self.obj.groups = groups;
        for (k, kind) in [(1, "texture coordinates"), (2, "normals")] {
            let Dangling { count, first } = self.dangling[k - 1];
            let Some((line, index)) = first else { continue };
            let problem = format!(
                "{count} corners of faces refer to {kind} that are not there, first in line {line} (number {index} of {}); they are without, \
                 so export the file again where that is seen",
                counts[k]
            );
            self.note(&problem);
        }
        Ok(())
    }

    /// Up to three numbers, of which `required` must be there. Where `lenient`, what some writers print for "not a number" is one.
    fn numbers(&self, rest: &str, required: usize, number: usize, lenient: bool) -> Result<[f64; 3], ImportError> {
        let mut values = [0.0; 3];
        let mut words = rest.split_whitespace();
        for (i, value) in values.iter_mut().enumerate() {
            match words.next() {
                None if i >= required => break,
                None => return Err(self.error(number, format!("found {i} numbers in {rest:?}, expected {required}"))),
                Some(word) => {
                    let odd = lenient && (word.to_ascii_lowercase().contains("nan") || word.contains("IND"));
                    let parsed = text::number(word).or(odd.then_some(f64::NAN));
                    *value = parsed.ok_or_else(|| self.error(number, format!("{word:?} is not a number")))?;
                }
            }
        }
        Ok(values)
    }

    fn note(&mut self, note: &str) {
        if !self.obj.notes.iter().any(|n| n == note) {
            self.obj.notes.push(note.to_string());
        }
    }

    fn error(&self, line: usize, problem: String) -> ImportError {
        ImportError::malformed(self.file, format!("line {line}"), problem)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<ObjFile, ImportError> {
        ObjFile::parse(text.as_bytes(), Path::new("a.obj"))
    }

    #[test]
    fn groups_materials_negative_indices_and_polygons() {
        let text = "mtllib my materials.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\no Big Chair\nusemtl Red Wood\nf -4/1 -3/1 -2/1 \\\n -1/1\n\
                    usemtl Steel\nf 1 2 3\nusemtl Red Wood\nf 1 3 4\n";
        let obj = parse(text).unwrap();
        assert_eq!(obj.libraries, ["my materials.mtl"]);
        let names: Vec<_> = obj.groups.iter().map(|g| (g.name.as_deref().unwrap(), g.material.as_deref().unwrap())).collect();
        assert_eq!(names, [("Big Chair", "Red Wood"), ("Big Chair", "Steel")]);
        let mesh = obj.mesh(obj.groups[..1].iter());
        assert_eq!((mesh.triangles.len(), mesh.uvs.len(), mesh.normals.len()), (3, mesh.positions.len(), 0));
        assert_eq!(mesh.validate(), Ok(()));
    }

    #[test]
    fn number_signs_begin_comments_but_not_within_names() {
        let text = "# a room\nmtllib set#1.mtl\nv 0 0 0 # origin\nv 1 0 0#\nv 0 1 0\n  # faces\ng Chair #1\nusemtl Wood #1\nf 1 2 3 # one\n\
                    usemtl Wood #2\nf 1 2 3\n";
        let obj = parse(text).unwrap();
        assert_eq!(obj.libraries, ["set#1.mtl"]);
        let names: Vec<_> = obj.groups.iter().map(|g| (g.name.as_deref().unwrap(), g.material.as_deref().unwrap())).collect();
        assert_eq!(names, [("Chair #1", "Wood #1"), ("Chair #1", "Wood #2")]);
        assert!(obj.notes.is_empty(), "{:?}", obj.notes);
    }

    #[test]
    fn mistakes_are_named_with_their_line() {
        let message = |text: &str| parse(text).err().unwrap().to_string();
        assert_eq!(
            message("v 0 0 0\nv 0 1 0\nv 1 0 0\nf 1 2 4\n"),
            "a.obj: line 4: the face refers to vertex 4, but there are only 3; export the file again"
        );
        assert!(message("v 0 0 0\nf 0 1 1").contains("line 2: the face refers to index 0"));
        assert!(message("v 0 0 0\nf -2 1 1").contains("line 2: the face refers to index -2"));
        assert!(message("v 0 zero 0").contains("line 1: \"zero\" is not a number"));
        assert!(message("v 0 0").contains("line 1: found 2 numbers"));
        assert!(message("v 0 nan 0").contains("line 1: the vertex \"0 nan 0\" is not finite"));
        assert!(message("v 0 0 0\nf 1/x 1 1").contains("is not a corner"));
        assert!(parse("vn -nan(ind) 0 0\nvt -1.#IND 0\n").is_ok());
    }

    #[test]
    fn indices_of_texture_coordinates_and_normals_that_are_not_there_are_dropped_and_counted() {
        let points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0.5 0.5\n";
        let obj = parse(&format!("{points}f 1/1/1 2/2/1 3/1/1\ng second\nf 1/0 2/-9 3/1\nf 1/99999999999 2/1 3/1\n")).unwrap();
        let mesh = obj.mesh(obj.groups.iter());
        assert_eq!((mesh.triangles.len(), mesh.normals.len()), (3, 0));
        assert_eq!(mesh.uvs[..3], [Vec2::splat(0.5), Vec2::ZERO, Vec2::splat(0.5)]);
        assert_eq!(obj.notes.len(), 2, "{:?}", obj.notes);
        let expected = "4 corners of faces refer to texture coordinates that are not there, first in line 5 (number 2 of 1)";
        assert!(obj.notes[0].starts_with(expected), "{:?}", obj.notes);
        assert!(obj.notes[1].starts_with("3 corners of faces refer to normals that are not there, first in line 5"), "{:?}", obj.notes);
        // Those that come later in the file are there.
        assert!(parse(&format!("f 1/1 2/1 3/1\n{points}")).unwrap().notes.is_empty());
    }
}
