//! `drop_doubled_faces`: of faces with the same corners only the first stays.

use super::seen::Look;
use crate::config::FileSource;
use enfilade_dataset::counted;
use enfilade_geometry::Mesh;
use enfilade_import::Imported;
use enfilade_scene::{PartId, Scene};
use std::collections::{BTreeMap, BTreeSet};

/// The remark about doubled faces and how to remove them; `None` if there are none, or if they are removed.
pub(super) fn remark(source: &FileSource, scene: &Scene, look: &Look) -> Option<String> {
    let doubled = &look.findings.doubled;
    let part = |triangle: u32| look.world.sources[triangle as usize].part;
    let [earlier, later] = *doubled.first()?;
    if source.drop_doubled_faces {
        return None;
    }
    Some(format!(
        "{} the corners of another, as of part {:?} and {:?}: which of the two is seen is chance; drop_doubled_faces = true (or \
         --drop-doubled-faces) keeps the first",
        if doubled.len() == 1 { "1 face has".into() } else { format!("{} faces have", doubled.len()) },
        scene.parts[part(earlier) as usize].name,
        scene.parts[part(later) as usize].name
    ))
}

/// Drops every doubled face if requested, and a part with its last face; returns a remark on how many were dropped.
pub(super) fn drop_faces(source: &FileSource, imported: &mut Imported, look: &Look) -> Option<String> {
    let doubled = &look.findings.doubled;
    if !source.drop_doubled_faces {
        return None;
    }
    let mut by_part: BTreeMap<PartId, BTreeSet<u32>> = BTreeMap::new();
    for [_, later] in doubled {
        let source = look.world.sources[*later as usize];
        by_part.entry(source.part).or_default().insert(source.triangle);
    }
    let scene = &mut imported.scene;
    let mut emptied = BTreeSet::new();
    for (part, dropped) in &by_part {
        let mesh = &scene.meshes[scene.parts[*part as usize].mesh as usize];
        if dropped.len() == mesh.triangles.len() {
            emptied.insert(*part);
            continue;
        }
        // Other parts may share the mesh, and theirs stay whole.
        let own = without(mesh, dropped);
        scene.parts[*part as usize].mesh = scene.meshes.len() as u32;
        scene.meshes.push(own.into());
    }
    remove_parts(imported, &emptied);
    imported.scene.remove_unused_meshes();
    (!doubled.is_empty()).then(|| {
        let parts = if emptied.is_empty() { String::new() } else { format!(", and with them {}", counted(emptied.len(), "part")) };
        format!("{} with the corners of another went (drop_doubled_faces){parts}", counted(doubled.len(), "face"))
    })
}

fn without(mesh: &Mesh, dropped: &BTreeSet<u32>) -> Mesh {
    let kept = mesh.triangles.iter().enumerate().filter(|(i, _)| !dropped.contains(&(*i as u32)));
    Mesh { triangles: kept.map(|(_, triangle)| *triangle).collect(), ..mesh.clone() }
}

/// Takes parts out, with their labels; the numbers of those behind them move up.
fn remove_parts(imported: &mut Imported, emptied: &BTreeSet<PartId>) {
    imported.scene.remove_parts(emptied);
    if let Some(labels) = &mut imported.labels {
        labels.retain(|label| !emptied.contains(&label.part));
        labels.iter_mut().for_each(|label| label.part -= emptied.range(..label.part).count() as PartId);
    }
}
