//! The bytes of an FBX file to its objects, by the library ufbx, within limits of memory and depth.

use super::animation::Animations;
use super::deform::Clip;
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_math::{DMat3, DVec3};
use ufbx::{AllocatorOpts, BakeOpts, CoordinateAxes, CoordinateAxis, Element, ErrorType, Exporter, FileFormat, LoadOpts, SceneRoot};

/// Memory that any file may take while it is read, bytes; large ones may take [`MEMORY_PER_BYTE`] times their size more.
const MEMORY: usize = 1 << 30;

/// Meshes and pictures are packed in the file, and unpacked into numbers of double precision.
const MEMORY_PER_BYTE: usize = 64;

/// Nodes within nodes.
const MAX_DEPTH: u32 = 512;

/// The scene of an FBX file in its own units and axes, in the pose of its first moment where it is animated, and its animation.
pub(super) fn read(a: &mut Assembly) -> Result<(SceneRoot, Animations, Option<Clip>), ImportError> {
    let bytes = a.read_scene_file()?;
    let memory = MEMORY.saturating_add(bytes.len().saturating_mul(MEMORY_PER_BYTE));
    let limits = || AllocatorOpts { memory_limit: memory, ..AllocatorOpts::default() };
    let options = LoadOpts {
        temp_allocator: limits(),
        result_allocator: limits(),
        file_format: FileFormat::Fbx,
        node_depth_limit: MAX_DEPTH,
        use_blender_pbr_material: true,
        generate_missing_normals: true,
        evaluate_skinning: true,
        ..LoadOpts::default()
    };
    let scene = ufbx::load_memory(&bytes, options).map_err(|e| a.malformed("whole file", problem(&e, &bytes)))?;
    for warning in &scene.metadata.warnings {
        a.warn("whole file", format!("{} ({} times)", &*warning.description, warning.count));
    }
    report_version(&scene, a);
    let Some(number) = scene.anim_stacks.iter().position(|s| s.layers.iter().any(|l| !l.anim_values.is_empty())) else {
        return Ok((scene, Animations::default(), None));
    };
    let stack = &scene.anim_stacks[number];
    let place = format!("animation {:?}", &*stack.element.name);
    let baking = BakeOpts { temp_allocator: limits(), result_allocator: limits(), ..BakeOpts::default() };
    let animations = Animations::sample(&scene, &stack.anim, baking).map_err(|e| a.malformed(&place, problem(&e, &bytes)))?;
    let clip = Clip { stack: number, memory, scene };
    let first = clip.at(0.0).map_err(|e| a.malformed(&place, problem(&e, &bytes)))?;
    Ok((first, animations, Some(clip)))
}

/// The message for an error: the fault, and what to do about it.
fn problem(error: &ufbx::Error, bytes: &[u8]) -> String {
    let what = error.description.to_string();
    let info = Some(error.info()).filter(|i| !i.is_empty()).map_or(String::new(), |i| format!(" ({i})"));
    let remedy = match error.type_ {
        ErrorType::UnrecognizedFileFormat => "expected FBX, binary or as text; check that the file is what its name says",
        ErrorType::EmptyFile | ErrorType::TruncatedFile => "the file ends too soon; copy or export it again",
        ErrorType::UnsupportedVersion => "expected FBX 6.1 to 7.7; export it again as FBX 2011 or later",
        ErrorType::MemoryLimit | ErrorType::AllocationLimit | ErrorType::OutOfMemory => {
            "unpacked it would be far larger than such a file can be; export it again, or split it"
        }
        ErrorType::NodeDepthLimit => "its nodes are nested too deep; flatten the tree and export it again",
        _ if bytes.starts_with(b"Kaydara FBX Binary") => "the file is damaged; copy or export it again",
        _ => "the file is damaged; export it again, as binary FBX",
    };
    format!("{what}{info}, in a file of {} bytes; {remedy}", bytes.len())
}

fn report_version(scene: &SceneRoot, a: &mut Assembly) {
    let version = scene.metadata.version;
    if !(6100..=7700).contains(&version) {
        a.warn("whole file", format!("FBX version {version}; 6100 to 7700 are known, so parts of it may be misread"));
    }
}

/// True where Blender wrote the file that the element is of.
pub(super) fn of_blender(element: &Element) -> bool {
    matches!(element.scene.metadata.exporter, Exporter::BlenderBinary | Exporter::BlenderAscii)
}

/// The rotation (or reflection) from the file's axes to the world's: its up axis becomes z, its front −y, its right x. `None` if the file
/// does not state them, or they are impossible.
pub(super) fn world_from_axes(axes: &CoordinateAxes) -> Option<DMat3> {
    let (x, y, z) = (direction(axes.right)?, direction(axes.front)?, direction(axes.up)?);
    let rows = DMat3::from_cols(x, -y, z);
    (rows.determinant().abs() == 1.0).then(|| rows.transpose())
}

fn direction(axis: CoordinateAxis) -> Option<DVec3> {
    Some(match axis {
        CoordinateAxis::PositiveX => DVec3::X,
        CoordinateAxis::NegativeX => DVec3::NEG_X,
        CoordinateAxis::PositiveY => DVec3::Y,
        CoordinateAxis::NegativeY => DVec3::NEG_Y,
        CoordinateAxis::PositiveZ => DVec3::Z,
        CoordinateAxis::NegativeZ => DVec3::NEG_Z,
        CoordinateAxis::Unknown => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axes_of_maya_and_max_both_stand_upright() {
        let axes = |right, up, front| CoordinateAxes { right, up, front };
        let maya = axes(CoordinateAxis::PositiveX, CoordinateAxis::PositiveY, CoordinateAxis::PositiveZ);
        assert_eq!(world_from_axes(&maya).unwrap() * DVec3::new(1.0, 2.0, 3.0), DVec3::new(1.0, -3.0, 2.0));
        let max = axes(CoordinateAxis::PositiveX, CoordinateAxis::PositiveZ, CoordinateAxis::NegativeY);
        assert_eq!(world_from_axes(&max).unwrap(), DMat3::IDENTITY);
        let twice = axes(CoordinateAxis::PositiveX, CoordinateAxis::PositiveX, CoordinateAxis::PositiveZ);
        assert_eq!(world_from_axes(&twice), None);
        assert_eq!(world_from_axes(&axes(CoordinateAxis::PositiveX, CoordinateAxis::Unknown, CoordinateAxis::PositiveZ)), None);
    }
}
