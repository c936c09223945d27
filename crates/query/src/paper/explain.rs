//! A classifier as it was trained, for who wants to look inside (eq. 10 to 16; fig. 2).

use cloudtouch_geom::{Point3, Vector3};
use cloudtouch_svm::Class;
use serde::Serialize;

use crate::classifier::{PairAnswer, PairPoint, PairPoints, Surface, Trained};

/// The classifier of one leaf pair: f(x) = 0 separates its points, f is positive on the side of A.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LeafClassifier {
    /// b (eq. 15), for a kernel less its constant, about the middle of the leaf pair.
    pub bias: f64,
    /// The biases, lowest and highest, that are as good.
    pub bias_interval: [f64; 2],
    /// Value of the primal (eq. 10) and of the dual (eq. 13).
    pub objective: [f64; 2],
    /// Points of A, then those of B.
    pub points: Vec<ClassifiedPoint>,
    #[serde(skip)]
    surface: Surface,
    /// What was subtracted from the coordinates of A's file, m.
    #[serde(skip)]
    origin: Vector3,
}

/// What a classifier says of one of its points.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ClassifiedPoint {
    /// c: +1 for a point of A, −1 for one of B.
    pub class: f64,
    /// Index in the prepared cloud; `None` for a point of a mesh.
    pub index: Option<u32>,
    /// Where it is, in the frame of A, m.
    pub position: [f64; 3],
    /// f there (eq. 14).
    pub f: f64,
    /// |S∇f|: the standard deviation of f over its ellipsoid.
    pub deviation: f64,
    /// ξ: by how much its ellipsoid misses the margin (eq. 10); 0 when it does not.
    pub xi: f64,
    /// α, from 0 to C (eq. 13).
    pub alpha: f64,
    /// v, at most rα long, along the axes of A (eq. 13).
    pub v: [f64; 3],
    /// P: the probability that it is on the wrong side (eq. 16).
    pub probability: f64,
}

impl LeafClassifier {
    /// `None` where nothing was trained, or no surface came of it. `radius` is r of the points that
    /// bring none.
    pub(super) fn of(
        points: &PairPoints,
        trained: &Trained,
        radius: f64,
        origin: Vector3,
    ) -> Option<Self> {
        let (Trained { answer, solution: Some(solution) }, both) = (trained, both(points)) else {
            return None;
        };
        let PairAnswer::Separated { surface, a, b } = answer else { return None };
        let told = |(i, ((class, point), &probability)): (usize, ((Class, &PairPoint), &f64))| {
            let (f, gradient) = surface.value_and_gradient(&point.point.mean);
            let deviation = point.point.covariance.std_along(&gradient);
            let margin = class.sign() * f - point.radius.unwrap_or(radius) * deviation;
            ClassifiedPoint {
                class: class.sign(),
                index: point.index,
                position: (point.point.mean + origin).coords.into(),
                f,
                deviation,
                xi: (1.0 - margin).max(0.0),
                alpha: solution.alpha[i],
                v: solution.v[i].into(),
                probability,
            }
        };
        Some(Self {
            bias: solution.bias,
            bias_interval: solution.bias_interval,
            objective: [solution.primal, solution.dual],
            points: both.zip(a.iter().chain(b)).enumerate().map(told).collect(),
            surface: surface.clone(),
            origin,
        })
    }

    /// f and its gradient per metre at a point in the frame of A (eq. 14).
    pub fn value_and_gradient(&self, point: &Point3) -> (f64, Vector3) {
        self.surface.value_and_gradient(&(point - self.origin))
    }
}

fn both(points: &PairPoints) -> impl Iterator<Item = (Class, &PairPoint)> {
    let of = |class| move |point| (class, point);
    points.a.iter().map(of(Class::A)).chain(points.b.iter().map(of(Class::B)))
}
