//! Lights and cameras of FBX nodes. [`super`] documents the meaning of a light's strength.

use super::matrix::affine;
use super::reader::of_blender;
use crate::assembly::Assembly;
use crate::blender::spot_inner_rad;
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DMat3, DVec3, Rgb, Vec3};
use enfilade_scene::{Light, Material, PartLabel, SpotFalloff};
use std::f32::consts::{FRAC_PI_4, PI};
use ufbx::{LightAreaShape, LightDecay, LightType, ProjectionMode};

/// Adds the light of a node. Lights shine along the node's −y by default.
pub(super) fn add_light(node: &ufbx::Node, light: &ufbx::Light, name: &str, a: &mut Assembly) {
    let place = format!("light {name:?}");
    if !light.cast_light {
        a.warn(place, "the light is switched off and was left out");
        return;
    }
    let file_from_node = affine(&node.node_to_world);
    let d = &light.local_direction;
    let direction = file_from_node.transform_vector3(DVec3::new(d.x, d.y, d.z)).normalize_or_zero().as_vec3();
    let at = file_from_node.translation;
    let position = at.as_vec3();
    let strength = Rgb::new(light.color.x as f32, light.color.y as f32, light.color.z as f32) * light.intensity as f32;
    let of_blender = of_blender(&light.element);
    let intensity = strength * point_scale(light.decay, of_blender, a);
    let name = name.to_string();
    match light.type_ {
        LightType::Directional => a.push_light(Light::Directional { name, direction, irradiance: strength, angular_radius_rad: 0.0 }),
        LightType::Spot => {
            let half = |angle: f64| 0.5 * (angle as f32).to_radians();
            let outer_rad = Some(half(light.outer_angle)).filter(|r| *r > 0.0).unwrap_or(FRAC_PI_4);
            let inner_rad = half(light.inner_angle).clamp(0.0, outer_rad);
            let (inner_rad, falloff) = match of_blender {
                // It writes (1 − blend)·outer as the inner angle.
                true => (spot_inner_rad(f64::from(outer_rad), f64::from(1.0 - inner_rad / outer_rad)) as f32, SpotFalloff::SmoothCosine),
                false => (inner_rad, SpotFalloff::Angle),
            };
            a.push_light_at(at, Light::Spot { name, position, direction, intensity, inner_rad, outer_rad, falloff });
        }
        LightType::Area => add_area(&name, light, file_from_node, strength, of_blender, a),
        LightType::Point | LightType::Volume => {
            if light.type_ == LightType::Volume {
                a.warn(&place, "volume lights are not supported; a point light stands in");
            }
            a.push_light_at(at, Light::Point { name, position, intensity });
        }
    }
    if !of_blender && light.type_ != LightType::Directional && light.decay != LightDecay::Quadratic {
        a.warn(
            place,
            format!("light with decay {:?}; it falls off with the square of the distance here, as it does in nature", light.decay),
        );
    }
}

/// W/sr in the file's unit for one of the light's intensity. Blender writes watts. The others have no unit: with quadratic decay the
/// programs divide by the square of the distance in the file's unit, without it an intensity of one is right at about a metre.
fn point_scale(decay: LightDecay, of_blender: bool, a: &Assembly) -> f32 {
    let per_square_metre = (a.meters_per_unit().powi(2) as f32).recip();
    match (of_blender, decay) {
        (true, _) => per_square_metre / (4.0 * PI),
        (false, LightDecay::Quadratic) => 1.0,
        (false, _) => per_square_metre,
    }
}

/// A square from −1 to 1 across the light's axis, as in Maya, that shines on one side. Blender's watts leave it altogether; the
/// others' intensity is its radiance.
fn add_area(name: &str, light: &ufbx::Light, file_from_node: DAffine3, strength: Rgb, of_blender: bool, a: &mut Assembly) {
    let sphere = light.area_shape == LightAreaShape::Sphere;
    let shape = if sphere { " instead of a sphere" } else { "" };
    a.warn(
        format!("light {name:?}"),
        format!("FBX does not say how large an area light is; a square of two units a side, scaled by its node, was used{shape}"),
    );
    let m = file_from_node.matrix3 * a.meters_per_unit();
    let area = 4.0 * m.x_axis.cross(m.z_axis).length() as f32;
    let radiance = if of_blender && area > 0.0 { strength * (PI * area).recip() } else { strength };
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let square =
        Mesh { positions: corners.map(|(x, z)| Vec3::new(x, 0.0, z)).to_vec(), triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
    let file = a.file().to_path_buf();
    if let Ok(Some(mesh)) = a.push_mesh(square, &file, name) {
        let material = a.push_material(Material { two_sided: false, ..Material::emitter(name, radiance) });
        a.push_part(name, mesh, material, file_from_node, PartLabel::NONE);
    }
}

/// Adds the camera of a node. Cameras look along the node's x with y up.
pub(super) fn add_camera(node: &ufbx::Node, camera: &ufbx::Camera, name: &str, a: &mut Assembly) {
    let place = format!("camera {name:?}");
    if camera.projection_mode == ProjectionMode::Orthographic {
        a.warn(place, "the camera is not perspective and was left out");
        return;
    }
    let property = |name| ufbx::find_prop(&camera.element.props, name).map_or(0.0, |p| p.value_vec4.x);
    for (shift, unit) in [("FilmOffsetX", "inches"), ("FilmOffsetY", "inches"), ("Roll", "degrees")] {
        let found = property(shift);
        if found != 0.0 {
            let remedy = if shift == "Roll" { "" } else { "; `principal_point` in [camera] of dataset.toml shifts all cameras" };
            a.warn(&place, format!("{shift} of {found} {unit} was set to zero{remedy}"));
        }
    }
    let axes = DMat3::from_cols(DVec3::Z, DVec3::Y, DVec3::NEG_X);
    let file_from_camera = affine(&node.node_to_world) * DAffine3::from_mat3(axes);
    let fov_x = 2.0 * camera.field_of_view_tan.x.atan();
    a.push_camera(name, file_from_camera, fov_x, camera.aspect_ratio);
}
