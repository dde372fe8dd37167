//! Visible and whole areas of squares whose sizes in pixels are known.

use super::*;
use enfilade_math::{DVec3, Vec3};
use enfilade_scene::{Camera, Fisheye, Intrinsics, Pose, Projection};

/// An upright square of side 1 around (x, 4, z), facing −y.
fn square(instance: i16, x: f32, z: f32) -> Solid {
    let corner = |dx: f32, dz: f32| Vec3::new(x + dx, 4.0, z + dz);
    let [a, b, c, d] = [corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5), corner(-0.5, 0.5)];
    Solid::new(instance, 5, &[[a, b, c], [a, c, d]])
}

/// At the origin, looking along y. One pixel sees 4/80 m at the squares' distance.
fn pinhole() -> Camera {
    Intrinsics { width: 64, height: 48, fx: 80.0, fy: 80.0, cx: 32.0, cy: 24.0, skew: 0.0 }.into()
}

fn views(solids: &[Solid], camera: &Camera, instances: &Values) -> (Vec<InstanceView>, AmodalMasks) {
    let pose = Pose::look_at(0, DVec3::ZERO, DVec3::Y, DVec3::Z).unwrap();
    frame_instances(solids, &CameraView::still(camera, &pose), 0, instances)
}

fn nothing(camera: &Camera) -> Values {
    let [width, height] = camera.size();
    Values::I16(vec![-1; (width * height) as usize])
}

#[test]
fn a_square_has_its_pixels_its_box_and_its_mask() {
    let camera = pinhole();
    let mut seen = vec![-1i16; 64 * 48];
    // Only its left half shows.
    for y in 14..34 {
        seen[64 * y + 22..64 * y + 32].fill(3);
    }
    let (views, masks) = views(&[square(3, 0.0, 0.0)], &camera, &Values::I16(seen));
    let [view] = views.as_slice() else { panic!("{views:?}") };
    assert_eq!(view.full, PixelArea { pixels: 400, bounds: [22, 14, 42, 34] });
    assert_eq!(view.visible, PixelArea { pixels: 200, bounds: [22, 14, 32, 34] });
    assert_eq!((view.inside_pixels, view.visibility(), view.truncation()), (400, 0.5, 0.0));
    let mask = &masks.instances[0];
    assert_eq!((masks.size, mask.semantic_instance_id, mask.counts.len()), ([48, 64], 3, 41));
    assert_eq!((mask.counts[0], mask.counts[1], mask.counts[2]), (22 * 48 + 14, 20, 28));
    assert_eq!(mask.counts.iter().sum::<u32>(), 64 * 48);
}

#[test]
fn what_the_image_cuts_off_is_its_share_and_what_it_does_not_hold_is_left_out() {
    let camera = pinhole();
    // The image ends 1.6 m to the right of the middle: a quarter of the first square lies inside, nothing of the second.
    let (views, _) = views(&[square(1, 1.85, 0.0), square(2, 2.3, 0.0), square(3, 50.0, 0.0)], &camera, &nothing(&camera));
    let [view] = views.as_slice() else { panic!("{views:?}") };
    assert_eq!((view.instance, view.full.pixels, view.inside_pixels, view.truncation()), (1, 400, 100, 0.75));
    assert_eq!((view.full.bounds, view.visible), ([59, 14, 79, 34], PixelArea::default()));
}

#[test]
fn what_is_behind_the_camera_is_clipped() {
    // A floor that runs through below the camera: only what is in front counts, up to the end of the canvas.
    let [a, b, c, d] = [[-9.0, -9.0], [9.0, -9.0], [9.0, 4.0], [-9.0, 4.0]].map(|[x, y]: [f32; 2]| Vec3::new(x, y, -1.0));
    let (camera, floor) = (pinhole(), Solid::new(1, 2, &[[a, b, c], [a, c, d]]));
    let (views, _) = views(&[floor], &camera, &nothing(&camera));
    // The far end is 20 px below the middle, at row 44, and the canvas ends at row 96; it is wider than the canvas.
    assert_eq!((views[0].inside_pixels, views[0].full.pixels), (64 * 4, 192 * 52));
}

#[test]
fn every_model_of_camera_agrees_with_rays_cast_one_by_one() {
    let k = Intrinsics { width: 64, height: 48, fx: 18.0, fy: 18.0, cx: 30.0, cy: 25.0, skew: 0.0 };
    let fisheye = Projection::Fisheye(k, Fisheye::new([-0.01, 0.002, 0.0, 0.0]).unwrap());
    let objects = [square(1, 0.4, 0.3), square(2, -3.0, 1.0), square(3, 3.0, -2.0)];
    for camera in [pinhole(), fisheye.into(), Projection::Equirectangular { width: 64, height: 32 }.into()] {
        let pose = Pose::look_at(0, DVec3::new(0.2, -0.3, 0.1), DVec3::new(0.3, 4.0, 0.0), DVec3::Z).unwrap();
        let view = CameraView::still(&camera, &pose);
        let (views, _) = frame_instances(&objects, &view, 0, &nothing(&camera));
        let [width, height] = camera.size();
        for solid in &objects {
            let hits = (0..width * height).filter(|i| {
                let ray = view.centre_ray(f64::from(i % width) + 0.5, f64::from(i / width) + 0.5);
                ray.is_some_and(|ray| solid.bvh.occluded(&enfilade_math::Ray::new(ray.origin.as_vec3(), ray.direction.as_vec3())))
            });
            let found = views.iter().find(|view| view.instance == solid.instance).map_or(0, |view| view.inside_pixels);
            assert_eq!(found, hits.count() as u64, "instance {} of {:?}", solid.instance, camera.projection);
        }
    }
}

#[test]
fn runs_alternate_and_add_up() {
    assert_eq!(run_lengths(&[], 5), [5]);
    assert_eq!(run_lengths(&[0, 1, 4], 5), [0, 2, 2, 1]);
    assert_eq!(run_lengths(&[2], 5), [2, 1, 2]);
}
