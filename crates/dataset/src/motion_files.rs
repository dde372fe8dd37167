//! What moves or can move in a scene: `_detail/metadata_bodies.csv` lists the bodies and their joints, and where one moves
//! `metadata_body_poses.csv` of each camera has their places in its frames. Scenes without bodies have neither.

use crate::atomic::remove_if_there;
use crate::tables::Table;
use crate::{Dataset, DatasetError, check_name};
use enfilade_math::{DAffine3, DVec3};
use enfilade_scene::{CameraView, DEFORM, PartLabel, band_of_row};
use std::collections::BTreeMap;

/// The columns of a joint's axis.
const AXIS: [&str; 3] = ["axis_x", "axis_y", "axis_z"];
/// The columns of a point on the axis.
const POINT: [&str; 3] = ["point_x", "point_y", "point_z"];
/// The columns of the ends of a joint.
const LIMITS: [&str; 2] = ["state_min", "state_max"];
/// The columns of a map of the world to itself: three rows of the rotation, each with the translation at its end.
const MATRIX: [&str; 12] = ["r00", "r01", "r02", "t0", "r10", "r11", "r12", "t1", "r20", "r21", "r22", "t2"];
/// The column of the first row of a band; only of cameras whose rows show several moments.
const FIRST_ROW: &str = "first_row";

/// Parts that move as one.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyRow {
    /// From 1 on, without gaps; a body comes after the one that bears it.
    pub id: u32,
    /// Unique name.
    pub name: String,
    /// Id of the body that bears it.
    pub parent: Option<u32>,
    /// `free`, `hinge` or `slide`; `deform` of a part that changes its shape.
    pub joint: String,
    /// Direction of the joint's axis, world, at rest; unit length. `None` of free bodies.
    pub axis: Option<[f64; 3]>,
    /// A point on the axis of a hinge, world, at rest, metres.
    pub point: Option<[f64; 3]>,
    /// The least and the greatest state: radians of a hinge, metres of a slide, from rest.
    pub limits: Option<[f64; 2]>,
    /// Whether it moves in the course of the frames.
    pub moves: bool,
    /// Parts of the body, as `render_entity_id` numbers them.
    pub node_ids: Vec<u32>,
}

/// The places of all bodies in a frame, or in a band of its rows: a rolling shutter exposes these one after the other.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameBodies {
    /// Frame number.
    pub frame: u32,
    /// The first row of the band; 0 where all rows show one moment.
    pub first_row: u32,
    /// The moment of the scene that it shows.
    pub time_s: f64,
    /// By body: the map of the world to itself that takes it from rest to its place.
    pub world_from_rest: Vec<DAffine3>,
    /// By body: the state of its joint, radians of a hinge, metres of a slide, from rest; `None` of free bodies.
    pub states: Vec<Option<f64>>,
}

/// The bodies of a scene in the frames of a camera.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmedBodies {
    /// All bodies.
    pub bodies: Vec<BodyRow>,
    /// By frame: the bands of its rows, from the upper border on.
    frames: BTreeMap<u32, Vec<FrameBodies>>,
    /// By node: index of its body.
    body_of_node: Vec<Option<u32>>,
}

/// Where the parts of a scene are in a frame.
///
/// ```
/// use enfilade_dataset::BodyPlaces;
/// use enfilade_math::DVec3;
/// // In scenes where nothing moves every point stays.
/// assert_eq!(BodyPlaces::default().carry(&BodyPlaces::default(), 7, DVec3::X), Some(DVec3::X));
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct BodyPlaces<'a> {
    body_of_node: &'a [Option<u32>],
    bodies: &'a [BodyRow],
    /// Bands of rows; none of a frame that is not listed.
    bands: &'a [FrameBodies],
}

impl<'a> BodyPlaces<'a> {
    /// Whether a part, by its `render_entity_id`, changes its shape over time, so that no map takes its points along.
    pub fn deforms(&self, entity: i64) -> bool {
        self.body(entity).and_then(|body| self.bodies.get(body)).is_some_and(|body| body.joint == DEFORM)
    }

    /// The map that takes a part, by its `render_entity_id`, from rest to its place at the frame's own moment, that of its middle row; `None`
    /// of parts that never move.
    pub fn world_from_rest(&self, entity: i64) -> Option<&'a DAffine3> {
        self.bands.get(self.bands.len() / 2)?.world_from_rest.get(self.body(entity)?)
    }

    fn body(&self, entity: i64) -> Option<usize> {
        self.body_of_node.get(usize::try_from(entity - 1).ok()?).copied().flatten().map(|body| body as usize)
    }

    /// The places when the row at image coordinate `y` is exposed.
    #[must_use]
    pub fn in_row(&self, y: f64) -> Self {
        if self.bands.len() < 2 { *self } else { self.in_band(band_of_row(self.bands.len(), |band| self.bands[band].first_row, y)) }
    }

    fn in_band(&self, band: usize) -> Self {
        Self { bands: &self.bands[band..=band], ..*self }
    }

    /// The maps that take instances from rest to their places, by their numbers: of those that move. `None` of instances whose parts deform or
    /// go different ways, so that no single pose is theirs. `labels` has a row per part, in the order of `render_entity_id`.
    pub fn instances(&self, labels: &[PartLabel]) -> BTreeMap<i16, Option<DAffine3>> {
        let mut maps: BTreeMap<i16, Option<DAffine3>> = BTreeMap::new();
        for (label, entity) in labels.iter().zip(1..).filter(|(label, _)| label.instance > 0) {
            let own = self.world_from_rest(entity).copied().unwrap_or(DAffine3::IDENTITY);
            let map = maps.entry(label.instance).or_insert(Some(own));
            if *map != Some(own) || self.deforms(entity) {
                *map = None;
            }
        }
        maps.retain(|_, map| *map != Some(DAffine3::IDENTITY));
        maps
    }

    /// The place in the frame `to`, when its `view` shows it, of a surface point that the row at image coordinate `y` shows here at `p_world`,
    /// on a part by its `render_entity_id`; `None` of parts that deform.
    pub fn carry_to(&self, y: f64, (to, view): (&BodyPlaces<'_>, &CameraView<'_>), entity: i64, p_world: DVec3) -> Option<DVec3> {
        let here = self.in_row(y);
        if to.bands.len() < 2 || self.body(entity).is_none() {
            return here.carry(to, entity, p_world);
        }
        let place = |band: usize| here.carry(&to.in_band(band), entity, p_world);
        place(0)?;
        place(view.band_that_shows(to.bands.len(), |band| to.bands[band].first_row, |band| place(band).unwrap_or(p_world)))
    }

    /// The place in the frame `to` of a surface point that is here at `p_world`, on a part by its `render_entity_id`, both at the frames' own
    /// moments; `None` of parts that deform.
    pub fn carry(&self, to: &BodyPlaces<'_>, entity: i64, p_world: DVec3) -> Option<DVec3> {
        if self.deforms(entity) || to.deforms(entity) {
            return None;
        }
        Some(match (self.world_from_rest(entity), to.world_from_rest(entity)) {
            (Some(here), Some(there)) if here != there => there.transform_point3(here.inverse().transform_point3(p_world)),
            _ => p_world,
        })
    }

    /// The place at rest of a point on a part; `None` of parts that deform.
    pub fn at_rest(&self, entity: i64, p_world: DVec3) -> Option<DVec3> {
        let rest = || self.world_from_rest(entity).map_or(p_world, |here| here.inverse().transform_point3(p_world));
        (!self.deforms(entity)).then(rest)
    }
}

impl FilmedBodies {
    fn new(bodies: Vec<BodyRow>, frames: BTreeMap<u32, Vec<FrameBodies>>) -> Self {
        let last = bodies.iter().flat_map(|body| &body.node_ids).max().map_or(0, |&id| id as usize);
        let mut body_of_node = vec![None; last];
        for (body, index) in bodies.iter().zip(0..) {
            body.node_ids.iter().for_each(|&id| body_of_node[id as usize - 1] = Some(index));
        }
        Self { bodies, frames, body_of_node }
    }

    /// Where the parts are in a frame; at rest in one that is not listed.
    pub fn at(&self, frame: u32) -> BodyPlaces<'_> {
        BodyPlaces { body_of_node: &self.body_of_node, bodies: &self.bodies, bands: self.bands(frame) }
    }

    /// The bands of the rows of a frame, from the upper border on: one where all rows show one moment; none of a frame that is not listed.
    pub fn bands(&self, frame: u32) -> &[FrameBodies] {
        self.frames.get(&frame).map_or(&[], Vec::as_slice)
    }

    /// The frames that are listed, in their order, at their own moments: those of their middle rows.
    pub fn frames(&self) -> impl Iterator<Item = &FrameBodies> {
        self.frames.values().filter_map(|bands| bands.get(bands.len() / 2))
    }
}

impl Dataset {
    /// Writes the bodies of a scene; none remove the table.
    ///
    /// # Errors
    /// When the name cannot be part of a path, or the file cannot be written.
    pub fn write_bodies(&self, scene: &str, bodies: &[BodyRow]) -> Result<(), DatasetError> {
        check_name("scene name", scene)?;
        let path = self.layout().metadata_bodies(scene);
        if bodies.is_empty() {
            return remove_if_there(&path);
        }
        let header: Vec<&str> = ["body_id", "name", "parent_id", "joint"]
            .into_iter()
            .chain(AXIS)
            .chain(POINT)
            .chain(LIMITS)
            .chain(["moves", "node_ids"])
            .collect();
        let mut table = Table::new(&path, &header);
        let row = |body: &BodyRow| {
            let ids: Vec<String> = body.node_ids.iter().map(ToString::to_string).collect();
            let parent = body.parent.map_or_else(String::new, |parent| parent.to_string());
            let mut cells = vec![body.id.to_string(), body.name.clone(), parent, body.joint.clone()];
            cells.extend(cells_of(body.axis).into_iter().chain(cells_of(body.point)).chain(cells_of(body.limits)));
            cells.extend([u8::from(body.moves).to_string(), ids.join(" ")]);
            cells
        };
        table.rows = bodies.iter().map(row).collect();
        table.write()
    }

    /// Writes the places of a scene's bodies in the frames of a camera, or in the bands of their rows; none remove the table.
    ///
    /// # Errors
    /// When a name cannot be part of a path, or the file cannot be written.
    pub fn write_body_poses(&self, scene: &str, camera: &str, frames: &[FrameBodies]) -> Result<(), DatasetError> {
        check_name("scene name", scene)?;
        check_name("camera name", camera)?;
        let path = self.layout().metadata_body_poses(scene, camera);
        if frames.is_empty() {
            return remove_if_there(&path);
        }
        let rolls = frames.iter().any(|band| band.first_row > 0);
        let first_row = rolls.then_some(FIRST_ROW);
        let header: Vec<&str> = ["frame_id", "time_seconds", "body_id", "state"].into_iter().chain(MATRIX).chain(first_row).collect();
        let mut table = Table::new(&path, &header);
        for frame in frames {
            for ((map, state), id) in frame.world_from_rest.iter().zip(&frame.states).zip(1..) {
                let [x, y, z] = map.matrix3.transpose().to_cols_array_2d();
                let rows = [x, y, z].into_iter().zip(map.translation.to_array()).flat_map(|([a, b, c], t)| [a, b, c, t]);
                let begin = [frame.frame.to_string(), frame.time_s.to_string(), i32::to_string(&id)];
                let begin = begin.into_iter().chain(cells_of(state.map(|state| [state])));
                let end = rolls.then(|| frame.first_row.to_string());
                table.rows.push(begin.chain(rows.map(|value| value.to_string())).chain(end).collect());
            }
        }
        table.write()
    }

    /// The bodies of a scene; none where nothing can move.
    ///
    /// # Errors
    /// When the table cannot be read.
    pub fn read_bodies(&self, scene: &str) -> Result<Vec<BodyRow>, DatasetError> {
        let path = self.layout().metadata_bodies(scene);
        if !path.is_file() {
            return Ok(Vec::new());
        }
        let table = Table::read(&path)?;
        let [id, name, parent, joint, moves, ids] = table.columns(["body_id", "name", "parent_id", "joint", "moves", "node_ids"])?;
        let (axis, point, limits) = (table.columns(AXIS)?, table.columns(POINT)?, table.columns(LIMITS)?);
        let wrong = |row: usize, what: &str, found: &str| {
            DatasetError::text(&path, format!("line {}: expected {what}, found {found:?}; render the scene again", row + 2))
        };
        let body = |row: usize| {
            let [found, parent, nodes] = [id, parent, ids].map(|column| table.rows[row][column].as_str());
            let number = row as u32 + 1;
            if found != number.to_string() {
                return Err(wrong(row, &format!("body_id {number}"), found));
            }
            let parent = match parent {
                "" => None,
                text => {
                    Some(text.parse().ok().filter(|id| (1..number).contains(id)).ok_or_else(|| wrong(row, "an earlier body_id", text))?)
                }
            };
            let node_ids: Option<Vec<u32>> = nodes.split_whitespace().map(|id| id.parse().ok().filter(|&id| id > 0)).collect();
            let node_ids = node_ids.ok_or_else(|| wrong(row, "node_ids from 1", nodes))?;
            Ok(BodyRow {
                id: number,
                name: table.rows[row][name].clone(),
                parent,
                joint: table.rows[row][joint].clone(),
                axis: numbers(&table, row, axis)?,
                point: numbers(&table, row, point)?,
                limits: numbers(&table, row, limits)?,
                moves: table.parse::<u8>(row, moves)? != 0,
                node_ids,
            })
        };
        (0..table.rows.len()).map(body).collect()
    }

    /// Whether anything in a scene moves in the course of its frames.
    ///
    /// # Errors
    /// When the table cannot be read.
    pub fn moves(&self, scene: &str) -> Result<bool, DatasetError> {
        Ok(self.read_bodies(scene)?.iter().any(|body| body.moves))
    }

    /// The bodies of a scene in the frames of a camera; `None` where nothing moves.
    ///
    /// # Errors
    /// When a table cannot be read, or the poses are not of these bodies.
    pub fn read_filmed_bodies(&self, scene: &str, camera: &str) -> Result<Option<FilmedBodies>, DatasetError> {
        let bodies = self.read_bodies(scene)?;
        if !bodies.iter().any(|body| body.moves) {
            return Ok(None);
        }
        let path = self.layout().metadata_body_poses(scene, camera);
        let table = Table::read(&path)?;
        let [frame, time, id, state] = table.columns(["frame_id", "time_seconds", "body_id", "state"])?;
        let matrix = table.columns(MATRIX)?;
        let first_row = table.header.iter().position(|name| name == FIRST_ROW);
        let mut frames: BTreeMap<u32, Vec<FrameBodies>> = BTreeMap::new();
        for row in 0..table.rows.len() {
            let (number, time_s) = (table.parse(row, frame)?, table.parse(row, time)?);
            let first_row = first_row.map_or(Ok(0), |column| table.parse(row, column))?;
            let bands = frames.entry(number).or_default();
            if bands.last().is_none_or(|band| band.first_row != first_row) {
                if bands.last().map_or(first_row != 0, |band| band.first_row > first_row) {
                    let problem = format!("line {}: first_row of frame {number} does not ascend from 0; render the scene again", row + 2);
                    return Err(DatasetError::text(&path, problem));
                }
                bands.push(FrameBodies { frame: number, first_row, time_s, world_from_rest: Vec::new(), states: Vec::new() });
            }
            let Some(listed) = bands.last_mut() else { continue };
            if table.parse::<usize>(row, id)? != listed.world_from_rest.len() + 1 {
                let problem = format!("line {}: expected body_id {}; render the scene again", row + 2, listed.world_from_rest.len() + 1);
                return Err(DatasetError::text(&path, problem));
            }
            listed.states.push(numbers(&table, row, [state])?.map(|[state]| state));
            let mut cells = [0.0; 12];
            for (cell, &column) in cells.iter_mut().zip(&matrix) {
                *cell = table.parse(row, column)?;
            }
            let column = |at: usize| DVec3::new(cells[at], cells[at + 4], cells[at + 8]);
            listed.world_from_rest.push(DAffine3::from_cols(column(0), column(1), column(2), column(3)));
        }
        if let Some(short) = frames.values().flatten().find(|listed| listed.world_from_rest.len() != bodies.len()) {
            let (found, count) = (short.world_from_rest.len(), bodies.len());
            let problem = format!("frame {} has {found} of {count} bodies; render the scene again", short.frame);
            return Err(DatasetError::text(&path, problem));
        }
        Ok(Some(FilmedBodies::new(bodies, frames)))
    }
}

/// Cells of numbers; empty where there are none.
fn cells_of<const N: usize>(numbers: Option<[f64; N]>) -> [String; N] {
    numbers.map_or_else(|| std::array::from_fn(|_| String::new()), |numbers| numbers.map(|number| number.to_string()))
}

/// The numbers in cells; `None` where the first is empty.
fn numbers<const N: usize>(table: &Table, row: usize, columns: [usize; N]) -> Result<Option<[f64; N]>, DatasetError> {
    if table.rows[row][columns[0]].is_empty() {
        return Ok(None);
    }
    let mut numbers = [0.0; N];
    for (number, column) in numbers.iter_mut().zip(columns) {
        *number = table.parse(row, column)?;
    }
    Ok(Some(numbers))
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::DQuat;

    fn row(id: u32, parent: Option<u32>, node_ids: &[u32]) -> BodyRow {
        BodyRow {
            id,
            name: format!("body, {id}"),
            parent,
            joint: "hinge".into(),
            axis: Some([0.0, 0.6, 0.8]),
            point: Some([1.0, -2.5, 0.1]),
            limits: parent.map(|_| [-0.1, 1.5]),
            moves: true,
            node_ids: node_ids.into(),
        }
    }

    #[test]
    fn bodies_come_back_and_carry_the_points_of_their_parts() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        assert_eq!(dataset.read_filmed_bodies("room", "cam_00").unwrap(), None);
        let bodies = [row(1, None, &[2, 5]), row(2, Some(1), &[])];
        dataset.write_bodies("room", &bodies).unwrap();
        let turn = DAffine3::from_rotation_translation(DQuat::from_rotation_z(0.3), DVec3::new(0.1, 0.2, -0.7));
        let frame = |frame, maps: [DAffine3; 2]| FrameBodies {
            frame,
            first_row: 0,
            time_s: f64::from(frame) / 30.0,
            world_from_rest: maps.into(),
            states: vec![Some(0.3), None],
        };
        let frames = [frame(0, [DAffine3::IDENTITY; 2]), frame(7, [turn, turn.inverse()])];
        dataset.write_body_poses("room", "cam_00", &frames).unwrap();

        let filmed = dataset.read_filmed_bodies("room", "cam_00").unwrap().unwrap();
        assert_eq!((filmed.bodies.as_slice(), filmed.frames().cloned().collect::<Vec<_>>().as_slice()), (&bodies[..], &frames[..]));
        let p = DVec3::new(1.0, 2.0, 3.0);
        let (first, later) = (filmed.at(0), filmed.at(7));
        assert_eq!(first.carry(&later, 5, p), Some(turn.transform_point3(p)));
        assert!(later.carry(&first, 2, turn.transform_point3(p)).unwrap().abs_diff_eq(p, 1e-15));
        assert!(later.at_rest(2, turn.transform_point3(p)).unwrap().abs_diff_eq(p, 1e-15));
        assert_eq!([1, 3, 6, -1, 0].map(|still| first.carry(&later, still, p)), [Some(p); 5]);

        // Parts 2 and 5 move, part 1 does not: instance 7 goes apart, 8 moves, 9 stays.
        let labels = [9, 7, 7, -1, 8].map(|instance| PartLabel { semantic: 5, instance });
        assert_eq!(later.instances(&labels), BTreeMap::from([(7, None), (8, Some(turn))]));

        // Of a rolling shutter, bands of rows have places of their own; the frame's is that of the middle.
        let band = |first_row, map| FrameBodies { first_row, ..frame(3, [map, DAffine3::IDENTITY]) };
        let up = DAffine3::from_translation(DVec3::Z);
        let rolled = [band(0, DAffine3::IDENTITY), band(10, up), band(30, turn)];
        dataset.write_body_poses("room", "cam_00", &rolled).unwrap();
        let read = dataset.read_filmed_bodies("room", "cam_00").unwrap().unwrap();
        assert_eq!((read.bands(3), read.frames().collect::<Vec<_>>()), (&rolled[..], vec![&rolled[1]]));
        let places = read.at(3);
        let at = |y: f64| places.in_row(y).world_from_rest(2).copied();
        assert_eq!([at(-3.0), at(9.9), at(10.5), at(99.0)], [Some(DAffine3::IDENTITY), Some(DAffine3::IDENTITY), Some(up), Some(turn)]);
        assert_eq!((places.world_from_rest(2), places.world_from_rest(3)), (Some(&up), None));
        dataset.write_body_poses("room", "cam_00", &[band(0, up), band(10, up), band(4, up)]).unwrap();
        assert!(dataset.read_filmed_bodies("room", "cam_00").unwrap_err().to_string().contains("first_row of frame 3 does not ascend"));

        dataset.write_body_poses("room", "cam_00", &[frame(0, [turn; 2])]).unwrap();
        dataset.write_bodies("room", &bodies[..1]).unwrap();
        assert!(dataset.read_filmed_bodies("room", "cam_00").unwrap_err().to_string().contains("frame 0 has 2 of 1 bodies"));
        dataset.write_bodies("room", &[row(1, Some(1), &[1])]).unwrap();
        assert!(dataset.read_bodies("room").unwrap_err().to_string().contains("line 2: expected an earlier body_id, found \"1\""));
        dataset.write_bodies("room", &[]).unwrap();
        dataset.write_body_poses("room", "cam_00", &[]).unwrap();
        assert_eq!(dataset.read_bodies("room").unwrap(), []);

        // No map takes along what deforms.
        let deforming = [BodyRow { joint: DEFORM.into(), axis: None, point: None, limits: None, ..row(1, None, &[2]) }];
        dataset.write_bodies("room", &deforming).unwrap();
        let at_rest = FrameBodies { frame: 0, first_row: 0, time_s: 0.0, world_from_rest: vec![DAffine3::IDENTITY], states: vec![None] };
        dataset.write_body_poses("room", "cam_00", &[at_rest]).unwrap();
        let filmed = dataset.read_filmed_bodies("room", "cam_00").unwrap().unwrap();
        let places = filmed.at(0);
        assert_eq!([1, 2].map(|part| (places.deforms(part), places.at_rest(part, p))), [(false, Some(p)), (true, None)]);
        assert_eq!((places.carry(&places, 2, p), places.instances(&labels)), (None, BTreeMap::from([(7, None)])));

        // Joints that stay have no poses.
        let still = BodyRow { moves: false, ..row(1, None, &[1]) };
        dataset.write_bodies("room", std::slice::from_ref(&still)).unwrap();
        assert_eq!((dataset.read_bodies("room").unwrap(), dataset.read_filmed_bodies("room", "cam_00").unwrap()), (vec![still], None));
        assert!(!dataset.moves("room").unwrap());
    }
}
