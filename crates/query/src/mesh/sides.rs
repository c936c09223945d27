//! On which side of a closed mesh one place after another is.

use std::collections::VecDeque;

use cloudtouch_geom::Point3;

use super::prepare::Mesh;

/// Off the surface distances are told this well, as a share of the coordinates.
const ROUNDING: f64 = 1e-9;
/// So many balls are remembered: to look through them costs less than one sum over triangles.
const REMEMBERED: usize = 32;

/// Tells sides of places of which many are near one another: a sum over triangles tells that of all
/// places as near to one as the surface is.
#[derive(Debug)]
pub(crate) struct Sides<'m> {
    mesh: &'m Mesh,
    known: VecDeque<OneSided>,
}

/// A ball that no surface passes.
#[derive(Debug)]
struct OneSided {
    middle: Point3,
    radius: f64,
    is_inside: bool,
}

impl OneSided {
    fn holds(&self, place: &Point3, around: f64) -> bool {
        (place - self.middle).norm() + around < self.radius
    }
}

impl<'m> Sides<'m> {
    pub(crate) fn of(mesh: &'m Mesh) -> Self {
        Self { mesh, known: VecDeque::new() }
    }

    fn known(&self, place: &Point3, around: f64) -> Option<&OneSided> {
        self.known.iter().find(|known| known.holds(place, around))
    }

    /// [`Mesh::encloses`] of a place that is so far (m) from the surface.
    pub(crate) fn encloses(&mut self, local: &Point3, distance: f64) -> bool {
        if let Some(known) = self.known(local, 0.0) {
            return known.is_inside;
        }
        let is_inside = self.mesh.encloses(local);
        let radius = distance - ROUNDING * (distance + local.coords.norm());
        self.known.truncate(REMEMBERED - 1);
        self.known.push_front(OneSided { middle: *local, radius, is_inside });
        is_inside
    }

    /// Whether every place within a distance (m) of this one, in the local frame, is outside.
    pub(crate) fn are_clear_around(&mut self, local: &Point3, distance: f64) -> bool {
        if self.mesh.is_surely_clear_of(local, distance) {
            return true;
        }
        if self.mesh.is_surely_inside(local) {
            return false;
        }
        if let Some(known) = self.known(local, distance) {
            return !known.is_inside;
        }
        let to_surface = self.mesh.distance(local);
        to_surface > distance && !self.encloses(local, to_surface)
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Pose, Vector3, seed};
    use cloudtouch_testkit::scene;

    use super::*;

    /// Places that follow one another along a crooked way through thin and thick parts.
    #[test]
    fn sides_of_places_near_one_another_are_those_of_each_alone() {
        let wire = |x: f64| {
            let there = Pose::from_translation_rpy(Vector3::new(x, 0.0, 0.0), [0.2, -0.1, 0.4]);
            scene::moved(&scene::cuboid([0.01, 0.8, 0.012]), &there)
        };
        let thick = scene::moved(&scene::torus(0.3, 0.1, 24), &Pose::identity());
        let shape = scene::assemble((0..5).map(|k| wire(0.1 * f64::from(k))).chain([thick]));
        let mesh = Mesh::prepare(&shape).unwrap();
        let mut sides = Sides::of(&mesh);
        let mut place = Point3::origin();
        let mut counts = [0; 4];
        for i in 0..20_000 {
            let step = [0, 1, 2].map(|k| seed::unit(seed::derive(3, i, k)) - 0.5);
            let next = place + 0.02 * Vector3::from(step);
            place = if next.coords.amax() < 0.45 { next } else { Point3::origin() };
            let distance = mesh.distance(&place);
            let is_inside = mesh.encloses(&place);
            assert_eq!(sides.encloses(&place, distance), is_inside, "{place}");
            let around = (0.06 * seed::unit(seed::derive(4, i, 0)) - 0.01).max(0.0);
            let is_clear = distance > around && !is_inside;
            assert_eq!(sides.are_clear_around(&place, around), is_clear, "{place}");
            counts[usize::from(is_inside)] += 1;
            counts[2 + usize::from(is_clear)] += 1;
        }
        assert!(counts.iter().all(|&count| count > 1000), "{counts:?}");
    }
}
