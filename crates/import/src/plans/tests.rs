//! Small plans of every kind, with known answers, and broken ones.

use super::read_plan;
use enfilade_math::DVec2;
use enfilade_scene::{DrawnPlan, OpeningKind};
use std::path::Path;

fn read(text: &str) -> DrawnPlan {
    read_plan(text.as_bytes(), Path::new("plan")).unwrap_or_else(|error| panic!("{error}"))
}

fn refused(text: &str) -> String {
    read_plan(text.as_bytes(), Path::new("plan")).unwrap_err().to_string()
}

/// Kinds with areas, m².
fn rooms(plan: &DrawnPlan) -> Vec<(&str, f64)> {
    plan.rooms.iter().map(|room| (room.kind.as_str(), (super::loops::area(&room.polygon).abs() * 100.0).round() / 100.0)).collect()
}

/// Kinds with middles and widths, in centimetres.
fn openings(plan: &DrawnPlan) -> Vec<(OpeningKind, [i64; 2], Option<i64>)> {
    let cm = |v: f64| (100.0 * v).round() as i64;
    plan.openings.iter().map(|o| (o.kind, [cm(o.at.x), cm(o.at.y)], o.width_m.map(cm))).collect()
}

#[test]
fn plans_by_hand_are_read_and_their_errors_name_the_place() {
    let text = r#"{"format": "enfilade plan 1", "height": 2.5, "rooms": [
        {"kind": "living", "polygon": [[0, 0], [5, 0], [5, 3], [3, 3], [3, 4], [0, 4]]},
        {"kind": "hall", "name": "entry", "height": 2.4, "polygon": [[5.1, 0], [7, 0], [7, 3], [5.1, 3]]}],
        "doors": [{"at": [5.05, 1], "into": "entry", "hinge": "right", "open": 30}, {"at": [7, 1.5], "width": 1.01}],
        "windows": [{"at": [2, 0], "width": 1.5, "sill": 0.8, "head": 2.1}],
        "roof": [{"from": [0, 4], "to": [5, 4], "knee": 1.2, "pitch": 40, "rooms": ["living_1"]}]}"#;
    let plan = read(text);
    // Towards the room, which is south of the line.
    let slope = enfilade_scene::Slope { from: [5.0, 4.0], to: [0.0, 4.0], low_z_m: 1.2, pitch_deg: 40.0 };
    assert_eq!(plan.slopes, [enfilade_scene::CeilingSlope { room: 0, slope }]);
    assert_eq!(rooms(&plan), [("living", 18.0), ("hall", 5.7)]);
    assert_eq!(
        plan.rooms.iter().map(|room| (room.name.as_str(), room.height_m)).collect::<Vec<_>>(),
        [("living_1", Some(2.5)), ("entry", Some(2.4))]
    );
    assert_eq!(plan.openings[0].into, Some(1));
    assert_eq!(plan.openings[2].z_m, Some([0.8, 2.1]));
    for (from, to, expected) in [
        ("\"kind\": \"hall\"", "\"kid\": \"hall\"", "unknown field `kid`"),
        ("\"into\": \"entry\"", "\"into\": \"entri\"", "doors[0]: there is no room \"entri\"; did you mean `entry`?"),
        ("\"living_1\"]", "\"livin_1\"]", "roof[0]: there is no room \"livin_1\"; did you mean `living_1`?"),
        (", \"head\": 2.1", "", "windows[0]: a window has both `sill` and `head`, or neither"),
        ("plan 1", "plan 2", "found \"enfilade plan 2\", expected \"enfilade plan 1\""),
        ("]}],", "]},],", "expected JSON with a floor plan"),
    ] {
        let message = refused(&text.replacen(from, to, 1));
        assert!(message.contains(expected), "{message}");
    }
    assert!(refused("{\"a\": 1}").contains("it is no floor plan that is read; expected a layout of ours"));
}

#[test]
fn svg_shapes_are_rooms_and_openings() {
    let plan = read(
        "<svg xmlns='http://www.w3.org/2000/svg' data-meters-per-unit='0.02'><g transform='translate(10 0) scale(2)'>
           <path data-kind='LivingRoom' d='M0 0 h100 v75 l-25 25 H0 z'/><rect id='bathroom_1' x='100' y='0' width='50' height='60'/>
           <line class='window' x1='20' y1='0' x2='50' y2='0'/><line id='door' x1='100' y1='10' x2='100' y2='30'/>
           <circle r='3'/><rect width='3' height='3'/></g></svg>",
    );
    assert_eq!(rooms(&plan), [("LivingRoom", 15.5), ("bathroom", 4.8)]);
    assert_eq!(plan.rooms[0].polygon[2], DVec2::new(4.2, -3.0));
    assert_eq!(openings(&plan), [(OpeningKind::Window, [160, 0], Some(120)), (OpeningKind::Door, [420, -80], Some(80))]);
    assert_eq!(plan.notes, ["2 shapes have no id, title or class that says what they are; they are left out"]);
    let unnamed = refused("<svg><path id='path12' d='M0 0 h4 v4 z'/></svg>");
    assert!(unnamed.contains("it was read as SVG, but no room was found; a unit of the drawing"), "{unnamed}");
    assert!(unnamed.contains("1 shapes have no id"), "{unnamed}");
    assert!(refused("<svg data-meters-per-unit='2m'/>").contains("expected metres of a unit"));
}

#[test]
fn curves_of_svg_are_flattened_in_the_size_that_they_have() {
    let plan = read(
        "<svg xmlns='http://www.w3.org/2000/svg' data-meters-per-unit='0.01'><g transform='scale(2)'>
           <circle id='study' cx='100' cy='100' r='100'/>
           <path class='hall' d='M300 0h100a100 100 0 01100 100v100h-200z'/></g>
           <path d='M0 0 C1 2'/></svg>",
    );
    let areas = [std::f64::consts::PI * 4.0, 12.0 + std::f64::consts::PI];
    for (room, expected) in plan.rooms.iter().zip(areas) {
        let found = super::loops::area(&room.polygon).abs();
        assert!((found - expected).abs() < 1e-3 * expected, "{}: {found} of {expected}", room.name);
    }
    assert!(plan.notes.iter().any(|note| note.starts_with("1 shapes have no id")), "{:?}", plan.notes);
    assert!(refused("<svg><path id='hall' d='M0 0 C1 2'/></svg>").contains("line 1: found \"\", expected a number"));
}

#[test]
fn drawings_of_cubicasa_are_read_by_the_classes_of_groups() {
    let text = "<svg xmlns='http://www.w3.org/2000/svg'><g id='Floor-1' class='Floorplan Floor-1'>
        <g id='Wall' class='Wall External'><polygon points='0,0 620,0 610,10 10,10 '/>
          <g id='Door' class='Door Swing Beside'><polygon points='100,0 190,0 190,10 100,10'/>
            <g id='Threshold'><polygon points='100,0 190,0 190,10 100,10'/></g>
            <g class='Panel Left Positive'><path d='M190,10 q-90,0 -90,-90 l90,0 Z'/></g></g></g>
        <g id='Wall' class='Wall'><polygon points='300,10 312,10 312,410 300,410'/>
          <g class='Door None'><polygon points='300,50 312,50 312,170 300,170'/></g></g>
        <g class='Window Regular'><polygon points='400,0 520,0 520,10 400,10'/><g class='Glass'><polygon points='0,0 1,0 1,1'/></g></g>
        <g class='Space LivingRoom'><polygon points='10,10 300,10 300,410 10,410'/><g class='NameLabel'><text>OH</text></g></g>
        <g class='Space Sauna'><polygon points='312,10 610,10 610,410 312,410'/></g>
        <g class='Space Outdoor Balcony'><polygon points='0,420 610,420 610,600 0,600'/></g>
        <g class='FixedFurniture Sink'><g class='BoundaryPolygon'><polygon points='0,0 9,0 9,9'/></g></g></g></svg>";
    let plan = read(text);
    assert_eq!(rooms(&plan), [("LivingRoom", 11.6), ("bathroom", 11.92)]);
    let expected = [
        (OpeningKind::Door, [145, -5], Some(90)),
        (OpeningKind::Passage, [306, -110], Some(120)),
        (OpeningKind::Window, [460, -5], Some(120)),
    ];
    assert_eq!(openings(&plan), expected);
    assert!(plan.notes[0].contains("taken as 0.0100 m") && plan.notes[1].starts_with("1 spaces are outdoors"), "{:?}", plan.notes);
    // A scan of half the size: its only door, 45 units wide, is 0.85 m.
    let half = read(&text.replace(
        "points='100,0 190,0 190,10 100,10'/>\n            <g id='Threshold'",
        "points='100,0 145,0 145,10 100,10'/><g id='Threshold'",
    ));
    assert!(half.notes[0].contains("taken as 0.0189 m"), "{:?}", half.notes);
}

#[test]
fn bulges_and_circles_of_dxf_are_arcs() {
    // A square of 4 m whose east side is half a circle outwards, and a circle.
    let text = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n6\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n0\nLWPOLYLINE\n8\nliving\n70\n1\n10\n0\n20\n0\n\
                10\n4\n20\n0\n42\n1\n10\n4\n20\n4\n10\n0\n20\n4\n0\nCIRCLE\n8\nstudy\n10\n10\n20\n2\n40\n2\n0\nENDSEC\n0\nEOF\n";
    let plan = read(text);
    let round = std::f64::consts::PI * 4.0;
    for (room, expected) in plan.rooms.iter().zip([16.0 + 0.5 * round, round]) {
        let found = super::loops::area(&room.polygon).abs();
        assert!((found - expected).abs() < 1e-3 * expected, "{}: {found} of {expected}", room.name);
    }
    assert_eq!((plan.rooms.len(), plan.notes.len()), (2, 0));
    let east = plan.rooms[0].polygon.iter().map(|p| p.x).fold(0.0, f64::max);
    assert!((east - 6.0).abs() < 0.006, "{east}");
}

#[test]
fn dxf_polylines_are_rooms_named_by_the_texts_in_them() {
    let outline = |points: &[[f64; 2]], layer: &str| {
        let corners: String = points.iter().map(|[x, y]| format!("10\n{x}\n20\n{y}\n")).collect();
        format!("0\nLWPOLYLINE\n8\n{layer}\n70\n1\n{corners}")
    };
    let text = format!(
        "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n{}{}0\nTEXT\n8\n0\n10\n1000\n20\n1000\n1\nKitchen\n\
         0\nLINE\n8\nA-Doors\n10\n3050\n20\n500\n11\n3050\n21\n1385\n0\nENDSEC\n0\nEOF\n",
        outline(&[[0.0, 0.0], [3000.0, 0.0], [3000.0, 2500.0], [0.0, 2500.0]], "ROOMS"),
        outline(&[[3100.0, 0.0], [5000.0, 0.0], [5000.0, 2500.0], [3100.0, 2500.0]], "hall"),
    );
    let plan = read(&text);
    assert_eq!(rooms(&plan), [("Kitchen", 7.5), ("hall", 4.75)]);
    assert_eq!(openings(&plan), [(OpeningKind::Door, [305, 94], Some(89))]);
    assert_eq!(plan.notes, Vec::<String>::new());
    assert!(refused(&text.replace("\n2500\n", "\ntwo\n")).contains("found \"two\", expected a number"));
    assert!(refused("AutoCAD Binary DXF\r\n").contains("save it as ASCII DXF"));
}

#[test]
fn spatiallm_walls_close_around_rooms_whose_kinds_are_guessed() {
    let text = "wall_0=Wall(0,0,0,4,0,0,2.5,0)\nwall_1=Wall(4,0,0,4,3,0,2.5,0)\nwall_2=Wall(4,3,0,0,3.1,0,2.5,0)\n\
                wall_3=Wall(0,3,0,0,0,0,2.5,0)\ndoor_0=Door(wall_1,4,1,1,0.9,2)\nwindow_0=Window(wall_0,2,0,1.5,1.2,1.2)\n\
                bbox_0=Bbox(bed,2,1,0.3,0,2,1.6,0.6)\n";
    let plan = read(text);
    assert_eq!(plan.rooms[0].kind, "bedroom");
    assert_eq!(plan.rooms[0].polygon.len(), 4);
    assert_eq!(openings(&plan), [(OpeningKind::Door, [400, 100], Some(90)), (OpeningKind::Window, [200, 0], Some(120))]);
    assert_eq!(plan.openings[1].z_m.map(|z| z.map(|z| (z * 10.0).round())), Some([9.0, 21.0]));
    assert!(refused(&text.replace("wall_2=Wall(4,3,", "wall_2=Wall(4,7,")).contains("do not meet within"));
    assert!(refused(&text.replace("0.9,2)", "0.9)")).contains("line 5"));
}

#[test]
fn procthor_is_mirrored_as_its_houses_are() {
    let plan = read(
        r#"{"rooms": [{"id": "room|2", "roomType": "Bedroom", "floorPolygon": [{"x":0,"y":0,"z":0},{"x":0,"y":0,"z":3},{"x":4,"y":0,"z":3},{"x":4,"y":0,"z":0}]}],
        "walls": [{"id": "w", "roomId": "room|2", "polygon": [{"x":0,"y":0,"z":0},{"x":0,"y":0,"z":3},{"x":0,"y":2.8,"z":3},{"x":0,"y":2.8,"z":0}]}],
        "doors": [{"id": "d", "assetId": "Doorway_1", "wall0": "w", "holePolygon": [{"x":1,"y":0,"z":0},{"x":2,"y":2.1,"z":0}]}],
        "windows": [{"id": "lost", "wall0": "none"}]}"#,
    );
    assert_eq!((rooms(&plan), plan.rooms[0].height_m), (vec![("Bedroom", 12.0)], Some(2.8)));
    assert_eq!(plan.rooms[0].polygon[2], DVec2::new(-4.0, -3.0));
    assert_eq!(openings(&plan), [(OpeningKind::Door, [0, -150], Some(100))]);
    assert_eq!(plan.notes, ["lost has no wall or no hole; it is left out"]);
}

#[test]
fn floors_of_3d_front_are_outlined() {
    let plan = read(
        r#"{"furniture": [], "mesh": [
          {"uid": "f", "type": "Floor", "xyz": [0,0,0, 4,0,0, 4,0,-3, 0,0,-3, 2,0,-3, 2,0,-5, 0,0,-5], "faces": [0,1,2, 0,2,4, 0,4,3, 3,4,5, 3,5,6]},
          {"uid": "d", "type": "Door", "xyz": [4,0,-1, 4.2,0,-1, 4.2,2,-1.9, 4,2,-1.9], "faces": [0,1,2, 0,2,3]},
          {"uid": "d2", "type": "Pocket", "xyz": [4,0,-1, 4.2,0,-1, 4.2,2,-1.9, 4,2,-1.9], "faces": [0,1,2, 0,2,3]},
          {"uid": "p", "type": "Pocket", "xyz": [0,0,-1, -0.2,0,-1, -0.2,2.1,-1.8, 0,2.1,-1.8], "faces": [0,1,2, 0,2,3]},
          {"uid": "s", "type": "BayWindow", "xyz": [1,0.2,0, 3,0.2,0, 3,0.25,0.2, 1,0.25,0.2], "faces": [0,1,2, 0,2,3]},
          {"uid": "w", "type": "BayWindow", "xyz": [1,0.2,0.1, 3,0.2,0.1, 3,2.3,0.2, 1,2.3,0.2], "faces": [0,1,2, 0,2,3]}],
        "scene": {"room": [{"type": "MasterBedroom", "instanceid": "MasterBedroom-12",
          "children": [{"ref": "f"}, {"ref": "d"}, {"ref": "d2"}, {"ref": "p"}, {"ref": "s"}, {"ref": "w"}]}]}}"#,
    );
    assert_eq!(rooms(&plan), [("MasterBedroom", 16.0)]);
    let (door, window) = ((OpeningKind::Door, [410, 145], Some(90)), (OpeningKind::Window, [200, -15], Some(200)));
    assert_eq!(openings(&plan), [door, window, (OpeningKind::Door, [-10, 140], Some(80))]);
    assert!(plan.notes[0].starts_with("1 openings have only linings"), "{:?}", plan.notes);
}

#[test]
fn drawings_of_lines_alone_say_what_is_missing() {
    let text = "0\nSECTION\n2\nENTITIES\n0\nLINE\n8\nwalls\n10\n0\n20\n0\n11\n4\n21\n0\n0\nENDSEC\n0\nEOF\n";
    assert!(refused(text).contains("1 single lines are no outlines: draw a closed polyline around each room"));
}
