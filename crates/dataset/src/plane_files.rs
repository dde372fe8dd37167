//! The planes of a scene's rooms, `_detail/metadata_planes.csv`, and which of them each pixel shows:
//! `_detail/<camera>/planes/frame.IIII.plane_id.hdf5`.

use crate::hdf5::{Array, Elements, Packing, Storage, read_array, write_array};
use crate::tables::Table;
use crate::{Dataset, DatasetError, check_name, replace_file};
use enfilade_math::DVec3;
use enfilade_scene::{PlaneKind, RoomPlane};

const HEADER: [&str; 8] = ["plane_id", "kind", "room", "wall", "normal_x", "normal_y", "normal_z", "offset_m"];
const KINDS: [PlaneKind; 3] = [PlaneKind::Floor, PlaneKind::Ceiling, PlaneKind::Wall];

impl Dataset {
    /// Writes the planes of a scene's rooms; the first is number 1.
    ///
    /// # Errors
    /// When the file cannot be written, or there are more planes than an int16 counts.
    pub fn write_plane_table(&self, scene: &str, planes: &[RoomPlane]) -> Result<(), DatasetError> {
        check_name("scene name", scene)?;
        if planes.len() > i16::MAX as usize {
            let problem = format!("{} planes, but plane_id is int16 and holds {}", planes.len(), i16::MAX);
            return Err(DatasetError::Unstorable { what: format!("the planes of scene {scene:?}"), problem });
        }
        let mut table = Table::new(&self.layout().plane_table(scene), &HEADER);
        let row = |(i, plane): (usize, &RoomPlane)| {
            let wall = plane.wall.map_or("-1".to_string(), |wall| wall.to_string());
            let mut row = vec![(i + 1).to_string(), plane.kind.name().into(), plane.room.to_string(), wall];
            row.extend(plane.normal.to_array().iter().chain([&plane.offset_m]).map(|v| v.to_string()));
            row
        };
        table.rows = planes.iter().enumerate().map(row).collect();
        table.write()
    }

    /// The planes of a scene's rooms, in the order of their numbers; none if they were not requested.
    ///
    /// # Errors
    /// When the table is damaged.
    pub fn read_plane_table(&self, scene: &str) -> Result<Vec<RoomPlane>, DatasetError> {
        let path = self.layout().plane_table(scene);
        if !path.is_file() {
            return Ok(Vec::new());
        }
        let table = Table::read(&path)?;
        let [id, kind, room, wall, x, y, z, offset] = table.columns(HEADER)?;
        let wrong = |row: usize, expected: &str, found: &str| {
            DatasetError::text(&path, format!("line {}: expected {expected}, found {found:?}; run enfilade make OUT rooms", row + 2))
        };
        let plane = |row: usize| {
            let cell = |column: usize| table.rows[row][column].as_str();
            if cell(id) != (row + 1).to_string() {
                return Err(wrong(row, &format!("plane_id {}", row + 1), cell(id)));
            }
            let named = KINDS.into_iter().find(|known| known.name() == cell(kind));
            Ok(RoomPlane {
                kind: named.ok_or_else(|| wrong(row, "floor, ceiling or wall", cell(kind)))?,
                room: table.parse(row, room)?,
                wall: usize::try_from(table.parse::<i64>(row, wall)?).ok(),
                normal: DVec3::new(table.parse(row, x)?, table.parse(row, y)?, table.parse(row, z)?),
                offset_m: table.parse(row, offset)?,
            })
        };
        (0..table.rows.len()).map(plane).collect()
    }

    /// Writes which plane each pixel of a frame shows, row by row; −1 is none. `size` is height and width.
    ///
    /// # Errors
    /// When a name cannot be part of a path, or the file cannot be written.
    pub fn write_plane_ids(&self, [scene, camera]: [&str; 2], frame: u32, size: [usize; 2], ids: Vec<i16>) -> Result<(), DatasetError> {
        check_name("scene name", scene)?;
        check_name("camera name", camera)?;
        let array = Array::new(&size, Elements::I16(ids));
        let description = "Plane of the scene's layout that the pixel shows, plane_id of metadata_planes.csv; -1: none.";
        let storage = Storage::Image(Packing::of_numbers(array.values.element()));
        let attributes = [("sentinel", "-1"), ("description", description)];
        replace_file(&self.layout().plane_ids(scene, camera, frame), |aside| write_array(aside, &array, storage, &attributes))
    }

    /// The plane that each pixel of a frame shows, as an int16 array of height × width; `None` if that was not requested.
    ///
    /// # Errors
    /// When the file is damaged, or no such image.
    pub fn read_plane_ids(&self, [scene, camera]: [&str; 2], frame: u32) -> Result<Option<Array>, DatasetError> {
        let path = self.layout().plane_ids(scene, camera, frame);
        if !path.is_file() {
            return Ok(None);
        }
        let array = read_array(&path)?;
        if array.shape.len() != 2 || !matches!(array.values, Elements::I16(_)) {
            let found = format!("{} of the shape {:?}", array.values.element().name(), array.shape);
            return Err(DatasetError::hdf5(
                &path,
                format!("expected int16 with height and width, found {found}; run enfilade make OUT rooms"),
            ));
        }
        Ok(Some(array))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_scene::{RoomOutline, Rooms};

    #[test]
    fn planes_come_back_and_tables_that_were_changed_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let names = ["room", "cam_00"];
        assert_eq!((dataset.read_plane_table("room").unwrap(), dataset.read_plane_ids(names, 3).unwrap()), (vec![], None));
        let polygon = vec![[0.0, 0.0], [4.0, 0.5], [4.0, 3.0]];
        let room = RoomOutline { name: "hall_1".into(), kind: "hall".into(), polygon, floor_z_m: 0.1, ceiling_z_m: 2.5 };
        let mut rooms = Rooms::default();
        rooms.push_room(room, &[(0.1, true); 3]);
        let planes = rooms.planes();
        dataset.write_plane_table("room", &planes).unwrap();
        assert_eq!(dataset.read_plane_table("room").unwrap(), planes);
        dataset.write_plane_ids(names, 3, [1, 3], vec![-1, 1, 5]).unwrap();
        let ids = Array::new(&[1, 3], Elements::I16(vec![-1, 1, 5]));
        assert_eq!(dataset.read_plane_ids(names, 3).unwrap(), Some(ids));

        let path = dataset.layout().plane_table("room");
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, text.replace("ceiling", "roof")).unwrap();
        let message = dataset.read_plane_table("room").unwrap_err().to_string();
        assert!(message.contains("line 3: expected floor, ceiling or wall, found \"roof\"; run enfilade make OUT rooms"), "{message}");
    }
}
