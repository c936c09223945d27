//! Settings of the solver far from the usual ones, on clouds that are harmless themselves.

use cloudtouch_geom::{Covariance, Point3, UncertainPoint, seed};

/// A robust classification problem in the unit box, with one penalty and one kernel width.
#[derive(Debug, Clone, PartialEq)]
pub struct HardProblem {
    /// A short name, unique in the catalogue.
    pub name: &'static str,
    /// Why it is hard.
    pub reason: &'static str,
    /// Points of one class, box lengths.
    pub points_a: Vec<UncertainPoint>,
    /// Points of the other class, box lengths.
    pub points_b: Vec<UncertainPoint>,
    /// Radii of the ellipsoids of `points_a`, standard deviations.
    pub radii_a: Vec<f64>,
    /// Radii of the ellipsoids of `points_b`, standard deviations.
    pub radii_b: Vec<f64>,
    /// C: what a point on the wrong side costs.
    pub penalty: f64,
    /// γ: the width of the Gaussian kernel.
    pub gamma: f64,
}

/// Points of each class.
const POINTS: usize = 30;
/// Standard deviation of the points, box lengths.
const STD: f64 = 0.02;

/// Radii, penalties and kernel widths out of the ordinary, on clouds apart and on clouds that cross.
pub fn hard_problems() -> Vec<HardProblem> {
    let radii = "small and large cones in one problem";
    let slack = "the penalty bounds every multiplier: all points are support vectors";
    let stiff = "a violation costs more than anything else: digits cancel";
    let smooth = "the kernel is 1 between all points: the matrix has rank one";
    let spiky = "the kernel is 0 between all points: the matrix is diagonal";
    vec![
        apart("radii 0 and 6, apart", radii, 100.0, 10.0).with_radii([0.0, 6.0]),
        crossing("radii 0 and 6, crossing", radii, 100.0, 10.0).with_radii([0.0, 6.0]),
        apart("radius 6, apart", "ellipsoids overlap though points do not", 100.0, 10.0)
            .with_radii([6.0, 6.0]),
        crossing("radius 6, crossing", "ellipsoids as large as the scene", 100.0, 10.0)
            .with_radii([6.0, 6.0]),
        apart("C 1e-3, apart", slack, 1e-3, 10.0),
        crossing("C 1e-3, crossing", slack, 1e-3, 10.0),
        apart("C 1e6, apart", stiff, 1e6, 10.0),
        crossing("C 1e6, crossing", stiff, 1e6, 10.0),
        apart("C 1e9, apart", stiff, 1e9, 10.0),
        crossing("C 1e9, crossing", stiff, 1e9, 10.0),
        apart("gamma 1e-6, apart", smooth, 100.0, 1e-6),
        crossing("gamma 1e-6, crossing", smooth, 100.0, 1e-6),
        apart("gamma 1e-3, apart", smooth, 100.0, 1e-3),
        crossing("gamma 1e-3, crossing", smooth, 100.0, 1e-3),
        apart("gamma 1e3, apart", spiky, 100.0, 1e3),
        crossing("gamma 1e3, crossing", spiky, 100.0, 1e3),
        apart("gamma 1e6, apart", spiky, 100.0, 1e6),
        crossing("gamma 1e6, crossing", spiky, 100.0, 1e6),
        apart("C 1e9 with gamma 1e-6, apart", stiff, 1e9, 1e-6),
        crossing("C 1e9 with gamma 1e-6, crossing", stiff, 1e9, 1e-6),
        crossing("C 1e9 with gamma 1e6, crossing", stiff, 1e9, 1e6),
        crossing("C 1e-3 with gamma 1e-6, crossing", slack, 1e-3, 1e-6),
        crossing("C 1e-3 with gamma 1e6, crossing", slack, 1e-3, 1e6),
    ]
}

impl HardProblem {
    /// Two sheets of a unit square: z = 0, and z = `height` + `slope`·x.
    fn sheets(
        (name, reason): (&'static str, &'static str),
        (height, slope): (f64, f64),
        (penalty, gamma): (f64, f64),
    ) -> Self {
        let point = |side: u64, i: usize| {
            let draw = |k| seed::unit(seed::derive(side, i as u64, k)) - 0.5;
            let (x, y) = (draw(0), draw(1));
            let z = if side == 0 { 0.0 } else { height + slope * x };
            let covariance = Covariance::isotropic(STD * STD);
            UncertainPoint { mean: Point3::new(x, y, z + STD * draw(2)), covariance }
        };
        Self {
            name,
            reason,
            points_a: (0..POINTS).map(|i| point(1, i)).collect(),
            points_b: (0..POINTS).map(|i| point(0, i)).collect(),
            radii_a: vec![1.0; POINTS],
            radii_b: vec![1.0; POINTS],
            penalty,
            gamma,
        }
    }

    /// The first radius for every other point, the second for the others.
    fn with_radii(mut self, [even, odd]: [f64; 2]) -> Self {
        for radii in [&mut self.radii_a, &mut self.radii_b] {
            radii.iter_mut().step_by(2).for_each(|r| *r = even);
            radii.iter_mut().skip(1).step_by(2).for_each(|r| *r = odd);
        }
        self
    }
}

/// Sheets ten standard deviations apart.
fn apart(name: &'static str, reason: &'static str, penalty: f64, gamma: f64) -> HardProblem {
    HardProblem::sheets((name, reason), (0.2, 0.0), (penalty, gamma))
}

fn crossing(name: &'static str, reason: &'static str, penalty: f64, gamma: f64) -> HardProblem {
    HardProblem::sheets((name, reason), (0.0, 0.4), (penalty, gamma))
}
