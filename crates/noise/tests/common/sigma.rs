//! How honest the stated standard deviations are: errors on known surfaces in units of them.

use cloudtouch_geom::Point3;
use cloudtouch_noise::Combination;

use super::{Surface, cuboid, isotropic, model, noisy, plane, refine_all, sphere};

/// Root mean squares of error over stated standard deviation that count as honest.
pub(crate) const HONEST: (f64, f64) = (0.8, 1.25);
/// Standard deviations of the noise, m.
pub(crate) const NOISES: [f64; 3] = [0.002, 0.01, 0.02];
/// Distances between samples, m.
pub(crate) const SPACINGS: [f64; 2] = [0.015, 0.035];
/// Clouds drawn of each surface.
const DRAWS: u64 = 6;

/// A surface that errors are measured on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Shape {
    /// A square of 60 cm.
    Plane,
    /// Edge lengths, m.
    Cuboid([f64; 3]),
    /// Radius, m.
    Sphere(f64),
}

/// What is measured, as tables call it.
pub(crate) const SHAPES: [(&str, Shape); 6] = [
    ("plane", Shape::Plane),
    ("box, 40 × 30 × 20 cm", Shape::Cuboid([0.4, 0.3, 0.2])),
    ("board, 30 mm", Shape::Cuboid([0.4, 0.3, 0.03])),
    ("board, 15 mm", Shape::Cuboid([0.4, 0.3, 0.015])),
    ("sphere, radius 20 cm", Shape::Sphere(0.2)),
    ("sphere, radius 10 cm", Shape::Sphere(0.1)),
];

/// One surface under one noise and spacing.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row {
    pub(crate) shape: &'static str,
    pub(crate) spacing: f64,
    pub(crate) noise: f64,
    /// More than a spacing from every edge; `None` where there are no such points.
    pub(crate) faces: Option<Spread>,
    /// Within a spacing of an edge.
    pub(crate) edges: Option<Spread>,
}

/// Errors along the true normal.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spread {
    /// Root mean square of error over stated standard deviation.
    pub(crate) standardised: f64,
    /// Root mean square error, m.
    #[allow(dead_code, reason = "for the page of the example")]
    pub(crate) error: f64,
}

/// Every shape, noise and spacing; deterministic.
pub(crate) fn rows() -> Vec<Row> {
    let mut rows = Vec::new();
    for (name, shape) in SHAPES {
        for spacing in SPACINGS {
            for noise in NOISES {
                rows.push(row(name, shape, spacing, noise));
            }
        }
    }
    rows
}

fn row(name: &'static str, shape: Shape, spacing: f64, noise: f64) -> Row {
    let (mut faces, mut edges) = (Vec::new(), Vec::new());
    for draw in 0..DRAWS {
        let stream = 1000 * (draw + 1);
        let surface = sample(shape, spacing, stream);
        let measured = noisy(&surface.points, noise, stream + 500);
        let sensor = isotropic(noise, &measured);
        let refined = refine_all(&model(Combination::SurfacePosterior), &measured, &sensor);
        for (i, refined) in refined.iter().enumerate() {
            let (point, normal) = (&surface.points[i], &surface.normals[i]);
            let error = (refined.point.mean - point).dot(normal);
            let one = (error, error / refined.point.covariance.std_along(normal));
            match to_edge(shape, point) {
                distance if distance > spacing => faces.push(one),
                // Beyond the rim of a plane there is nothing to be mistaken for it.
                _ if shape == Shape::Plane => {}
                _ => edges.push(one),
            }
        }
    }
    Row { shape: name, spacing, noise, faces: spread(&faces), edges: spread(&edges) }
}

fn sample(shape: Shape, spacing: f64, stream: u64) -> Surface {
    match shape {
        Shape::Plane => plane(0.6, spacing, stream),
        Shape::Cuboid(edges) => cuboid(edges, spacing, stream),
        Shape::Sphere(radius) => sphere(radius, spacing, stream),
    }
}

/// Distance of a point of the surface from the nearest edge, m.
fn to_edge(shape: Shape, point: &Point3) -> f64 {
    match shape {
        Shape::Plane => 0.3 - point.x.abs().max(point.y.abs()),
        Shape::Cuboid(edges) => {
            // On a face one of these is zero; the next larger one leads to the edge.
            let mut inward = [0, 1, 2].map(|a| 0.5 * edges[a] - point[a].abs());
            inward.sort_by(f64::total_cmp);
            inward[1]
        }
        Shape::Sphere(_) => f64::INFINITY,
    }
}

fn spread(found: &[(f64, f64)]) -> Option<Spread> {
    let mean = |value: fn(&(f64, f64)) -> f64| {
        (found.iter().map(|one| value(one).powi(2)).sum::<f64>() / found.len() as f64).sqrt()
    };
    // Fewer say nothing to a tenth.
    (found.len() >= 50)
        .then(|| Spread { standardised: mean(|one| one.1), error: mean(|one| one.0) })
}
