//! Croissant 1.0 (MLCommons): a card of the dataset in JSON-LD, with tables of its frames, layers and classes as record sets.
//!
//! The files of the dataset are named by patterns relative to its root, so the export's files are meant to be put there, beside
//! `scenes`; the tables can be read from any folder.

use crate::ExportError;
use crate::calibration::Calibration;
use crate::export_folder::ExportFolder;
use crate::selected_frames::{SelectedFrames, View};
use enfilade_frame::{Dtype, LAYERS, Layer, LayerSpec};
use enfilade_scene::NYU40;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};
use std::fmt::Write;
use std::path::Path;

/// A table of the card.
struct Table {
    name: &'static str,
    about: &'static str,
    /// Name, schema.org type and meaning of every column.
    columns: Vec<(String, &'static str, String)>,
    rows: Vec<Vec<String>>,
}

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    let layers: Vec<&LayerSpec> = LAYERS.iter().filter(|spec| selected.views().any(|view| selected.stores(view, spec.layer))).collect();
    let tables = [frames(selected, &layers), layer_table(&layers, is_released(selected)), classes()];
    let mut distribution: Vec<Value> = layers.iter().map(|spec| file_set(selected, spec)).collect();
    let mut record_sets = Vec::new();
    for table in tables {
        let bytes = csv_bytes(&table);
        distribution.push(file_object(&table, &bytes));
        record_sets.push(record_set(&table));
        out.write(&format!("{}.csv", table.name), &bytes)?;
    }
    out.write_json("croissant.json", &card(selected, &distribution, &record_sets)?)
}

fn card(selected: &SelectedFrames<'_>, distribution: &[Value], record_sets: &[Value]) -> Result<Value, ExportError> {
    let manifest = selected.dataset.read_manifest()?;
    let name = manifest.as_ref().and_then(|m| m.config.get("name")).and_then(Value::as_str).unwrap_or("hypersim_layout").to_string();
    let (frames, scenes) = (selected.views().count(), selected.scenes().count());
    let (origin, unit) = match is_released(selected) {
        true => ("as Apple released them in Hypersim", "in the scene's asset units (meters_per_asset_unit of _detail/metadata_scene.csv)"),
        false => ("rendered by enfilade in the layout of Hypersim", "in metres"),
    };
    let description = format!(
        "{frames} photorealistic images of {scenes} indoor scenes with dense ground truth for every pixel, {origin} (Roberts et al., ICCV \
         2021): one HDF5 file per layer and frame, whose array is called \"dataset\". World coordinates are right-handed with z up, {unit}."
    );
    Ok(json!({
        "@context": context(),
        "@type": "sc:Dataset",
        "conformsTo": "http://mlcommons.org/croissant/1.0",
        "name": name,
        "description": description,
        "version": "1.0.0",
        "distribution": distribution,
        "recordSet": record_sets,
    }))
}

/// True when this program made none of the scenes.
fn is_released(selected: &SelectedFrames<'_>) -> bool {
    selected.scenes().all(|tracks| selected.dataset.is_released(&tracks[0].scene))
}

/// The context that Croissant 1.0 prescribes.
fn context() -> Value {
    let mut context = json!({
        "@language": "en",
        "@vocab": "https://schema.org/",
        "sc": "https://schema.org/",
        "cr": "http://mlcommons.org/croissant/",
        "rai": "http://mlcommons.org/croissant/RAI/",
        "dct": "http://purl.org/dc/terms/",
        "conformsTo": "dct:conformsTo",
        "data": { "@id": "cr:data", "@type": "@json" },
        "examples": { "@id": "cr:examples", "@type": "@json" },
        "dataType": { "@id": "cr:dataType", "@type": "@vocab" },
    });
    let terms = [
        "citeAs",
        "column",
        "extract",
        "field",
        "fileObject",
        "fileProperty",
        "fileSet",
        "format",
        "includes",
        "isLiveDataset",
        "jsonPath",
        "key",
        "md5",
        "parentField",
        "path",
        "recordSet",
        "references",
        "regex",
        "repeated",
        "replace",
        "separator",
        "source",
        "subField",
        "transform",
    ];
    for term in terms {
        context[term] = format!("cr:{term}").into();
    }
    context
}

/// All files of a layer.
fn file_set(selected: &SelectedFrames<'_>, spec: &LayerSpec) -> Value {
    let folder = relative(selected, selected.dataset.layout().scenes_dir());
    let pattern = format!("*/images/*/frame.*.{}.hdf5", spec.name);
    let unit = if spec.unit.is_empty() { String::new() } else { format!(" Unit: {}.", spec.unit) };
    json!({
        "@type": "cr:FileSet",
        "@id": format!("{}-files", spec.name),
        "name": format!("{}-files", spec.name),
        "description": format!("{}{unit}", spec.description),
        "encodingFormat": "application/x-hdf5",
        "includes": if folder.is_empty() { pattern } else { format!("{folder}/{pattern}") },
    })
}

fn file_object(table: &Table, bytes: &[u8]) -> Value {
    let file = format!("{}.csv", table.name);
    let sha256 = Sha256::digest(bytes).iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    });
    json!({
        "@type": "cr:FileObject",
        "@id": file,
        "name": file,
        "description": table.about,
        "contentUrl": file,
        "contentSize": format!("{} B", bytes.len()),
        "encodingFormat": "text/csv",
        "sha256": sha256,
    })
}

fn record_set(table: &Table) -> Value {
    let field = |(name, kind, about): &(String, &'static str, String)| {
        json!({
            "@type": "cr:Field",
            "@id": format!("{}/{name}", table.name),
            "name": name,
            "description": about,
            "dataType": kind,
            "source": { "fileObject": { "@id": format!("{}.csv", table.name) }, "extract": { "column": name } },
        })
    };
    json!({
        "@type": "cr:RecordSet",
        "@id": table.name,
        "name": table.name,
        "description": table.about,
        "field": table.columns.iter().map(field).collect::<Vec<_>>(),
    })
}

fn frames(selected: &SelectedFrames<'_>, layers: &[&LayerSpec]) -> Table {
    let column = |name: &str, kind, about: &str| (name.to_string(), kind, about.to_string());
    let mut columns = vec![
        column("scene", "sc:Text", "Name of the scene."),
        column("camera", "sc:Text", "Name of the camera, which has one trajectory."),
        column("frame", "sc:Integer", "Number of the frame."),
        column("width", "sc:Integer", "Pixels per row."),
        column("height", "sc:Integer", "Rows."),
        column("fx", "sc:Float", "Focal length along x, pixels; NaN for cameras without K."),
        column("fy", "sc:Float", "Focal length along y, pixels; NaN for cameras without K."),
        column("position_x", "sc:Float", "Camera centre in the world, metres."),
        column("position_y", "sc:Float", "Camera centre in the world, metres."),
        column("position_z", "sc:Float", "Camera centre in the world, metres."),
    ];
    columns.extend(layers.iter().map(|spec| column(spec.name, "sc:Text", &format!("File, relative to the dataset: {}", spec.description))));
    let about = "One row per frame: where it was taken, and the files of its layers.";
    Table { name: "frames", about, columns, rows: selected.views().map(|view| frame_row(selected, view, layers)).collect() }
}

fn frame_row(selected: &SelectedFrames<'_>, view: View<'_>, layers: &[&LayerSpec]) -> Vec<String> {
    let track = view.track;
    let [width, height] = track.camera.size();
    let focal = Calibration::of(track).map_or([f64::NAN; 2], |c| [c.intrinsics.fx, c.intrinsics.fy]);
    let mut row = vec![track.scene.clone(), track.name.clone(), view.frame().to_string(), width.to_string(), height.to_string()];
    row.extend(focal.iter().chain(&view.pose().position.to_array()).map(ToString::to_string));
    row.extend(layers.iter().map(|spec| {
        let path = selected.dataset.layout().layer(&track.scene, &track.name, view.frame(), spec.layer);
        if selected.stores(view, spec.layer) { relative(selected, &path) } else { String::new() }
    }));
    row
}

/// In Hypersim's release everything that is no integer is float16, and positions are in asset units.
fn layer_table(layers: &[&LayerSpec], released: bool) -> Table {
    let column = |name: &str, kind, about: &str| (name.to_string(), kind, about.to_string());
    let columns = vec![
        column("name", "sc:Text", "Name, as in frame.IIII.<name>.hdf5."),
        column("channels", "sc:Integer", "Values per pixel."),
        column("dtype", "sc:Text", "numpy's name of the type in which values are stored."),
        column("unit", "sc:Text", "Unit; empty for pure numbers."),
        column("space", "sc:Text", "Coordinate or colour space; empty where there is none."),
        column("nothing_hit", "sc:Text", "What stands where the pixel's ray meets nothing."),
        column("description", "sc:Text", "One sentence."),
    ];
    let dtype = |dtype: Dtype| match dtype {
        Dtype::F16 => "float16",
        Dtype::F32 if released => "float16",
        Dtype::F32 => "float32",
        Dtype::I16 => "int16",
        Dtype::U8 => "uint8",
    };
    let row = |s: &&LayerSpec| {
        let unit = if released && s.layer == Layer::Position { "asset units" } else { s.unit };
        [s.name, &s.channels.to_string(), dtype(s.dtype), unit, s.space, s.sentinel, s.description].map(ToString::to_string).to_vec()
    };
    Table { name: "layers", about: "One row per layer of a frame.", columns, rows: layers.iter().map(row).collect() }
}

fn classes() -> Table {
    let column = |name: &str, kind, about: &str| (name.to_string(), kind, about.to_string());
    let columns = vec![
        column("id", "sc:Integer", "Value in the layer semantic."),
        column("name", "sc:Text", "NYU40's name."),
        column("red", "sc:Integer", "Display colour, sRGB."),
        column("green", "sc:Integer", "Display colour, sRGB."),
        column("blue", "sc:Integer", "Display colour, sRGB."),
    ];
    let row = |class: &enfilade_scene::SemanticClass| {
        let [r, g, b] = class.color.map(|v| v.to_string());
        vec![class.id.to_string(), class.name.to_string(), r, g, b]
    };
    Table { name: "classes", about: "The classes of the layer semantic.", columns, rows: NYU40.iter().map(row).collect() }
}

fn csv_bytes(table: &Table) -> Vec<u8> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let header: Vec<&String> = table.columns.iter().map(|(name, _, _)| name).collect();
    writer.write_record(header).expect("writing to memory cannot fail");
    table.rows.iter().for_each(|row| writer.write_record(row).expect("rows are as long as the header"));
    writer.into_inner().expect("writing to memory cannot fail")
}

/// A path relative to the dataset's folder, with forward slashes.
fn relative(selected: &SelectedFrames<'_>, path: &Path) -> String {
    let relative = path.strip_prefix(selected.dataset.root()).unwrap_or(path);
    relative.components().map(|part| part.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/")
}
