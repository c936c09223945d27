//! Carrying the change of one or two samples to f₀, its gradient and |T∇f₀| at all of them.

use cloudtouch_geom::Vector3;

use crate::lanes::{Lane, Lanes};
use crate::problem::Problem;
use crate::problem::kernel::Kernel;

/// A change of weight cα and displacement S v at a sample.
pub(crate) struct Source<'a> {
    pub(crate) x: Vector3,
    /// The reduced kernel of the sample and all others.
    pub(crate) row: &'a [Lane],
    pub(crate) a: f64,
    pub(crate) s: Vector3,
}

/// f₀ and what comes of it, at the samples.
#[derive(Debug, Default)]
pub(crate) struct Field {
    /// f₀ = f − b.
    pub(crate) f: Lanes,
    /// ∇f₀, world axes.
    pub(crate) gradient: [Lanes; 3],
    /// T∇f₀.
    pub(crate) scaled: [Lanes; 3],
    /// |T∇f₀|.
    pub(crate) norm: Lanes,
}

impl Field {
    /// Of so many samples where all is 0.
    pub(crate) fn reset(&mut self, samples: usize) {
        let vectors = self.gradient.iter_mut().chain(&mut self.scaled);
        for lanes in vectors.chain([&mut self.f, &mut self.norm]) {
            lanes.reset(samples);
        }
    }

    /// y = 1 − c f₀ + |T∇f₀| of a sample of this class.
    #[inline]
    pub(crate) fn violation(&self, sign: f64, i: usize) -> f64 {
        1.0 - sign * self.f.at(i) + self.norm.at(i)
    }

    pub(crate) fn gradient_at(&self, i: usize) -> Vector3 {
        Vector3::from_fn(|axis, _| self.gradient[axis].at(i))
    }

    #[cfg(test)]
    fn scaled_at(&self, i: usize) -> Vector3 {
        Vector3::from_fn(|axis, _| self.scaled[axis].at(i))
    }

    /// Adds what the sources add.
    ///
    /// Where no point is uncertain only f₀ is kept: nothing asks for gradients before the end, when
    /// they are computed anew `with_gradients`.
    pub(crate) fn add(&mut self, problem: &Problem, sources: &[Source<'_>], with_gradients: bool) {
        let arch = pulp::Arch::new();
        if with_gradients {
            arch.dispatch(Spread { problem, sources, field: self });
        } else {
            arch.dispatch(SpreadValues { sources, field: self });
        }
    }
}

struct Spread<'a> {
    problem: &'a Problem,
    sources: &'a [Source<'a>],
    field: &'a mut Field,
}

impl pulp::NullaryFnOnce for Spread<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { problem, sources, field } = self;
        let places = problem.places.each_ref().map(Lanes::lanes);
        let factors = problem.factors.each_ref().map(Lanes::lanes);
        let Field { f, gradient, scaled, norm } = field;
        let f = f.lanes_mut();
        let [gx, gy, gz] = gradient.each_mut().map(Lanes::lanes_mut);
        let [tx, ty, tz] = scaled.each_mut().map(Lanes::lanes_mut);
        let n = f.len();
        let norm = &mut norm.lanes_mut()[..n];
        let (places, factors) = (places.map(|lanes| &lanes[..n]), factors.map(|lanes| &lanes[..n]));
        let [gx, gy, gz] = [gx, gy, gz].map(|lanes| &mut lanes[..n]);
        let [tx, ty, tz] = [tx, ty, tz].map(|lanes| &mut lanes[..n]);
        for k in 0..n {
            let to = places.map(|lanes| lanes[k]);
            let mut value = f[k];
            let mut g = [gx[k], gy[k], gz[k]];
            for source in sources {
                let (df, dg) = influence(&problem.kernel, source, source.row[k], &to);
                value += df;
                g = [g[0] + dg[0], g[1] + dg[1], g[2] + dg[2]];
            }
            f[k] = value;
            [gx[k], gy[k], gz[k]] = g;
            // No closures here: one that is not inlined has not the instructions of the processor.
            let mut t = [Lane::ZERO; 3];
            for axis in 0..3 {
                let row = [&factors[3 * axis], &factors[3 * axis + 1], &factors[3 * axis + 2]];
                t[axis] = row[0][k] * g[0] + row[1][k] * g[1] + row[2][k] * g[2];
            }
            [tx[k], ty[k], tz[k]] = t;
            norm[k] = (t[0] * t[0] + t[1] * t[1] + t[2] * t[2]).sqrt();
        }
    }
}

struct SpreadValues<'a> {
    sources: &'a [Source<'a>],
    field: &'a mut Field,
}

impl pulp::NullaryFnOnce for SpreadValues<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for source in self.sources {
            for (f, k) in self.field.f.lanes_mut().iter_mut().zip(source.row) {
                *f += *k * Lane::splat(source.a);
            }
        }
    }
}

#[inline(always)]
fn splat(v: &Vector3) -> [Lane; 3] {
    [Lane::splat(v.x), Lane::splat(v.y), Lane::splat(v.z)]
}

#[inline(always)]
fn dot(v: &[Lane; 3], w: &[Lane; 3]) -> Lane {
    v[0] * w[0] + v[1] * w[1] + v[2] * w[2]
}

/// [`Kernel::influence`] at many places.
#[inline(always)]
fn influence(
    kernel: &Kernel,
    source: &Source<'_>,
    reduced: Lane,
    to: &[Lane; 3],
) -> (Lane, [Lane; 3]) {
    let a = Lane::splat(source.a);
    match *kernel {
        Kernel::Linear => {
            let w = splat(&(source.x * source.a + source.s));
            (dot(&w, to), w)
        }
        Kernel::Gaussian { gamma } => {
            let (from, s) = (splat(&source.x), splat(&source.s));
            let k = Lane::splat(1.0) + reduced;
            let d = [from[0] - to[0], from[1] - to[1], from[2] - to[2]];
            let pull = Lane::splat(-2.0 * gamma) * dot(&s, &d);
            let (along, scale) = (a + pull, Lane::splat(2.0 * gamma) * k);
            let mut gradient = [Lane::ZERO; 3];
            for axis in 0..3 {
                gradient[axis] = (d[axis] * along + s[axis]) * scale;
            }
            (a * reduced + k * pull, gradient)
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use cloudtouch_geom::{Covariance, Point3, UncertainPoint};

    use super::*;
    use crate::problem::sample::{Class, Sample};

    proptest! {
        #[test]
        fn what_is_carried_is_what_the_kernel_says_of_each_point(
            places in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 2..20),
            (a, s) in (-2.0..2.0_f64, prop::array::uniform3(-1.0..1.0_f64)),
            gamma in prop::option::of(0.1..30.0_f64),
        ) {
            let kernel = gamma.map_or(Kernel::Linear, |gamma| Kernel::Gaussian { gamma });
            let sample = |(k, p): (usize, &[f64; 3])| Sample {
                point: UncertainPoint {
                    mean: Point3::from(*p),
                    covariance: Covariance::diagonal([0.1, 0.2, 0.01 * k as f64]),
                },
                class: if k % 2 == 0 { Class::A } else { Class::B },
                radius: 1.5,
                penalty: 1.0,
            };
            let samples: Vec<Sample> = places.iter().enumerate().map(sample).collect();
            let problem = Problem::new(&samples, kernel).unwrap();
            let (x, s) = (problem.points[0].x, Vector3::from(s));
            let mut row = Lanes::default();
            row.reset(problem.len());
            kernel.reduced_row(&x, &problem.places, row.lanes_mut());
            let [mut all, mut values] = [Field::default(), Field::default()];
            for (field, with_gradients, s) in [(&mut all, true, s), (&mut values, false, Vector3::zeros())] {
                field.reset(problem.len());
                field.add(&problem, &[Source { x, row: row.lanes(), a, s }], with_gradients);
            }
            // Of the size of the terms, which may cancel.
            let tolerance = 1e-15 * (10.0 + gamma.unwrap_or(1.0)).powi(2);
            for (i, point) in problem.points.iter().enumerate() {
                let reduced = kernel.reduced(&x, &point.x);
                let (f, g) = kernel.influence(&x, &point.x, reduced, a, &s);
                let scaled = point.factor * g;
                prop_assert!((all.f.at(i) - f).abs() <= tolerance);
                prop_assert!((all.gradient_at(i) - g).norm() <= tolerance);
                prop_assert!((all.scaled_at(i) - scaled).norm() <= tolerance);
                prop_assert!((all.norm.at(i) - scaled.norm()).abs() <= tolerance);
                prop_assert!((values.f.at(i) - a * reduced).abs() <= tolerance);
            }
        }
    }
}
