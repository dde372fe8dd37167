//! The edits to scenes before they are rendered, on a scene with every kind of plugin concerned.

use enfilade_vray::edit::*;
use enfilade_vrscene::{Document, Plugin, Value, add_include, inline_includes};

const SCENE: &str = r#"#include "C:\Jobs\lib\mats.vrscene"
Node sofa@node_1 { geometry=mesh; material=mtl; scene_name=ListString("sofa", "layer/0"); }
Node lost@node_2 { geometry=mesh; material=mtl; }
MtlSingleBRDF mtl { brdf=brdf; scene_name="leather"; }
BRDFVRayMtl brdf { diffuse=tex; self=mtl; reflect_affect_alpha=1; }
TexBitmap tex { bitmap=buffer; }
BitmapBuffer buffer { file="c:/jobs/maps/Leather.jpg"; gamma=1; }
LightRectangle r { intensity=1; }
LightMesh m { intensity=1; }
LightDome d { intensity=1; }
LightIES i { ies_file="D:\lamps\a.ies"; }
FilterLanczos aaFilter { size=2; }
SettingsImageSampler is { type=3; filter=aaFilter; filters=List(aaFilter, mesh); }
SettingsUnitsInfo units { meters_scale=0.0254; }
SettingsGI gi { on=1; }
RenderView view { transform=interpolate((0, 1), (99, 2)); }
SettingsOutput output { img_pixelAspect=1.5; }
CameraPhysical cam { fov=1; use_dof=1; lens_shift=0.2; horizontal_shift=0.1; horizontal_offset=0.3; vertical_offset=-0.1; zoom_factor=2; blades_enable=1; }
"#;

fn scene() -> Document {
    Document::parse(SCENE.as_bytes()).unwrap()
}

fn find<'a>(scene: &'a Document, name: &str) -> &'a Plugin {
    scene.plugins().find(|plugin| plugin.name() == name.as_bytes()).unwrap()
}

fn raw<'a>(scene: &'a Document, plugin: &str, parameter: &str) -> Option<&'a str> {
    find(scene, plugin).parameter(parameter).map(|p| std::str::from_utf8(p.raw()).unwrap())
}

#[test]
fn paths_move_whatever_their_slashes_and_letters() {
    let mut scene = scene();
    assert_eq!(replace_paths(&mut scene, r"C:\jobs\", "/mnt/assets"), 2);
    assert_eq!(raw(&scene, "buffer", "file"), Some("\"/mnt/assets/maps/Leather.jpg\""));
    let paths: Vec<String> = file_references(&scene).into_iter().map(|reference| reference.path).collect();
    assert_eq!(paths, ["/mnt/assets/lib/mats.vrscene", "/mnt/assets/maps/Leather.jpg", r"D:\lamps\a.ies"]);
    assert_eq!(replace_paths(&mut scene, "/mnt/asset", "/x"), 0);
    assert_eq!(replace_paths(&mut scene, "/mnt/assets", r"E:\a"), 2);
    assert_eq!(raw(&scene, "buffer", "file"), Some(r#""E:\a\maps\Leather.jpg""#));
    assert_eq!(Platform::Windows.join(r"E:\a\", "b.vrmap"), r"E:\a\b.vrmap");
}

#[test]
fn every_parameter_that_names_a_file_counts_and_no_other() {
    let text = r#"MtlVRmat a { filename="C:\jobs\a.vrmat"; }
VRayScene b { filepath="C:\jobs\b.vrscene"; filter_type=1; }
CameraPhysical c { lens_file="C:\jobs\c.lens"; }
PhxShaderCache d { cache_path="C:\jobs\d.aur"; }
TexOSL e { shader_file="C:\jobs\e.osl"; }
SettingsOutput f { img_file="C:\jobs\f.exr"; img_dir="C:\jobs"; img_file_needFrameNumber=1; }
BitmapBuffer g { file="C:\jobs\g.png"; load_file=1; }
"#;
    let mut scene = Document::parse(text.as_bytes()).unwrap();
    assert_eq!(replace_paths(&mut scene, r"C:\jobs", "/mnt"), 6);
    let paths: Vec<String> = file_references(&scene).into_iter().map(|reference| reference.path).collect();
    assert_eq!(paths, ["/mnt/a.vrmat", "/mnt/b.vrscene", "/mnt/c.lens", "/mnt/d.aur", "/mnt/e.osl", "/mnt/g.png"]);
    assert_eq!(raw(&scene, "f", "img_file"), Some(r#""C:\jobs\f.exr""#));
}

#[test]
fn surroundings_of_one_colour_leave_pictures_and_skies_alone() {
    let text = "SettingsEnvironment e { bg_tex=sky::color; gi_tex=AColor(0, 0, 0, 1); gi_color=Color(1, 0, 0); }\nTexSky sky {}\n";
    let mut scene = Document::parse(text.as_bytes()).unwrap();
    hypersim_surroundings(&mut scene);
    assert_eq!(raw(&scene, "e", "bg_tex"), Some("sky::color"));
    assert_eq!((raw(&scene, "e", "bg_color"), raw(&scene, "e", "gi_color")), (Some("Color(4, 4, 4)"), Some("Color(4, 4, 4)")));
    // Values that the scene does not state are V-Ray's constants.
    assert_eq!((raw(&scene, "e", "gi_tex"), raw(&scene, "e", "reflect_tex")), (Some("AColor(4, 4, 4, 1)"), Some("AColor(4, 4, 4, 1)")));
}

#[test]
fn removed_plugins_leave_no_reference() {
    let mut scene = scene();
    assert_eq!(remove_kinds(&mut scene, &IMAGE_FILTERS), Removed { plugins: 1, references: 2 });
    assert_eq!(raw(&scene, "is", "filter"), None);
    assert_eq!(raw(&scene, "is", "filters"), Some("List(mesh)"));
    assert_eq!(remove_kinds(&mut scene, &IMAGE_FILTERS), Removed::default());
}

#[test]
fn every_node_and_light_has_a_number_of_its_own() {
    let mut scene = scene();
    let options = EntityOptions { hide_nodes_not_in_mesh: true, hide_lights: true };
    let entities = set_entity_ids(&mut scene, &["wall", "sofa"], options);
    let seen: Vec<_> = entities.iter().map(|e| (e.id, e.name.as_str(), e.object, e.light)).collect();
    let expected = [
        (1, "sofa@node_1", Some(1), false),
        (2, "lost@node_2", None, false),
        (3, "r", None, true),
        (4, "m", None, true),
        (5, "d", None, true),
    ];
    assert_eq!(seen, expected);
    assert_eq!((raw(&scene, "sofa@node_1", "visible"), raw(&scene, "lost@node_2", "visible")), (None, Some("0")));
    assert_eq!((raw(&scene, "m", "objectID"), raw(&scene, "m", "invisible")), (Some("4"), Some("1")));
}

#[test]
fn a_node_leads_to_its_strings_and_circles_end() {
    let scene = scene();
    let strings = node_strings(&scene, find(&scene, "sofa@node_1"));
    let found: Vec<_> = strings.iter().map(|s| (s.path.as_str(), s.string.as_str())).collect();
    let expected = [
        ("<root>", "sofa@node_1"),
        ("<root>.material", "mtl"),
        ("<root>.material.brdf", "brdf"),
        ("<root>.material.brdf.diffuse", "tex"),
        ("<root>.material.brdf.diffuse.bitmap", "buffer"),
        ("<root>.material.brdf.diffuse.bitmap.file", "c:/jobs/maps/Leather.jpg"),
        ("<root>.material.scene_name", "leather"),
        ("<root>.scene_name[0]", "sofa"),
        ("<root>.scene_name[1]", "layer/0"),
    ];
    assert_eq!(found, expected);
}

#[test]
fn a_plugin_that_several_ways_lead_to_is_named_at_each_and_told_once() {
    let text = "Node n { material=m; geometry=g; }\nMtl m { second=t::out; first=List(t, a); }\n\
        Tex t { note=\"red\"; }\nTex a { back=m; }\n";
    let scene = Document::parse(text.as_bytes()).unwrap();
    let strings = node_strings(&scene, find(&scene, "n"));
    let found: Vec<_> = strings.iter().map(|s| (s.path.as_str(), s.string.as_str())).collect();
    let expected = [
        ("<root>", "n"),
        ("<root>.material", "m"),
        ("<root>.material.first[0]", "t"),
        ("<root>.material.first[0].note", "red"),
        ("<root>.material.first[1]", "a"),
        ("<root>.material.second", "t"),
    ];
    assert_eq!(found, expected);
}

#[test]
fn normalization_rises_from_v0_to_v2() {
    let normalized = |policy| {
        let mut scene = scene();
        normalize(&mut scene, policy);
        (raw(&scene, "units", "photometric_scale").map(String::from), raw(&scene, "buffer", "gamma").map(String::from))
    };
    assert_eq!(normalized(Normalization::V0), (None, Some("1".into())));
    assert_eq!(normalized(Normalization::V1), (Some("0.002094395".into()), Some("1".into())));
    assert_eq!(normalized(Normalization::V2), (Some("0.002094395".into()), Some("0.4545454".into())));
    assert_eq!(meters_per_asset_unit(&scene()).unwrap(), Some(0.0254));
}

#[test]
fn another_camera_leaves_nothing_of_the_one_before() {
    let mut scene = scene();
    let keyframe = |frame, x| CameraKeyframe {
        frame,
        position: [x, 0.5, 2.0],
        world_from_camera: [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]],
    };
    let lens = LensTexture { file: "/a/lens.exr".into(), size: [2049, 1537] };
    let mut path = CameraPath {
        keyframes: vec![keyframe(0, 1.0), keyframe(2, 3.0)],
        frame_time_s: 0.5,
        fov_x_rad: 1.25,
        size: [1024, 768],
        lens: Some(lens),
    };
    set_camera(&mut scene, &path);
    set_camera(&mut scene, &path);
    let matrix = "Matrix(Vector(1, 0, 0), Vector(0, 0, 1), Vector(0, -1, 0))";
    let expected = format!("interpolate((0, Transform({matrix}, Vector(1, 0.5, 2))), (2, Transform({matrix}, Vector(3, 0.5, 2))))");
    assert_eq!(raw(&scene, "view", "transform"), Some(expected.as_str()));
    assert_eq!(raw(&scene, "output", "frames"), Some("ListInt(0, 1, 2)"));
    assert_eq!(raw(&scene, "output", "frames_per_second"), Some("2"));
    assert_eq!((raw(&scene, "output", "img_pixelAspect"), raw(&scene, "cam", "zoom_factor")), (Some("1"), Some("1")));
    for shift in ["lens_shift", "horizontal_shift", "horizontal_offset", "vertical_offset", "blades_enable"] {
        assert_eq!(raw(&scene, "cam", shift), Some("0"), "{shift}");
    }
    assert_eq!((raw(&scene, "cam", "use_dof"), raw(&scene, "cam", "distortion_type")), (Some("0"), Some("3")));
    assert_eq!(scene.of_kind("TexBitmap").count(), 2);
    path.keyframes.truncate(1);
    path.lens = None;
    set_camera(&mut scene, &path);
    assert_eq!(raw(&scene, "view", "transform"), Some(format!("Transform({matrix}, Vector(1, 0.5, 2))").as_str()));
    assert_eq!(raw(&scene, "cam", "distortion_type"), Some("0"));
}

#[test]
fn passes_have_what_they_need_and_nothing_else() {
    let mut whole = scene();
    prepare_for_layers(&mut whole);
    hypersim_quality(&mut whole);
    add_geometry_channels(&mut whole);
    add_color_channels(&mut whole);
    add_denoiser(&mut whole);
    assert_eq!(raw(&whole, "brdf", "reflect_affect_alpha"), Some("0"));
    let sampled = [("VRayPosition", "point"), ("VRayNormal", "normal"), ("VRayNormalBump", "bumpNormal"), ("VRayTexCoord", "uvCoord")];
    for (name, output) in sampled {
        // A texture in between: the sampler's outputs are vectors.
        let color = format!("HYPERSIM_color_{name}");
        assert_eq!(find(&whole, &color).kind(), b"TexVectorToColor");
        assert_eq!(raw(&whole, &format!("HYPERSIM_channel_{name}"), "texmap"), Some(color.as_str()));
        assert_eq!(raw(&whole, &color, "input"), Some(format!("HYPERSIM_sampler_{name}::{output}").as_str()));
    }
    assert_eq!(raw(&whole, "HYPERSIM_channel_VRayDiffuseFilter", "color_mapping"), Some("0"));
    let caches = GiCaches { light_cache: "/a/b.vrlmap".into(), irradiance_map: "/a/b.vrmap".into() };
    let channels = |pass| {
        let mut scene = whole.clone();
        make_pass(&mut scene, pass, &caches);
        let count = |kind| scene.of_kind(kind).count();
        let counts = [count("RenderChannelExtraTex"), count("RenderChannelNodeID"), count("RenderChannelColor"), count("SettingsGI")];
        let cache = scene.of_kind("SettingsLightCache").next().and_then(|c| c.get("mode").unwrap());
        (counts, cache, scene.of_kind("SettingsImageSampler").next().and_then(|s| s.get("type").unwrap()))
    };
    assert_eq!(channels(Pass::Geometry), ([4, 1, 0, 0], None, Some(Value::Int(0))));
    assert_eq!(channels(Pass::Pre), ([0, 0, 0, 1], Some(Value::Int(0)), Some(Value::Int(0))));
    assert_eq!(channels(Pass::Final), ([0, 0, 13, 1], Some(Value::Int(2)), Some(Value::Int(3))));
    let written = whole.to_bytes();
    assert_eq!(Document::parse(written.as_slice()).unwrap().to_bytes(), written);
}

#[test]
fn included_files_come_in_place_of_their_lines() {
    let file = |name: &str| match name {
        "main" => "// top\nA a { x=1; }\n#include \"one\" // kept\nB b { }\n",
        "one" => "#include \"two\"\nC c { y=a; } // no line's end",
        "two" => "D d { }",
        "circle" => "#include \"back\"",
        _ => "E e {}\n#include \"circle\"\n",
    };
    let inline = |name: &str| {
        let parse = |name: &str| Document::parse(file(name).as_bytes()).unwrap();
        inline_includes(parse(name), name.to_string(), &mut |_, include| {
            let path = String::from_utf8(include.path().to_vec()).unwrap();
            Ok::<_, String>((parse(&path), path))
        })
    };
    let whole = inline("main").unwrap();
    assert_eq!(whole.includes().count(), 0);
    let again = Document::parse(whole.to_bytes()).unwrap();
    let names: Vec<String> = again.plugins().map(|plugin| String::from_utf8_lossy(plugin.name()).into_owned()).collect();
    assert_eq!(names, ["a", "d", "c", "b"], "{}", String::from_utf8_lossy(&whole.to_bytes()));
    let text = String::from_utf8(whole.to_bytes()).unwrap();
    assert!(text.contains("// top") && text.contains("// kept") && text.contains("// no line's end\n"), "{text}");
    let circle = inline("circle").unwrap_err();
    assert_eq!(circle.to_string(), "2:1: \"circle\" includes itself");
    let mut scene = scene();
    add_include(&mut scene, "/a/quads.vrscene");
    assert_eq!(Document::parse(scene.to_bytes()).unwrap().includes().count(), 2);
}

#[test]
fn a_lens_is_a_texture_of_numbers_and_goes_with_its_camera() {
    let mut scene = scene();
    let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut path = CameraPath {
        keyframes: vec![CameraKeyframe { frame: 0, position: [0.0; 3], world_from_camera: identity }],
        frame_time_s: 1.0,
        fov_x_rad: 1.0,
        size: [4, 2],
        lens: Some(LensTexture { file: "/a/lens.exr".into(), size: [9, 5] }),
    };
    set_camera(&mut scene, &path);
    assert_eq!(raw(&scene, "cam", "distortion_tex"), Some("HYPERSIM_camera_lens_distortion_texture"));
    assert_eq!(raw(&scene, "HYPERSIM_camera_lens_distortion_buffer", "gamma"), Some("1"));
    // The toolkit's scale and offset: (n - 1) / n and half a texel.
    let transform = find(&scene, "HYPERSIM_camera_lens_distortion_uvw").get("uvw_transform").unwrap();
    let Some(Value::Transform(transform)) = transform else { panic!() };
    assert_eq!((transform.matrix[0][0], transform.matrix[1][1]), (8.0 / 9.0, 0.8));
    assert!((transform.offset[0] - 1.0 / 18.0).abs() < 1e-7 && (transform.offset[1] - 0.1).abs() < 1e-7);
    path.lens = None;
    set_camera(&mut scene, &path);
    assert_eq!(raw(&scene, "cam", "distortion_tex"), None);
    assert!(!String::from_utf8(scene.to_bytes()).unwrap().contains("HYPERSIM_camera_lens"));
}
