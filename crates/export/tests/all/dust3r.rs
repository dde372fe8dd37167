//! DUSt3R: the pairs of `pairs.csv` as places in the list of images.

use enfilade_dataset::{FramePair, PairRow, write_pairs};
use enfilade_export::{Existing, ExportConfig, Format, export};
use enfilade_scene::Heard;
use enfilade_testkit::Npz;

#[test]
fn pairs_are_those_of_the_list_whose_frames_are_exported() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = crate::common::write(&folder.path().join("dataset"), &crate::common::pinhole());
    let config = ExportConfig::new(Format::Dust3r, vec!["room".into()]);
    let exported = |out: &str| {
        let heard = Heard::default();
        let out = folder.path().join(out);
        export(&dataset, &config, &out, Existing::Refuse, &heard).unwrap();
        (Npz::new(&std::fs::read(out.join("all_metadata.npz")).unwrap()), heard.lines().join("\n"))
    };
    // Without a list every frame goes with the next one of its camera.
    let (found, heard) = exported("without");
    assert!(found.i64("pairs").chunks(2).all(|pair| pair[1] == pair[0] + 1) && heard.contains("enfilade make OUT pairs"), "{heard}");

    let cameras = dataset.cameras("room").unwrap();
    let images: Vec<(String, u32)> =
        cameras.iter().flat_map(|camera| dataset.frame_numbers("room", camera).unwrap().into_iter().map(|n| (camera.clone(), n))).collect();
    let row = |scene: &str, first: usize, second: usize| PairRow {
        pair: FramePair { scene: scene.into(), first: images[first].clone(), second: images[second].clone() },
        first_seen_by_second: 0.5,
        second_seen_by_first: 0.5,
        baseline_m: 1.0,
        angle_deg: 30.0,
    };
    let last = images.len() - 1;
    write_pairs(&dataset.layout().pairs(), &[row("room", 0, last), row("attic", 0, 1), row("room", 0, 1)]).unwrap();
    let (found, heard) = exported("with");
    assert_eq!(found.i64("pairs"), [0, last as i64, 0, 1]);
    assert!(heard.contains("1 of 3 pairs are of frames that are not exported"), "{heard}");
    assert_eq!((found.i64("sceneids"), found.f32("trajectories").len()), (vec![0; images.len()], 16 * images.len()));
}
