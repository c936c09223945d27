//! What a query has gathered so far.

use cloudtouch_geom::Point3;

use crate::POINT_FLOOR;
use crate::report::{Clearance, Contact, PointProbabilities};
use crate::stats::Stats;

use super::point::{PointProbability, Side};

/// Everything the parts of a query add to, and the report is made from.
#[derive(Debug, Default)]
pub(crate) struct Evidence {
    points: Vec<PointProbability>,
    contacts: Vec<Contact>,
    clearance: Option<(f64, Clearance)>,
    /// Largest probability of any point so far.
    largest: f64,
    /// No point of what was culled or left out is more probable than this.
    bound_of_rest: f64,
    pub stats: Stats,
}

impl Evidence {
    pub(crate) fn add_point(&mut self, point: PointProbability) {
        self.largest = self.largest.max(point.probability);
        if point.probability >= POINT_FLOOR {
            self.points.push(point);
        } else {
            self.widen(point.probability);
        }
    }

    /// Notes that two exact surfaces cross.
    pub(crate) fn add_certain_collision(&mut self) {
        self.add_point(PointProbability {
            side: Side::A,
            index: None,
            position: Point3::origin(),
            probability: 1.0,
            spacing: 0.0,
        });
    }

    pub(crate) fn add_contact(&mut self, contact: Contact) {
        self.contacts.push(contact);
    }

    /// Notes the gap at a place of this probability; the most probable place counts, and among
    /// equally probable ones the narrowest gap.
    pub(crate) fn add_clearance(&mut self, probability: f64, clearance: Clearance) {
        // Below the floor all places are equally out of the question: the narrowest gap counts.
        let probability = probability.max(POINT_FLOOR);
        let wins = self.clearance.is_none_or(|(most, known)| {
            probability > most || (probability == most && clearance.mean < known.mean)
        });
        if wins {
            self.clearance = Some((probability, clearance));
        }
    }

    /// Notes that points which were not looked at may be this probable, and no more; of what is no number nothing
    /// is known.
    pub(crate) fn widen(&mut self, bound: f64) {
        self.bound_of_rest = self.bound_of_rest.max(if bound.is_nan() { 1.0 } else { bound });
    }

    pub(crate) fn largest(&self) -> f64 {
        self.largest
    }

    pub(crate) fn bound_of_rest(&self) -> f64 {
        self.bound_of_rest
    }

    /// The gap at the most probable place; `None` when a place that was left out may be closer.
    /// In a collision above `accept` the search may have ended at the first certain place.
    pub(crate) fn clearance(&self, accept: f64) -> Option<Clearance> {
        let (probability, clearance) = self.clearance?;
        let decides = probability > POINT_FLOOR && probability >= self.bound_of_rest;
        (probability > accept || decides).then_some(clearance)
    }

    /// One entry per point, its largest probability: a point may stand in several leaf pairs.
    pub(crate) fn merge_points(&mut self) -> &[PointProbability] {
        let place = |p: &PointProbability| (p.side, p.index);
        self.points.sort_by(|p, q| {
            place(p)
                .cmp(&place(q))
                .then_with(|| {
                    let [p, q] = [p, q].map(|p| p.position);
                    p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)).then(p.z.total_cmp(&q.z))
                })
                .then(q.probability.total_cmp(&p.probability))
        });
        self.points.dedup_by(|later, first| {
            place(later) == place(first)
                && (later.index.is_some() || later.position == first.position)
        });
        &self.points
    }

    /// Probabilities by point, in index order; call after [`Self::merge_points`].
    pub(crate) fn point_probabilities(&self) -> PointProbabilities {
        let of = |side: Side| {
            self.points
                .iter()
                .filter(|p| p.side == side)
                .filter_map(|p| Some((p.index? as usize, p.probability)))
                .collect()
        };
        PointProbabilities { a: of(Side::A), b: of(Side::B) }
    }

    /// The most probable contacts, no two within a hundredth of the spread of all of them.
    pub(crate) fn top_contacts(&mut self, count: usize) -> Vec<Contact> {
        self.contacts.sort_by(|p, q| {
            q.probability
                .total_cmp(&p.probability)
                .then(p.clearance_m.total_cmp(&q.clearance_m))
                .then(p.point.x.total_cmp(&q.point.x))
                .then(p.point.y.total_cmp(&q.point.y))
                .then(p.point.z.total_cmp(&q.point.z))
        });
        let spread = self
            .contacts
            .iter()
            .map(|c| (c.point - self.contacts[0].point).norm())
            .fold(0.0, f64::max);
        let mut chosen: Vec<Contact> = Vec::new();
        for contact in &self.contacts {
            if chosen.len() == count {
                break;
            }
            if chosen.iter().all(|c| (c.point - contact.point).norm() > 0.01 * spread) {
                chosen.push(*contact);
            }
        }
        chosen
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// It was left out of every maximum, and what was left read free.
    #[test]
    fn a_point_of_no_known_probability_may_be_of_any() {
        let mut evidence = Evidence::default();
        evidence.add_point(PointProbability {
            side: Side::A,
            index: Some(0),
            position: Point3::origin(),
            probability: f64::NAN,
            spacing: 0.0,
        });
        assert_eq!(evidence.bound_of_rest(), 1.0);
    }
}
