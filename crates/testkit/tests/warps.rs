//! Every sampling warp of `math` draws from the density that it documents.

use enfilade_math::{Distribution1, Distribution2, INV_PI, Vec3, warp};
use enfilade_testkit::{ChiSquare, chi_square_survival};

const SAMPLES: u32 = 300_000;
const TESTS: usize = 8;

#[test]
fn directions_follow_their_densities() {
    let sphere = ChiSquare::directions(SAMPLES, |u| Some(warp::sphere([u[0], u[1]])), |_| 0.25 * INV_PI);
    sphere.assert("uniform sphere", TESTS);
    let cosine = ChiSquare::directions(SAMPLES, |u| Some(warp::cosine_hemisphere([u[0], u[1]])), |w| warp::cosine_hemisphere_pdf(w.z));
    cosine.assert("cosine hemisphere", TESTS);
    // The cone's border is between rows of cells: 1 − cosθ = 0.5 = 6 rows of 24.
    let cone =
        ChiSquare::directions(SAMPLES, |u| Some(warp::cone([u[0], u[1]], 0.5)), |w| if w.z > 0.5 { warp::cone_pdf(0.5) } else { 0.0 });
    cone.assert("cone", TESTS);
}

#[test]
fn points_follow_their_densities() {
    // Disk: uniform in (r², φ).
    let disk = ChiSquare::square(
        SAMPLES,
        |u| {
            let d = warp::disk([u[0], u[1]]);
            Some([d.length_squared(), d.y.atan2(d.x) / std::f32::consts::TAU + 0.5])
        },
        |_| 1.0,
    );
    disk.assert("disk", TESTS);
    // Triangle: uniform below the diagonal, whose cells are half covered.
    let triangle = ChiSquare::square(
        SAMPLES,
        |u| Some(warp::triangle([u[0], u[1]]).to_array()),
        |p| {
            if p[0] + p[1] < 1.0 {
                2.0
            } else if p[0] + p[1] == 1.0 {
                1.0
            } else {
                0.0
            }
        },
    );
    triangle.assert("triangle", TESTS);
    let tent = |x: f32| 2.0 * (1.0 - (2.0 * x - 1.0).abs());
    let filter = ChiSquare::square(
        SAMPLES,
        |u| Some([0.5 + 0.5 * warp::tent(u[0], 1.0), 0.5 + 0.5 * warp::tent(u[1], 1.0)]),
        |p| tent(p[0]) * tent(p[1]),
    );
    filter.assert("tent", TESTS);
}

#[test]
fn distributions_follow_their_weights() {
    let weights: Vec<f32> = (0..32).map(|i| ((i * 7 % 13) as f32).powi(2)).collect();
    let one = Distribution1::new(&weights).unwrap();
    let line = ChiSquare::square(
        SAMPLES,
        |u| {
            let (index, _, renewed) = one.sample(u[0]);
            Some([(index as f32 + 0.5) / 32.0, renewed])
        },
        |p| one.pmf((p[0] * 32.0) as usize) * 32.0,
    );
    line.assert("discrete", TESTS);
    let grid: Vec<f32> = (0..64).map(|i| if i % 5 == 0 { 0.0 } else { (i % 11) as f32 }).collect();
    let two = Distribution2::new(&grid, 8).unwrap();
    ChiSquare::square(SAMPLES, |u| Some(two.sample([u[0], u[1]]).0), |p| two.pdf(p)).assert("grid", TESTS);
}

#[test]
fn a_wrong_density_is_found_out() {
    let biased = ChiSquare::directions(
        SAMPLES,
        |u| Some(warp::cosine_hemisphere([u[0], u[1]])),
        |w: Vec3| if w.z > 0.0 { 0.5 * INV_PI } else { 0.0 },
    );
    assert!(biased.p_value < 1e-12);
    assert!(chi_square_survival(0.0, 5) == 1.0);
}
