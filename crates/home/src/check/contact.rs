//! Contacts of objects: those that cut each other deeper than they may, and those that touch.

use crate::shell::is_shell;
use enfilade_furniture::meet::{Body, overlap};
use enfilade_furniture::touch::{SOFT_REACH, is_draped, is_soft, reach};
use enfilade_math::Vec3;

/// Objects may sink this far into each other: feet into a rug's pile, screws into a wall, metres.
const SINK: f32 = 0.004;
/// Cloth and cushions, which give way, may sink this far into others, metres.
const SOFT_SINK: f32 = 0.03;
/// Shares of their reach by which bodies are moved towards others: cloth that lies flat is thinner than all of it, and would be within.
const SHARES: [f32; 2] = [1.0, 0.2];
/// The six ways along the axes.
const WAYS: [Vec3; 6] = [Vec3::Z, Vec3::NEG_Z, Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y];

/// The core of a soft body, which gives way on all sides; `None` for a hard one.
pub fn core(body: &Body) -> Option<Body> {
    is_soft(&body.name).then(|| body.shrunk(SOFT_SINK))
}

/// True when `a`, moved by `offset`, runs into `b` deeper than it may.
pub fn runs_into(a: &Body, b: &Body, offset: Vec3) -> bool {
    cuts(a, b, offset) && cores_meet([a, b], [core(a).as_ref(), core(b).as_ref()], offset)
}

/// True when the surface of `a`, moved by `offset`, cuts the surface of `b`; never for cloth that lies in folds.
pub fn cuts(a: &Body, b: &Body, offset: Vec3) -> bool {
    !is_draped(&a.name) && !is_draped(&b.name) && a.meets(b, offset)
}

/// True when two bodies whose surfaces cut each other go deeper than they may, given their [`core`]s.
pub fn cores_meet([a, b]: [&Body; 2], cores: [Option<&Body>; 2], offset: Vec3) -> bool {
    // Hard bodies that a small step sets free are no deeper in each other than that step; of soft ones, what is left of them decides.
    match cores {
        [None, None] => WAYS.iter().all(|way| a.meets(b, offset + *way * SINK)),
        [soft_a, soft_b] => soft_a.unwrap_or(a).meets(soft_b.unwrap_or(b), offset),
    }
}

/// True when `a`, moved by `offset`, comes so near to `b` that either can carry the other.
pub fn touches(a: &Body, b: &Body, offset: Vec3) -> bool {
    let reach = reach(&a.name, &b.name);
    let shares = if reach < SOFT_REACH { &SHARES[..1] } else { &SHARES };
    a.bounds.min.cmple(b.bounds.max + reach - offset).all()
        && b.bounds.min.cmple(a.bounds.max + reach + offset).all()
        && (a.meets(b, offset) || shares.iter().any(|share| WAYS.iter().any(|way| a.meets(b, offset + *way * (share * reach)))))
}

/// Pairs of bodies that may touch; not those of the shell.
fn neighbours(bodies: &[Body]) -> Vec<(usize, usize)> {
    let shell: Vec<bool> = bodies.iter().map(|b| is_shell(&b.name)).collect();
    let mut order: Vec<usize> = (0..bodies.len()).collect();
    order.sort_by(|&a, &b| bodies[a].bounds.min.x.total_cmp(&bodies[b].bounds.min.x));
    let mut pairs = Vec::new();
    for (k, &a) in order.iter().enumerate() {
        for &b in order[k + 1..].iter().take_while(|&&b| bodies[b].bounds.min.x <= bodies[a].bounds.max.x + SOFT_REACH) {
            if !(shell[a] && shell[b]) && overlap(&bodies[a].bounds, &bodies[b].bounds, SOFT_REACH) {
                pairs.push((a.min(b), a.max(b)));
            }
        }
    }
    pairs.sort_unstable();
    pairs
}

/// The contacts between many bodies: sorted pairs of their numbers, the smaller first.
pub struct Contacts {
    /// Pairs that touch.
    pub touching: Vec<(usize, usize)>,
    /// Pairs that run into each other.
    pub meeting: Vec<(usize, usize)>,
}

impl Contacts {
    /// All contacts.
    pub fn new(bodies: &[Body]) -> Self {
        let pairs = neighbours(bodies);
        Self { touching: touching(bodies, &pairs), meeting: meetings(bodies, &pairs) }
    }

    /// Those by touch alone.
    pub fn of_touch(bodies: &[Body]) -> Self {
        Self { touching: touching(bodies, &neighbours(bodies)), meeting: Vec::new() }
    }

    /// Finds the contacts between the bodies of `group`, which have moved, and all others again.
    pub fn renew(&mut self, bodies: &[Body], group: &[usize]) {
        let changed = |&(a, b): &(usize, usize)| group.contains(&a) != group.contains(&b);
        let pairs: Vec<(usize, usize)> = neighbours(bodies).into_iter().filter(changed).collect();
        let new = [touching(bodies, &pairs), meetings(bodies, &pairs)];
        for (known, new) in [&mut self.touching, &mut self.meeting].into_iter().zip(new) {
            known.retain(|pair| !changed(pair));
            known.extend(new);
            known.sort_unstable();
        }
    }

    /// Whether the shell carries each body, directly or by way of others, if only those are left of which `there` is true.
    pub fn carried(&self, bodies: &[Body], there: impl Fn(usize) -> bool) -> Vec<bool> {
        let mut beside: Vec<Vec<usize>> = vec![Vec::new(); bodies.len()];
        for &(a, b) in &self.touching {
            beside[a].push(b);
            beside[b].push(a);
        }
        let mut carried = vec![false; bodies.len()];
        let mut stack: Vec<usize> = (0..bodies.len()).filter(|&i| is_shell(&bodies[i].name)).collect();
        while let Some(i) = stack.pop() {
            if there(i) && !std::mem::replace(&mut carried[i], true) {
                stack.extend(beside[i].iter().filter(|&&j| !carried[j]));
            }
        }
        carried
    }
}

fn meetings(bodies: &[Body], pairs: &[(usize, usize)]) -> Vec<(usize, usize)> {
    enfilade_parallel::flat_map(pairs, |&(a, b)| runs_into(&bodies[a], &bodies[b], Vec3::ZERO).then_some((a, b)))
}

fn touching(bodies: &[Body], pairs: &[(usize, usize)]) -> Vec<(usize, usize)> {
    enfilade_parallel::flat_map(pairs, |&(a, b)| touches(&bodies[a], &bodies[b], Vec3::ZERO).then_some((a, b)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_furniture::shape::{Reshape, bevelled_box};

    #[test]
    fn a_towel_that_lies_flat_touches_the_floor() {
        let body = |name: &str, size: [f32; 3], at: [f32; 3]| {
            let mesh = bevelled_box(Vec3::from_array(size), 0.001).moved(Vec3::from_array(at));
            let mut body = Body::new(name);
            body.push((0..mesh.triangles.len()).map(|t| mesh.corners(t)).collect());
            body
        };
        let floor = body("floor_gym_1", [4.0, 4.0, 0.3], [0.0, 0.0, -0.15]);
        let towel = |z: f32| body("towel_1", [1.0, 0.6, 0.012], [0.0, 0.0, z]);
        assert!(touches(&towel(0.0076), &floor, Vec3::ZERO));
        assert!(!touches(&towel(0.04), &floor, Vec3::ZERO));
    }
}
