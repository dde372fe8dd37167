//! A miniature of Hypersim's release, in its layout and dtypes: a box room in inches, with what is peculiar of the real data.
//!
//! A tilted image plane, in a table of cameras apart from the scene. float16 distances and positions, the latter in inches. Five poses, of
//! which the first has a stretched orientation, and images for four of them. A camera that is in the table and nowhere else. A hole in a
//! wall, where nothing is hit. Normals that are zero or face away, a colour beyond float16, an instance number without a box.

use enfilade_dataset::hdf5::{Storage, write_array};
use enfilade_dataset::{Array, Elements};
use enfilade_frame::f16;
use enfilade_math::{DMat3, DVec3};
use enfilade_scene::{Intrinsics, Pose, TiltedPinhole};
use std::fs;
use std::path::{Path, PathBuf};

pub const SCENE: &str = "ai_001_001";
/// Metres per inch, as the real tables have it.
pub const INCH: f64 = 0.02539999969303608;
pub const SIZE: [u32; 2] = [96, 72];
/// Frames that have images; the one of pose 2 was removed.
pub const FRAMES: [u32; 4] = [0, 1, 3, 4];

/// The folder structure of the scenes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tree {
    /// `scenes/ai_001_001`, with the table of cameras in the dataset's folder.
    Toolkit,
    /// `ai_001_001` alone, with the table in the folder above.
    Archives,
}

/// Half of the room, metres: it reaches from -3 to 3, -2.5 to 2.5 and 0 to 2.8.
const ROOM: DVec3 = DVec3::new(3.0, 2.5, 2.8);
/// A box on the floor, from corner to corner.
const BOX: [DVec3; 2] = [DVec3::new(0.4, 0.9, 0.0), DVec3::new(1.4, 1.7, 0.8)];

/// The camera: a straight pinhole of this K, turned.
pub fn calibration() -> (Intrinsics, DMat3) {
    let k = Intrinsics { width: SIZE[0], height: SIZE[1], fx: 80.0, fy: 80.0, cx: 51.5, cy: 29.25, skew: 0.0 };
    (k, DMat3::from_rotation_x(0.14) * DMat3::from_rotation_y(-0.03))
}

/// `M_cam_from_uv` of it, up to a scale.
pub fn cam_from_uv() -> DMat3 {
    let (k, turn) = calibration();
    0.97 * turn.transpose() * k.cam_from_uv()
}

pub fn poses() -> Vec<Pose> {
    let pose = |frame: u32| {
        let t = f64::from(frame);
        let from = DVec3::new(-1.8 + 0.3 * t, -1.6 + 0.1 * t, 1.5);
        Pose::look_at(frame, from, DVec3::new(0.6, 1.6, 0.9), DVec3::new(0.1 * t, 0.0, 1.0)).unwrap()
    };
    (0..5).map(pose).collect()
}

/// The artist's matrix of frame 0: its rotation, stretched.
pub fn stored_orientation(pose: &Pose) -> DMat3 {
    let stretch = DMat3::from_cols_array(&[1.02, 0.01, 0.0, 0.01, 0.99, 0.005, 0.0, 0.005, 1.01]);
    if pose.frame == 0 { pose.world_from_camera * stretch } else { pose.world_from_camera }
}

/// Distance, entity and normal of what a ray meets; `None` in the hole.
fn meet(origin: DVec3, direction: DVec3) -> Option<(f64, i16, DVec3)> {
    let mut nearest: Option<(f64, i16, DVec3)> = None;
    let mut add = |distance: f64, entity: i16, normal: DVec3| {
        if distance > 1e-9 && nearest.is_none_or(|(d, ..)| distance < d) {
            nearest = Some((distance, entity, normal));
        }
    };
    let (low, high) = (DVec3::new(-ROOM.x, -ROOM.y, 0.0), ROOM);
    for axis in 0..3 {
        let normal = DVec3::AXES[axis];
        let toward = direction[axis];
        let wall = if toward > 0.0 { high[axis] } else { low[axis] };
        let entity = if axis < 2 {
            3
        } else if toward > 0.0 {
            2
        } else {
            1
        };
        add((wall - origin[axis]) / toward, entity, -normal * toward.signum());
        let side = if toward > 0.0 { BOX[0][axis] } else { BOX[1][axis] };
        let distance = (side - origin[axis]) / toward;
        let p = origin + direction * distance;
        let inside = (0..3).all(|a| a == axis || (BOX[0][a]..=BOX[1][a]).contains(&p[a]));
        if inside {
            add(distance, 4, -normal * toward.signum());
        }
    }
    let (distance, entity, normal) = nearest?;
    let p = origin + direction * distance;
    let hole = entity == 3 && normal.y < -0.5 && (-1.2..-0.6).contains(&p.x) && (1.2..1.8).contains(&p.z);
    (!hole).then_some((distance, entity, normal))
}

/// Writes the release; returns the folder to open.
pub fn write(folder: &Path, tree: Tree) -> PathBuf {
    let root = folder.join("hypersim");
    let scene = match tree {
        Tree::Toolkit => root.join("scenes").join(SCENE),
        Tree::Archives => root.join(SCENE),
    };
    write_details(&scene);
    poses().iter().filter(|pose| FRAMES.contains(&pose.frame)).for_each(|pose| write_frame(&scene, pose));
    let table = if tree == Tree::Toolkit { &root } else { folder };
    fs::write(table.join("metadata_camera_parameters.csv"), camera_table(cam_from_uv())).unwrap();
    root
}

fn put(path: &Path, array: &Array, storage: Storage) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    write_array(path, array, storage, &[]).unwrap();
}

fn write_details(scene: &Path) {
    let detail = scene.join("_detail");
    let (poses, camera) = (poses(), detail.join("cam_00"));
    let points = |of: fn(&Pose) -> DVec3| {
        let values = poses.iter().flat_map(|p| (of(p) / INCH).to_array()).collect();
        Array::f64(&[poses.len(), 3], values)
    };
    let orientations = poses.iter().flat_map(|p| stored_orientation(p).transpose().to_cols_array()).collect();
    let keyframes = [
        ("frame_indices", Array::i64(&[poses.len()], poses.iter().map(|p| i64::from(p.frame)).collect())),
        ("positions", points(|p| p.position)),
        ("look_at_positions", points(|p| p.look_at)),
        ("orientations", Array::f64(&[poses.len(), 3, 3], orientations)),
    ];
    for (what, array) in keyframes {
        put(&camera.join(format!("camera_keyframe_{what}.hdf5")), &array, Storage::Contiguous);
    }
    let tables = [
        ("metadata_scene.csv", format!("parameter_name,parameter_value\nmeters_per_asset_unit,{INCH}\n")),
        ("metadata_cameras.csv", "camera_name\ncam_00\ncam_01\n".into()),
        (
            "metadata_nodes.csv",
            "node_id,node_name,object_id,object_name\n1,floor@n1,0,floor\n2,ceiling@n2,1,ceiling\n3,walls@n3,2,walls\n4,box@n4,3,box\n\
            5,lamp@n5,-1,_NULL_OBJECT\n"
                .into(),
        ),
        ("metadata_node_strings.csv", "node_id,path,string\n1,floor@n1.material,Mtl_oak\n".into()),
        ("cam_00/metadata_camera.csv", "parameter_name,parameter_value\nframe_time_seconds,1.0\n".into()),
    ];
    for (name, text) in tables {
        fs::write(detail.join(name), text).unwrap();
    }
    let none = f64::INFINITY;
    let (center, extents) = (0.5 * (BOX[0] + BOX[1]) / INCH, (BOX[1] - BOX[0]) / INCH);
    let rows = |v: DVec3| Array::f64(&[3, 3], [[none; 3], v.to_array(), [none; 3]].concat());
    let turns = [[none; 9], DMat3::IDENTITY.to_cols_array(), [none; 9]].concat();
    for (what, array) in [("positions", rows(center)), ("extents", rows(extents)), ("orientations", Array::f64(&[3, 3, 3], turns))] {
        let name = format!("mesh/metadata_semantic_instance_bounding_box_object_aligned_2d_{what}.hdf5");
        put(&detail.join(name), &array, Storage::Contiguous);
    }
}

fn write_frame(scene: &Path, pose: &Pose) {
    let camera = TiltedPinhole::new(SIZE[0], SIZE[1], cam_from_uv()).unwrap();
    let [width, height] = SIZE.map(|side| side as usize);
    let pass = |name: &str| scene.join(format!("images/scene_cam_00_{name}_hdf5"));
    let (color, geometry) = (pass("final"), pass("geometry"));
    let mut ids: Vec<i16> = Vec::new();
    let [mut distances, mut positions, mut normals, mut in_camera, mut uvw] = [const { Vec::<f64>::new() }; 5];
    let [mut a, mut s, mut r, mut whole] = [const { Vec::<f64>::new() }; 4];
    for i in 0..width * height {
        let (x, y) = ((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
        let direction = pose.world_from_camera * camera.ray(x, y).normalize();
        let hit = meet(pose.position, direction);
        let (distance, id, normal) = hit.unwrap_or((f64::NAN, -1, DVec3::NAN));
        // Artists' normals: some are zero, some face away.
        let normal = if i == 40 * width + 20 {
            DVec3::ZERO
        } else if i == 40 * width + 21 {
            -normal
        } else {
            normal
        };
        ids.push(id);
        distances.push(distance);
        positions.extend(((pose.position + direction * distance) / INCH).to_array());
        normals.extend(normal.to_array());
        in_camera.extend((stored_orientation(pose).transpose() * normal).to_array());
        uvw.extend([x / 96.0, y / 72.0, 0.25]);
        let shade = 0.3 + 0.01 * f64::from(id.max(0)) + 0.001 * x;
        let parts = if id == -1 { [0.0, 0.0, 4.0] } else { [0.5, shade, if i == 0 { 1e6 } else { 0.02 }] };
        a.extend([parts[0]; 3]);
        s.extend([parts[1]; 3]);
        r.extend([parts[2]; 3]);
        whole.extend([parts[0] * parts[1] + parts[2]; 3]);
    }
    let classes: Vec<i16> = ids.iter().map(|id| [-1, -1, 2, 22, 1, 7][(id + 1) as usize]).collect();
    let instances: Vec<i16> = ids.iter().map(|&id| if id == 4 { 1 } else { -1 }).collect();
    let image = |values: Vec<f64>| {
        let channels = values.len() / (width * height);
        let shape = if channels == 1 { vec![height, width] } else { vec![height, width, channels] };
        Array { shape, values: Elements::F16(values.into_iter().map(f16::from_f64).collect()) }
    };
    let numbers = |values: Vec<i16>| Array { shape: vec![height, width], values: Elements::I16(values) };
    let layers = [
        (&color, "color", image(whole)),
        (&color, "diffuse_illumination", image(s)),
        (&color, "diffuse_reflectance", image(a)),
        (&color, "residual", image(r)),
        (&geometry, "depth_meters", image(distances)),
        (&geometry, "position", image(positions)),
        (&geometry, "normal_world", image(normals.clone())),
        (&geometry, "normal_bump_world", image(normals)),
        (&geometry, "normal_cam", image(in_camera.clone())),
        (&geometry, "normal_bump_cam", image(in_camera)),
        (&geometry, "tex_coord", image(uvw)),
        (&geometry, "render_entity_id", numbers(ids)),
        (&geometry, "semantic", numbers(classes)),
        (&geometry, "semantic_instance", numbers(instances)),
    ];
    for (folder, name, array) in layers {
        put(&folder.join(format!("frame.{:04}.{name}.hdf5", pose.frame)), &array, Storage::Compressed);
    }
    let preview = scene.join("images/scene_cam_00_final_preview");
    fs::create_dir_all(&preview).unwrap();
    fs::write(preview.join(format!("frame.{:04}.tonemap.jpg", pose.frame)), "Apple's own picture").unwrap();
}

/// The table of cameras with one row, of the columns that programs read.
pub fn camera_table(cam_from_uv: DMat3) -> String {
    let mut header = vec!["scene_name", "settings_output_img_height", "settings_output_img_width", "settings_units_info_meters_scale"];
    header.push("use_camera_physical");
    let mut names: Vec<String> = header.into_iter().map(String::from).collect();
    let mut cells = vec![SCENE.to_string(), format!("{:?}", f64::from(SIZE[1])), format!("{:?}", f64::from(SIZE[0])), INCH.to_string()];
    cells.push("True".into());
    let uv = cam_from_uv.inverse().transpose();
    let depth = 1001.0 / 999.0;
    // Near and far planes are 1 and 1000 asset units.
    let rows = [
        [uv.x_axis.to_array().as_slice(), &[0.0]].concat(),
        [uv.y_axis.to_array().as_slice(), &[0.0]].concat(),
        [(uv.z_axis * depth).to_array().as_slice(), &[-2000.0 / 999.0]].concat(),
        [uv.z_axis.to_array().as_slice(), &[0.0]].concat(),
    ];
    for k in 0..9 {
        names.push(format!("M_cam_from_uv_{}{}", k / 3, k % 3));
        cells.push(cam_from_uv.col(k % 3)[k / 3].to_string());
    }
    for (i, row) in rows.iter().enumerate() {
        for (j, value) in row.iter().enumerate() {
            names.push(format!("M_proj_{i}{j}"));
            cells.push(value.to_string());
        }
    }
    format!("{}\n{}\n", names.join(","), cells.join(","))
}
