//! V-Ray scenes that are wrong: each message names file, place, plugin, what was found and what to do.

use crate::common::{Folder, warnings};

const GOOD: &str = "GeomStaticMesh mesh {\n  vertices=ListVector(Vector(0,0,0), Vector(1,0,0), Vector(0,1,0));\n  faces=ListInt(0,1,2);\n}\n\
    Node part {\n  geometry=mesh;\n  material=mtl;\n}\n\
    MtlSingleBRDF mtl {\n  brdf=brdf;\n}\nBRDFDiffuse brdf {\n  color=Color(0.5,0.5,0.5);\n}\nRenderView view {\n  fov=1;\n}\n";

fn error(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from}");
    Folder::new().write("a.vrscene", GOOD.replace(from, to)).error("a.vrscene")
}

#[test]
fn wrong_values_are_told_with_file_line_plugin_and_remedy() {
    for (from, to, expected) in [
        ("fov=1;", "fov=\"wide\";", "a.vrscene: 16:3: RenderView view: fov: found \"wide\", expected a number; correct the value"),
        ("geometry=mesh;", "geometry=gone;", "a.vrscene: 6:3: Node part: geometry: refers to gone, but no plugin has this name; add"),
        ("geometry=mesh;", "geometry=5;", "geometry: found 5, expected the name of a plugin"),
        (
            "ListInt(0,1,2)",
            "ListInt(0,1,3)",
            "a.vrscene: 3:3: GeomStaticMesh mesh: faces: face 0 has the indices 0, 1, 3, but there are 3 vertices",
        ),
        ("ListInt(0,1,2)", "ListInt(0,1,-1)", "face 0 has the indices 0, 1, -1"),
        ("ListInt(0,1,2)", "ListInt(0,1)", "found 2 indices, expected three for each face"),
        ("ListInt(0,1,2)", "ListIntHex(\"ZIPCzz\")", "a.vrscene: 3:21: GeomStaticMesh mesh: faces: expected two sizes"),
        (
            "faces=ListInt(0,1,2);",
            "faces=ListInt(0,1,2); face_mtlIDs=ListInt(1,2);",
            "found 2 material ids, expected one for each of the 1 faces",
        ),
        (
            "faces=ListInt(0,1,2);",
            "faces=ListInt(0,1,2); normals=ListVector(Vector(0,0,1)); faceNormals=ListInt(0,0,1);",
            "but there are 1 normals",
        ),
        ("faces=ListInt(0,1,2);", "faces=ListInt(0,1,2); map_channels=List(List(1, 2));", "map_channels: expected List(List(number"),
        ("Vector(1,0,0)", "Vector(nan,0,0)", "GeomStaticMesh mesh: "),
        ("fov=1;", "transform=Color(1,1,1);", "expected Transform(Matrix"),
        (
            "fov=1;\n}",
            "fov=1;\n}\nSettingsUnitsInfo u {\n  meters_scale=0;\n}",
            "SettingsUnitsInfo u: meters_scale: found 0, expected a number above zero",
        ),
        ("fov=1;\n}", "fov=1;\n}\nLightSphere s {\n  units=9;\n}", "LightSphere s: units: found 9, expected 0 (image), 1 (lm)"),
        ("color=Color(0.5,0.5,0.5);", "color=Color(0.5,0.5,0.5)", "a.vrscene: 14:1: expected `;`"),
    ] {
        let found = error(from, to);
        assert!(found.contains(expected), "{to}: {found}\nexpected {expected}");
    }
}

#[test]
fn circles_end_with_an_error() {
    for (from, to, expected) in [
        (
            "color=Color(0.5,0.5,0.5);\n}",
            "color_tex=t;\n}\nTexBitmap t {\n  color_mult=t;\n}",
            "color_mult: textures refer to each other in a circle",
        ),
        ("brdf=brdf;", "brdf=mtl;", "materials refer to each other in a circle"),
        ("color=Color(0.5,0.5,0.5);\n}", "color_tex=t;\n}\nTexInvert t {\n  texture=t;\n}", "textures refer to each other in a circle"),
        ("material=mtl;", "material=w;\n}\nMtlWrapper w {\n  base_material=w;", "materials refer to each other in a circle"),
        ("geometry=mesh;", "geometry=d;\n}\nGeomDisplacedMesh d {\n  mesh=d;", "geometries refer to each other in a circle"),
        (
            "fov=1;\n}",
            "fov=1;\n}\nLightDome d {\n  dome_tex=t;\n}\nTexAColor t {\n  texture=t;\n}",
            "textures refer to each other in a circle",
        ),
    ] {
        let found = error(from, to);
        assert!(found.contains(expected), "{to}: {found}\nexpected {expected}");
    }
}

#[test]
fn layers_that_double_at_every_level_end_with_an_error() {
    let layer = |i: usize| format!("BRDFLayered l{i} {{ brdfs=List(l{0}, l{0}, l{0}); }}\n", i + 1);
    let layers: String = (0..40).map(layer).collect();
    let text = GOOD.replace("brdf=brdf;", "brdf=l0;") + &layers + "BRDFMirror l40 {}\n";
    let found = Folder::new().write("a.vrscene", text).error("a.vrscene");
    assert!(found.contains("more than 256 BRDFs"), "{found}");
}

#[test]
fn includes_that_close_a_circle_or_lead_nowhere_are_errors() {
    let folder = Folder::new();
    folder.write("a.vrscene", format!("{GOOD}#include \"b.vrscene\"\n")).write("b.vrscene", "#include \"a.vrscene\"\n");
    let found = folder.error("a.vrscene");
    assert!(found.starts_with("b.vrscene: 1:1: #include \"a.vrscene\": files include each other in a circle"), "{found}");
    // The same by paths that grow, so that no two are alike.
    folder.write("s/b.vrscene", "#include \"../s/b.vrscene\"\n").write("a.vrscene", format!("{GOOD}#include \"s/b.vrscene\"\n"));
    assert!(folder.error("a.vrscene").contains("in a circle"));
    folder.write("a.vrscene", "#include \"gone.vrscene\"\n");
    let found = folder.error("a.vrscene");
    assert!(found.contains("gone.vrscene: cannot be read") && found.contains("a.vrscene refers to it"), "{found}");
    folder.write("a.vrscene", "RenderView v {}\n");
    assert!(folder.error("a.vrscene").contains("no visible parts"));
}

#[test]
fn unsupported_things_are_reported_and_the_rest_is_read() {
    let folder = Folder::new();
    let more = "Node hair { geometry=h; material=mtl; }\nGeomHair h {}\nInstancer2 i {}\nLightAmbient l {}\nNode bare { geometry=mesh; }\nNode none {}\n";
    let imported = folder.write("a.vrscene", format!("{GOOD}{more}")).load("a.vrscene").unwrap();
    let text = warnings(&imported);
    for expected in [
        "GeomHair is not supported",
        "Instancer2: 1 of this kind",
        "LightAmbient: 1 of this kind",
        "no material",
        "no geometry",
        "does not state its unit",
    ] {
        assert!(text.contains(expected), "{expected} in {text}");
    }
    assert_eq!(imported.scene.parts.iter().map(|p| p.name.as_str()).collect::<Vec<_>>(), ["part", "bare"]);
}

#[test]
fn no_damage_makes_it_panic() {
    let folder = Folder::new();
    let mut noise = enfilade_math::Rng::new(3);
    let text = format!("{GOOD}LightSphere s {{ radius=1; }}\nCameraPhysical c {{ lens_shift=0.1; }}\n").into_bytes();
    for _ in 0..400 {
        let mut bytes = text.clone();
        for _ in 0..1 + noise.next_u64() % 3 {
            let at = noise.next_u64() as usize % bytes.len();
            match noise.next_u64() % 3 {
                0 => bytes[at] = noise.next_u64() as u8,
                1 => bytes.truncate(at.max(1)),
                _ => bytes[at] = b"0123456789(){};=,.-e\""[noise.next_u64() as usize % 21],
            }
        }
        let _ = folder.write("a.vrscene", &bytes).load("a.vrscene");
    }
}
