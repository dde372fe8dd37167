//! FBX files made on the spot: one tree of records, written as text or as binary of either width.

/// A value of a record.
#[derive(Clone, Debug)]
pub enum Value {
    Int(i64),
    Real(f64),
    Text(&'static str),
    Ints(Vec<i32>),
    Longs(Vec<i64>),
    Reals(Vec<f64>),
    Bytes(Vec<u8>),
}

/// A record with its values and the records within it.
#[derive(Clone, Debug)]
pub struct Record {
    name: &'static str,
    values: Vec<Value>,
    children: Vec<Record>,
}

/// A record.
pub fn record(name: &'static str, values: Vec<Value>, children: Vec<Record>) -> Record {
    Record { name, values, children }
}

/// A property of `Properties70`.
pub fn property(name: &'static str, kind: &'static str, values: Vec<Value>) -> Record {
    let head = [name, kind, "", ""].map(Value::Text);
    record("P", head.into_iter().chain(values).collect(), vec![])
}

/// A property of numbers.
pub fn reals(name: &'static str, kind: &'static str, values: &[f64]) -> Record {
    property(name, kind, values.iter().map(|v| Value::Real(*v)).collect())
}

/// A property of one whole number.
pub fn int(name: &'static str, kind: &'static str, value: i64) -> Record {
    property(name, kind, vec![Value::Int(value)])
}

/// Properties.
pub fn properties(list: Vec<Record>) -> Record {
    record("Properties70", vec![], list)
}

/// An object: its kind, number, name with its class, and type.
pub fn object(kind: &'static str, id: i64, name: &'static str, class: &'static str, children: Vec<Record>) -> Record {
    record(kind, vec![Value::Int(id), Value::Text(name), Value::Text(class)], children)
}

/// `child` belongs to `parent`; 0 is the scene.
pub fn belongs(child: i64, parent: i64) -> Record {
    record("C", vec![Value::Text("OO"), Value::Int(child), Value::Int(parent)], vec![])
}

/// `child` is the value of a property of `parent`.
pub fn feeds(child: i64, parent: i64, property: &'static str) -> Record {
    record("C", vec![Value::Text("OP"), Value::Int(child), Value::Int(parent), Value::Text(property)], vec![])
}

/// A document of this version, with y up, the unit in centimetres, and these objects.
pub fn document(version: i64, settings: Vec<Record>, objects: Vec<Record>, connections: Vec<Record>) -> Vec<Record> {
    let axes = [("UpAxis", 1), ("UpAxisSign", 1), ("FrontAxis", 2), ("FrontAxisSign", 1), ("CoordAxis", 0), ("CoordAxisSign", 1)];
    // Later properties of one name count.
    let mut all: Vec<Record> = axes.into_iter().map(|(name, value)| int(name, "int", value)).collect();
    for setting in settings {
        all.retain(|p| format!("{:?}", p.values[0]) != format!("{:?}", setting.values[0]));
        all.push(setting);
    }
    vec![
        record("FBXHeaderExtension", vec![], vec![record("FBXVersion", vec![Value::Int(version)], vec![])]),
        record("GlobalSettings", vec![], vec![properties(all)]),
        record("Objects", vec![], objects),
        record("Connections", vec![], connections),
    ]
}

/// The document as Blender would have written it.
pub fn of_blender(mut document: Vec<Record>) -> Vec<Record> {
    document[0].children.push(record("Creator", vec![Value::Text("Blender (stable FBX IO) - 4.5.0 - 5.13.0")], vec![]));
    document
}

/// The document as text.
pub fn text(document: &[Record], version: u32) -> Vec<u8> {
    let mut out = format!("; FBX {}.{}.0 project file\n", version / 1000, version / 100 % 10);
    document.iter().for_each(|r| write_text(r, &mut out));
    out.into_bytes()
}

fn write_text(record: &Record, out: &mut String) {
    let array = |values: Vec<String>| format!("*{} {{\n a: {}\n}}", values.len(), values.join(","));
    let value = |v: &Value| match v {
        Value::Int(v) => v.to_string(),
        Value::Real(v) => format!("{v:?}"),
        // As text, the class comes first.
        Value::Text(t) => match t.split_once("\0\x01") {
            Some((name, class)) => format!("\"{class}::{name}\""),
            None => format!("\"{t}\""),
        },
        Value::Ints(v) => array(v.iter().map(i32::to_string).collect()),
        Value::Longs(v) => array(v.iter().map(i64::to_string).collect()),
        Value::Reals(v) => array(v.iter().map(|v| format!("{v:?}")).collect()),
        Value::Bytes(b) => format!(",\n\"{}\"", super::base64(b)),
    };
    let values: Vec<String> = record.values.iter().map(value).collect();
    *out += &format!("{}: {}", record.name, values.join(", "));
    if !record.children.is_empty() {
        *out += " {\n";
        record.children.iter().for_each(|c| write_text(c, out));
        *out += "}";
    }
    *out += "\n";
}

/// The document in binary; from version 7500 on lengths have eight bytes.
pub fn binary(document: &[Record], version: u32) -> Vec<u8> {
    let mut out = b"Kaydara FBX Binary  \0\x1a\0".to_vec();
    out.extend(version.to_le_bytes());
    document.iter().for_each(|r| write_binary(r, version >= 7500, &mut out));
    out.resize(out.len() + if version >= 7500 { 25 } else { 13 }, 0);
    out
}

fn write_binary(record: &Record, wide: bool, out: &mut Vec<u8>) {
    let mut values = Vec::new();
    record.values.iter().for_each(|v| write_value(v, &mut values));
    let start = out.len();
    let width = if wide { 8 } else { 4 };
    out.resize(start + 3 * width, 0);
    out.push(record.name.len() as u8);
    out.extend(record.name.bytes());
    out.extend(&values);
    if !record.children.is_empty() {
        record.children.iter().for_each(|c| write_binary(c, wide, out));
        out.resize(out.len() + 3 * width + 1, 0);
    }
    let end = out.len();
    for (i, number) in [end, record.values.len(), values.len()].into_iter().enumerate() {
        out[start + i * width..start + (i + 1) * width].copy_from_slice(&(number as u64).to_le_bytes()[..width]);
    }
}

fn write_value(value: &Value, out: &mut Vec<u8>) {
    let mut array = |kind: u8, count: usize, bytes: Vec<u8>| {
        out.push(kind);
        [count, 0, bytes.len()].iter().for_each(|n| out.extend((*n as u32).to_le_bytes()));
        out.extend(bytes);
    };
    match value {
        Value::Ints(v) => array(b'i', v.len(), v.iter().flat_map(|v| v.to_le_bytes()).collect()),
        Value::Longs(v) => array(b'l', v.len(), v.iter().flat_map(|v| v.to_le_bytes()).collect()),
        Value::Reals(v) => array(b'd', v.len(), v.iter().flat_map(|v| v.to_le_bytes()).collect()),
        Value::Int(v) => {
            out.push(b'L');
            out.extend(v.to_le_bytes());
        }
        Value::Real(v) => {
            out.push(b'D');
            out.extend(v.to_le_bytes());
        }
        Value::Text(t) => {
            out.push(b'S');
            out.extend((t.len() as u32).to_le_bytes());
            out.extend(t.bytes());
        }
        Value::Bytes(b) => {
            out.push(b'R');
            out.extend((b.len() as u32).to_le_bytes());
            out.extend(b);
        }
    }
}

const TICKS_PER_S: f64 = 46_186_158_000.0;

/// A curve of linear keys, seconds and values, that drives a component of a property of an object; the others stay as at rest.
pub fn curve(
    id: i64,
    (target, of): (i64, &'static str),
    component: &'static str,
    rest: [f64; 3],
    keys: &[(f64, f64)],
) -> (Vec<Record>, Vec<Record>) {
    const LINEAR: i32 = 4;
    let list = |name, values| record(name, vec![values], vec![]);
    let children = vec![
        record("Default", vec![Value::Real(0.0)], vec![]),
        record("KeyVer", vec![Value::Int(4008)], vec![]),
        list("KeyTime", Value::Longs(keys.iter().map(|(time_s, _)| (time_s * TICKS_PER_S) as i64).collect())),
        list("KeyValueFloat", Value::Reals(keys.iter().map(|(_, value)| *value).collect())),
        list("KeyAttrFlags", Value::Ints(vec![LINEAR])),
        list("KeyAttrDataFloat", Value::Reals(vec![0.0; 4])),
        list("KeyAttrRefCount", Value::Ints(vec![keys.len() as i32])),
    ];
    let names: &[&'static str] = if component.len() == 3 { &["d|X", "d|Y", "d|Z"] } else { &[component] };
    let at_rest = names.iter().zip(rest).map(|(name, value)| reals(name, "Number", &[value])).collect();
    let of_property = object("AnimationCurveNode", id, "T\0\x01AnimCurveNode", "", vec![properties(at_rest)]);
    let objects = vec![of_property, object("AnimationCurve", id + 1, "\0\x01AnimCurve", "", children)];
    (objects, vec![belongs(id, LAYER), feeds(id, target, of), feeds(id + 1, id, component)])
}

/// Number of the layer of the animation that curves belong to.
const LAYER: i64 = 41;

/// The animation that curves belong to, between two moments, seconds.
pub fn animation(ends_s: [f64; 2]) -> (Vec<Record>, Vec<Record>) {
    const STACK: i64 = 40;
    let span = |(name, time_s)| property(name, "KTime", vec![Value::Int((time_s * TICKS_PER_S) as i64)]);
    let ends = ["LocalStart", "LocalStop"].into_iter().zip(ends_s).map(span).collect();
    let stack = object("AnimationStack", STACK, "Take\0\x01AnimStack", "", vec![properties(ends)]);
    (vec![stack, object("AnimationLayer", LAYER, "Base\0\x01AnimLayer", "", vec![])], vec![belongs(LAYER, STACK)])
}
