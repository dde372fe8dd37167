//! Files come back as they were; edits change what they name and nothing else; damage is reported with its place.

use enfilade_vrscene::{Document, Include, Item, Plugin, Transform, Value};
use std::path::Path;

const SCENE: &str = "\u{feff}// a scene
#include \"D:\\lib\\mats.vrscene\"\r
/* two ; lines } of
   remarks */
Node chair@node_1 {
  transform=TransformHex(\"0000803F0000000000000000000000000000803F00000000000000000000000000000040000000000000F03F000000000000004000000000000008C0\");
  geometry=mesh_1;   // what it is
  visible=interpolate((0, 1), (10.5, 0));
  color=AColor(1, 0.5, 0, 1);texture=tex_3::out_alpha;
  note=\"a \\\"quoted\\\" ; } brace\";
}
Unknown_Thing  x|y:z  { odd = Strange(1, List(\"a\", Foo(2.5e-3)), -inf) ; }
";

fn document(text: &str) -> Document {
    Document::parse(text.as_bytes()).unwrap()
}

fn value(text: &str) -> Value {
    Value::parse(text.as_bytes()).unwrap()
}

#[test]
fn what_is_not_edited_comes_back_byte_for_byte() {
    let read = document(SCENE);
    assert_eq!(read.to_bytes(), SCENE.as_bytes());
    assert_eq!(read.items.len(), 3);
    assert_eq!(read.includes().next().unwrap().path(), b"D:\\lib\\mats.vrscene");
    assert_eq!(document("").to_bytes(), b"");
}

#[test]
fn values_are_what_they_say() {
    let read = document(SCENE);
    let chair = read.of_kind("Node").next().unwrap();
    assert_eq!(chair.name(), b"chair@node_1");
    let matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0]];
    assert_eq!(chair.get("transform").unwrap(), Some(Value::Transform(Transform { matrix, offset: [1.0, 2.0, -3.0] })));
    assert_eq!(chair.get("visible").unwrap(), Some(Value::Animated(vec![(0.0, Value::Int(1)), (10.5, Value::Int(0))])));
    assert_eq!(chair.get("color").unwrap(), Some(Value::AColor([1.0, 0.5, 0.0, 1.0])));
    assert_eq!(chair.get("texture").unwrap().unwrap().plugin(), Some(b"tex_3".as_slice()));
    assert_eq!(chair.get("note").unwrap(), Some(Value::Text(b"a \\\"quoted\\\" ; } brace".to_vec())));
    assert_eq!(chair.get("nothing").unwrap(), None);
    let odd = read.of_kind("Unknown_Thing").next().unwrap().get("odd").unwrap().unwrap();
    assert_eq!(odd.to_bytes(), b"Strange(1, List(\"a\", Foo(0.0025)), -inf)");
}

#[test]
fn every_value_reads_as_it_was_written() {
    let values = [
        Value::Int(-7),
        Value::Float(0.1),
        Value::Float(1e-30),
        Value::Name(b"a::b".to_vec()),
        Value::Color([0.25, 1e-9, 3.0]),
        Value::Matrix([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.5]]),
        Value::Transform(Transform { matrix: [[0.1; 3]; 3], offset: [1.0 / 3.0, -2e300, 0.0] }),
        Value::Ints((0..1000).collect()),
        Value::Ints(vec![]),
        Value::Floats((0..100).map(|i| i as f32 / 7.0).collect()),
        Value::Floats(vec![f32::MIN_POSITIVE]),
        Value::Vectors(vec![[1.0, -0.0, f32::MAX]; 3]),
        Value::Vectors(vec![[1.0, -0.0, 2.5]; 30]),
        Value::Colors(vec![[0.5; 3]; 17]),
        Value::List(b"ListString".to_vec(), vec![Value::Text(b"C:\\a b".to_vec())]),
        Value::Animated(vec![(0.0, Value::Vector([0.0; 3])), (1.0, Value::Vector([1.0; 3]))]),
    ];
    for expected in values {
        let written = expected.to_bytes();
        assert_eq!(Value::parse(&written).unwrap(), expected, "{}", String::from_utf8_lossy(&written));
    }
    assert_eq!(value("ListIntHex(\"01000000FFFFFFFF\")"), Value::Ints(vec![1, -1]));
}

#[test]
fn edits_change_what_they_name_and_nothing_else() {
    let mut edited = document(SCENE);
    let chair = edited.of_kind_mut("Node").next().unwrap();
    chair.set("visible", &Value::Int(0));
    chair.set("objectID", &Value::Int(5));
    assert_eq!(chair.remove("note"), 1);
    let Some(Item::Include(include)) = edited.items.first_mut() else { panic!("no include") };
    include.set_path("/mnt/lib/mats.vrscene");
    let expected = SCENE
        .replace("interpolate((0, 1), (10.5, 0))", "0")
        .replace("\n  note=\"a \\\"quoted\\\" ; } brace\";", "\n  objectID=5;")
        .replace("D:\\lib\\mats.vrscene", "/mnt/lib/mats.vrscene");
    assert_eq!(String::from_utf8(edited.to_bytes()).unwrap(), expected);
}

#[test]
fn moments_are_kept_where_they_stand() {
    let text = "#time 0\nNode a { x=1; }\n#time 1.5 FilterArea f {}Node a { x=2; }\n#time 2";
    let mut read = document(text);
    assert_eq!((read.items.len(), read.plugins().count(), read.to_bytes()), (6, 3, text.as_bytes().to_vec()));
    let Item::Time(time) = &read.items[2] else { panic!("{:?}", read.items[2]) };
    assert_eq!((time.place().line, time.place().column), (3, 1));
    // The number ends where it did when the text after it is removed.
    read.items.retain(|item| !matches!(item, Item::Plugin(plugin) if plugin.kind() == b"FilterArea"));
    read.push(Plugin::new("Node", "b"));
    assert_eq!(document(std::str::from_utf8(&read.to_bytes()).unwrap()).plugins().count(), 3);
}

#[test]
fn colours_may_be_multiplied() {
    assert_eq!(value("Color(1, 0.5, 0)*0.5"), Value::Color([0.5, 0.25, 0.0]));
    assert_eq!(value("List(Color(1, 1, 1) * 2, 3)"), Value::List(b"List".to_vec(), vec![Value::Color([2.0; 3]), Value::Int(3)]));
    assert_eq!(Value::parse(b"Color(1, 1, 1)*red").unwrap_err().to_string(), "1:16: expected a number after `*`, found `red`");
}

#[test]
fn what_is_made_can_be_read() {
    let mut made = Document::default();
    made.items.push(Item::Include(Include::new("a.vrscene")));
    let mut light = Plugin::new("LightDome", "dome");
    light.set("intensity", &Value::Float(30.0));
    made.push(light);
    assert_eq!(made.to_bytes(), b"\n#include \"a.vrscene\"\n\nLightDome dome {\n  intensity=30;\n}\n");
    assert_eq!(Document::parse(made.to_bytes()).unwrap().to_bytes(), made.to_bytes());
}

#[test]
fn damage_is_told_with_line_and_column() {
    let told = |text: &str| Document::parse(text.as_bytes()).unwrap_err().to_string();
    assert_eq!(told("Node a {\n  x=1\n}"), "3:1: expected `;` at the end of the value, found `}`");
    assert_eq!(told("Node a {\n  x=(1;\n}"), "2:5: expected `)` for this bracket, found `(1;`");
    assert_eq!(told("Node a {\n  x=\"b;\n}"), "2:5: expected `\"` at the end of this string, found `\"b;`");
    assert_eq!(told("Node {"), "1:6: expected the name of the plugin, found `{`");
    assert_eq!(told("Node a {"), "1:9: expected the name of a parameter, or `}`, found the end of the text");
    assert_eq!(told("#define x"), "1:1: expected `#include`, `#time`, or a plugin, found `#define x`");
    assert_eq!(told("#time soon"), "1:7: expected a number after `#time`, found `soon`");
    assert_eq!(told("/* x"), "1:1: expected `*/` at the end of this comment, found `/* x`");
    let wrong = |text: &str| document(text).plugins().next().unwrap().parameters()[0].value().unwrap_err().to_string();
    assert_eq!(wrong("A b {\n  c=Vector(1, 2);\n}"), "2:16: expected 3 values in these brackets and not 2, found `)`");
    assert_eq!(
        wrong("A b {\n  c=ListIntHex(\"ZIPC\");\n}"),
        "2:17: expected two sizes of 8 hexadecimal digits after ZIPC, found `ZIPC\")`"
    );
    assert_eq!(wrong("A b {\n  c=ListInt(1,\n 2.5);\n}"), "3:2: expected a whole number, found `2.5)`");
    let deep = format!("A b {{ c={}1{}; }}", "List(".repeat(100), ")".repeat(100));
    assert!(wrong(&deep).contains("no deeper"));
}

#[test]
fn no_cut_and_no_flipped_byte_makes_it_panic() {
    for at in 0..SCENE.len() {
        let mut bytes = SCENE.as_bytes().to_vec();
        bytes.truncate(at);
        read_everything(&bytes);
        for other in [0, b'"', b'(', b'}', b';', 0xff] {
            let mut bytes = SCENE.as_bytes().to_vec();
            bytes[at] = other;
            read_everything(&bytes);
        }
    }
}

fn read_everything(bytes: &[u8]) {
    if let Ok(document) = Document::parse(bytes) {
        assert_eq!(document.to_bytes(), bytes);
        for parameter in document.plugins().flat_map(Plugin::parameters) {
            drop(parameter.value());
        }
    }
}

#[test]
fn hypersims_empty_scene_comes_back_and_its_meshes_open() {
    let Some(scenes) = std::env::var_os("ENFILADE_SCENES") else {
        return eprintln!("skipped: ENFILADE_SCENES is not set");
    };
    let bytes = std::fs::read(Path::new(&scenes).join("vrscene/hypersim_empty.vrscene")).unwrap();
    let scene = Document::parse(bytes.as_slice()).unwrap();
    assert_eq!(scene.to_bytes(), bytes);
    assert_eq!((scene.of_kind("Node").count(), scene.of_kind("GeomStaticMesh").count()), (7, 3));
    for mesh in scene.of_kind("GeomStaticMesh") {
        let (Some(Value::Vectors(vertices)), Some(Value::Ints(faces))) = (mesh.get("vertices").unwrap(), mesh.get("faces").unwrap()) else {
            panic!("{:?} is no mesh", String::from_utf8_lossy(mesh.name()));
        };
        assert_eq!(faces.iter().max().map(|&v| v as usize), Some(vertices.len() - 1));
    }
    for parameter in scene.plugins().flat_map(Plugin::parameters) {
        let value = parameter.value().unwrap();
        assert_eq!(Value::parse(&value.to_bytes()).unwrap(), value, "{}", String::from_utf8_lossy(parameter.raw()));
    }
}
