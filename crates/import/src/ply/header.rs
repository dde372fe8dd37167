//! The header of a PLY file: which elements follow, and of which properties.

/// Place and what is wrong there.
pub(super) type Problem = (String, String);

#[derive(Clone, Copy, PartialEq)]
pub(super) enum Encoding {
    Text,
    Little,
    Big,
}

pub(super) struct Header {
    pub encoding: Encoding,
    /// Line ending: `\n`, also after `\r`, or `\r` alone, as Rhinoceros writes it.
    pub line_end: u8,
    pub elements: Vec<Element>,
    /// Number of its lines.
    pub lines: usize,
    /// Pictures that comments name (`comment TextureFile wood.png`), as MeshLab and others write them.
    pub pictures: Vec<String>,
}

pub(super) struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
}

pub(super) struct Property {
    pub name: String,
    pub kind: Kind,
    /// Type of the count in front, for lists.
    pub list: Option<Kind>,
}

#[derive(Clone, Copy)]
pub(super) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Kind {
    pub(super) fn parse(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    /// The value that represents 1 in a colour of this type.
    pub(super) fn full(self) -> f64 {
        match self {
            Self::I8 => 127.0,
            Self::U8 => 255.0,
            Self::I16 => 32_767.0,
            Self::U16 => 65_535.0,
            Self::I32 => f64::from(i32::MAX),
            Self::U32 => f64::from(u32::MAX),
            Self::F32 | Self::F64 => 1.0,
        }
    }

    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

pub(super) fn parse_header(bytes: &[u8]) -> Result<(Header, &[u8]), Problem> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    // The first line decides: in a binary file a byte `\n` behind the header belongs to the body.
    let line_end = if bytes.get(3) == Some(&b'\r') && bytes.get(4) != Some(&b'\n') { b'\r' } else { b'\n' };
    let mut header = Header { encoding: Encoding::Text, line_end, elements: Vec::new(), lines: 0, pictures: Vec::new() };
    let (mut at, mut number) = (0, 0);
    loop {
        number += 1;
        let place = || format!("line {number}");
        let rest = bytes.get(at..).unwrap_or_default();
        let Some(end) = rest.iter().position(|&b| b == line_end) else {
            return Err((place(), "the header does not end; the file is cut short or no PLY".into()));
        };
        let line = String::from_utf8_lossy(&rest[..end]);
        at += end + 1;
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["ply"] if number == 1 => (),
            _ if number == 1 => return Err((place(), "the file does not begin with \"ply\"; check that it is what its name says".into())),
            ["format", "ascii", _] => header.encoding = Encoding::Text,
            ["format", "binary_little_endian", _] => header.encoding = Encoding::Little,
            ["format", "binary_big_endian", _] => header.encoding = Encoding::Big,
            ["element", name, count] => {
                let whole = count.split_once('.').filter(|(_, rest)| rest.bytes().all(|b| b == b'0')).map_or(count, |(whole, _)| whole);
                let count = whole.parse().map_err(|_| {
                    (place(), format!("{count:?} is not a number of elements; expected a whole number, so export the file again"))
                })?;
                header.elements.push(Element { name: name.into(), count, properties: Vec::new() });
            }
            ["property", ref kinds @ .., name] => {
                let parsed = match kinds {
                    ["list", count, kind] => Kind::parse(count).zip(Kind::parse(kind)).map(|(c, k)| (Some(c), k)),
                    [kind] => Kind::parse(kind).map(|k| (None, k)),
                    _ => None,
                };
                let (Some((list, kind)), Some(element)) = (parsed, header.elements.last_mut()) else {
                    return Err((
                        place(),
                        format!(
                            "{:?} is not a property; expected property <type> <name> or property list <type> <type> <name> after an element, with \
                         types such as float and uchar; export the file again",
                            line.trim()
                        ),
                    ));
                };
                element.properties.push(Property { name: name.into(), kind, list });
            }
            ["end_header"] => {
                header.lines = number;
                return Ok((header, &bytes[at..]));
            }
            ["comment", "TextureFile", _, ..] => {
                header.pictures.extend(line.split_once("TextureFile").map(|(_, name)| name.trim().to_string()));
            }
            ["comment" | "obj_info", ..] | [] => (),
            _ => {
                let expected = "expected format, element, property, comment, obj_info or end_header; export the file again";
                return Err((place(), format!("{:?} is not understood; {expected}", line.trim())));
            }
        }
    }
}
