//! USD's lights, cameras, shapes and labels, with known answers.

use crate::common::{Folder, png, warnings};
use enfilade_import::Imported;
use enfilade_math::{DVec3, Rgb, Vec2, Vec3};
use enfilade_scene::{Environment, Filter, Light, Scene, SpotFalloff, TextureRef, uv_from_direction};
use std::f32::consts::PI;

/// 10 candela in every direction of the lower half, 20π lumens.
const HALF: &str = "IES:LM-63-2019\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 9\n0 90\n0\n10 10\n";

fn load(body: &str) -> Imported {
    let folder = Folder::new();
    folder.write("sky.png", png(8, 4, [255; 4])).write("half.ies", HALF).write("dark.ies", HALF.replace("10 10", "0 0"));
    folder.write("a.usda", format!("#usda 1.0\n( metersPerUnit = 0.5 upAxis = \"Z\" )\ndef Cube \"Box\" {{ }}\n{body}"));
    folder.load("a.usda").unwrap_or_else(|e| panic!("{e}"))
}

/// A PNG of these pixels, row by row.
fn picture_of(width: u32, height: u32, pixels: &[[u8; 4]]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let picture = image::RgbaImage::from_raw(width, height, pixels.concat()).unwrap();
    picture.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

fn radiance(scene: &Scene, name: &str) -> Rgb {
    let part = scene.parts.iter().find(|p| p.name == name).unwrap_or_else(|| panic!("no {name}"));
    scene.materials[part.material as usize].emission.factor
}

#[test]
fn surfaces_emit_what_intensity_exposure_and_area_say() {
    let scene = load(
        r#"def DiskLight "Disk" { float inputs:intensity = 3
            float inputs:exposure = 1
            color3f inputs:color = (1, 0.5, 0)
            double3 xformOp:translate = (0, 0, 4)
            uniform token[] xformOpOrder = ["xformOp:translate"] }
        def SphereLight "Ball" { float inputs:intensity = 10
            bool inputs:normalize = true
            float inputs:radius = 1
            float3 xformOp:scale = (2, 2, 2)
            uniform token[] xformOpOrder = ["xformOp:scale"] }
        def CylinderLight "Tube" { bool inputs:normalize = true
            float intensity = 1 }
        def Mesh "Panel" ( apiSchemas = ["MeshLightAPI"] ) { int[] faceVertexCounts = [4]
            int[] faceVertexIndices = [0, 1, 2, 3]
            point3f[] points = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)]
            uniform token subdivisionScheme = "none"
            bool inputs:normalize = true
            float inputs:intensity = 2 }"#,
    )
    .scene;
    assert_eq!(radiance(&scene, "Disk"), Rgb::new(6.0, 3.0, 0.0));
    // 10 over the sphere of radius 2, 4π·4 square units; 1 over π square units of tube; 2 over 4 square units.
    assert!((radiance(&scene, "Ball").r - 10.0 / (16.0 * PI)).abs() < 1e-5);
    assert!((radiance(&scene, "Tube").r - 1.0 / PI).abs() < 1e-5);
    assert_eq!(radiance(&scene, "Panel"), Rgb::splat(0.5));
    let disk = scene.parts.iter().find(|p| p.name == "Disk").unwrap();
    let [a, b, c] = scene.world_corners(disk, 0);
    assert!((b - a).cross(c - a).z < 0.0 && (a.z - 2.0).abs() < 1e-6);
}

/// The luminous power of a part's light: ∫ π L dA.
fn power(scene: &Scene, name: &str) -> f64 {
    let part = scene.parts.iter().find(|p| p.name == name).unwrap();
    let triangles = scene.meshes[part.mesh as usize].triangles.len();
    let area = |t| {
        let [a, b, c] = scene.world_corners(part, t);
        f64::from((b - a).cross(c - a).length()) / 2.0
    };
    (0..triangles).map(area).sum::<f64>() * std::f64::consts::PI * f64::from(radiance(scene, name).r)
}

#[test]
fn spheres_have_few_triangles_and_the_power_of_true_ones() {
    let scene = load(
        r#"def SphereLight "Ball" { float inputs:intensity = 3
            float inputs:radius = 0.5 }
        def SphereLight "Egg" { float inputs:intensity = 3
            bool inputs:normalize = true
            float inputs:radius = 1
            float3 xformOp:scale = (1, 2, 3)
            uniform token[] xformOpOrder = ["xformOp:scale"] }"#,
    )
    .scene;
    // 4πr²·π·L with r = 0.5 units of 0.5 m; normalized, π·L over the units' area, which metres make a quarter.
    let exact = 4.0 * std::f64::consts::PI.powi(2) * 0.0625 * 3.0;
    assert!((power(&scene, "Ball") / exact - 1.0).abs() < 1e-5, "{} {exact}", power(&scene, "Ball"));
    let exact = std::f64::consts::PI * 3.0 * 0.25;
    assert!((power(&scene, "Egg") / exact - 1.0).abs() < 1e-5, "{} {exact}", power(&scene, "Egg"));
    assert!(scene.meshes.iter().all(|mesh| mesh.triangles.len() < 600), "{:?}", scene.meshes.iter().map(|m| m.triangles.len()).max());
}

#[test]
fn pictures_of_panels_have_their_minimum_at_plus_x_plus_y() {
    // Red and green above, blue and white below; UsdLux: "min coordinates should be at (+X, +Y) and max coordinates at (-X, -Y)".
    let folder = Folder::new();
    let colors = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [255, 255, 255, 255]];
    folder.write("four.png", picture_of(2, 2, &colors));
    folder.write(
        "a.usda",
        "#usda 1.0\n( metersPerUnit = 1 upAxis = \"Z\" )\ndef RectLight \"Panel\" { asset inputs:texture:file = @four.png@\n\
         float inputs:width = 4\nfloat inputs:height = 2 }",
    );
    let scene = folder.load("a.usda").unwrap_or_else(|e| panic!("{e}")).scene;
    let part = scene.parts.iter().find(|p| p.name == "Panel").unwrap();
    let texture = scene.materials[part.material as usize].emission.texture.unwrap();
    let mesh = &scene.meshes[part.mesh as usize];
    let at = |x: f32, y: f32| {
        let corner = mesh.positions.iter().position(|p| (p.x, p.y) == (x, y)).unwrap();
        let inward = 0.25 * (Vec2::splat(0.5) - mesh.uvs[corner]);
        scene.images[texture.image as usize]
            .sample(&TextureRef { filter: Filter::Nearest, ..texture }, mesh.uvs[corner] + inward)
            .0
            .to_array()
    };
    assert_eq!([at(2.0, 1.0), at(-2.0, 1.0)], [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!([at(2.0, -1.0), at(-2.0, -1.0)], [[0.0, 0.0, 1.0], [1.0; 3]]);
}

#[test]
fn points_spots_and_suns_keep_their_intensity() {
    let scene = load(
        r#"def SphereLight "Bulb" { float inputs:intensity = 8
            bool treatAsPoint = true
            float inputs:radius = 0.5 }
        def SphereLight "Spot" { bool inputs:normalize = true
            float inputs:intensity = 12
            float inputs:shaping:cone:angle = 30
            float inputs:shaping:cone:softness = 0.5 }
        def DistantLight "Sun" { float inputs:intensity = 7
            bool inputs:normalize = true
            float inputs:angle = 2
            float xformOp:rotateX = 90
            uniform token[] xformOpOrder = ["xformOp:rotateX"] }
        def DistantLight "Moon" { float inputs:intensity = 100
            float inputs:angle = 10 }"#,
    )
    .scene;
    let [Light::Point { intensity, .. }, spot, sun, moon] = &scene.lights[..] else { panic!("{:?}", scene.lights) };
    // L·πr² in units of half a metre.
    assert!((intensity.g - 8.0 * PI * 0.25 * 0.25).abs() < 1e-3, "{intensity:?}");
    let Light::Spot { intensity, inner_rad, outer_rad, direction, falloff: SpotFalloff::SmoothAngle, .. } = spot else {
        panic!("{spot:?}")
    };
    assert!((intensity.g - 12.0 / 4.0 * 0.25).abs() < 1e-5 && *direction == Vec3::NEG_Z);
    assert!((inner_rad.to_degrees() - 15.0).abs() < 1e-4 && (outer_rad.to_degrees() - 30.0).abs() < 1e-4);
    let Light::Directional { direction, irradiance, angular_radius_rad, .. } = sun else { panic!("{sun:?}") };
    assert!((*direction - Vec3::Y).length() < 1e-6 && irradiance.g == 7.0 && (angular_radius_rad.to_degrees() - 1.0).abs() < 1e-5);
    let Light::Directional { irradiance, .. } = moon else { panic!("{moon:?}") };
    assert!((irradiance.g - 100.0 * PI * 5.0f32.to_radians().sin().powi(2)).abs() < 1e-4);
}

#[test]
fn normalized_profiles_keep_the_power_of_the_light() {
    let lamp = |more: &str| {
        let imported = load(&format!(
            "def SphereLight \"Lamp\" {{ bool inputs:normalize = true\nfloat inputs:intensity = 12\n\
             asset inputs:shaping:ies:file = @half.ies@\n{more} }}"
        ));
        let [Light::Profile { intensity, .. }] = imported.scene.lights[..] else { panic!("{:?}", imported.scene.lights) };
        (intensity.g, warnings(&imported))
    };
    // The sphere's intensity, in units of half a metre: 12 / 4 everywhere, so 12π of power.
    let (intensity, told) = lamp("");
    assert!((intensity - 3.0 * 0.25).abs() < 1e-6, "{intensity}");
    assert!(told.contains("a point of its intensity times the profile's candela") && !told.contains("left out"), "{told}");
    let (intensity, told) = lamp("bool inputs:shaping:ies:normalize = true");
    // In half of all directions it is twice as strong: 0.15 times 10 candela.
    assert!((intensity - 0.15).abs() < 1e-5, "{intensity}");
    assert!(told.contains("made a point of the same power"), "{told}");
    let (intensity, told) = lamp("bool inputs:shaping:ies:normalize = true\nbool treatAsPoint = true");
    assert!((intensity - 0.15).abs() < 1e-5 && told.is_empty(), "{told}");
    let dark = load("def SphereLight \"Lamp\" { asset inputs:shaping:ies:file = @dark.ies@\nbool inputs:shaping:ies:normalize = true }");
    assert!(warnings(&dark).contains("profile is dark, so it could not be normalized"), "{}", warnings(&dark));
}

#[test]
fn shaping_that_points_do_not_have_is_reported() {
    let told = |body: &str| warnings(&load(&format!("def SphereLight \"Lamp\" {{ {body} }}")));
    let profile = "asset inputs:shaping:ies:file = @half.ies@\n";
    for (body, what) in [
        ("bool treatAsPoint = true\nfloat inputs:shaping:focus = 2".to_string(), "focus"),
        ("float inputs:shaping:cone:angle = 30\nfloat inputs:shaping:focus = 2".to_string(), "focus"),
        (format!("{profile}float inputs:shaping:focus = 2"), "focus"),
        (format!("{profile}float inputs:shaping:cone:angle = 30"), "cone"),
        (format!("{profile}float inputs:shaping:ies:angleScale = 0.5"), "profile's angle scale"),
    ] {
        let told = told(&body);
        assert!(told.contains(&format!("the light's {what} was left out")), "{body}: {told}");
    }
    let cone = told("float inputs:shaping:cone:angle = 30\nfloat inputs:shaping:ies:angleScale = 0.5");
    assert!(cone.contains("a point of the same intensity") && !cone.contains("left out"), "{cone}");
}

/// A quarter is what all versions of Blender write that write `normalize`, which older ones did not; other programs write the whole.
#[test]
fn suns_of_blender_are_as_strong_as_in_blender() {
    let folder = Folder::new();
    for (doc, normalized, expected, told) in
        [("Blender v4.5.0", true, 3.0, true), ("Blender v3.0.0", false, 0.0, false), ("Maya", true, 0.75, false)]
    {
        let metadata = format!("doc = \"{doc}\" metersPerUnit = 1 upAxis = \"Z\"");
        let normalize = if normalized { "bool inputs:normalize = 1" } else { "" };
        let sun = format!("def DistantLight \"Sun\" {{ float inputs:intensity = 0.75\nfloat inputs:angle = 0.5\n{normalize} }}");
        folder.write("a.usda", format!("#usda 1.0\n( {metadata} )\ndef Cube \"Box\" {{ }}\n{sun}"));
        let imported = folder.load("a.usda").unwrap();
        let [Light::Directional { irradiance, angular_radius_rad, .. }] = imported.scene.lights[..] else {
            panic!("{:?}", imported.scene.lights)
        };
        assert!((irradiance.g - expected).abs() < 1e-4, "{doc}: {irradiance:?}");
        let across: f32 = if told { 1.0 } else { 0.5 };
        assert!((2.0 * angular_radius_rad - across.to_radians()).abs() < 1e-6, "{doc}: {angular_radius_rad}");
        assert_eq!(warnings(&imported).contains("four times as strong"), told, "{doc}");
    }
}

#[test]
fn spots_of_blender_dim_as_in_blender() {
    let folder = Folder::new();
    let shaping = "float inputs:shaping:cone:angle = 60\nfloat inputs:shaping:cone:softness = 0.5";
    for (doc, inner, law) in
        [("Blender v4.5.0", 0.75f32.acos(), SpotFalloff::SmoothCosine), ("Maya", 30f32.to_radians(), SpotFalloff::SmoothAngle)]
    {
        let spot = format!("def SphereLight \"Spot\" {{ float inputs:intensity = 1\nbool inputs:normalize = 1\n{shaping} }}");
        folder.write("a.usda", format!("#usda 1.0\n( doc = \"{doc}\" metersPerUnit = 1 )\ndef Cube \"Box\" {{ }}\n{spot}"));
        let imported = folder.load("a.usda").unwrap();
        let [Light::Spot { inner_rad, outer_rad, falloff, .. }] = imported.scene.lights[..] else { panic!("{:?}", imported.scene.lights) };
        assert!((inner_rad - inner).abs() < 1e-6 && (outer_rad - 60f32.to_radians()).abs() < 1e-6, "{doc}: {inner_rad}, {outer_rad}");
        assert_eq!(falloff, law, "{doc}");
    }
}

#[test]
fn lights_of_the_default_temperature_are_white() {
    for stated in ["", "float inputs:colorTemperature = 6500"] {
        let found = radiance(&load(&format!("def DiskLight \"D\" {{ bool inputs:enableColorTemperature = 1\n{stated} }}")).scene, "D");
        assert!([found.r, found.g, found.b].iter().all(|c| (c - 1.0).abs() < 1e-6), "{found:?}");
    }
}

/// Black bodies of `UsdLux.BlackbodyTemperatureAsRgb`, divided by the one of 6500 K, which is to be white.
#[test]
fn colour_temperatures_agree_with_usdlux() {
    let white = (1.043_33, 0.983_62, 1.034_61);
    for (kelvin, r, g, b) in
        [(3000.0, 1.771_03, 0.844_29, 0.272_03), (6500.0, 1.043_33, 0.983_62, 1.034_61), (10_000.0, 0.871_84, 0.994_69, 1.43)]
    {
        let body = format!("def DiskLight \"D\" {{ bool inputs:enableColorTemperature = 1\nfloat inputs:colorTemperature = {kelvin} }}");
        let found = radiance(&load(&body).scene, "D");
        let (r, g, b) = (r / white.0, g / white.1, b / white.2);
        assert!((found.r - r).abs() < 0.03 && (found.g - g).abs() < 0.03 && (found.b - b).abs() < 0.03, "{kelvin}: {found:?}");
    }
}

#[test]
fn domes_have_their_middle_along_z_and_their_pole_up() {
    let map = |body: &str| match load(body).scene.environment {
        Some(Environment::Map { map_from_world, scale, .. }) => (map_from_world, scale),
        other => panic!("no map: {other:?}"),
    };
    let (m, scale) = map("def DomeLight \"D\" { asset inputs:texture:file = @sky.png@\nfloat inputs:intensity = 2 }");
    assert_eq!(scale, Rgb::splat(2.0));
    let uv = |d: Vec3| uv_from_direction(m * d);
    // OpenEXR: latitude 0, longitude 0 is +z, longitude 90° is +x; longitude falls from the left border to the right.
    assert!((uv(Vec3::Z).x - 0.5).abs() < 1e-6 && (uv(Vec3::X).x - 0.25).abs() < 1e-6 && uv(Vec3::Y).y < 1e-3);
    let (m, _) = map("def DomeLight_1 \"D\" { asset inputs:texture:file = @sky.png@ }");
    assert!(uv_from_direction(m * Vec3::Z).y < 1e-3);
    let plain = load("def DomeLight \"D\" { float inputs:intensity = 3 }").scene.environment;
    assert_eq!(plain, Some(Environment::Constant { radiance: Rgb::splat(3.0) }));
}

#[test]
fn shapes_cameras_labels_and_what_is_left_out() {
    let imported = load(
        r#"def Sphere "S" ( apiSchemas = ["SemanticsAPI:Semantics"] ) { double radius = 2
            string semantic:Semantics:params:semanticType = "class"
            string semantic:Semantics:params:semanticData = "Lamp"
            color3f[] primvars:displayColor = [(0.1, 0.2, 0.3)] }
        def Capsule "C" { token axis = "X"
            token[] semantics:labels:kind = ["gadget"] }
        def BasisCurves "Hair" { }
        def Camera "Eye" { float horizontalAperture = 36
            float verticalAperture = 18
            float focalLength = 18
            float horizontalApertureOffset = 2 }
        def Camera "Flat" { token projection = "orthographic" }"#,
    );
    let scene = &imported.scene;
    let bounds = |i: usize| scene.meshes[scene.parts[i].mesh as usize].bounds();
    assert!((bounds(1).max - Vec3::splat(2.0)).length() < 1e-5 && (bounds(2).max - Vec3::new(1.0, 0.5, 0.5)).length() < 1e-5);
    assert_eq!(scene.parts[0].world_from_mesh.transform_point3(DVec3::ONE), DVec3::splat(0.5));
    assert_eq!(imported.labels.as_ref().unwrap()[0].label.semantic, 35);
    assert_eq!((scene.cameras.len(), scene.cameras[0].aspect), (1, 2.0));
    assert!((scene.cameras[0].fov_x_rad - std::f64::consts::FRAC_PI_2).abs() < 1e-9);
    let told = warnings(&imported);
    for expected in ["1 labels name no class of NYU40", "\"gadget\"", "prims of type BasisCurves", "aperture is shifted", "not perspective"]
    {
        assert!(told.contains(expected), "{expected} is not in\n{told}");
    }
}

#[test]
fn other_surfaces_are_guessed_by_the_names_of_inputs() {
    let imported = load(
        r#"def Cube "Stool" { rel material:binding = </M> }
        def Material "M" { token outputs:mdl:surface.connect = </M/S.outputs:out>
            def Shader "S" { uniform token info:mdl:sourceAsset:subIdentifier = "OmniPBR"
                color3f inputs:diffuse_color_constant = (0.5, 0.25, 0.125)
                float inputs:reflection_roughness_constant = 0.75 } }"#,
    );
    let part = imported.scene.parts.iter().find(|p| p.name == "Stool").unwrap();
    let enfilade_scene::Bsdf::Principled(p) = &imported.scene.materials[part.material as usize].bsdf else { panic!("not principled") };
    assert_eq!((p.base_color.factor, p.roughness.factor), (Rgb::new(0.5, 0.25, 0.125), 0.75));
    assert!(warnings(&imported).contains("its surface is \"OmniPBR\""));
}
