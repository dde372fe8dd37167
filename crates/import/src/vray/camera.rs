//! `RenderView` and `CameraPhysical` to cameras.

use super::physical::{BY_EXPOSURE_VALUE, Physical};
use super::plugins::Handle;
use super::reader::Reader;
use crate::ImportError;
use enfilade_math::{DMat3, Rgb};
use std::f64::consts::FRAC_PI_4;

/// V-Ray's size of a picture where `SettingsOutput` does not state it.
const DEFAULT_SIZE: [f64; 2] = [640.0, 480.0];

/// Angles that are stated twice and differ by less than this were rounded.
const SAME_ANGLE_RAD: f64 = 1e-6;

impl<'n> Reader<'n, '_> {
    /// Adds the cameras of the scene.
    pub(super) fn cameras(&mut self) -> Result<(), ImportError> {
        let aspect = self.aspect()?;
        let physical = self.plugins.settings("CameraPhysical");
        let settings = self.plugins.settings("SettingsCamera");
        if let Some(settings) = settings
            && let kind = settings.int("type", 0)?
            && kind > 0
        {
            self.warn(settings, format!("camera type {kind} is not supported; a pinhole of the same field of view stands in"));
        }
        for view in self.plugins.of_kind("RenderView") {
            if view.flag("orthographic", false)? {
                self.warn(view, "an orthographic camera is not supported and was left out");
                continue;
            }
            self.warn_of_animation(view, &["fov"]);
            let keys = view.keyframes("transform");
            if keys > 1 {
                let message = format!(
                    "the camera moves: the first of its {keys} keyframes was used; `plan` finds trajectories of its own, or reads poses \
                     made elsewhere"
                );
                self.warn(view, message);
            }
            let fov = match physical {
                Some(camera) => self.physical(camera, view.number("fov", FRAC_PI_4)?, aspect)?,
                None => self.angle(view, settings)?,
            };
            self.a.push_camera(&view.name(), view.transform("transform")?, fov, aspect);
        }
        Ok(())
    }

    /// The field of view of a camera that is not physical: the one of `SettingsCamera`, unless it is below zero, or else the view's.
    fn angle(&mut self, view: Handle<'n>, settings: Option<Handle<'n>>) -> Result<f64, ImportError> {
        let own = view.number("fov", FRAC_PI_4)?;
        let Some(settings) = settings else { return Ok(own) };
        let stated = settings.number("fov", -1.0)?;
        if stated <= 0.0 {
            return Ok(own);
        }
        if view.plugin.parameter("fov").is_some() && (stated - own).abs() > SAME_ANGLE_RAD {
            self.warn(view, format!("its fov is {own}, and the {stated} of SettingsCamera override it"));
        }
        Ok(stated)
    }

    /// Width over height of the picture.
    fn aspect(&mut self) -> Result<f64, ImportError> {
        let Some(output) = self.plugins.settings("SettingsOutput") else { return Ok(DEFAULT_SIZE[0] / DEFAULT_SIZE[1]) };
        let positive = |parameter: &str, default: f64| {
            let found = output.number(parameter, default)?;
            let problem = format!("found {found}, expected a number above zero; correct the value");
            if found > 0.0 { Ok(found) } else { Err(output.error(parameter, problem)) }
        };
        let pixel = positive("img_pixelAspect", 1.0)?;
        if (pixel - 1.0).abs() > 1e-6 {
            self.warn(output, format!("pixels {pixel} times as wide as high became square; the picture has the same borders"));
        }
        Ok(positive("img_width", DEFAULT_SIZE[0])? / positive("img_height", DEFAULT_SIZE[1])? * pixel)
    }

    /// The field of view of a physical camera, and warnings of what is not the pinhole's.
    fn physical(&mut self, camera: Handle<'n>, fov: f64, aspect: f64) -> Result<f64, ImportError> {
        let meters = self.a.meters_per_unit();
        let lens = Physical::of(camera, aspect, meters)?;
        let fov = if camera.flag("specify_fov", false)? {
            camera.number("fov", fov)?
        } else {
            let focal_length = camera.number("focal_length", 40.0)?;
            if focal_length <= 0.0 {
                let problem = format!("found {focal_length}, expected millimetres above zero; correct the value");
                return Err(camera.error("focal_length", problem));
            }
            lens.fov_x_rad(focal_length * 0.001 / meters)
        };
        if lens.is_shifted() {
            let message = match lens.cam_from_uv(fov) {
                Some(m) => format!("the lens is shifted; [camera] of dataset.toml takes the same pictures with {}", tilted(m)),
                None => "the lens is shifted, and no film behind it sees the field of view; the shift was left out".to_string(),
            };
            self.warn(camera, message);
        }
        self.lens_effects(camera)?;
        Ok(fov)
    }

    fn lens_effects(&mut self, camera: Handle<'n>) -> Result<(), ImportError> {
        if camera.int("distortion_type", 0)? > 1 || camera.number("distortion", 0.0)? != 0.0 {
            self.warn(
                camera,
                "lens distortion was left out; `radial_tangential` or `ray_grid` in [camera] of dataset.toml give all cameras one",
            );
        }
        if camera.flag("use_dof", false)? {
            self.warn(camera, "depth of field was left out; `lens` in [camera] of dataset.toml gives all cameras one");
        }
        if camera.flag("use_moblur", false)? {
            self.warn(camera, "motion blur was left out; `shutter` in [camera] of dataset.toml gives all cameras one");
        }
        if camera.flag("exposure", true)? {
            let message = format!("all light was multiplied by {:.4}, the camera's exposure; exposure=0 turns that off", self.exposure);
            self.warn(camera, message);
            if camera.int("exposure", 1)? == BY_EXPOSURE_VALUE {
                self.warn(camera, "its exposure value was taken for one of ISO 100; V-Ray does not publish its formula");
            }
            if camera.number("vignetting", 1.0)? != 0.0 {
                self.warn(camera, "vignetting was left out: the picture does not darken towards its borders");
            }
            if camera.color("white_balance", Rgb::WHITE)? != Rgb::WHITE {
                self.warn(camera, "white balance was left out");
            }
        }
        Ok(())
    }
}

/// The keys of a shifted lens in `dataset.toml`.
fn tilted(m: DMat3) -> String {
    let rows = m.transpose().to_cols_array_2d().map(|row| {
        let row = row.map(|v| format!("{:.9}", v + 0.0));
        format!("[{}]", row.join(", "))
    });
    format!("model = \"tilted_pinhole\", cam_from_uv = [{}]", rows.join(", "))
}
