//! Mitsuba's own mesh format: zlib-compressed meshes one after the other, and a table of their offsets at the end.
//!
//! Every mesh begins with the numbers 0x041C and the version (3 or 4); the compressed rest is flags, the name (version 4),
//! the counts of vertices and triangles as 64-bit numbers, positions, then normals, texture coordinates and colours by the flags,
//! and 32-bit indices. All is little-endian.

use crate::ImportError;
use crate::assembly::{origin_of, positions_from};
use enfilade_geometry::Mesh;
use enfilade_math::{DVec2, DVec3};
use flate2::bufread::ZlibDecoder;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

const MAGIC: u16 = 0x041c;
const HAS_NORMALS: u32 = 0x0001;
const HAS_UVS: u32 = 0x0002;
const HAS_COLORS: u32 = 0x0008;
const DOUBLE: u32 = 0x2000;

/// More vertices or triangles than this are taken for damage: compressed, a few bytes can announce and store any number of zeros.
const MAX_ELEMENTS: u64 = 1 << 26;
/// Longest name of a mesh, bytes.
const MAX_NAME: u64 = 1 << 16;

/// Reads mesh `index` of the file, and the point from which its positions count (see `origin_of`). Texture coordinates stay as they are.
pub(super) fn read(bytes: &[u8], index: i64, file: &Path, meters_per_unit: f64) -> Result<(Mesh, DVec3), ImportError> {
    let error = |problem: String| ImportError::malformed(file, format!("mesh {index}"), problem);
    let (start, version) = locate(bytes, index).map_err(error)?;
    let body = bytes.get(start + 4..).unwrap_or_default();
    let mut stream = Stream { inner: BufReader::new(ZlibDecoder::new(body)) };
    let damaged = |e| error(format!("{e}; the file is damaged or cut short, so copy or export it again"));
    stream.mesh(version, meters_per_unit).map_err(damaged)
}

/// Byte offset and version of a mesh.
fn locate(bytes: &[u8], index: i64) -> Result<(usize, u16), String> {
    let u32_at = |at: usize| bytes.get(at..)?.first_chunk().map(|b| u32::from_le_bytes(*b));
    let version_at = |at: usize| {
        let word = u32_at(at)?;
        (word as u16 == MAGIC).then_some((word >> 16) as u16).filter(|v| (3..=4).contains(v))
    };
    let version = version_at(0).ok_or("the file does not begin like a serialized mesh of version 3 or 4")?;
    let count = bytes.len().checked_sub(4).and_then(u32_at).unwrap_or(0) as usize;
    let index = usize::try_from(index).ok().filter(|&i| i < count).ok_or(format!("there are only {count} meshes in the file"))?;
    let entry = if version == 4 { 8 } else { 4 };
    let table = count.checked_mul(entry).and_then(|size| bytes.len().checked_sub(4 + size));
    let at = table.ok_or("the table of meshes is cut short")? + index * entry;
    let low = u32_at(at).unwrap_or(u32::MAX) as usize;
    let start = if version == 4 { low | (u32_at(at + 4).unwrap_or(0) as usize) << 32 } else { low };
    let version = version_at(start).ok_or("the table of meshes points at something else")?;
    Ok((start, version))
}

struct Stream<R> {
    inner: R,
}

impl<R: BufRead> Stream<R> {
    fn mesh(&mut self, version: u16, meters_per_unit: f64) -> std::io::Result<(Mesh, DVec3)> {
        let flags = self.u32()?;
        if version == 4 {
            self.name()?;
        }
        let (vertices, triangles) = (self.u64()?, self.u64()?);
        if vertices.max(triangles) > MAX_ELEMENTS {
            let problem = format!("{vertices} vertices and {triangles} triangles were announced, expected at most {MAX_ELEMENTS}");
            return Err(std::io::Error::new(std::io::ErrorKind::InvalidData, problem));
        }
        let double = flags & DOUBLE != 0;
        let positions = self.floats(vertices, 3, double)?;
        let positions: Vec<DVec3> = positions.chunks_exact(3).map(DVec3::from_slice).collect();
        let normals = if flags & HAS_NORMALS != 0 { self.floats(vertices, 3, double)? } else { Vec::new() };
        let uvs = if flags & HAS_UVS != 0 { self.floats(vertices, 2, double)? } else { Vec::new() };
        if flags & HAS_COLORS != 0 {
            self.floats(vertices, 3, double)?;
        }
        let indices = self.exactly(triangles, 12)?;
        let word = |b: &[u8]| u32::from_le_bytes([b[0], b[1], b[2], b[3]]);
        let origin = origin_of(positions.iter().copied(), meters_per_unit);
        let mesh = Mesh {
            positions: positions_from(origin, &positions),
            normals: normals.chunks_exact(3).map(|n| DVec3::from_slice(n).as_vec3()).collect(),
            uvs: uvs.chunks_exact(2).map(|uv| DVec2::from_slice(uv).as_vec2()).collect(),
            triangles: indices.chunks_exact(12).map(|t| [word(t), word(&t[4..]), word(&t[8..])]).collect(),
        };
        Ok((mesh, origin))
    }

    /// Passes the name and the zero after it.
    fn name(&mut self) -> std::io::Result<()> {
        let passed = self.inner.by_ref().take(MAX_NAME).skip_until(0)?;
        if passed as u64 == MAX_NAME {
            return Err(std::io::Error::new(std::io::ErrorKind::InvalidData, format!("the name is longer than {MAX_NAME} bytes")));
        }
        Ok(())
    }

    fn floats(&mut self, count: u64, components: u64, double: bool) -> std::io::Result<Vec<f64>> {
        let size = if double { 8 } else { 4 };
        let bytes = self.exactly(count, components * size)?;
        Ok(if double {
            bytes.chunks_exact(8).map(|b| f64::from_le_bytes([b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7]])).collect()
        } else {
            bytes.chunks_exact(4).map(|b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]))).collect()
        })
    }

    /// `count` × `size` bytes. Memory grows with what is really there, whatever the count claims.
    fn exactly(&mut self, count: u64, size: u64) -> std::io::Result<Vec<u8>> {
        let short =
            || std::io::Error::new(std::io::ErrorKind::UnexpectedEof, format!("{count} elements were announced, but not all are there"));
        let wanted = count.checked_mul(size).ok_or_else(short)?;
        let mut bytes = Vec::new();
        self.inner.by_ref().take(wanted).read_to_end(&mut bytes)?;
        if bytes.len() as u64 == wanted { Ok(bytes) } else { Err(short()) }
    }

    fn bytes(&mut self, count: u64) -> std::io::Result<Vec<u8>> {
        self.exactly(count, 1)
    }

    fn u32(&mut self) -> std::io::Result<u32> {
        let b = self.bytes(4)?;
        Ok(u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
    }

    fn u64(&mut self) -> std::io::Result<u64> {
        Ok(u64::from(self.u32()?) | u64::from(self.u32()?) << 32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::{Vec2, Vec3};
    use flate2::{Compression, write::ZlibEncoder};
    use std::io::Write;

    /// Two meshes of one triangle, the second one shifted and in double precision.
    fn file(version: u16, far: f64) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut offsets = Vec::new();
        for shift in [0.0f64, far] {
            let double = shift > 0.0;
            offsets.push(bytes.len() as u64);
            bytes.extend(MAGIC.to_le_bytes());
            bytes.extend(version.to_le_bytes());
            let mut z = ZlibEncoder::new(Vec::new(), Compression::fast());
            z.write_all(&(if double { DOUBLE } else { 0x1000 } | HAS_UVS).to_le_bytes()).unwrap();
            if version == 4 {
                z.write_all(b"name\0").unwrap();
            }
            z.write_all(&3u64.to_le_bytes()).unwrap();
            z.write_all(&1u64.to_le_bytes()).unwrap();
            for v in [shift, 0.0, 0.0, shift + 1.0, 0.0, 0.0, shift, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0] {
                if double { z.write_all(&v.to_le_bytes()).unwrap() } else { z.write_all(&(v as f32).to_le_bytes()).unwrap() }
            }
            (0..3u32).for_each(|i| z.write_all(&i.to_le_bytes()).unwrap());
            bytes.extend(z.finish().unwrap());
        }
        for offset in &offsets {
            if version == 4 { bytes.extend(offset.to_le_bytes()) } else { bytes.extend((*offset as u32).to_le_bytes()) }
        }
        bytes.extend(2u32.to_le_bytes());
        bytes
    }

    #[test]
    fn every_mesh_of_either_version_is_found() {
        for version in [3, 4] {
            let (mesh, origin) = read(&file(version, 5.0), 1, Path::new("a.serialized"), 1.0).unwrap();
            assert_eq!(origin, DVec3::ZERO);
            assert_eq!((mesh.positions[1], mesh.uvs[2], mesh.triangles[0]), (Vec3::new(6.0, 0.0, 0.0), Vec2::Y, [0, 1, 2]));
            assert_eq!(read(&file(version, 5.0), 0, Path::new("a.serialized"), 1.0).unwrap().0.positions[1], Vec3::X);
        }
    }

    #[test]
    fn double_precision_far_from_the_origin_is_kept() {
        let (mesh, origin) = read(&file(4, 445_123.125), 1, Path::new("a.serialized"), 1.0).unwrap();
        assert_eq!(origin.x + f64::from(mesh.positions[1].x), 445_124.125);
        assert!(origin.x > 445_000.0);
    }

    #[test]
    fn damage_is_named() {
        let message = |bytes: &[u8], i| read(bytes, i, Path::new("a.serialized"), 1.0).unwrap_err().to_string();
        assert!(message(&file(4, 5.0), 2).contains("only 2 meshes"));
        assert!(message(&file(4, 5.0), -1).contains("only 2 meshes"));
        assert!(message(b"", 0).contains("does not begin like"));
        let mut broken = file(4, 5.0);
        broken[30..60].fill(0xff);
        assert!(message(&broken, 0).contains("damaged"));
        let mut z = ZlibEncoder::new(Vec::new(), Compression::fast());
        z.write_all(&[0, 0, 0, 0]).unwrap();
        z.write_all(&[u64::MAX >> 8, 1].map(u64::to_le_bytes).concat()).unwrap();
        let table = [0u32, 1].map(u32::to_le_bytes).concat();
        let many = [&MAGIC.to_le_bytes()[..], &[3, 0], &z.finish().unwrap(), &table].concat();
        assert!(message(&many, 0).contains("expected at most 67108864"));
    }
}
