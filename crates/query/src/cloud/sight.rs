//! What a cloud knows of places: whether its sensors saw them.

use cloudtouch_geom::Point3;

use super::prepared::Prepared;
use super::view::seen::Sight;
use super::view::{Hiding, Seeing, range};

/// What a cloud knows of places in its local frame.
pub(crate) struct Sights<'a> {
    prepared: &'a Prepared,
    images: Vec<Seeing<'a>>,
}

impl Sights<'_> {
    /// What its scans know of a place in a body of such a breadth, m: of depth images the one that knows most tells, and
    /// without any how far returns were kept.
    pub(crate) fn of(&self, place: &Point3, breadth: f64) -> Sight {
        let Prepared { scans, origin, .. } = self.prepared;
        best_of(&self.images, place, breadth)
            .unwrap_or_else(|| range::sight(&scans.ranges, &(place + origin)))
    }

    /// Whether all places no farther than a distance (m) from one were seen, for bodies of such a breadth, m, as an image
    /// soon tells of most; they may have been where this does not say so.
    pub(crate) fn are_all_seen(&self, place: &Point3, distance: f64, breadth: f64) -> bool {
        for image in self.images.iter().rev() {
            if image.sees_about(place, distance, breadth) {
                return true;
            }
            // What one that came later did not see may have come since.
            if image.is_later() {
                return false;
            }
        }
        false
    }
}

impl Prepared {
    /// What its scans know of places; `None` where nothing says what was not seen.
    pub(crate) fn sights(&self) -> Option<Sights<'_>> {
        let measured = (self.points(), self.sensor());
        let images: Vec<_> = self.views.iter().filter_map(|view| view.over(measured)).collect();
        let by_range = self.views.is_empty() && self.knows_unseen();
        (by_range || !images.is_empty()).then_some(Sights { prepared: self, images })
    }

    /// Whether one of its depth images looked past a place in a body of such a breadth, m. Returns that were kept up to
    /// some range say nothing of it.
    pub(crate) fn has_looked_past(&self, place: &Point3, breadth: f64) -> bool {
        let is_seen = |sights: Sights<'_>| best_of(&sights.images, place, breadth);
        self.sights().and_then(is_seen) == Some(Sight::Seen)
    }

    /// Of the surface of the robot in one of its images, or of a link, the share that the camera looked past, where that
    /// is more than of a robot that is there.
    pub(crate) fn robot_passed(&self) -> Option<f64> {
        let measured = (self.points(), self.sensor());
        let of_each = self.views.iter().filter_map(|view| view.robot_passed(measured));
        of_each.max_by(f64::total_cmp)
    }

    /// Whether anything was taken for the robot that may be of something beside it.
    pub(crate) fn was_more_taken(&self) -> bool {
        !self.scans.taken.is_empty()
    }

    /// Whether such a thing may be within a margin (m) of a place in the local frame.
    pub(crate) fn may_be_taken(&self, place: &Point3, margin: f64) -> bool {
        let place = place + self.origin;
        self.scans.taken.iter().any(|taken| taken.may_be_within(&place, margin))
    }

    /// Whether it may know that places were not seen.
    pub(crate) fn knows_unseen(&self) -> bool {
        let ranges = &self.scans.ranges;
        let all_end = !ranges.is_empty() && ranges.iter().all(|range| range.most.is_finite());
        !self.views.is_empty() || all_end
    }
}

/// Whether what an image counts as seen is behind a surface that another of the same time knows better.
fn is_known_better(images: &[Seeing], image: &Seeing, place: &Point3) -> bool {
    let is_other = |other: &&Seeing| !other.is_later() && !std::ptr::eq(*other, image);
    let mut others = images.iter().filter(is_other);
    !image.is_later() && others.any(|other| image.is_known_better_by(other, place))
}

/// What the image tells that knows most of a place; `None` without any. An older one knows nothing of what is behind a
/// thing that came since, in whichever image that is: it looked past where the thing is, or the robot was in its way.
fn best_of(images: &[Seeing], place: &Point3, breadth: f64) -> Option<Sight> {
    let (mut best, mut things, mut is_hidden) = (None, Vec::new(), false);
    for image in images.iter().rev() {
        // Where the robot was in it something may have come since.
        let sight = match is_hidden {
            true => image.sight_of_returns(place, breadth),
            false => image.sight(place, breadth),
        };
        if sight == Sight::Seen {
            if things.iter().any(|(thing, std)| image.looks_past(thing, *std))
                || is_known_better(images, image, place)
            {
                continue;
            }
            return Some(sight);
        }
        if sight.is_behind() && image.is_later() {
            match image.hiding(place) {
                Hiding::Robot => {}
                Hiding::Thing(thing, std) => {
                    is_hidden = true;
                    things.push((thing, std));
                }
                Hiding::Unknown => is_hidden = true,
            }
        }
        best = Some(best.map_or(sight, |best: Sight| best.min(sight)));
    }
    best
}
