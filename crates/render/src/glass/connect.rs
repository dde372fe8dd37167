//! The way from a surface through glass to a light.

use super::bodies::Bodies;
use super::shot::{End, Passed, Shot};
use crate::light::{LightPoint, LightSample};
use crate::prepared::RenderScene;
use crate::surface::{Surface, shadow_ray};
use crate::vertex::Medium;
use enfilade_math::{Onb, Ray, Rgb, Rng, Vec2, Vec3, offset_origin, warp};

/// Newton's steps, and how often a step that leads nowhere is halved.
const STEPS: usize = 16;
const HALVINGS: usize = 5;
/// The longest step, as a tangent.
const LONGEST_STEP: f32 = 0.5;
/// A light is met when the shot passes it by no more than this, as a fraction of the distance, or when the directions differ by as much.
const MET: f32 = 5e-5;
/// Ways are the same when they pass the same flat faces, and their first directions differ by no more than this.
const SAME: f32 = 2e-3;
/// The most attempts to find a way again. A way that takes more counts for less than it should.
const ATTEMPTS: u32 = 16_384;
/// How far first directions to a light at infinity are spread about the straight one, as a tangent.
const SPREAD: f32 = 0.7;

/// A way through glass.
pub(crate) struct Connection {
    /// The first direction, a unit vector.
    pub wi: Vec3,
    /// The last direction, at the light.
    pub arrives: Vec3,
    /// Fraction of the light that comes through.
    pub through: Rgb,
    /// For a light at a point, the irradiance across the way for an intensity of one, per square metre; for a light at infinity, the
    /// irradiance across the way if it were one without the glass.
    pub spread: f32,
    /// True when only panes are on the way, so that sampled directions find the same light.
    pub parallel: bool,
    /// The panes and borders on it.
    pub passed: Passed,
    /// A number for the flat faces that it passes, in their order.
    pub faces: u64,
    /// Estimated number of ways that this one represents.
    pub ways: f32,
}

/// The end of a way.
#[derive(Clone, Copy)]
enum Goal {
    /// A point, and the unit normal of its surface, if it is on one.
    Point(Vec3, Vec3),
    Direction(Vec3),
}

impl Goal {
    fn of(light: &LightSample) -> Self {
        light.target.map_or(Self::Direction(light.wi), |p| Self::Point(p, light.normal))
    }

    fn end(self) -> End {
        match self {
            Self::Point(p, normal) => End::Near(p, normal),
            Self::Direction(_) => End::After(f32::INFINITY),
        }
    }

    /// By how much a shot misses, across its direction, and the derivatives of its end.
    fn miss(self, shot: &Shot, distance: f32) -> Option<(Vec3, [Vec3; 2])> {
        let across = |v: Vec3| v - shot.direction * v.dot(shot.direction);
        match self {
            Self::Point(p, _) => Some((across(p - shot.p) / distance, shot.moved.map(|moved| moved / distance))),
            Self::Direction(d) => (d.dot(shot.direction) > 0.0).then(|| (across(d), shot.turned)),
        }
    }
}

impl<'s> RenderScene<'s> {
    /// The way from `surface`, whose side towards a sample of light is in `medium`, through panes to that.
    pub(crate) fn connect(&self, surface: &Surface<'s>, medium: Medium, light: &LightSample) -> Option<Connection> {
        self.glass_ahead(&surface.shadow_ray(light.wi, light.target))?;
        let goal = Goal::of(light);
        let panes = self.passes_panes(&surface.ray(light.wi), medium, goal.end());
        panes.then(|| self.aim(surface, medium, light.wi, goal).filter(|way| way.parallel))?
    }

    /// A way from `surface` to a sample of a light without a surface, through glass that bends it. Where no such glass is on the straight
    /// way, of which `hidden` is false if it is known to be free or to pass panes, only some points look for one: those from where there
    /// seems to be much curved glass.
    pub(crate) fn connect_bent(
        &self,
        surface: &Surface<'s>,
        medium: Medium,
        light: &LightSample,
        hidden: bool,
        mut rng: Rng,
    ) -> Option<Connection> {
        let &LightSample { wi, target, .. } = light;
        let straight = surface.shadow_ray(wi, target);
        let ahead = if hidden { self.glass_ahead(&straight) } else { None };
        let seen = self.bodies.seen_from(surface);
        let chance = if ahead.is_some() { 1.0 } else { Bodies::chance(seen) };
        if rng.next_f32() >= chance {
            return None;
        }

        // Begin anywhere about the light or in a body, and see how often the same way is found.
        let mut attempt = || {
            let start = match ahead {
                Some((near, _)) if rng.next_f32() < 0.5 => {
                    let aside = warp::sphere([rng.next_f32(), rng.next_f32()]) * rng.next_f32();
                    target.map_or(wi + aside * SPREAD, |target| target + aside * (straight.t_max - near) - straight.origin)
                }
                Some((_, part)) if rng.next_f32() < 0.5 => self.bodies.find(part)?.point(&mut rng) - straight.origin,
                _ => self.bodies.choose(surface, rng.next_f32() * seen)?.point(&mut rng) - straight.origin,
            };
            self.aim(surface, medium, start.try_normalize()?, Goal::of(light)).filter(|way| !way.parallel)
        };
        let mut found = attempt()?;
        for _ in 1..ATTEMPTS {
            if attempt().is_some_and(|again| again.faces == found.faces && again.wi.distance_squared(found.wi) < SAME * SAME) {
                break;
            }
            found.ways += 1.0;
        }
        found.ways /= chance;
        Some(found)
    }

    /// Whether [`RenderScene::connect`] looks for the way through panes from `from` to the point `p` of an emissive surface with the unit
    /// normal `normal`: the straight way there meets panes and nothing else. `medium` is that at both ends.
    pub(crate) fn meets_panes(&self, from: &LightPoint, medium: Medium, p: Vec3, normal: Vec3) -> bool {
        let Some(direction) = (p - from.p).try_normalize() else { return false };
        let aside = if from.n == Vec3::ZERO { direction } else { from.n * from.n.dot(direction).signum() };
        let ray = Ray::new(offset_origin(from.p, aside), direction);
        self.glass_ahead(&shadow_ray(ray.origin, direction, Some(p))).is_some() && self.passes_panes(&ray, medium, End::Near(p, normal))
    }

    /// Whether only panes are on a ray's way to its end.
    fn passes_panes(&self, ray: &Ray, medium: Medium, end: End) -> bool {
        self.shoot(ray, medium, end).is_some_and(|shot| shot.parallel)
    }

    /// Corrects the first direction of a shot until it meets its goal.
    fn aim(&self, surface: &Surface<'s>, medium: Medium, start: Vec3, goal: Goal) -> Option<Connection> {
        let distance = if let Goal::Point(p, _) = goal { p.distance(surface.p) } else { 1.0 };
        let shoot = |wi: Vec3| {
            let shot = self.shoot(&surface.ray(wi), medium, goal.end())?;
            let (miss, by) = goal.miss(&shot, distance)?;
            Some((wi, shot, miss, by))
        };
        let mut best = shoot(start)?;
        for _ in 0..STEPS {
            let (wi, shot, miss, by) = best;
            let axes = Onb::from_z(shot.direction);
            let [a, b] = by.map(|v| Vec2::new(axes.x.dot(v), axes.y.dot(v)));
            let determinant = a.perp_dot(b);
            let miss_2d = Vec2::new(axes.x.dot(miss), axes.y.dot(miss));
            let step = Vec2::new(miss_2d.perp_dot(b), a.perp_dot(miss_2d)) / determinant;
            if !step.is_finite() {
                return None;
            }
            let step = step.clamp_length_max(LONGEST_STEP);
            let first = Onb::from_z(wi);
            let moved_by = |fraction: f32| (wi + (first.x * step.x + first.y * step.y) * fraction).normalize();
            if miss.length_squared() <= MET * MET {
                // Beside the edge of a flat face no way may pass where this one does: the last step shows it.
                let same_faces = shot.faces == 0 || shoot(moved_by(1.0))?.1.faces == shot.faces;
                return same_faces.then(|| connection(wi, &shot, goal, medium, determinant.abs(), distance))?;
            }
            let try_step =
                |fraction: f32| shoot(moved_by(fraction)).filter(|(_, _, closer, _)| closer.length_squared() < miss.length_squared());
            best = (0..HALVINGS).find_map(|k| try_step(0.5f32.powi(k as i32)))?;
        }
        None
    }
}

/// The way that a shot has found. `determinant` belongs to the derivatives of its end, for a light at a point divided by the square of
/// `distance`.
fn connection(wi: Vec3, shot: &Shot, goal: Goal, medium: Medium, determinant: f32, distance: f32) -> Option<Connection> {
    // Radiance over the square of the index is the same along a ray, so étendue is kept: what spreads light from here spreads it to here.
    let denser = shot.medium.compression / medium.compression;
    let spread = match goal {
        Goal::Point(..) => denser / (determinant * distance * distance),
        Goal::Direction(_) if shot.parallel => 1.0,
        Goal::Direction(_) => denser / determinant,
    };
    spread.is_finite().then_some(Connection {
        wi,
        arrives: shot.direction,
        through: shot.through,
        spread,
        parallel: shot.parallel,
        passed: shot.passed,
        faces: shot.faces,
        ways: 1.0,
    })
}
