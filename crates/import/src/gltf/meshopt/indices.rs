//! The packing of indices: those of lists of triangles by recent edges and vertices, and others as differences.
//!
//! Modes 1 and 2 of appendix A of `KHR_meshopt_compression`.

use super::bytes::{Bytes, CUT_SHORT, signed};

/// Bytes at the end of packed triangles: a table of pairs of vertices that are met often.
const TABLE: usize = 16;

/// Bytes at the end of other indices, which mean nothing.
const PADDING: usize = 4;

/// Unpacks the given number of indices of triangles, a multiple of 3.
///
/// # Errors
/// When the data are damaged, as the rest of a sentence.
pub(super) fn triangles(packed: &[u8], count: usize) -> Result<Vec<u32>, String> {
    let body = body(packed, 0xe1, "triangles", TABLE)?;
    let (codes, data) = body.split_at_checked(count / 3).ok_or(CUT_SHORT)?;
    let table = &packed[packed.len() - TABLE..];
    let mut decoder = Triangles { data: Bytes(data), next: 0, last: 0, edges: Recent::default(), vertices: Recent::default() };
    let mut indices = Vec::with_capacity(count);
    for &code in codes {
        indices.extend(decoder.triangle(code, table)?);
    }
    decoder.data.end()?;
    Ok(indices)
}

/// Unpacks the given number of other indices.
///
/// # Errors
/// When the data are damaged, as the rest of a sentence.
pub(super) fn sequence(packed: &[u8], count: usize) -> Result<Vec<u32>, String> {
    let mut data = Bytes(body(packed, 0xd1, "indices", PADDING)?);
    if count > data.0.len() {
        return Err(CUT_SHORT.into());
    }
    // Two runs of indices, of which the lowest bit chooses one.
    let mut last = [0u32; 2];
    let mut indices = Vec::with_capacity(count);
    for _ in 0..count {
        let number = data.number()?;
        let last = &mut last[number as usize & 1];
        *last = last.wrapping_add(signed(number >> 1));
        indices.push(*last);
    }
    data.end()?;
    Ok(indices)
}

/// The bytes between the first one, which gives the kind, and the given number of bytes at the end.
fn body<'b>(packed: &'b [u8], magic: u8, what: &str, tail: usize) -> Result<&'b [u8], String> {
    match packed.first() {
        Some(&found) if found == magic => {}
        found => return Err(format!("begins with {found:02x?}, expected {magic:02x} for {what}; export the file again")),
    }
    let end = packed.len().checked_sub(tail);
    Ok(end.and_then(|end| packed.get(1..end)).ok_or(CUT_SHORT)?)
}

/// The last `N` things met.
struct Recent<T, const N: usize> {
    things: [T; N],
    next: usize,
}

impl<T: Copy + Default, const N: usize> Default for Recent<T, N> {
    fn default() -> Self {
        Self { things: [T::default(); N], next: 0 }
    }
}

impl<T: Copy, const N: usize> Recent<T, N> {
    fn push(&mut self, thing: T) {
        self.things[self.next] = thing;
        self.next = (self.next + 1) % N;
    }

    /// The thing that was met `ago` things ago; 0 is the last.
    fn get(&self, ago: u8) -> T {
        self.things[(self.next + 2 * N - 1 - usize::from(ago)) % N]
    }
}

/// The decoder's state after the triangles so far.
struct Triangles<'b> {
    data: Bytes<'b>,
    /// The vertex after the highest that was met in order.
    next: u32,
    /// The last vertex that was met out of order.
    last: u32,
    edges: Recent<[u32; 2], 16>,
    vertices: Recent<u32, 16>,
}

impl Triangles<'_> {
    fn triangle(&mut self, code: u8, table: &[u8]) -> Result<[u32; 3], String> {
        let (edge, vertex) = (code >> 4, code & 15);
        if edge == 15 {
            return self.without_edge(vertex, table);
        }
        let [a, b] = self.edges.get(edge);
        let c = match vertex {
            0 => self.fresh(),
            1..=12 => self.vertices.get(vertex),
            13 => self.jump(u32::MAX),
            14 => self.jump(1),
            _ => self.far()?,
        };
        if !(1..=12).contains(&vertex) {
            self.vertices.push(c);
        }
        self.edges.push([c, b]);
        self.edges.push([a, c]);
        Ok([a, b, c])
    }

    /// A triangle none of whose edges was met; `code` is an index into the table, or means that it is written out.
    fn without_edge(&mut self, code: u8, table: &[u8]) -> Result<[u32; 3], String> {
        let written = code >= 14;
        let pair = if written { self.data.byte()? } else { table[usize::from(code)] };
        if written && pair == 0 {
            self.next = 0;
        }
        let a = if code == 15 { self.far()? } else { self.fresh() };
        let mut corner = |code: u8| {
            Ok::<_, String>(match code {
                0 => (self.fresh(), true),
                15 if written => (self.far()?, true),
                _ => (self.vertices.get(code - 1), false),
            })
        };
        let ((b, b_is_new), (c, c_is_new)) = (corner(pair >> 4)?, corner(pair & 15)?);
        self.vertices.push(a);
        for (vertex, _) in [(b, b_is_new), (c, c_is_new)].into_iter().filter(|(_, is_new)| *is_new) {
            self.vertices.push(vertex);
        }
        for edge in [[b, a], [c, b], [a, c]] {
            self.edges.push(edge);
        }
        Ok([a, b, c])
    }

    /// The next vertex in order.
    fn fresh(&mut self) -> u32 {
        let vertex = self.next;
        self.next = vertex.wrapping_add(1);
        vertex
    }

    /// A vertex out of order, whose distance from the last such is written.
    fn far(&mut self) -> Result<u32, String> {
        let distance = signed(self.data.number()?);
        Ok(self.jump(distance))
    }

    fn jump(&mut self, distance: u32) -> u32 {
        self.last = self.last.wrapping_add(distance);
        self.last
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By meshoptimizer 1.3's encoder, which turns triangles so that they begin with a known edge: here the third.
    #[test]
    fn triangles_and_sequences_are_unpacked_to_the_end() {
        let packed = *b"\xe1\xf0\x10\x10\xfe\x7f\xff\x1f\xf0\x0e\x04\xff\xb6\x01\x02\x02\x67\x00\x76\x87\x56\x67\x78\xa9\x86\x65\x89\x68\x98\x01\x69\0\0";
        let expected = [0, 1, 2, 2, 1, 3, 3, 1, 4, 5, 7, 6, 0, 2, 9, 100, 101, 102, 102, 101, 50];
        assert_eq!(triangles(&packed, 21).unwrap(), expected);
        let other = *b"\xd1\x00\x04\xcd\x01\x04\x07\x98\x1f\xfd\x89\x11\x92\x1f\0\0\0\0";
        assert_eq!(sequence(&other, 8).unwrap(), [0, 1, 51, 2, 49, 1000, 70_000, 3]);
        assert!((0..packed.len()).all(|end| triangles(&packed[..end], 21).is_err()));
        assert!((0..other.len()).all(|end| sequence(&other[..end], 8).is_err()));
        assert!(triangles(&other, 21).unwrap_err().contains("begins with Some(d1), expected e1 for triangles"));
    }
}
