//! Surfaces along the rays of a frame's pixels: `_detail/<camera>/surfaces/frame.IIII.<what>.hdf5`.

use crate::atomic::{create_parent, remove_if_there, rename, temporary};
use crate::hdf5::{Array, Elements, Packing, Storage, read_array, write_array};
use crate::{Dataset, DatasetError, check_name};
use enfilade_frame::f16;

/// File by which a frame that has surfaces is known.
const FIRST: &str = "surface_distance_meters";

/// The surfaces that the ray through each pixel's centre meets, straight on through all of them, row by row, and for each pixel from near to
/// far; and by pixel the first that lets no light through, on the way that glass bends.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surfaces {
    /// Height and width of the image.
    pub size: [usize; 2],
    /// Surfaces per pixel at most.
    pub count: usize,
    /// Euclidean distance from the camera centre, metres; NaN beyond the last surface.
    pub distance_m: Vec<f32>,
    /// Part number from 1, as in `render_entity_id`; −1 beyond the last surface.
    pub entity: Vec<i16>,
    /// Class of that part; −1 where it has none, and beyond the last surface.
    pub semantic: Vec<i16>,
    /// 1: front, 2: back of the surface; 0 beyond the last.
    pub side: Vec<u8>,
    /// Unit normal of the flat triangle in the world, facing the camera, three values per surface; NaN beyond the last.
    pub normal_world: Vec<f16>,
    /// Length of the refracted path of each pixel, metres; NaN where it meets no opaque surface.
    pub bent_distance_m: Vec<f32>,
    /// End of the refracted path of each pixel, world space, metres, three values per pixel; NaN as there.
    pub bent_position: Vec<f32>,
    /// The part on which the refracted path of each pixel ends; −1 where it meets none.
    pub bent_entity: Vec<i16>,
}

/// Name, unit and description of each file.
const FILES: [(&str, &str, &str); 8] = [
    (FIRST, "m", "Euclidean distance to each surface along the pixel's ray, from near to far; NaN beyond the last."),
    ("surface_entity_id", "", "Part number of each surface, as render_entity_id; -1 beyond the last."),
    ("surface_semantic", "", "Class of that part; -1 where it has none, and beyond the last."),
    ("surface_side", "", "1: the front of the surface is seen, to which its outward normals point; 2: its back; 0 beyond the last."),
    ("surface_normal_world", "", "Unit normal of the flat triangle, world, facing the camera; reshape to (height, width, surfaces, 3)."),
    ("refracted_distance_meters", "m", "Length of the way to the first surface that lets no light through, as glass bends it; NaN: none."),
    ("refracted_position", "m", "Where that way ends, in the world; NaN where it meets none."),
    ("refracted_entity_id", "", "Part number of the surface that it ends on; -1 where it meets none."),
];

/// The shape of each file.
fn shapes([height, width]: [usize; 2], count: usize) -> [Vec<usize>; FILES.len()] {
    let image = |channels: usize| vec![height, width, channels];
    [image(count), image(count), image(count), image(count), image(3 * count), vec![height, width], image(3), vec![height, width]]
}

impl Dataset {
    /// Writes the surfaces along the rays of a frame.
    ///
    /// # Errors
    /// When a name cannot be part of a path, or a file cannot be written.
    pub fn write_surfaces(&self, scene: &str, camera: &str, frame: u32, surfaces: Surfaces) -> Result<(), DatasetError> {
        check_name("scene name", scene)?;
        check_name("camera name", camera)?;
        let shapes = shapes(surfaces.size, surfaces.count);
        let values = [
            Elements::F32(surfaces.distance_m),
            Elements::I16(surfaces.entity),
            Elements::I16(surfaces.semantic),
            Elements::U8(surfaces.side),
            Elements::F16(surfaces.normal_world),
            Elements::F32(surfaces.bent_distance_m),
            Elements::F32(surfaces.bent_position),
            Elements::I16(surfaces.bent_entity),
        ];
        // The first file exists only if all do.
        remove_if_there(&self.layout().surfaces(scene, camera, frame, FIRST))?;
        for (((name, unit, description), shape), values) in FILES.iter().zip(shapes).zip(values).rev() {
            let array = Array::new(&shape, values);
            let path = self.layout().surfaces(scene, camera, frame, name);
            create_parent(&path)?;
            let attributes = [("unit", *unit), ("description", *description)];
            let attributes: Vec<_> = attributes.into_iter().filter(|(_, text)| !text.is_empty()).collect();
            let aside = temporary(&path);
            write_array(&aside, &array, Storage::Image(Packing::of_numbers(array.values.element())), &attributes)?;
            rename(&aside, &path)?;
        }
        Ok(())
    }

    /// The surfaces along the rays of a frame.
    ///
    /// # Errors
    /// When a file is missing, damaged, or not what [`Dataset::write_surfaces`] writes.
    pub fn read_surfaces(&self, scene: &str, camera: &str, frame: u32) -> Result<Surfaces, DatasetError> {
        let read = |index: usize| {
            let path = self.layout().surfaces(scene, camera, frame, FILES[index].0);
            let array = read_array(&path)?;
            Ok((array, path))
        };
        let (first, path) = read(0)?;
        let (height, width, n, distance_m) = match (&first.shape[..], first.values) {
            (&[height, width, n], Elements::F32(values)) if n > 0 => (height, width, n, values),
            (shape, values) => {
                let found = format!("{} of the shape {shape:?}", values.element().name());
                let expected = "expected float32 with height, width and at least one surface";
                return Err(DatasetError::hdf5(&path, format!("{expected}, found {found}; run enfilade make OUT surfaces")));
            }
        };
        let shapes = shapes([height, width], n);
        let values = |index: usize| {
            let (array, path) = read(index)?;
            if array.shape != shapes[index] {
                let problem = format!("expected the shape {:?}, found {:?}; run enfilade make OUT surfaces", shapes[index], array.shape);
                return Err(DatasetError::hdf5(&path, problem));
            }
            Ok((array.values, path))
        };
        let wrong = |(found, path): (Elements, std::path::PathBuf)| {
            DatasetError::hdf5(&path, format!("values of another type, {}; run enfilade make OUT surfaces", found.element().name()))
        };
        let floats = |index| match values(index)? {
            (Elements::F32(values), _) => Ok(values),
            other => Err(wrong(other)),
        };
        let numbers = |index| match values(index)? {
            (Elements::I16(values), _) => Ok(values),
            other => Err(wrong(other)),
        };
        Ok(Surfaces {
            size: [height, width],
            count: n,
            distance_m,
            entity: numbers(1)?,
            semantic: numbers(2)?,
            side: match values(3)? {
                (Elements::U8(values), _) => values,
                other => return Err(wrong(other)),
            },
            normal_world: match values(4)? {
                (Elements::F16(values), _) => values,
                other => return Err(wrong(other)),
            },
            bent_distance_m: floats(5)?,
            bent_position: floats(6)?,
            bent_entity: numbers(7)?,
        })
    }

    /// True when a frame has surfaces.
    pub fn has_surfaces(&self, scene: &str, camera: &str, frame: u32) -> bool {
        self.layout().surfaces(scene, camera, frame, FIRST).is_file()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surfaces_come_back_and_other_files_in_their_place_are_told() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        assert!(!dataset.has_surfaces("room", "cam_00", 3));
        let surfaces = Surfaces {
            size: [1, 2],
            count: 2,
            distance_m: vec![1.0, 2.0, 3.0, 4.0],
            entity: vec![1, 2, 3, -1],
            semantic: vec![5, -1, 2, -1],
            side: vec![1, 2, 1, 0],
            normal_world: (0..12).map(|i| f16::from_f32(i as f32)).collect(),
            bent_distance_m: vec![2.5, 3.0],
            bent_position: vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0],
            bent_entity: vec![2, 3],
        };
        dataset.write_surfaces("room", "cam_00", 12, surfaces.clone()).unwrap();
        assert!(dataset.has_surfaces("room", "cam_00", 12) && !dataset.has_surfaces("room", "cam_00", 3));
        assert_eq!(dataset.read_surfaces("room", "cam_00", 12).unwrap(), surfaces);
        let path = |what: &str| dataset.layout().surfaces("room", "cam_00", 12, what);
        std::fs::copy(path("surface_entity_id"), path("surface_side")).unwrap();
        let message = dataset.read_surfaces("room", "cam_00", 12).unwrap_err().to_string();
        assert!(message.contains("frame.0012.surface_side.hdf5: values of another type, int16"), "{message}");
        std::fs::copy(path("refracted_entity_id"), path("surface_side")).unwrap();
        assert!(
            dataset.read_surfaces("room", "cam_00", 12).unwrap_err().to_string().contains("expected the shape [1, 2, 2], found [1, 2]")
        );
    }
}
