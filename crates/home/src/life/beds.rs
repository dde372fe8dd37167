//! Beds that somebody has slept in: the cover is thrown back and lies as it fell, pillows are askew, cushions and throws are put away.

use super::cloth::{bounds_of, hang, joined, settle};
use super::stage::{Bundle, Stage};
use super::table::interpolated;
use crate::check::contact::runs_into;
use enfilade_furniture::cloth::{Sheet, Solid, Textile};
use enfilade_furniture::meet::{Body, overlap};
use enfilade_furniture::{family_of, object_of};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3, Rng, Vec2, Vec3, hash_text};
use enfilade_scene::{Part, PartLabel};
use std::f32::consts::TAU;

/// Probability that a bed is unmade, at ½ and at 1.
const UNMADE: [f32; 2] = [0.6, 0.96];
/// Falls that are tried until the cover runs into nothing.
const TRIES: usize = 6;
/// Width of the cover beyond the mattress at the first try, and by how much it is less at each further one, metres: things stand close by.
const BEYOND: [f32; 2] = [0.4, 0.08];
/// Names of a cover's upper side; the lower one is its lining.
const COVERS: [&str; 2] = ["duvet", "bedspread"];
/// Height above the mattress from which the cover falls, metres: above pillows.
const FALL: f32 = 0.34;

/// Unmakes some of the beds.
pub fn sleep_in(stage: &mut Stage, rng: &Rng, lived_in: f32) {
    let beds: Vec<String> = stage.bodies.iter().map(|body| body.name.clone()).filter(|name| family_of(name) == "bed").collect();
    for bed in beds {
        let mut rng = rng.fork(hash_text(&bed)).fork(hash_text("unmade"));
        if rng.next_f32() < interpolated(lived_in, UNMADE) {
            unmake(stage, &bed, &mut rng);
        }
    }
}

/// Throws the cover of a bed back; models by others, whose parts have other names, stay as they are.
fn unmake(stage: &mut Stage, bed: &str, rng: &mut Rng) {
    let find = |part: &str| {
        let name = format!("{bed}/{part}");
        stage.home.scene.parts.iter().position(|part| part.name == name)
    };
    let Some(cover) = COVERS.into_iter().find(|cover| find(cover).is_some()) else { return };
    let (Some(mattress), Some(upper), Some(lower)) = (find("mattress"), find(cover), find(&format!("{cover}_lining"))) else { return };
    // The upper bed of a bunk has no frame: its cover carries it.
    let own =
        |name: &str| ["mattress", cover].iter().any(|own| name.strip_prefix(bed).is_some_and(|part| part.starts_with(&format!("/{own}"))));
    if stage.home.scene.parts.iter().all(|part| object_of(&part.name) != bed || own(&part.name)) {
        return;
    }
    let pose = stage.home.scene.parts[mattress].world_from_mesh;
    let lying = stage.home.scene.meshes[stage.home.scene.parts[mattress].mesh as usize].bounds();
    let sides = [upper, lower].map(|part| (stage.home.scene.parts[part].clone(), stage.home.labels.parts[part]));
    let on_bed = on_bed(stage, bed);
    let covers = [sides[0].0.name.clone(), sides[1].0.name.clone()];
    let throws = first_parts(stage, &on_bed);
    stage.remove(|part| covers.iter().any(|cover| cover == part) || on_bed.iter().any(|object| object_of(part) == object));
    let mut ground = None;
    let thrown = (0..TRIES).find_map(|k| {
        let width = lying.extent().x + BEYOND[0] - BEYOND[1] * k as f32;
        fallen(stage, bed, thrown(width, pose, lying.max.z, rng), &mut ground, rng)
    });
    for (k, (part, label)) in sides.into_iter().enumerate() {
        let part = match &thrown {
            Some((origin, meshes)) => {
                let mesh = add(stage, meshes[k].clone());
                Part { mesh, world_from_mesh: DAffine3::from_translation(origin.as_dvec3()), ..part }
            }
            None => part,
        };
        stage.home.scene.parts.push(part);
        stage.home.labels.parts.push(label);
    }
    stage.renew(|name| name == bed);
    for (part, label) in throws {
        throw_on(stage, pose, lying.max.z, part, label, rng);
    }
}

/// The first part of each throw or blanket among these objects, with its label.
fn first_parts(stage: &Stage, objects: &[String]) -> Vec<(Part, PartLabel)> {
    let parts = || stage.home.scene.parts.iter().zip(&stage.home.labels.parts);
    let throws = objects.iter().filter(|object| family_of(object) != "cushion");
    throws
        .filter_map(|object| parts().find(|(part, _)| object_of(&part.name) == object))
        .map(|(part, label)| (part.clone(), *label))
        .collect()
}

/// Lets the throw of a bed fall on what lies there now.
fn throw_on(stage: &mut Stage, pose: DAffine3, top: f32, part: Part, label: PartLabel, rng: &mut Rng) {
    let textile = Textile::blanket(rng);
    let at = pose.transform_point3(DVec3::new(f64::from(rng.range(-0.3, 0.3)), f64::from(rng.range(0.0, 0.7)), f64::from(top + FALL)));
    let mut sheet = Sheet::new(textile, at.as_vec3(), rng.range(0.0, TAU), rng.range(0.4, 1.0), rng);
    settle(stage, &mut sheet, &mut None);
    let Some(bounds) = bounds_of(&sheet) else { return };
    let [upper, lower] = sheet.sides(bounds.center());
    let bundle = Bundle { parts: vec![Part { world_from_mesh: DAffine3::IDENTITY, ..part }], labels: vec![label] };
    hang(stage, bundle, joined(upper, lower), bounds.center());
}

/// The sides of a cover that has fallen, around a point, if it runs into nothing but the bed.
fn fallen(stage: &Stage, bed: &str, mut sheet: Sheet, ground: &mut Option<Solid>, rng: &mut Rng) -> Option<(Vec3, [Mesh; 2])> {
    settle(stage, &mut sheet, ground);
    let origin = bounds_of(&sheet)?.center();
    let meshes = sheet.quilted(origin, rng);
    let mut body = Body::new(bed);
    for mesh in &meshes {
        body.push((0..mesh.triangles.len()).map(|t| mesh.corners(t).map(|p| p + origin)).collect());
    }
    let others = stage.bodies.iter().filter(|other| other.name != bed && overlap(&other.bounds, &body.bounds, 0.01));
    let free = others.into_iter().all(|other| !runs_into(&body, other, Vec3::ZERO));
    free.then_some((origin, meshes))
}

fn add(stage: &mut Stage, mesh: Mesh) -> u32 {
    stage.home.scene.meshes.push(mesh.into());
    stage.home.scene.meshes.len() as u32 - 1
}

/// Throws and cushions that lie on a bed.
fn on_bed(stage: &Stage, bed: &str) -> Vec<String> {
    let Some(bed) = stage.body(bed) else { return Vec::new() };
    let lies = |at: Vec3| at.cmpge(bed.bounds.min).all() && at.truncate().cmple(bed.bounds.max.truncate()).all();
    let put_away = |name: &str| ["throw", "cushion", "blanket"].contains(&family_of(name));
    stage.bodies.iter().filter(|body| put_away(&body.name) && lies(body.bounds.center())).map(|body| body.name.clone()).collect()
}

/// A duvet in the air above a bed, pushed aside or folded back.
fn thrown(width: f32, pose: DAffine3, top: f32, rng: &mut Rng) -> Sheet {
    let textile = Textile::duvet(width);
    // The head is at −y: the cover has slipped to the foot and to one side.
    let side = if rng.below(2) == 0 { 1.0 } else { -1.0 };
    let local = Vec3::new(side * rng.range(0.02, 0.14), rng.range(0.3, 0.5), top + FALL);
    let at = pose.transform_point3(local.as_dvec3()).as_vec3();
    let ahead = pose.transform_vector3(enfilade_math::DVec3::X);
    let yaw = (ahead.y.atan2(ahead.x)) as f32 + rng.range(-0.3, 0.3);
    let mut sheet = Sheet::new(textile, at, yaw, rng.range(0.5, 1.0), rng);
    match rng.below(4) {
        // Thrown back by who got up at one side.
        0 | 1 => sheet.folded_back(Vec2::new(side * rng.range(-0.05, 0.15), -0.22), Vec2::new(side, -rng.range(0.5, 1.3)).normalize()),
        // Pushed down to the foot.
        2 => sheet.folded_back(Vec2::new(0.0, rng.range(-0.2, 0.0)), Vec2::new(rng.range(-0.4, 0.4), -1.0).normalize()),
        _ => {}
    }
    sheet
}
