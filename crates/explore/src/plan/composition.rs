//! The composition of a picture: how far away its thirds are, and how much of it shows things, compared with photographs.

use super::TargetObject;
use super::glance::{Glance, Glancer};
use enfilade_math::Bounds3;
use enfilade_scene::{Pose, WorldMesh};

/// Values that describe a composition.
const VALUES: usize = 5;

/// The mean composition of NYUv2's 795 training photographs (Silberman et al. 2012), in the order of [`Composer::composition`]. Things are
/// all labelled pixels there except walls, floors, ceilings, doors, windows, blinds and curtains. `python -m enfilade_training.study.views` computes the table.
const MEAN: [f64; VALUES] = [1.146, 0.980, 0.673, -0.098, 0.532];

/// The inverse of the lower Cholesky factor of the covariance of these photographs' compositions.
const WHITENING: [[f64; VALUES]; VALUES] = [
    [2.656, 0.0, 0.0, 0.0, 0.0],
    [-4.326, 5.880, 0.0, 0.0, 0.0],
    [1.338, -5.521, 6.650, 0.0, 0.0],
    [-0.266, -0.107, 0.696, 6.284, 0.0],
    [-1.178, 0.725, 1.315, -0.399, 5.934],
];

/// Where nobody says what things are, they are the parts of which no side is as long as this, metres: furniture and what lies on it. Walls,
/// floors and ceilings are longer.
const THINGS_BELOW_M: f32 = 2.4;

/// Nearer surfaces count as this far away, metres.
const NEAREST_M: f64 = 0.3;

/// Measures compositions of views.
pub(super) struct Composer {
    is_thing: Vec<bool>,
}

impl Composer {
    /// For a scene whose things are the parts of these objects, or its small parts where there are none.
    pub fn new(world: &WorldMesh, things: &[TargetObject]) -> Self {
        if !things.is_empty() {
            let mut is_thing = vec![false; world.contrasts.len()];
            let parts = things.iter().flat_map(|object| &object.parts);
            parts
                .filter_map(|part| Some(*part as usize).filter(|part| *part < world.contrasts.len()))
                .for_each(|part| is_thing[part] = true);
            return Self { is_thing };
        }
        let mut bounds = vec![Bounds3::EMPTY; world.contrasts.len()];
        for (triangle, source) in world.corners.iter().zip(&world.sources) {
            let own = &mut bounds[source.part as usize];
            *own = triangle.iter().fold(*own, |bounds, p| bounds.include(*p));
        }
        Self { is_thing: bounds.iter().map(|bounds| bounds.extent().max_element() < THINGS_BELOW_M).collect() }
    }

    /// How likely the composition of a view is among photographs, relative to their mean composition, whose likelihood is 1; 0 where a third
    /// of the picture shows nothing.
    pub fn likelihood(&self, glancer: &Glancer, pose: &Pose, glance: &Glance) -> f64 {
        let Some(found) = self.composition(glancer, pose, glance) else { return 0.0 };
        let apart: [f64; VALUES] = std::array::from_fn(|i| found[i] - MEAN[i]);
        let white = WHITENING.map(|row| row.iter().zip(apart).map(|(weight, value)| weight * value).sum::<f64>());
        (-0.5 * white.iter().map(|value| value * value).sum::<f64>()).exp()
    }

    /// The mean logarithms of the planar depth in metres in the upper, middle and lower third; by how much it is greater in the outer
    /// quarters than in the inner half; and the share of things.
    pub fn composition(&self, glancer: &Glancer, pose: &Pose, glance: &Glance) -> Option<[f64; VALUES]> {
        let (mut thirds, mut columns) = ([Mean::default(); 3], [Mean::default(); 2]);
        let mut things = Mean::default();
        for point in &glance.points {
            let ([x, y], depth_m) = glancer.placed(pose, point.p_world);
            let depth = depth_m.max(NEAREST_M).ln();
            thirds[(3.0 * y).clamp(0.0, 2.0) as usize].add(depth);
            columns[usize::from((x - 0.5).abs() < 0.25)].add(depth);
            things.add(f64::from(u8::from(self.is_thing[point.part as usize])));
        }
        let [upper, middle, lower] = thirds.map(Mean::value);
        let [outer, inner] = columns.map(Mean::value);
        Some([upper?, middle?, lower?, outer? - inner?, things.value()?])
    }
}

#[derive(Clone, Copy, Default)]
struct Mean {
    sum: f64,
    count: usize,
}

impl Mean {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1;
    }

    /// `None` of nothing.
    fn value(self) -> Option<f64> {
        (self.count > 0).then(|| self.sum / self.count as f64)
    }
}
