//! `annotation_3d.json`: planes, the lines of each, and the two junctions of each line. Millimetres, z up.

use enfilade_math::DVec3;
use serde::Deserialize;

#[derive(Deserialize)]
pub(crate) struct Annotation {
    pub junctions: Vec<Junction>,
    pub planes: Vec<Plane>,
    pub semantics: Vec<Semantic>,
    #[serde(rename = "planeLineMatrix")]
    lines_of_plane: Vec<Vec<u8>>,
    #[serde(rename = "lineJunctionMatrix")]
    junctions_of_line: Vec<Vec<u8>>,
}

#[derive(Deserialize)]
pub(crate) struct Junction {
    pub coordinate: DVec3,
}

#[derive(Deserialize)]
pub(crate) struct Plane {
    pub r#type: String,
    pub normal: DVec3,
}

#[derive(Deserialize)]
pub(crate) struct Semantic {
    pub r#type: String,
    #[serde(rename = "planeID")]
    pub planes: Vec<usize>,
}

impl Annotation {
    /// The junctions at the ends of a plane's lines. Lines that do not have two are left out.
    pub fn lines(&self, plane: usize) -> impl Iterator<Item = [usize; 2]> + '_ {
        let ones = |rows: &'_ [Vec<u8>], i: usize| -> Vec<usize> {
            let row = rows.get(i).map_or(&[][..], Vec::as_slice);
            row.iter().enumerate().filter(|(_, on)| **on != 0).map(|(k, _)| k).collect()
        };
        let ends = move |line: usize| match ones(&self.junctions_of_line, line)[..] {
            [p, q, ..] if p.max(q) < self.junctions.len() => Some([p, q]),
            _ => None,
        };
        ones(&self.lines_of_plane, plane).into_iter().filter_map(ends)
    }
}
