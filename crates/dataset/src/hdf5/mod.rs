//! One array per file, exactly as Hypersim's files are: one dataset named `dataset`, no groups.
//!
//! Images are stored in chunks, deflated and where that pays shuffled (see [`Packing`]), which every HDF5 reader understands; camera
//! arrays are stored as they are. Files have superblock version 0, as h5py writes by default, so that any libhdf5 since 1.6 opens them.
//! The HDF5 library is used in [`write_array`] and [`read_array`] alone. [`read_window`] does not use it for images: it finds the chunks
//! itself and inflates those that it needs with libdeflate, in less than half of the library's time.
//!
//! ```
//! use enfilade_dataset::hdf5::{Array, Storage, read_array, write_array};
//! # let folder = tempfile::tempdir()?;
//! let path = folder.path().join("camera_keyframe_positions.hdf5");
//! let positions = Array::f64(&[2, 3], vec![0.0, 0.0, 1.5, 1.0, 0.0, 1.5]);
//! write_array(&path, &positions, Storage::Contiguous, &[("unit", "m")])?;
//! assert_eq!(read_array(&path)?, positions);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod array;
mod bytes;
mod chunk_tree;
mod chunks;
mod image_decoder;
mod image_map;
mod length;
mod lz4;
mod packing;
mod read;
mod volume;
mod volume_array;
mod window;
mod write;

pub(crate) use array::ArrayView;
pub use array::{Array, Element, Elements};
pub(crate) use length::missing_bytes;
pub use packing::{Packing, Storage};
pub use read::{image_shape, read_array, read_window};
pub use volume::Volume;
pub use volume_array::{Number, VolumeArray};
pub use window::Window;
pub use write::write_array;
pub(crate) use write::write_view;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DatasetError;
    use enfilade_frame::f16;
    use std::path::Path;

    const SHAPES: [&[usize]; 6] = [&[1, 1], &[7, 5], &[97, 131], &[97, 131, 3], &[300, 400, 3], &[13]];

    /// Values of every element type that differ from each other and fill all their bytes.
    fn arrays() -> Vec<Array> {
        let mut arrays = vec![Array::f64(&[100, 3, 3], (0..900).map(|i| f64::from(i) / 7.0).collect()), Array::i64(&[0], vec![])];
        for shape in SHAPES {
            let n = shape.iter().product::<usize>();
            let wave = |i: usize| (i as f64 * 0.37).sin() * 100.0;
            arrays.extend([
                Array::new(shape, Elements::F16((0..n).map(|i| f16::from_f64(wave(i))).collect())),
                Array::new(shape, Elements::F32((0..n).map(|i| wave(i) as f32).collect())),
                Array::new(shape, Elements::F64((0..n).map(wave).collect())),
                Array::new(shape, Elements::I16((0..n).map(|i| (i * 7919 % 65536) as i16).collect())),
                Array::new(shape, Elements::I64((0..n).map(|i| i as i64 - 3).collect())),
                Array::new(shape, Elements::U8((0..n).map(|i| (i % 251) as u8).collect())),
            ]);
        }
        arrays
    }

    /// Every way of storing, with chunks that do not divide the images.
    fn storages() -> Vec<Storage> {
        let image = |channels_together, shuffle| Storage::Image(Packing { chunk: [64, 48], channels_together, shuffle, level: 6 });
        let images = [(true, true), (true, false), (false, true), (false, false)].map(|(together, shuffle)| image(together, shuffle));
        [vec![Storage::Contiguous, Storage::Compressed, Storage::Fast], images.into()].concat()
    }

    #[test]
    fn arrays_of_every_type_and_shape_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.hdf5");
        for array in arrays() {
            for storage in storages() {
                write_array(&path, &array, storage, &[("unit", "m")]).unwrap();
                assert!(read_array(&path).unwrap() == array, "{:?} {storage:?}", array.shape);
            }
        }
    }

    #[test]
    fn a_window_has_the_values_of_the_whole_image() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.hdf5");
        for array in arrays().into_iter().filter(|array| matches!(array.shape.len(), 2 | 3) && array.shape[1] > 100) {
            for storage in storages() {
                write_array(&path, &array, storage, &[]).unwrap();
                assert_eq!(image_shape(&path).unwrap(), array.shape);
                for (top, left, height, width) in [(0, 0, 97, 131), (5, 70, 66, 40), (63, 47, 2, 2), (96, 130, 1, 1), (10, 10, 0, 5)] {
                    let window = Window { top, left, height, width };
                    let read = read_window(&path, window).unwrap();
                    let channels = array.shape.get(2).copied().unwrap_or(1);
                    let pixel = channels * array.values.element().size();
                    let row = |y: usize| ((y * array.shape[1] + left) * pixel)..((y * array.shape[1] + left + width) * pixel);
                    let expected: Vec<u8> = (top..top + height).flat_map(|y| &array.values.as_bytes()[row(y)]).copied().collect();
                    assert_eq!(read.shape[..2], [height, width]);
                    assert!(read.values.as_bytes() == expected, "{:?} {storage:?} {window:?}", array.shape);
                }
                let outside = Window { top: 0, left: array.shape[1] - 3, height: 2, width: 4 };
                assert!(read_window(&path, outside).unwrap_err().to_string().contains("a.hdf5"));
            }
        }
    }

    #[test]
    fn images_are_read_past_the_library() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.hdf5");
        for array in arrays().into_iter().filter(|array| matches!(array.shape.len(), 2 | 3) && array.shape[1] > 1) {
            for storage in storages() {
                write_array(&path, &array, storage, &[("unit", "m")]).unwrap();
                assert!(image_decoder::read_image(&path).unwrap() == array, "{:?} {storage:?}", array.shape);
            }
        }
    }

    #[test]
    fn fast_images_are_one_run_where_lz4_does_not_pay() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.hdf5");
        let size = |shape: &[usize], values: Elements| {
            let array = Array::new(shape, values);
            write_array(&path, &array, Storage::Fast, &[]).unwrap();
            assert!(read_array(&path).unwrap() == array);
            (std::fs::metadata(&path).unwrap().len() as usize, array.values.as_bytes().len())
        };
        // Without periods that LZ4 would find.
        let mixed = |i: u32| {
            let i = (i ^ i >> 16).wrapping_mul(0x21f0_aaad);
            let i = (i ^ i >> 15).wrapping_mul(0x735a_2d97);
            i ^ i >> 15
        };
        let smooth = |n: usize| Elements::F16((0..n).map(|i| f16::from_f32((i / 3000) as f32)).collect());
        let noise = |n: usize| Elements::F16((0..n).map(|i| f16::from_bits(mixed(i as u32) as u16 >> 2)).collect());
        let (stored, raw) = size(&[300, 400], smooth(120_000));
        assert!(stored >= raw, "depth is copied: {stored} of {raw}");
        let (stored, raw) = size(&[300, 400, 3], noise(360_000));
        assert!((raw..raw + 4096).contains(&stored), "LZ4 saves nothing: {stored} of {raw}");
        let (stored, raw) = size(&[300, 400, 3], smooth(360_000));
        assert!(4 * stored < raw, "LZ4 saves much: {stored} of {raw}");
        let (stored, raw) = size(&[300, 400], Elements::I16((0..120_000).map(|i| (i / 700) as i16).collect()));
        assert!(4 * stored < raw, "so it does of classes: {stored} of {raw}");
    }

    #[test]
    fn the_same_array_gives_the_same_bytes() {
        let folder = tempfile::tempdir().unwrap();
        for array in arrays() {
            for storage in storages() {
                let write = |name: &str| {
                    let path = folder.path().join(name);
                    write_array(&path, &array, storage, &[("unit", "m"), ("space", "world")]).unwrap();
                    std::fs::read(&path).unwrap()
                };
                assert!(write("a.hdf5") == write("another name.hdf5"), "{:?} {storage:?}", array.shape);
            }
        }
    }

    #[test]
    fn a_pointer_of_git_lfs_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("frame.0000.color.hdf5");
        std::fs::write(&path, "version https://git-lfs.github.com/spec/v1\noid sha256:00112233\nsize 28200\n").unwrap();
        let message = read_array(&path).unwrap_err().to_string();
        assert!(message.contains("frame.0000.color.hdf5: it is a Git LFS pointer"), "{message}");
    }

    #[test]
    fn a_damaged_file_is_an_error_that_names_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("frame.0000.depth_meters.hdf5");
        let array = Array::new(&[67, 71], Elements::F32((0..67 * 71).map(|i| (i as f32).sin()).collect()));
        for storage in &storages()[..4] {
            write_array(&path, &array, *storage, &[]).unwrap();
            let whole = std::fs::read(&path).unwrap();
            for length in (0..whole.len()).step_by(197).chain([whole.len() - 1]) {
                std::fs::write(&path, &whole[..length]).unwrap();
                let Err(error) = read_array(&path) else { panic!("{length} of {} bytes pass", whole.len()) };
                let message = error.to_string();
                assert!(message.contains("depth_meters.hdf5") && message.contains("cut short"), "{length}: {message}");
            }
            // Bytes that are altered may pass unnoticed (HDF5 has no checksum here), but must not panic.
            for at in (0..2000).step_by(3).chain((2000..whole.len()).step_by(501)) {
                let mut altered = whole.clone();
                altered[at] ^= 0xff;
                std::fs::write(&path, altered).unwrap();
                let _ = read_array(&path);
            }
        }
    }

    #[test]
    fn a_file_that_is_missing_or_no_hdf5_is_told_apart() {
        let folder = tempfile::tempdir().unwrap();
        let missing = read_array(&folder.path().join("nothing.hdf5")).unwrap_err();
        assert!(missing.is_not_found(), "{missing}");
        let text = folder.path().join("text.hdf5");
        std::fs::write(&text, "not an array at all, but long enough to hold a superblock".repeat(20)).unwrap();
        assert!(matches!(read_array(&text), Err(DatasetError::Hdf5 { .. })));
        assert!(matches!(read_array(folder.path()), Err(DatasetError::Io { .. })));
        assert!(write_array(&folder.path().join("no/folder.hdf5"), &arrays()[0], Storage::Contiguous, &[]).unwrap_err().is_not_found());
    }

    #[test]
    fn hypersims_own_files_are_read() {
        let Some(scenes) = std::env::var_os("ENFILADE_SCENES") else {
            return eprintln!("skipped: ENFILADE_SCENES is not set");
        };
        let camera = Path::new(&scenes).join("hypersim-real/ai_037_002/_detail/cam_00");
        let orientations = read_array(&camera.join("camera_keyframe_orientations.hdf5")).unwrap();
        assert_eq!((orientations.shape, orientations.values.element()), (vec![100, 3, 3], Element::F64));
        let geometry = Path::new(&scenes).join("hypersim-real/ai_037_002/images/scene_cam_00_geometry_hdf5");
        let depth = read_array(&geometry.join("frame.0000.depth_meters.hdf5")).unwrap();
        assert_eq!(depth.shape, [768, 1024]);
        let Elements::F16(metres) = depth.values else { panic!("{:?}", depth.values.element()) };
        assert!(metres.iter().filter(|d| d.to_f32() > 0.1 && d.to_f32() < 100.0).count() > 700_000);
    }
}
