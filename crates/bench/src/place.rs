//! `place [SCENES] [OBJECTS] [--models FOLDER]` places models on tables of homes (50 scenes of 20 objects unless given) and measures what comes
//! of it by means that the placement does not use: how deep meshes are in one another, by rays that count crossings, and how far objects
//! move in two more seconds of a new simulation.

use enfilade_compose::{Composed, Many, Number, ObjectGroup, Pose, compose, moved_again};
use enfilade_geometry::{Bvh, NearestTriangle};
use enfilade_home::{HomeConfig, RoomKind, home};
use enfilade_import::{ImportOptions, load};
use enfilade_math::{DVec3, Ray, Vec3};
use enfilade_scene::{LabelledScene, Labels, Part, PartLabel, PictureFiles, Quiet, Scene};
use std::error::Error;
use std::path::Path;
use std::time::Instant;

/// Directions of the rays that tell inside from outside: a point is inside if all but one of them say so, since a ray may meet an edge.
const DIRECTIONS: [Vec3; 7] = [
    Vec3::new(0.36, 0.48, 0.8),
    Vec3::new(-0.6, 0.64, 0.48),
    Vec3::new(0.28, -0.96, 0.0),
    Vec3::new(-0.48, -0.36, 0.8),
    Vec3::new(0.64, 0.48, -0.6),
    Vec3::new(-0.352, 0.264, -0.898),
    Vec3::new(0.123, -0.456, -0.881),
];

/// Runs the instrument.
pub fn run() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = crate::arguments::arguments().collect();
    let numbers: Vec<u32> = args.iter().map_while(|a| a.parse().ok()).collect();
    let (scenes, objects) = (numbers.first().copied().unwrap_or(50), numbers.get(1).copied().unwrap_or(20));
    let folder = args.iter().position(|a| a == "--models").and_then(|i| args.get(i + 1)).map_or("examples/compose/models", String::as_str);
    let mut files: Vec<String> = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        files.extend(path.extension().is_some_and(|end| end == "glb").then(|| path.display().to_string()));
    }
    files.sort();
    let (mut placed, mut missing, mut seconds, mut deepest, mut farthest) = (0, 0, 0.0, 0.0f64, 0.0f64);
    for seed in 0..u64::from(scenes) {
        let room = room(seed);
        let pose = [Pose::Upright, Pose::Lying, Pose::Dropped][seed as usize % 3];
        let group = ObjectGroup {
            files: Many(files.clone()),
            count: Some(Number([objects; 2])),
            on: Many(vec!["table".into()]),
            pose,
            ..ObjectGroup::default()
        };
        let classes: Vec<i16> = room.labels.parts.iter().map(|label| label.semantic).collect();
        let start = Instant::now();
        let composed = compose(&room, &classes, &[(group, files.clone())], &|_, file| model(file), seed, &Quiet)?;
        seconds += start.elapsed().as_secs_f64();
        let (depth, pair) = depth(&composed);
        let moved = moved_again(&room, &composed.placed, &|file| model(file))?;
        println!(
            "scene {seed} ({}): {} placed, {} not, {:.2} mm deep ({pair}), moved {:.2} mm",
            pose.name(),
            composed.placed.objects.len(),
            composed.placed.missing.len(),
            depth * 1e3,
            moved * 1e3
        );
        (placed, missing) = (placed + composed.placed.objects.len(), missing + composed.placed.missing.len());
        (deepest, farthest) = (deepest.max(depth), farthest.max(moved));
    }
    println!(
        "{placed} objects placed, {missing} not, {:.3} s each; at most {:.2} mm deep in anything, moved at most {:.2} mm in two seconds",
        seconds / f64::from(placed.max(1) as u32),
        deepest * 1e3,
        farthest * 1e3
    );
    Ok(())
}

/// A dining room without small things.
fn room(seed: u64) -> LabelledScene {
    let made = home(&HomeConfig { seed, rooms: vec![RoomKind::Dining], clutter: 0.0, ..HomeConfig::default() });
    LabelledScene { scene: made.scene, labels: made.labels, picture_files: PictureFiles::new() }
}

fn model(file: &str) -> Result<LabelledScene, String> {
    let scene = load(Path::new(file), &ImportOptions::default(), &Quiet).map_err(|error| error.to_string())?.scene;
    let labels = Labels { parts: vec![PartLabel::NONE; scene.parts.len()] };
    Ok(LabelledScene { scene, labels, picture_files: PictureFiles::new() })
}

/// A body: its triangles, for rays and for distances.
struct Body {
    corners: Vec<[Vec3; 3]>,
    rays: Bvh,
    near: NearestTriangle,
    bounds: [Vec3; 2],
}

impl Body {
    fn new(scene: &Scene, parts: &[&Part]) -> Self {
        let of_part = |part: &&Part| -> Vec<[Vec3; 3]> {
            (0..scene.meshes[part.mesh as usize].triangles.len()).map(|triangle| scene.world_corners(part, triangle)).collect()
        };
        let corners: Vec<[Vec3; 3]> = parts.iter().flat_map(of_part).collect();
        let (rays, near) = (Bvh::new(&corners, &|_| false), NearestTriangle::new(&corners));
        let bounds = corners.iter().flatten().fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], p| [low.min(*p), high.max(*p)]);
        Self { corners, rays, near, bounds }
    }

    /// How deep a point is inside, metres; 0 outside.
    fn depth(&self, point: Vec3) -> f64 {
        if point.cmplt(self.bounds[0]).any() || point.cmpgt(self.bounds[1]).any() {
            return 0.0;
        }
        let inside = DIRECTIONS.iter().filter(|direction| self.crossings(point, **direction) % 2 == 1).count();
        if inside < DIRECTIONS.len() - 1 {
            return 0.0;
        }
        let point = point.as_dvec3();
        self.near.nearest_point(point).map_or(0.0, |near: DVec3| near.distance(point))
    }

    fn crossings(&self, from: Vec3, direction: Vec3) -> usize {
        let (mut from, mut count) = (from, 0);
        while let Some(hit) = self.rays.closest(&Ray::new(from, direction)) {
            count += 1;
            from += direction * (hit.t + 1e-5);
        }
        count
    }

    /// Corners and middles of triangles.
    fn points(&self) -> impl Iterator<Item = Vec3> {
        self.corners.iter().flat_map(|[a, b, c]| [*a, *b, *c, (*a + *b + *c) / 3.0])
    }
}

/// The greatest depth of a point of a placed object in a part of the scene or in another object, and of a point of those in it; and of what in
/// what.
fn depth(composed: &Composed) -> (f64, String) {
    let scene = &composed.scene.scene;
    let names: Vec<&str> = composed.placed.objects.iter().map(|object| object.name.as_str()).collect();
    let owner = |part: &Part| names.iter().position(|name| part.name.split('/').next() == Some(name));
    let own = |number| scene.parts.iter().filter(move |part| owner(part) == Some(number)).collect::<Vec<_>>();
    let objects: Vec<Body> = (0..names.len()).map(|number| Body::new(scene, &own(number))).collect();
    let rest = scene.parts.iter().filter(|part| owner(part).is_none());
    let others: Vec<(&str, Body)> = rest.map(|part| (part.name.as_str(), Body::new(scene, &[part]))).collect();
    let named = || names.iter().copied().zip(&objects);
    let mut deepest = (0.0f64, String::from("-"));
    for (name, object) in named() {
        let rest = named().chain(others.iter().map(|(name, body)| (*name, body))).filter(|(other, _)| *other != name);
        for (other, body) in
            rest.filter(|(_, body)| object.bounds[0].cmple(body.bounds[1]).all() && object.bounds[1].cmpge(body.bounds[0]).all())
        {
            let depth = object.points().map(|point| body.depth(point)).fold(0.0, f64::max);
            let depth = body.points().map(|point| object.depth(point)).fold(depth, f64::max);
            if depth > deepest.0 {
                deepest = (depth, format!("{name}, {other}"));
            }
        }
    }
    deepest
}
