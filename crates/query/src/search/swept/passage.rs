//! How clearly a piece of one surface could pass through a piece of the other while one of them
//! drifts: a bound on the crossings of `search/cross/crossing.rs` at any pose on the way.

use cloudtouch_geom::{Point3, Vector3};

use crate::cloud::{DISC_SPACINGS, Edge, Onward, Surfel};

use super::course::Course;
use super::drifts::Drifts;
use super::leaf::EdgeTrack;
use super::plane::{Heights, Known, Plane};
use super::track::{Approach, Direction, Drifting, SweptFacet, Track, piece_keeps_off};
use crate::search::compare::facet::Facet;
use crate::search::cross::crossing::weight_at;
use crate::search::cross::past::Past;
use crate::search::cross::side::{CLEAREST, known_past_to, known_to};
use crate::search::cross::through_mesh::Outline;
use crate::search::visit::around::OfMesh;

/// A passage that may be.
#[derive(Debug, Clone, Copy)]
pub(super) struct Passage {
    /// No clearer and with no more weight than this.
    pub clear: f64,
    pub weight: f64,
    /// Distance between samples there, m.
    pub spacing: f64,
}

/// An edge of A, or one of B, which drifts.
#[derive(Debug, Clone, Copy)]
pub(super) struct Adrift<'a> {
    edge: &'a Edge,
    is_a: bool,
    track: &'a EdgeTrack,
    past: &'a Past<'a>,
}

impl<'a> Adrift<'a> {
    /// With where the surface goes on past its ends.
    pub(super) fn new(
        is_a: bool,
        edge: &'a Edge,
        track: &'a EdgeTrack,
        past: &'a Past<'a>,
    ) -> Self {
        Self { edge, is_a, track, past }
    }

    /// Where it passes a plane, its ends known so well.
    fn crossed(&self, plane: &Plane<'_>, known: [f64; 2]) -> Option<Crossed> {
        let [from, to] = &self.track.ends;
        let heights = plane.heights([from, to], 2.0 * self.edge.half_length);
        let crossed = Crossed::of(&heights, known)?;
        // The leaf of the end that is nearer to the plane counts it: either, where both may be.
        let counts = |k: usize| crossed.nearer[k] && self.edge.own[k].is_some();
        (counts(0) || counts(1)).then_some(crossed)
    }

    /// The ends of the part of the edge where it may pass.
    fn part(&self, crossed: &Crossed) -> [Point3; 2] {
        let [from, to] = self.edge.ends;
        crossed.shares.map(|share| from + (to - from) * share)
    }

    /// Of the disc about a sample of the other body, which it is within reach of between two times; `drift`
    /// is that of the edge.
    pub(super) fn through_disc(
        &self,
        disc: &Surfel,
        times: [f64; 2],
        drift: &Course,
    ) -> Option<Passage> {
        let (normal, middle) = (disc.normal?, disc.point.mean);
        let across = disc.across;
        let known = self.edge.across.map(|own| known_to((own + across).sqrt(), disc.spacing));
        let plane = Plane::new(normal, &middle, times, drift);
        let crossed = self.crossed(&plane, known)?;
        let part = self.part(&crossed);
        let off = (piece_keeps_off(&part, &middle, drift) / disc.spacing).max(0.0);
        if off > DISC_SPACINGS {
            return None;
        }
        let known_past =
            |onward: &Onward| known_past_to((onward.across + across).sqrt(), disc.spacing);
        let clear = self.clear_past(crossed.clear, (&plane, drift), known, known_past);
        Some(Passage { clear, weight: weight_at(off), spacing: disc.spacing })
    }

    /// Of a triangle of the other body.
    pub(super) fn through_facet(
        &self,
        SweptFacet { facet, corners }: SweptFacet<'_>,
        drifts: &Drifts,
    ) -> Option<Passage> {
        let (normal, drift) = (facet.normal?, &drifts.of_b);
        let spacing = 2.0 * self.edge.half_length;
        let known = self.edge.across.map(|own| known_to(own.sqrt(), spacing));
        let of_edge = drifts.of(self.is_a);
        let plane = Plane::new(normal, &facet.corners[0], [-1.0, 1.0], of_edge);
        let crossed = self.crossed(&plane, known)?;
        let [from, to] = self.part(&crossed);
        let (middle, half) = (nalgebra::center(&from, &to), 0.5 * (to - from).norm());
        let track = Track::of(&middle, drift);
        let drifting = if self.is_a { Drifting::Corners(corners) } else { Drifting::Place(&track) };
        let off = Approach { place: &middle, facet, drifting, drift }.keep_off();
        (off <= half * (1.0 + ROUNDING) + ROUNDING * spacing).then(|| {
            let known_past = |onward: &Onward| known_to(onward.across.sqrt(), spacing);
            let clear = self.clear_past(crossed.clear, (&plane, of_edge), known, known_past);
            Passage { clear, weight: 1.0, spacing }
        })
    }

    /// How clear the passage of a plane is at most, given that by its ends alone, and how well they and what
    /// lies past them are known; `drift` is that of the edge.
    fn clear_past(
        &self,
        by_ends: f64,
        (plane, drift): (&Plane<'_>, &Course),
        known: [f64; 2],
        known_past: impl Fn(&Onward) -> f64,
    ) -> f64 {
        if by_ends >= CLEAREST {
            return by_ends;
        }
        let ends = [0, 1].map(|k| Known { track: self.track.ends[k], to: known[k] });
        let pasts = [0, 1].map(|k| {
            let onward = self.past.of(k);
            Known { track: Track::of(&onward.place, drift), to: known_past(&onward) }
        });
        let pairs = [[&pasts[0], &ends[1]], [&ends[0], &pasts[1]], [&pasts[0], &pasts[1]]];
        pairs.into_iter().map(|pair| plane.clear(pair)).fold(by_ends, f64::max).min(CLEAREST)
    }
}

const ROUNDING: f64 = 1e-9;

/// How an edge may pass a plane.
#[derive(Debug, Clone, Copy)]
struct Crossed {
    /// Deviations of its less clear end, at most.
    clear: f64,
    /// Between which shares of its length it passes.
    shares: [f64; 2],
    /// Whether either end may be the nearer one.
    nearer: [bool; 2],
}

impl Crossed {
    /// Of ends at these heights, known so well. `None` where both keep on one side.
    fn of(heights: &Heights, known: [f64; 2]) -> Option<Self> {
        let Heights { at, changes, apart } = *heights;
        let from_above = Self::one_way(at, changes, apart, known);
        let from_below = Self::one_way(at.map(|h| -h), changes, [-apart[1], -apart[0]], known);
        match (from_above, from_below) {
            (Some(p), Some(q)) => Some(Self {
                clear: p.clear.max(q.clear),
                shares: [p.shares[0].min(q.shares[0]), p.shares[1].max(q.shares[1])],
                nearer: [p.nearer[0] || q.nearer[0], p.nearer[1] || q.nearer[1]],
            }),
            (one, other) => one.or(other),
        }
    }

    /// With the first end above the plane and the second below it.
    fn one_way(
        heights: [f64; 2],
        changes: [f64; 2],
        apart: [f64; 2],
        known: [f64; 2],
    ) -> Option<Self> {
        let (above, below) = (heights[0], -heights[1]);
        let least = [(above - changes[0]).max(0.0), (below - changes[1]).max(0.0)];
        let most_apart = apart[1].min(above + changes[0] + below + changes[1]);
        let most = [
            (above + changes[0]).min(most_apart - least[1]),
            (below + changes[1]).min(most_apart - least[0]),
        ];
        if most[0] <= 0.0 || most[1] <= 0.0 {
            return None;
        }
        let clear = (most[0] / known[0]).min(most[1] / known[1]).min(CLEAREST);
        let least_apart = apart[0].max(least[0] + least[1]);
        let to = most[0] / least_apart.max(most[0]);
        Some(Self {
            clear: clear.min(most_apart / (known[0] + known[1])),
            shares: [(least[0] / most_apart).min(to), to.min(most[0] / (most[0] + least[1]))],
            nearer: [least[0] <= most[1], least[1] <= most[0]],
        })
    }
}

/// How near to the middle of a disc some facets may pass it, m; `None` where none can.
pub(super) fn may_pierce(
    is_a: bool,
    (disc, track): (&Surfel, &Track),
    normal: &Vector3,
    facets: &[SweptFacet<'_>],
    drifts: &Drifts,
) -> Option<f64> {
    let middle = disc.point.mean;
    let direction = Direction::new(*normal, drifts.of(!is_a));
    let passes = facets.iter().filter(|swept| {
        let heights = swept.corners.map(|corner| {
            let (at, by) = (normal.dot(&(corner.place - middle)), corner.along(&direction));
            (at - by, at + by)
        });
        heights.iter().any(|(low, _)| *low <= 0.0) && heights.iter().any(|(_, high)| *high >= 0.0)
    });
    let off = passes.map(|SweptFacet { facet, corners }| {
        let drifting = if is_a { Drifting::Corners(corners) } else { Drifting::Place(track) };
        Approach { place: &middle, facet, drifting, drift: &drifts.of_b }.keep_off()
    });
    let off = off.fold(f64::INFINITY, f64::min);
    (off <= DISC_SPACINGS * disc.spacing * (1.0 + ROUNDING)).then_some(off)
}

/// What a mesh may do to the disc about a sample, which drifts so, that it may pass so near to its middle;
/// `around` gives all its triangles within a distance of a place.
pub(super) fn mesh_through_disc(
    disc: &Surfel,
    (normal, off): (Vector3, f64),
    around: &mut OfMesh<'_>,
    drift: &Course,
) -> Passage {
    let (middle, radius) = (disc.point.mean, DISC_SPACINGS * disc.spacing);
    let by = drift.in_any_direction(&middle);
    let std = known_to(disc.across.sqrt(), disc.spacing);
    let passage = |clear: f64| Passage {
        clear: (clear / std).min(CLEAREST),
        weight: weight_at(off / disc.spacing),
        spacing: disc.spacing,
    };
    if by > radius {
        // As clear as a disc is wide: with so much room there is no telling.
        return passage(radius);
    }
    let near: Vec<&Facet> = around.near(&middle, std::f64::consts::SQRT_2 * radius + by).collect();
    let corners = near.iter().flat_map(|facet| &facet.corners);
    let farthest = corners.map(|corner| (corner - middle).norm()).fold(0.0, f64::max);
    let room = by + drift.turn() * farthest;
    let heights = Outline::new(middle, normal, radius + room).heights(near.into_iter());
    let [low, high] = heights.unwrap_or([0.0; 2]);
    passage((high + room).min(room - low).clamp(0.0, radius))
}
