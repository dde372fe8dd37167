//! COLMAP's text form of a [`Model`]; [`super::colmap`] describes the numbers. Every number is read back exactly.

use super::colmap::{Files, Model};

/// The model in COLMAP's text form.
pub(crate) fn text(model: &Model) -> Files {
    [("cameras.txt", cameras_txt(model)), ("images.txt", images_txt(model)), ("points3D.txt", points_txt(model))]
}

fn cameras_txt(model: &Model) -> Vec<u8> {
    let mut text = format!("# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n# Number of cameras: {}\n", model.cameras.len());
    for (id, camera) in (1..).zip(&model.cameras) {
        let parameters = joined(&camera.parameters);
        text.push_str(&format!("{id} {} {} {} {parameters}\n", camera.model.name(), camera.width, camera.height));
    }
    text.into_bytes()
}

fn images_txt(model: &Model) -> Vec<u8> {
    let mut text = String::from("# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n# POINTS2D[] as (X, Y, POINT3D_ID)\n");
    text.push_str(&format!("# Number of images: {}\n", model.images.len()));
    for (id, image) in (1..).zip(&model.images) {
        let (rotation, translation) = (joined(&image.rotation), joined(&image.translation));
        text.push_str(&format!("{id} {rotation} {translation} {} {}\n", image.camera_id, image.name));
        let points: Vec<String> = image.points.iter().map(|(x, y, point)| format!("{x} {y} {point}")).collect();
        text.push_str(&format!("{}\n", points.join(" ")));
    }
    text.into_bytes()
}

fn points_txt(model: &Model) -> Vec<u8> {
    let mut text = String::from("# POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n");
    text.push_str(&format!("# Number of points: {}\n", model.points.len()));
    for (id, point) in (1..).zip(&model.points) {
        let [r, g, b] = point.color;
        let track: Vec<String> = point.track.iter().map(|(image, index)| format!("{image} {index}")).collect();
        text.push_str(&format!("{id} {} {r} {g} {b} 0 {}\n", joined(&point.position), track.join(" ")));
    }
    text.into_bytes()
}

fn joined(values: &[f64]) -> String {
    values.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ")
}
