//! Suspected units and axes: from rooms and things of standard sizes, written in other units and axes.

use enfilade_pipeline::{FileSource, HomeConfig, UpAxis, check_file, make_home};
use enfilade_scene::{Quiet, to_bytes};
use std::fmt::Write;
use std::path::Path;

/// Low and high corner of a box and what it is called: a room of 5 m x 4 m x 2.6 m with a door of 2.05 m, a chair of 0.9 m, a bookshelf
/// of 2 m; z up, metres.
const ROOM: [(&str, [f64; 3], [f64; 3]); 9] = [
    ("floor", [0.0, 0.0, -0.1], [5.0, 4.0, 0.0]),
    ("ceiling", [0.0, 0.0, 2.6], [5.0, 4.0, 2.7]),
    ("wall_w", [-0.1, 0.0, 0.0], [0.0, 4.0, 2.6]),
    ("wall_e", [5.0, 0.0, 0.0], [5.1, 4.0, 2.6]),
    ("wall_s", [0.0, -0.1, 0.0], [5.0, 0.0, 2.6]),
    ("wall_n", [0.0, 4.0, 0.0], [5.0, 4.1, 2.6]),
    ("door", [0.01, 1.0, 0.0], [0.05, 1.9, 2.05]),
    ("chair", [2.0, 2.0, 0.0], [2.5, 2.5, 0.9]),
    ("bookshelf", [4.0, 1.0, 0.0], [4.9, 1.4, 2.0]),
];

/// An OBJ file of boxes whose corners `place` moves.
fn boxes(list: &[(&str, [f64; 3], [f64; 3])], place: impl Fn([f64; 3]) -> [f64; 3]) -> String {
    let mut text = String::new();
    for (k, (name, low, high)) in list.iter().enumerate() {
        let _ = writeln!(text, "o {name}");
        for i in 0..8 {
            let [x, y, z] = place([0, 1, 2].map(|axis| if i >> axis & 1 == 1 { high[axis] } else { low[axis] }));
            let _ = writeln!(text, "v {x} {y} {z}");
        }
        for face in [[1, 3, 4, 2], [5, 6, 8, 7], [1, 2, 6, 5], [3, 7, 8, 4], [1, 5, 7, 3], [2, 4, 8, 6]] {
            let _ = writeln!(text, "f {}", face.map(|i| (8 * k + i).to_string()).join(" "));
        }
    }
    text
}

/// y up, as in OBJ files.
fn y_up([x, y, z]: [f64; 3]) -> [f64; 3] {
    [x, z, -y]
}

/// The suspicions about a file with this text.
fn suspected(name: &str, text: &str, source: impl Fn(FileSource) -> FileSource) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join(name);
    std::fs::write(&file, text).unwrap();
    of(&source(FileSource::of(file.to_string_lossy())))
}

fn of(source: &FileSource) -> Vec<String> {
    let checked = check_file(source, &Quiet).unwrap();
    let messages = checked.warnings.into_iter().map(|warning| warning.message);
    messages.filter(|message| message.contains("seems to") || message.contains("its unit")).collect()
}

fn plain(name: &str, text: &str) -> Vec<String> {
    suspected(name, text, |source| source)
}

#[test]
fn units_are_suspected_by_rooms_and_furniture_and_the_number_to_try_is_named() {
    assert_eq!(plain("room.obj", &boxes(&ROOM, y_up)), [""; 0]);
    for (unit, key) in [(0.01, "0.01"), (0.001, "0.001"), (0.0254, "0.0254"), (0.3048, "0.3048"), (0.1, "0.1"), (2.0, "2"), (100.0, "100")]
    {
        let text = boxes(&ROOM, |p| y_up(p).map(|v| v / unit));
        let told = plain("room.obj", &text);
        assert_eq!(told.len(), 1, "{unit}: {told:?}");
        assert!(told[0].contains(&format!("with meters_per_unit = {key} (or --meters-per-unit {key})")), "{told:?}");
        assert!(told[0].contains("rooms are 2.60 m high") && told[0].contains("the chair is 0.90 m high"), "{told:?}");
        // If a unit is stated, the proposed one replaces it, and then there is no suspicion.
        let doubled = suspected("room.obj", &text, |source| FileSource { meters_per_unit: 2.0 * unit, ..source });
        assert!(doubled[0].contains(&format!("meters_per_unit = {key} ")), "{doubled:?}");
        assert_eq!(suspected("room.obj", &text, |source| FileSource { meters_per_unit: unit, ..source }), [""; 0]);
    }
}

#[test]
fn halls_single_things_and_dolls_houses_in_their_own_size_are_what_they_are() {
    let hall: Vec<_> = ROOM.iter().take(6).map(|(name, low, high)| (*name, low.map(|v| 4.0 * v), high.map(|v| 4.0 * v))).collect();
    assert_eq!(plain("hall.obj", &boxes(&hall, y_up)), [""; 0]);
    let with_people = [hall, vec![("chair", [2.0, 2.0, 0.0], [2.5, 2.5, 0.9]), ("person", [3.0, 2.0, 0.0], [3.5, 2.3, 1.75])]].concat();
    assert_eq!(plain("hall.obj", &boxes(&with_people, y_up)), [""; 0]);
    for (name, high) in [("chair", [0.5, 0.5, 0.9]), ("sofa", [2.0, 0.9, 0.8]), ("cup", [0.08, 0.08, 0.1]), ("person", [0.5, 0.3, 1.8])] {
        assert_eq!(plain("model.obj", &boxes(&[(name, [0.0; 3], high)], y_up)), [""; 0], "{name}");
        // Many exporters write no names, and then the file's name is used.
        let unnamed = boxes(&[("Mesh.001", [0.0; 3], high)], y_up);
        assert_eq!(plain(&format!("{name}.obj"), &unnamed), [""; 0], "{name}");
    }
    for name in ["chair.obj", "armchair_03.obj"] {
        let told = plain(name, &boxes(&[("Mesh.001", [0.0; 3], [6.0, 6.0, 12.8])], y_up));
        assert!(told[0].contains("the chair is 12.80 m high") && told[0].contains("meters_per_unit = 0.1 "), "{told:?}");
    }
    let house = boxes(&ROOM, |p| y_up(p).map(|v| v / 12.0));
    assert!(plain("house.obj", &house)[0].contains("rooms are 0.22 m high"));
}

/// The image of a point.
type Turn = fn([f64; 3]) -> [f64; 3];

#[test]
fn rooms_on_their_sides_and_heads_are_suspected_and_the_axis_is_named() {
    let turned: [(&str, Turn); 5] = [
        ("z", |p| p),
        ("-z", |[x, y, z]| [x, -y, -z]),
        ("-y", |[x, y, z]| [x, -z, y]),
        ("x", |[x, y, z]| [z, y, -x]),
        ("-x", |[x, y, z]| [-z, y, x]),
    ];
    for (axis, place) in turned {
        let text = boxes(&ROOM, place);
        let told = plain("room.obj", &text);
        assert!(told.len() == 1 && told[0].contains(&format!("up_axis = \"{axis}\" (or --up-axis {axis})")), "{axis}: {told:?}");
        let named = UpAxis::ALL.into_iter().find(|up| up.name() == axis);
        assert_eq!(suspected("room.obj", &text, |source| FileSource { up_axis: named, ..source }), [""; 0], "{axis}");
    }
}

#[test]
fn cameras_tell_which_way_is_up_and_views_from_above_do_not() {
    let box_of =
        |z: f64| format!("<shape type=\"cube\"><transform name=\"to_world\"><scale x=\"2\" y=\"2\" z=\"{z}\"/></transform></shape>");
    let scene = |look: &str| {
        let sensor = format!("<sensor type=\"perspective\"><transform name=\"to_world\"><lookat {look}/></transform></sensor>");
        format!("<scene version=\"3.0.0\">{sensor}{}</scene>", box_of(1.3))
    };
    let told = plain("room.xml", &scene("origin=\"0.5,0.5,1\" target=\"3,2.5,0.8\" up=\"0,0,1\""));
    assert!(told.len() == 1 && told[0].contains("upper sides of its cameras") && told[0].contains("up_axis = \"z\""), "{told:?}");
    // Straight along an axis, where the room taken as y-up is looked at from below.
    assert_eq!(plain("room.xml", &scene("origin=\"0,-1,0\" target=\"0,1,0\" up=\"0,0,1\"")).len(), 1);
    assert_eq!(plain("room.xml", &scene("origin=\"0,0,1\" target=\"1,0,0\" up=\"0,1,0\"")), [""; 0]);
    assert_eq!(plain("room.xml", &scene("origin=\"0,9,0\" target=\"0,0,0\" up=\"0,0,1\"")), [""; 0], "a bird's-eye view");
}

#[test]
fn a_scan_without_names_is_suspected_by_its_largest_surfaces() {
    let flat = [("", [0.0; 3], [9.0, 6.0, 2.6]), ("", [1.0, 1.0, 0.0], [3.0, 2.0, 0.8])];
    let text = boxes(&flat, |p| p).replace("o \n", "");
    assert!(plain("scan.obj", &text)[0].contains("up_axis = \"z\""));
    assert_eq!(plain("scan.obj", &boxes(&flat, y_up).replace("o \n", "")), [""; 0]);
    // A corridor of 1.5 m and the cage of a lift have more wall than floor.
    for high in [[12.0, 1.5, 2.5], [2.0, 2.0, 7.0]] {
        assert_eq!(plain("scan.obj", &boxes(&[("", [0.0; 3], high)], y_up).replace("o \n", "")), [""; 0], "{high:?}");
    }
}

#[test]
fn glass_bodies_and_closed_boxes_are_no_rooms() {
    let floor = ("floor", [0.0, 0.0, -0.1], [5.0, 4.0, 0.0]);
    let walls = &ROOM[2..6];
    // 3.6 % to 48 % of a floor of 20 m2, of whatever is as high as half a room.
    for size in [[1.2, 0.6, 1.3], [2.0, 1.0, 1.3], [2.5, 2.0, 1.3], [4.0, 2.4, 0.9]] {
        let block = |name| (name, [0.4, 0.8, 0.01], [0.4 + size[0], 0.8 + size[1], 0.01 + size[2]]);
        for name in ["aquarium", "block", "Cube.001", "crate"] {
            assert_eq!(plain("a.obj", &boxes(&[floor, block(name)], y_up)), [""; 0], "{name} {size:?}");
            assert_eq!(plain("a.obj", &boxes(&[walls, &[floor, block(name)]].concat(), y_up)), [""; 0], "{name} {size:?} in walls");
        }
        // All of the floor is below the glass.
        let slab = ("floor", [0.3, 0.7, -0.1], [0.5 + size[0], 0.9 + size[1], 0.0]);
        let text = boxes(&[slab, block("Cube.001")], y_up).replace("o Cube.001", "o Cube.001\nusemtl clear");
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("a.mtl"), "newmtl clear\nKd 0 0 0\nd 1\nNi 1.5\nillum 7\nKs 1 1 1\n").unwrap();
        let file = folder.path().join("a.obj");
        std::fs::write(&file, format!("mtllib a.mtl\n{text}")).unwrap();
        assert_eq!(of(&FileSource::of(file.to_string_lossy())), [""; 0], "glass of {size:?}");
    }
    // A room of half the height is still suspected, glass in it or not.
    let aquarium = ("aquarium", [1.0, 1.0, 0.01], [2.2, 1.6, 1.3]);
    let half = boxes(&[&ROOM[..], &[aquarium]].concat(), |p| y_up(p).map(|v| v / 2.0));
    assert!(plain("room.obj", &half)[0].contains("meters_per_unit = 2 "));
}

#[test]
fn backs_are_not_told_where_the_unit_explains_what_is_seen() {
    let messages = |text: &str| {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("room.obj");
        std::fs::write(&file, text).unwrap();
        let checked = check_file(&FileSource::of(file.to_string_lossy()), &Quiet).unwrap();
        checked.warnings.into_iter().map(|warning| warning.message).filter(|message| message.contains("backs of faces")).collect::<Vec<_>>()
    };
    // Closed boxes, whose fronts look outward, as every room and thing here: people are inside of none but the room.
    for unit in [0.001, 0.01, 0.0254, 0.1, 0.3048, 1.0] {
        for nameless in [false, true] {
            let text = boxes(&ROOM, |p| y_up(p).map(|v| v / unit));
            let text = if nameless { text.lines().filter(|line| !line.starts_with("o ")).collect::<Vec<_>>().join("\n") } else { text };
            assert_eq!(messages(&text), [""; 0], "{unit} {nameless}");
        }
    }
    // A shell whose fronts look outward.
    assert_eq!(messages(&boxes(&[("shell", [0.0; 3], [5.0, 4.0, 2.6])], y_up)).len(), 1);
}

#[test]
fn rooms_without_names_are_suspected_by_what_things_rest_on() {
    let nameless = |list: &[(&str, [f64; 3], [f64; 3])], place: Turn| {
        boxes(list, place).lines().filter(|line| !line.starts_with("o ")).fold(String::new(), |text, line| text + line + "\n")
    };
    let table = ("", [1.0, 0.8, 0.0], [1.8, 2.0, 0.75]);
    let lamp = ("", [1.2, 1.2, 0.75], [1.5, 1.5, 1.15]);
    let room = [&ROOM[..], &[table, lamp]].concat();
    let turned: [(&str, Turn); 4] =
        [("z", |p| p), ("-z", |[x, y, z]| [x, -y, -z]), ("x", |[x, y, z]| [z, y, -x]), ("-x", |[x, y, z]| [-z, y, x])];
    for (axis, place) in turned {
        let told = plain("room.obj", &nameless(&room, place));
        assert!(told.len() == 1 && told[0].contains(&format!("up_axis = \"{axis}\" (or --up-axis {axis})")), "{axis}: {told:?}");
    }
    assert_eq!(plain("room.obj", &nameless(&room, y_up)), [""; 0]);
    // Pictures on a wall, and things that rest on nothing, tell nothing.
    let pictures = [1.0, 2.0, 3.0].map(|x| ("", [x, 3.96, 1.2], [x + 0.6, 4.0, 1.8]));
    assert_eq!(plain("room.obj", &nameless(&[&ROOM[..6], &pictures].concat(), y_up)), [""; 0]);
    let floating = [1.0, 2.0, 3.0].map(|x| ("", [x, 1.0, 0.5], [x + 0.6, 1.6, 1.3]));
    assert_eq!(plain("room.obj", &nameless(&[&ROOM[..6], &floating].concat(), y_up)), [""; 0]);
    // Nothing is in it, so nothing shows which way is up.
    assert_eq!(plain("room.obj", &nameless(&ROOM[..6], |p| p)), [""; 0]);
    // glTF has y up by its rules; what writes z up there does not say so.
    let told = of_gltf(&nameless(&room, |p| p));
    assert!(told.len() == 1 && told[0].contains("up_axis = \"z\" (or --up-axis z)"), "{told:?}");
    assert_eq!(of_gltf(&nameless(&room, y_up)), [""; 0]);
    assert_eq!(of_gltf(&nameless(&ROOM[..6], |p| p)), [""; 0]);
    assert_eq!(of_gltf(&nameless(&[&ROOM[..6], &pictures].concat(), y_up)), [""; 0]);
}

#[test]
fn files_that_leave_out_which_way_is_up_are_suspected_as_those_of_formats_that_cannot_say() {
    let table = ("", [1.0, 0.8, 0.0], [1.8, 2.0, 0.75]);
    let lamp = ("", [1.2, 1.2, 0.75], [1.5, 1.5, 1.15]);
    let room = [&ROOM[..], &[table, lamp]].concat();
    let text = |place: Turn| boxes(&room, place);
    for (name, shapes, unstated, stated) in
        [("room.usda", usda as fn(&str) -> String, "", "    upAxis = \"Y\"\n"), ("room.dae", dae, "", "<up_axis>Y_UP</up_axis>")]
    {
        let file = |head: &str, place: Turn| shapes(&text(place)).replace("UP", head);
        let told = plain(name, &file(unstated, |p| p));
        assert!(told.len() == 1 && told[0].contains("up_axis = \"z\" (or --up-axis z)"), "{name}: {told:?}");
        assert_eq!(plain(name, &file(unstated, y_up)), [""; 0], "{name}");
        // What the file states is believed.
        assert_eq!(plain(name, &file(stated, |p| p)), [""; 0], "{name}");
    }
}

/// The shapes of an OBJ file without their names: vertices, and corners of quadrilaterals from 0 on.
fn shapes_of(obj: &str) -> (Vec<[String; 3]>, Vec<String>) {
    let row = |line: &str, mark: &str| line.strip_prefix(mark).map(|rest| rest.split(' ').map(str::to_string).collect::<Vec<_>>());
    let vertices = obj.lines().filter_map(|line| row(line, "v ")).map(|v| v.try_into().unwrap()).collect();
    let corners = obj.lines().filter_map(|line| row(line, "f ")).flatten();
    (vertices, corners.map(|i| (i.parse::<usize>().unwrap() - 1).to_string()).collect())
}

/// USD, with UP where the upward axis may be stated.
fn usda(obj: &str) -> String {
    let (vertices, corners) = shapes_of(obj);
    let points: Vec<String> = vertices.iter().map(|v| format!("({})", v.join(", "))).collect();
    let counts = vec!["4"; corners.len() / 4].join(", ");
    format!(
        "#usda 1.0\n(\n    metersPerUnit = 1\nUP)\ndef Mesh \"m\" {{ point3f[] points = [{}] int[] faceVertexCounts = [{counts}] int[] \
         faceVertexIndices = [{}] }}\n",
        points.join(", "),
        corners.join(", ")
    )
}

/// COLLADA, with UP where the upward axis may be stated.
fn dae(obj: &str) -> String {
    let (vertices, corners) = shapes_of(obj);
    let (count, numbers) = (vertices.len(), vertices.concat().join(" "));
    let quads = corners.len() / 4;
    format!(
        r##"<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>UP</asset>
        <library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="{}">{numbers}</float_array>
        <technique_common><accessor source="#a" count="{count}" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
        <param name="Z" type="float"/></accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
        <polylist count="{quads}"><input semantic="VERTEX" source="#v" offset="0"/><vcount>{}</vcount><p>{}</p></polylist></mesh></geometry>
        </library_geometries><library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node></visual_scene>
        </library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>"##,
        3 * count,
        vec!["4"; quads].join(" "),
        corners.join(" ")
    )
}

/// The suspicions about the shapes of an OBJ file as glTF, which has them as they are.
fn of_gltf(obj: &str) -> Vec<String> {
    let row = |line: &str, mark: &str| line.strip_prefix(mark).map(|rest| rest.split(' ').map(str::to_string).collect::<Vec<_>>());
    let vertices: Vec<[f32; 3]> =
        obj.lines().filter_map(|line| row(line, "v ")).map(|v| [0, 1, 2].map(|axis| v[axis].parse().unwrap())).collect();
    let faces = obj.lines().filter_map(|line| row(line, "f "));
    let corners = faces.flat_map(|face| [0, 1, 2, 0, 2, 3].map(|i| vertices[face[i].parse::<usize>().unwrap() - 1]));
    let bytes: Vec<u8> = corners.flatten().flat_map(f32::to_le_bytes).collect();
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.bin"), &bytes).unwrap();
    let text = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": {}}}],
        "bufferViews": [{{"buffer": 0, "byteLength": {length}}}], "buffers": [{{"uri": "a.bin", "byteLength": {length}}}]}}"#,
        bytes.len() / 12,
        length = bytes.len()
    );
    let file = folder.path().join("room.gltf");
    std::fs::write(&file, text).unwrap();
    of(&FileSource::of(file.to_string_lossy()))
}

#[test]
fn generated_homes_are_not_suspected() {
    let folder = tempfile::tempdir().unwrap();
    for seed in 0..3 {
        let output = folder.path().join("home.scene");
        let config = HomeConfig { seed, ..HomeConfig::default() };
        make_home(&config, &output, |scene, _, _| Ok(to_bytes(scene).into()), &Quiet).unwrap();
        assert_eq!(of(&FileSource::of(Path::new(&output).to_string_lossy())), [""; 0], "home {seed}");
    }
}
