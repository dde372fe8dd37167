//! Reading `dataset.toml`: levels, defaults, and what is refused with which words.

use super::*;
use crate::error::ConfigError;
use enfilade_dataset::ColorKind;
use enfilade_explore::{Mode, Preset, VideoConfig};
use enfilade_home::light::Moment;
use enfilade_home::{HomeConfig, RoomKind};
use enfilade_import::EnvironmentOverride;
use enfilade_import::UpAxis;
use enfilade_render::RenderConfig;
use enfilade_verify::view_gates::{GateAction, GateConfig};
use std::path::PathBuf;

fn variable(name: &str) -> Option<String> {
    (name == "ROOMS").then(|| "/rooms".into())
}

fn config_with(text: &str, overrides: &Overrides) -> Config {
    resolve(Path::new("dataset.toml"), text, overrides, &variable).unwrap_or_else(|e| panic!("{e}"))
}

fn config(text: &str) -> Config {
    config_with(text, &Overrides::default())
}

/// The whole message as a user sees it.
fn error(text: &str) -> String {
    let error = resolve(Path::new("sets/dataset.toml"), text, &Overrides::default(), &variable).unwrap_err();
    format!("{error}\nhelp: {}", error.help.as_deref().unwrap_or("-"))
}

const SCENE: &str = "[[scene]]\nname = \"a\"\nfile = \"a.gltf\"\n";

#[test]
fn a_scene_needs_a_name_and_a_file_and_gets_defaults_for_the_rest() {
    let config = config(SCENE);
    let scene = &config.scenes[0];
    assert_eq!((scene.seed, scene.size, scene.fov_x_deg, scene.render.samples), (0, [1024, 768], None, 32));
    assert_eq!((scene.plan.frames, &scene.labels, scene.cameras.len()), (100, &None, 0));
    let file = FileSource::of("a.gltf");
    assert_eq!(scene.source, Source::File(file));
}

#[test]
fn the_scene_wins_over_the_file_and_the_command_line_over_both() {
    let text = format!(
        "seed = 1\nframes = 10\nquality = \"draft\"\n[render]\nmax_bounces = 3\nsize = [64, 48]\n[plan]\ncandidates = 7\n{SCENE}\
         seed = 2\nframes = 20\n[scene.render]\nsamples = 5\nfov_x_deg = 70\n[scene.carve]\nvoxel_m = 0.2\n"
    );
    let scene = config(&text).scenes.remove(0);
    assert_eq!((scene.seed, scene.plan.frames, scene.plan.candidates, scene.size), (2, 20, 7, [64, 48]));
    assert_eq!((scene.render.samples, scene.render.max_bounces, scene.fov_x_deg, scene.carve.voxel_m), (5, Some(3), Some(70.0), 0.2));
    let render = RenderChoices { color: Some(ColorKind::Rendered), ..RenderChoices::default() };
    let overrides = Overrides { seed: Some(9), frames: Some(3), size: Some([8, 6]), quality: Some(Quality::High), render };
    let scene = config_with(&text, &overrides).scenes.remove(0);
    assert_eq!((scene.seed, scene.plan.frames, scene.size, scene.render.samples), (9, 3, [8, 6], Quality::High.samples()));
    assert_eq!(scene.color, ColorKind::Rendered);
}

#[test]
fn limits_of_gates_have_defaults_and_the_scene_wins() {
    assert_eq!(config(SCENE).scenes[0].gate, GateConfig::default());
    let text = format!("[gate]\nmax_plane_share = 0.8\nmin_depth_m = 0.2\n{SCENE}[scene.gate]\nmax_plane_share = 1\naction = \"report\"\n");
    let gate = config(&text).scenes.remove(0).gate;
    assert_eq!((gate.max_plane_share, gate.min_depth_m, gate.action), (1.0, 0.2, enfilade_verify::view_gates::GateAction::Report));
    let share = error(&format!("[gate]\nmax_plane_share = 1.5\n{SCENE}"));
    assert!(share.contains("a share must lie between 0 and 1, found 1.5") && share.contains("2:19"), "{share}");
    assert!(error(&format!("[gate]\nmin_depth_m = -1\n{SCENE}")).contains("0 or more metres, found -1"));
}

#[test]
fn color_is_denoised_unless_asked_otherwise_and_no_library_can_be_named() {
    let chosen = |text: &str| {
        let scene = config(text).scenes.remove(0);
        (scene.color, scene.keep_rendered)
    };
    assert_eq!(chosen(SCENE), (ColorKind::Denoised, true));
    let text = format!("[render]\nkeep_rendered = false\n{SCENE}[scene.render]\ncolor = \"rendered\"\n");
    assert_eq!(chosen(&text), (ColorKind::Rendered, false));
    assert!(error(&format!("[render]\ncolor = \"clean\"\n{SCENE}")).contains("`rendered`"));
    assert!(error(&format!("[render]\ndenoise = true\n{SCENE}")).contains("the key `denoise` is gone"));
    for key in ["denoiser", "denoise_library"] {
        let named = error(&format!("[render]\n{key} = \"$ROOMS/lib\"\n{SCENE}"));
        assert!(named.contains(&format!("2:1: the key `{key}` is gone")) && named.contains("delete this line"), "{named}");
    }
}

#[test]
fn a_key_by_its_name_in_files_of_stored_datasets_is_read() {
    assert!(config(&format!("[render]\nsplits = true\n{SCENE}")).scenes[0].render.light_parts);
}

#[test]
fn choices_of_the_command_line_win_over_the_file_and_its_samples_over_the_quality() {
    let text = format!("[render]\nsamples = 5\nnoise = 0.1\nclamp = 4\ntime_limit_s = 60\nsave_every_s = 5\nlight_parts = true\n{SCENE}");
    let scene = config(&text).scenes.remove(0);
    assert_eq!((scene.render.samples, scene.render.noise, scene.render.clamp), (5, Some(0.1), Some(4.0)));
    assert_eq!((scene.time_limit_s, scene.save_every_s, scene.render.light_parts), (Some(60.0), 5.0, true));
    let render = RenderChoices {
        samples: Some(7),
        noise: Some(0.02),
        max_bounces: Some(3),
        clamp: Some(9.0),
        time_limit_s: Some(1.5),
        ..RenderChoices::default()
    };
    let overrides = Overrides { quality: Some(Quality::High), render, ..Overrides::default() };
    let scene = config_with(&text, &overrides).scenes.remove(0);
    assert_eq!((scene.render.samples, scene.render.noise, scene.render.clamp), (7, Some(0.02), Some(9.0)));
    assert_eq!((scene.render.max_bounces, scene.time_limit_s, scene.render.light_parts), (Some(3), Some(1.5), true));
    let scene = config(SCENE).scenes.remove(0);
    assert_eq!((scene.render.light_parts, scene.time_limit_s, scene.save_every_s), (false, None, 30.0));
    let render = RenderChoices { noise: Some(2.0), ..RenderChoices::default() };
    let error = Config::demo(&Overrides { render, ..Overrides::default() }).unwrap_err();
    assert_eq!(error.to_string(), "the command line: noise must lie between 0 and 1, found 2");
}

#[test]
fn a_scenes_quality_wins_over_the_samples_of_the_file() {
    let scene = config(&format!("render.samples = 5\n{SCENE}quality = \"high\"\n")).scenes.remove(0);
    assert_eq!(scene.render.samples, Quality::High.samples());
}

#[test]
fn a_noise_target_takes_as_many_samples_as_it_needs_unless_its_level_or_one_above_says_how_many() {
    let told = |text: &str, overrides: Overrides| {
        let scene = config_with(text, &overrides).scenes.remove(0);
        (scene.render.samples, scene.render.noise)
    };
    let (nothing, noise) = (Overrides::default(), RenderChoices { noise: Some(0.03), ..RenderChoices::default() });
    let most = Quality::Reference.samples();
    for text in [format!("render.noise = 0.05\n{SCENE}"), format!("quality = \"draft\"\nrender.samples = 9\n{SCENE}render.noise = 0.05\n")]
    {
        assert_eq!(told(&text, nothing.clone()), (most, Some(0.05)), "{text}");
    }
    for text in [format!("render.noise = 0.05\n{SCENE}render.samples = 9\n"), format!("render = {{ noise = 0.05, samples = 9 }}\n{SCENE}")]
    {
        assert_eq!(told(&text, nothing.clone()), (9, Some(0.05)), "{text}");
    }
    let draft = Overrides { quality: Some(Quality::Draft), render: noise, ..Overrides::default() };
    assert_eq!(told(&format!("render.samples = 9\n{SCENE}"), draft), (most, Some(0.03)));
}

#[test]
fn a_reference_is_unbiased_and_another_quality_takes_that_back() {
    let told = |text: &str, quality: Option<Quality>| {
        let scene = config_with(text, &Overrides { quality, ..Overrides::default() }).scenes.remove(0);
        (scene.render.samples, scene.render.noise, scene.render.clamp, scene.color)
    };
    let reference = (Quality::Reference.samples(), Some(0.02), None, ColorKind::Rendered);
    let clamped = format!("render.clamp = 4\n{SCENE}quality = \"reference\"\n");
    assert_eq!(told(&clamped, None), reference);
    assert_eq!(told(SCENE, Some(Quality::Reference)), reference);
    assert_eq!(told(&clamped, Some(Quality::Draft)), (Quality::Draft.samples(), None, None, ColorKind::Denoised));
    // What its own level says besides stands.
    let mine = format!("{SCENE}quality = \"reference\"\nrender.noise = 0.01\nrender.color = \"denoised\"\n");
    assert_eq!(told(&mine, None), (Quality::Reference.samples(), Some(0.01), None, ColorKind::Denoised));
    assert_eq!(
        told(&format!("quality = \"reference\"\n{SCENE}quality = \"high\"\n"), None),
        (Quality::High.samples(), None, None, ColorKind::Denoised)
    );
}

#[test]
fn everything_about_a_scene_can_be_said() {
    let text = "labels = \"../../examples/real-rooms/drake_labels.csv\"\n[import]\nallow_missing_textures = true\n\
        [[scene]]\nname = \"hall\"\nfile = \"$ROOMS/hall.xml\"\n\
        meters_per_unit = 0.4\nup_axis = \"z\"\nlabel_scene = \"modern-hall\"\nscene_type = \"hall\"\nenvironment = { file = \"sky.hdr\", rotation_deg = 90 }\n\
        cameras = [\"door\", { position = [0, 1, 1.5], look_at = [3, 1, 1.2] }]\n[[scene]]\nname = \"home\"\nhome = { seed = 5 }\n";
    let config = config(text);
    let hall = &config.scenes[0];
    let Source::File(file) = &hall.source else { panic!("{:?}", hall.source) };
    assert_eq!((file.file.as_str(), file.meters_per_unit, file.up_axis), ("$ROOMS/hall.xml", 0.4, Some(UpAxis::Z)));
    assert!(file.allow_missing_textures);
    assert_eq!(file.environment, Some(EnvironmentOverride { rotation_deg: 90.0, ..EnvironmentOverride::named("sky.hdr") }));
    assert_eq!(hall.labels, Some(LabelSource { table: "../../examples/real-rooms/drake_labels.csv".into(), scene: "modern-hall".into() }));
    assert_eq!(
        hall.cameras,
        [CameraChoice::Named("door".into()), CameraChoice::Placed { position: [0.0, 1.0, 1.5], look_at: [3.0, 1.0, 1.2] }]
    );
    assert_eq!(hall.scene_type.as_deref(), Some("Hall"), "as Hypersim spells it");
    assert!(error(&format!("{SCENE}scene_type = \"pantry\"\n")).contains("Living room, Office, "));
    // A home knows its own labels.
    assert_eq!((&config.scenes[1].source, &config.scenes[1].labels), (&Source::Home(HomeConfig::of_seed(5)), &None));
}

#[test]
fn a_scenes_camera_replaces_that_of_the_file_and_its_matrix_remembers_the_size() {
    let text = format!(
        "[camera]\nmodel = \"fisheye\"\n[render]\nfov_x_deg = 200\n{SCENE}[[scene]]\nname = \"b\"\nfile = \"b.gltf\"\nrender.size = [64, 48]\n\
         render.fov_x_deg = 90\n[scene.camera]\nK = [[50, 0, 31.5], [0, 50, 23.5], [0, 0, 1]]\nshutter = {{ exposure_s = 0.02 }}\n"
    );
    let error = error(&text.replace("200", "360"));
    assert!(error.contains("fov_x_deg must lie between 0 and 360"), "{error}");
    // The pinhole of scene b cannot be as wide as the file says, but says otherwise itself.
    let overrides = Overrides { size: Some([32, 24]), ..Overrides::default() };
    let [a, b] = config_with(&text, &overrides).scenes.try_into().unwrap();
    assert_eq!((a.camera.model, a.fov_x_deg), (CameraModel::Fisheye, Some(200.0)));
    assert_eq!((b.camera.model, b.camera.k_size, b.size), (CameraModel::Pinhole, Some([64, 48]), [32, 24]));
    let shutter = b.camera.shutter.unwrap();
    assert_eq!((shutter.exposure_s, shutter.readout_s, shutter.frame_time_s), (0.02, 0.0, 1.0));
}

#[test]
fn cameras_that_cannot_be_are_shown_in_place() {
    let text = error(&format!("[camera]\nmodel = \"pinhole\"\ndistortion = [0.1, 0, 0, 0]\n{SCENE}"));
    assert!(text.starts_with("sets/dataset.toml:1:1: `distortion` goes with model radial_tangential or fisheye"), "{text}");
    let text = error(&format!("camera = {{ model = \"fisheyes\" }}\n{SCENE}"));
    assert!(text.starts_with("sets/dataset.toml:1:20: ") && text.contains("`fisheye`"), "{text}");
    let text = error(&format!("[camera]\nlense = {{ blades = 3 }}\n{SCENE}"));
    assert!(text.contains("did you mean `lens`?"), "{text}");
}

#[test]
fn a_mode_of_trajectories_has_keys_of_its_own() {
    let text = format!(
        "[plan]\nlevel = true\ncamera_height_m = [1.4, 1.7]\n{SCENE}[scene.plan]\nmode = {{ kind = \"video\", fps = 30 }}\nmin_depth_m = 0.4\n"
    );
    let plan = config(&text).scenes.remove(0).plan;
    let video = VideoConfig { fps: 30.0, ..VideoConfig::default() };
    assert_eq!((plan.mode, plan.level, plan.camera_height_m, plan.min_depth_m), (Mode::Video(video), true, Some([1.4, 1.7]), 0.4));
    let text = error(&format!("{SCENE}[scene.plan]\nmode = {{ kind = \"vidio\" }}\n"));
    assert!(text.starts_with("sets/dataset.toml:5:") && text.contains("`vidio`") && text.contains("`keyframes`"), "{text}");
    let text = error(&format!("{SCENE}[scene.plan]\nmode = {{ kind = \"video\", max_sped_m_s = 2 }}\n"));
    assert!(text.starts_with("sets/dataset.toml:5:") && text.contains("did you mean `max_speed_m_s`?"), "{text}");
    let text = error(&format!("{SCENE}[scene.plan]\nmode = {{ kind = \"walk\", step_m = [1, 1, 0] }}\n"));
    assert!(text.starts_with("sets/dataset.toml:5:") && text.contains("mode walk has no key `step_m`"), "{text}");
    let text = error(&format!("{SCENE}[scene.plan]\nmode = {{ kind = \"keyframes\", files = [\"$NOWHERE/a.csv\"] }}\n"));
    assert!(text.contains("the environment variable NOWHERE is not set"), "{text}");
}

#[test]
fn a_walk_is_a_mode_without_keys() {
    let text = format!("[plan]\nmode = {{ kind = \"stills\" }}\n{SCENE}[scene.plan]\nmode = {{ kind = \"walk\" }}\n");
    let mode = config(&text).scenes.remove(0).plan.mode;
    assert_eq!(mode, Mode::default());
    let stored = serde_json::to_string(&mode).unwrap();
    assert_eq!((stored.as_str(), serde_json::from_str::<Mode>(&stored).unwrap()), ("{\"kind\":\"walk\"}", mode));
}

#[test]
fn unknown_keys_are_shown_in_place_with_the_closest_known_key() {
    assert_eq!(
        error(&format!("[render]\nsize = [4, 3]\nsampels = 3\n{SCENE}")),
        "sets/dataset.toml:3:1: unknown key `sampels`\n  3 | sampels = 3\n    | ^^^^^^^\nhelp: did you mean `samples`? known keys here: \
         size, fov_x_deg, time_limit_s, save_every_s, color, keep_rendered, samples, adaptive, noise, guiding, max_bounces, clamp, light_parts, fixtures, extra, lambertian, roulette_start, filter, filter_radius"
    );
    let text = error(&format!("{SCENE}meter_per_unit = 3\n"));
    assert!(
        text.starts_with("sets/dataset.toml:4:1: unknown key `meter_per_unit`") && text.contains("did you mean `meters_per_unit`?"),
        "{text}"
    );
    let text = error(&format!("{SCENE}cameras = [{{ position = [0, 0, 0], lookat = [1, 0, 0] }}]\n"));
    assert!(text.starts_with("sets/dataset.toml:4:36: unknown key `lookat`") && text.contains("did you mean `look_at`?"), "{text}");
    assert!(error("[[scenes]]\nname = \"a\"\n").contains("did you mean `scene`?"));
}

#[test]
fn keys_that_are_gone_are_named_with_what_to_do() {
    assert_eq!(
        error(&format!("[render]\nreuse = false\n{SCENE}")),
        "sets/dataset.toml:2:1: the key `reuse` is gone\n  2 | reuse = false\n    | ^^^^^\n\
         help: pixels no longer share light, which is what `reuse = false` asked for: delete this line"
    );
}

#[test]
fn wrong_types_and_syntax_are_shown_in_place() {
    let text = error("frames = \"many\"\n");
    let start = "sets/dataset.toml:1:10: invalid type: string \"many\", expected a whole number of at least 0\n  1 | frames = \"many\"";
    assert!(text.starts_with(start), "{text}");
    let text = error("frames = 3\nname \"x\"\n");
    assert!(text.starts_with("sets/dataset.toml:2:6: "), "{text}");
    assert!(error(&format!("quality = \"best\"\n{SCENE}")).contains("`draft`, `normal`, `high`"));
    assert!(error(&format!("{SCENE}cameras = [3]\n")).contains("a camera's name, or a table"));
}

#[test]
fn what_was_meant_by_a_text_is_proposed_with_its_key() {
    for (text, help) in [
        (format!("frames = \"1\"\n{SCENE}"), "help: write frames = 1"),
        (format!("[render]\nnoise = \"2%\"\n{SCENE}"), "help: write noise = 0.02"),
        (format!("render = {{ samples = 4, light_parts = \"true\" }}\n{SCENE}"), "help: write light_parts = true"),
        (format!("[plan]\nmode = \"walk\"\n{SCENE}"), "help: write mode = { kind = \"walk\" }"),
        // The reader does not tell where in the table of a mode it is.
        (format!("[plan]\nmode = {{ kind = \"video\", fps = \"24\" }}\n{SCENE}"), "help: write 24"),
    ] {
        let found = error(&text);
        assert!(found.ends_with(help) && !found.contains("u32") && !found.contains("f32") && !found.contains("enum"), "{found}");
    }
}

#[test]
fn values_that_carving_and_planning_refuse_are_shown_in_place() {
    for (text, start) in [
        (format!("[plan]\noverlap = [0.8, 0.3]\n{SCENE}"), "sets/dataset.toml:2:11: overlap = [0.8, 0.3]: expected two shares"),
        (format!("[plan]\nclearance_m = -1\n{SCENE}"), "sets/dataset.toml:2:15: clearance_m = -1: expected a length"),
        (format!("[plan]\nmode = {{ kind = \"video\", fps = 0 }}\n{SCENE}"), "sets/dataset.toml:2:8: fps = 0: expected a number"),
        (
            format!("[plan]\nmode = {{ kind = \"keyframes\", files = [] }}\n{SCENE}"),
            "sets/dataset.toml:2:8: files = []: expected at least one file of poses",
        ),
        // The one that counts, and not the one that it replaces.
        (format!("[plan]\nclearance_m = 1\n{SCENE}plan.clearance_m = -1\n"), "sets/dataset.toml:6:20: clearance_m = -1"),
        (
            format!("[plan]\noverlap = [0.2, 0.8]\n{SCENE}[scene.plan]\nmode = {{ kind = \"stills\" }}\n"),
            "sets/dataset.toml:2:11: overlap = [0.2, 0.8] with mode stills: expected mode walk",
        ),
        (format!("[carve]\nvoxel_m = 0\n{SCENE}"), "sets/dataset.toml:2:11: voxel_m = 0: expected a positive length"),
        (format!("[carve]\nrays = 0\n{SCENE}"), "sets/dataset.toml:2:8: rays = 0: expected 64 or more"),
        (format!("[carve]\niterations = 0\n{SCENE}"), "sets/dataset.toml:2:14: iterations = 0: expected 1 or more"),
        // A voxel that the given cube cannot hold.
        (format!("[carve]\nextent_m = 1\n{SCENE}carve.voxel_m = 2\n"), "sets/dataset.toml:2:12: extent_m = 1: expected a length of at"),
    ] {
        let found = error(&text);
        assert!(found.starts_with(start) && !found.ends_with("help: -"), "{found}");
    }
}

#[test]
fn files_of_late_stages_are_read_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("good.csv", "name,nyu40_id\na,7\n");
    write("class.csv", "name,nyu40_id\na,99\n");
    write("twice.csv", "name,nyu40_id\na,7\na,8\n");
    write("header.csv", "thing,kind\na,7\n");
    let place = folder.path().display().to_string();
    let read = |text: &str| resolve(&folder.path().join("dataset.toml"), text, &Overrides::default(), &|_| Some(place.clone()));
    assert!(read(&format!("labels = \"good.csv\"\n{SCENE}")).is_ok());
    assert!(read(&format!("labels = \"$ROOMS/good.csv\"\n{SCENE}")).is_ok());
    for (keys, words) in [
        ("labels = \"nope.csv\"", "there is no label table"),
        ("labels = \".\"", "there is no label table"),
        ("labels = \"$ROOMS/class.csv\"", "class.csv:2: class 99 is out of range"),
        ("labels = \"twice.csv\"", "twice.csv:3: \"a\" is 8"),
        ("labels = \"header.csv\"", "header.csv:1: no column"),
        ("camera = { model = \"ray_grid\", ray_grid = \"nope.hdf5\" }", "there is no ray grid"),
        ("camera = { model = \"ray_grid\", ray_grid = \"good.csv\" }", "good.csv"),
    ] {
        let error = read(&format!("{keys}\n{SCENE}")).unwrap_err();
        let (text, line) = (error.to_string(), error.place.as_ref().map(|place| place.line));
        assert!(text.contains(words) && line == Some(1) && error.help.is_some(), "{text}");
    }
    // A table that no scene uses may be missing: a home knows its own labels.
    assert!(read("labels = \"nope.csv\"\n[[scene]]\nname = \"home\"\nhome = {}\n").is_ok());
}

#[test]
fn values_out_of_range_are_shown_with_an_example() {
    for (text, start) in [
        (format!("frames = 0\n{SCENE}"), "sets/dataset.toml:1:10: frames must lie between 1 and 10000, found 0"),
        (
            format!("[render]\nsize = [0, 5]\n{SCENE}"),
            "sets/dataset.toml:2:8: width and height must lie between 1 and 16384 pixels, found 0 x 5",
        ),
        (format!("[render]\nsamples = 0\n{SCENE}"), "sets/dataset.toml:2:11: samples must be at least 1"),
        (format!("[render]\nnoise = 2\n{SCENE}"), "sets/dataset.toml:2:9: noise must lie between 0 and 1, found 2"),
        (
            format!("[render]\nfilter_radius = -1\n{SCENE}"),
            "sets/dataset.toml:2:17: filter_radius must lie between 0 and 16 pixels, found -1",
        ),
        (format!("[render]\nfilter_radius = 17\n{SCENE}"), "sets/dataset.toml:2:17: filter_radius must lie between 0 and 16"),
        (format!("{SCENE}render.clamp = 0\n"), "sets/dataset.toml:4:16: clamp must be above 0, found 0"),
        (format!("[render]\ntime_limit_s = -1\n{SCENE}"), "sets/dataset.toml:2:16: time_limit_s must be above 0, found -1"),
        (format!("[render]\nsave_every_s = nan\n{SCENE}"), "sets/dataset.toml:2:16: save_every_s must be at least 0, found NaN"),
        (format!("{SCENE}render.fov_x_deg = 180\n"), "sets/dataset.toml:4:20: fov_x_deg must lie between 0 and 180"),
        (format!("{SCENE}meters_per_unit = -1.0\n"), "sets/dataset.toml:4:19: meters_per_unit: found -1; expected a number above zero"),
    ] {
        let found = error(&text);
        assert!(found.starts_with(start) && !found.ends_with("help: -"), "{found}");
    }
}

/// A number of `[render]` that is out of its range, its key, and what is said of it.
type Wrong = (&'static str, f32, &'static str);

#[test]
fn file_command_line_program_and_renderer_refuse_the_same_values_in_the_same_words() {
    let wrong: [Wrong; 8] = [
        ("noise", 0.0, "noise must lie between 0 and 1, found 0"),
        ("noise", 1.0, "noise must lie between 0 and 1, found 1"),
        ("noise", 2.5, "noise must lie between 0 and 1, found 2.5"),
        ("noise", -0.5, "noise must lie between 0 and 1, found -0.5"),
        ("clamp", 0.0, "clamp must be above 0, found 0"),
        ("clamp", -4.0, "clamp must be above 0, found -4"),
        ("clamp", f32::INFINITY, "clamp must be above 0, found inf"),
        ("samples", 0.0, "samples must be at least 1, found 0"),
    ];
    for (key, value, message) in wrong {
        let in_file = error(&format!("[render]\n{key} = {value}\n{SCENE}"));
        assert!(in_file.starts_with(&format!("sets/dataset.toml:2:{}: {message}\n", key.len() + 4)), "{in_file}");
        let (mut choices, mut render) = (RenderChoices::default(), RenderConfig::default());
        match key {
            "noise" => (choices.noise, render.noise) = (Some(value), Some(value)),
            "clamp" => (choices.clamp, render.clamp) = (Some(value), Some(value)),
            _ => (choices.samples, render.samples) = (Some(value as u32), value as u32),
        }
        assert_eq!(choices.check().unwrap_err().to_string(), format!("the command line: {message}"));
        let overrides = Overrides { render: choices, ..Overrides::default() };
        assert_eq!(Config::demo(&overrides).unwrap_err().to_string(), format!("the command line: {message}"));
        assert_eq!(render.validate().unwrap_err().to_string(), message);
        let mut config = Config::demo(&Overrides::default()).unwrap();
        config.scenes[0].render = render;
        assert_eq!(config.check().unwrap_err().to_string(), format!("scene \"home\": {message}"));
    }
    for (key, value) in [("noise", 1e-6), ("noise", 0.999), ("clamp", 1e-6), ("clamp", 1e6), ("samples", 1.0)] {
        config(&format!("[render]\n{key} = {value}\n{SCENE}")).check().unwrap();
    }
}

#[test]
fn values_that_another_level_replaces_are_not_refused() {
    let text = format!("[render]\nnoise = 2\n{SCENE}render.noise = 0.1\n");
    assert_eq!(config(&text).scenes[0].render.noise, Some(0.1));
    // The place is that of the value which counts.
    let text = error(&format!("[render]\nnoise = 0.1\n[gate]\nmin_depth_m = 0.2\n{SCENE}render.noise = 2\n"));
    assert!(text.starts_with("sets/dataset.toml:8:16: noise must lie"), "{text}");
    let text = error(&format!("[gate]\nmin_depth_m = 0.2\n{SCENE}gate.min_depth_m = -1\n"));
    assert!(text.starts_with("sets/dataset.toml:6:20: a length must be"), "{text}");
}

#[test]
fn scenes_that_cannot_be_made_are_told() {
    assert!(error("name = \"x\"\n").starts_with("sets/dataset.toml: there is no [[scene]] in it\nhelp: add at least one:"));
    assert!(error("[[scene]]\nname = \"a\"\n").contains("sets/dataset.toml:2:8: a scene needs either `file` or `home`"));
    assert!(error(&format!("{SCENE}home = {{}}\n")).contains("a scene needs either `file` or `home`"));
    assert!(error(&format!("{SCENE}{SCENE}")).starts_with("sets/dataset.toml:5:8: two scenes have the name \"a\""));
    assert!(error("[[scene]]\nname = \"my room\"\nhome = {}\n").contains("\"my room\" cannot be the name of a scene"));
    let text = error("[[scene]]\nname = \"a\"\nfile = \"$NOWHERE/a.gltf\"\n");
    assert!(text.starts_with("sets/dataset.toml:3:8: the environment variable NOWHERE is not set"), "{text}");
}

#[test]
fn resolved_configurations_survive_json() {
    for config in [Config::demo(&Overrides::default()).unwrap(), config(&format!("{SCENE}cameras = [\"c\"]\n"))] {
        let text = serde_json::to_string(&config).unwrap();
        assert_eq!(serde_json::from_str::<Config>(&text).unwrap(), Config { base: PathBuf::new(), ..config });
    }
}

#[test]
fn stored_configurations_of_older_versions_are_read_and_unknown_keys_refused() {
    let config = config(&format!(
        "labels = \"../../examples/real-rooms/drake_labels.csv\"\n{SCENE}cameras = [{{ position = [0, 1, 1], look_at = [3, 1, 1] }}]\n"
    ));
    let stored = serde_json::to_value(&config).unwrap();
    for place in ["", "/scenes/0", "/scenes/0/source/file", "/scenes/0/labels", "/scenes/0/cameras/0"] {
        let mut changed = stored.clone();
        changed.pointer_mut(place).unwrap()["sampels"] = 3.into();
        assert!(serde_json::from_value::<Config>(changed).is_err(), "{place}");
    }
    // What the first version did not have.
    let mut old = stored;
    for key in ["camera", "gate", "time_limit_s", "save_every_s", "keep_rendered", "denoiser"] {
        old["scenes"][0].as_object_mut().unwrap().remove(key);
    }
    let expected = Config { base: PathBuf::new(), ..config };
    assert_eq!(serde_json::from_value::<Config>(old.clone()).unwrap(), expected);
    // What a later version had, and no longer has.
    old["scenes"][0]["denoiser"] = "/usr/lib/libOpenImageDenoise.so.2".into();
    assert_eq!(serde_json::from_value::<Config>(old).unwrap(), expected);
}

/// A change of a scene, and what refuses it.
type Change = (fn(&mut SceneConfig), &'static str);

#[test]
fn what_a_program_puts_together_is_refused_as_a_file_is() {
    let demo = Config::demo(&Overrides::default()).unwrap();
    demo.check().unwrap();
    config(&format!("[gate]\nmin_depth_m = 0.2\n[camera]\nmodel = \"fisheye\"\n[render]\nfov_x_deg = 200\n{SCENE}")).check().unwrap();
    let refused = |change: &dyn Fn(&mut Config)| {
        let mut config = demo.clone();
        change(&mut config);
        config.check().unwrap_err().to_string()
    };
    assert_eq!(refused(&|config| config.scenes.clear()), "the configuration has no scenes");
    assert_eq!(refused(&|config| config.scenes.push(config.scenes[0].clone())), "two scenes have the name \"home\"");
    assert_eq!(refused(&|config| config.scenes[0].name = "../x".into()), "\"../x\" cannot be the name of a scene");
    let changes: [Change; 9] = [
        (|scene| scene.size = [0, 5], "width and height must lie between 1 and 16384 pixels, found 0 x 5"),
        (|scene| scene.plan.frames = 0, "frames must lie between 1 and 10000, found 0"),
        (|scene| scene.render.samples = 0, "samples must be at least 1"),
        (|scene| scene.fov_x_deg = Some(180.0), "fov_x_deg must lie between 0 and 180, found 180"),
        (|scene| scene.save_every_s = -1.0, "save_every_s must be at least 0, found -1"),
        (|scene| scene.source = Source::Home(HomeConfig { clutter: 9.0, ..HomeConfig::default() }), "in `home`: clutter must lie between"),
        (|scene| scene.camera.cam_from_uv = Some([[0.0; 3]; 3]), "in `camera`: `cam_from_uv` goes with model tilted_pinhole"),
        (|scene| scene.carve.rays = 0, "in `carve`: rays = 0: expected"),
        (|scene| scene.gate.max_plane_share = 1.5, "in `gate`: a share must lie between 0 and 1, found 1.5"),
    ];
    for (change, expected) in changes {
        let found = refused(&|config| change(&mut config.scenes[0]));
        assert!(found.starts_with(&format!("scene \"home\": {expected}")), "{found}");
    }
}

#[test]
fn the_demo_is_one_room_and_takes_overrides() {
    let config = Config::demo(&Overrides {
        seed: Some(4),
        frames: Some(2),
        size: Some([64, 48]),
        quality: Some(Quality::Draft),
        ..Overrides::default()
    })
    .unwrap();
    let scene = &config.scenes[0];
    let room = HomeConfig { rooms: vec![RoomKind::Living], moment: Some(Moment::Day), ..HomeConfig::of_seed(4) };
    assert_eq!((config.scenes.len(), &scene.source, scene.plan.frames, scene.size), (1, &Source::Home(room), 2, [64, 48]));
    assert_eq!(scene.render.samples, Quality::Draft.samples());
    let error = Config::demo(&Overrides { frames: Some(0), ..Overrides::default() }).unwrap_err();
    assert_eq!(error.to_string(), "the command line: frames must lie between 1 and 10000, found 0");
}

#[test]
fn the_example_is_a_valid_configuration() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/real-rooms/dataset.toml");
    let text = std::fs::read_to_string(&file).unwrap();
    // Its scenes lie elsewhere; so does the label table, which is read.
    let scenes = tempfile::tempdir().unwrap();
    std::fs::write(scenes.path().join("material_to_nyu40.csv"), "scene,material,nyu40_id\n").unwrap();
    let variable = |_: &str| Some(scenes.path().display().to_string());
    let config = resolve(&file, &text, &Overrides::default(), &variable).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(config.scenes.len(), 8);
    assert!(config.scenes.iter().all(|s| s.labels.is_some()));
}

#[test]
fn the_cameras_of_the_page_are_valid_configurations() {
    let page = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/cameras.md")).unwrap();
    let block = page.split("```toml").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let cameras: Vec<&str> = block.split("[camera]").skip(1).collect();
    assert_eq!(cameras.len(), 4);
    for camera in cameras {
        assert_ne!(config(&format!("[camera]{camera}\n{SCENE}")).scenes[0].camera, CameraConfig::default());
    }
}

#[test]
fn patterns_choose_scenes_and_a_typing_mistake_gets_a_proposal() {
    let config = Config::demo(&Overrides::default()).unwrap();
    assert_eq!(config.select(Some("h*e")).unwrap().len(), 1);
    assert_eq!(config.select(Some("x, home")).unwrap().len(), 1);
    let error = config.select(Some("hom")).unwrap_err();
    assert_eq!(error.hint().unwrap(), "did you mean \"home\"? the scenes are: home");
}

#[test]
fn seeds_differ_by_scene_and_purpose() {
    let scene = Config::demo(&Overrides::default()).unwrap().scenes.remove(0);
    let other = SceneConfig { name: "b".into(), ..scene.clone() };
    assert_ne!(scene.seed_for("plan"), scene.seed_for("render"));
    assert_ne!(scene.seed_for("plan"), other.seed_for("plan"));
}

/// The configuration of a scene for each of these homes.
fn homes(homes: &[&str], overrides: &Overrides) -> Result<Config, ConfigError> {
    let scene = |(i, home): (usize, &&str)| format!("[[scene]]\nname = \"home_{i}\"\nhome = {home}\n");
    let text: String = homes.iter().enumerate().map(scene).collect();
    resolve(Path::new("dataset.toml"), &text, overrides, &|_| None)
}

#[test]
fn homes_are_photographed_where_nobody_asks_for_walks() {
    let mode = |above: &str, keys: &str| {
        let found = config(&format!("{above}[[scene]]\nname = \"flat\"\nhome = {{}}\n{keys}"));
        found.scenes[0].plan.mode.name()
    };
    assert_eq!(mode("", ""), "photos");
    assert_eq!(mode("[plan]\npitch_limits_deg = [-20, 0]\n", ""), "photos");
    for walks in ["[plan]\nmode = { kind = \"walk\" }\n", "[plan]\noverlap = [0.3, 0.8]\n", "preset = \"paper\"\n"] {
        assert_eq!(mode(walks, ""), "walk", "{walks}");
    }
    assert_eq!(mode("", "plan.saliency = { kind = \"parts\" }\n"), "walk");
    assert_eq!(mode("[plan]\nmode = { kind = \"walk\" }\n", "plan.mode = { kind = \"stills\" }\n"), "stills");
    assert_eq!(config(SCENE).scenes[0].plan.mode.name(), "walk", "files keep walks");
    assert_eq!(Config::demo(&Overrides::default()).unwrap().scenes[0].plan.mode.name(), "walk");
}

#[test]
fn homes_keep_their_own_seeds_whatever_the_command_line_says() {
    let overrides = Overrides { seed: Some(9), ..Overrides::default() };
    let config = homes(&["{ seed = 1 }", "{ seed = 2 }", "{}"], &overrides).unwrap();
    let sources: Vec<Source> = config.scenes.iter().map(|scene| scene.source.clone()).collect();
    assert_eq!(sources, [1, 2, 9].map(|seed| Source::Home(HomeConfig::of_seed(seed))));
    assert!(config.scenes.iter().all(|scene| scene.seed == 9));
}

#[test]
fn the_plan_of_a_home_must_be_there_and_has_its_own_shape() {
    let refused = |home: &str| homes(&[home], &Overrides::default()).unwrap_err().to_string();
    assert!(
        refused("{ plan = \"nowhere.json\" }").contains("there is no floor plan nowhere.json"),
        "{}",
        refused("{ plan = \"nowhere.json\" }")
    );
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("plan.json");
    std::fs::write(&file, "{}").unwrap();
    let both = refused(&format!("{{ plan = {:?}, shape = \"varied\" }}", file.display().to_string()));
    assert!(both.contains("leave `shape` out"), "{both}");
    assert!(refused("{ shape = \"round\" }").contains("`rectangular`"), "{}", refused("{ shape = \"round\" }"));
}

#[test]
fn one_home_for_two_scenes_is_refused_unless_both_say_its_seed() {
    for same in [["{}", "{}"], ["{ seed = 0 }", "{}"], ["{}", "{ seed = 0 }"]] {
        let error = homes(&same, &Overrides::default()).unwrap_err();
        let text = error.to_string();
        let message = "the scenes \"home_0\" and \"home_1\" would be the same home";
        assert!(text.starts_with("dataset.toml:6:") && text.contains(message), "{text}");
        assert!(error.help.unwrap().contains("give each a seed"));
    }
    for allowed in [["{ seed = 4 }", "{ seed = 4 }"], ["{}", "{ clutter = 0 }"], ["{}", "{ seed = 1 }"]] {
        assert!(homes(&allowed, &Overrides::default()).is_ok(), "{allowed:?}");
    }
}

#[test]
fn a_preset_is_one_word_for_rules_gates_and_camera_over_which_every_key_wins() {
    let of = |preset: &str| config(&format!("preset = \"{preset}\"\n{SCENE}")).scenes.remove(0);
    let (default, paper, hypersim) = (of("default"), of("paper"), of("hypersim"));
    assert_eq!(default, config(SCENE).scenes.remove(0));
    for (scene, preset) in [(&paper, Preset::Paper), (&hypersim, Preset::Hypersim)] {
        assert_eq!((scene.carve.preset, scene.plan.preset, scene.gate.action), (preset, preset, GateAction::Report));
        assert_eq!((scene.size, scene.fov_x_deg), ([1024, 768], Some(60.0)));
    }
    assert_eq!((paper.plan.clearance_m, hypersim.plan.clearance_m), (0.0, default.plan.clearance_m));
    // A scene's own preset wins over the file's, and keys win wherever they stand.
    let text = format!("preset = \"paper\"\n[render]\nsize = [64, 48]\n[gate]\naction = \"reject\"\n{SCENE}preset = \"hypersim\"\n");
    let scene = config(&text).scenes.remove(0);
    assert_eq!((scene.plan.preset, scene.size, scene.gate.action), (Preset::Hypersim, [64, 48], GateAction::Reject));
    // A camera that says its field of view itself keeps it.
    let tilted = config(&format!("preset = \"hypersim\"\n{SCENE}[scene.camera]\nmodel = \"equirectangular\"\n")).scenes.remove(0);
    assert_eq!(tilted.fov_x_deg, None);
}

#[test]
fn the_papers_preset_has_the_supplements_numbers() {
    let scene = config(&format!("preset = \"paper\"\n{SCENE}")).scenes.remove(0);
    let plan = &scene.plan;
    assert_eq!((plan.frames, plan.queries, plan.candidates), (100, 1000, 20));
    assert_eq!((plan.step_m, plan.height_range_m, plan.roll_limit_deg), ([1.5, 1.5, 0.25], 0.25, 5.0));
    assert_eq!(plan.saliency, enfilade_explore::Saliency::Triangles { alpha: 1.0, beta: 2.0 });
    assert_eq!((plan.test_width, plan.test_height), (256, 192));
    assert_eq!((scene.carve.rays, scene.size, scene.fov_x_deg), (262_144, [1024, 768], Some(60.0)));
}

#[test]
fn keys_of_rules_that_a_preset_does_not_have_are_refused_where_they_stand() {
    let text = error(&format!("preset = \"paper\"\n{SCENE}[scene.plan]\nclearance_m = 0.4\n"));
    assert!(text.contains("preset \"paper\" has no rule for `clearance_m`") && text.contains("dataset.toml:6"), "{text}");
    let text = error(&format!("preset = \"hypersim\"\n[plan]\nroll_limit_deg = 3\n{SCENE}"));
    assert!(text.contains("preset \"hypersim\" has no rule for `roll_limit_deg`"), "{text}");
    // Keys for other scenes do not count.
    config(&format!("[plan]\nclearance_m = 0.4\n{SCENE}preset = \"paper\"\n[[scene]]\nname = \"b\"\nfile = \"b.obj\"\n"));
    assert!(error(&format!("preset = \"papr\"\n{SCENE}")).contains("papr"));
}

#[test]
fn cameras_are_a_list_or_found() {
    let scene = config(&format!("{SCENE}cameras = \"found\"\n")).scenes.remove(0);
    assert!(scene.finds_cameras && scene.cameras.is_empty());
    let text = error(&format!("{SCENE}cameras = \"door\"\n"));
    assert!(text.contains("a list of cameras, or \"found\""), "{text}");
}

/// A folder of files like a collection's, and a configuration beside them.
fn collection() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for file in ["hssd/scenes/2.scene_instance.json", "hssd/scenes/10.scene_instance.json", "s3d/scene_7/annotation_3d.json", "a b$.glb"] {
        let path = folder.path().join(file);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, "").unwrap();
    }
    folder
}

fn of_collection(folder: &Path, text: &str) -> Result<Config, String> {
    let lookup = |name: &str| (name == "DATA").then(|| folder.display().to_string());
    let resolved = resolve(&folder.join("dataset.toml"), text, &Overrides::default(), &lookup);
    resolved.map_err(|e| format!("{e}\nhelp: {}", e.help.as_deref().unwrap_or("-")))
}

#[test]
fn every_file_that_a_pattern_means_is_a_scene_in_the_order_of_the_paths() {
    let folder = collection();
    let named = |text: &str| -> Vec<(String, String)> {
        let scenes = of_collection(folder.path(), text).unwrap_or_else(|e| panic!("{e}")).scenes;
        let file = |source: &Source| if let Source::File(file) = source { file.file.clone() } else { panic!("a home") };
        scenes.iter().map(|scene| (scene.name.clone(), file(&scene.source))).collect()
    };
    let pair = |name: &str, file: &str| (name.to_string(), file.to_string());
    let text = "[[scene]]\nfiles = \"hssd/scenes/*.scene_instance.json\"\nframes = 7\n[[scene]]\nname = \"x\"\nfile = \"x.glb\"\n";
    let expected = [pair("10", "hssd/scenes/10.scene_instance.json"), pair("2", "hssd/scenes/2.scene_instance.json"), pair("x", "x.glb")];
    assert_eq!(named(text), expected);
    let scenes = of_collection(folder.path(), text).unwrap().scenes;
    assert_eq!(scenes.iter().map(|scene| scene.plan.frames).collect::<Vec<_>>(), [7, 7, 100]);
    assert_eq!(named("[[scene]]\nfiles = \"s3d/*/annotation_3d.json\"\n"), [pair("scene_7", "s3d/scene_7/annotation_3d.json")]);
    // Variables stay in the path, so that the dataset can move; a dollar sign of a name is doubled.
    assert_eq!(named("[[scene]]\nfiles = \"$DATA/*.glb\"\n"), [pair("a_b_", "$DATA/a b$$.glb")]);
    assert_eq!(named("[[scene]]\nfiles = \"s3d/scene_7/annotation_3d.json\"\n"), [pair("annotation_3d", "s3d/scene_7/annotation_3d.json")]);
}

#[test]
fn patterns_that_mean_nothing_or_stand_beside_a_name_are_refused_at_their_place() {
    let folder = collection();
    let error = |text: &str| of_collection(folder.path(), text).unwrap_err();
    let message = error("[[scene]]\nfiles = \"hssd/scene/*.scene_instance.json\"\n");
    assert!(message.contains("dataset.toml:2:9: no file is called \"hssd/scene/*.scene_instance.json\" in "), "{message}");
    assert!(
        message.contains("help: there is \"hssd\", but nothing in it is called \"scene\", so the rest was not looked for; `*`"),
        "{message}"
    );
    let message = error("[[scene]]\nfiles = \"hssd/scenes/*.glb\"\n");
    assert!(message.contains("there is \"hssd/scenes\", but nothing in it is called \"*.glb\"; "), "{message}");
    let message = error("[[scene]]\nname = \"a\"\nfiles = \"*.glb\"\n");
    assert!(message.contains("dataset.toml:3:9: `files` cannot be combined with `name`, `file`, `home` or `count`"), "{message}");
    let message = error("[[scene]]\nfiles = \"hssd/scenes/*\"\n[[scene]]\nname = \"2\"\nfile = \"2.glb\"\n");
    assert!(message.contains("two scenes have the name \"2\""), "{message}");
    let message = error("[[scene]]\nfile = \"2.glb\"\n");
    assert!(message.contains("dataset.toml:1:1: missing field `name`"), "{message}");
    assert!(error("[[scene]]\nfiles = \"$NONE/*\"\n").contains("the environment variable NONE is not set"));
}

#[test]
fn a_table_of_many_homes_numbers_them_and_their_seeds() {
    let homes = |text: &str| -> Vec<(String, u64)> {
        let seed = |source: &Source| if let Source::Home(home) = source { home.seed } else { panic!("a file") };
        config(text).scenes.iter().map(|scene| (scene.name.clone(), seed(&scene.source))).collect()
    };
    let named = |name: &str, seed: u64| (name.to_string(), seed);
    assert_eq!(homes("[[scene]]\nname = \"h\"\ncount = 2\nhome = { seed = 7 }\n"), [named("h_0", 7), named("h_1", 8)]);
    let eleven = homes("seed = 5\n[[scene]]\nname = \"h\"\ncount = 11\nhome = {}\n");
    assert_eq!((&eleven[0], &eleven[10]), (&named("h_00", 5), &named("h_10", 15)));
    assert_eq!(homes("[[scene]]\nname = \"h\"\ncount = 1\nhome = {}\n"), [named("h_0", 0)]);

    let wrong = |keys: &str| error(&format!("[[scene]]\nname = \"h\"\n{keys}\n"));
    let text = wrong("count = 0\nhome = {}");
    assert!(text.contains("dataset.toml:3:9: count must lie between 1 and 100000, found 0"), "{text}");
    let text = wrong("count = 2\nfile = \"a.glb\"");
    assert!(text.contains("dataset.toml:3:9: `count` needs `home`"), "{text}");
    let text = error("[[scene]]\nname = \"a\"\ncount = 3\nhome = {}\n[[scene]]\nname = \"b\"\nhome = {}\nseed = 2\n");
    assert!(text.contains("the scenes \"a_2\" and \"b\" would be the same home"), "{text}");
}

#[test]
fn words_are_written_alike_in_files_and_on_the_command_line() {
    fn check<T: Copy + serde::Serialize>(all: &[T], name: impl Fn(T) -> &'static str) {
        for &value in all {
            assert_eq!(serde_json::to_value(value).unwrap(), name(value));
        }
    }
    check(&Quality::ALL, Quality::name);
    check(&ColorKind::ALL, ColorKind::name);
    check(&Lamps::ALL, Lamps::name);
    check(&Moment::ALL, Moment::name);
    check(&RoomKind::ALL, RoomKind::name);
    check(&enfilade_home::Building::ALL, enfilade_home::Building::name);
    check(&enfilade_home::RoomShape::ALL, enfilade_home::RoomShape::name);
    check(&enfilade_render::Filter::ALL, enfilade_render::Filter::name);
    check(&GateAction::ALL, GateAction::name);
}

#[test]
fn keys_of_a_scene_win_over_those_of_import_one_by_one() {
    let text = "[import]\nmeters_per_unit = 0.01\npanes = [\"glass\"]\n[[scene]]\nname = \"a\"\nfile = \"a.obj\"\npanes = []\n\
        drop_doubled_faces = true\nup_axis = \"-z\"\n";
    let config = resolve(Path::new("a.toml"), text, &Overrides::default(), &|_| None).unwrap();
    let Source::File(source) = &config.scenes[0].source else { panic!() };
    let expected = FileSource { meters_per_unit: 0.01, drop_doubled_faces: true, ..FileSource::of("a.obj") };
    assert_eq!(*source, FileSource { up_axis: Some(UpAxis::MinusZ), ..expected });
}

#[test]
fn products_of_which_nothing_could_be_made_are_refused() {
    let text = error(&format!("products = [\"flow\"]\n{SCENE}"));
    assert!(text.contains("flow follows the list of pairs") && text.contains("{ flow = { step = 1 } }"), "{text}");
    let found = config(&format!("products = [\"flow\", \"pairs\"]\n{SCENE}products = [{{ flow = {{ step = 2 }} }}]\n"));
    assert_eq!(found.scenes[0].products.len(), 1, "the scene's own list");
}

#[test]
fn objects_are_groups_of_the_file_or_of_a_scene() {
    let group = |on: &str| format!("files = \"models/*.glb\"\non = \"{on}\"\n");
    let scene = |name: &str| format!("[[scene]]\nname = \"{name}\"\nfile = \"a.glb\"\n");
    let text = format!("[[object]]\n{}{}{}[[scene.object]]\n{}", group("table"), scene("a"), scene("b"), group("floor"));
    let config = config(&text);
    let on = |scene: usize| config.scenes[scene].objects.iter().map(|group| group.on.0.clone()).collect::<Vec<_>>();
    assert_eq!((on(0), on(1)), (vec![vec!["table".to_string()]], vec![vec!["floor".to_string()]]));

    let wrong = |line: &str| error(&format!("[[object]]\n{}{line}\n{}", group("table"), scene("a")));
    assert!(wrong("label = \"chare\"").contains("NYU40 has no class \"chare\""), "{}", wrong("label = \"chare\""));
    assert!(wrong("lable = \"chair\"").contains("did you mean `label`"), "{}", wrong("lable = \"chair\""));
    assert!(wrong("visible_share = 2").contains("[[object]] 1: visible_share: found 2, expected a share from 0 to 1"));
    assert!(wrong("count = \"many\"").contains("expected a whole number such as 10, or [least, most]"), "{}", wrong("count = \"many\""));
}

#[test]
fn variations_follow_their_scene_and_are_named_after_it() {
    let vary = |keys: &str| format!("{SCENE}[scene.vary]\n{keys}");
    let config = config(&vary("count = 3\nlight_sets = 2\nlamps = {}\nmaterials = {}\n"));
    let names: Vec<&str> = config.scenes.iter().map(|scene| scene.name.as_str()).collect();
    let first = names[0];
    assert_eq!(names, [first.to_string(), format!("{first}_v01"), format!("{first}_v02"), format!("{first}_v03")]);
    assert_eq!(config.scenes[0].varies, None);
    let varies: Vec<&Varies> = config.scenes[1..].iter().map(|scene| scene.varies.as_ref().unwrap()).collect();
    assert_eq!(varies.iter().map(|varies| varies.sets).collect::<Vec<_>>(), [[0, 0, 0], [1, 1, 1], [0, 1, 2]]);
    // What variations have in common is the first scene's; their noise is their own.
    let [one, two] = [&config.scenes[1], &config.scenes[3]];
    assert_eq!(one.exploring_seed("plan", Preset::Default), config.scenes[0].exploring_seed("plan", Preset::Default));
    assert_eq!(one.variation_seeds(varies[0]).light, two.variation_seeds(varies[2]).light);
    assert_ne!(one.variation_seeds(varies[0]).arrangement, two.variation_seeds(varies[2]).arrangement);
    assert_ne!(one.seed_for("render"), two.seed_for("render"));
    // They come back from where settings are stored, and scenes without them are stored as before.
    let stored = serde_json::to_string(&config.scenes[1]).unwrap();
    assert_eq!(serde_json::from_str::<SceneConfig>(&stored).unwrap(), config.scenes[1]);
    assert!(!serde_json::to_string(&config.scenes[0]).unwrap().contains("varies"));
}

#[test]
fn variations_that_cannot_be_are_refused_where_they_are_said() {
    for (keys, expected) in [
        ("count = 0\nlamps = {}\n", "expected a whole number from 1 to 9999, found 0"),
        ("lamps = {}\n", "[vary] has no `count`"),
        ("count = 2\n", "nothing varies"),
        ("count = 2\nlamps = { kelvin = [4000, 2700] }\n", "lamps.kelvin must be two numbers from 1700 to 20000, the smaller one first"),
        ("count = 2\nlamps = { kelvn = [2700, 4000] }\n", "did you mean `kelvin`?"),
        ("count = 2\nmaterials = { classes = { walls = {} } }\n", "did you mean \"wall\"?"),
        ("count = 2\nlmaps = {}\n", "did you mean `lamps`?"),
    ] {
        let text = error(&format!("{SCENE}[scene.vary]\n{keys}"));
        assert!(text.starts_with("sets/dataset.toml:") && text.contains(expected), "{keys}: {text}");
    }
    let text = error(&format!("[vary]\nlamps = {{}}\n{SCENE}"));
    assert!(text.contains("[vary] has no `count`, and no scene has one"), "{text}");
}
