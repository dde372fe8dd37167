//! Parts of arrays in HDF5 files with several datasets and groups, as MATLAB 7.3 and h5py write them by default.
//!
//! MATLAB's files begin with a block of 512 bytes of its own, from whose end all addresses count. This walks superblocks 0 and 1, groups of
//! symbol tables, object headers of version 1, and data that are compact, contiguous or in chunks under a B-tree of version 1, deflated
//! and shuffled or as they are ("HDF5 File Format Specification Version 3.0", sections II.A, III.A, III.B, III.C, IV.A). Nothing is kept
//! open between reads, so an array may be read from many threads and after a fork.

use super::bytes::{FileBytes, max_chunks, u16_at, u32_at, u64_at, usize_at};
use super::chunk_tree::{self, ChunkSpan};
use super::image_map::{DEFLATE, MAX_DEPTH, SHUFFLE, filters, messages};
use super::volume_array::{DAMAGED, Layout, NOWHERE, Number, VolumeArray, grid};
use crate::DatasetError;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";
const REWRITE: &str = "write the file again in HDF5's oldest form, as MATLAB's -v7.3 and h5py without libver do";

/// A file of several arrays.
#[derive(Debug)]
pub struct Volume {
    path: PathBuf,
    /// Position of the HDF5 data in the file, in bytes.
    base: u64,
    /// Addresses of the headers of the root group's members.
    members: BTreeMap<String, u64>,
}

impl Volume {
    /// Reads the list of a file's arrays.
    ///
    /// # Errors
    /// When the file is missing, no HDF5, damaged, or of a newer form of HDF5.
    pub fn open(path: &Path) -> Result<Self, DatasetError> {
        std::fs::metadata(path).map_err(DatasetError::at("read", path))?;
        let mut source =
            FileBytes::open(path).ok_or_else(|| std::io::Error::other("it cannot be opened")).map_err(DatasetError::at("read", path))?;
        let wrong = |problem: String| DatasetError::hdf5(path, problem);
        let base = begin(&mut source).ok_or_else(|| wrong("holds no HDF5; check that the path is right and the download whole".into()))?;
        let mut source = source.based_at(base);
        let version = source.bytes(8, 1).map_or(0, |bytes| bytes[0]);
        if version > 1 {
            return Err(wrong(format!("is HDF5 with a superblock of version {version}, expected 0 or 1; {REWRITE}")));
        }
        let members = members(&mut source, version).ok_or_else(|| wrong(DAMAGED.into()))?;
        Ok(Self { path: path.to_path_buf(), base, members })
    }

    /// Names of the arrays and groups at the top.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.members.keys().map(String::as_str)
    }

    /// An array by its name.
    ///
    /// # Errors
    /// When there is none, it is damaged, or stored in an unknown way.
    pub fn array(&self, name: &str) -> Result<VolumeArray, DatasetError> {
        let Some(&header) = self.members.get(name) else {
            let names: Vec<&str> = self.names().collect();
            return Err(DatasetError::hdf5(&self.path, format!("has no array {name:?}; it has {}", names.join(", "))));
        };
        self.array_at(name, header)
    }

    /// The texts of an array of references to texts, MATLAB's cells, in the order in which they are stored.
    ///
    /// # Errors
    /// When it is no such array, or damaged.
    pub fn texts(&self, name: &str) -> Result<Vec<String>, DatasetError> {
        let cells = self.array(name)?;
        let wrong = || DatasetError::hdf5(&self.path, format!("{name} is no list of texts (MATLAB's cells of characters)"));
        if cells.number != Number::Reference {
            return Err(wrong());
        }
        let addresses = cells.read_all()?;
        let text = |address: &[u8]| {
            let array = self.array_at(name, u64_at(address, 0).ok_or_else(wrong)?)?;
            if array.number != Number::U16 {
                return Err(wrong());
            }
            let units: Vec<u16> = array.read_all()?.chunks_exact(2).map(|unit| u16::from_le_bytes([unit[0], unit[1]])).collect();
            Ok(String::from_utf16_lossy(&units))
        };
        addresses.chunks_exact(8).map(text).collect()
    }

    fn array_at(&self, name: &str, header: u64) -> Result<VolumeArray, DatasetError> {
        let wrong = |problem: &str| DatasetError::hdf5(&self.path, format!("array {name:?}: {problem}"));
        let mut source = FileBytes::open(&self.path).ok_or_else(|| wrong("the file is gone"))?.based_at(self.base);
        let mut found = Header::default();
        messages(&mut source, header, &mut |kind, body| found.take(kind, body)).ok_or_else(|| wrong(found.problem.unwrap_or(DAMAGED)))?;
        let number = found.number.ok_or_else(|| wrong("it has no type; is it a group?"))?;
        let shape = found.shape.ok_or_else(|| wrong("it has no shape; is it a group?"))?;
        let bytes = shape.iter().try_fold(number.size(), |n, &axis| n.checked_mul(axis));
        if bytes.is_none_or(|bytes| bytes as u64 > source.max_inflated()) {
            return Err(wrong(DAMAGED));
        }
        let layout = match found.layout.ok_or_else(|| wrong("it has no data; is it a group?"))? {
            Stored::Compact(bytes) => Layout::Compact(bytes),
            Stored::Contiguous(address) => Layout::Contiguous(address),
            Stored::Chunked { tree, sides } => {
                let bytes = sides.iter().try_fold(1_u64, |n, &side| n.checked_mul(side as u64));
                let possible = bytes.is_some_and(|bytes| bytes <= source.max_inflated());
                let known = possible && sides.len() == shape.len() + 1 && sides.last() == Some(&number.size()) && !sides.contains(&0);
                let (shuffled, deflated) = match found.filters.as_deref().unwrap_or_default() {
                    [] => (false, false),
                    [DEFLATE] => (false, true),
                    [SHUFFLE] => (true, false),
                    [SHUFFLE, DEFLATE] => (true, true),
                    other => {
                        let problem =
                            format!("is compressed by HDF5's filters {other:?}, expected deflate, with or without shuffle; {REWRITE}");
                        return Err(wrong(&problem));
                    }
                };
                let chunk = sides[..shape.len().min(sides.len())].to_vec();
                let places = known.then(|| chunks(&mut source, tree, &shape, &chunk)).flatten().ok_or_else(|| wrong(DAMAGED))?;
                Layout::Chunked { chunk, shuffled, deflated, places }
            }
        };
        Ok(VolumeArray { path: self.path.clone(), base: self.base, name: name.into(), number, shape, layout })
    }
}

/// Position of the HDF5 data in bytes: the start of the file, or 512, or twice that, and so on.
fn begin(source: &mut FileBytes) -> Option<u64> {
    let mut places = std::iter::once(0).chain((9..24).map(|power| 1 << power));
    places.find(|&place| source.bytes(place, 8).is_some_and(|bytes| bytes == SIGNATURE))
}

/// The members of the root group.
fn members(source: &mut FileBytes, version: u8) -> Option<BTreeMap<String, u64>> {
    // Version 1 has four bytes more in front of the addresses.
    let addresses = if version == 0 { 24 } else { 28 };
    let superblock = source.bytes(0, 100)?;
    let entry = addresses + 32;
    let symbol_table = u32_at(&superblock, entry + 16)? == 1;
    let end_of_file = u64_at(&superblock, addresses + 16)?;
    if superblock[13..15] != [8, 8] || !symbol_table || end_of_file > source.length {
        return None;
    }
    let heap = source.bytes(u64_at(&superblock, entry + 32)?, 32)?;
    let names = if heap.starts_with(b"HEAP") { u64_at(&heap, 24)? } else { return None };
    let mut members = BTreeMap::new();
    group(source, u64_at(&superblock, entry + 24)?, names, 0, &mut members)?;
    Some(members)
}

/// Enters the members of a node of a group's tree, and of those below it.
fn group(source: &mut FileBytes, node: u64, names: u64, depth: usize, members: &mut BTreeMap<String, u64>) -> Option<()> {
    source.walk(node)?;
    const MAX_NAME: usize = 1024;
    let start = source.bytes(node, 24)?;
    if start.starts_with(b"SNOD") {
        let count = usize::from(u16_at(&start, 6)?);
        for entry in source.bytes(node.checked_add(8)?, count * 40)?.chunks_exact(40) {
            let name = names.checked_add(u64_at(entry, 0)?)?;
            let mut text = Vec::new();
            while text.len() < MAX_NAME {
                match source.bytes(name.checked_add(text.len() as u64)?, 1)?[0] {
                    0 => break,
                    byte => text.push(byte),
                }
            }
            members.insert(String::from_utf8_lossy(&text).into_owned(), u64_at(entry, 8)?);
        }
        return Some(());
    }
    if depth > MAX_DEPTH || !start.starts_with(b"TREE\0") {
        return None;
    }
    let entries = usize::from(u16_at(&start, 6)?);
    let body = source.bytes(node.checked_add(24)?, 8 + entries * 16)?;
    (0..entries).try_for_each(|entry| group(source, u64_at(&body, 8 + 16 * entry)?, names, depth + 1, members))
}

/// Contents of the messages of an array's header.
#[derive(Default)]
struct Header {
    shape: Option<Vec<usize>>,
    number: Option<Number>,
    layout: Option<Stored>,
    filters: Option<Vec<u16>>,
    /// Why the header was not read to its end.
    problem: Option<&'static str>,
}

enum Stored {
    Compact(Vec<u8>),
    Contiguous(u64),
    Chunked { tree: u64, sides: Vec<usize> },
}

impl Header {
    fn take(&mut self, kind: u16, body: &[u8]) -> Option<()> {
        match kind {
            // Dataspace.
            0x01 => {
                let rank = usize::from(*body.get(1)?);
                let axes = (0..rank).map(|axis| usize_at(body, 8 + 8 * axis)).collect::<Option<_>>();
                self.shape = Some(axes.filter(|_| body[0] == 1)?);
            }
            // Datatype.
            0x03 => {
                self.number = Number::of(body);
                self.known(self.number.is_some(), "its elements are no uint8, uint16, float32, float64 or references, little-endian")?;
            }
            // Data layout.
            0x08 => {
                self.known(
                    body.first() == Some(&3),
                    "its data use an HDF5 layout that is not read here; write the file again with h5repack",
                )?;
                self.layout = Some(match *body.get(1)? {
                    0 => Stored::Compact(body.get(4..4 + usize::from(u16_at(body, 2)?))?.to_vec()),
                    1 => Stored::Contiguous(u64_at(body, 2)?),
                    _ => {
                        let axes = usize::from(*body.get(2)?);
                        let side = |axis| u32_at(body, 11 + 4 * axis).map(|side| side as usize);
                        Stored::Chunked { tree: u64_at(body, 3)?, sides: (0..axes).map(side).collect::<Option<_>>()? }
                    }
                });
            }
            // Filter pipeline.
            0x0b => self.filters = Some(filters(body)?),
            // External files.
            0x07 => self.known(false, "its data are in other files")?,
            _ => {}
        }
        Some(())
    }

    fn known(&mut self, known: bool, problem: &'static str) -> Option<()> {
        self.problem = (!known).then_some(problem);
        known.then_some(())
    }
}

/// True when the tree of the chunks of array `name` is damaged, for which [`chunk_tree::walk`] has the reasons. In a file of another form
/// than is known here, when two nodes of any tree of chunks lead to the same.
pub(super) fn has_damaged_tree(path: &Path, name: &str) -> bool {
    walks_into_damage(path, name).unwrap_or_else(|| {
        let base = FileBytes::open(path).and_then(|mut source| begin(&mut source)).unwrap_or(0);
        std::fs::read(path).is_ok_and(|bytes| chunk_tree::meet_again(bytes.get(base as usize..).unwrap_or_default()))
    })
}

/// `None` when there is no tree in the forms that are known here.
fn walks_into_damage(path: &Path, name: &str) -> Option<bool> {
    let volume = Volume::open(path).ok()?;
    let mut source = FileBytes::open(path)?.based_at(volume.base);
    let mut found = Header::default();
    messages(&mut source, *volume.members.get(name)?, &mut |kind, body| {
        // What elements and filters are does not matter here.
        found.take(kind, body);
        Some(())
    })?;
    let (Some(Stored::Chunked { tree, sides }), Some(shape)) = (found.layout, found.shape) else { return None };
    let chunk = sides.get(..shape.len())?;
    if chunk.contains(&0) {
        return Some(true);
    }
    let grid = grid(&shape, chunk);
    Some(tree != NOWHERE && chunk_tree::walk(&mut source, tree, chunk, &grid, &mut |_, _, _| Some(())).is_none())
}

/// The places of all chunks.
fn chunks(source: &mut FileBytes, tree: u64, shape: &[usize], chunk: &[usize]) -> Option<Vec<ChunkSpan>> {
    let grid = grid(shape, chunk);
    let count = grid.iter().try_fold(1_usize, |n, &axis| n.checked_mul(axis))?;
    let mut places = vec![ChunkSpan::default(); Some(count).filter(|&count| count as u64 <= max_chunks(source.length))?];
    if tree != NOWHERE {
        chunk_tree::enter(source, tree, chunk, &grid, &mut places)?;
    }
    Some(places)
}
