//! USD features, one small layer each.

use crate::common::{Folder, png, warnings};
use enfilade_import::{ImportOptions, Imported, UpAxis};
use enfilade_math::{DVec3, Rgb, Vec2, Vec3};
use enfilade_scene::{Bsdf, NormalMap, Part, Principled, Scene, Wrap};

/// A triangle as the body of a mesh prim.
const TRIANGLE: &str = "int[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 2]\n\
                        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\nuniform token subdivisionScheme = \"none\"\n";

fn layer(body: &str) -> String {
    format!("#usda 1.0\n( defaultPrim = \"World\" metersPerUnit = 1 upAxis = \"Z\" )\n{}", body.replace("TRIANGLE", TRIANGLE))
}

fn load(body: &str) -> Imported {
    let folder = Folder::new();
    folder.write("a.usda", layer(body)).load("a.usda").unwrap_or_else(|e| panic!("{e}"))
}

fn names(scene: &Scene) -> Vec<&str> {
    scene.parts.iter().map(|p| p.name.as_str()).collect()
}

fn part<'s>(scene: &'s Scene, name: &str) -> &'s Part {
    scene.parts.iter().find(|p| p.name == name).unwrap_or_else(|| panic!("no {name} among {:?}", names(scene)))
}

/// The world position of a point of a part's mesh.
fn at(scene: &Scene, name: &str, point: DVec3) -> DVec3 {
    part(scene, name).world_from_mesh.transform_point3(point)
}

fn principled<'s>(scene: &'s Scene, name: &str) -> &'s Principled {
    match &scene.materials[part(scene, name).material as usize].bsdf {
        Bsdf::Principled(p) => p,
        other => panic!("not principled: {other:?}"),
    }
}

#[test]
fn units_and_axes_are_the_files_unless_the_options_say_otherwise() {
    let folder = Folder::new();
    folder.write("a.usda", format!("#usda 1.0\ndef Mesh \"M\" {{ {TRIANGLE} }}"));
    folder.write("z.usda", layer("def Mesh \"M\" { TRIANGLE }"));
    // Nothing stated: centimetres, y up.
    assert_eq!(at(&folder.load("a.usda").unwrap().scene, "M", DVec3::Y), DVec3::Z * 0.01);
    assert_eq!(at(&folder.load("z.usda").unwrap().scene, "M", DVec3::Y), DVec3::Y);
    let options = ImportOptions { meters_per_unit: 100.0, up_axis: Some(UpAxis::Z), ..ImportOptions::default() };
    assert!((at(&folder.load_with("a.usda", &options).unwrap().scene, "M", DVec3::Y) - DVec3::Y).length() < 1e-12);
}

#[test]
fn operations_on_transforms_stand_in_the_order_of_their_list() {
    let scene = load(
        r#"def Xform "A" {
            double3 xformOp:translate = (1, 2, 3)
            float xformOp:rotateZ = 90
            float3 xformOp:scale = (2, 2, 2)
            uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateZ", "xformOp:scale"]
            def Mesh "B" { TRIANGLE
                double3 xformOp:translate:pivot = (1, 0, 0)
                float3 xformOp:rotateXYZ = (90, 0, 90)
                uniform token[] xformOpOrder = ["xformOp:translate:pivot", "xformOp:rotateXYZ", "!invert!xformOp:translate:pivot"]
            }
            def Mesh "C" { TRIANGLE
                quatf xformOp:orient = (0.70710678, 0, 0, 0.70710678)
                matrix4d xformOp:transform = ((1,0,0,0), (0,1,0,0), (0,0,1,0), (5,6,7,1))
                uniform token[] xformOpOrder = ["!resetXformStack!", "xformOp:transform", "xformOp:orient"]
            }
        }"#,
    )
    .scene;
    // (1,1,0): less the pivot (0,1,0), about x to (0,0,1), about z the same, plus the pivot (1,0,1); then ×2, a quarter turn, moved.
    assert!((at(&scene, "A/B", DVec3::new(1.0, 1.0, 0.0)) - DVec3::new(1.0, 4.0, 5.0)).length() < 1e-6);
    assert!((at(&scene, "A/C", DVec3::X) - DVec3::new(5.0, 7.0, 7.0)).length() < 1e-6);
}

#[test]
fn polygons_have_holes_sides_and_values_of_every_interpolation() {
    let mesh = |more: &str| {
        load(&format!(
            "def Mesh \"M\" {{ int[] faceVertexCounts = [4, 3, 3]\nint[] faceVertexIndices = [0, 1, 2, 3, 1, 4, 2, 0, 1, 4]\n\
             point3f[] points = [(0,0,0), (1,0,0), (1,1,0), (0,1,0), (2,0,0)]\nuniform token subdivisionScheme = \"none\"\nint[] holeIndices = [2]\n{more} }}"
        ))
    };
    let plain = mesh("").scene;
    assert_eq!((plain.meshes[0].positions.len(), plain.meshes[0].triangles.len()), (5, 3));
    assert!(plain.meshes[0].normals.is_empty());
    let turned = mesh("uniform token orientation = \"leftHanded\"").scene;
    let [a, b, c] = turned.meshes[0].corners(0);
    assert!((b - a).cross(c - a).z < 0.0);
    for (interpolation, values, indices, vertices, first) in [
        ("constant", "[(0.5, 0.5)]", "", 5, Vec2::splat(0.5)),
        ("uniform", "[(0, 0), (1, 1), (2, 2)]", "", 7, Vec2::ZERO),
        ("vertex", "[(0, 0), (1, 0), (1, 1), (0, 1), (2, 0)]", "", 5, Vec2::ZERO),
        ("varying", "[(7, 8), (1, 0)]", "[0, 1, 1, 1, 0]", 5, Vec2::new(7.0, 8.0)),
        ("faceVarying", "[(0, 0), (1, 1)]", "[1, 0, 0, 0, 0, 0, 0, 0, 0, 0]", 5, Vec2::ONE),
    ] {
        let indices = if indices.is_empty() { String::new() } else { format!("int[] primvars:st:indices = {indices}") };
        let scene = mesh(&format!("texCoord2f[] primvars:st = {values} ( interpolation = \"{interpolation}\" )\n{indices}")).scene;
        assert_eq!((scene.meshes[0].uvs.len(), scene.meshes[0].uvs[0]), (vertices, first), "{interpolation}");
    }
    let scene = mesh("normal3f[] normals = [(0, 0, 2), (0, 1, 0), (1, 0, 0)] ( interpolation = \"uniform\" )").scene;
    assert_eq!((scene.meshes[0].normals[0], scene.meshes[0].positions.len()), (Vec3::Z, 7));
}

#[test]
fn the_composition_of_layers_follows_the_order_of_strength() {
    let folder = Folder::new();
    folder.write(
        "chair.usda",
        layer(
            r#"def Xform "World" ( variants = { string size = "small" } prepend variantSets = "size" ) {
                custom float strength = 1
                variantSet "size" = {
                    "small" { over "Seat" { double3 xformOp:translate = (1, 0, 0) } }
                    "large" { over "Seat" { double3 xformOp:translate = (9, 0, 0) } def Cube "Extra" { double size = 1 } }
                }
                def Mesh "Seat" { TRIANGLE
                    double3 xformOp:translate = (5, 5, 5)
                    uniform token[] xformOpOrder = ["xformOp:translate"]
                    rel material:binding = </World/Wood>
                }
                def Material "Wood" {
                    token outputs:surface.connect = </World/Wood/S.outputs:surface>
                    def Shader "S" { uniform token info:id = "UsdPreviewSurface"
                        color3f inputs:diffuseColor = (0.25, 0.5, 0.75)
                        token outputs:surface }
                }
            }"#,
        ),
    );
    folder.write("sub.usda", layer(r#"over "Room" { over "Chair_1" { over "Seat" { double3 xformOp:translate = (0, 0, 3) } } }"#));
    let root = layer(
        r#"class "_Lamp" { double size = 4 }
        def Xform "Room" {
            def "Chair_1" ( references = @./chair.usda@ ) { }
            def "Chair_2" ( payload = @chair.usda@</World> variants = { string size = "large" } ) { }
            def "Chair_3" ( prepend references = </Room/Chair_2> instanceable = true ) { }
            def Cube "Lamp" ( inherits = </_Lamp> ) { }
            def Cube "Off" ( active = false ) { }
            def Cube "Hidden" { token visibility = "invisible" }
            def Cube "Guide" { uniform token purpose = "guide" }
            over "Nothing" { def Cube "C" { } }
        }"#,
    );
    folder.write("room.usda", root.replace("( defaultPrim", "( subLayers = [@sub.usda@] defaultPrim"));
    let imported = folder.load("room.usda").unwrap();
    let scene = &imported.scene;
    let expected = ["Room/Chair_1/Seat", "Room/Chair_2/Seat", "Room/Chair_2/Extra", "Room/Chair_3/Seat", "Room/Chair_3/Extra", "Room/Lamp"];
    assert_eq!(names(scene), expected);
    // A sublayer is stronger than a reference, a chosen variant weaker than what is stated outright.
    assert_eq!(at(scene, "Room/Chair_1/Seat", DVec3::ZERO), DVec3::Z * 3.0);
    assert_eq!(at(scene, "Room/Chair_2/Seat", DVec3::ZERO), DVec3::splat(5.0));
    assert_eq!(part(scene, "Room/Chair_2/Extra").mesh, part(scene, "Room/Chair_3/Extra").mesh);
    assert_eq!(scene.meshes[part(scene, "Room/Lamp").mesh as usize].bounds().max, Vec3::splat(2.0));
    // Bindings within a reference lead to the material beside it.
    for chair in ["Room/Chair_1/Seat", "Room/Chair_2/Seat", "Room/Chair_3/Seat"] {
        assert_eq!(principled(scene, chair).base_color.factor, Rgb::new(0.25, 0.5, 0.75));
    }
    assert!(warnings(&imported).contains("2 prims that are invisible"));
    assert_eq!(imported.inputs.len(), 3);
}

#[test]
fn a_purpose_without_a_type_and_inactive_instances_are_as_in_openusd() {
    let folder = Folder::new();
    let root = layer(
        r#"def Xform "Room" {
            def "Untyped" { token purpose = "guide" def Cube "Seen" { } }
            def Xform "Typed" { uniform token purpose = "guide" def "Below" { def Cube "Aside" { } } }
            def PointInstancer "I" ( inactiveIds = [7] ) {
                int64[] ids = [5, 7, 9] int64[] invisibleIds = [9]
                point3f[] positions = [(0, 0, 0), (4, 0, 0), (8, 0, 0)] int[] protoIndices = [0, 0, 0]
                rel prototypes = </Room/I/Box>
                def Cube "Box" { }
            }
        }"#,
    );
    folder.write("room.usda", root);
    assert_eq!(names(&folder.load("room.usda").unwrap().scene), ["Room/Untyped/Seen", "I[0]/Room/I/Box"]);
}

#[test]
fn references_that_lead_back_are_left_out() {
    let folder = Folder::new();
    folder.write("a.usda", layer(r#"def "World" ( references = @b.usda@ ) { }"#));
    folder.write("b.usda", layer(r#"def "World" { def Cube "X" ( references = @a.usda@ ) { } }"#));
    // As Blender writes instances of curves.
    folder.write("c.usda", layer(r#"def "Ring" { def Cube "Ring" { } def "Ring_0" ( prepend references = </Ring> ) { } }"#));
    for (file, expected, place) in [("a.usda", vec!["World/X"], "World/X"), ("c.usda", vec!["Ring/Ring"], "Ring/Ring_0")] {
        let imported = folder.load(file).unwrap();
        assert_eq!(names(&imported.scene), expected);
        let told = warnings(&imported);
        assert!(told.contains("it refers to itself, by way of <") && told.contains("left out"), "{place}: {told}");
    }
}

#[test]
fn scenes_are_read_without_layers_that_are_not_there() {
    let folder = Folder::new();
    folder.write("in.usdz", stored_archive("in.usda", &layer("def Cube \"Inner\" { }")));
    let cases = [
        ("payload = @gone.usd@", "Prop> in a.usda: it refers to", "gone.usd, which cannot be read (No such file"),
        ("references = [@./lost/gone.usd@</A>]", "Prop> in a.usda", "put the file there or correct the reference"),
        ("payload = @https://example.org/y.usd@", "Prop> in a.usda", "https is not fetched"),
        ("references = @omniverse://x/y.usd@", "Prop> in a.usda", "omniverse is not fetched"),
        ("references = @in.usdz[other.usda]@", "Prop> in a.usda", "it refers to other.usda, which is not in the archive in.usdz"),
    ];
    for (arc, place, problem) in cases {
        let text = format!("def Xform \"World\" {{ def Cube \"Box\" {{ }} def \"Prop\" ( {arc} ) {{ }} def \"Again\" ( {arc} ) {{ }} }}");
        let imported = folder.write("a.usda", layer(&text)).load("a.usda").unwrap_or_else(|e| panic!("{arc}: {e}"));
        assert_eq!(names(&imported.scene), ["World/Box"], "{arc}");
        let told = warnings(&imported);
        assert!(told.contains(place) && told.contains(problem), "{arc}: {told}");
        assert_eq!(told.lines().count(), 1, "{arc}: {told}");
    }
    folder
        .write("s.usda", "#usda 1.0\n( subLayers = [@gone.usda@, @box.usda@] metersPerUnit = 1 )\n")
        .write("box.usda", layer("def Cube \"Box\" { }"));
    let imported = folder.load("s.usda").unwrap();
    assert_eq!(names(&imported.scene), ["Box"]);
    assert!(warnings(&imported).contains("subLayers of s.usda: it refers to"), "{}", warnings(&imported));
    assert_eq!(imported.missing, [folder.path("gone.usda")]);
    // What is there but no layer is still an error, and so is the scene file itself.
    folder.write("b.usda", layer("def Cube \"Box\" { } def \"Prop\" ( references = @bad.usd@ ) { }")).write("bad.usd", "no layer");
    assert!(folder.error("b.usda").contains("found neither `#usda` nor `PXR-USDC`"), "{}", folder.error("b.usda"));
    assert!(folder.error("nowhere.usda").starts_with("nowhere.usda: cannot be read"), "{}", folder.error("nowhere.usda"));
}

/// An archive of one file, without compression.
fn stored_archive(name: &str, text: &str) -> Vec<u8> {
    let mut zip = zip::write::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    let stored = zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
    zip.start_file(name, stored).unwrap();
    std::io::Write::write_all(&mut zip, text.as_bytes()).unwrap();
    zip.finish().unwrap().into_inner()
}

#[test]
fn the_first_sample_comes_before_the_value_without_time_of_the_same_layer() {
    let folder = Folder::new();
    let weaker = r#"def Cube "Box" { double size = 100
        double size.timeSamples = { 3: 3, 1: 1 } }
        def Cube "Shown" { token visibility = "invisible"
        token visibility.timeSamples = { 1: "inherited" } }
        def Cube "Plain" { double size = 4
        double size.timeSamples = { } }
        def Cube "Blocked" { double size = 7
        double size.timeSamples = { 0: None } }"#;
    folder.write("weaker.usda", layer(weaker));
    folder.write("stronger.usda", "#usda 1.0\n( subLayers = [@weaker.usda@] metersPerUnit = 1 )\nover \"Box\" { double size = 5 }\n");
    let size = |file: &str, name: &str| {
        let scene = folder.load(file).unwrap().scene;
        let part = part(&scene, name);
        scene.meshes[part.mesh as usize].positions.iter().map(|p| part.world_from_mesh.transform_point3(p.as_dvec3()).x).fold(0.0, f64::max)
            * 2.0
    };
    // A cube of the default size is 2 units wide.
    for (name, expected) in [("Box", 1.0), ("Shown", 2.0), ("Plain", 4.0), ("Blocked", 2.0)] {
        assert!((size("weaker.usda", name) - expected).abs() < 1e-6, "{name}");
    }
    // The value of a stronger layer counts before all samples of a weaker one.
    assert!((size("stronger.usda", "Box") - 5.0).abs() < 1e-6);
}

#[test]
fn circles_of_layers_and_endless_references_are_errors_that_name_them() {
    let folder = Folder::new();
    folder.write("s.usda", "#usda 1.0\n( subLayers = [@s.usda@] )\n");
    assert!(folder.error("s.usda").contains("sublayers refer to each other in a circle, or are nested too deep: s.usda → s.usda"));
    // References that multiply: 2^40 prims of 80.
    let mut doubling = String::new();
    for i in 0..40 {
        doubling +=
            &format!("def \"L{i}\" {{ def \"a\" ( references = </L{n}> ) {{ }} def \"b\" ( references = </L{n}> ) {{ }} }}\n", n = i + 1);
    }
    folder.write("d.usda", layer(&format!("{doubling} def Cube \"L40\" {{ }}")));
    assert!(folder.error("d.usda").contains("prims"), "{}", folder.error("d.usda"));
}

#[test]
fn preview_surfaces_and_their_textures_become_principled() {
    let folder = Folder::new();
    folder.write("tex/color.png", png(2, 2, [255, 0, 0, 128])).write("tex/normal.png", png(1, 1, [128, 128, 255, 255]));
    folder.write(
        "a.usda",
        layer(
            r#"def Mesh "M" ( apiSchemas = ["MaterialBindingAPI"] ) { TRIANGLE
            rel material:binding = </Looks/Paint>
            texCoord2f[] primvars:uv1 = [(0, 0), (1, 0), (0, 1)] ( interpolation = "vertex" ) }
        def Scope "Looks" { def Material "Paint" {
            float inputs:rough = 0.25
            token outputs:surface.connect = </Looks/Paint/G.outputs:out>
            def NodeGraph "G" {
                token outputs:out.connect = </Looks/Paint/G/S.outputs:surface>
                def Shader "S" { uniform token info:id = "UsdPreviewSurface"
                    color3f inputs:diffuseColor.connect = </Looks/Paint/G/T.outputs:rgb>
                    float inputs:opacity.connect = </Looks/Paint/G/T.outputs:a>
                    float inputs:opacityThreshold = 0.4
                    float inputs:roughness.connect = </Looks/Paint.inputs:rough>
                    float inputs:metallic.connect = </Looks/Paint/G/B.outputs:g>
                    normal3f inputs:normal.connect = </Looks/Paint/G/N.outputs:rgb>
                    color3f inputs:emissiveColor = (1, 2, 3)
                    float inputs:ior = 1.4
                    float inputs:clearcoat = 0.5
                    token outputs:surface }
                def Shader "T" { uniform token info:id = "UsdUVTexture"
                    asset inputs:file = @tex/color.png@
                    float2 inputs:st.connect = </Looks/Paint/G/X.outputs:result>
                    token inputs:wrapS = "clamp"
                    token inputs:wrapT = "mirror"
                    float4 inputs:scale = (0.5, 1, 1, 1) }
                def Shader "B" { uniform token info:id = "UsdUVTexture"
                    asset inputs:file = @./tex/color.png@
                    token inputs:sourceColorSpace = "raw"
                    float4 inputs:bias = (0, 0.25, 0, 0) }
                def Shader "N" { uniform token info:id = "UsdUVTexture"
                    asset inputs:file = @tex/normal.png@
                    float4 inputs:scale = (2, 2, 2, 1)
                    float4 inputs:bias = (-1, -1, -1, 0)
                    token inputs:sourceColorSpace = "raw" }
                def Shader "X" { uniform token info:id = "UsdTransform2d"
                    float inputs:rotation = 90
                    float2 inputs:scale = (2, 3)
                    float2 inputs:translation = (0.5, 0)
                    float2 inputs:in.connect = </Looks/Paint/G/P.outputs:result> }
                def Shader "P" { uniform token info:id = "UsdPrimvarReader_float2"
                    string inputs:varname = "uv1" }
            } } }"#,
        ),
    );
    let imported = folder.load("a.usda").unwrap();
    let scene = &imported.scene;
    assert!(imported.report.warnings.is_empty(), "{}", warnings(&imported));
    let p = principled(scene, "M");
    let material = &scene.materials[part(scene, "M").material as usize];
    assert_eq!((material.name.as_str(), p.ior, p.roughness.factor, p.clearcoat.factor), ("Paint", 1.4, 0.25, 0.5));
    assert_eq!((p.base_color.factor, material.emission.factor), (Rgb::new(0.5, 1.0, 1.0), Rgb::new(1.0, 2.0, 3.0)));
    let texture = p.base_color.texture.unwrap();
    assert_eq!(texture.wrap, [Wrap::Clamp, Wrap::Mirror]);
    // (1, 0) is scaled to (2, 0), turned to (0, 2), moved to (0.5, 2).
    assert!((texture.transform(Vec2::X) - Vec2::new(0.5, 2.0)).length() < 1e-6);
    assert!(matches!(material.alpha, enfilade_scene::Alpha::Mask { cutoff: 0.4, opacity } if opacity.texture.unwrap().1 == 3));
    assert!(matches!(material.normal_map, Some(NormalMap::Normal { scale: 1.0, .. })));
    // Metallic: green 0 plus 0.25.
    let (metallic, channel) = p.metallic.texture.unwrap();
    assert_eq!((p.metallic.factor, channel, scene.images[metallic.image as usize].texel(0, 0).0.r), (1.0, 0, 0.25));
    assert_eq!(scene.meshes[0].uvs, [Vec2::ZERO, Vec2::X, Vec2::Y]);
    std::fs::remove_file(folder.path("tex/normal.png")).unwrap();
    assert!(folder.error("a.usda").contains("material </Looks/Paint> needs the texture"));
}

/// Blender's output for MaterialX: with a preview surface, and with its viewport's colour in place of one.
fn blender(preview: &str, open_pbr: &str) -> String {
    layer(&format!(
        r#"def Mesh "M" ( apiSchemas = ["MaterialBindingAPI"] ) {{ TRIANGLE
            rel material:binding = </P> }}
        def Material "P" {{
            token outputs:mtlx:surface.connect = </P/Open.outputs:surface>
            token outputs:surface.connect = </P/{preview}.outputs:surface>
            def Shader "previewShader" {{ uniform token info:id = "UsdPreviewSurface"
                color3f inputs:diffuseColor = (0.8, 0.8, 0.8) }}
            def Shader "Plain" {{ uniform token info:id = "UsdPreviewSurface"
                color3f inputs:diffuseColor = (0.5, 0.25, 0)
                float inputs:clearcoat = 1 }}
            def Shader "Glowing" {{ uniform token info:id = "UsdPreviewSurface"
                color3f inputs:emissiveColor.connect = </P/Glow.outputs:rgb> }}
            def Shader "Glow" {{ uniform token info:id = "UsdUVTexture"
                asset inputs:file = @color.png@ }}
            def Shader "Open" {{ uniform token info:id = "ND_open_pbr_surface_surfaceshader"
                float3 inputs:geometry_tangent.connect = </P/N.outputs:tangent>
                {open_pbr} }}
            def NodeGraph "N" {{
                float3 outputs:tangent.connect = </P/N/Tangent.outputs:out>
                color3f outputs:color.connect = </P/N/Color.outputs:out>
                float outputs:blue.connect = </P/N/Blue.outputs:out>
                def Shader "Tangent" {{ uniform token info:id = "ND_tangent_vector3" }}
                def Shader "Color" {{ uniform token info:id = "ND_convert_color4_color3"
                    color4f inputs:in.connect = </P/N/Image.outputs:out> }}
                def Shader "Blue" {{ uniform token info:id = "ND_extract_vector4"
                    int inputs:index = 2
                    float4 inputs:in.connect = </P/N/Image.outputs:out> }}
                def Shader "Image" {{ uniform token info:id = "ND_image_color4"
                    asset inputs:file = @color.png@ ( colorSpace = "srgb_texture" )
                    float2 inputs:texcoord.connect = </P/N/At.outputs:out>
                    string inputs:uaddressmode = "clamp" }}
                def Shader "At" {{ uniform token info:id = "ND_texcoord_vector2" }} }} }}"#
    ))
}

#[test]
fn materialx_is_taken_where_the_preview_surface_only_stands_in_for_it() {
    let folder = Folder::new();
    folder.write("color.png", png(1, 1, [255, 0, 0, 255]));
    let load = |preview: &str, open_pbr: &str| {
        let imported = folder.write("a.usda", blender(preview, open_pbr)).load("a.usda").unwrap();
        let told = warnings(&imported);
        (imported.scene, told)
    };
    let picture = "color3f inputs:base_color.connect = </P/N.outputs:color>\nfloat inputs:specular_roughness.connect = </P/N.outputs:blue>";
    for preview in ["previewShader", "Plain"] {
        let (scene, told) = load(preview, picture);
        let p = principled(&scene, "M");
        let texture = p.base_color.texture.unwrap();
        assert_eq!((texture.wrap, p.roughness.texture.unwrap().1), ([Wrap::Clamp, Wrap::Repeat], 2));
        assert!(told.contains("its surface is \"ND_open_pbr_surface_surfaceshader\""), "{told}");
    }
    let (scene, _) = load("previewShader", "color3f inputs:base_color = (0.6, 0.1, 0.1)\nfloat inputs:geometry_opacity = 0.5");
    assert_eq!(principled(&scene, "M").base_color.factor, Rgb::new(0.6, 0.1, 0.1));
    let material = &scene.materials[part(&scene, "M").material as usize];
    assert!(matches!(material.alpha, enfilade_scene::Alpha::Blend { opacity } if opacity.factor == 0.5));
    // A complete preview surface is kept, and what is not taken from MaterialX is reported.
    let (scene, told) = load("Plain", "color3f inputs:base_color = (0.5, 0.25, 0)");
    assert_eq!((principled(&scene, "M").clearcoat.factor, principled(&scene, "M").transmission.factor), (1.0, 0.0));
    assert!(told.contains("beside its UsdPreviewSurface it has a \"ND_open_pbr_surface_surfaceshader\""), "{told}");
}

#[test]
fn preview_surfaces_take_glass_and_strength_of_emission_from_materialx() {
    let folder = Folder::new();
    folder.write("color.png", png(1, 1, [255, 0, 0, 255]));
    let load = |preview: &str, open_pbr: &str| folder.write("a.usda", blender(preview, open_pbr)).load("a.usda").unwrap().scene;
    for (thin, solid) in [("", true), ("bool inputs:geometry_thin_walled = 1", false)] {
        let scene = load("Plain", &format!("float inputs:transmission_weight = 1\n{thin}"));
        let p = principled(&scene, "M");
        assert_eq!((p.transmission.factor, p.solid, p.clearcoat.factor), (1.0, solid, 1.0));
    }
    let scene = load("Glowing", "float inputs:emission_luminance = 4");
    let emission = &scene.materials[part(&scene, "M").material as usize].emission;
    assert_eq!((emission.factor, emission.texture.is_some()), (Rgb::splat(4.0), true));
}
