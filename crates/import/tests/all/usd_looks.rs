//! Looks of USD's surfaces: bindings by purpose and by collection, MaterialX by name, display colours, and prims that are damaged.

use crate::common::{Folder, png, warnings};
use enfilade_import::Imported;
use enfilade_math::{Rgb, Vec2};
use enfilade_scene::{Alpha, Bsdf, Material, Principled};

fn layer(body: &str) -> String {
    format!("#usda 1.0\n( metersPerUnit = 1 upAxis = \"Z\" )\n{body}")
}

fn load(body: &str) -> Imported {
    Folder::new().write("a.usda", layer(body)).load("a.usda").unwrap_or_else(|e| panic!("{e}"))
}

fn material<'s>(imported: &'s Imported, name: &str) -> &'s Material {
    let scene = &imported.scene;
    let part = scene.parts.iter().find(|p| p.name == name).unwrap_or_else(|| panic!("no {name}"));
    &scene.materials[part.material as usize]
}

fn principled(material: &Material) -> &Principled {
    match &material.bsdf {
        Bsdf::Principled(p) => p,
        other => panic!("not principled: {other:?}"),
    }
}

fn color(imported: &Imported, name: &str) -> Rgb {
    principled(material(imported, name)).base_color.factor
}

/// Two materials of plain colours.
const RED_AND_BLUE: &str = r#"
    def Material "Red" { token outputs:surface.connect = </Red/S.outputs:surface>
        def Shader "S" { uniform token info:id = "UsdPreviewSurface" color3f inputs:diffuseColor = (1, 0, 0) } }
    def Material "Blue" { token outputs:surface.connect = </Blue/S.outputs:surface>
        def Shader "S" { uniform token info:id = "UsdPreviewSurface" color3f inputs:diffuseColor = (0, 0, 1) } }
    "#;

const RED: Rgb = Rgb::new(1.0, 0.0, 0.0);
const BLUE: Rgb = Rgb::new(0.0, 0.0, 1.0);

/// A cube of a MaterialX surface with these inputs.
fn mtlx(kind: &str, inputs: &str) -> String {
    format!(
        r#"def Cube "C" {{ rel material:binding = </M> }}
        def Material "M" {{ float inputs:unset
            token outputs:mtlx:surface.connect = </M/S.outputs:out>
            def Shader "S" {{ uniform token info:id = "ND_{kind}_surfaceshader"
                {inputs} }}
            def Shader "T" {{ uniform token info:id = "ND_tiledimage_color3"
                asset inputs:file = @color.png@
                float2 inputs:uvtiling = (4, 2)
                float2 inputs:uvoffset = (1, 0) }} }}"#
    )
}

fn of_mtlx(kind: &str, inputs: &str) -> Material {
    material(&load(&mtlx(kind, inputs)), "C").clone()
}

#[test]
fn the_purpose_full_wins_over_nearness() {
    let imported = load(&format!(
        r#"{RED_AND_BLUE}
        def Xform "A" {{ rel material:binding:full = </Red>
            def Cube "C" {{ rel material:binding = </Blue> }} }}
        def Xform "B" {{ rel material:binding = </Red> ( bindMaterialAs = "strongerThanDescendants" )
            def Cube "C" {{ rel material:binding = </Blue> }} }}
        def Xform "D" {{ rel material:binding = </Red>
            def Cube "C" {{ rel material:binding = </Blue> }} }}"#
    ));
    assert_eq!(["A/C", "B/C", "D/C"].map(|n| color(&imported, n)), [RED, RED, BLUE]);
}

#[test]
fn collections_bind_their_members() {
    let imported = load(&format!(
        r#"{RED_AND_BLUE}
        def Xform "A" {{ rel material:binding = </Blue>
            rel material:binding:collection:some = [</A.collection:some>, </Red>]
            rel collection:some:includes = [</A/In>, </A/C>]
            rel collection:some:excludes = </A/In/Out>
            def Xform "In" {{ def Cube "C" {{ }} def Cube "Out" {{ }} }}
            def Cube "C" {{ rel material:binding = </Blue> }} }}"#
    ));
    assert_eq!(["A/In/C", "A/In/Out", "A/C"].map(|n| color(&imported, n)), [RED, BLUE, BLUE]);
}

#[test]
fn prototypes_have_the_materials_of_their_own_place() {
    let imported = load(&format!(
        r#"{RED_AND_BLUE}
        def PointInstancer "I" {{ rel material:binding = </Blue>
            point3f[] positions = [(0, 0, 0), (3, 0, 0)]
            int[] protoIndices = [0, 1]
            rel prototypes = </P/Q/C> }}
        over "P" {{ rel material:binding = </Red>
            def Xform "Q" {{ def Cube "C" {{ }} }} }}"#
    ));
    assert_eq!(color(&imported, "I[0]/P/Q/C"), RED);
    assert_eq!(imported.scene.parts.len(), 1);
    assert!(warnings(&imported).contains("found prototype 1, but there are 1"), "{}", warnings(&imported));
}

#[test]
fn emission_without_a_strength_is_that_of_the_nodes_definition() {
    let unset = "float inputs:emission.connect = </M.inputs:unset>";
    assert!(of_mtlx("standard_surface", unset).emission.factor.is_black());
    assert!(of_mtlx("standard_surface", "float inputs:emission\ncolor3f inputs:emission_color = (1, 1, 1)").emission.factor.is_black());
    assert!(of_mtlx("open_pbr_surface", "float inputs:emission_luminance").emission.factor.is_black());
    assert_eq!(of_mtlx("standard_surface", "float inputs:emission = 2").emission.factor, Rgb::splat(2.0));
    let glow = of_mtlx("gltf_pbr", "color3f inputs:emissive = (2, 0, 0)\nfloat inputs:emissive_strength = 3");
    assert_eq!(glow.emission.factor, Rgb::new(6.0, 0.0, 0.0));
}

#[test]
fn opacity_base_and_coat_of_materialx_arrive() {
    let m = of_mtlx(
        "standard_surface",
        "color3f inputs:base_color = (1, 0, 0)\nfloat inputs:base = 0.25\ncolor3f inputs:opacity = (0.25, 0.5, 0.75)\nfloat inputs:coat = 1",
    );
    assert!(matches!(m.alpha, Alpha::Blend { opacity } if opacity.factor == 0.5), "{:?}", m.alpha);
    let p = principled(&m);
    assert_eq!((p.base_color.factor, p.clearcoat.factor, p.clearcoat_roughness.factor), (Rgb::new(0.25, 0.0, 0.0), 1.0, 0.1));
    let alpha = |mode: u32| of_mtlx("gltf_pbr", &format!("float inputs:alpha = 0.25\nint inputs:alpha_mode = {mode}")).alpha;
    assert_eq!(alpha(0), Alpha::Opaque);
    assert!(matches!(alpha(1), Alpha::Mask { cutoff: 0.5, .. }) && matches!(alpha(2), Alpha::Blend { .. }));
    // MaterialX's twin of the preview surface is read as that one.
    let m = of_mtlx("UsdPreviewSurface", "float inputs:opacity = 0.5\nfloat inputs:ior = 2\ncolor3f inputs:emissiveColor = (3, 0, 0)");
    assert_eq!((principled(&m).ior, m.emission.factor), (2.0, Rgb::new(3.0, 0.0, 0.0)));
    assert!(matches!(m.alpha, Alpha::Blend { opacity } if opacity.factor == 0.5));
}

#[test]
fn tiled_images_repeat() {
    let folder = Folder::new();
    folder.write("color.png", png(1, 1, [255, 0, 0, 255]));
    folder.write("a.usda", layer(&mtlx("standard_surface", "color3f inputs:base_color.connect = </M/T.outputs:out>")));
    let imported = folder.load("a.usda").unwrap();
    let texture = principled(material(&imported, "C")).base_color.texture.unwrap();
    assert_eq!(texture.transform(Vec2::ONE), Vec2::new(3.0, 2.0));
}

#[test]
fn references_to_materialx_documents_leave_the_geometry() {
    let folder = Folder::new();
    folder.write("m.mtlx", "<?xml version=\"1.0\"?><materialx version=\"1.38\"/>");
    folder.write("a.usda", layer(r#"def Cube "C" { rel material:binding = </L/M> } def "L" ( references = @m.mtlx@</MaterialX> ) { }"#));
    let imported = folder.load("a.usda").unwrap();
    assert_eq!(imported.scene.parts.len(), 1);
    let told = warnings(&imported);
    assert!(told.contains("m.mtlx: MaterialX documents are not read") && told.contains("its material </L/M> is not there"), "{told}");
}

#[test]
fn display_colours_and_opacities_are_inherited() {
    let imported = load(
        r#"def Xform "A" { color3f[] primvars:displayColor = [(1, 0, 0)]
            float[] primvars:displayOpacity = [0.5]
            def Cube "C" { }
            def Cube "D" { color3f[] primvars:displayColor = [(0, 0, 1)] }
            def Cube "E" { rel material:binding = </M> } }
        def Cube "F" { rel material:binding = </M> }
        def Material "M" { token outputs:surface.connect = </M/S.outputs:surface>
            def Shader "S" { uniform token info:id = "UsdPreviewSurface"
                float inputs:roughness = 0.25
                color3f inputs:diffuseColor.connect = </M/R.outputs:result> }
            def Shader "R" { uniform token info:id = "UsdPrimvarReader_float3"
                string inputs:varname = "displayColor"
                float3 inputs:fallback = (0, 0, 1) } }"#,
    );
    assert_eq!(["A/C", "A/D", "A/E", "F"].map(|n| color(&imported, n)), [RED, BLUE, RED, BLUE]);
    assert!(matches!(material(&imported, "A/C").alpha, Alpha::Blend { opacity } if opacity.factor == 0.5));
    assert_eq!(principled(material(&imported, "A/E")).roughness.factor, 0.25);
}

#[test]
fn one_bad_prim_does_not_end_a_house() {
    let mesh = "int[] faceVertexCounts = [3] int[] faceVertexIndices = [0, 1, 2] uniform token subdivisionScheme = \"none\"\n";
    let imported = load(&format!(
        r#"def Cube "Good" {{ }}
        def Mesh "Short" {{ {mesh} point3f[] points = [(0, 0, 0), (1, 0, 0)] }}
        def Mesh "Uv" {{ {mesh} point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
            texCoord2f[] primvars:st = [(0, 0), (1, 0)] ( interpolation = "vertex" )
            def GeomSubset "S" {{ int[] indices = [7] rel material:binding = </M> }} }}
        def PointInstancer "I" {{ point3f[] positions = [(0, 0, 0)] int[] protoIndices = [0, 0] rel prototypes = </Good> }}"#
    ));
    let names: Vec<&str> = imported.scene.parts.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["Good", "Uv"]);
    let told = warnings(&imported);
    for expected in [
        "found point 2, but there are 2; the mesh was left out",
        "found 2 values, expected 3 (Vertex); it was left out",
        "found face 7, but there are 1",
        "found 1 positions for 2 instances; the instancer was left out",
    ] {
        assert!(told.contains(expected), "no {expected:?} in\n{told}");
    }
}

#[test]
fn a_prims_own_purpose_counts_and_what_is_left_out_is_told() {
    let imported = load(
        r#"def Xform "A" { uniform token purpose = "guide"
            def Cube "Aside" { }
            def Cube "Own" { uniform token purpose = "default" } }
        def RectLight "R" { }
        def DistantLight "S" { }
        def Camera "K" { float exposure = 2 }
        def Xform "L" ( relocates = { <Old/B> : <New/B> } ) { }"#,
    );
    let names: Vec<&str> = imported.scene.parts.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["A/Own", "R"]);
    let told = warnings(&imported);
    for expected in ["1 prims that are invisible", "dark backs keep out the sun", "the camera's exposure", "relocates were left out"] {
        assert!(told.contains(expected), "no {expected:?} in\n{told}");
    }
}

#[test]
fn expressions_and_archives_in_archives_are_named() {
    let folder = Folder::new();
    folder.write("e.usda", layer("def Cube \"Box\" { } def \"A\" ( references = @`\"${N}.usd\"`@ ) { }"));
    let told = warnings(&folder.load("e.usda").unwrap());
    assert!(told.contains("an expression of variables"), "{told}");
    folder.write("z.usda", layer("def \"A\" ( references = @in.usd@ ) { }")).write("in.usd", b"PK\x03\x04");
    assert!(folder.error("z.usda").contains("found an archive within an archive"), "{}", folder.error("z.usda"));
}
