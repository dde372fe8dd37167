//! Fixtures: `_detail/metadata_fixtures.csv`, and for each of them the files `fixture_NN_diffuse_illumination` and `fixture_NN_residual`
//! of every frame, beside its other layers; and in `relit/<mix>/` what mixes of them make of frames.

use crate::atomic::{begin_folder, remove_if_there};
use crate::frames::{read_json, write_layer};
use crate::layout::FIXTURE_PARTS;
use crate::read::{frame_numbers_in, read_image, sorted_names};
use crate::tables::Table;
use crate::{Dataset, DatasetError, check_name, write_bytes};
use enfilade_frame::{FixtureLayers, Frame, Layer, MAX_FIXTURES, Values};
use enfilade_math::Vec3;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::path::PathBuf;

/// Name of the file with the rules of a mix.
const RULES: &str = "mix.json";

/// Something that lights a scene: the sky, the sun, a window, or a lamp with all its bulbs.
#[derive(Clone, Debug, PartialEq)]
pub struct Fixture {
    /// From 1 on, without gaps: the number in the names of its files.
    pub id: u32,
    /// `sky`, `sun`, `window`: the sky through its panes, `lamp`, or `rest`: the weakest of very many lamps.
    pub kind: String,
    /// Name of its strongest part or light, or of its largest pane.
    pub name: String,
    /// Luminance of its radiant intensity, W/sr; `None` for the sky, the sun and windows.
    pub intensity: Option<f32>,
    /// Middle of the fixture in the world, metres; `None` for what has no place.
    pub position: Option<Vec3>,
    /// Emissive parts of the fixture, or its panes, as `render_entity_id` numbers them.
    pub node_ids: Vec<u32>,
    /// Names of its lights without a surface, in the table as a list in JSON.
    pub lights: Vec<String>,
}

impl Dataset {
    /// Writes the fixtures of a scene; none remove the table.
    ///
    /// # Errors
    /// When the name cannot be part of a path, or the file cannot be written.
    pub fn write_fixtures(&self, scene: &str, fixtures: &[Fixture]) -> Result<(), DatasetError> {
        check_name("scene name", scene)?;
        let path = self.layout().metadata_fixtures(scene);
        if fixtures.is_empty() {
            return remove_if_there(&path);
        }
        let header =
            ["fixture_id", "kind", "name", "intensity_w_per_sr", "position_x", "position_y", "position_z", "node_ids", "light_names"];
        let mut table = Table::new(&path, &header);
        let text = |value: Option<f32>| value.map_or_else(String::new, |value| value.to_string());
        let row = |fixture: &Fixture| {
            let [x, y, z] = [0, 1, 2].map(|axis| text(fixture.position.map(|p| p[axis])));
            let ids: Vec<String> = fixture.node_ids.iter().map(ToString::to_string).collect();
            let (kind, name) = (fixture.kind.clone(), fixture.name.clone());
            vec![fixture.id.to_string(), kind, name, text(fixture.intensity), x, y, z, ids.join(" "), json_list(&fixture.lights)]
        };
        table.rows = fixtures.iter().map(row).collect();
        table.write()
    }

    /// The fixtures of a scene; none where their light is not kept apart.
    ///
    /// # Errors
    /// When the table cannot be read.
    pub fn read_fixtures(&self, scene: &str) -> Result<Vec<Fixture>, DatasetError> {
        let path = self.layout().metadata_fixtures(scene);
        if !path.is_file() {
            return Ok(Vec::new());
        }
        let table = Table::read(&path)?;
        let [id, kind, name, intensity, x, ids, lights] =
            table.columns(["fixture_id", "kind", "name", "intensity_w_per_sr", "position_x", "node_ids", "light_names"])?;
        let [y, z] = table.columns(["position_y", "position_z"])?;
        let number = |row: usize, column: usize| match table.rows[row][column].as_str() {
            "" => Ok(None),
            _ => table.parse::<f32>(row, column).map(Some),
        };
        let wrong = |row: usize, what: &str, found: &str| {
            DatasetError::text(&path, format!("line {}: expected {what}, found {found:?}; render the scene again", row + 2))
        };
        let fixture = |row: usize| {
            let cell = |column: usize| table.rows[row][column].clone();
            let (found, lights) = (cell(ids), cell(lights));
            let node_ids: Option<Vec<u32>> = found.split_whitespace().map(|id| id.parse().ok().filter(|&id| id > 0)).collect();
            let number_of_row = row as u32 + 1;
            if cell(id) != number_of_row.to_string() {
                return Err(wrong(row, &format!("fixture_id {number_of_row}"), &cell(id)));
            }
            Ok(Fixture {
                id: number_of_row,
                kind: cell(kind),
                name: cell(name),
                intensity: number(row, intensity)?,
                position: match [number(row, x)?, number(row, y)?, number(row, z)?] {
                    [Some(x), Some(y), Some(z)] => Some(Vec3::new(x, y, z)),
                    _ => None,
                },
                node_ids: node_ids.ok_or_else(|| wrong(row, "node_ids from 1", &found))?,
                lights: serde_json::from_str(&lights).map_err(|_| wrong(row, "light_names as a list in JSON", &lights))?,
            })
        };
        (0..table.rows.len()).map(fixture).collect()
    }

    /// The light of a fixture in a frame, with height and width.
    ///
    /// # Errors
    /// When a file is missing or damaged, the two differ in size, or they are no images of three float16 per pixel.
    pub fn read_fixture_layers(
        &self,
        scene: &str,
        camera: &str,
        frame: u32,
        fixture: u32,
    ) -> Result<([usize; 2], FixtureLayers), DatasetError> {
        let read = |part: Layer| {
            let path = self.layout().fixture_layer(scene, camera, frame, fixture, part);
            let (size, values) = read_image(&path, part, None)?;
            match values {
                Values::F16(_) => Ok((size, values, path)),
                other => Err(DatasetError::hdf5(&path, format!("expected float16, found {:?}; render the frame again", other.dtype()))),
            }
        };
        let [(size, diffuse_illumination, _), (other, residual, path)] = [read(FIXTURE_PARTS[0])?, read(FIXTURE_PARTS[1])?];
        if other != size {
            let problem = format!("{}x{} pixels, but the other part has {}x{}", other[1], other[0], size[1], size[0]);
            return Err(DatasetError::hdf5(&path, format!("{problem}; render the frame again")));
        }
        Ok((size, FixtureLayers { diffuse_illumination, residual }))
    }

    /// Begins a mix by these rules. What is there of a mix of the same name and other rules is removed.
    ///
    /// # Errors
    /// When the name cannot be part of a path, or the folder cannot be used.
    pub fn begin_mix(&self, mix: &str, rules: &impl Serialize) -> Result<(), DatasetError> {
        check_name("mix", mix)?;
        let folder = self.layout().relit_dir().join(mix);
        begin_folder(&folder, &folder.join(RULES), rules)
    }

    /// The names of the mixes that have pictures.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn mixes(&self) -> Result<Vec<String>, DatasetError> {
        let folder = self.layout().relit_dir();
        let names = if folder.is_dir() { sorted_names(&folder)? } else { Vec::new() };
        Ok(names.into_iter().filter(|name| folder.join(name).join(RULES).is_file()).collect())
    }

    /// The rules of a mix; `None` where there are none.
    ///
    /// # Errors
    /// When they cannot be read.
    pub fn mix_rules<T: DeserializeOwned>(&self, mix: &str) -> Result<Option<T>, DatasetError> {
        read_json(&self.layout().relit_dir().join(mix).join(RULES), "remove it, and light the frames again")
    }

    /// The numbers of a camera's frames that a mix was made of, sorted.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn relit_frame_numbers(&self, mix: &str, [scene, camera]: [&str; 2]) -> Result<Vec<u32>, DatasetError> {
        frame_numbers_in(&self.layout().relit_dir().join(mix).join(scene).join(camera))
    }

    /// Writes what a mix of fixtures makes of a frame (scene, camera, number): layers, and the bytes of a JPEG picture.
    ///
    /// # Errors
    /// When a name cannot be part of a path, or a file cannot be written.
    pub fn write_relit(&self, mix: &str, frame: (&str, &str, u32), layers: &Frame, picture: &[u8]) -> Result<(), DatasetError> {
        check_name("mix", mix)?;
        let size = [layers.height as usize, layers.width as usize];
        for (layer, values) in layers.iter() {
            let path = self.layout().relit(mix, frame, &format!("{}.hdf5", layer.spec().name));
            write_layer(&path, size, layer, values)?;
        }
        write_bytes(&self.layout().relit(mix, frame, "display.jpg"), picture)
    }

    /// A layer that a mix of fixtures makes of a frame, with height and width.
    ///
    /// # Errors
    /// When the file is missing, damaged, or not an image of the layer's channels.
    pub fn read_relit_layer(&self, mix: &str, frame: (&str, &str, u32), layer: Layer) -> Result<([usize; 2], Values), DatasetError> {
        read_image(&self.layout().relit(mix, frame, &format!("{}.hdf5", layer.spec().name)), layer, None)
    }

    /// The files of the fixtures that a frame has in memory.
    pub(crate) fn fixture_layers<'f>(
        &self,
        scene: &str,
        camera: &str,
        number: u32,
        frame: &'f Frame,
    ) -> impl Iterator<Item = (PathBuf, Layer, &'f Values, Option<String>)> {
        let layout = self.layout();
        frame.fixtures().iter().zip(1..).flat_map(move |(light, fixture)| {
            FIXTURE_PARTS.into_iter().zip([&light.diffuse_illumination, &light.residual]).map(move |(part, values)| {
                let path = layout.fixture_layer(scene, camera, number, fixture, part);
                (path, part, values, Some(description(part, fixture)))
            })
        })
    }

    /// Removes the fixture layers of a frame.
    pub(crate) fn remove_fixture_layers(&self, scene: &str, camera: &str, frame: u32) -> Result<(), DatasetError> {
        (1..=MAX_FIXTURES as u32)
            .flat_map(|fixture| FIXTURE_PARTS.map(|part| self.layout().fixture_layer(scene, camera, frame, fixture, part)))
            .try_for_each(|path| remove_if_there(&path))
    }
}

fn json_list(names: &[String]) -> String {
    serde_json::to_string(names).expect("texts have a JSON text")
}

fn description(part: Layer, fixture: u32) -> String {
    let whole = part.spec().name;
    let zero = if part == Layer::DiffuseIllumination { "; 0 where diffuse_reflectance is" } else { "" };
    format!("Part of {whole}, as it was rendered, that comes from fixture {fixture} of metadata_fixtures.csv{zero}.")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fixtures_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let sky = Fixture {
            id: 1,
            kind: "sky".into(),
            name: "sky".into(),
            intensity: None,
            position: None,
            node_ids: Vec::new(),
            lights: Vec::new(),
        };
        let lamp = Fixture {
            id: 2,
            kind: "lamp".into(),
            name: "bulb, left".into(),
            intensity: Some(0.1),
            position: Some(Vec3::new(0.1, -2.0, 3.5)),
            node_ids: vec![7, 12],
            lights: vec!["a | b, \"c\"".into(), "c".into()],
        };
        assert!(dataset.read_fixtures("room").unwrap().is_empty());
        let fixtures = [sky, lamp];
        dataset.write_fixtures("room", &fixtures).unwrap();
        assert_eq!(dataset.read_fixtures("room").unwrap(), fixtures);
        let path = dataset.layout().metadata_fixtures("room");
        std::fs::write(&path, std::fs::read_to_string(&path).unwrap().replace("7 12", "7 0")).unwrap();
        let message = dataset.read_fixtures("room").unwrap_err().to_string();
        assert!(message.contains("metadata_fixtures.csv: line 3: expected node_ids from 1, found \"7 0\""), "{message}");
        dataset.write_fixtures("room", &[]).unwrap();
        assert!(!path.exists());
    }
}
