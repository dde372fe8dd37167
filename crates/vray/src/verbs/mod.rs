//! `enfilade vray`: edits of V-Ray's scenes, file to file; jobs that render them, and the images that these make.

mod args;
mod console;
mod frames;
mod tables;

pub use args::VrayArgs;
pub use console::Console;

use crate::VrayError;
use crate::edit::{
    EntityOptions, GiCaches, IMAGE_FILTERS, Normalization, Pass, add_color_channels, add_denoiser, add_geometry_channels, file_references,
    hypersim_quality, hypersim_surroundings, linear_output, make_pass, normalize, prepare_for_layers, reduce_quality, reduce_size,
    remove_kinds, replace_paths, save_gi_caches, set_entity_ids,
};
use crate::{Asset, inline_scene, read_scene, scene_assets};
use args::{Copy, Edit, PassArg, Policy};
use enfilade_dataset::write_bytes;
use enfilade_vrscene::{Document, add_include};
use std::collections::BTreeMap;
use std::path::Path;

/// Does what the arguments of `enfilade vray` ask for.
///
/// # Errors
/// When a scene, a job or an image cannot be read, edited or written as asked; the error states what to do.
pub fn vray(args: &VrayArgs, console: &dyn Console) -> Result<(), VrayError> {
    match &args.edit {
        Edit::Copy(copy) => edited(copy, console, |_| Ok("copied".into())),
        Edit::Info { input, files } => info(input, *files, console),
        Edit::Normalize { copy, policy } => edited(copy, console, |scene| {
            normalize(
                scene,
                match policy {
                    Policy::V0 => Normalization::V0,
                    Policy::V1 => Normalization::V1,
                    Policy::V2 => Normalization::V2,
                },
            );
            Ok("normalized".into())
        }),
        Edit::ReplacePaths { copy, old, new } => edited(copy, console, |scene| match replace_paths(scene, old, new) {
            0 => Err(VrayError::usage(format!("no path begins with {old:?}"), "see which there are: enfilade vray info IN --files")),
            changed => Ok(format!("{changed} paths replaced")),
        }),
        Edit::Remove { copy, kinds } => edited(copy, console, |scene| {
            let kinds: Vec<&str> =
                kinds.iter().flat_map(|kind| if kind == "IMAGE_FILTERS" { IMAGE_FILTERS.to_vec() } else { vec![kind.as_str()] }).collect();
            let removed = remove_kinds(scene, &kinds);
            Ok(format!("{} plugins and {} references to them removed", removed.plugins, removed.references))
        }),
        Edit::Entities { copy, objects, nodes, strings, hide_nodes_not_in_mesh, hide_lights } => edited(copy, console, |scene| {
            let objects = tables::objects(objects)?;
            let names: Vec<&str> = objects.iter().map(String::as_str).collect();
            let options = EntityOptions { hide_nodes_not_in_mesh: *hide_nodes_not_in_mesh, hide_lights: *hide_lights };
            let entities = set_entity_ids(scene, &names, options);
            if let Some(path) = nodes {
                tables::write_nodes(path, &entities, &objects)?;
            }
            if let Some(path) = strings {
                tables::write_strings(path, scene)?;
            }
            let lights = entities.iter().filter(|entity| entity.light).count();
            let strangers = entities.iter().filter(|entity| !entity.light && entity.object.is_none()).count();
            Ok(format!("{} nodes, of which {strangers} are not objects of the mesh, and {lights} lights numbered", entities.len() - lights))
        }),
        Edit::Layers { copy, denoiser, hypersim_surroundings: surroundings } => edited(copy, console, |scene| {
            prepare_for_layers(scene);
            remove_kinds(scene, &IMAGE_FILTERS);
            add_geometry_channels(scene);
            add_color_channels(scene);
            if *denoiser {
                add_denoiser(scene);
            }
            if *surroundings {
                hypersim_surroundings(scene);
            }
            Ok("render elements added".into())
        }),
        Edit::Quality(copy) => edited(copy, console, |scene| {
            hypersim_quality(scene);
            Ok("Hypersim's quality".into())
        }),
        Edit::Camera { copy, dataset, scene: name, camera, wish, lens, lens_when_rendering } => edited(copy, console, |scene| {
            let place = lens.as_deref().map(|file| (file, lens_when_rendering.as_deref()));
            frames::set_dataset_camera(scene, &copy.input, dataset, [name, camera], &wish.wish(), place)
        }),
        Edit::Include { copy, files } => edited(copy, console, |scene| {
            files.iter().for_each(|file| add_include(scene, file));
            Ok(format!("{} files included", files.len()))
        }),
        Edit::Inline(copy) => edited(copy, console, |scene| {
            let before = scene.includes().count();
            *scene = inline_scene(std::mem::take(scene), &copy.input)?;
            Ok(format!("{before} included files taken in"))
        }),
        Edit::Jobs(args) => frames::jobs(args, console),
        Edit::Collect(args) => frames::collect(args, console),
        Edit::Pass { copy, pass, light_cache, irradiance_map } => edited(copy, console, |scene| {
            let caches = match (pass, light_cache, irradiance_map) {
                (PassArg::Geometry, ..) => GiCaches { light_cache: String::new(), irradiance_map: String::new() },
                (_, Some(light_cache), Some(irradiance_map)) => {
                    GiCaches { light_cache: light_cache.clone(), irradiance_map: irradiance_map.clone() }
                }
                _ => return Err(VrayError::usage("this pass needs indirect light", "give --light-cache and --irradiance-map")),
            };
            let pass = match pass {
                PassArg::Geometry => Pass::Geometry,
                PassArg::Pre => Pass::Pre,
                PassArg::Final => Pass::Final,
            };
            make_pass(scene, pass, &caches);
            Ok(format!("the {pass:?} pass").to_lowercase())
        }),
        Edit::SaveGiCaches { copy, light_cache, irradiance_map } => edited(copy, console, |scene| {
            save_gi_caches(scene, &GiCaches { light_cache: light_cache.clone(), irradiance_map: irradiance_map.clone() });
            Ok("indirect light will be kept".into())
        }),
        Edit::Reduce { copy, quality, size } => edited(copy, console, |scene| {
            if !quality && !size {
                return Err(VrayError::usage("nothing to reduce", "give --quality, --size or both"));
            }
            if *quality {
                reduce_quality(scene);
            }
            if *size {
                reduce_size(scene);
            }
            Ok("reduced".into())
        }),
        Edit::Linear(copy) => edited(copy, console, |scene| {
            linear_output(scene);
            Ok("linear".into())
        }),
    }
}

/// Reads, edits and writes a scene, and reports what the edit did. The output appears whole or not at all.
fn edited(copy: &Copy, console: &dyn Console, edit: impl FnOnce(&mut Document) -> Result<String, VrayError>) -> Result<(), VrayError> {
    let mut scene = read_scene(&copy.input)?;
    let done = edit(&mut scene)?;
    write_bytes(&copy.output, scene.to_bytes())?;
    console.say(&format!("{}: {done}", copy.output.display()));
    match scene.includes().count() {
        0 => {}
        files => console.say(&format!("note: {files} included files stay as they are; to edit all of the scene: enfilade vray inline")),
    }
    Ok(())
}

fn info(path: &Path, files_only: bool, console: &dyn Console) -> Result<(), VrayError> {
    let scene = read_scene(path)?;
    let (files, unseen) = scene_assets(&scene, path)?;
    if files_only {
        files.iter().for_each(|file| console.say(&file.path));
        return Ok(());
    }
    let mut kinds: BTreeMap<String, usize> = BTreeMap::new();
    scene.plugins().for_each(|plugin| *kinds.entry(String::from_utf8_lossy(plugin.kind()).into_owned()).or_default() += 1);
    let units = frames::units(&scene, path)?;
    console.say(&format!("units    {}", units.map_or("not said".into(), |m| format!("{m} m"))));
    console.say(&format!("plugins  {}", kinds.values().sum::<usize>()));
    kinds.iter().for_each(|(kind, count)| console.say(&format!("{count:8} {kind}")));
    let own = file_references(&scene);
    let of_others: Vec<&Asset> = files.iter().filter(|file| own.iter().all(|own| own.path != file.path)).collect();
    console.say(&format!("files    {}", own.len() + of_others.len()));
    own.iter().for_each(|file| console.say(&format!("         {} ({}, line {})", file.path, file.plugin, file.place.line)));
    of_others.iter().for_each(|file| console.say(&format!("         {} ({}, of an included file)", file.path, file.named_by)));
    unseen.iter().for_each(|file| console.say(&format!("unseen   {file}: included, but not on this machine; it may need more files")));
    Ok(())
}
