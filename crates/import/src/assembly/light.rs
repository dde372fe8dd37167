//! Lights and environments, given in the file's units and axes.

use super::{Assembly, mat3_f32};
use enfilade_math::{DMat3, DVec3, Rgb, Vec3, nearest_rotation, place};
use enfilade_scene::{Environment, Light, MapRows};

impl Assembly<'_> {
    /// Adds a light that is already in the world's units and axes.
    pub(crate) fn push_world_light(&mut self, light: Light) {
        self.light_positions.push(position_of(&light));
        self.scene.lights.push(light);
    }

    /// Adds a light given in the file's units and axes. Point and spot lights shine so that a picture looks the same whatever
    /// the unit: their intensity grows with the square of the metres per unit.
    pub(crate) fn push_light(&mut self, light: Light) {
        self.push_light_at(position_of(&light), light);
    }

    /// Adds a light whose `position` in the file is known in double precision, otherwise as [`Assembly::push_light`].
    pub(crate) fn push_light_at(&mut self, position: DVec3, light: Light) {
        let metres = self.meters_per_unit as f32;
        let name = light.name().to_string();
        let at = |p: Vec3| place(&self.world_from_file, p);
        let turn = |d: Vec3| self.world_from_file.transform_vector3(d.as_dvec3()).as_vec3().normalize_or_zero();
        let light = match light {
            Light::Point { name, position, intensity } => {
                Light::Point { name, position: at(position), intensity: intensity * (metres * metres) }
            }
            Light::Spot { name, position, direction, intensity, inner_rad, outer_rad, falloff } => Light::Spot {
                name,
                position: at(position),
                direction: turn(direction),
                intensity: intensity * (metres * metres),
                inner_rad,
                outer_rad,
                falloff,
            },
            Light::Profile { name, position, web_from_world: web_from_file, intensity, web } => {
                let rotation = self.world_from_file.matrix3 * (1.0 / self.meters_per_unit);
                let web_from_world = web_from_file * mat3_f32(rotation.transpose());
                Light::Profile { name, position: at(position), web_from_world, intensity: intensity * (metres * metres), web }
            }
            Light::Directional { name, direction, irradiance, angular_radius_rad } => {
                Light::Directional { name, direction: turn(direction), irradiance, angular_radius_rad }
            }
        };
        let (usable, power) = match &light {
            Light::Point { position, intensity, .. } => (position.is_finite(), *intensity),
            Light::Spot { position, direction, intensity, .. } => (position.is_finite() && direction.length() > 0.5, *intensity),
            Light::Profile { position, web_from_world, intensity, .. } => (position.is_finite() && web_from_world.is_finite(), *intensity),
            Light::Directional { direction, irradiance, .. } => (direction.length() > 0.5, *irradiance),
        };
        if usable && power.is_finite() {
            self.light_positions.push(self.world_from_file.transform_point3(position));
            self.scene.lights.push(light);
        } else {
            self.warn(format!("light {name:?}"), "its placement or strength makes no sense, so it was left out");
        }
    }

    /// Sets an environment picture by the matrix that takes its own space (y up) to the file's axes; scale and skew are taken out.
    pub(crate) fn set_environment_map(&mut self, image: u32, rows: MapRows, scale: Rgb, file_from_map: DMat3, place: &str) {
        let world_from_map = self.world_from_file.matrix3 * file_from_map;
        let normalized = |v: DVec3| v.try_normalize();
        let columns = (normalized(world_from_map.x_axis), normalized(world_from_map.y_axis), normalized(world_from_map.z_axis));
        let (Some(x), Some(y), Some(z)) = columns else {
            self.warn(place, "the environment's rotation makes no sense, so the environment was left out");
            return;
        };
        let world_from_map = DMat3::from_cols(x, y, z);
        let skew = (world_from_map * world_from_map.transpose() - DMat3::IDENTITY).to_cols_array().iter().any(|v| v.abs() > 1e-4);
        let world_from_map = match nearest_turn(world_from_map) {
            Some(turn) if skew => {
                self.warn(place, "the environment's transform is skewed; the nearest rotation was taken, which turns parts of the picture");
                turn
            }
            Some(_) => world_from_map,
            None => {
                self.warn(place, "the environment's transform has no depth, so the environment was left out");
                return;
            }
        };
        let map_from_world = world_from_map.transpose();
        self.set_environment(Environment::Map { image, rows, scale, map_from_world: mat3_f32(map_from_world) }, place);
    }

    /// Sets the environment; a second one replaces the first, with a warning.
    pub(crate) fn set_environment(&mut self, environment: Environment, place: &str) {
        if self.scene.environment.replace(environment).is_some() {
            self.warn(place, "the file has several environments; the last one counts");
        }
    }
}

/// Position of a light; the origin for one without a position.
fn position_of(light: &Light) -> DVec3 {
    match light {
        Light::Point { position, .. } | Light::Spot { position, .. } | Light::Profile { position, .. } => position.as_dvec3(),
        Light::Directional { .. } => DVec3::ZERO,
    }
}

/// The rotation nearest to `m`, mirrored where `m` is; `None` when it has no inverse.
fn nearest_turn(m: DMat3) -> Option<DMat3> {
    let flip = DMat3::from_diagonal(DVec3::new(m.determinant().signum(), 1.0, 1.0));
    Some(nearest_rotation(m * flip)? * flip)
}
