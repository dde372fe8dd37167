//! The file format of Open Image Denoise's weights: `.tza`, version 2.
//!
//! Little-endian: the magic number, major and minor version, position of the table; the table names each tensor with its sizes, what
//! they mean (`x`, or `oihw` for output channel, input channel, row, column), its type (`f` or `h`: 32 or 16 bits) and its place.

use enfilade_frame::f16;

/// First two bytes of a file.
const MAGIC: u16 = 0x41d7;

/// A tensor of weights.
#[derive(Debug)]
pub(super) struct Weights {
    pub name: String,
    /// Output channels, input channels, rows and columns, or output channels alone.
    pub sizes: Vec<usize>,
    pub values: Vec<f32>,
}

/// The tensors of a file in its order.
///
/// # Errors
/// When the file is damaged or of another version, in words that include the place.
pub(super) fn read(file: &[u8]) -> Result<Vec<Weights>, String> {
    let mut head = Reader { file, at: 0 };
    let magic = u16::from_le_bytes(head.take()?);
    if magic != MAGIC {
        return Err(format!("byte 0: expected 0x{MAGIC:04x}, found 0x{magic:04x}"));
    }
    let [major, minor] = head.take()?;
    if major != 2 {
        return Err(format!("byte 2: expected version 2, found {major}.{minor}"));
    }
    let mut table = Reader { file, at: usize::try_from(u64::from_le_bytes(head.take()?)).unwrap_or(usize::MAX) };
    let count = u32::from_le_bytes(table.take()?);
    (0..count).map(|_| tensor(&mut table)).collect()
}

/// The next tensor of the table.
fn tensor(table: &mut Reader<'_>) -> Result<Weights, String> {
    let length = u16::from_le_bytes(table.take()?);
    let name = String::from_utf8_lossy(table.bytes(length.into())?).into_owned();
    let [dimensions] = table.take()?;
    let sizes: Vec<usize> = (0..dimensions).map(|_| Ok(u32::from_le_bytes(table.take()?) as usize)).collect::<Result<_, String>>()?;
    let at = table.at;
    let meaning = table.bytes(dimensions.into())?;
    if !matches!(meaning, b"x" | b"oihw") {
        return Err(format!("byte {at}: `{name}` is laid out as `{}`; expected `x` or `oihw`", String::from_utf8_lossy(meaning)));
    }
    let at = table.at;
    let [kind] = table.take()?;
    let place = usize::try_from(u64::from_le_bytes(table.take()?)).unwrap_or(usize::MAX);
    let count = sizes.iter().try_fold(1usize, |product, &size| product.checked_mul(size)).filter(|&count| count <= table.file.len());
    let count = count.ok_or_else(|| format!("byte {at}: `{name}` is larger than the file: {sizes:?}"))?;
    let mut data = Reader { file: table.file, at: place };
    let values: Vec<f32> = match kind {
        b'h' => data.bytes(2 * count)?.as_chunks().0.iter().map(|&bytes| f16::from_le_bytes(bytes).to_f32()).collect(),
        b'f' => data.bytes(4 * count)?.as_chunks().0.iter().map(|&bytes| f32::from_le_bytes(bytes)).collect(),
        _ => return Err(format!("byte {at}: `{name}` has the type `{}`; expected `h` or `f`", char::from(kind))),
    };
    if values.iter().any(|value| !value.is_finite()) {
        return Err(format!("byte {place}: `{name}` holds a number that is not finite"));
    }
    Ok(Weights { name, sizes, values })
}

/// A place in a file.
struct Reader<'a> {
    file: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    fn bytes(&mut self, count: usize) -> Result<&'a [u8], String> {
        let end = self.at.checked_add(count).filter(|&end| end <= self.file.len());
        let end = end.ok_or_else(|| format!("byte {}: {count} bytes wanted, the file ends after {}", self.at, self.file.len()))?;
        let bytes = &self.file[self.at..end];
        self.at = end;
        Ok(bytes)
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], String> {
        self.bytes(N).map(|bytes| bytes.try_into().expect("as many as asked for"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file of two tensors, whose data begin at bytes 12 and 20.
    fn file() -> Vec<u8> {
        let mut file = [&MAGIC.to_le_bytes()[..], &[2, 0], &24u64.to_le_bytes()].concat();
        [1.0, -0.5, 65504.0, 0.25].into_iter().for_each(|value| file.extend(f16::from_f32(value).to_le_bytes()));
        file.extend(3.5f32.to_le_bytes());
        file.extend(2u32.to_le_bytes());
        let mut tensor = |name: &str, sizes: &[u32], meaning: &str, kind: u8, place: u64| {
            file.extend((name.len() as u16).to_le_bytes());
            file.extend(name.bytes());
            file.push(sizes.len() as u8);
            sizes.iter().for_each(|size| file.extend(size.to_le_bytes()));
            file.extend(meaning.bytes());
            file.push(kind);
            file.extend(place.to_le_bytes());
        };
        tensor("a.weight", &[2, 2, 1, 1], "oihw", b'h', 12);
        tensor("a.bias", &[1], "x", b'f', 20);
        file
    }

    #[test]
    fn halves_and_floats_are_read_with_their_names_and_sizes() {
        let tensors = read(&file()).unwrap();
        assert_eq!((tensors[0].name.as_str(), &tensors[0].sizes[..]), ("a.weight", &[2, 2, 1, 1][..]));
        assert_eq!(tensors[0].values, [1.0, -0.5, 65504.0, 0.25]);
        assert_eq!((tensors[1].name.as_str(), &tensors[1].sizes[..], &tensors[1].values[..]), ("a.bias", &[1][..], &[3.5][..]));
    }

    #[test]
    fn a_file_that_is_cut_off_anywhere_is_refused() {
        let file = file();
        for length in 0..file.len() {
            let error = read(&file[..length]).unwrap_err();
            assert!(error.contains("the file ends after") || error.contains("larger than the file"), "{length}: {error}");
        }
    }

    #[test]
    fn damage_is_told_with_its_place() {
        let with = |at: usize, byte: u8| {
            let mut damaged = file();
            damaged[at] = byte;
            read(&damaged).unwrap_err()
        };
        assert_eq!(with(0, 0), "byte 0: expected 0x41d7, found 0x4100");
        assert_eq!(with(2, 3), "byte 2: expected version 2, found 3.0");
        assert_eq!(with(11, 255), "byte 18374686479671623704: 4 bytes wanted, the file ends after 91");
        assert_eq!(with(42, 255), "byte 59: `a.weight` is larger than the file: [4278190082, 2, 1, 1]");
        assert_eq!(with(55, b'h'), "byte 55: `a.weight` is laid out as `hihw`; expected `x` or `oihw`");
        assert_eq!(with(59, b'd'), "byte 59: `a.weight` has the type `d`; expected `h` or `f`");
        assert_eq!(with(13, 0x7c), "byte 12: `a.weight` holds a number that is not finite");
    }
}
