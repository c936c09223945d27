//! From spots to what is reported: contacts merged to patches, and the clearance.

use super::parting::Partings;
use super::spots::{Spot, Spots};
use crate::CONTACT_FLOOR;
use crate::classifier::Clock;
use crate::report::{Clearance, Contact};
use crate::search::may_be_within;

/// A distance is clearly less than another that is so many standard deviations more.
const CLEARLY: f64 = 2.0;

/// Contact patches, likeliest first: spots within a spacing of a likelier one belong to its patch.
/// None is more probable than the collision is.
pub(in crate::query) fn contacts(spots: &Spots<'_>, collision: f64, most: usize) -> Vec<Contact> {
    let mut patches: Vec<(Spot, usize)> = Vec::new();
    for spot in spots.sorted.iter().filter(|spot| spot.probability.min(collision) >= CONTACT_FLOOR)
    {
        let is_near = |(of, _): &&mut (Spot, usize)| {
            (of.place - spot.place).norm() <= of.spacing.max(spot.spacing)
        };
        let is_full = patches.len() >= most;
        match patches.iter_mut().find(is_near) {
            Some((_, count)) => *count += 1,
            None if is_full => {}
            None => patches.push((*spot, 1)),
        }
    }
    let mut partings = Partings::default();
    let contact = |(spot, count): &(Spot, usize)| Contact {
        point: spot.place,
        normal_a_to_b: partings.at(spot, spots),
        probability: spot.probability.min(collision),
        clearance_m: spot.gap,
        // A patch is a spacing wide on either side, however many pieces met there.
        area_m2: Some(spot.spacing * spot.spacing * (*count).min(4) as f64),
    };
    patches.iter().map(contact).collect()
}

/// The place that tells the distance of the two surfaces. Where a collision is likelier than not, that of the likeliest
/// spot, or of the deepest that is about as likely: as much of an overlap as was seen. Else that of the
/// two pieces likeliest to meet: what seems to cross there most probably does not.
pub(in crate::query) fn nearest<'s>(spots: &'s Spots<'_>, collision: f64) -> Option<&'s Spot> {
    let sorted = &spots.sorted;
    let is_likely = collision >= 0.5;
    let likeliest = sorted.iter().find(|spot| is_likely || !spot.is_bound)?;
    let deepest = sorted
        .iter()
        .filter(|spot| spot.gap < 0.0 && spot.probability >= 0.9 * likeliest.probability)
        .min_by(|p, q| p.gap.total_cmp(&q.gap));
    Some(deepest.filter(|_| is_likely).unwrap_or(likeliest))
}

impl Spots<'_> {
    /// Whether the surfaces are nearer elsewhere than a place tells where no pieces face each other: those
    /// likeliest to meet are known worst, which need not be the nearest.
    pub(in crate::query) fn are_nearer_than(&self, spot: &Spot, clock: &Clock) -> bool {
        let least = spot.gap - CLEARLY * spot.std;
        let is_one = || may_be_within(self.bodies, &self.pose, least, clock);
        spot.is_beside && least > 0.0 && is_one().unwrap_or(true)
    }
}

/// The distance of the two surfaces there.
pub(in crate::query) fn clearance(spot: &Spot) -> Clearance {
    Clearance { mean: spot.gap, std: spot.std, is_bound: spot.is_bound }
}
