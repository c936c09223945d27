//! How directions become places of a view.

use std::f64::consts::TAU;

use cloudtouch_geom::Vector3;
use nalgebra::UnitQuaternion;

/// An image with a direction so far off its middle (cosine) is a panorama: 80° and more.
const PANORAMA: f64 = 0.17;
/// Relative rounding of what is looked for, and absolute of a place of the view, generously.
const ROUNDING: [f64; 2] = [1e-9, 1e-12];

/// How directions become places of a view.
#[derive(Debug)]
pub(super) enum Lens {
    /// A camera: forward is where the points lie, right and down are as nearly as can be those of its rows and
    /// columns, so that its view is a rectangle of the raster in every frame.
    Camera([Vector3; 3]),
    /// All around the vertical of the sensor: by azimuth and elevation, from its frame.
    Panorama(UnitQuaternion<f64>),
}

/// Where a camera sees a place.
#[derive(Debug, Clone, Copy)]
pub(in crate::cloud) struct Spot {
    pub at: [f64; 2],
    /// Along the axis of the camera, m.
    pub depth: f64,
}

impl Spot {
    /// How far about it in the view all is that is no farther than a distance (m) from a place there, with room for
    /// rounding; `None` where some of that may not be ahead.
    pub(super) fn reach(&self, distance: f64) -> Option<[f64; 2]> {
        let nearest = self.depth - distance;
        // Of a place δ farther on, u moves by (δ·right − u δ·forward)/(depth + δ·forward).
        let [relative, absolute] = ROUNDING;
        let reach = |u: f64| {
            (1.0 + relative) * distance * u.hypot(1.0) / nearest + absolute * (1.0 + u.abs())
        };
        (nearest > 0.0).then(|| self.at.map(reach))
    }
}

impl Lens {
    /// Of rays and how long they are, m, and of a scanner the bearing where those of its view begin, rad.
    pub(super) fn of<'a>(
        rays: impl Iterator<Item = (&'a Vector3, f64)> + Clone,
        (turn, scanner): (&UnitQuaternion<f64>, Option<f64>),
    ) -> Option<Self> {
        let rays = || rays.clone().filter(|(_, range)| *range > 0.0);
        let directions = rays().map(|(ray, range)| ray / range);
        let forward = directions.sum::<Vector3>().try_normalize(0.0)?;
        let is_aside = |(ray, range): (&Vector3, f64)| ray.dot(&forward) < PANORAMA * range;
        if scanner.is_some() || rays().any(is_aside) {
            let begin = scanner.unwrap_or(0.0);
            let turned = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), -begin);
            return Some(Self::Panorama(turned * turn.inverse()));
        }
        // A camera looks along its z; one whose turn is stated otherwise, as in a frame with x or y forward, still has
        // an axis aside.
        let local = turn.inverse_transform_vector(&forward).abs();
        let right = if local.x < local.y.max(local.z) { Vector3::x() } else { Vector3::y() };
        let down = forward.cross(&turn.transform_vector(&right)).normalize();
        Some(Self::Camera([down.cross(&forward), down, forward]))
    }

    pub(super) fn is_behind(&self, ray: &Vector3) -> bool {
        match self {
            Self::Camera([_, _, forward]) => ray.dot(forward) <= 0.0,
            Self::Panorama(_) => false,
        }
    }

    /// How far away what a ray of such a range (m) leads to is, m: along the axis of a camera, over which a plane goes
    /// evenly, or from a scanner.
    pub(super) fn distance(&self, ray: &Vector3, range: f64) -> f64 {
        match self {
            Self::Camera([_, _, forward]) => ray.dot(forward),
            Self::Panorama(_) => range,
        }
    }

    /// Where a camera sees what a ray leads to; `None` of what is not ahead, and of a panorama.
    pub(super) fn spot(&self, ray: &Vector3) -> Option<Spot> {
        let Self::Camera([.., forward]) = self else { return None };
        Some(Spot { at: self.project(ray)?, depth: ray.dot(forward) })
    }

    /// `None` for a direction that no view of this kind has.
    pub(super) fn project(&self, ray: &Vector3) -> Option<[f64; 2]> {
        match self {
            Self::Camera([right, down, forward]) => {
                let depth = ray.dot(forward);
                (depth > 0.0).then(|| [ray.dot(right) / depth, ray.dot(down) / depth])
            }
            Self::Panorama(to_sensor) => {
                let (range, ray) = (ray.norm(), to_sensor.transform_vector(ray));
                (range > 0.0).then(|| [ray.y.atan2(ray.x).rem_euclid(TAU), (ray.z / range).asin()])
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Forward along y there was no right: the axis that it was told across was that one, or off it by rounding.
    #[test]
    fn rows_of_a_camera_that_looks_along_an_axis_of_its_frame_are_level() {
        for forward in 0..3 {
            let aside = [(forward + 1) % 3, (forward + 2) % 3];
            let ray = |[u, v]: [f64; 2]| {
                let mut ray = Vector3::ith(forward, 1.0);
                (ray[aside[0]], ray[aside[1]]) = (0.5 * u, 0.25 * v);
                ray
            };
            let rays = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]].map(ray);
            let lens = Lens::of(
                rays.iter().map(|ray| (ray, ray.norm())),
                (&UnitQuaternion::identity(), None),
            );
            let lens = lens.expect("rays with directions");
            for ray in &rays {
                let at = lens.project(ray).expect("a ray ahead");
                let mut sides = at.map(f64::abs);
                sides.sort_by(f64::total_cmp);
                let off = [sides[0] - 0.25, sides[1] - 0.5];
                assert!(off.iter().all(|off| off.abs() < 1e-12), "{forward}: {at:?}");
            }
        }
    }
}
