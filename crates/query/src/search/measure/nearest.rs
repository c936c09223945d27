//! The two pieces of surface of two leaves with the least deviations between them.

use cloudtouch_geom::{Point3, UncertainPoint, Vector3};

use crate::cloud::{Ball, Surfel};
use crate::search::compare::facet::Facet;
use crate::search::compare::meeting::squared_deviations;
use crate::search::compare::whitening::Whitening;
use crate::search::visit::ends::ROUNDING;
use crate::search::visit::leaf::{ExactLeaf, Leaf, NoisyLeaf};
use crate::search::visit::side::Side;

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
    /// The larger of how much of their variances those about them are off by too, from 0 to 1.
    pub shared: f64,
}

impl Nearest {
    /// A piece, and a facet so many squared deviations and such a way (m) from it.
    pub(super) fn on_facet(surfel: &Surfel, facet: &Facet, (squared, way): (f64, Vector3)) -> Self {
        let on_mesh: Point3 = surfel.point.mean + way;
        Self {
            squared,
            a: surfel.point,
            b: UncertainPoint::exact(on_mesh),
            normals: [surfel.normal, facet.normal],
            between: [surfel.index, facet.triangle],
            spacing: surfel.spacing,
            shared: surfel.shared,
        }
    }

    pub(in crate::search) fn swapped(self) -> Self {
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
    sides: &mut [Side; 2],
) -> Option<Nearest> {
    let within = within * within;
    let [of_a, of_b] = sides;
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
    [of_a, of_b]: [&mut Side; 2],
) {
    let are_near = |(a, on_a): (&NoisyLeaf<'_>, usize), (b, on_b): (&NoisyLeaf<'_>, usize)| {
        let limit = a.squared[on_a].max(b.squared[on_b]).min(within) * (1.0 + ROUNDING);
        squared_deviations(&a.surfels[on_a], &b.surfels[on_b], limit).is_some()
    };
    let is_in_reach = |surfel: &Surfel, ball: &Ball| {
        let reach = (within * (surfel.most_variance + ball.variance)).sqrt();
        ball.is_within(&surfel.point.mean, reach)
    };
    let is_near_b = |a: &NoisyLeaf<'_>, on_a: usize| {
        is_in_reach(&a.surfels[on_a], &b.ball)
            && (0..b.surfels.len()).any(|on_b| are_near((a, on_a), (b, on_b)))
    };
    a.end_near(is_near_b, of_a);
    let is_near_a = |b: &NoisyLeaf<'_>, on_b: usize| {
        is_in_reach(&b.surfels[on_b], &a.ball)
            && (0..a.surfels.len()).any(|on_a| are_near((a, on_a), (b, on_b)))
    };
    b.end_near(is_near_a, of_b);
}

fn between_noisy(a: &mut NoisyLeaf<'_>, b: &mut NoisyLeaf<'_>, within: f64) -> Option<Nearest> {
    let mut least = within;
    let mut nearest = None;
    let mut most_of_b = b.squared.iter().copied().fold(0.0, f64::max);
    for (on_a, least_of_a) in a.surfels.iter().zip(&mut a.squared) {
        if on_a.may_end() {
            continue;
        }
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
                    shared: on_a.shared.max(on_b.shared),
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
    side: &mut Side,
) -> Option<Nearest> {
    noisy.make_room();
    let is_near = |noisy: &NoisyLeaf<'_>, place: usize| {
        let surfel = &noisy.surfels[place];
        let limit = noisy.squared[place].min(within) * (1.0 + ROUNDING);
        let reach = (limit * surfel.most_variance).sqrt();
        let mut facets = exact.facets.iter();
        let mut is_any_near = |whitening: &Whitening| {
            facets.any(|facet| facet.squared_deviations(surfel, whitening, limit).is_some())
        };
        exact.ball.is_within(&surfel.point.mean, reach) && is_any_near(noisy.whitening(place))
    };
    noisy.end_near(is_near, side);
    let mut least = within;
    let mut nearest = None;
    for place in 0..noisy.surfels.len() {
        let surfel = &noisy.surfels[place];
        let mut least_of_it = noisy.squared[place];
        let reach = (least_of_it.min(within) * surfel.most_variance).sqrt();
        if surfel.may_end() || !exact.ball.is_within(&surfel.point.mean, reach) {
            continue;
        }
        let whitening = noisy.whitening(place);
        for facet in exact.facets.iter() {
            // On an edge it is as near to both triangles: the one of another leaf counts whichever was first.
            let limit = (least_of_it * (1.0 + ROUNDING)).min(within);
            let found = facet.squared_deviations(surfel, whitening, limit);
            let Some((squared, way)) = found else { continue };
            least_of_it = least_of_it.min(squared);
            if squared < least {
                least = squared;
                nearest = Some(Nearest::on_facet(surfel, facet, (squared, way)));
            }
        }
        noisy.squared[place] = least_of_it;
    }
    nearest
}
