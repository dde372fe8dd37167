//! ScanNet's exported scans: `scans/<scan>/{color,depth,pose,intrinsic,label-filt,instance-filt}`, and the mesh of each with its labels.
//!
//! Depth is planar, 16-bit PNG in millimetres, 0 for none. `pose/N.txt` is camera to world with OpenCV's axes, metres. `intrinsic/` has K
//! for whole-numbered pixel centres in 4 × 4 matrices; colour and depth are one camera, so both are the same and the extrinsics are
//! the identity. Labels of images are numbers of ScanNet's raw vocabulary, those of the mesh NYU40's, as in its own files. [`mesh`] has the files
//! of the mesh, in the layout of ScanNet's README, [`classes`] what their labels are called.

mod classes;
mod colors;
mod lists;
mod mesh;
mod names;
mod segments;
mod subdivide;

pub(crate) use colors::colors;

use crate::ExportError;
use crate::calibration::Calibration;
use crate::depth::{DEPTH, millimetres, planar_m};
use crate::export_folder::ExportFolder;
use crate::instances::{are_labelled, warn_of_none};
use crate::mesh::missing_mesh_file;
use crate::picture::{SHOWN, color_jpeg, grey8_png, grey16_png};
use crate::selected_frames::{SelectedFrames, Track, View};
use enfilade_frame::{Frame, Layer, Values};
use enfilade_scene::{Rooms, Warning};
use names::scan;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Colour and depth are of one camera.
const IDENTITY: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    check_names(selected)?;
    for track in &selected.tracks {
        let k = Calibration::of_pinhole(selected, track)?;
        let folder = folder(track);
        let intrinsic = matrix(&four_by_four(k.intrinsics.opencv_k()));
        let identity = matrix(&four_by_four(IDENTITY));
        for what in ["color", "depth"] {
            out.write(&format!("{folder}/intrinsic/intrinsic_{what}.txt"), intrinsic.as_bytes())?;
            out.write(&format!("{folder}/intrinsic/extrinsic_{what}.txt"), identity.as_bytes())?;
        }
        let rooms = selected.dataset.read_rooms(&track.scene)?;
        out.write(&format!("{folder}/{}.txt", scan(track)), about(track, &k, rooms.as_ref()).as_bytes())?;
    }
    let raw = raw_numbers(selected)?;
    selected.each(|view| write_frame(selected, out, view, &raw[&view.track.scene]))?;
    selected.scenes().try_for_each(|tracks| write_mesh(selected, out, tracks))?;
    warn_of_none(selected, are_labelled(selected)?)?;
    classes::write_table(selected, out)?;
    lists::write(selected, out)
}

/// No two cameras may be one scan.
fn check_names(selected: &SelectedFrames<'_>) -> Result<(), ExportError> {
    let mut known: BTreeMap<String, String> = BTreeMap::new();
    for track in &selected.tracks {
        if let Some(other) = known.insert(scan(track), track.folder()) {
            let problem = format!("{other} would be the scan {} too; leave one of them out with --scene or --camera", scan(track));
            return Err(selected.unsuitable(track.folder(), problem));
        }
    }
    Ok(())
}

/// The mesh of a scene in each of its scans, or a warning that there is none.
fn write_mesh(selected: &SelectedFrames<'_>, out: &ExportFolder, tracks: &[Track]) -> Result<(), ExportError> {
    let scene = &tracks[0].scene;
    if let Some(missing) = missing_mesh_file(selected.dataset, scene) {
        let message = format!("its mesh folder has no {missing}, so its scans have no mesh with labels; make it (import, label)");
        selected.warn(Warning { place: scene.clone(), message });
        return Ok(());
    }
    let mesh = mesh::scene_mesh(selected, scene)?;
    let views: Vec<View<'_>> = tracks.iter().flat_map(Track::views).collect();
    let colors = colors(selected, &views, &mesh.vertices)?;
    tracks.iter().try_for_each(|track| mesh.write(out, &folder(track), &scan(track), &colors))
}

fn folder(track: &Track) -> String {
    format!("scans/{}", scan(track))
}

/// Numbers of ScanNet's vocabulary by class, for every scene.
fn raw_numbers(selected: &SelectedFrames<'_>) -> Result<BTreeMap<String, Raw>, ExportError> {
    let of_scene = |tracks: &[Track]| {
        let scene = &tracks[0].scene;
        Ok((scene.clone(), classes::classes(selected, scene)?.into_iter().map(|(id, named)| (id, named.raw)).collect()))
    };
    selected.scenes().map(of_scene).collect()
}

/// Numbers of ScanNet's vocabulary by class.
type Raw = BTreeMap<i16, u16>;

fn write_frame(selected: &SelectedFrames<'_>, out: &ExportFolder, view: View<'_>, raw: &Raw) -> Result<(), ExportError> {
    let (folder, n) = (folder(view.track), view.frame());
    let k = Calibration::of_pinhole(selected, view.track)?;
    let frame = selected.read(view, &[&SHOWN[..], &DEPTH, &[Layer::Semantic, Layer::SemanticInstance]].concat())?;
    out.write(&format!("{folder}/pose/{n}.txt"), matrix(&k.opencv_pose(view)).as_bytes())?;
    let depth: Vec<u16> = planar_m(selected, view, &k, &frame)?.into_iter().map(millimetres).collect();
    out.write(&format!("{folder}/depth/{n}.png"), &grey16_png(frame.width, frame.height, &depth))?;
    if frame.get(Layer::Color).is_some() {
        out.write(&format!("{folder}/color/{n}.jpg"), &color_jpeg(selected, view, &frame)?)?;
    }
    if let Some(semantic) = frame.get(Layer::Semantic) {
        let labels: Vec<u16> = (0..semantic.len()).map(|i| raw.get(&(semantic.get(i) as i16)).copied().unwrap_or(0)).collect();
        out.write(&format!("{folder}/label-filt/{n}.png"), &grey16_png(frame.width, frame.height, &labels))?;
    }
    if let Some(instance) = frame.get(Layer::SemanticInstance) {
        out.write(&format!("{folder}/instance-filt/{n}.png"), &instance_png(&frame, &numbers(instance)))?;
    }
    Ok(())
}

/// Instances from 1, and 0 where there is none.
fn numbers(labels: &Values) -> Vec<u16> {
    (0..labels.len()).map(|i| labels.get(i).max(0.0) as u16).collect()
}

fn instance_png(frame: &Frame, numbers: &[u16]) -> Vec<u8> {
    let bytes: Result<Vec<u8>, _> = numbers.iter().map(|&n| u8::try_from(n)).collect();
    bytes.map_or_else(|_| grey16_png(frame.width, frame.height, numbers), |bytes| grey8_png(frame.width, frame.height, &bytes))
}

/// A rotation or K in the upper left of the identity.
fn four_by_four(m: [[f64; 3]; 3]) -> [[f64; 4]; 4] {
    let row = |r: [f64; 3]| [r[0], r[1], r[2], 0.0];
    [row(m[0]), row(m[1]), row(m[2]), [0.0, 0.0, 0.0, 1.0]]
}

/// Rows of numbers with spaces between them; every number comes back exactly.
fn matrix(rows: &[[f64; 4]; 4]) -> String {
    let row = |row: &[f64; 4]| row.map(|v| v.to_string()).join(" ") + "\n";
    rows.iter().map(row).collect()
}

/// The page that ScanNet has for every scan: its keys in their order, the kind of scene last, where loaders look for it.
fn about(track: &Track, calibration: &Calibration, rooms: Option<&Rooms>) -> String {
    let k = calibration.intrinsics;
    let [[fx, _, mx], [_, fy, my], _] = k.opencv_k();
    let identity = matrix(&four_by_four(IDENTITY)).trim_end().replace('\n', " ");
    let mut text = format!("axisAlignment = {identity}\ncolorHeight = {}\ncolorToDepthExtrinsics = {identity}\n", k.height);
    let _ = write!(text, "colorWidth = {}\ndepthHeight = {}\ndepthShift = 1000\ndepthWidth = {0}\n", k.width, k.height);
    for (key, value) in [("fx", fx), ("fy", fy), ("mx", mx), ("my", my)] {
        let _ = writeln!(text, "{key}_color = {value}\n{key}_depth = {value}");
    }
    let _ = writeln!(text, "numColorFrames = {0}\nnumDepthFrames = {0}\nnumIMUmeasurements = 0", track.chosen.len());
    let kinds = rooms.iter().flat_map(|rooms| &rooms.outlines).map(|room| room.kind.as_str());
    let _ = writeln!(text, "sceneType = {}", scene_type(kinds));
    text
}

/// ScanNet's word for what the rooms of a scene are: that of the only room; several rooms of a home are an apartment. In other buildings it
/// is that of the rooms that homes do not have, if they have one.
fn scene_type<'a>(kinds: impl IntoIterator<Item = &'a str>) -> &'static str {
    let (at_home, public): (Vec<_>, Vec<_>) = kinds.into_iter().map(room_type).partition(|(_, at_home)| *at_home);
    match (at_home.as_slice(), public.as_slice()) {
        ([(word, _)], []) => word,
        ([_, _, ..], []) => "Apartment",
        (_, [(word, _), others @ ..]) if others.iter().all(|(other, _)| other == word) => word,
        _ => MISC,
    }
}

/// ScanNet's word where none fits.
const MISC: &str = "Misc.";

/// ScanNet's word for a kind of room, and whether homes have such rooms; kinds that are not known count among those.
fn room_type(kind: &str) -> (&'static str, bool) {
    match kind {
        "bathroom" | "toilet" => ("Bathroom", true),
        "bedroom" | "childrens" => ("Bedroom / Hotel", true),
        "dining" => ("Dining Room", true),
        "hall" => ("Hallway", true),
        "kitchen" => ("Kitchen", true),
        "laundry" => ("Laundry Room", true),
        "living" => ("Living room / Lounge", true),
        "study" => ("Office", true),
        "hotel_room" => ("Bedroom / Hotel", false),
        "office" | "open_office" => ("Office", false),
        "meeting" => ("Conference Room", false),
        "classroom" => ("Classroom", false),
        "computer_lab" => ("ComputerCluster", false),
        "corridor" => ("Hallway", false),
        "library" | "bookshop" => ("Bookstore / Library", false),
        "reception" => ("Lobby", false),
        "gym" => ("Gym", false),
        "storeroom" => ("Storage/Basement/Garage", false),
        "cafe" | "shop" | "workshop" => (MISC, false),
        _ => (MISC, true),
    }
}

#[cfg(test)]
mod tests {
    use super::scene_type;

    #[test]
    fn a_scene_is_what_its_rooms_are() {
        assert_eq!(scene_type([]), "Misc.");
        assert_eq!(scene_type(["classroom"]), "Classroom");
        assert_eq!(scene_type(["kitchen", "hall"]), "Apartment");
        assert_eq!(scene_type(["library", "bookshop"]), "Bookstore / Library");
        assert_eq!(scene_type(["office", "meeting"]), "Misc.");
        assert_eq!(scene_type(["hotel_room", "bathroom"]), "Bedroom / Hotel");
        // A study is at home, an office is not.
        assert_eq!(scene_type(["study", "hall"]), "Apartment");
    }
}
