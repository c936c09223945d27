//! How many deviations two bodies are from being within a margin of each other.

use cloudtouch_bvh::{NodeId, Sought, SurfaceFlow, visit_surfaces};
use cloudtouch_geom::{Motion, Pose};

use crate::body::BodyRef;
use crate::classifier::Clock;
use crate::cloud::Surfel;
use crate::error::QueryError;
use crate::judge::MOST_DEVIATIONS;
use crate::stats::Stats;

use crate::search::compare::meeting::{deviations_beyond, may_be_beyond, may_have_fewer};
use crate::search::visit::leaf::{ExactLeaf, Leaf, NoisyLeaf};
use crate::search::visit::leaves::Leaves;
use crate::search::visit::side::Side;
use crate::search::visit::trees::Trees;
use crate::search::visit::unseen::{Parted, told_apart};

/// What a search beyond a margin found.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Beyond {
    /// The least deviations between two pieces of surface that are more than the margin apart;
    /// negative, down to −[`MOST_DEVIATIONS`], where two are clearly within it.
    pub deviations: f64,
    /// The leaves of A and B that have so few; none where no two were looked at that have fewer than was asked
    /// about.
    pub leaves: Option<[NodeId; 2]>,
    /// Whether what was left out cannot have fewer.
    pub is_complete: bool,
}

/// Deviations that a search tells apart: more than `most` are none, and fewer than `enough` no better.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Span {
    pub most: f64,
    pub enough: f64,
}

/// Looks for the two pieces that are most clearly within a margin (m) of each other, until the time is
/// over. It does not end when two are likely enough: a wider margin could then be found less likely.
pub(crate) fn least_beyond(
    bodies: (BodyRef<'_>, BodyRef<'_>),
    a_from_b: &Pose,
    margin: f64,
    clock: &Clock,
) -> Result<Beyond, QueryError> {
    let span = Span { most: MOST_DEVIATIONS, enough: -MOST_DEVIATIONS };
    least_within(bodies, a_from_b, margin, span, clock)
}

/// Whether two pieces are nearer to each other than a margin (m), as far as that is known: ends at the
/// first two, and where the time is over, which may have left some out.
pub(crate) fn may_be_within(
    bodies: (BodyRef<'_>, BodyRef<'_>),
    a_from_b: &Pose,
    margin: f64,
    clock: &Clock,
) -> Result<bool, QueryError> {
    let span = Span { most: 0.0, enough: -f64::MIN_POSITIVE };
    let found = least_within(bodies, a_from_b, margin, span, clock)?;
    Ok(found.deviations < 0.0 || !found.is_complete)
}

/// The least deviations beyond a margin of two pieces of two leaves alone; `most` where none has fewer.
pub(crate) fn least_of_leaves(
    (a, b): (BodyRef<'_>, BodyRef<'_>),
    a_from_b: &Pose,
    margin: f64,
    most: f64,
    [of_a, of_b]: [NodeId; 2],
) -> f64 {
    let mut stats = Stats::default();
    let mut sides = [Side::default(), Side::moved(Motion::from(a_from_b))];
    let [side_a, side_b] = &mut sides;
    let mut leaf_a = Leaf::load(a, of_a, side_a, &mut stats);
    let mut leaf_b = Leaf::load(b, of_b, side_b, &mut stats);
    least_of(&mut leaf_a, &mut leaf_b, margin, most, &mut sides).max(-MOST_DEVIATIONS)
}

/// The least deviations beyond a margin, within a span of them.
pub(crate) fn least_within<'a>(
    (a, b): (BodyRef<'a>, BodyRef<'a>),
    a_from_b: &Pose,
    margin: f64,
    Span { most, enough }: Span,
    clock: &Clock,
) -> Result<Beyond, QueryError> {
    let (mut least, mut nearest) = (most, None);
    // A margin is told without what it cost.
    let mut stats = Stats::default();
    let mut trees = Trees::of(a, b);
    // Of pairs whose boxes are within the margin no more is known than that: all are looked at.
    let reach = |least: f64| least.max(f64::MIN_POSITIVE);
    let sought = Sought { within: reach(most), margin, crossings: false, drift: None };
    let mut leaves: (Leaves<Leaf<'a>>, Leaves<Leaf<'a>>) = Default::default();
    let mut sides = [Side::default(), Side::moved(Motion::from(a_from_b))];
    let outcome = visit_surfaces(trees.both(), a_from_b, sought, |pair| {
        let is_apart = |parted: &Parted| parted.deviations_beyond(margin) >= reach(least);
        let (of_a, of_b) = (&mut leaves.0, &mut leaves.1);
        let load = |body, id, side: &mut Side| Leaf::load(body, id, side, &mut stats);
        let are_loose = trees.may_be_loose();
        if told_apart((a, b), &pair, are_loose, (of_a, of_b), &mut sides, load, is_apart).is_none()
        {
            let [side_a, side_b] = &mut sides;
            let leaf_a = of_a.get_or_load(pair.a, || Leaf::load(a, pair.a, side_a, &mut stats));
            let leaf_b = of_b.get_or_load(pair.b, || Leaf::load(b, pair.b, side_b, &mut stats));
            let of_pair = least_of(leaf_a, leaf_b, margin, least, &mut sides).max(-MOST_DEVIATIONS);
            if of_pair < least {
                (least, nearest) = (of_pair, Some([pair.a, pair.b]));
            }
        }
        if clock.is_over() || least <= enough {
            return SurfaceFlow::Stop;
        }
        trees.count_pair([leaves.0.len(), leaves.1.len()]);
        trees.flow(reach(least), &mut stats, || clock.is_over())
    })?;
    let is_complete = !outcome.stopped || least <= enough;
    Ok(Beyond { deviations: least, leaves: nearest, is_complete })
}

/// The least deviations beyond the margin of two pieces of two leaves; `most` where none has fewer.
fn least_of(
    a: &mut Leaf<'_>,
    b: &mut Leaf<'_>,
    margin: f64,
    most: f64,
    [of_a, of_b]: &mut [Side; 2],
) -> f64 {
    match (a, b) {
        (Leaf::Noisy(a), Leaf::Noisy(b)) => {
            let are_near = |on_a: &Surfel, on_b: &Surfel| may_be_beyond(on_a, on_b, margin, most);
            let is_near_b = |a: &NoisyLeaf<'_>, on_a: usize| {
                b.surfels.iter().any(|on_b| are_near(&a.surfels[on_a], on_b))
            };
            a.end_near(is_near_b, of_a);
            let is_near_a = |b: &NoisyLeaf<'_>, on_b: usize| {
                a.surfels.iter().any(|on_a| are_near(on_a, &b.surfels[on_b]))
            };
            b.end_near(is_near_a, of_b);
            between_noisy(a, b, margin, most)
        }
        (Leaf::Noisy(a), Leaf::Exact(b)) => to_exact(a, b, margin, most, of_a),
        (Leaf::Exact(a), Leaf::Noisy(b)) => to_exact(b, a, margin, most, of_b),
        // Two meshes are tested exactly and never come here.
        (Leaf::Exact(_), Leaf::Exact(_)) => most,
    }
}

fn between_noisy(a: &NoisyLeaf<'_>, b: &NoisyLeaf<'_>, margin: f64, most: f64) -> f64 {
    let mut least = most;
    for on_a in a.surfels.iter() {
        let reach = margin + least.max(0.0) * (on_a.most_variance + b.ball.variance).sqrt();
        if !b.ball.is_within(&on_a.point.mean, reach) {
            continue;
        }
        for on_b in b.surfels.iter() {
            least = deviations_beyond(on_a, on_b, margin, least).unwrap_or(least);
        }
    }
    least
}

fn to_exact(
    noisy: &mut NoisyLeaf<'_>,
    exact: &ExactLeaf,
    margin: f64,
    most: f64,
    side: &mut Side,
) -> f64 {
    let may_reach = |surfel: &Surfel, least: f64| {
        let reach = margin + least.max(0.0) * surfel.most_variance.sqrt();
        exact.ball.is_within(&surfel.point.mean, reach)
    };
    let is_near = |noisy: &NoisyLeaf<'_>, place: usize| {
        let surfel = &noisy.surfels[place];
        let covariance = surfel.point.covariance.matrix();
        let mut ways = exact.facets.iter().map(|facet| facet.way_from(&surfel.point.mean));
        may_reach(surfel, most) && ways.any(|way| may_have_fewer(&covariance, &way, margin, most))
    };
    noisy.end_near(is_near, side);
    let mut least = most;
    noisy.make_room();
    for (place, surfel) in noisy.surfels.iter().enumerate() {
        if surfel.may_end() || !may_reach(surfel, least) {
            continue;
        }
        let whitening = noisy.whitening(place);
        for facet in exact.facets.iter() {
            least = least.min(facet.deviations_beyond(surfel, whitening, margin));
        }
    }
    least
}
