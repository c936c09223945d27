//! Seeded leaf problems shared by the tests and the measuring example.
#![allow(clippy::unwrap_used, reason = "a panic is how a test fails, in its helpers too")]

use cloudtouch_geom::{Covariance, Point3, UncertainPoint, UnitVector3, Vector3, seed};
use cloudtouch_svm::{Class, Sample, Settings, Solver};

/// Default settings with another tolerance.
pub(crate) fn settings(relative_gap: f64) -> Settings {
    Settings { relative_gap, ..Settings::default() }
}

pub(crate) fn solver(settings: &Settings) -> Solver {
    Solver::new(*settings).unwrap()
}

/// A stream of seeded random numbers.
pub(crate) struct Stream {
    seed: u64,
    drawn: u64,
}

impl Stream {
    pub(crate) fn new(seed: u64) -> Self {
        Self { seed, drawn: 0 }
    }

    /// Uniform in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        self.drawn += 1;
        seed::unit(seed::derive(self.seed, self.drawn, 0))
    }

    pub(crate) fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Log-uniform.
    pub(crate) fn log_range(&mut self, low: f64, high: f64) -> f64 {
        self.range(low.ln(), high.ln()).exp()
    }

    pub(crate) fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    /// Standard normal (Box and Muller).
    pub(crate) fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.unit()).ln()).sqrt() * (std::f64::consts::TAU * self.unit()).cos()
    }

    pub(crate) fn normal_vector(&mut self) -> Vector3 {
        Vector3::new(self.normal(), self.normal(), self.normal())
    }
}

/// What two surfaces face each other in the unit box.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Shape {
    Cap,
    Wedge,
    CrossingSheet,
    #[cfg(feature = "clarabel")]
    Blob,
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct Scene {
    pub(crate) shape: Shape,
    pub(crate) count_a: usize,
    pub(crate) count_b: usize,
    /// Signed distance of the surfaces, in box lengths.
    pub(crate) gap: f64,
    /// Standard deviation of the points, in box lengths.
    pub(crate) noise: f64,
    pub(crate) anisotropic: bool,
    pub(crate) radius: f64,
    pub(crate) penalty: f64,
}

impl Scene {
    /// A plane patch (class B, at z = 0) below the shape (class A), both observed with noise.
    pub(crate) fn samples(&self, stream: &mut Stream) -> Vec<Sample> {
        let mut samples = Vec::new();
        for class in [Class::A, Class::B] {
            let count = if class == Class::A { self.count_a } else { self.count_b };
            for _ in 0..count {
                let (x, y) = (stream.range(-0.5, 0.5), stream.range(-0.5, 0.5));
                let z = match (class, self.shape) {
                    (Class::B, _) => 0.0,
                    (Class::A, Shape::Cap) => self.gap + 0.6 * (x * x + y * y),
                    (Class::A, Shape::Wedge) => self.gap + 0.8 * x.abs(),
                    (Class::A, Shape::CrossingSheet) => self.gap + 0.4 * (x + 0.5),
                    #[cfg(feature = "clarabel")]
                    (Class::A, Shape::Blob) => self.gap + 0.3 * stream.unit(),
                };
                let covariance = self.covariance(stream);
                let offset = covariance.sqrt() * stream.normal_vector();
                samples.push(Sample {
                    point: UncertainPoint { mean: Point3::new(x, y, z) + offset, covariance },
                    class,
                    radius: self.radius,
                    penalty: self.penalty,
                });
            }
        }
        samples
    }

    fn covariance(&self, stream: &mut Stream) -> Covariance {
        if self.noise == 0.0 {
            Covariance::zero()
        } else if self.anisotropic {
            let axis = UnitVector3::new_normalize(stream.normal_vector());
            Covariance::from_axis(&axis, self.noise, self.noise * stream.log_range(0.03, 1.0))
        } else {
            Covariance::isotropic(self.noise * self.noise)
        }
    }
}

/// The cells of the timing table: easy, contact and hard leaf problems.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Difficulty {
    Easy,
    Contact,
    Hard,
}

/// A seeded problem of a cell: samples and γ.
pub(crate) fn cell(difficulty: Difficulty, per_side: usize, seed: u64) -> (Vec<Sample>, f64) {
    let mut stream = Stream::new(seed);
    let shape = [Shape::Cap, Shape::Wedge, Shape::CrossingSheet][stream.below(3)];
    let (gap, noise, radius, penalty, gamma) = match difficulty {
        Difficulty::Easy => (stream.range(0.05, 0.3), stream.range(0.01, 0.02), 1.0, 100.0, 5.0),
        Difficulty::Contact => {
            (stream.range(-0.1, 0.1), stream.range(0.01, 0.05), 1.0, 100.0, 10.0)
        }
        Difficulty::Hard => {
            (stream.range(-0.1, 0.1), stream.range(0.05, 0.1), stream.range(2.0, 6.0), 1000.0, 20.0)
        }
    };
    let scene = Scene {
        shape,
        count_a: per_side,
        count_b: per_side,
        gap,
        noise,
        anisotropic: stream.unit() < 0.5,
        radius,
        penalty,
    };
    (scene.samples(&mut stream), gamma)
}

/// Primal and dual value of eq. 10 and 13 for given multipliers and bias, written out from the
/// paper's 4×4 kernel blocks with symmetric covariance roots; shares no code with the library.
pub(crate) fn objectives(
    samples: &[Sample],
    gamma: Option<f64>,
    alpha: &[f64],
    v: &[Vector3],
    centre: &Point3,
    bias: f64,
) -> (f64, f64) {
    let n = samples.len();
    let x: Vec<Vector3> = samples.iter().map(|s| s.point.mean - centre).collect();
    let root: Vec<_> = samples.iter().map(|s| s.point.covariance.sqrt()).collect();
    let sign: Vec<f64> = samples.iter().map(|s| s.class.sign()).collect();
    let (mut f, mut g) = (vec![0.0; n], vec![Vector3::zeros(); n]);
    for i in 0..n {
        for j in 0..n {
            let d = x[i] - x[j];
            let a = sign[j] * alpha[j];
            match gamma {
                None => {
                    f[i] += a * x[i].dot(&x[j]) + (root[j] * x[i]).dot(&v[j]);
                    g[i] += root[i] * x[j] * a + root[i] * (root[j] * v[j]);
                }
                Some(gamma) => {
                    let k = (-gamma * d.norm_squared()).exp();
                    let (si_d, sj_d) = (root[i] * d, root[j] * d);
                    f[i] += k * a + 2.0 * gamma * k * sj_d.dot(&v[j]);
                    let straight = root[i] * (root[j] * v[j]) * (2.0 * gamma * k);
                    let bent = si_d * (4.0 * gamma * gamma * k * sj_d.dot(&v[j]));
                    g[i] += si_d * (-2.0 * gamma * k * a) + straight - bent;
                }
            }
        }
    }
    let squared: f64 = (0..n).map(|i| sign[i] * alpha[i] * f[i] + v[i].dot(&g[i])).sum();
    let slack: f64 = (0..n)
        .map(|i| {
            let y = 1.0 - sign[i] * (f[i] + bias) + samples[i].radius * g[i].norm();
            samples[i].penalty * y.max(0.0)
        })
        .sum();
    (0.5 * squared + slack, alpha.iter().sum::<f64>() - 0.5 * squared)
}

/// The middle of the box of the means: the origin the library's bias refers to.
pub(crate) fn middle(samples: &[Sample]) -> Point3 {
    let first = samples[0].point.mean;
    let (low, high) = samples
        .iter()
        .fold((first, first), |(l, h), s| (l.inf(&s.point.mean), h.sup(&s.point.mean)));
    Point3::from(low.coords * 0.5 + high.coords * 0.5)
}
