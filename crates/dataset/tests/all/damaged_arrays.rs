//! Arrays whose chunks are not where they should be: an error at once, never a hang, much memory, or zeros.

use crate::damaged::{branching_tree, chunk_tree};
use enfilade_dataset::hdf5::{Packing, Storage, read_array, read_window, write_array};
use enfilade_dataset::{Array, Elements, Window};
use std::fs::{self, File};
use std::path::Path;

/// A list and an image, each in one chunk.
fn arrays() -> [(Array, Storage); 2] {
    let packing = Packing { chunk: [64, 64], channels_together: true, shuffle: true, level: 6 };
    let image = Array::new(&[9, 7], Elements::I16((1..64).collect()));
    [(Array::i64(&[13], (1..14).collect()), Storage::Compressed), (image, Storage::Image(packing))]
}

/// The bytes of the array's file at `path`.
fn written(path: &Path, array: &Array, storage: Storage) -> Vec<u8> {
    write_array(path, array, storage, &[]).unwrap();
    assert!(read_array(path).unwrap() == *array);
    fs::read(path).unwrap()
}

#[test]
fn a_tree_that_leads_to_a_node_twice_is_an_error_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("branching.hdf5");
    for (array, storage) in arrays() {
        let whole = written(&path, &array, storage);
        fs::write(&path, branching_tree(&whole, array.shape.len(), 50)).unwrap();
        let message = read_array(&path).unwrap_err().to_string();
        assert!(message.contains("branching.hdf5") && message.contains("the index of its chunks"), "{message}");
        // Also where the superblock keeps no address of the list of names, so that ours does not find the array, and the library does.
        let mut other = branching_tree(&whole, array.shape.len(), 50);
        other[72] = 0;
        fs::write(&path, other).unwrap();
        let message = read_array(&path).unwrap_err().to_string();
        assert!(message.contains("branching.hdf5") && message.contains("the index of its chunks"), "{message}");
    }
}

#[test]
fn a_chunk_beyond_the_file_is_an_error_and_not_zeros() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("flipped.hdf5");
    for (array, storage) in arrays() {
        let mut file = written(&path, &array, storage);
        // The key of the first chunk follows the node's 24 bytes, and its address follows the key.
        let address = chunk_tree(&file) + 24 + 8 + 8 * (array.shape.len() + 1);
        file[address + 5] ^= 1;
        fs::write(&path, file).unwrap();
        let message = read_array(&path).unwrap_err().to_string();
        assert!(message.contains("flipped.hdf5") && message.contains("the index of its chunks"), "{message}");
    }
    let window = Window { top: 0, left: 0, height: 2, width: 2 };
    assert!(read_window(&path, window).unwrap_err().to_string().contains("flipped.hdf5"));
}

#[test]
fn more_chunks_than_the_file_can_tell_of_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cut_small.hdf5");
    let packing = Packing { chunk: [1, 1], channels_together: true, shuffle: false, level: 1 };
    let mut file = written(&path, &Array::new(&[11, 13], Elements::U8((0..143).collect())), Storage::Image(packing));
    let sides = |sides: [u64; 2]| sides.map(u64::to_le_bytes).concat();
    let places: Vec<usize> = (0..file.len() - 16).filter(|&at| file[at..at + 16] == sides([11, 13])[..]).collect();
    assert!(!places.is_empty(), "the shape stands in the file");
    places.iter().for_each(|&at| file[at..at + 16].copy_from_slice(&sides([32_000, 32_000])));
    fs::write(&path, file).unwrap();
    // Long enough for the elements, if they were deflated well.
    File::options().write(true).open(&path).unwrap().set_len(1 << 20).unwrap();
    let message = read_array(&path).unwrap_err().to_string();
    assert!(message.contains("cut_small.hdf5") && message.contains("cannot hold chunks of [1, 1]"), "{message}");
}
