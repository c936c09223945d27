//! Noisy samples of the piano and the room, and where the two clouds meet.

use cloudtouch_geom::{Point3, Pose, TriangleMesh, seed};
use cloudtouch_testkit::{
    noise::{NoiseKind, add_noise},
    surface::{area, positions, sample_surface},
};

/// How the meshes are sampled: mean spacing (root of area per point) and noise, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sampling {
    pub(super) piano_spacing: f64,
    pub(super) room_spacing: f64,
    pub(super) noise: f64,
}

/// The clouds of one sampling.
pub(super) struct Sampled {
    pub(super) piano: Vec<Point3>,
    pub(super) room: Vec<Point3>,
}

/// How near the two clouds come to one another.
#[derive(Debug, PartialEq)]
pub(super) struct Meeting {
    /// The smallest distance between a point of one and a point of the other, m; at most the reach.
    pub(super) gap: f64,
    /// Points of the piano within the reach of a point of the room.
    pub(super) points: usize,
}

impl Sampling {
    /// Samples both meshes.
    pub(super) fn draw(&self, room: &TriangleMesh, piano: &TriangleMesh, seed: u64) -> Sampled {
        Sampled {
            room: noisy(room, self.room_spacing, self.noise, seed::derive(seed, 1, 0)),
            piano: noisy(piano, self.piano_spacing, self.noise, seed::derive(seed, 2, 0)),
        }
    }
}

/// Samples with the given mean spacing and Gaussian noise, m.
fn noisy(mesh: &TriangleMesh, spacing: f64, noise: f64, seed: u64) -> Vec<Point3> {
    let count = (area(mesh) / spacing.powi(2)).round() as usize;
    let samples = positions(&sample_surface(mesh, count, seed));
    add_noise(&samples, NoiseKind::Gaussian, noise, seed::derive(seed, 0, 1))
}

impl Sampled {
    /// What of the piano, at a pose, comes within `reach` metres of the room.
    pub(super) fn meeting(&self, room_from_piano: &Pose, reach: f64) -> Meeting {
        let placed: Vec<Point3> =
            self.piano.iter().map(|p| room_from_piano.transform_point(p)).collect();
        let low = placed.iter().fold(placed[0], |low, p| low.inf(p)).map(|v| v - reach);
        let high = placed.iter().fold(placed[0], |high, p| high.sup(p)).map(|v| v + reach);
        let room: Vec<&Point3> = self.room.iter().filter(|q| low <= **q && **q <= high).collect();
        let mut meeting = Meeting { gap: reach, points: 0 };
        for p in &placed {
            let squares = room.iter().map(|q| (p - **q).norm_squared());
            let distance = squares.fold(f64::INFINITY, f64::min).sqrt();
            meeting.points += usize::from(distance < reach);
            meeting.gap = meeting.gap.min(distance);
        }
        meeting
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Vector3;

    use super::*;

    #[test]
    fn the_gap_is_between_the_placed_points() {
        let sampled = Sampled {
            piano: vec![Point3::origin(), Point3::new(0.0, 0.0, 5.0)],
            room: vec![Point3::new(1.0, 0.25, 0.0)],
        };
        let pose = Pose::from_translation(Vector3::x());
        assert_eq!(sampled.meeting(&pose, 1.0), Meeting { gap: 0.25, points: 1 });
        assert_eq!(sampled.meeting(&pose, 0.125), Meeting { gap: 0.125, points: 0 });
    }
}
