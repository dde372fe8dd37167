//! Names, shapes and places of a scene's parts, in a table beside the labels: by them the labels of one version of a scene find the parts
//! of the next.

use super::scene::AnnotatedScene;
use super::shape::ShapeInvariants;
use enfilade_dataset::{DatasetError, write_bytes};
use enfilade_math::DVec3;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Name of the table in the folder of labels.
pub const SHAPES: &str = "annotation_shapes.csv";
const COLUMNS: [&str; 8] = ["object_name", "faces", "edges_m", "root_area_m", "spread_m", "x_m", "y_m", "z_m"];

/// A part.
#[derive(Clone, Debug, PartialEq)]
pub struct PartShape {
    /// Name of the part.
    pub name: String,
    /// What does not change when it is moved.
    pub shape: ShapeInvariants,
    /// The mean of its corners, metres.
    pub place: DVec3,
}

impl PartShape {
    /// The parts of a scene, in order.
    pub fn of_scene(scene: &AnnotatedScene) -> Vec<Self> {
        let mut corners = vec![Vec::new(); scene.parts.len()];
        scene.part_of_face.iter().zip(&scene.corners).for_each(|(&part, face)| corners[part as usize].push(*face));
        let part = |(name, faces): (&String, &Vec<_>)| {
            let points = faces.iter().flatten().map(|p: &enfilade_math::Vec3| p.as_dvec3());
            let place = points.sum::<DVec3>() / (3 * faces.len()).max(1) as f64;
            Self { name: name.clone(), shape: ShapeInvariants::of(faces.iter()), place }
        };
        scene.parts.iter().zip(&corners).map(part).collect()
    }

    /// Writes the table.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(parts: &[Self], folder: &Path) -> Result<PathBuf, DatasetError> {
        let mut table = csv::Writer::from_writer(Vec::new());
        let mut row = |fields: [String; 8]| table.write_record(fields).expect("writing to memory cannot fail");
        row(COLUMNS.map(Into::into));
        for Self { name, shape, place } in parts {
            let (faces, [edges, area, spread]) = shape.numbers();
            let numbers = [edges, area, spread, place.x, place.y, place.z].map(|number| number.to_string());
            let [edges, area, spread, x, y, z] = numbers;
            row([name.clone(), faces.to_string(), edges, area, spread, x, y, z]);
        }
        let path = folder.join(SHAPES);
        write_bytes(&path, table.into_inner().expect("flushing memory cannot fail")).map(|()| path)
    }

    /// Reads the table in a folder; `None` where there is none.
    ///
    /// # Errors
    /// Which file and line is wrong, and what was expected.
    pub fn read(folder: &Path) -> Result<Option<Vec<Self>>, String> {
        let path = folder.join(SHAPES);
        let bytes = match std::fs::read(&path) {
            Err(e) if e.kind() == ErrorKind::NotFound => return Ok(None),
            bytes => bytes.map_err(|e| format!("cannot read {}: {e}", path.display()))?,
        };
        let mut reader = csv::Reader::from_reader(bytes.as_slice());
        let rows = reader.records().enumerate().map(|(i, record)| {
            let wrong = |problem: String| format!("{}:{}: {problem}; restore a copy", path.display(), i + 2);
            let record = record.map_err(|e| wrong(e.to_string()))?;
            let cell = |column: usize| record.get(column).unwrap_or("");
            let number = |column: usize| {
                let value: Option<f64> = cell(column).parse().ok().filter(|value: &f64| value.is_finite());
                value.ok_or_else(|| wrong(format!("{} is {:?}, expected a number", COLUMNS[column], cell(column))))
            };
            let faces = cell(1).parse().map_err(|_| wrong(format!("faces is {:?}, expected a whole number", cell(1))))?;
            let shape = ShapeInvariants::of_numbers(faces, [number(2)?, number(3)?, number(4)?]);
            Ok(Self { name: cell(0).into(), shape, place: DVec3::new(number(5)?, number(6)?, number(7)?) })
        });
        rows.collect::<Result<_, _>>().map(Some)
    }
}
