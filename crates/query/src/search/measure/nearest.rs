//! The two pieces of surface of two leaves with the least deviations between them.

use cloudtouch_geom::{Point3, UncertainPoint, Vector3};

use crate::search::compare::meeting::squared_deviations;
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
) -> Option<Nearest> {
    let within = within * within;
    match (a, b) {
        (Leaf::Noisy(a), Leaf::Noisy(b)) => between_noisy(a, b, within),
        (Leaf::Noisy(a), Leaf::Exact(b)) => to_exact(a, b, within),
        (Leaf::Exact(a), Leaf::Noisy(b)) => to_exact(b, a, within).map(Nearest::swapped),
        // Two meshes are tested exactly and never come here.
        (Leaf::Exact(_), Leaf::Exact(_)) => None,
    }
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
fn to_exact(noisy: &mut NoisyLeaf<'_>, exact: &ExactLeaf, within: f64) -> Option<Nearest> {
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
