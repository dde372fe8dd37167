//! How far a joint can go before what moves runs into something: states are tried one after another, on the triangles.

use super::contact::runs_into;
use enfilade_furniture::meet::{Body, Triangle, overlap};
use enfilade_math::{Bounds3, Vec3, free_way};
use enfilade_scene::BodyStates;

/// Distance that the farthest point goes from one state that is tried to the next, metres: boards and leaves are about as thick.
const STEP: f64 = 0.02;
/// Times that the last step before a contact is halved.
const HALVINGS: usize = 5;

/// What moves by a joint.
pub struct Mover {
    /// Of the object that has the joint: it decides how soft it is.
    name: String,
    /// Triangles at rest, part by part.
    parts: Vec<Vec<Triangle>>,
    states: BodyStates,
}

/// How far something can go, and what stops it.
pub struct Reach {
    /// The farthest state that is free.
    pub state: f64,
    /// Name of the object in the way.
    pub stopped_by: Option<String>,
}

impl Mover {
    /// What moves: the triangles of its parts at rest.
    pub fn new(name: &str, parts: Vec<Vec<Triangle>>, states: &BodyStates) -> Self {
        Self { name: name.into(), parts, states: states.clone() }
    }

    /// Name of the object.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// It in a state.
    pub fn at(&self, state: f64) -> Body {
        let map = self.states.map_to(state);
        let mut body = Body::new(&self.name);
        for part in &self.parts {
            body.push(part.iter().map(|triangle| triangle.map(|p| map.transform_point3(p.as_dvec3()).as_vec3())).collect());
        }
        body
    }

    /// By how much the state changes from one that is tried to the next.
    fn step(&self) -> f64 {
        let BodyStates::Hinge { point, axis, .. } = &self.states else { return STEP };
        let points = self.parts.iter().flatten().flatten();
        let radius = points.map(|p| axis.cross(p.as_dvec3() - *point).length()).fold(0.05, f64::max);
        STEP / radius
    }

    /// How far it can go from rest towards `limit`, with these bodies around it.
    pub fn reach(&self, limit: f64, others: &[&Body]) -> Reach {
        let near = self.near(limit, others);
        let (state, stopped_by) = free_way(limit, self.step(), HALVINGS, |state| self.hit(state, &near).map(str::to_string));
        Reach { state, stopped_by }
    }

    /// Name of a body that it runs into in a state.
    pub fn hit<'a>(&self, state: f64, others: &[&'a Body]) -> Option<&'a str> {
        let moved = self.at(state);
        others.iter().find(|other| runs_into(&moved, other, Vec3::ZERO)).map(|other| other.name.as_str())
    }

    /// The bodies whose boxes meet that of the whole way to `limit`.
    fn near<'a>(&self, limit: f64, others: &[&'a Body]) -> Vec<&'a Body> {
        // Between two of nine states of an arc of up to half a circle its points leave the box of both by less than 2 % of their distance
        // from the axis, which is below a metre and a half.
        const MARGIN: f32 = 0.03;
        let way = (0..=8).map(|k| self.at(limit * f64::from(k) / 8.0).bounds).fold(Bounds3::EMPTY, Bounds3::union);
        others.iter().copied().filter(|other| overlap(&way, &other.bounds, MARGIN)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_furniture::shape::{Reshape, bevelled_box};
    use enfilade_math::DVec3;

    fn triangles(size: [f32; 3], at: [f32; 3]) -> Vec<Triangle> {
        let mesh = bevelled_box(Vec3::from_array(size), 0.001).moved(Vec3::from_array(at));
        (0..mesh.triangles.len()).map(|t| mesh.corners(t)).collect()
    }

    fn body(name: &str, size: [f32; 3], at: [f32; 3]) -> Body {
        let mut body = Body::new(name);
        body.push(triangles(size, at));
        body
    }

    #[test]
    fn a_drawer_stops_at_what_stands_before_it() {
        let states = BodyStates::Slide { axis: DVec3::Y, distances_m: vec![0.0] };
        let drawer = Mover::new("dresser_1", vec![triangles([0.4, 0.02, 0.2], [0.0, 0.0, 0.5])], &states);
        // Its face is at 0.01, the front of the crate at 0.25; things may sink 4 mm into each other.
        let crate_ = body("crate_1", [0.5, 0.1, 0.6], [0.0, 0.3, 0.3]);
        let aside = body("crate_2", [0.5, 0.1, 0.6], [2.0, 0.1, 0.3]);
        let found = drawer.reach(0.35, &[&aside, &crate_]);
        assert_eq!(found.stopped_by.as_deref(), Some("crate_1"));
        assert!((0.2395..=0.2451).contains(&found.state), "{}", found.state);
        let free = drawer.reach(0.35, &[&aside]);
        assert_eq!((free.state, free.stopped_by), (0.35, None));
    }

    #[test]
    fn a_door_stops_at_the_wall() {
        // A leaf of 0.8 m, hinged at the origin, turns from x towards y; a wall along y stands at x = −0.4.
        let states = BodyStates::Hinge { point: DVec3::ZERO, axis: DVec3::Z, angles_rad: vec![0.0] };
        let leaf = Mover::new("door_1", vec![triangles([0.8, 0.04, 2.0], [0.4, -0.02, 1.0])], &states);
        let wall = body("wall_hall_west_1", [0.1, 3.0, 2.5], [-0.45, 1.5, 1.25]);
        let found = leaf.reach(2.5, &[&wall]);
        assert_eq!(found.stopped_by.as_deref(), Some("wall_hall_west_1"));
        // The corner of its face is 0.8 m from the hinge: it reaches x = −0.4 at 120 degrees.
        assert!((found.state - 120f64.to_radians()).abs() < 0.012, "{}", found.state.to_degrees());
    }
}
