//! Exports read back without Python: COLMAP's binary files byte by byte, OpenEXR by its crate, archives by theirs.

use crate::common::{files, layer};
use enfilade_dataset::{Dataset, planar_depth};
use enfilade_export::{CloudSource, Existing, ExportConfig, Format, export};
use enfilade_frame::{Layer, Values};
use enfilade_math::{DMat3, DQuat, DVec3};
use enfilade_scene::{Camera, Intrinsics, Projection, Quiet, TiltedPinhole};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Exports the analytic dataset.
fn exported(format: Format, shard_bytes: u64) -> (tempfile::TempDir, Dataset, PathBuf) {
    exported_of(&crate::common::pinhole_of(format), format, shard_bytes)
}

/// Exports a dataset as [`exported`] does, taken with this camera.
fn exported_of(camera: &Camera, format: Format, shard_bytes: u64) -> (tempfile::TempDir, Dataset, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let dataset = crate::common::write(&folder.path().join("dataset"), camera);
    let out = folder.path().join("out");
    // The few frames do not show a room to all its walls, which point clouds for layouts ask for.
    let config = ExportConfig { shard_bytes, cloud: CloudSource::Mesh, ..ExportConfig::new(format, dataset.scenes().unwrap()) };
    export(&dataset, &config, &out, Existing::Refuse, &Quiet).unwrap();
    (folder, dataset, out)
}

/// Numbers one after the other, little-endian.
struct Bytes<'b>(&'b [u8]);

impl Bytes<'_> {
    fn take<const N: usize>(&mut self) -> [u8; N] {
        let (head, rest) = self.0.split_at(N);
        self.0 = rest;
        head.try_into().unwrap()
    }

    fn u64(&mut self) -> u64 {
        u64::from_le_bytes(self.take())
    }

    fn u32(&mut self) -> u32 {
        u32::from_le_bytes(self.take())
    }

    fn f64(&mut self) -> f64 {
        f64::from_le_bytes(self.take())
    }

    fn doubles(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| self.f64()).collect()
    }

    fn text(&mut self) -> String {
        std::iter::repeat_with(|| self.take::<1>()[0]).take_while(|&b| b != 0).map(char::from).collect()
    }
}

#[test]
fn colmaps_tracks_join_points_with_the_pixels_that_show_them() {
    let (_folder, _, out) = exported(Format::Colmap, 1);
    let read = |name: &str| std::fs::read(out.join("room/sparse/0").join(name)).unwrap();
    let cameras = read("cameras.bin");
    let mut bytes = Bytes(&cameras);
    assert_eq!(bytes.u64(), 2);
    assert_eq!((bytes.u32(), bytes.u32(), bytes.u64(), bytes.u64()), (1, 1, 40, 30), "a plain pinhole is PINHOLE, model 1");
    let k = bytes.doubles(4);
    assert_eq!(k, [33.0, 34.5, 19.25, 15.75]);
    let (images, points) = (read("images.bin"), read("points3D.bin"));
    let mut bytes = Bytes(&points);
    let mut positions: BTreeMap<u64, (DVec3, Vec<(u32, u32)>)> = BTreeMap::new();
    for _ in 0..bytes.u64() {
        let (id, position) = (bytes.u64(), DVec3::from_slice(&bytes.doubles(3)));
        let color: [u8; 3] = bytes.take();
        assert!(color.iter().any(|&channel| channel > 0), "points have colours");
        assert_eq!(bytes.f64(), 0.0, "error");
        let track = (0..bytes.u64()).map(|_| (bytes.u32(), bytes.u32())).collect();
        positions.insert(id, (position, track));
    }
    assert!(bytes.0.is_empty() && positions.len() > 1000, "{} points", positions.len());
    let mut bytes = Bytes(&images);
    let (mut names, mut sightings) = (Vec::new(), 0);
    for _ in 0..bytes.u64() {
        let id = bytes.u32();
        let pose = bytes.doubles(7);
        let rotation = DQuat::from_xyzw(pose[1], pose[2], pose[3], pose[0]);
        bytes.u32();
        names.push(bytes.text());
        for index in 0..bytes.u64() as u32 {
            let (x, y, point) = (bytes.f64(), bytes.f64(), bytes.u64());
            let (position, track) = &positions[&point];
            assert!(track.contains(&(id, index)));
            let p = rotation * *position + DVec3::from_slice(&pose[4..]);
            assert!((k[0] * p.x / p.z + k[2] - x).abs() < 1e-9 && (k[1] * p.y / p.z + k[3] - y).abs() < 1e-9);
            sightings += 1;
        }
    }
    assert!(bytes.0.is_empty());
    assert_eq!(names, ["cam_00_0000.png", "cam_00_0001.png", "cam_00_0003.png", "cam_01_0000.png"]);
    // Gaussian splatting's first loader looks for the last part of a name in `images/`, and calls a picture what is before the first dot.
    let mut stems: Vec<&str> = names.iter().map(|name| name.rsplit('/').next().unwrap().split('.').next().unwrap()).collect();
    stems.dedup();
    assert_eq!(stems.len(), names.len());
    let entries: Vec<_> = std::fs::read_dir(out.join("room/images")).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert!(entries.len() == names.len() && entries.iter().all(|path| path.is_file()), "{entries:?}");
    assert_eq!(sightings, positions.values().map(|(_, track)| track.len()).sum::<usize>());
    assert!(sightings > 2 * positions.len(), "most points are seen by several frames: {sightings} of {}", positions.len());
}

#[test]
fn openexr_has_every_layer_bit_by_bit_and_a_manifest_of_its_ids() {
    use exr::prelude::{AttributeValue, FlatSamples, ReadChannels, ReadLayers, read};
    let (_folder, dataset, out) = exported(Format::Exr, 1);
    let path = out.join("room/cam_00/frame.0003.exr");
    let image =
        read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes().from_file(path).unwrap();
    let channel =
        |name: &str| &image.layer_data.channel_data.list.iter().find(|c| c.name.eq(name)).unwrap_or_else(|| panic!("{name}")).sample_data;
    for layer in crate::common::layers() {
        let values = crate::common::layer(&dataset, "room", "cam_00", 3, layer);
        let spec = layer.spec();
        for c in 0..spec.channels {
            let letter = if spec.channels == 1 {
                "V"
            } else if layer == Layer::Position {
                ["X", "Y", "Z"][c]
            } else {
                ["R", "G", "B"][c]
            };
            let name = if layer == Layer::Color { letter.to_string() } else { format!("{}.{letter}", spec.name) };
            for i in 0..values.len() / spec.channels {
                let expected = values.get(i * spec.channels + c);
                let found = match channel(&name) {
                    FlatSamples::F16(v) => v[i].to_f64(),
                    FlatSamples::F32(v) => f64::from(v[i]),
                    FlatSamples::U32(_) => panic!("{name} has whole numbers"),
                };
                assert!(found == expected || found.is_nan() && expected.is_nan(), "{name} {i}: {found} instead of {expected}");
            }
        }
    }
    let attributes: BTreeMap<String, String> = image
        .layer_data
        .attributes
        .other
        .iter()
        .filter_map(|(name, value)| match value {
            AttributeValue::Text(text) => Some((name.to_string(), text.to_string())),
            _ => None,
        })
        .collect();
    let manifests: Vec<&String> = attributes.iter().filter(|(name, _)| name.ends_with("/manifest")).map(|(_, value)| value).collect();
    assert!(manifests.iter().any(|m| m.contains("\"table_001\"") && m.contains("\"chair_002\"")), "{manifests:?}");
    assert!(manifests.iter().any(|m| m.contains("\"floor\"") && m.contains("\"wall\"")), "{manifests:?}");
}

#[test]
fn planar_depth_in_openexr_is_along_the_axis_of_k_of_a_tilted_camera() {
    use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read};
    let k = Intrinsics { width: 40, height: 30, fx: 33.0, fy: 34.5, cx: 19.25, cy: 15.75, skew: 0.0 };
    let tilted = TiltedPinhole::new(40, 30, DMat3::from_rotation_x(0.15) * k.cam_from_uv()).unwrap();
    let camera: Camera = Projection::TiltedPinhole(tilted).into();
    let (_folder, dataset, out) = exported_of(&camera, Format::Exr, 1);
    let path = out.join("room/cam_00/frame.0001.exr");
    let image =
        read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes().from_file(path).unwrap();
    let channel = image.layer_data.channel_data.list.iter().find(|channel| channel.name.eq("depth_z_meters.V")).unwrap();
    let FlatSamples::F32(found) = &channel.sample_data else { panic!("depth is float32") };
    let expected = planar_depth(&camera.projection, &layer(&dataset, "room", "cam_00", 1, Layer::DepthMeters));
    let stored = layer(&dataset, "room", "cam_00", 1, Layer::DepthZMeters);
    let seen: Vec<usize> = (0..found.len()).filter(|&i| expected[i].is_finite()).collect();
    assert!(seen.len() > 500 && seen.iter().all(|&i| (found[i] - expected[i]).abs() < 1e-5));
    assert!(seen.iter().any(|&i| (f64::from(found[i]) - stored.get(i)).abs() > 0.05), "the axis is another than the camera's");
}

#[test]
fn shards_hold_whole_samples_and_headers_without_time_or_user() {
    let (_folder, dataset, out) = exported(Format::Webdataset, 120_000);
    let shards: Vec<PathBuf> = files(&out).into_keys().filter(|name| name.extension().is_some_and(|e| e == "tar")).collect();
    assert!(shards.len() > 1, "{shards:?}");
    let (mut keys, mut closed) = (Vec::new(), Vec::new());
    for shard in &shards {
        assert!(out.join(shard).metadata().unwrap().len() < 150_000, "{shard:?}");
        for entry in tar::Archive::new(std::fs::File::open(out.join(shard)).unwrap()).entries().unwrap() {
            let mut entry = entry.unwrap();
            let header = entry.header();
            assert_eq!((header.mtime().unwrap(), header.uid().unwrap(), header.gid().unwrap()), (0, 0, 0));
            let name = entry.path().unwrap().to_string_lossy().into_owned();
            let (key, extension) = name.split_at(name.rfind('/').unwrap() + 5);
            if keys.last().is_none_or(|last| last != key) {
                assert!(!closed.contains(&key.to_string()), "{key} is torn");
                closed.extend(keys.last().cloned());
                keys.push(key.to_string());
            }
            if (key, extension) == ("room/cam_00/0001", ".semantic.npy") {
                let mut content = Vec::new();
                std::io::Read::read_to_end(&mut entry, &mut content).unwrap();
                let Values::I16(expected) = layer(&dataset, "room", "cam_00", 1, Layer::Semantic) else { panic!() };
                let found: Vec<i16> = content[128..].chunks_exact(2).map(|b| i16::from_le_bytes([b[0], b[1]])).collect();
                assert_eq!(found, expected);
            }
        }
    }
    let expected =
        ["room/cam_00/0000", "room/cam_00/0001", "room/cam_00/0003", "room/cam_01/0000", "room-two/cam_00/0000", "room-two/cam_00/0012"];
    let mut sorted = expected.map(String::from).to_vec();
    sorted.sort();
    keys.sort();
    assert_eq!(keys, sorted);
}

#[test]
fn depth_is_planar_to_the_millimetre_and_zero_where_nothing_was_hit() {
    let (_folder, dataset, out) = exported(Format::DepthPng, 1);
    let picture = image::open(out.join("room/cam_00/frame.0000.png")).unwrap().into_luma16();
    let planar = layer(&dataset, "room", "cam_00", 0, Layer::DepthZMeters);
    let mut void = 0;
    for (i, pixel) in picture.pixels().enumerate() {
        let (found, expected) = (f64::from(pixel.0[0]) / 1000.0, planar.get(i));
        void += usize::from(expected.is_nan());
        assert!(if expected.is_nan() { found == 0.0 } else { (found - expected).abs() <= 0.000_501 }, "{i}: {found} {expected}");
    }
    assert!(void > 10, "the test's frame has no void");
}

#[test]
fn two_exports_are_the_same_and_name_no_folder() {
    for spec in enfilade_export::FORMATS {
        let ((_a, _, first), (_b, _, second)) = (exported(spec.format, 150_000), exported(spec.format, 150_000));
        let (a, b) = (files(&first), files(&second));
        let differ: Vec<&PathBuf> = a.keys().filter(|name| a.get(*name) != b.get(*name)).collect();
        assert!(differ.is_empty() && a.len() == b.len(), "{}: {differ:?}", spec.name);
        let root = first.parent().unwrap_or(Path::new("")).to_string_lossy().into_owned();
        assert!(!a.values().any(|bytes| String::from_utf8_lossy(bytes).contains(&root)), "{} names {root}", spec.name);
    }
}
