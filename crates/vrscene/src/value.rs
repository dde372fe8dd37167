//! Values of parameters: numbers, strings, references, vectors, lists and keyframes, read from text and written back.

use crate::error::SceneTextError;
use crate::packed;
use crate::scan::Scanner;
use crate::transform::{Matrix, Transform, Vector};

/// The value of a parameter.
///
/// ```
/// use enfilade_vrscene::Value;
///
/// let color = Value::parse(b"Color(1, 0.5, 0) * 2").unwrap();
/// assert_eq!(color, Value::Color([2.0, 1.0, 0.0]));
/// assert_eq!(color.to_bytes(), b"Color(2, 1, 0)");
///
/// // Lists come back the same, though long ones are packed when they are written.
/// let faces = Value::Ints((0..300).collect());
/// assert!(faces.to_bytes().starts_with(b"ListIntHex(\"ZIPC"));
/// assert_eq!(Value::parse(&faces.to_bytes()).unwrap(), faces);
///
/// let animated = Value::parse(b"interpolate((0, 1), (10, 0))").unwrap();
/// assert_eq!(animated, Value::Animated(vec![(0.0, Value::Int(1)), (10.0, Value::Int(0))]));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A whole number; truth values are 0 and 1.
    Int(i64),
    /// A number with a point or an exponent.
    Float(f64),
    /// The text between quotes, as written: paths keep their backslashes.
    Text(Vec<u8>),
    /// The name of a plugin, or `name::output` for one of its outputs.
    Name(Vec<u8>),
    /// `Vector(x, y, z)`.
    Vector(Vector),
    /// `Color(r, g, b)`; multiplied where `* number` follows.
    Color(Vector),
    /// `AColor(r, g, b, a)`.
    AColor([f32; 4]),
    /// `Matrix(Vector, Vector, Vector)`.
    Matrix(Matrix),
    /// `Transform(Matrix, Vector)` or `TransformHex("…")`.
    Transform(Transform),
    /// `ListInt(…)` or `ListIntHex("…")`.
    Ints(Vec<i32>),
    /// `ListFloat(…)` or `ListFloatHex("…")`.
    Floats(Vec<f32>),
    /// `ListVector(…)` or `ListVectorHex("…")`.
    Vectors(Vec<Vector>),
    /// `ListColor(…)` or `ListColorHex("…")`.
    Colors(Vec<Vector>),
    /// `List(…)`, `ListString(…)` and every other kind of list: its name and what is in it.
    List(Vec<u8>, Vec<Value>),
    /// `interpolate((frame, value), …)`: keyframes in the order of the file.
    Animated(Vec<(f64, Value)>),
}

/// No scene nests lists deeper than this.
const MAX_DEPTH: usize = 32;

/// Lists longer than this are packed when they are written.
const MAX_PLAIN: usize = 16;

impl Value {
    /// Reads a text that is a single value.
    ///
    /// # Errors
    /// If it is not a value, with line and column from 1.
    pub fn parse(text: &[u8]) -> Result<Self, SceneTextError> {
        let mut scanner = Scanner::new(text);
        let value = read(&mut scanner, 0)?;
        scanner.skip_blank()?;
        if scanner.at < text.len() { Err(scanner.error("the end of the value")) } else { Ok(value) }
    }

    /// The name of the plugin that it refers to, without the output.
    pub fn plugin(&self) -> Option<&[u8]> {
        let Self::Name(name) = self else { return None };
        Some(name.windows(2).position(|pair| pair == b"::").map_or(name, |end| &name[..end]))
    }

    /// A number, whole or not.
    pub fn number(&self) -> Option<f64> {
        match *self {
            Self::Int(v) => Some(v as f64),
            Self::Float(v) => Some(v),
            _ => None,
        }
    }

    /// The value as exporters write it. Lists of more than 16 numbers are packed.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut out = Vec::new();
        self.write(&mut out);
        out
    }

    fn write(&self, out: &mut Vec<u8>) {
        match self {
            Self::Int(v) => out.extend(v.to_string().bytes()),
            Self::Float(v) => out.extend(number(*v).bytes()),
            Self::Text(text) => out.extend([b"\"", text.as_slice(), b"\""].concat()),
            Self::Name(name) => out.extend(name),
            Self::Vector(v) => floats("Vector", v, out),
            Self::Color(v) => floats("Color", v, out),
            Self::AColor(v) => floats("AColor", v, out),
            Self::Matrix(m) => matrix(m, out),
            Self::Transform(t) => {
                out.extend(b"Transform(");
                matrix(&t.matrix, out);
                let [x, y, z] = t.offset.map(number);
                out.extend(format!(", Vector({x}, {y}, {z}))").bytes());
            }
            Self::Ints(v) if v.len() > MAX_PLAIN => packed::write("ListIntHex", v.iter().flat_map(|v| v.to_le_bytes()), out),
            Self::Floats(v) if v.len() > MAX_PLAIN => packed::write("ListFloatHex", v.iter().flat_map(|v| v.to_le_bytes()), out),
            Self::Vectors(v) if v.len() > MAX_PLAIN => {
                packed::write("ListVectorHex", v.iter().flatten().flat_map(|v| v.to_le_bytes()), out);
            }
            Self::Colors(v) if v.len() > MAX_PLAIN => {
                packed::write("ListColorHex", v.iter().flatten().flat_map(|v| v.to_le_bytes()), out);
            }
            Self::Ints(v) => list(b"ListInt", v, |v, out| out.extend(v.to_string().bytes()), out),
            Self::Floats(v) => list(b"ListFloat", v, |v, out| out.extend(single(*v).bytes()), out),
            Self::Vectors(v) => list(b"ListVector", v, |v, out| floats("Vector", v, out), out),
            Self::Colors(v) => list(b"ListColor", v, |v, out| floats("Color", v, out), out),
            Self::List(name, values) => list(name, values, Self::write, out),
            Self::Animated(keys) => list(
                b"interpolate",
                keys,
                |(frame, value), out| {
                    out.extend(format!("({}, ", number(*frame)).bytes());
                    value.write(out);
                    out.push(b')');
                },
                out,
            ),
        }
    }
}

/// The shortest text that reads as the same number, whole numbers without a point.
fn number(v: f64) -> String {
    format!("{v}")
}

fn single(v: f32) -> String {
    format!("{v}")
}

fn floats(name: &str, values: &[f32], out: &mut Vec<u8>) {
    list(name.as_bytes(), values, |v, out| out.extend(single(*v).bytes()), out);
}

fn matrix(m: &Matrix, out: &mut Vec<u8>) {
    list(b"Matrix", m, |v, out| floats("Vector", v, out), out);
}

fn list<T>(name: &[u8], values: &[T], write: impl Fn(&T, &mut Vec<u8>), out: &mut Vec<u8>) {
    out.extend(name);
    out.push(b'(');
    for (i, value) in values.iter().enumerate() {
        if i > 0 {
            out.extend(b", ");
        }
        write(value, out);
    }
    out.push(b')');
}

fn read(scanner: &mut Scanner, depth: usize) -> Result<Value, SceneTextError> {
    if depth > MAX_DEPTH {
        return Err(scanner.error(format!("lists no deeper than {MAX_DEPTH}")));
    }
    scanner.skip_blank()?;
    if scanner.peek() == Some(b'"') {
        return Ok(Value::Text(scanner.string()?.to_vec()));
    }
    let start = scanner.at;
    let word = scanner.word("a value")?;
    if !scanner.take(b'(')? {
        return Ok(plain(word));
    }
    match word {
        b"Vector" => Ok(Value::Vector(numbers(scanner)?)),
        b"Color" => Ok(Value::Color(multiplied(scanner)?)),
        b"AColor" => Ok(Value::AColor(numbers(scanner)?)),
        b"Matrix" => Ok(Value::Matrix(vectors(scanner, depth)?)),
        b"Transform" => transform(scanner, depth),
        b"TransformHex" => packed::transform(scanner).map(Value::Transform),
        b"ListInt" => Ok(Value::Ints(items(scanner, |s| number_of(s, "a whole number"))?)),
        b"ListFloat" => Ok(Value::Floats(items(scanner, |s| number_of(s, "a number"))?)),
        b"ListVector" => Ok(Value::Vectors(items(scanner, |s| triple(s, depth + 1))?)),
        b"ListColor" => Ok(Value::Colors(items(scanner, |s| triple(s, depth + 1))?)),
        b"ListIntHex" => packed::list(scanner, i32::from_le_bytes).map(Value::Ints),
        b"ListFloatHex" => packed::list(scanner, f32::from_le_bytes).map(Value::Floats),
        b"ListVectorHex" => packed::list(scanner, packed::triple).map(Value::Vectors),
        b"ListColorHex" => packed::list(scanner, packed::triple).map(Value::Colors),
        b"interpolate" => Ok(Value::Animated(items(scanner, |s| keyframe(s, depth + 1))?)),
        name if name.first().is_some_and(u8::is_ascii_alphabetic) => {
            let values = items(scanner, |s| read(s, depth + 1))?;
            Ok(Value::List(name.to_vec(), values))
        }
        _ => Err(scanner.error_at(start, "the name of a type before `(`")),
    }
}

/// A word that is neither a call nor a string: a number, or the name of a plugin.
fn plain(word: &[u8]) -> Value {
    let text = std::str::from_utf8(word).unwrap_or("");
    let begins_like_a_number = word.first().is_some_and(|b| b.is_ascii_digit() || matches!(b, b'-' | b'+' | b'.'));
    if begins_like_a_number {
        if let Ok(v) = text.parse() {
            return Value::Int(v);
        }
        if let Ok(v) = text.parse() {
            return Value::Float(v);
        }
    }
    Value::Name(word.to_vec())
}

/// The items up to the closing bracket, each read by `read`; the opening one was read before.
fn items<T>(scanner: &mut Scanner, read: impl Fn(&mut Scanner) -> Result<T, SceneTextError>) -> Result<Vec<T>, SceneTextError> {
    let mut values = Vec::new();
    if scanner.take(b')')? {
        return Ok(values);
    }
    loop {
        values.push(read(scanner)?);
        if !scanner.take(b',')? {
            scanner.expect(b')', "`,` or `)`")?;
            return Ok(values);
        }
    }
}

fn number_of<T: std::str::FromStr>(scanner: &mut Scanner, expected: &str) -> Result<T, SceneTextError> {
    scanner.skip_blank()?;
    let start = scanner.at;
    let word = scanner.word(expected)?;
    std::str::from_utf8(word).ok().and_then(|text| text.parse().ok()).ok_or_else(|| scanner.error_at(start, expected))
}

fn exactly<T, const N: usize>(scanner: &Scanner, values: Vec<T>) -> Result<[T; N], SceneTextError> {
    let found = values.len();
    let before = scanner.at.saturating_sub(1);
    <[T; N]>::try_from(values).map_err(|_| scanner.error_at(before, format!("{N} values in these brackets and not {found}")))
}

fn numbers<const N: usize>(scanner: &mut Scanner) -> Result<[f32; N], SceneTextError> {
    let values = items(scanner, |s| number_of(s, "a number"))?;
    exactly(scanner, values)
}

/// Three numbers, times one that may follow.
fn multiplied(scanner: &mut Scanner) -> Result<Vector, SceneTextError> {
    let color: Vector = numbers(scanner)?;
    if !scanner.take(b'*')? {
        return Ok(color);
    }
    let factor: f32 = number_of(scanner, "a number after `*`")?;
    Ok(color.map(|v| v * factor))
}

fn vectors(scanner: &mut Scanner, depth: usize) -> Result<Matrix, SceneTextError> {
    let values = items(scanner, |s| triple(s, depth + 1))?;
    exactly(scanner, values)
}

fn triple(scanner: &mut Scanner, depth: usize) -> Result<Vector, SceneTextError> {
    scanner.skip_blank()?;
    let start = scanner.at;
    match read(scanner, depth)? {
        Value::Vector(v) | Value::Color(v) => Ok(v),
        _ => Err(scanner.error_at(start, "`Vector(x, y, z)`")),
    }
}

fn transform(scanner: &mut Scanner, depth: usize) -> Result<Value, SceneTextError> {
    scanner.skip_blank()?;
    let start = scanner.at;
    let Value::Matrix(matrix) = read(scanner, depth + 1)? else {
        return Err(scanner.error_at(start, "`Matrix(…)`"));
    };
    scanner.expect(b',', "`,` after the matrix")?;
    scanner.skip_blank()?;
    let start = scanner.at;
    if scanner.word("`Vector(x, y, z)`")? != b"Vector" {
        return Err(scanner.error_at(start, "`Vector(x, y, z)`"));
    }
    scanner.expect(b'(', "`(` after Vector")?;
    let values = items(scanner, |s| number_of(s, "a number"))?;
    let offset = exactly(scanner, values)?;
    scanner.expect(b')', "`)` at the end of the transform")?;
    Ok(Value::Transform(Transform { matrix, offset }))
}

fn keyframe(scanner: &mut Scanner, depth: usize) -> Result<(f64, Value), SceneTextError> {
    scanner.expect(b'(', "`(frame, value)`")?;
    let frame = number_of(scanner, "the number of a frame")?;
    scanner.expect(b',', "`,` after the frame")?;
    let value = read(scanner, depth + 1)?;
    scanner.expect(b')', "`)` after the value")?;
    Ok((frame, value))
}
