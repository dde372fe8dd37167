//! The edits that give scenes Hypersim's settings: one quality for all, and cameras without motion blur and depth of field. Other settings
//! stay.

use enfilade_vray::edit::*;
use enfilade_vrscene::{Document, Value};
use std::path::Path;

/// A camera that moves, with or without a lens.
fn camera(lens: bool) -> CameraPath {
    let keyframe = |frame, x| CameraKeyframe {
        frame,
        position: [x, 0.0, 1.5],
        world_from_camera: [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]],
    };
    CameraPath {
        keyframes: vec![keyframe(0, 0.0), keyframe(1, 0.5)],
        frame_time_s: 1.0,
        fov_x_rad: 1.0,
        size: [64, 48],
        lens: lens.then(|| LensTexture { file: "/a/lens.exr".into(), size: [129, 97] }),
    }
}

fn parse(text: &str) -> Document {
    Document::parse(text.as_bytes()).unwrap()
}

fn written(scene: &Document) -> String {
    String::from_utf8(scene.to_bytes()).unwrap()
}

#[test]
fn motion_blur_and_depth_of_field_are_turned_off_wherever_they_are_on() {
    let mut scene = parse(
        "SettingsMotionBlur mb { on = 1; /* a long shutter */ geom_samples=8; camera_motion_blur=1; }\n\
         SettingsCameraDof dof { aperture=5; on=interpolate((0, 0), (9, 1)); focal_dist=200; }\n\
         CameraPhysical a { use_dof=1; use_moblur=1; blades_enable=1; f_number=2; rolling_shutter_mode=1; }\n\
         CameraPhysical b { f_number=8; // defaults\n}\n\
         CameraDome dome { flip_x=0; fov=3.1; }\n\
         #time 1\nSettingsMotionBlur mb { on=1; }\n",
    );
    set_camera(&mut scene, &camera(false));
    let text = written(&scene);
    for kept in [
        "SettingsMotionBlur mb { on = 0; /* a long shutter */ geom_samples=8; camera_motion_blur=1; }\n",
        "SettingsCameraDof dof { aperture=5; on=0; focal_dist=200; }\n",
        "CameraPhysical a { use_dof=0; use_moblur=0; blades_enable=0; f_number=2; rolling_shutter_mode=0;\n",
        "CameraPhysical b { f_number=8;\n",
        "  blades_enable=0; // defaults\n}\n",
        "CameraDome dome { flip_x=0; fov=3.1; }\n#time 1\nSettingsMotionBlur mb { on=0; }\n",
    ] {
        assert!(text.contains(kept), "no {kept} in\n{text}");
    }
    for camera in scene.of_kind("CameraPhysical") {
        for effect in ["use_dof", "use_moblur", "blades_enable"] {
            assert_eq!(camera.get(effect).unwrap(), Some(Value::Int(0)), "{effect}");
        }
    }
    // An unknown parameter to V-Ray before version 5.
    assert_eq!(text.matches("rolling_shutter_mode").count(), 1);
}

#[test]
fn effects_that_are_off_by_default_are_not_mentioned() {
    let mut scene = parse("RenderView view { fov=1; }\n");
    set_camera(&mut scene, &camera(false));
    for kind in ["SettingsMotionBlur", "SettingsCameraDof", "CameraPhysical"] {
        assert_eq!(scene.of_kind(kind).count(), 0, "{kind}");
    }
    set_camera(&mut scene, &camera(true));
    let camera = scene.of_kind("CameraPhysical").next().unwrap();
    assert_eq!((camera.get("use_dof").unwrap(), camera.get("use_moblur").unwrap()), (Some(Value::Int(0)), Some(Value::Int(0))));
}

#[test]
fn quality_is_hypersims_and_nothing_else_changes() {
    let mut scene = parse(
        "// mine\nSettingsImageSampler is { type = 1; /* buckets */ dmc_threshold=0.01; filter=aa; }\n\
         SettingsDMCSampler dmc { subdivs_mult=0.5; adaptive_amount=0.85; }\n\
         SettingsGI gi { on=0; saturation=0.8; primary_engine=2; secondary_engine=0; }\n\
         SettingsLightCache lc { subdivs=200; sample_size=0.02; }\n\
         SettingsIrradianceMap im { min_rate=-4; max_rate=0; subdivs=20; multipass=0; mode=0; }\n\
         SettingsEnvironment env { bg_color=Color(0, 0, 0); gi_color=Color(1, 1, 1); }\nFilterArea aa { size=2; }\n",
    );
    hypersim_quality(&mut scene);
    let expected = "// mine\nSettingsImageSampler is { type = 3; /* buckets */ dmc_threshold=0.01; filter=aa;\n  min_shade_rate=6;\n  \
         progressive_minSubdivs=1;\n  progressive_maxSubdivs=24;\n  progressive_threshold=0.001;\n  progressive_maxTime=300; }\n\
         SettingsDMCSampler dmc { subdivs_mult=0; adaptive_amount=0.85; }\n\
         SettingsGI gi { on=1; saturation=0.8; primary_engine=0; secondary_engine=3; }\n\
         SettingsLightCache lc { subdivs=1500; sample_size=0.02; }\n\
         SettingsIrradianceMap im { min_rate=-3; max_rate=-1; subdivs=50; multipass=1; mode=0; }\n\
         SettingsEnvironment env { bg_color=Color(0, 0, 0); gi_color=Color(1, 1, 1); }\nFilterArea aa { size=2; }\n";
    assert_eq!(written(&scene), expected);
}

#[test]
fn scenes_without_settings_get_them() {
    let mut scene = parse("RenderView view { fov=1; }\n");
    hypersim_quality(&mut scene);
    let value = |kind, name| scene.of_kind(kind).next().and_then(|plugin| plugin.get(name).unwrap());
    assert_eq!(value("SettingsImageSampler", "progressive_threshold"), Some(Value::Float(0.001)));
    // Its default, 1, is not Hypersim's.
    assert_eq!(value("SettingsDMCSampler", "subdivs_mult").and_then(|value| value.number()), Some(0.0));
    assert_eq!(value("SettingsGI", "on"), Some(Value::Int(1)));
    assert_eq!(scene.of_kind("SettingsEnvironment").count(), 0);
}

#[test]
fn a_second_edit_changes_no_byte() {
    let text =
        "SettingsMotionBlur mb { on=1; }\nCameraPhysical cam { use_dof=1; fov=1; }\nSettingsGI gi { on=1; }\nRenderView view { fov=1; }\n";
    let edits: [&dyn Fn(&mut Document); 4] =
        [&|s| set_camera(s, &camera(false)), &|s| set_camera(s, &camera(true)), &hypersim_quality, &hypersim_surroundings];
    for (i, edit) in edits.into_iter().enumerate() {
        for text in [text, "RenderView view { fov=1; }\n"] {
            let mut scene = parse(text);
            edit(&mut scene);
            let once = written(&scene);
            let mut again = parse(&once);
            edit(&mut again);
            assert_eq!(written(&again), once, "edit {i}");
        }
    }
}

#[test]
fn files_of_indirect_light_are_those_of_the_engines() {
    let files = |settings: &str| {
        let GiFiles { light_cache, irradiance_map } = gi_files(&parse(settings)).unwrap();
        (light_cache, irradiance_map)
    };
    for (settings, expected) in [
        ("on=1; primary_engine=0; secondary_engine=3;", (true, true)),
        ("on=1; primary_engine=2; secondary_engine=3;", (true, false)),
        ("on=1; primary_engine=3; secondary_engine=3;", (true, false)),
        ("on=1; primary_engine=2; secondary_engine=2;", (false, false)),
        ("on=0; primary_engine=0; secondary_engine=3;", (false, false)),
        ("on=interpolate((0, 1), (9, 1)); secondary_engine=3;", (true, true)),
        // V-Ray's defaults: off; and once on, an irradiance map and brute force.
        ("", (false, false)),
        ("on=1;", (false, true)),
    ] {
        assert_eq!(files(&format!("SettingsGI gi {{ {settings} }}")), expected, "{settings}");
    }
    assert_eq!(files("RenderView view { fov=1; }"), (false, false));
    let mut scene = parse("SettingsGI gi { on=0; primary_engine=2; }");
    hypersim_quality(&mut scene);
    assert_eq!(gi_files(&scene).unwrap(), GiFiles { light_cache: true, irradiance_map: true });
    let damaged = gi_files(&parse("SettingsGI gi {\n  on=Vector(1);\n}")).unwrap_err();
    assert!(damaged.to_string().starts_with("2:"), "{damaged}");
}

#[test]
fn hypersims_empty_scene_changes_in_these_parameters_alone() {
    let Some(scenes) = std::env::var_os("ENFILADE_SCENES") else {
        return eprintln!("skipped: ENFILADE_SCENES is not set");
    };
    let bytes = std::fs::read(Path::new(&scenes).join("vrscene/hypersim_empty.vrscene")).unwrap();
    let before = Document::parse(bytes.as_slice()).unwrap();
    let mut after = before.clone();
    hypersim_quality(&mut after);
    set_camera(&mut after, &camera(false));
    let mut changed = Vec::new();
    assert_eq!(before.plugins().count(), after.plugins().count());
    for (old, new) in before.plugins().zip(after.plugins()) {
        assert_eq!((old.kind(), old.name()), (new.kind(), new.name()));
        let raw = |parameter: &enfilade_vrscene::Parameter| (parameter.name().to_vec(), parameter.raw().to_vec());
        let kept: Vec<_> = old.parameters().iter().map(raw).collect();
        let differing = new.parameters().iter().map(raw).filter(|parameter| !kept.contains(parameter));
        changed.extend(differing.map(|(name, _)| format!("{}.{}", String::from_utf8_lossy(new.kind()), String::from_utf8_lossy(&name))));
    }
    let expected = [
        "SettingsCamera.fov",
        "RenderView.transform",
        "RenderView.fov",
        "SettingsGI.primary_engine",
        "SettingsOutput.img_width",
        "SettingsOutput.img_height",
        "SettingsOutput.frames",
        "SettingsOutput.img_file_needFrameNumber",
        "SettingsOutput.anim_start",
        "SettingsOutput.anim_end",
        "SettingsOutput.frame_start",
        "SettingsImageSampler.progressive_maxSubdivs",
        "SettingsImageSampler.progressive_threshold",
        "SettingsImageSampler.progressive_maxTime",
        "SettingsLightCache.subdivs",
        "SettingsIrradianceMap.max_rate",
        "SettingsDMCSampler.subdivs_mult",
    ];
    assert_eq!(changed, expected);
}
