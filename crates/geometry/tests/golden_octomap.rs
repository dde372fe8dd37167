//! Trees written by OctoMap itself, against what is known about them. Reads `golden` and `octomap` beside and in the folder that
//! `ENFILADE_SCENES` names; skipped where that is unset or the folders are missing.

use enfilade_geometry::{OccupancyTree, Voxel, VoxelKey};
use std::path::{Path, PathBuf};

fn scenes() -> Option<PathBuf> {
    let scenes = std::env::var_os("ENFILADE_SCENES").map(PathBuf::from);
    if scenes.is_none() {
        println!("skipped: ENFILADE_SCENES is not set");
    }
    scenes
}

fn read(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// SHA-256 over the sorted keys of all voxels of a state, each x·2³² + y·2¹⁶ + z as eight little-endian bytes.
fn digest_of_keys(tree: &OccupancyTree, state: Voxel) -> String {
    let mut keys = Vec::new();
    for leaf in tree.leaves().filter(|leaf| leaf.state == state) {
        let [x, y, z] = leaf.key.0.map(u64::from);
        let edge = 1u64 << leaf.level;
        for i in 0..leaf.voxels() {
            keys.push((x + i % edge) << 32 | (y + i / edge % edge) << 16 | (z + i / edge / edge));
        }
    }
    keys.sort_unstable();
    let bytes: Vec<u8> = keys.iter().flat_map(|k| k.to_le_bytes()).collect();
    sha256(&bytes)
}

#[test]
fn golden_trees_have_the_known_voxels_and_survive_a_round_trip() {
    let Some(scenes) = scenes() else { return };
    for room in ["aws-house-offgrid", "staircase"] {
        let folder = scenes.join("../golden").join(room);
        if !folder.is_dir() {
            println!("skipped: no folder {}", folder.display());
            continue;
        }
        let bytes = read(&folder.join("octomap.bt"));
        let stats: serde_json::Value = serde_json::from_slice(&read(&folder.join("stats.json"))).unwrap();
        let known = &stats["octomap"];
        let tree = OccupancyTree::from_bt(&bytes).unwrap();
        assert_eq!(known["sha256"], sha256(&bytes), "the test's own digest");
        assert_eq!(tree.to_bt(), bytes, "{room}: written again");
        for (state, name) in [(Voxel::Free, "free"), (Voxel::Occupied, "occupied")] {
            let leaves = tree.leaves().filter(|leaf| leaf.state == state).count();
            assert_eq!(known[format!("{name}_leaves")], leaves, "{room}: {name} leaves");
            assert_eq!(known[format!("{name}_voxels")], tree.count(state), "{room}: {name} voxels");
            assert_eq!(known[format!("{name}_voxel_keys_sha256")], digest_of_keys(&tree, state), "{room}: {name} keys");
            let (min, max) = tree.bounds(state).unwrap();
            for (bound, corner) in [("min", min), ("max", max)] {
                for axis in 0..3 {
                    let value = known[format!("{name}_{bound}")][axis].as_f64().unwrap();
                    assert!((value - corner[axis]).abs() < 1e-6, "{room}: {name} {bound} {value} {corner}");
                }
            }
        }
    }
}

#[test]
fn a_large_tree_from_a_robot_reads_and_writes() {
    let Some(scenes) = scenes() else { return };
    let path = scenes.join("octomap/geb079.bt");
    if !path.is_file() {
        println!("skipped: no file {}", path.display());
        return;
    }
    let bytes = read(&path);
    let mut tree = OccupancyTree::from_bt(&bytes).unwrap();
    assert_eq!((tree.node_count(), tree.resolution_m()), (532_566, 0.08));
    let data = |b: &[u8]| b[b.windows(6).position(|w| w == b"\ndata\n").unwrap()..].to_vec();
    assert_eq!(data(&tree.to_bt()), data(&bytes));
    let counts = [Voxel::Free, Voxel::Occupied].map(|s| tree.count(s));
    tree.prune();
    assert_eq!([Voxel::Free, Voxel::Occupied].map(|s| tree.count(s)), counts);
}

/// The bytes that OctoMap's own `convert_octree` makes of a tree file; `None` where that is not installed.
fn convert(bytes: &[u8], from: &str, to: &str) -> Option<Vec<u8>> {
    let folder = tempfile::tempdir().unwrap();
    let [source, target] = [from, to].map(|kind| folder.path().join(format!("tree.{kind}")));
    std::fs::write(&source, bytes).unwrap();
    match std::process::Command::new("convert_octree").args([&source, &target]).output() {
        Ok(_) => Some(read(&target)),
        Err(_) => {
            println!("skipped: convert_octree of OctoMap (Debian: octomap-tools) is not installed");
            None
        }
    }
}

#[test]
fn octomap_reads_our_trees_and_writes_the_same() {
    let states = |key: VoxelKey, level: u32| {
        let outside = key.0.iter().any(|k| *k >= 32800 || u32::from(*k) + (1 << level) <= 32760);
        match (outside, level) {
            (true, _) => Some(Voxel::Unknown),
            (false, 0) => {
                Some([Voxel::Unknown, Voxel::Free, Voxel::Free, Voxel::Occupied][usize::from(key.0[0] / 3 + key.0[1] / 5 + key.0[2]) % 4])
            }
            _ => None,
        }
    };
    let tree = OccupancyTree::from_states(0.05, states);
    // By way of OctoMap's other kind of file, which has probabilities.
    let Some(ot) = convert(&tree.to_bt(), "bt", "ot") else { return };
    let data = |bytes: &[u8]| bytes[bytes.windows(6).position(|w| w == b"\ndata\n").unwrap()..].to_vec();
    assert_eq!(data(&convert(&ot, "ot", "bt").unwrap()), data(&tree.to_bt()));
}

/// FIPS 180-4, for the tests alone.
fn sha256(message: &[u8]) -> String {
    let primes = (2u32..).filter(|n| (2..*n).take_while(|d| d * d <= *n).all(|d| n % d != 0));
    let fraction = |x: f64| ((x - x.floor()) * 4_294_967_296.0) as u32;
    let k: Vec<u32> = primes.clone().take(64).map(|p| fraction(f64::from(p).cbrt())).collect();
    let mut state: Vec<u32> = primes.take(8).map(|p| fraction(f64::from(p).sqrt())).collect();
    let mut padded = message.to_vec();
    padded.push(0x80);
    padded.resize(padded.len().next_multiple_of(64), 0);
    if message.len() % 64 > 55 {
        padded.resize(padded.len() + 64, 0);
    }
    let end = padded.len();
    padded[end - 8..].copy_from_slice(&(8 * message.len() as u64).to_be_bytes());
    for block in padded.chunks_exact(64) {
        let mut w: Vec<u32> = block.chunks_exact(4).map(|b| u32::from_be_bytes([b[0], b[1], b[2], b[3]])).collect();
        for i in 16..64 {
            let s0 = w[i - 15].rotate_right(7) ^ w[i - 15].rotate_right(18) ^ (w[i - 15] >> 3);
            let s1 = w[i - 2].rotate_right(17) ^ w[i - 2].rotate_right(19) ^ (w[i - 2] >> 10);
            w.push(w[i - 16].wrapping_add(s0).wrapping_add(w[i - 7]).wrapping_add(s1));
        }
        let mut v = state.clone();
        for i in 0..64 {
            let s1 = v[4].rotate_right(6) ^ v[4].rotate_right(11) ^ v[4].rotate_right(25);
            let choice = (v[4] & v[5]) ^ (!v[4] & v[6]);
            let t1 = v[7].wrapping_add(s1).wrapping_add(choice).wrapping_add(k[i]).wrapping_add(w[i]);
            let s0 = v[0].rotate_right(2) ^ v[0].rotate_right(13) ^ v[0].rotate_right(22);
            let t2 = s0.wrapping_add((v[0] & v[1]) ^ (v[0] & v[2]) ^ (v[1] & v[2]));
            v.rotate_right(1);
            v[4] = v[4].wrapping_add(t1);
            v[0] = t1.wrapping_add(t2);
        }
        state.iter_mut().zip(&v).for_each(|(s, v)| *s = s.wrapping_add(*v));
    }
    state.iter().map(|word| format!("{word:08x}")).collect()
}

#[test]
fn the_digest_is_sha256() {
    assert_eq!(sha256(b"abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}
