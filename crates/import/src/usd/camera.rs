//! Cameras: focal length and aperture as a field of view.

use super::stage::Prim;
use crate::assembly::Assembly;
use enfilade_math::DAffine3;

/// Adds a camera. Apertures and focal length are in one unit, so that only their ratio counts. The camera looks along −z with y up.
pub(super) fn add(prim: &Prim, file_from_prim: DAffine3, a: &mut Assembly) {
    if prim.text("projection").is_some_and(|p| p == "orthographic") {
        a.warn(&prim.path, "the camera is not perspective and was left out");
        return;
    }
    let number = |name: &str, default: f64| prim.number(name).unwrap_or(default);
    let (width, height) = (number("horizontalAperture", 20.955), number("verticalAperture", 15.2908));
    let focal = number("focalLength", 50.0);
    if number("horizontalApertureOffset", 0.0) != 0.0 || number("verticalApertureOffset", 0.0) != 0.0 {
        a.warn(&prim.path, "the camera's aperture is shifted; it was centred (a dataset's [camera] may shift the lens)");
    }
    if number("fStop", 0.0) > 0.0 {
        a.warn(
            &prim.path,
            "the camera's f-stop and distance of focus were left out: everything is in focus (a dataset's [camera] may have a lens)",
        );
    }
    if number("exposure", 0.0) != 0.0 {
        a.warn(&prim.path, "the camera's exposure was left out: pictures hold radiance");
    }
    a.push_camera(&name(prim), file_from_prim, 2.0 * (0.5 * width / focal).atan(), width / height);
}

/// A prim's path without its leading slash: the name that parts, lights and cameras have.
pub(super) fn name(prim: &Prim) -> String {
    prim.path.trim_start_matches('/').to_string()
}
