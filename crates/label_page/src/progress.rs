//! Progress: how many pixels of the planned views each piece covers, and how much of them is labelled.

use super::camera::PageCamera;
use super::pieces::Pieces;
use super::planned::{PlannedCamera, PlannedFrame, rows, upright};
use super::scene::AnnotatedScene;
use enfilade_geometry::{Bvh, NOTHING, VisibilityBuffer};
use enfilade_math::{DVec3, Ray, Vec3};
use enfilade_scene::PartLabel;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Height of the small pictures whose pixels are counted.
const ROWS: u32 = 120;
/// Height of generated viewpoints above the lowest point of a scene, metres.
const EYE_HEIGHT_M: f32 = 1.5;
/// Free distance in front of generated viewpoints, metres.
const FREE_M: f32 = 0.5;
/// Generated viewpoints are on a grid of `GRID` by `GRID`.
const GRID: usize = 4;

/// Which faces the views of a scene show, and in how many pixels.
pub struct Seen {
    /// Source of the views, for people.
    pub views_of: &'static str,
    /// The views' cameras.
    pub cameras: Vec<PlannedCamera>,
    views: Vec<SeenView>,
}

struct SeenView {
    camera: usize,
    frame: u32,
    /// Faces and how many pixels show them.
    faces: Vec<(u32, u32)>,
}

/// The views that progress is measured in: the planned ones, or if there are none, generated ones.
pub fn views(scene: &AnnotatedScene, bvh: &Bvh) -> (&'static str, Vec<PlannedCamera>) {
    if scene.cameras.iter().any(|camera| !camera.frames.is_empty()) {
        return ("planned cameras", scene.cameras.clone());
    }
    ("generated viewpoints", vec![PlannedCamera { name: "generated".into(), frames: generated(bvh) }])
}

impl Seen {
    /// Draws every view at a small size and counts the pixels of each face.
    pub fn new(scene: &AnnotatedScene, bvh: &Bvh) -> Self {
        let (views_of, cameras) = views(scene, bvh);
        let all: Vec<(usize, &PlannedFrame)> =
            cameras.iter().enumerate().flat_map(|(i, camera)| camera.frames.iter().map(move |frame| (i, frame))).collect();
        let view = |&(camera, frame): &(usize, &PlannedFrame)| {
            let columns = (f64::from(ROWS) * frame.aspect).round().clamp(16.0, 1024.0) as u32;
            let pinhole = PageCamera::new(DVec3::from_array(frame.position), rows(&frame.orientation), frame.fov_y_deg, [columns, ROWS]);
            let mut buffer = VisibilityBuffer::new(columns, ROWS);
            buffer.draw(bvh, &pinhole.rays(0, 0));
            let mut counts: HashMap<u32, u32> = HashMap::new();
            buffer.triangles().iter().filter(|&&face| face != NOTHING).for_each(|&face| *counts.entry(face).or_default() += 1);
            let mut faces: Vec<(u32, u32)> = counts.into_iter().collect();
            faces.sort_unstable();
            SeenView { camera, frame: frame.frame, faces }
        };
        let views = enfilade_parallel::map(&all, view);
        Self { views_of, cameras, views }
    }

    /// Progress of the work, as JSON.
    pub fn progress(&self, pieces: &Pieces) -> Value {
        let list = pieces.list();
        let (pixels, best) = self.pixels(pieces);
        let seen = pixels.iter().sum::<u64>() as f64;
        let area: f64 = list.iter().map(|piece| piece.measure.area_m2).sum();
        // The sum of no floats is −0; adding 0 makes it 0.
        let share = |part: f64, of: f64| if of > 0.0 { part / of + 0.0 } else { 0.0 };
        let layer = |has: &dyn Fn(usize) -> bool| {
            let with = || (0..list.len()).filter(|&i| has(i));
            json!({
                "pieces": with().count(),
                "area_share": share(with().map(|i| list[i].measure.area_m2).sum(), area),
                "visible_share": share(with().map(|i| pixels[i] as f64).sum(), seen),
            })
        };
        let (semantic, instance) = (layer(&|i| list[i].label.semantic >= 1), layer(&|i| list[i].label.instance >= 1));
        let best_view = |i: usize| {
            let view = self.views.get(best[i])?;
            Some(json!({ "camera": self.cameras[view.camera].name, "frame": view.frame }))
        };
        let row = |&i: &usize| {
            let piece = &list[i];
            json!({ "piece": i, "name": piece.name, "pixels": pixels[i], "area_m2": piece.measure.area_m2, "best_view": best_view(i) })
        };
        let listed = |wanted: &dyn Fn(PartLabel) -> bool| {
            let mut found: Vec<usize> = (0..list.len()).filter(|&i| wanted(list[i].label)).collect();
            let area = |i: usize| list[i].measure.area_m2;
            found.sort_by(|&a, &b| pixels[b].cmp(&pixels[a]).then(area(b).total_cmp(&area(a))).then(a.cmp(&b)));
            found.iter().map(row).collect::<Vec<Value>>()
        };
        json!({
            "pieces": list.len(),
            "labelled_pieces": semantic["pieces"],
            "area_share": semantic["area_share"],
            "visible": { "pixels_labelled_share": semantic["visible_share"], "views": self.views.len(), "views_of": self.views_of },
            "by_layer": { "semantic": semantic, "instance": instance },
            "unlabelled": listed(&|label| label.semantic < 1),
            "without_instance": listed(&|label| label.semantic >= 1 && label.instance < 1),
            "classes": classes(pieces),
            "conflicts": conflicts(pieces),
        })
    }

    /// The pixels of each piece in all views, and the view that shows most of it; `usize::MAX` where none does.
    fn pixels(&self, pieces: &Pieces) -> (Vec<u64>, Vec<usize>) {
        let count = pieces.list().len();
        let mut pixels = vec![0u64; count];
        let mut best: Vec<(u32, usize)> = vec![(0, usize::MAX); count];
        for (number, view) in self.views.iter().enumerate() {
            let mut here: HashMap<u32, u32> = HashMap::new();
            view.faces.iter().for_each(|&(face, count)| *here.entry(pieces.of_face()[face as usize]).or_default() += count);
            for (piece, count) in here {
                pixels[piece as usize] += u64::from(count);
                if count > best[piece as usize].0 {
                    best[piece as usize] = (count, number);
                }
            }
        }
        (pixels, best.into_iter().map(|(_, view)| view).collect())
    }
}

/// Pieces, instances and area of each class in use.
fn classes(pieces: &Pieces) -> Vec<Value> {
    let mut classes: BTreeMap<i16, (usize, BTreeSet<i16>, f64)> = BTreeMap::new();
    for piece in pieces.list().iter().filter(|piece| piece.label.semantic >= 1) {
        let (count, instances, area) = classes.entry(piece.label.semantic).or_default();
        *count += 1;
        *area += piece.measure.area_m2;
        if piece.label.instance >= 1 {
            instances.insert(piece.label.instance);
        }
    }
    let row = |(id, (count, instances, area)): (&i16, &(usize, BTreeSet<i16>, f64))| json!({ "id": id, "pieces": count, "instances": instances.len(), "area_m2": area });
    classes.iter().map(row).collect()
}

/// Instances whose pieces are of different classes, or some of them unlabelled.
fn conflicts(pieces: &Pieces) -> Vec<Value> {
    let mut of_instance: BTreeMap<i16, BTreeSet<i16>> = BTreeMap::new();
    let labels = pieces.list().iter().map(|piece| piece.label).filter(|label| label.instance >= 1);
    labels.for_each(|label| {
        of_instance.entry(label.instance).or_default().insert(label.semantic);
    });
    let conflicting = of_instance.iter().filter(|(_, classes)| classes.len() > 1);
    conflicting.map(|(instance, classes)| json!({ "instance": instance, "classes": classes })).collect()
}

/// Views in four directions from the points of a grid at eye height that have free space in front of them; if none has, views from
/// around the scene toward its middle.
fn generated(bvh: &Bvh) -> Vec<PlannedFrame> {
    let bounds = bvh.bounds();
    if bounds.is_empty() {
        return Vec::new();
    }
    let (centre, extent) = (bounds.center(), bounds.extent());
    let height = bounds.min.z + EYE_HEIGHT_M.min(0.5 * extent.z);
    let mut frames = Vec::new();
    let mut add = |from: Vec3, to: Vec3| {
        if let Some(pose) = upright(frames.len() as u32, from.as_dvec3(), to.as_dvec3()) {
            frames.push(PlannedFrame::new(&pose, 60.0, 4.0 / 3.0));
        }
    };
    let share = |i: usize| (i as f32 + 0.5) / GRID as f32;
    for (i, j) in (0..GRID * GRID).map(|k| (k % GRID, k / GRID)) {
        let from = Vec3::new(bounds.min.x + share(i) * extent.x, bounds.min.y + share(j) * extent.y, height);
        let directions = [Vec3::X, Vec3::Y, Vec3::NEG_X, Vec3::NEG_Y];
        let meets = |direction: Vec3| bvh.closest(&Ray::new(from, direction));
        // With something above and below: outdoors and on a roof are no viewpoints.
        let enclosed = [Vec3::Z, Vec3::NEG_Z].into_iter().all(|direction| meets(direction).is_some());
        let free = directions.into_iter().filter(|&direction| meets(direction).is_none_or(|hit| hit.t > FREE_M));
        free.filter(|_| enclosed).for_each(|direction| add(from, from + direction));
    }
    if frames.is_empty() {
        let reach = 1.2 * extent.length().max(1e-3);
        for [x, y, z] in [[1.0, 1.0, 0.5], [-1.0, 1.0, 0.5], [-1.0, -1.0, 0.5], [1.0, -1.0, 0.5], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0f32]] {
            let from = centre + reach * Vec3::new(x, y, z).normalize();
            if let Some(pose) = upright(frames.len() as u32, from.as_dvec3(), centre.as_dvec3()) {
                frames.push(PlannedFrame::new(&pose, 60.0, 4.0 / 3.0));
            }
        }
    }
    frames
}
