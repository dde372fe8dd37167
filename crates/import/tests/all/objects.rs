//! Things as files define them: objects, their parents, and labels that files give to them.

use crate::common::{Folder, Gltf, warnings};
use enfilade_import::Imported;
use enfilade_scene::{PartLabel, Scene};
use serde_json::json;

const TRIANGLES: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

/// Every part with the number of its object, from 0 in the order of parts, and the names around it.
fn told(scene: &Scene) -> Vec<(String, usize, String)> {
    let mut known: Vec<u32> = Vec::new();
    let number = |part: u32| {
        let object = scene.object_of(part);
        known.iter().position(|k| *k == object).unwrap_or_else(|| {
            known.push(object);
            known.len() - 1
        })
    };
    let numbers: Vec<usize> = (0..scene.parts.len() as u32).map(number).collect();
    let parts = scene.parts.iter().zip(numbers);
    parts.map(|(part, number)| (part.name.clone(), number, scene.lineage(part).join(" > "))).collect()
}

fn assert_told(scene: &Scene, expected: &[(&str, usize, &str)]) {
    let expected: Vec<_> = expected.iter().map(|(part, object, names)| (part.to_string(), *object, names.to_string())).collect();
    assert_eq!(told(scene), expected);
}

/// Class and instance of every part, by name.
fn labels(imported: &Imported) -> Vec<(String, i16, i16)> {
    let mut of_parts = vec![PartLabel::NONE; imported.scene.parts.len()];
    imported.labels.iter().flatten().for_each(|l| of_parts[l.part as usize] = l.label);
    imported.scene.parts.iter().zip(of_parts).map(|(part, l)| (part.name.clone(), l.semantic, l.instance)).collect()
}

fn assert_labels(imported: &Imported, expected: &[(&str, i16, i16)]) {
    let expected: Vec<_> = expected.iter().map(|(part, class, instance)| (part.to_string(), *class, *instance)).collect();
    assert_eq!(labels(imported), expected);
}

fn usd(body: &str) -> Imported {
    let folder = Folder::new();
    let chair = "#usda 1.0\n( defaultPrim = \"Chair\" upAxis = \"Z\" metersPerUnit = 1 )\n\
                 def Xform \"Chair\" ( prepend apiSchemas = [\"SemanticsLabelsAPI:class\"] ) {\n\
                 token[] semantics:labels:class = [\"chair\"]\ndef Cube \"seat\" { }\ndef Cube \"back\" { }\n}\n";
    folder.write("chair.usda", chair);
    let stage = format!("#usda 1.0\n( upAxis = \"Z\" metersPerUnit = 1 )\ndef Xform \"World\" {{\n{body}\n}}\n");
    folder.write("a.usda", stage).load("a.usda").unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn nodes_with_their_primitives_are_objects_and_lie_in_the_nodes_above() {
    let mut g = Gltf::triangle();
    let primitive = g.json["meshes"][0]["primitives"][0].clone();
    g.json["meshes"] = json!([{"primitives": [primitive, primitive]}, {"primitives": [primitive]}]);
    g.json["nodes"] = json!([
        {"name": "World", "children": [1, 2, 3]},
        {"name": "chair_1", "mesh": 0}, {"name": "chair_2", "mesh": 0, "children": [4]},
        {"children": [5]}, {"name": "cushion", "mesh": 1}, {"name": "World/rug", "mesh": 1}
    ]);
    g.json["scenes"] = json!([{"nodes": [0]}]);
    let scene = Folder::new().write("a.gltf", g.text()).load("a.gltf").unwrap().scene;
    assert_told(
        &scene,
        &[
            ("chair_1.0", 0, "World > chair_1"),
            ("chair_1.1", 0, "World > chair_1"),
            ("chair_2.0", 1, "World > chair_2"),
            ("chair_2.1", 1, "World > chair_2"),
            ("cushion", 2, "World > chair_2 > cushion"),
            ("World/rug", 3, "World > World/rug"),
        ],
    );
}

#[test]
fn groups_are_objects_unless_the_file_has_several_o() {
    let scene = |text: &str| Folder::new().write("a.obj", format!("{TRIANGLES}{text}")).load("a.obj").unwrap().scene;
    let [wood, cloth] = ["usemtl wood\nf 1 2 3\n", "usemtl cloth\nf 1 2 3\n"];
    assert_told(
        &scene(&format!("o chair_1\n{wood}{cloth}o chair_2\n{wood}{cloth}")),
        &[("chair_1.wood", 0, "chair_1"), ("chair_1.cloth", 0, "chair_1"), ("chair_2.wood", 1, "chair_2"), ("chair_2.cloth", 1, "chair_2")],
    );
    // Blender's groups of materials within its objects.
    assert_told(
        &scene(&format!("o Chair\ng Chair_wood\n{wood}g Chair_cloth\n{cloth}o Table\n{wood}")),
        &[("Chair_wood", 0, "Chair"), ("Chair_cloth", 0, "Chair"), ("Table", 1, "Table")],
    );
    // Programs that know groups alone write one `o`, or none.
    for (o, around) in [("", ""), ("o room\n", "room > ")] {
        let expected = ["chair", "chair", "table"].map(|name| format!("{around}{name}"));
        let found: Vec<(usize, String)> = told(&scene(&format!("{o}g chair\n{wood}{cloth}g table\n{wood}")))
            .into_iter()
            .map(|(_, object, names)| (object, names))
            .collect();
        assert_eq!(found, [0, 0, 1].into_iter().zip(expected).collect::<Vec<_>>(), "{o:?}");
    }
    assert_told(&scene(&format!("{wood}{cloth}")), &[("wood", 0, "wood"), ("cloth", 1, "cloth")]);
}

#[test]
fn a_face_of_several_groups_is_of_the_first_within_the_others() {
    let load = |text: &str| Folder::new().write("a.obj", format!("{TRIANGLES}{text}")).load("a.obj").unwrap();
    let text = "g chair_1 furniture\nf 1 2 3\ng table_1 furniture\nusemtl Wood\nf 1 2 3\nusemtl Steel\nf 1 2 3\ng furniture\nf 1 2 3\n";
    assert_told(
        &load(text).scene,
        &[
            ("chair_1", 0, "furniture > chair_1"),
            ("table_1.Wood", 1, "furniture > table_1"),
            ("table_1.Steel", 1, "furniture > table_1"),
            ("furniture", 2, "furniture"),
        ],
    );
    // As SketchUp writes them.
    assert_told(
        &load("g Mesh1 Chair Model\nf 1 2 3\ng Mesh2 Chair Model\nf 1 2 3\n").scene,
        &[("Mesh1", 0, "Model > Chair > Mesh1"), ("Mesh2", 1, "Model > Chair > Mesh2")],
    );
    assert_told(&load("o House\ng seat chair_1\nf 1 2 3\n").scene, &[("seat", 0, "House > chair_1 > seat")]);
    // Names of objects, and names with spaces, are one.
    assert_told(
        &load("o Big_Chair 1\nf 1 2 3\no Big_Chair 2\nf 1 2 3\n").scene,
        &[("Big_Chair 1", 0, "Big_Chair 1"), ("Big_Chair 2", 1, "Big_Chair 2")],
    );
    assert_told(
        &load("g Living Room Chair\nf 1 2 3\ng Living Room Table\nf 1 2 3\n").scene,
        &[("Living Room Chair", 0, "Living Room Chair"), ("Living Room Table", 1, "Living Room Table")],
    );
}

#[test]
fn prims_are_objects_and_components_instances_and_placed_prototypes_are_one() {
    let scene = usd(r#"def Cube "chair_1" { }
           def Cube "chair_2" { }
           def Xform "set" { def Cube "a" { }
             def Cube "b" { } }
           def Xform "model" ( kind = "component" ) { def Xform "legs" ( instanceable = true ) { def Cube "c" { } }
             def Cube "d" { } }
           def Xform "copy" ( instanceable = true prepend references = @chair.usda@ ) { }
           def PointInstancer "pots" { point3f[] positions = [(0,0,0),(4,0,0)]
             int[] protoIndices = [0,0]
             rel prototypes = [</World/pots/pot>]
             def Xform "pot" { def Cube "clay" { }
               def Cube "plant" { } } }"#)
    .scene;
    assert_told(
        &scene,
        &[
            ("World/chair_1", 0, "World > chair_1"),
            ("World/chair_2", 1, "World > chair_2"),
            ("World/set/a", 2, "World > set > a"),
            ("World/set/b", 3, "World > set > b"),
            ("World/model/legs/c", 4, "World > model"),
            ("World/model/d", 4, "World > model"),
            ("World/copy/seat", 5, "World > copy"),
            ("World/copy/back", 5, "World > copy"),
            ("pots[0]/World/pots/pot/clay", 6, "World > pots > pots[0]"),
            ("pots[0]/World/pots/pot/plant", 6, "World > pots > pots[0]"),
            ("pots[1]/World/pots/pot/clay", 7, "World > pots > pots[1]"),
            ("pots[1]/World/pots/pot/plant", 7, "World > pots > pots[1]"),
        ],
    );
    // A prim that contains everything is the scene, whatever its kind.
    let all = usd("def Xform \"all\" ( kind = \"component\" ) { def Cube \"a\" { }\ndef Cube \"b\" { } }").scene;
    assert_told(&all, &[("World/all/a", 0, "World > all > a"), ("World/all/b", 1, "World > all > b")]);
}

#[test]
fn shapes_of_an_instance_are_one_object() {
    let mitsuba = r#"<scene version="3.0.0"><shape type="shapegroup" id="lamp"><shape type="sphere"/><shape type="cube"/></shape>
        <shape type="instance" id="lamp_1"><ref id="lamp"/></shape><shape type="instance" id="lamp_2"><ref id="lamp"/></shape>
        <shape type="cube" id="floor"/></scene>"#;
    let scene = Folder::new().write("a.xml", mitsuba).load("a.xml").unwrap().scene;
    assert_eq!(
        told(&scene).into_iter().map(|(_, object, names)| (object, names)).collect::<Vec<_>>(),
        [(0, "lamp_1".to_string()), (0, "lamp_1".into()), (1, "lamp_2".into()), (1, "lamp_2".into()), (2, "floor".into()),]
    );
    let pbrt = "WorldBegin\nObjectBegin \"lamp\"\nShape \"sphere\"\nShape \"disk\"\nObjectEnd\nObjectInstance \"lamp\"\nObjectInstance \"lamp\"\n\
                Shape \"disk\"\n";
    let scene = Folder::new().write("a.pbrt", pbrt).load("a.pbrt").unwrap().scene;
    assert_eq!(told(&scene).iter().map(|(_, object, _)| *object).collect::<Vec<_>>(), [0, 0, 1, 1, 2]);
}

#[test]
fn semantics_of_prims_give_each_an_instance_of_its_own() {
    let imported = usd(r#"def Xform "c1" ( instanceable = true prepend references = @chair.usda@ ) { }
           def Xform "c2" ( instanceable = true prepend references = @chair.usda@ ) { token[] semantics:labels:class = ["table"] }
           def Xform "grp" { string semantic:Semantics:params:semanticData = "Night stand"
             def Cube "s1" { }
             def Cube "s2" { }
             def Cube "own" { token[] semantics:labels:class = ["lamp"] } }
           def PointInstancer "pi" { point3f[] positions = [(0,0,2),(1,0,2),(2,0,2),(3,0,2)]
             int[] protoIndices = [0,1,0,2]
             token[] semantics:labels:class = ["otherprop"]
             rel prototypes = [</World/pi/P/book>, </World/pi/P/box>, </World/pi/P/bare>]
             def Scope "P" { def Cube "book" { token[] semantics:labels:class = ["books"] }
               def Xform "box" ( instanceable = true prepend references = @chair.usda@ ) { }
               def Cube "bare" { } } }
           def Cube "floor" { token[] semantics:labels:class = ["floor"] }"#);
    assert_labels(
        &imported,
        &[
            ("World/c1/seat", 5, 1),
            ("World/c1/back", 5, 1),
            ("World/c2/seat", 7, 2),
            ("World/c2/back", 7, 2),
            ("World/grp/s1", 32, 3),
            ("World/grp/s2", 32, 3),
            ("World/grp/own", 35, 4),
            ("pi[0]/World/pi/P/book", 23, 5),
            ("pi[1]/World/pi/P/box/seat", 5, 6),
            ("pi[1]/World/pi/P/box/back", 5, 6),
            ("pi[2]/World/pi/P/book", 23, 7),
            ("pi[3]/World/pi/P/bare", 40, 8),
            ("World/floor", 2, -1),
        ],
    );
}

#[test]
fn of_two_schemas_the_stronger_opinion_counts_then_the_newer_schema() {
    // By the strength order of USD (LIVRPS): a prim's own opinion is stronger than what it references.
    let older = |name: &str| format!("string semantic:Semantics:params:semanticData = \"{name}\"");
    let newer = |name: &str| format!("token[] semantics:labels:class = [\"{name}\"]");
    let chair = "prepend references = @chair.usda@";
    let imported = usd(&format!(
        r#"def Xform "own" ( {chair} ) {{ {} }}
           def Xform "both" ( {chair} ) {{ {}
             {} }}
           class "Old" {{ {} }}
           def Cube "inherited" ( inherits = </World/Old> ) {{ {} }}
           def Cube "here" {{ {}
             {} }}
           def Xform "unknown" ( {chair} ) {{ {} }}"#,
        older("lamp"),
        older("lamp"),
        newer("table"),
        older("bed"),
        newer("sofa"),
        older("bed"),
        newer("desk"),
        older("chair_03"),
    ));
    assert_labels(
        &imported,
        &[
            ("World/own/seat", 35, 1),
            ("World/own/back", 35, 1),
            ("World/both/seat", 7, 2),
            ("World/both/back", 7, 2),
            ("World/inherited", 6, 3),
            ("World/here", 14, 4),
            ("World/unknown/seat", 5, 5),
            ("World/unknown/back", 5, 5),
        ],
    );
}

#[test]
fn subsets_may_have_labels_of_their_own() {
    let imported = usd(r#"def Mesh "bed" { token[] semantics:labels:class = ["bed"]
             int[] faceVertexCounts = [3, 3]
             int[] faceVertexIndices = [0, 1, 2, 0, 2, 3]
             point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
             def GeomSubset "pillow" { int[] indices = [1]
               token[] semantics:labels:class = ["pillow"] } }"#);
    assert_labels(&imported, &[("World/bed", 4, 1), ("World/bed.pillow", 18, 2)]);
}

#[test]
fn categories_of_roomplan_are_labels() {
    let object = |name: &str, category: &str| {
        format!("def Xform \"{name}\" ( customData = {{ string Category = \"{category}\" }} ) {{ def Cube \"{name}\" {{ }} }}\n")
    };
    let list = [("Wall0", "Wall"), ("Door2", "Door(Isopen: False)"), ("Storage1", "Storage"), ("Chair3", "Chair"), ("O", "Opening")];
    let imported = usd(&list.map(|(name, category)| object(name, category)).concat());
    let found: Vec<(i16, i16)> = labels(&imported).into_iter().map(|(_, class, instance)| (class, instance)).collect();
    assert_eq!(found, [(1, -1), (8, 1), (3, 2), (5, 3), (-1, -1)]);
    assert!(warnings(&imported).contains("1 labels name no class of NYU40 and were left out; the first is \"Opening\""));
}

#[test]
fn extras_without_a_number_give_each_node_an_instance() {
    let mut g = Gltf::triangle();
    g.json["nodes"] = json!([
        {"name": "c1", "mesh": 0, "extras": {"semantic": "chair"}},
        {"name": "c2", "mesh": 0, "extras": {"semantic_id": 5}},
        {"name": "c3", "mesh": 0, "extras": {"semantic": "Chair", "instance": 2}},
        {"name": "c4", "mesh": 0, "extras": {"semantic_id": 5.0, "semantic": "table"}},
        {"name": "grp", "children": [5, 6], "extras": {"semantic": "sofa"}},
        {"name": "s0", "mesh": 0}, {"name": "s1", "mesh": 0},
        {"name": "none", "mesh": 0, "extras": {"semantic": "lamp", "instance": -1}},
        {"name": "walls", "mesh": 0, "extras": {"semantic": "wall"}},
        {"name": "odd", "mesh": 0, "extras": {"semantic": "armchair"}}
    ]);
    g.json["scenes"] = json!([{"nodes": [0, 1, 2, 3, 4, 7, 8, 9]}]);
    let imported = Folder::new().write("a.gltf", g.text()).load("a.gltf").unwrap();
    assert_labels(
        &imported,
        &[
            ("c1", 5, 1),
            ("c2", 5, 3),
            ("c3", 5, 2),
            ("c4", 7, 4),
            ("s0", 6, 5),
            ("s1", 6, 5),
            ("none", 35, -1),
            ("walls", 1, -1),
            ("odd", -1, -1),
        ],
    );
    let told = warnings(&imported);
    for expected in ["semantic is \"table\", but semantic_id is 5.0", "found \"armchair\", expected a NYU40 id"] {
        assert!(told.contains(expected), "{expected} is not in\n{told}");
    }
}

#[test]
fn each_place_of_an_instanced_mesh_is_an_object_and_an_instance() {
    let mut g = Gltf::triangle();
    let places = [0.0f32, 0.0, 0.0, 3.0, 0.0, 0.0].map(f32::to_le_bytes).concat();
    let places = g.accessor(&places, 5126, "VEC3", 2);
    g.json["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": places}}});
    g.json["nodes"][0]["name"] = json!("chair");
    g.json["nodes"][0]["extras"] = json!({"semantic": "chair"});
    g.json["extensionsUsed"] = json!(["EXT_mesh_gpu_instancing"]);
    let imported = Folder::new().write("a.gltf", g.text()).load("a.gltf").unwrap();
    assert_told(&imported.scene, &[("chair", 0, "chair"), ("chair_2", 1, "chair")]);
    assert_labels(&imported, &[("chair", 5, 1), ("chair_2", 5, 2)]);
}

#[test]
fn extras_of_a_mesh_label_the_nodes_that_show_it_and_nothing_below_them() {
    // Blender's exporter writes custom properties of an object to the node, those of its mesh to the mesh.
    let mut g = Gltf::triangle();
    g.json["meshes"][0]["extras"] = json!({"semantic": "chair"});
    let plain = g.json["meshes"][0]["primitives"].clone();
    g.json["meshes"].as_array_mut().unwrap().push(json!({"primitives": plain}));
    g.json["nodes"] = json!([
        {"name": "c1", "mesh": 0, "children": [3]},
        {"name": "c2", "mesh": 0},
        {"name": "sofa", "mesh": 0, "extras": {"semantic": "sofa"}},
        {"name": "cushion", "mesh": 1},
        {"name": "numbered", "mesh": 0, "extras": {"instance": 7}}
    ]);
    g.json["scenes"] = json!([{"nodes": [0, 1, 2, 4]}]);
    let imported = Folder::new().write("a.gltf", g.text()).load("a.gltf").unwrap();
    assert_labels(&imported, &[("c1", 5, 1), ("cushion", -1, -1), ("c2", 5, 2), ("sofa", 6, 3), ("numbered", 5, 7)]);
    g.json["meshes"][0]["extras"] = json!({"semantic_id": 99});
    let told = warnings(&Folder::new().write("a.gltf", g.text()).load("a.gltf").unwrap());
    assert!(told.contains("meshes[0].extras.semantic_id: found 99, expected a NYU40 id"), "{told}");
}

#[test]
fn geoms_of_the_world_are_objects_and_those_of_a_body_are_one() {
    let chair = |name: &str, x: f64| format!("<geom name=\"{name}\" type=\"box\" size=\".2 .2 .4\" pos=\"{x} 0 .4\"/>");
    let text = format!(
        "<mujoco model=\"room\"><worldbody>{}{}<body name=\"table\" pos=\"0 3 0\">{}{}</body></worldbody></mujoco>",
        chair("chair_1", 1.0),
        chair("chair_2", 2.0),
        chair("top", 0.0),
        chair("leg", 0.1),
    );
    let imported = Folder::new().write("a.xml", text).load("a.xml").unwrap_or_else(|e| panic!("{e}"));
    assert_told(
        &imported.scene,
        &[("chair_1", 0, "room > chair_1"), ("chair_2", 1, "room > chair_2"), ("top", 2, "room > table"), ("leg", 2, "room > table")],
    );
}
