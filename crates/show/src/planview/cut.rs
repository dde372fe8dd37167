//! Planes that cut through a scene, and where its surfaces meet them.

use enfilade_math::DVec3;
use enfilade_scene::WorldMesh;

/// Which way a drawing looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Look {
    /// From above: x to the right, y up the page.
    Down,
    /// Along +y: x to the right, z up the page.
    AlongY,
    /// Along −x: y to the right, z up the page.
    AgainstX,
}

impl Look {
    /// World directions to the right on the page, up the page, and toward the viewer. Right-handed.
    pub fn axes(self) -> [DVec3; 3] {
        match self {
            Self::Down => [DVec3::X, DVec3::Y, DVec3::Z],
            Self::AlongY => [DVec3::X, DVec3::Z, DVec3::NEG_Y],
            Self::AgainstX => [DVec3::Y, DVec3::Z, DVec3::X],
        }
    }

    /// Names of the axes to the right and up the page.
    pub fn axis_names(self) -> [&'static str; 2] {
        match self {
            Self::Down => ["x", "y"],
            Self::AlongY => ["x", "z"],
            Self::AgainstX => ["y", "z"],
        }
    }
}

/// A plane, seen from one of its sides. What is behind it is drawn, what is in front is cut away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cut {
    /// The side from which it is seen.
    pub look: Look,
    /// A point of the plane, metres.
    pub through: DVec3,
}

impl Cut {
    /// Metres from the plane toward the viewer; negative behind it.
    pub fn height_over(&self, p: DVec3) -> f64 {
        (p - self.through).dot(self.look.axes()[2])
    }

    /// In words, as "z = 1.40 m".
    pub fn name(&self) -> String {
        let (name, value) = match self.look {
            Look::Down => ("z", self.through.z),
            Look::AlongY => ("y", self.through.y),
            Look::AgainstX => ("x", self.through.x),
        };
        format!("{name} = {value:.2} m")
    }

    /// The lines in which the surfaces of `world` meet the plane, in the order of its triangles.
    ///
    /// A triangle within the plane gives none. Corners on the plane count as in front of it, so that two triangles that share
    /// an edge within the plane give that edge at most once each.
    pub fn lines(&self, world: &WorldMesh) -> Vec<[DVec3; 2]> {
        enfilade_parallel::flat_map(&world.corners, |corners| self.line(corners.map(|p| p.as_dvec3())))
    }

    fn line(&self, corners: [DVec3; 3]) -> Option<[DVec3; 2]> {
        let heights = corners.map(|p| self.height_over(p));
        let crossing = |i: usize, j: usize| {
            let (a, b) = (heights[i], heights[j]);
            ((a < 0.0) != (b < 0.0)).then(|| corners[i].lerp(corners[j], a / (a - b)))
        };
        let mut found = [(0, 1), (1, 2), (2, 0)].into_iter().filter_map(|(i, j)| crossing(i, j));
        let (from, to) = (found.next()?, found.next()?);
        (from != to).then_some([from, to])
    }
}

/// Joins lines that share an end, to within a tenth of a millimetre, to longer runs. Every line is in one run.
pub(super) fn joined(lines: &[[DVec3; 2]]) -> Vec<Vec<DVec3>> {
    let key = |p: DVec3| (p * 1e4).round().to_array().map(|v| v as i64);
    let mut at: std::collections::BTreeMap<[i64; 3], Vec<usize>> = std::collections::BTreeMap::new();
    for (i, line) in lines.iter().enumerate() {
        line.iter().for_each(|&end| at.entry(key(end)).or_default().push(i));
    }
    let mut used = vec![false; lines.len()];
    let follow = |run: &mut Vec<DVec3>, used: &mut Vec<bool>| {
        while let Some(&end) = run.last() {
            let Some(next) = at.get(&key(end)).and_then(|there| there.iter().copied().find(|&i| !used[i])) else { break };
            used[next] = true;
            let [a, b] = lines[next];
            run.push(if key(a) == key(end) { b } else { a });
        }
    };
    let mut runs = Vec::new();
    for i in 0..lines.len() {
        if used[i] {
            continue;
        }
        used[i] = true;
        let mut run = lines[i].to_vec();
        follow(&mut run, &mut used);
        run.reverse();
        follow(&mut run, &mut used);
        runs.push(run);
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_testroom::box_room;

    fn length(lines: &[[DVec3; 2]]) -> f64 {
        lines.iter().map(|[a, b]| a.distance(*b)).sum()
    }

    #[test]
    fn a_box_room_is_cut_along_its_perimeter() {
        let room = box_room(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5));
        for (look, perimeter) in [(Look::Down, 14.0), (Look::AlongY, 13.0), (Look::AgainstX, 11.0)] {
            let cut = Cut { look, through: DVec3::new(1.7, 1.2, 1.4) };
            let lines = cut.lines(&room);
            assert_eq!(lines.len(), 8, "two triangles for each of four sides");
            assert!((length(&lines) - perimeter).abs() < 1e-6, "{look:?}: {}", length(&lines));
            assert!(lines.iter().flatten().all(|p| cut.height_over(*p).abs() < 1e-6));
            let runs = joined(&lines);
            assert_eq!((runs.len(), runs[0].len()), (1, 9), "one closed run");
            assert!(runs[0][0].distance(runs[0][8]) < 1e-6);
        }
    }

    #[test]
    fn a_plane_that_misses_the_room_cuts_nothing() {
        let room = box_room(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5));
        let cut = |z| Cut { look: Look::Down, through: DVec3::Z * z }.lines(&room);
        assert!(cut(3.0).is_empty() && cut(-0.1).is_empty());
        assert!((length(&cut(2.5)) - 14.0).abs() < 1e-6, "walls up to the plane count, the ceiling within it does not");
    }

    #[test]
    fn page_axes_are_right_handed() {
        for look in [Look::Down, Look::AlongY, Look::AgainstX] {
            let [right, up, toward] = look.axes();
            assert_eq!(right.cross(up), toward);
        }
    }
}
