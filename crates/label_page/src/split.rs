//! Ways to split a piece: into groups of faces, each in ascending order, ordered by their first face.

use super::pieces::Piece;
use super::scene::AnnotatedScene;
use enfilade_geometry::DisjointSets;
use std::collections::{HashMap, HashSet};

/// Groups of faces that are connected by shared corners. Corners are the same where their coordinates are, exactly.
pub fn by_component(scene: &AnnotatedScene, faces: &[u32]) -> Vec<Vec<u32>> {
    let mut of_corner: HashMap<[u32; 3], u32> = HashMap::new();
    let mut sets = DisjointSets::new(faces.len());
    for (i, &face) in faces.iter().enumerate() {
        for corner in &scene.corners[face as usize] {
            // Adding 0 turns −0 into 0, whose bits differ.
            let key = corner.to_array().map(|x| (x + 0.0).to_bits());
            let first = *of_corner.entry(key).or_insert(i as u32);
            sets.unite(first, i as u32);
        }
    }
    grouped(faces, |i| sets.root(i as u32))
}

/// Groups of faces of one material.
pub fn by_material(scene: &AnnotatedScene, faces: &[u32]) -> Vec<Vec<u32>> {
    grouped(faces, |i| scene.material_of_face[faces[i] as usize])
}

/// The rest of a piece, and the painted faces.
///
/// # Errors
/// When a face is not of the piece, or nothing is left on one side.
pub fn by_faces(piece: &Piece, of_face: &[u32], number: u32, painted: &[u32]) -> Result<[Vec<u32>; 2], String> {
    if let Some(&face) = painted.iter().find(|&&face| of_face.get(face as usize) != Some(&number)) {
        return Err(match of_face.get(face as usize) {
            Some(other) => format!("face {face} belongs to piece {other}, not to {number} ({:?})", piece.name),
            None => format!("there is no face {face}; the scene has {}", of_face.len()),
        });
    }
    let painted: HashSet<u32> = painted.iter().copied().collect();
    let (new, kept): (Vec<u32>, Vec<u32>) = piece.faces.iter().partition(|&face| painted.contains(face));
    Ok([kept, new])
}

/// Groups by the key of the face at each place, ordered by their first face.
fn grouped(faces: &[u32], mut key: impl FnMut(usize) -> u32) -> Vec<Vec<u32>> {
    let mut place: HashMap<u32, usize> = HashMap::new();
    let mut groups: Vec<Vec<u32>> = Vec::new();
    for (i, &face) in faces.iter().enumerate() {
        let group = *place.entry(key(i)).or_insert_with(|| {
            groups.push(Vec::new());
            groups.len() - 1
        });
        groups[group].push(face);
    }
    groups
}
