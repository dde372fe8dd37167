//! Which source a point samples: learned from where each source's light arrives.
//!
//! In a room most light is in shadow: the sun is the strongest source and reaches one patch of floor. [`super::learn`] sends
//! some thousand walks from the cameras to the places that matter and tries the sources there; a grid of cells, six of them at
//! each place for surfaces that face six ways, keeps what arrived. Samples then go to sources in proportion to the root mean
//! square of their contribution, which minimises the variance of the sum, and a fixed fraction is spread over all sources, so that
//! nothing that was missed is lost: the choice changes noise, never the mean.

use super::lights::{Lights, Source};
use super::sample::LightPoint;
use super::window::Windows;
use enfilade_math::{Bounds3, ONE_MINUS_EPSILON, Vec3};

/// Cells along the longest side of the region that the walks visited.
const CELLS: f32 = 24.0;
/// No cell is smaller, in metres.
const MIN_CELL: f32 = 0.2;
/// Cells at one place: six ways that surfaces face, and one for surfaces that light reaches from anywhere.
const FACINGS: usize = 7;
const ANY_FACING: usize = 6;
/// Weight of what was learned in neighbouring cells, and of the other facings of the same cell.
const NEIGHBOUR: f32 = 0.15;
/// The smallest fraction of the samples that ignores what was learned; it is larger in cells with few trials, and this number of trials
/// halves what is added.
const PRIOR_FRACTION: f32 = 0.12;
const FEW_TRIALS: f32 = 4.0;

/// The root mean square of a glint's contributions, as a multiple of the mean: they are small except for a few places.
const GLINT_GAIN: f32 = 4.0;

/// Probabilities of the sources over a grid of cells.
#[derive(Debug)]
pub(crate) struct LightChoice {
    origin: Vec3,
    cell_size: f32,
    cells_per_m: f32,
    /// Places along x, y and z.
    size: [usize; 3],
    sources: usize,
    /// Row of each cell; cells where nothing was learned use the first.
    rows: Vec<u32>,
    /// `sources` numbers a row: sums of the probabilities before each source, in steps of 1/[`ONE`].
    starts: Vec<u16>,
    windows: Option<Windows>,
}

/// Light from a source that a trial found to arrive at a point.
pub(super) struct Arrival {
    pub at: LightPoint,
    pub source: u32,
    /// Estimate of the irradiance, cosine included.
    pub value: f32,
}

/// Sum of the probabilities of a row. Sixteen bits keep a row in one or two lines of the processor's cache.
const ONE: u32 = 1 << 16;

/// The probabilities of the sources at a point: sums before each source, see [`starts`].
#[derive(Clone, Copy)]
pub(super) struct Row<'a>(&'a [u16]);

impl Row<'_> {
    /// A source for `u` uniform on [0,1), its probability, and `u` renewed.
    #[inline]
    pub fn sample(self, u: f32) -> (usize, f32, f32) {
        // Without a branch, some dozen numbers are counted faster than searched.
        let at = u * ONE as f32;
        let whole = at as u16;
        let source = usize::from(self.0.iter().map(|&start| u16::from(start <= whole)).sum::<u16>()) - 1;
        let within = (at - f32::from(self.0[source])) / self.steps(source) as f32;
        (source, self.probability(source), within.clamp(0.0, ONE_MINUS_EPSILON))
    }

    /// The probability of a source.
    #[inline]
    pub fn probability(self, source: usize) -> f32 {
        self.steps(source) as f32 * (1.0 / ONE as f32)
    }

    #[inline]
    fn steps(self, source: usize) -> u32 {
        self.0.get(source + 1).map_or(ONE, |&end| u32::from(end)) - u32::from(self.0[source])
    }
}

/// Sums of the probabilities before each source, in proportion to `weights` ≥ 0 that sum to more than zero; each source keeps a step.
fn starts(weights: &[f32]) -> impl Iterator<Item = u16> {
    let total: f64 = weights.iter().map(|&w| f64::from(w)).sum();
    let free = f64::from(ONE) - weights.len() as f64;
    let mut sum = 0.0;
    weights.iter().enumerate().map(move |(source, &weight)| {
        let start = (sum / total * free).min(free) as usize + source;
        sum += f64::from(weight);
        start as u16
    })
}

impl LightChoice {
    /// The windows through which the sky is seen.
    #[inline]
    pub(super) fn windows(&self) -> Option<&Windows> {
        self.windows.as_ref()
    }

    /// The probabilities at a point.
    #[inline]
    pub(super) fn row(&self, at: &LightPoint) -> Row<'_> {
        let first = self.rows[self.place(at.p) * FACINGS + facing(at.n)] as usize * self.sources;
        Row(&self.starts[first..first + self.sources])
    }

    pub(super) fn from_arrivals(lights: &Lights<'_>, windows: Option<Windows>, arrivals: &[Arrival]) -> Self {
        let bounds = Bounds3::from_points(arrivals.iter().map(|a| a.at.p));
        let bounds = if bounds.is_empty() { Bounds3 { min: Vec3::ZERO, max: Vec3::ZERO } } else { bounds };
        let cell_size = (bounds.extent().max_element() / CELLS).max(MIN_CELL);
        let size = (bounds.extent() / cell_size).to_array().map(|n| n as usize + 1);
        let places = size.iter().product::<usize>();
        let sources = lights.source_count(windows.as_ref().map_or(0, Windows::len));
        let rows = vec![0; places * FACINGS];
        let mut choice =
            Self { origin: bounds.min, cell_size, cells_per_m: 1.0 / cell_size, size, sources, rows, starts: Vec::new(), windows };
        let learned = Learned::gather(&choice, arrivals);
        choice.push_row(&learned.all, lights, None);
        let mut next = 1;
        for place in 0..places {
            for facing in 0..FACINGS {
                if let Some(statistics) = learned.around(&choice, place, facing) {
                    choice.push_row(&statistics, lights, Some((place, facing)));
                    choice.rows[place * FACINGS + facing] = next;
                    next += 1;
                }
            }
        }
        choice
    }

    /// Turns what was learned into probabilities.
    fn push_row(&mut self, learned: &[Statistics], lights: &Lights<'_>, cell: Option<(usize, usize)>) {
        let rms: Vec<f32> = learned
            .iter()
            .enumerate()
            .map(|(source, statistics)| match lights.source(source) {
                // Portals find the brightest of the sky's light as well, so its variance counts for little.
                Source::Sky if self.windows.is_some() => statistics.mean(),
                Source::Glint(_) => GLINT_GAIN * statistics.mean(),
                _ => statistics.root_mean_square(),
            })
            .collect();
        let prior: Vec<f32> = (0..self.sources)
            .map(|s| {
                cell.map_or(0.0, |(place, facing)| {
                    lights.prior(s, self.windows(), &LightPoint { p: self.center(place), n: normal(facing) })
                })
            })
            .map(|importance| if importance.is_finite() { importance } else { 0.0 })
            .collect();
        let (rms_sum, prior_sum) = (rms.iter().sum::<f32>(), prior.iter().sum::<f32>());
        let trials = learned.iter().map(|s| s.count).sum::<f32>() / self.sources as f32;
        let prior_fraction = if rms_sum > 0.0 { PRIOR_FRACTION.max(FEW_TRIALS / (FEW_TRIALS + trials) * 0.5) } else { 1.0 };
        let uniform = 1.0 / self.sources as f32;
        let probability = |s: usize| {
            let by_prior = if prior_sum > 0.0 { 0.5 * prior[s] / prior_sum + 0.5 * uniform } else { uniform };
            let by_learning = if rms_sum > 0.0 { rms[s] / rms_sum } else { 0.0 };
            prior_fraction * by_prior + (1.0 - prior_fraction) * by_learning
        };
        let weights: Vec<f32> = (0..self.sources).map(probability).collect();
        self.starts.extend(starts(&weights));
    }

    #[inline]
    fn place(&self, p: Vec3) -> usize {
        let at = (p - self.origin) * self.cells_per_m;
        let index = |v: f32, n: usize| (v.max(0.0) as usize).min(n - 1);
        let [nx, ny, nz] = self.size;
        (index(at.z, nz) * ny + index(at.y, ny)) * nx + index(at.x, nx)
    }

    fn center(&self, place: usize) -> Vec3 {
        let [nx, ny, _] = self.size;
        let [x, y, z] = [place % nx, place / nx % ny, place / (nx * ny)].map(|i| i as f32 + 0.5);
        self.origin + Vec3::new(x, y, z) * self.cell_size
    }
}

/// The number of the way that a normal faces.
#[inline]
fn facing(n: Vec3) -> usize {
    if n == Vec3::ZERO {
        return ANY_FACING;
    }
    let axis = n.abs().max_position();
    2 * axis + usize::from(n[axis] < 0.0)
}

/// The normal in the middle of a facing.
fn normal(facing: usize) -> Vec3 {
    let mut n = Vec3::ZERO;
    if facing < ANY_FACING {
        n[facing / 2] = if facing.is_multiple_of(2) { 1.0 } else { -1.0 };
    }
    n
}

/// Sums over the trials of a source in a cell.
#[derive(Clone, Copy, Default)]
struct Statistics {
    sum: f32,
    squares: f32,
    count: f32,
}

impl Statistics {
    fn add(&mut self, other: Self, weight: f32) {
        self.sum += weight * other.sum;
        self.squares += weight * other.squares;
        self.count += weight * other.count;
    }

    fn mean(&self) -> f32 {
        if self.count > 0.0 { self.sum / self.count } else { 0.0 }
    }

    fn root_mean_square(&self) -> f32 {
        if self.count > 0.0 { (self.squares / self.count).sqrt() } else { 0.0 }
    }
}

/// The statistics of all trials, by cell.
struct Learned {
    /// Start of each cell's statistics begin, `u32::MAX` where there are none.
    first: Vec<u32>,
    statistics: Vec<Statistics>,
    /// Statistics of all cells together.
    all: Vec<Statistics>,
}

impl Learned {
    fn gather(choice: &LightChoice, arrivals: &[Arrival]) -> Self {
        let none = vec![Statistics::default(); choice.sources];
        let mut learned = Self { first: vec![u32::MAX; choice.rows.len()], statistics: Vec::new(), all: none.clone() };
        for a in arrivals {
            let one = Statistics { sum: a.value, squares: a.value * a.value, count: 1.0 };
            learned.all[a.source as usize].add(one, 1.0);
            let place = choice.place(a.at.p) * FACINGS;
            for facing in [Some(facing(a.at.n)), (a.at.n != Vec3::ZERO).then_some(ANY_FACING)].into_iter().flatten() {
                let first = &mut learned.first[place + facing];
                if *first == u32::MAX {
                    *first = learned.statistics.len() as u32;
                    learned.statistics.extend_from_slice(&none);
                }
                learned.statistics[*first as usize + a.source as usize].add(one, 1.0);
            }
        }
        learned
    }

    /// A cell's own statistics and, with less weight, its neighbours'. `None` if there are none.
    fn around(&self, choice: &LightChoice, place: usize, facing: usize) -> Option<Vec<Statistics>> {
        let [nx, ny, nz] = choice.size;
        let (x, y, z) = (place % nx, place / nx % ny, place / (nx * ny));
        let mut sum = None;
        let mut take = |place: usize, facing: usize, weight: f32| {
            let first = self.first[place * FACINGS + facing];
            if first == u32::MAX {
                return;
            }
            let sum: &mut Vec<Statistics> = sum.get_or_insert_with(|| vec![Statistics::default(); choice.sources]);
            for (s, statistics) in sum.iter_mut().zip(&self.statistics[first as usize..]) {
                s.add(*statistics, weight);
            }
        };
        for cz in z.saturating_sub(1)..nz.min(z + 2) {
            for cy in y.saturating_sub(1)..ny.min(y + 2) {
                for cx in x.saturating_sub(1)..nx.min(x + 2) {
                    let other = (cz * ny + cy) * nx + cx;
                    take(other, facing, if other == place { 1.0 } else { NEIGHBOUR });
                }
            }
        }
        if facing != ANY_FACING {
            take(place, ANY_FACING, NEIGHBOUR);
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_choose_by_their_probabilities() {
        for weights in [vec![0.25, 0.0, 0.75], vec![0.05; 20], vec![1.0]] {
            let starts: Vec<u16> = starts(&weights).collect();
            let row = Row(&starts);
            let probabilities = (0..weights.len()).map(|s| row.probability(s));
            assert!((probabilities.clone().sum::<f32>() - 1.0).abs() < 1e-6);
            assert!(probabilities.zip(&weights).all(|(p, w)| (p - w).abs() < 1e-3));
            for k in 0..1000 {
                let (source, probability, renewed) = row.sample(k as f32 / 1000.0);
                assert!(probability > 0.0 && probability == row.probability(source));
                assert!((0.0..1.0).contains(&renewed));
            }
        }
    }

    #[test]
    fn every_normal_has_the_facing_that_it_is_nearest_to() {
        for f in 0..FACINGS {
            assert_eq!(facing(normal(f)), f);
        }
        assert_eq!(facing(Vec3::new(0.1, -0.9, 0.3)), 3);
    }
}
