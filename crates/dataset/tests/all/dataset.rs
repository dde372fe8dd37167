//! The promises of a dataset as a whole, on frames whose every value is known.

use crate::analytic::{CAMERA, SCENE};
use enfilade_dataset::{ColorKind, Dataset, DatasetError, FrameStatus, FrameTime, ManifestInfo};
use enfilade_frame::{DENOISED, Frame, LAYERS, Layer, Pass, Values, f16};
use enfilade_scene::{Cx, Heard, Intrinsics, Quiet, Warning};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn small() -> Intrinsics {
    Intrinsics { width: 97, height: 64, fx: 80.0, fy: 81.0, cx: 50.0, cy: 30.5, skew: 0.0 }
}

/// Does something whenever progress is reported.
struct Told<F>(F);

impl<F: Fn() + Sync> Cx for Told<F> {
    fn progress(&self, _what: &str, _done: u64, _total: u64) {
        (self.0)();
    }

    fn warn(&self, _warning: Warning) {}
}

/// Relative path and content of every file below `root`.
fn files(root: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![root.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                found.insert(path.strip_prefix(root).unwrap().to_path_buf(), fs::read(&path).unwrap());
            }
        }
    }
    found
}

fn temporaries(root: &Path) -> Vec<PathBuf> {
    files(root).into_keys().filter(|path| path.to_string_lossy().ends_with(".partial")).collect()
}

#[test]
fn a_frame_comes_back_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = Dataset::create(folder.path()).unwrap();
    crate::analytic::write(&dataset, &small(), 3);
    let dataset = Dataset::open(folder.path()).unwrap();
    assert_eq!(dataset.scenes().unwrap(), [SCENE]);
    assert_eq!(dataset.cameras(SCENE).unwrap(), [CAMERA]);
    assert_eq!(dataset.frame_numbers(SCENE, CAMERA).unwrap(), [0, 1]);
    assert_eq!(dataset.read_trajectory(SCENE, CAMERA).unwrap(), crate::analytic::trajectory(3));
    let pose = &crate::analytic::trajectory(3).poses[1];
    let written = crate::analytic::frame(&small(), pose, 7);
    let labels = crate::analytic::label_frame(&written);
    for (layer, values) in written.iter().chain(labels.iter()) {
        // NaN differs from itself, so bytes are compared.
        assert_eq!(dataset.read_layer(SCENE, CAMERA, 1, layer).unwrap().as_bytes(), values.as_bytes(), "{layer:?}");
    }
    let layers: Vec<Layer> = LAYERS.iter().filter(|spec| !spec.pass.is_optional()).map(|spec| spec.layer).collect();
    let read = dataset.read_frame(SCENE, CAMERA, 1, &layers).unwrap();
    assert_eq!((read.width, read.height, read.iter().count()), (97, 64, 17));
    let record = dataset.frame_record(SCENE, CAMERA, 1).unwrap().unwrap();
    assert_eq!((record.pose.to_pose(1), record.camera_differs_by(&small().into()), record.files.len()), (*pose, 0.0, 15));
    assert!(dataset.labels_are_complete(SCENE, CAMERA, 1, "beef") && !dataset.labels_are_complete(SCENE, CAMERA, 1, "other"));
    assert!(temporaries(folder.path()).is_empty());
}

#[test]
fn two_runs_differ_in_nothing_but_their_times() {
    let run = |cpu_s: f64| {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        crate::analytic::write(&dataset, &small(), 3);
        let pose = &crate::analytic::trajectory(3).poses[0];
        let frame = crate::analytic::frame(&small(), pose, 7);
        dataset
            .write_frame(
                SCENE,
                CAMERA,
                &frame,
                &crate::analytic::info(&small(), pose),
                FrameTime { wall_s: cpu_s, cpu_s, ..FrameTime::default() },
            )
            .unwrap();
        let manifest = dataset.collect_manifest(&ManifestInfo::default()).unwrap();
        dataset.write_manifest(&manifest).unwrap();
        files(folder.path())
    };
    let (first, second) = (run(1.0), run(2.0));
    assert!(first.keys().eq(second.keys()));
    let different: Vec<_> = first.iter().filter(|(path, bytes)| second[*path] != **bytes).map(|(path, _)| path).collect();
    assert_eq!(different, [Path::new("manifest_times.csv")]);
}

#[test]
fn the_manifest_tells_what_became_of_every_frame_and_finds_damage() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = Dataset::create(folder.path()).unwrap();
    crate::analytic::write(&dataset, &small(), 4);
    fs::remove_file(dataset.layout().frame_record(SCENE, CAMERA, 1)).unwrap();
    let info = ManifestInfo {
        failed_frames: BTreeMap::from([((SCENE.into(), CAMERA.into(), 1), "the camera is inside the ball".into())]),
        failed_scenes: BTreeMap::from([("attic".into(), "attic.glb is cut short".into())]),
        ..ManifestInfo::default()
    };
    let manifest = dataset.collect_manifest(&info).unwrap();
    dataset.write_manifest(&manifest).unwrap();
    assert_eq!(dataset.read_manifest().unwrap().as_ref(), Some(&manifest));
    let frames = &manifest.scenes[SCENE].cameras[CAMERA].frames;
    let status: Vec<_> = frames.iter().map(|frame| frame.status).collect();
    assert_eq!(status, [FrameStatus::Complete, FrameStatus::Failed, FrameStatus::Complete, FrameStatus::Planned]);
    assert_eq!(frames[1].reason.as_deref(), Some("the camera is inside the ball"));
    assert_eq!(frames[0].files.len(), 17);
    assert_eq!(manifest.scenes["attic"].failed.as_deref(), Some("attic.glb is cut short"));

    assert_eq!(dataset.verify_checksums(&manifest).unwrap(), [""; 0]);
    let path = dataset.layout().layer(SCENE, CAMERA, 2, Layer::Position);
    let mut bytes = fs::read(&path).unwrap();
    *bytes.last_mut().unwrap() ^= 1;
    fs::write(&path, bytes).unwrap();
    fs::remove_file(dataset.layout().layer(SCENE, CAMERA, 0, Layer::Color)).unwrap();
    fs::write(dataset.layout().layer(SCENE, CAMERA, 2, Layer::Semantic), "half").unwrap();
    let problems = dataset.verify_checksums(&manifest).unwrap();
    assert_eq!(problems.len(), 3, "{problems:?}");
    let says = |problem: &str, record: &str, stage: &str| problem.ends_with(&format!("{record} and run the {stage} stage again"));
    assert!(says(&problems[1], "frame.0002.json", "render") && says(&problems[2], "frame.0002.labels.json", "label"), "{problems:?}");
    assert!(problems[0].contains("frame.0000.color.hdf5: it is missing"), "{problems:?}");
    assert!(problems[1].contains("frame.0002.position.hdf5: its content is not what was written"), "{problems:?}");
}

#[test]
fn a_repacked_copy_is_still_ours_and_its_manifest_is_about_its_own_files() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = Dataset::create(folder.path().join("made")).unwrap();
    crate::analytic::write(&dataset, &small(), 3);
    let repacked = |name: &str| {
        let out = folder.path().join(name);
        dataset.repack(&out, None, &Quiet).unwrap();
        Dataset::open(out).unwrap()
    };
    let copy = repacked("unlisted");
    assert!(!dataset.is_released(SCENE) && !copy.is_released(SCENE));
    assert!(copy.read_manifest().unwrap().is_none());
    assert_eq!(copy.frame_numbers(SCENE, CAMERA).unwrap(), [0, 1]);
    dataset.write_manifest(&dataset.collect_manifest(&ManifestInfo::default()).unwrap()).unwrap();
    let copy = repacked("listed");
    let manifest = copy.read_manifest().unwrap().unwrap();
    assert_eq!(manifest.scenes[SCENE].cameras[CAMERA].frames[0].files.len(), 17);
    assert_eq!(copy.verify_checksums(&manifest).unwrap(), [""; 0]);
    assert!(manifest.conventions.notes["records"].contains("has no record"));
    assert_eq!(copy.read_label_tables(SCENE).unwrap(), crate::analytic::labels());
    assert!(!copy.layout().mesh_file(SCENE, "mesh_vertices.hdf5").exists());
    let position = fs::read(copy.layout().layer(SCENE, CAMERA, 0, Layer::Position)).unwrap();
    assert!(position.windows(11).any(|bytes| bytes == b"description"), "our layers say what they are");
}

#[test]
fn a_repacked_copy_takes_the_place_of_an_earlier_one_whole() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = Dataset::create(folder.path().join("made")).unwrap();
    crate::analytic::write(&dataset, &small(), 3);
    let (out, fresh) = (folder.path().join("copy"), folder.path().join("fresh"));
    // What a copy left that was killed.
    fs::create_dir_all(out.join(".repack.partial/scenes/attic/_detail")).unwrap();
    dataset.repack(&out, None, &Quiet).unwrap();
    let whole = files(&out);
    assert_eq!(Dataset::open(&out).unwrap().frame_numbers(SCENE, CAMERA).unwrap(), [0, 1]);

    // One that is interrupted leaves the earlier one as it was.
    fs::remove_file(dataset.layout().frame_record(SCENE, CAMERA, 0)).unwrap();
    let interrupted = || dataset.repack(&out, None, &Told(|| std::panic::resume_unwind(Box::new("interrupted"))));
    assert!(std::panic::catch_unwind(std::panic::AssertUnwindSafe(interrupted)).is_err());
    assert_eq!(files(&out), whole);

    dataset.repack(&out, Some(&[Layer::Color]), &Quiet).unwrap();
    dataset.repack(&fresh, Some(&[Layer::Color]), &Quiet).unwrap();
    let copy = Dataset::open(&out).unwrap();
    assert_eq!(copy.frame_numbers(SCENE, CAMERA).unwrap(), [1]);
    assert!(copy.has_layer(SCENE, CAMERA, 1, Layer::Color) && !copy.has_layer(SCENE, CAMERA, 1, Layer::Position));
    assert_eq!(files(&out), files(&fresh));

    // What another one at work there has done so far is left to it.
    let second = Told(|| {
        let error = dataset.repack(&out, None, &Quiet).unwrap_err();
        assert!(error.to_string().contains("another `repack` is at work there"), "{error}");
    });
    dataset.repack(&out, None, &second).unwrap();
    fs::create_dir(fresh.join("lost+found")).unwrap();
    dataset.repack(&fresh, None, &Quiet).unwrap();
    assert!(fresh.join("lost+found").is_dir());
    fs::remove_dir(fresh.join("lost+found")).unwrap();
    assert_eq!(files(&out), files(&fresh));
}

#[test]
fn what_is_no_copy_is_not_replaced_by_one() {
    let folder = tempfile::tempdir().unwrap();
    let [dataset, other] = ["made", "other"].map(|name| Dataset::create(folder.path().join(name)).unwrap());
    crate::analytic::write(&dataset, &small(), 3);
    crate::analytic::write(&other, &small(), 2);
    let before = files(folder.path());
    let refused = |out: &Path| dataset.repack(out, None, &Quiet).unwrap_err().to_string();
    let message = refused(other.root());
    assert!(message.contains("other") && message.contains("not made by `repack`"), "{message}");
    assert!(refused(&dataset.root().join("scenes")).contains("inside the dataset"));
    assert!(refused(folder.path()).contains("the dataset is inside that folder"));
    assert_eq!(files(folder.path()), before);
}

#[test]
fn an_interrupted_frame_does_not_count() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = Dataset::create(folder.path()).unwrap();
    crate::analytic::write(&dataset, &small(), 3);
    let complete = |frame| dataset.frame_is_complete(SCENE, CAMERA, frame, "c0ffee");
    assert!(complete(0) && complete(1) && !complete(2));
    assert!(!dataset.frame_is_complete(SCENE, CAMERA, 0, "another configuration"));

    // Killed before the record was written.
    fs::remove_file(dataset.layout().frame_record(SCENE, CAMERA, 0)).unwrap();
    assert!(!complete(0));
    // Killed while layers were written: temporary files are left, and a later run removes them.
    let position = dataset.layout().layer(SCENE, CAMERA, 1, Layer::Position);
    let temporary = position.with_file_name(".frame.0002.position.hdf5.partial");
    fs::write(&temporary, "half").unwrap();
    // A file was cut short by a crash of the machine.
    fs::write(&position, "half").unwrap();
    assert!(!complete(1));
    assert!(dataset.frame_numbers(SCENE, CAMERA).unwrap().is_empty());
    dataset.remove_temporaries(SCENE, CAMERA).unwrap();
    assert!(temporaries(folder.path()).is_empty() && position.exists());
}

#[test]
fn frames_with_a_record_that_do_not_count_are_told_with_their_first_wrong_file() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = Dataset::create(folder.path()).unwrap();
    crate::analytic::write(&dataset, &small(), 4);
    let told = || -> Vec<(u32, String)> {
        let complete = dataset.frame_numbers(SCENE, CAMERA).unwrap();
        let incomplete = dataset.incomplete_frames(SCENE, CAMERA, &complete).unwrap();
        incomplete.into_iter().map(|(frame, problem)| (frame, problem.to_string())).collect()
    };
    assert!(told().is_empty(), "a frame without a record is only not there");
    fs::remove_file(dataset.layout().layer(SCENE, CAMERA, 0, Layer::Position)).unwrap();
    fs::write(dataset.layout().layer(SCENE, CAMERA, 1, Layer::DepthMeters), "half").unwrap();
    let told = told();
    let [(0, first), (1, second)] = told.as_slice() else { panic!("{told:?}") };
    assert!(first.contains("frame.0000.position.hdf5: it is missing"), "{first}");
    assert!(second.contains("frame.0001.depth_meters.hdf5: it has 4 bytes"), "{second}");
}

#[test]
fn readers_are_warned_of_labels_that_have_a_record_but_are_not_whole() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = Dataset::create(folder.path()).unwrap();
    crate::analytic::write(&dataset, &small(), 4);
    let told = |range: Option<std::ops::Range<u32>>| {
        let heard = Heard::default();
        dataset.warn_of_incomplete([SCENE, CAMERA], &[0, 1, 2], range.as_ref(), &heard).unwrap();
        heard.lines()
    };
    assert!(told(None).is_empty());
    fs::remove_file(dataset.layout().layer(SCENE, CAMERA, 1, Layer::Semantic)).unwrap();
    fs::write(dataset.layout().label_record(SCENE, CAMERA, 2), "half").unwrap();
    let [message] = told(None).try_into().unwrap();
    assert!(message.contains("the labels of frame 1 and 1 more are not whole:"), "{message}");
    assert!(message.contains("frame.0001.semantic.hdf5") && message.ends_with("run the label stage again"), "{message}");
    assert!(told(Some(0..1)).is_empty());
    assert!(told(Some(2..3))[0].contains("the labels of frame 2 are not whole:"));
    let has_labels = |frame| dataset.layers_are_whole(SCENE, CAMERA, frame, Pass::Label);
    assert_eq!([0, 1, 2, 3].map(has_labels), [true, false, false, false]);
}

#[test]
fn rendering_a_frame_again_drops_its_labels() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = Dataset::create(folder.path()).unwrap();
    crate::analytic::write(&dataset, &small(), 2);
    let pose = &crate::analytic::trajectory(2).poses[0];
    let frame = crate::analytic::frame(&small(), pose, 8);
    dataset.write_frame(SCENE, CAMERA, &frame, &crate::analytic::info(&small(), pose), FrameTime::default()).unwrap();
    assert!(!dataset.has_layer(SCENE, CAMERA, 0, Layer::Semantic) && !dataset.labels_are_complete(SCENE, CAMERA, 0, "beef"));
}

/// The three layers that denoising makes, all of them 1.
fn ones() -> Frame {
    let mut layers = Frame::new(97, 64);
    DENOISED.iter().for_each(|(layer, _)| layers.insert(*layer, Values::F16(vec![f16::ONE; 97 * 64 * 3])));
    layers
}

#[test]
fn what_guided_denoising_goes_with_what_was_rendered() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = Dataset::create(folder.path()).unwrap();
    crate::analytic::write(&dataset, &small(), 1);
    let pose = &crate::analytic::trajectory(1).poses[0];
    let mut frame = crate::analytic::frame(&small(), pose, 7);
    frame.insert(Layer::ReflectanceBeyond, frame.get(Layer::DiffuseReflectance).unwrap().clone());
    dataset.write_frame(SCENE, CAMERA, &frame, &crate::analytic::info(&small(), pose), FrameTime::default()).unwrap();
    let rendered = dataset.frame_record(SCENE, CAMERA, 0).unwrap().unwrap();
    let has_guide = || dataset.has_layer(SCENE, CAMERA, 0, Layer::ReflectanceBeyond);

    let kept = dataset.write_denoised([SCENE, CAMERA], 0, &ones(), ["Smoother", "face"], true).unwrap();
    assert!(has_guide() && kept.as_rendered() == rendered);
    let dropped = dataset.write_denoised([SCENE, CAMERA], 0, &ones(), ["Smoother", "face"], false).unwrap();
    assert!(!has_guide() && dropped.as_rendered() == rendered);
    assert!(!dropped.files.keys().any(|path| path.contains("beyond")));
}

#[test]
fn color_is_denoised_and_as_it_was_rendered_again() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = Dataset::create(folder.path()).unwrap();
    crate::analytic::write(&dataset, &small(), 3);
    let before = files(folder.path());
    let rendered = dataset.frame_record(SCENE, CAMERA, 0).unwrap().unwrap();
    let color = |layer| dataset.read_layer(SCENE, CAMERA, 0, layer).unwrap().get(5);
    let noisy = color(Layer::Color);

    let record = dataset.write_denoised([SCENE, CAMERA], 0, &ones(), ["Smoother 3.1", "face"], true).unwrap();
    assert_eq!((record.color, record.has_rendered(), record.as_rendered()), (ColorKind::Denoised, true, rendered.clone()));
    assert!(dataset.frame_is_complete(SCENE, CAMERA, 0, &rendered.config_hash), "nothing has to be rendered again");
    assert_eq!((color(Layer::Color), color(Layer::ColorRendered)), (1.0, noisy));
    let manifest = dataset.collect_manifest(&ManifestInfo::default()).unwrap();
    let [first, second, _] = &manifest.scenes[SCENE].cameras[CAMERA].frames[..] else { panic!("three frames were written") };
    assert_eq!((first.color, first.denoiser.as_deref(), first.files.len()), (Some(ColorKind::Denoised), Some("Smoother 3.1"), 20));
    assert_eq!((second.color, &second.denoiser, second.files.len()), (Some(ColorKind::Rendered), &None, 17));
    assert_eq!(dataset.verify_checksums(&manifest).unwrap(), [""; 0]);

    // By another program, and back: then what was rendered has both names, and the record lists one.
    dataset.write_denoised([SCENE, CAMERA], 0, &ones(), ["Smoother 4", "cafe"], true).unwrap();
    for _ in 0..2 {
        dataset.link_rendered([SCENE, CAMERA], 0).unwrap();
        let mut after = files(folder.path());
        for (plain, kept) in DENOISED {
            let [plain, kept] = [plain, kept].map(|layer| dataset.layout().layer(SCENE, CAMERA, 0, layer));
            assert!(fs::read(plain).unwrap() == after.remove(kept.strip_prefix(folder.path()).unwrap()).unwrap());
        }
        assert!(after == before, "what was rendered is as it was");
        assert!(!dataset.has_layer(SCENE, CAMERA, 0, Layer::ColorRendered), "a second name is no layer");
    }

    // What is not kept cannot come back, and stays known.
    let dropped = dataset.write_denoised([SCENE, CAMERA], 0, &ones(), ["Smoother 3.1", "face"], false).unwrap();
    assert_eq!((dropped.has_rendered(), dropped.files.len(), dropped.as_rendered()), (false, rendered.files.len(), rendered));
    assert!(!dataset.has_layer(SCENE, CAMERA, 0, Layer::ColorRendered));
    let error = dataset.link_rendered([SCENE, CAMERA], 0).unwrap_err().to_string();
    assert!(error.contains("frame.0000.json") && error.contains("keep_rendered"), "{error}");
    let again = dataset.write_denoised([SCENE, CAMERA], 0, &ones(), ["Smoother 4", "cafe"], true).unwrap_err();
    assert!(again.to_string().contains("render the frame again"), "{again}");

    // A frame that is rendered again is as it was rendered.
    let pose = &crate::analytic::trajectory(3).poses[0];
    let frame = crate::analytic::frame(&small(), pose, 8);
    dataset.write_frame(SCENE, CAMERA, &frame, &crate::analytic::info(&small(), pose), FrameTime::default()).unwrap();
    assert_eq!(dataset.frame_record(SCENE, CAMERA, 0).unwrap().unwrap().color, ColorKind::Rendered);
}

#[test]
fn a_frame_that_was_rendered_counts_once_its_color_is_made() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = Dataset::create(folder.path()).unwrap();
    crate::analytic::write(&dataset, &small(), 3);
    let whole = files(folder.path());
    let pose = &crate::analytic::trajectory(3).poses[0];
    let (frame, info) = (crate::analytic::frame(&small(), pose, 7), crate::analytic::info(&small(), pose));
    dataset.write_rendered(SCENE, CAMERA, &frame, &info, FrameTime::default()).unwrap();
    assert!(!dataset.has_layer(SCENE, CAMERA, 0, Layer::Color) && dataset.has_layer(SCENE, CAMERA, 0, Layer::ColorRendered));
    assert_eq!(dataset.frame_numbers(SCENE, CAMERA).unwrap(), [1]);
    let told = dataset.incomplete_frames(SCENE, CAMERA, &[1]).unwrap()[&0].to_string();
    assert!(told.contains("frame.0000.color.hdf5") && told.ends_with("run again"), "{told}");
    assert!(dataset.frame_is_complete(SCENE, CAMERA, 0, &info.config_hash), "it is not rendered again");
    let record = dataset.frame_record(SCENE, CAMERA, 0).unwrap().unwrap();
    let read = dataset.read_rendered([SCENE, CAMERA], 0, &[Layer::Color, Layer::DepthMeters]).unwrap();
    assert_eq!(read.get(Layer::Color), frame.get(Layer::Color));
    dataset.link_rendered([SCENE, CAMERA], 0).unwrap();
    assert_eq!(dataset.frame_record(SCENE, CAMERA, 0).unwrap().unwrap(), record.as_rendered());
    let layer = |layer| dataset.layout().layer(SCENE, CAMERA, 0, layer);
    let name = |path: &std::path::Path| path.strip_prefix(folder.path()).unwrap().to_path_buf();
    let after = files(folder.path());
    assert!(DENOISED.iter().all(|(plain, kept)| after[&name(&layer(*plain))] == whole[&name(&layer(*plain))] && layer(*kept).is_file()));
}

#[test]
fn a_change_of_color_that_is_cut_anywhere_costs_no_rendering_and_ends_as_if_it_had_not_been_cut() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = Dataset::create(folder.path()).unwrap();
    crate::analytic::write(&dataset, &small(), 3);
    let path = |layer| dataset.layout().layer(SCENE, CAMERA, 0, layer);
    let record = dataset.layout().frame_record(SCENE, CAMERA, 0);
    let rendered = files(folder.path());
    dataset.link_rendered([SCENE, CAMERA], 0).unwrap();
    let linked = files(folder.path());
    dataset.write_denoised([SCENE, CAMERA], 0, &ones(), ["Smoother 3.1", "face"], true).unwrap();
    let denoised = files(folder.path());
    let without_color = {
        // The state while colour is being made.
        let mut record = dataset.frame_record(SCENE, CAMERA, 0).unwrap().unwrap();
        (record.color, record.denoised) = (ColorKind::Rendered, None);
        record.files.retain(|name, _| !DENOISED.iter().any(|(plain, _)| name.ends_with(&format!(".{}.hdf5", plain.spec().name))));
        record
    };
    let put = |tree: &BTreeMap<PathBuf, Vec<u8>>| {
        DENOISED.iter().for_each(|(_, kept)| drop(fs::remove_file(path(*kept))));
        tree.iter().for_each(|(name, bytes)| enfilade_dataset::write_bytes(&folder.path().join(name), bytes).unwrap());
    };
    let is_complete = || dataset.frame_is_complete(SCENE, CAMERA, 0, &without_color.config_hash);
    let end = |denoise: bool, told: &str| {
        assert!(is_complete(), "{told}");
        match denoise {
            true => drop(dataset.write_denoised([SCENE, CAMERA], 0, &ones(), ["Smoother 3.1", "face"], true).unwrap()),
            false => dataset.link_rendered([SCENE, CAMERA], 0).unwrap(),
        }
        assert!(files(folder.path()) == if denoise { denoised.clone() } else { linked.clone() }, "{told}");
    };
    let hdf5 = |layer| path(layer).strip_prefix(folder.path()).unwrap().to_path_buf();
    for denoise in [true, false] {
        // This many of the layers that earlier versions rendered have their second name already.
        for named in 0..=3 {
            put(&rendered);
            DENOISED.into_iter().take(named).for_each(|(plain, kept)| fs::hard_link(path(plain), path(kept)).unwrap());
            end(denoise, &format!("{named} named"));
        }
        // The record has no colour, and this many layers of the other kind are written already.
        for (from, to) in [(&linked, &denoised), (&denoised, &linked)] {
            for written in 0..=3 {
                put(from);
                enfilade_dataset::write_json(&record, &without_color).unwrap();
                for (plain, _) in DENOISED.into_iter().take(written) {
                    enfilade_dataset::write_bytes(&path(plain), &to[&hdf5(plain)]).unwrap();
                }
                assert_eq!(dataset.frame_numbers(SCENE, CAMERA).unwrap(), [1]);
                end(denoise, &format!("{written} written"));
            }
        }
        // Earlier versions moved what was rendered away, `color` first, and then put the other in its place.
        for (moved, written) in (0..=3).map(|moved| (moved, 0)).chain((1..=3).map(|written| (3, written))) {
            put(&rendered);
            DENOISED.into_iter().rev().take(moved).for_each(|(plain, kept)| fs::rename(path(plain), path(kept)).unwrap());
            DENOISED.into_iter().take(written).for_each(|(plain, _)| fs::write(path(plain), "denoised").unwrap());
            end(denoise, &format!("{moved} moved, {written} written by an earlier version"));
        }
    }
    // Cut after the record, before what is not kept is gone.
    put(&rendered);
    dataset.write_denoised([SCENE, CAMERA], 0, &ones(), ["Smoother 3.1", "face"], false).unwrap();
    let done = files(folder.path());
    DENOISED.iter().for_each(|(plain, kept)| fs::write(path(*kept), &rendered[&hdf5(*plain)]).unwrap());
    assert!(!dataset.has_layer(SCENE, CAMERA, 0, Layer::ColorRendered));
    dataset.drop_rendered([SCENE, CAMERA], 0).unwrap();
    assert!(files(folder.path()) == done);
}

#[test]
fn a_frame_that_cannot_be_written_leaves_nothing_behind() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = Dataset::create(folder.path()).unwrap();
    crate::analytic::write(&dataset, &small(), 2);
    // A folder is in the place of a layer: permissions do not stop the superuser, under whom tests may run.
    let pose = &crate::analytic::trajectory(2).poses[1];
    let path = dataset.layout().layer(SCENE, CAMERA, pose.frame, Layer::Position);
    fs::create_dir_all(path.join("in the way")).unwrap();
    let frame = crate::analytic::frame(&small(), pose, 7);
    let before = files(folder.path());
    let error = dataset.write_frame(SCENE, CAMERA, &frame, &crate::analytic::info(&small(), pose), FrameTime::default()).unwrap_err();
    assert!(error.to_string().contains("frame.0001.position.hdf5"), "{error}");
    assert!(files(folder.path()) == before, "{:?}", files(folder.path()).keys());
    assert!(!dataset.frame_is_complete(SCENE, CAMERA, pose.frame, "c0ffee"));
}

#[cfg(unix)]
#[test]
fn a_read_only_folder_is_one_clear_error() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let dataset = Dataset::create(folder.path()).unwrap();
    crate::analytic::write(&dataset, &small(), 2);
    let images = dataset.layout().images_dir(SCENE).join(format!("scene_{CAMERA}_geometry_hdf5"));
    fs::set_permissions(&images, fs::Permissions::from_mode(0o555)).unwrap();
    if fs::write(images.join("probe"), "").is_ok() {
        return eprintln!("skipped: this user may write to read-only folders");
    }
    let pose = &crate::analytic::trajectory(2).poses[1];
    let frame = crate::analytic::frame(&small(), pose, 7);
    let error = dataset.write_frame(SCENE, CAMERA, &frame, &crate::analytic::info(&small(), pose), FrameTime::default()).unwrap_err();
    assert!(matches!(&error, DatasetError::Io { .. }), "{error}");
    assert!(error.to_string().contains("make the folder readable and writable"), "{error}");
    assert!(temporaries(folder.path()).is_empty());
    assert!(dataset.frame_is_complete(SCENE, CAMERA, 0, "c0ffee") && !dataset.frame_is_complete(SCENE, CAMERA, 1, "c0ffee"));
    fs::set_permissions(&images, fs::Permissions::from_mode(0o755)).unwrap();
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_one_clear_error() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = Dataset::create(folder.path()).unwrap();
    crate::analytic::write(&dataset, &small(), 2);
    let before = files(folder.path());
    let (frame, info) = {
        let pose = &crate::analytic::trajectory(2).poses[1];
        (crate::analytic::frame(&small(), pose, 7), crate::analytic::info(&small(), pose))
    };
    let record = dataset.layout().frame_record(SCENE, CAMERA, 1);
    for path in [dataset.layout().layer(SCENE, CAMERA, 1, Layer::Position), record] {
        // What is written under the temporary name goes to a device that is always full.
        let name = format!(".{}.partial", path.file_name().unwrap().to_string_lossy());
        std::os::unix::fs::symlink("/dev/full", path.with_file_name(name)).unwrap();
        let error = dataset.write_frame(SCENE, CAMERA, &frame, &info, FrameTime::default()).unwrap_err();
        let message = error.to_string();
        assert!(message.contains("frame.0001.") && message.contains("free some space on the disk"), "{message}");
        let mut after = files(folder.path());
        after.insert("manifest_times.csv".into(), before[Path::new("manifest_times.csv")].clone());
        assert!(after == before, "{:?}", after.keys());
    }
    dataset.write_frame(SCENE, CAMERA, &frame, &info, FrameTime::default()).unwrap();
    assert!(dataset.frame_is_complete(SCENE, CAMERA, 1, "c0ffee"));
}

/// Reads every array of a dataset and prints name, type, shape, chunks, filters and a checksum of its bytes.
const READ_WITH_H5PY: &str = r#"
import sys, pathlib, zlib, h5py
root = pathlib.Path(sys.argv[1])
for path in sorted(root.rglob("*.hdf5")):
    with h5py.File(path, "r") as f:
        assert list(f) == ["dataset"], path
        d = f["dataset"]
        a = d[()]
        assert all(isinstance(v, str) for v in d.attrs.values()), path
        print(path.relative_to(root).as_posix(), a.dtype, "x".join(map(str, a.shape)), zlib.crc32(a.tobytes()))
"#;

#[test]
fn h5py_reads_the_same_values() {
    let Some(python) = std::env::var_os("ENFILADE_PYTHON") else {
        return eprintln!("skipped: ENFILADE_PYTHON names no python with h5py");
    };
    // Kept, so that other programs can be tried on it by hand.
    let root = Path::new(env!("CARGO_TARGET_TMPDIR")).join("analytic");
    let _ = fs::remove_dir_all(&root);
    let dataset = Dataset::create(&root).unwrap();
    crate::analytic::write(&dataset, &small(), 3);
    dataset.write_manifest(&dataset.collect_manifest(&ManifestInfo::default()).unwrap()).unwrap();
    let output = Command::new(python).args(["-c", READ_WITH_H5PY]).arg(&root).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let lines = String::from_utf8(output.stdout).unwrap();
    assert!(lines.lines().count() >= 2 * 16 + 4 + 9 + 4, "{lines}");
    for line in lines.lines() {
        let &[name, dtype, shape, checksum] = line.split(' ').collect::<Vec<_>>().as_slice() else { panic!("{line}") };
        let array = enfilade_dataset::hdf5::read_array(&root.join(name)).unwrap();
        let own_shape = array.shape.iter().map(ToString::to_string).collect::<Vec<_>>().join("x");
        assert_eq!((dtype, shape), (array.values.element().name(), own_shape.as_str()), "{name}");
        assert_eq!(checksum, crc32(array.values.as_bytes()).to_string(), "{name}");
    }
}

/// zlib's checksum, bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    let step = |crc: u32, _| if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 };
    !bytes.iter().fold(!0, |crc, &byte| (0..8).fold(crc ^ u32::from(byte), step))
}
