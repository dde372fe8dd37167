//! V-Ray's own picture of Hypersim's empty scene with its squares: edges are where V-Ray has them, and radiance agrees. Skipped unless
//! `ENFILADE_SCENES` names the folder of the shared scenes.

use super::edges::Sight;
use super::picture::{Picture, relative_differences};
use super::scene;
use enfilade_render::{Guide, RenderConfig, RenderScene, render_frame};
use enfilade_scene::{Camera, CameraView, Intrinsics, Quiet};

/// The picture is rendered this many times smaller.
const SMALLER: usize = 4;

#[test]
fn edges_and_radiance_are_those_of_v_rays_picture() {
    let Some(scenes) = std::env::var_os("ENFILADE_SCENES").map(std::path::PathBuf::from) else {
        eprintln!("skipped: ENFILADE_SCENES does not name the folder of the shared rooms");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let imported = scene::import(&scenes, None, folder.path()).unwrap_or_else(|e| panic!("{e}"));
    let counts = &imported.report.counts;
    assert_eq!((counts.parts, counts.cameras, counts.environments), (7 + 235, 1, 1), "{}", imported.report);
    let reference = Picture::read(&scene::picture(&scenes)).unwrap();
    let camera = scene::taken_with(&imported);
    let pose = imported.scene.cameras[0].pose(0);
    let sight = Sight::new(&imported.scene, CameraView::still(&camera, &pose));

    let points = sight.edge_points(&reference);
    let shift = points.iter().map(|p| p.normal * p.offset_px).sum::<enfilade_math::DVec2>() * (2.0 / points.len() as f64);
    let mut sizes: Vec<f64> = points.iter().map(|p| p.offset_px.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    assert!(sizes.len() > 500, "{} places", sizes.len());
    let (median, most) = (sizes[sizes.len() / 2], sizes[sizes.len() * 99 / 100]);
    eprintln!(
        "{} places on edges: off by {median:.3} px in the median, by less than {most:.3} for 99 %; all together {shift:.3}",
        sizes.len()
    );
    assert!(median < 0.08 && most < 0.4 && shift.length() < 0.02, "offsets of edges: median {median} px, 99 % {most} px, all {shift}");

    // Blocks without squares, whose pictures are not there.
    let size = scene::SIZE.map(|s| s / SMALLER as u32);
    let small = Camera::from(Intrinsics::from_fov_x(size[0], size[1], imported.scene.cameras[0].fov_x_rad));
    let view = CameraView::still(&small, &pose);
    let prepared = RenderScene::new(&imported.scene, &Quiet).unwrap();
    let config = RenderConfig { samples: 64, ..RenderConfig::default() };
    let guide = Guide::learn(&prepared, &[view], &config);
    let ours = Picture::of(&render_frame(&prepared, &guide, &view, &config, &Quiet).unwrap()).unwrap();
    let ours = ours.vignetted(imported.scene.cameras[0].fov_x_rad);
    let reference = reference.shrunk(SMALLER);
    let plain = |i: usize| {
        let (x, y) = ((i % ours.width * SMALLER) as f64, (i / ours.width * SMALLER) as f64);
        let steps = [-6.0, 2.0, 10.0];
        steps.iter().flat_map(|dx| steps.map(|dy| (x + dx, y + dy))).all(|(x, y)| {
            let part = sight.part_at(x, y);
            part.is_some_and(|p| p.name.starts_with("Plane")) || part.is_none()
        })
    };
    let differences = relative_differences(&ours, &reference);
    let mut plain: Vec<f64> = (0..differences.len()).filter(|i| plain(*i)).map(|i| differences[i].abs()).collect();
    plain.sort_by(f64::total_cmp);
    assert!(plain.len() > 2000, "{} plain pixels", plain.len());
    let (median, most) = (plain[plain.len() / 2], plain[plain.len() * 95 / 100]);
    eprintln!("plain pixels: {} with a difference of {median} in the median and below {most} for 95 %", plain.len());
    assert!(median < 0.03 && most < 0.12, "differences of radiance: median {median}, 95 % {most}");
}
