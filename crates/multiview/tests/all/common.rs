//! Datasets of distances alone, and of the scene that they are of.

use enfilade_dataset::{Dataset, FrameInfo, FrameTime, write_bytes};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3, Rgb, Vec3};
use enfilade_render::Lookout;
use enfilade_scene::{Camera, CameraView, Intrinsics, Material, Part, Pose, Scene, Trajectory, to_bytes};
use std::path::Path;

/// 64 by 48 pixels, 90 degrees wide.
pub fn pinhole() -> Intrinsics {
    Intrinsics { width: 64, height: 48, fx: 32.0, fy: 32.0, cx: 32.0, cy: 24.0, skew: 0.0 }
}

/// A pose at `position` that looks along y.
pub fn along_y(frame: u32, position: DVec3) -> Pose {
    Pose::look_at(frame, position, position + DVec3::Y, DVec3::Z).unwrap()
}

/// A scene of grey parts, each of triangles.
pub fn scene(parts: &[Vec<[Vec3; 3]>]) -> Scene {
    let mut scene = Scene { materials: vec![Material::diffuse("grey", Rgb::splat(0.5))], ..Scene::default() };
    for (i, triangles) in parts.iter().enumerate() {
        let corners = triangles.as_flattened().to_vec();
        let triangles = (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        scene.meshes.push(Mesh { positions: corners, triangles, ..Mesh::default() }.into());
        scene.parts.push(Part {
            name: format!("part {i}"),
            object: None,
            mesh: i as u32,
            material: 0,
            world_from_mesh: DAffine3::IDENTITY,
        });
    }
    scene.validate().unwrap();
    scene
}

/// A board across y, from `low` to `high` in x, 18 m tall.
pub fn board(y: f32, low: f32, high: f32) -> Vec<[Vec3; 3]> {
    let [a, b, c, d] = [(low, -9.0), (high, -9.0), (high, 9.0), (low, 9.0)].map(|(x, z)| Vec3::new(x, y, z));
    vec![[a, b, c], [a, c, d]]
}

/// The surface of a box.
pub fn cuboid(min: Vec3, max: Vec3) -> Vec<[Vec3; 3]> {
    let corner = |i: usize| Vec3::new([min.x, max.x][i & 1], [min.y, max.y][(i >> 1) & 1], [min.z, max.z][i >> 2]);
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = |[a, b, c, d]: [usize; 4]| [[a, b, c], [a, c, d]].map(|t| t.map(corner));
    sides.into_iter().flat_map(triangles).collect()
}

/// A dataset of one scene "room": the distances that its cameras see in their poses, and the package beside them.
pub fn dataset(root: &Path, scene: &Scene, cameras: &[(&str, Camera, Vec<Pose>)]) -> Dataset {
    let dataset = Dataset::create(root).unwrap();
    dataset.write_scene("room", scene).unwrap();
    dataset.write_camera_parameters("room", &pinhole().into()).unwrap();
    let lookout = Lookout::new(scene).unwrap();
    for (name, camera, poses) in cameras {
        let trajectory = Trajectory { name: (*name).into(), poses: poses.clone() };
        dataset.write_trajectory("room", &trajectory, camera, None).unwrap();
        for (index, pose) in poses.iter().enumerate() {
            let frame = lookout.look(&CameraView::of_frame(camera, poses, index), 1).frame;
            let info = FrameInfo {
                seed: 1,
                samples: 1,
                config_hash: "test".into(),
                pose: *pose,
                camera: camera.clone(),
                sampling: None,
                recipe: None,
            };
            dataset.write_frame("room", name, &frame, &info, FrameTime::default()).unwrap();
        }
    }
    write_bytes(&dataset.layout().scene_package("room"), to_bytes(scene)).unwrap();
    dataset
}
