//! The two pieces of surface of two leaves with the least deviations between them.

use cloudtouch_geom::{Point3, UncertainPoint, Vector3};
use cloudtouch_noise::Scratch;

use crate::cloud::Surfel;
use crate::search::compare::facet::{Facet, Whitening};
use crate::search::compare::meeting::squared_deviations;
use crate::search::visit::ends::ROUNDING;
use crate::search::visit::leaf::{ExactLeaf, Leaf, NoisyLeaf};

/// The two pieces of two leaves with the least deviations between them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Nearest {
    pub squared: f64,
    /// The pieces: where on a triangle is part of what is found.
    pub a: UncertainPoint,
    pub b: UncertainPoint,
    /// Unit normals of the surface there, where known; of a triangle by the turn of its corners.
    pub normals: [Option<Vector3>; 2],
    /// Which they are: of the points of a cloud, or of the triangles of a mesh.
    pub between: [u32; 2],
    /// The larger of their spacings, m; a mesh has none.
    pub spacing: f64,
}

impl Nearest {
    fn swapped(self) -> Self {
        let ([a, b], [of_a, of_b]) = (self.between, self.normals);
        Self { a: self.b, b: self.a, normals: [of_b, of_a], between: [b, a], ..self }
    }
}

/// `None` where all have so many deviations or more. Notes for every noisy piece what is its least,
/// where that is less.
pub(in crate::search) fn nearest_pieces(
    a: &mut Leaf<'_>,
    b: &mut Leaf<'_>,
    within: f64,
    scratch: &mut [Scratch; 2],
) -> Option<Nearest> {
    let within = within * within;
    let [of_a, of_b] = scratch;
    match (a, b) {
        (Leaf::Noisy(a), Leaf::Noisy(b)) => {
            end_near_noisy(a, b, within, [of_a, of_b]);
            between_noisy(a, b, within)
        }
        (Leaf::Noisy(a), Leaf::Exact(b)) => to_exact(a, b, within, of_a),
        (Leaf::Exact(a), Leaf::Noisy(b)) => to_exact(b, a, within, of_b).map(Nearest::swapped),
        // Two meshes are tested exactly and never come here.
        (Leaf::Exact(_), Leaf::Exact(_)) => None,
    }
}

/// Lets those pieces of two leaves end that are near some of the other.
fn end_near_noisy(
    a: &mut NoisyLeaf<'_>,
    b: &mut NoisyLeaf<'_>,
    within: f64,
    [of_a, of_b]: [&mut Scratch; 2],
) {
    let are_near = |(on_a, least_of_a): (&Surfel, f64), (on_b, least_of_b): (&Surfel, f64)| {
        let limit = least_of_a.max(least_of_b).min(within) * (1.0 + ROUNDING);
        squared_deviations(on_a, on_b, limit).is_some()
    };
    let is_near_b = |on_a: &Surfel, least: f64| {
        let mut of_b = b.surfels.iter().zip(b.squared.iter().copied());
        let reach = (within * (on_a.most_variance + b.ball.variance)).sqrt();
        b.ball.is_within(&on_a.point.mean, reach) && of_b.any(|on_b| are_near((on_a, least), on_b))
    };
    a.end_near(is_near_b, of_a);
    let is_near_a = |on_b: &Surfel, least: f64| {
        let mut of_a = a.surfels.iter().zip(a.squared.iter().copied());
        let reach = (within * (on_b.most_variance + a.ball.variance)).sqrt();
        a.ball.is_within(&on_b.point.mean, reach) && of_a.any(|on_a| are_near(on_a, (on_b, least)))
    };
    b.end_near(is_near_a, of_b);
}

fn between_noisy(a: &mut NoisyLeaf<'_>, b: &mut NoisyLeaf<'_>, within: f64) -> Option<Nearest> {
    let mut least = within;
    let mut nearest = None;
    let mut most_of_b = b.squared.iter().copied().fold(0.0, f64::max);
    for (on_a, least_of_a) in a.surfels.iter().zip(&mut a.squared) {
        let limit = least_of_a.max(most_of_b).min(within);
        let reach = (limit * (on_a.most_variance + b.ball.variance)).sqrt();
        if !b.ball.is_within(&on_a.point.mean, reach) {
            continue;
        }
        for (on_b, least_of_b) in b.surfels.iter().zip(&mut b.squared) {
            let limit = least_of_b.max(*least_of_a).min(within);
            let Some(squared) = squared_deviations(on_a, on_b, limit) else { continue };
            *least_of_a = least_of_a.min(squared);
            *least_of_b = least_of_b.min(squared);
            if squared < least {
                least = squared;
                nearest = Some(Nearest {
                    squared,
                    a: on_a.point,
                    b: on_b.point,
                    normals: [on_a.normal, on_b.normal],
                    between: [on_a.index, on_b.index],
                    spacing: on_a.spacing.max(on_b.spacing),
                });
            }
        }
        most_of_b = b.squared.iter().copied().fold(0.0, f64::max);
    }
    nearest
}

/// From the pieces of a cloud to those of a mesh.
fn to_exact(
    noisy: &mut NoisyLeaf<'_>,
    exact: &ExactLeaf,
    within: f64,
    scratch: &mut Scratch,
) -> Option<Nearest> {
    let is_near = |surfel: &Surfel, least: f64| {
        let limit = least.min(within) * (1.0 + ROUNDING);
        let whitening = Whitening::of(surfel);
        let near = |facet: &Facet| facet.squared_deviations(surfel, &whitening, limit).is_some();
        let reach = (limit * surfel.most_variance).sqrt();
        exact.ball.is_within(&surfel.point.mean, reach) && exact.facets.iter().any(near)
    };
    noisy.end_near(is_near, scratch);
    let mut least = within;
    let mut nearest = None;
    let (surfels, whitenings, squared) = noisy.whitened();
    for ((surfel, whitening), least_of_it) in surfels.iter().zip(whitenings).zip(squared) {
        let limit = least_of_it.min(within);
        let reach = (limit * surfel.most_variance).sqrt();
        if !exact.ball.is_within(&surfel.point.mean, reach) {
            continue;
        }
        for facet in exact.facets.iter() {
            let found = facet.squared_deviations(surfel, whitening, least_of_it.min(within));
            let Some((squared, way)) = found else { continue };
            *least_of_it = squared;
            if squared < least {
                least = squared;
                let on_mesh: Point3 = surfel.point.mean + way;
                nearest = Some(Nearest {
                    squared,
                    a: surfel.point,
                    b: UncertainPoint::exact(on_mesh),
                    normals: [surfel.normal, facet.normal],
                    between: [surfel.index, facet.triangle],
                    spacing: surfel.spacing,
                });
            }
        }
    }
    nearest
}
