//! COLLADA files, made by the tests, compared with trimesh with pycollada and with the specification.

use crate::common::{Folder, png, principled, warnings};
use enfilade_import::Imported;
use enfilade_math::{Rgb, Vec3, linear_from_srgb};
use enfilade_scene::{Alpha, Bsdf, Light, Wrap};

/// A file with these libraries and nodes; y is up and the unit is a centimetre unless `asset` changes that.
fn file(asset: &str, libraries: &str, nodes: &str) -> String {
    let asset = if asset.is_empty() { "<unit meter=\"0.01\"/><up_axis>Y_UP</up_axis>" } else { asset };
    format!(
        "<?xml version=\"1.0\" encoding=\"utf-8\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">\
         <asset>{asset}</asset>{libraries}<library_visual_scenes><visual_scene id=\"s\">{nodes}</visual_scene></library_visual_scenes>\
         <scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>"
    )
}

/// A source of vectors.
fn source(id: &str, values: &str, stride: usize) -> String {
    let count = values.split_whitespace().count();
    format!(
        "<source id=\"{id}\"><float_array id=\"{id}-a\" count=\"{count}\">{values}</float_array><technique_common><accessor source=\"#{id}-a\" \
         count=\"{}\" stride=\"{stride}\"/></technique_common></source>",
        count / stride
    )
}

/// The geometry `g` of five vertices of a house's front, with these primitives.
fn geometry(primitives: &str) -> String {
    format!(
        "<library_geometries><geometry id=\"g\" name=\"House\"><mesh>{}{}{}<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>\
         {primitives}</mesh></geometry></library_geometries>",
        source("p", "0 0 0  200 0 0  200 100 0  100 150 0  0 100 0", 3),
        source("n", "0 0 1", 3),
        source("t", "0 0 1 0 1 1 0.5 1.5 0 1", 2),
    )
}

const VERTEX: &str = "<input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>";
const NODE: &str = "<node id=\"n1\" name=\"Front\"><instance_geometry url=\"#g\"/></node>";

fn load(text: &str) -> Imported {
    Folder::new().write("a.dae", text).load("a.dae").unwrap_or_else(|e| panic!("{e}"))
}

fn points(imported: &Imported, name: &str) -> Vec<Vec3> {
    let names: Vec<&str> = imported.scene.parts.iter().map(|p| p.name.as_str()).collect();
    let part = imported.scene.parts.iter().find(|p| p.name == name).unwrap_or_else(|| panic!("no {name} in {names:?}"));
    imported.scene.world_positions(part).collect()
}

fn area(imported: &Imported) -> f32 {
    let scene = &imported.scene;
    let of = |part: &enfilade_scene::Part| {
        (0..scene.meshes[part.mesh as usize].triangles.len()).map(|t| scene.world_corners(part, t)).collect::<Vec<_>>()
    };
    scene.parts.iter().flat_map(of).map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
}

#[test]
fn every_kind_of_primitive_gives_the_same_front() {
    let all = [
        "<triangles count=\"3\">IN<p>0 1 2 0 2 3 0 3 4</p></triangles>",
        "<polylist count=\"2\">IN<vcount>3 4</vcount><p>0 1 2 0 2 3 4</p></polylist>",
        "<polygons count=\"1\">IN<p>0 1 2 3 4</p></polygons>",
        "<polygons count=\"1\">IN<ph><p>0 1 2 3 4</p><h>0 1 2</h></ph></polygons>",
        "<trifans count=\"1\">IN<p>0 1 2 3 4</p></trifans>",
        "<tristrips count=\"1\">IN<p>1 2 0 3 4</p></tristrips>",
    ];
    for primitive in all {
        let imported = load(&file("", &geometry(&primitive.replace("IN", VERTEX)), NODE));
        // Two metres by one with a gable of half a metre: 2 + 0.5.
        assert!((area(&imported) - 2.5).abs() < 1e-5, "{primitive}: {}", area(&imported));
        assert_eq!(imported.scene.parts[0].name, "Front");
        let scene = &imported.scene;
        for t in 0..scene.meshes[0].triangles.len() {
            let [a, b, c] = scene.world_corners(&scene.parts[0], t);
            // The front looks along +z of the file, −y of the world.
            assert!((b - a).cross(c - a).y < 0.0, "{primitive} {t}");
        }
    }
}

#[test]
fn units_and_axes_are_those_of_the_asset() {
    let front = geometry(&format!("<triangles>{VERTEX}<p>0 1 3</p></triangles>"));
    // The corner (100, 150, 0): x to the right, y up; z up; and x up with −y to the right, as the specification's table has it.
    for (asset, expected) in [
        ("<unit meter=\"0.01\"/><up_axis>Y_UP</up_axis>", [1.0, 0.0, 1.5]),
        ("<unit name=\"inch\" meter=\"0.0254\"/><up_axis>Z_UP</up_axis>", [2.54, 3.81, 0.0]),
        ("<unit meter=\"0,01\"/><up_axis>X_UP</up_axis>", [-1.5, 0.0, 1.0]),
        ("<unit meter=\"0.01\"/><up_axis> z_up\n</up_axis>", [1.0, 1.5, 0.0]),
        ("<created/>", [100.0, 0.0, 150.0]),
    ] {
        let found = points(&load(&file(asset, &front, NODE)), "Front");
        assert!(found.iter().any(|p| (*p - Vec3::from(expected)).length() < 1e-4), "{asset}: {found:?}");
    }
}

#[test]
fn transforms_apply_in_their_order_and_nodes_hold_nodes() {
    let front = geometry(&format!("<triangles>{VERTEX}<p>0 1 3</p></triangles>"));
    let nodes = "<node id=\"outer\"><translate>100 0 0</translate><rotate>0 0 1 90</rotate><scale>2 1 1</scale>\
        <node id=\"inner\"><matrix>1 0 0 0  0 1 0 10  0 0 1 0  0 0 0 1</matrix><instance_geometry url=\"#g\"/></node></node>\
        <node id=\"copy\"><instance_node url=\"#outer\"/></node>";
    let imported = load(&file("", &front, nodes));
    // (200, 0) → +10 in y → ×2 in x → (400, 10) → a quarter turn → (−10, 400) → +100 in x: (90, 400) cm, y up.
    let found = points(&imported, "inner");
    assert!(found.iter().any(|p| (*p - Vec3::new(0.9, 0.0, 4.0)).length() < 1e-5), "{found:?}");
    assert_eq!(points(&imported, "inner_2"), found);
    assert_eq!(imported.report.counts.meshes, 1);
    let lineage = imported.scene.lineage(&imported.scene.parts[1]);
    assert_eq!(lineage, ["copy", "outer", "inner"]);
    let cycle = "<node id=\"a\"><instance_node url=\"#a\"/></node>";
    assert!(Folder::new().write("a.dae", file("", &front, cycle)).error("a.dae").contains("nested more than"));
}

/// An effect of a shading model, the material `m` of it, and a node that binds it.
fn painted(model: &str, parameters: &str) -> String {
    let front = geometry(&format!(
        "<triangles material=\"sym\">{VERTEX}<input semantic=\"NORMAL\" source=\"#n\" offset=\"1\"/>\
         <input semantic=\"TEXCOORD\" source=\"#t\" offset=\"2\" set=\"0\"/><p>0 0 0 1 0 1 3 0 3</p></triangles>"
    ));
    let libraries = format!(
        "<library_images><image id=\"img\"><init_from>file:///gone/my%20wood.png</init_from></image></library_images>\
         <library_effects><effect id=\"e\"><profile_COMMON>{parameters}<technique sid=\"c\">{model}</technique></profile_COMMON></effect>\
         </library_effects><library_materials><material id=\"m\" name=\"Oak\"><instance_effect url=\"#e\"/></material></library_materials>{front}"
    );
    let node = "<node id=\"n\"><instance_geometry url=\"#g\"><bind_material><technique_common><instance_material symbol=\"sym\" target=\"#m\"/>\
                </technique_common></bind_material></instance_geometry></node>";
    file("", &libraries, node)
}

const SAMPLER: &str = "<newparam sid=\"surf\"><surface type=\"2D\"><init_from>img</init_from></surface></newparam>\
    <newparam sid=\"samp\"><sampler2D><source>surf</source><wrap_s>MIRROR</wrap_s><wrap_t>CLAMP</wrap_t></sampler2D></newparam>";

#[test]
fn materials_have_the_colours_and_pictures_of_the_common_profile() {
    let lambert = "<lambert><diffuse><color>0.5 0.25 1 1</color></diffuse></lambert>";
    let imported = load(&painted(lambert, ""));
    let material = &imported.scene.materials[0];
    assert_eq!(material.name, "Oak");
    let srgb = Rgb::new(linear_from_srgb(0.5), linear_from_srgb(0.25), 1.0);
    assert_eq!(material.bsdf, Bsdf::Diffuse { reflectance: srgb.into() });
    let text = painted(lambert, "").replace("<asset>", "<asset><contributor><authoring_tool>Blender 2.93.1</authoring_tool></contributor>");
    assert_eq!(load(&text).scene.materials[0].bsdf, Bsdf::Diffuse { reflectance: Rgb::new(0.5, 0.25, 1.0).into() });
    // A picture by its sampler, whose folder is another machine's, and its wrapping.
    let phong = "<phong><emission><color>0 0 0 1</color></emission><diffuse><texture texture=\"samp\" texcoord=\"UV0\"/></diffuse>\
                 <specular><color>1 1 1 1</color></specular><shininess><float>198</float></shininess></phong>";
    let folder = Folder::new();
    folder.write("textures/my wood.png", png(1, 1, [9, 9, 9, 255])).write("a.dae", painted(phong, SAMPLER));
    let imported = folder.load("a.dae").unwrap();
    let p = principled(&imported.scene.materials[0].bsdf);
    assert_eq!(p.base_color.texture.unwrap().wrap, [Wrap::Mirror, Wrap::Clamp]);
    // GGX alpha 0.1, whose root is the roughness.
    assert!((p.roughness.factor - 0.1f32.sqrt()).abs() < 1e-6);
    assert_eq!(imported.scene.meshes[0].uvs.len(), 3);
    let missing = Folder::new().write("a.dae", painted(phong, SAMPLER)).error("a.dae");
    assert!(missing.contains("material \"Oak\" needs the texture") && missing.contains("--allow-missing-textures"), "{missing}");
    let none = phong.replace("\"samp\"", "\"nothing\"");
    assert!(warnings(&load(&painted(&none, SAMPLER))).contains("names no picture; a mid grey stands in"));
}

#[test]
fn opacity_follows_the_four_modes_of_the_specification() {
    // transparent, transparency and mode; the opacity by the table of COLLADA 1.5.
    for (transparent, transparency, expected) in [
        ("opaque=\"A_ONE\"><color>0 0 0 0.25</color>", "1", 0.25),
        ("><color>1 1 1 1</color>", "0.5", 0.5),
        ("opaque=\"RGB_ZERO\"><color>0.5 0.5 0.5 1</color>", "0.5", 0.75),
        ("opaque=\"RGB_ONE\"><color>0.5 0.5 0.5 1</color>", "0.5", 0.25),
        ("opaque=\"A_ZERO\"><color>0 0 0 0.25</color>", "1", 0.75),
        ("opaque=\"RGB_ZERO\"><color>0 0 0 1</color>", "1", 1.0),
    ] {
        let model = format!(
            "<lambert><diffuse><color>1 1 1 1</color></diffuse><transparent {transparent}</transparent><transparency><float>{transparency}</float>\
             </transparency></lambert>"
        );
        let found = match &load(&painted(&model, "")).scene.materials[0].alpha {
            Alpha::Opaque => 1.0,
            Alpha::Blend { opacity } => opacity.factor,
            other => panic!("{other:?}"),
        };
        assert!((found - expected).abs() < 1e-6, "{transparent}: {found}");
    }
    let hidden = "<lambert><transparent><color>1 1 1 1</color></transparent><transparency><float>0</float></transparency></lambert>";
    let imported = load(&painted(hidden, ""));
    assert_eq!(imported.scene.materials[0].alpha, Alpha::Opaque);
    assert!(warnings(&imported).contains("found an opacity of zero"));
}

#[test]
fn lights_and_cameras_stand_at_their_nodes() {
    let libraries = format!(
        "{}<library_lights><light id=\"sun\"><technique_common><directional><color>2 2 2</color></directional></technique_common></light>\
         <light id=\"spot\"><technique_common><spot><color>10 0 0</color><falloff_angle>60</falloff_angle></spot></technique_common></light>\
         <light id=\"amb\"><technique_common><ambient><color>1 1 1</color></ambient></technique_common></light></library_lights>\
         <library_cameras><camera id=\"cam\"><optics><technique_common><perspective><yfov>60</yfov><aspect_ratio>2</aspect_ratio></perspective>\
         </technique_common></optics></camera></library_cameras>",
        geometry(&format!("<triangles>{VERTEX}<p>0 1 3</p></triangles>"))
    );
    let nodes = format!(
        "{NODE}<node name=\"Sun\"><rotate>1 0 0 -90</rotate><instance_light url=\"#sun\"/></node>\
         <node name=\"Lamp\"><translate>0 200 0</translate><instance_light url=\"#spot\"/><instance_light url=\"#amb\"/></node>\
         <node name=\"Eye\"><lookat>0 100 300  0 100 0  0 1 0</lookat><instance_camera url=\"#cam\"/></node>"
    );
    let imported = load(&file("", &libraries, &nodes));
    let [Light::Directional { direction, .. }, Light::Spot { position, intensity, outer_rad, .. }] = &imported.scene.lights[..] else {
        panic!("{:?}", imported.scene.lights)
    };
    assert!((*direction - Vec3::NEG_Z).length() < 1e-6, "{direction}");
    // 10 per square unit of a centimetre.
    assert!(
        (*position - Vec3::new(0.0, 0.0, 2.0)).length() < 1e-6
            && (intensity.r - 0.001).abs() < 1e-9
            && (outer_rad.to_degrees() - 30.0).abs() < 1e-4
    );
    let camera = &imported.scene.cameras[0];
    assert!((camera.position - enfilade_math::DVec3::new(0.0, -3.0, 1.0)).length() < 1e-9, "{}", camera.position);
    // tan(30°)·2.
    assert!((camera.fov_x_rad - 2.0 * (2.0 * 30f64.to_radians().tan()).atan()).abs() < 1e-9);
    assert!(warnings(&imported).contains("ambient light has no place"), "{}", warnings(&imported));
}

#[test]
fn skins_stand_as_they_were_bound_and_what_is_missing_is_told() {
    let controller = "<library_controllers><controller id=\"c\"><skin source=\"#g\"><bind_shape_matrix>1 0 0 0 0 1 0 100 0 0 1 0 0 0 0 1\
                      </bind_shape_matrix></skin></controller></library_controllers>";
    let libraries = geometry(&format!("<triangles>{VERTEX}<p>0 1 3</p></triangles>")) + controller;
    let nodes =
        "<node id=\"b\"><translate>999 0 0</translate><instance_controller url=\"#c\"/><instance_geometry url=\"other.dae#x\"/></node>";
    let imported = load(&file("", &libraries, nodes));
    assert!(points(&imported, "b").iter().any(|p| (*p - Vec3::new(0.0, 0.0, 1.0)).length() < 1e-6));
    let told = warnings(&imported);
    assert!(
        told.contains("it has no joints; it stays as it was bound") && told.contains("\"other.dae#x\", which is not in the file"),
        "{told}"
    );
}

#[test]
fn broken_files_say_where() {
    let error = |text: String| Folder::new().write("a.dae", text).error("a.dae");
    let front = |p: &str| file("", &geometry(&format!("<triangles>{VERTEX}<p>{p}</p></triangles>")), NODE);
    assert!(error(front("0 1 9")).contains("geometry \"g\": a face refers to vertex 9, but there are only 5"), "{}", error(front("0 1 9")));
    assert!(error(front("0 1 -2")).contains("no whole numbers"));
    assert!(error("<a/>".into()).contains("it is XML of another program, with <a> around all, not COLLADA"));
    assert!(error("<COLLADA>".into()).contains("not well-formed XML"));
    let whole = front("0 1 3");
    for length in (0..whole.len()).step_by(37) {
        assert!(error(whole[..length].to_string()).starts_with("a.dae: "));
    }
}
