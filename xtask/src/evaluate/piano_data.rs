//! Noisy samples of the piano and the room, as clouds for the tool.

use std::path::PathBuf;

use anyhow::Result;
use cloudtouch_geom::{Point3, PointCloud, Pose, TriangleMesh, seed};
use cloudtouch_io::write_cloud_pcd;
use cloudtouch_testkit::{
    noise::{NoiseKind, add_noise},
    surface::{area, positions, sample_surface},
};
use nalgebra::Matrix4;

use super::{
    Places, SEED,
    case_file::{Case, CaseFile},
};

/// How the meshes are sampled: mean spacing (root of area per point) and noise, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sampling {
    pub(super) piano_spacing: f64,
    pub(super) room_spacing: f64,
    pub(super) noise: f64,
}

/// The clouds of one sampling and the case file that names them.
pub(super) struct Sampled {
    pub(super) cases: PathBuf,
    /// How the document names the case file.
    pub(super) shown: String,
    pub(super) piano: Vec<Point3>,
    pub(super) room: Vec<Point3>,
}

impl Sampling {
    /// Samples both meshes and writes clouds and case file to the work folder.
    pub(super) fn write(
        &self,
        places: &Places,
        truth: &CaseFile,
        [room, piano]: [&TriangleMesh; 2],
    ) -> Result<Sampled> {
        let name = format!(
            "piano-{:.0}mm-room-{:.0}mm-noise-{:.0}mm",
            1e3 * self.piano_spacing,
            1e3 * self.room_spacing,
            1e3 * self.noise
        );
        let cloud = |mesh, spacing, stream, body: &str| -> Result<(Vec<Point3>, String)> {
            let points = noisy(mesh, spacing, self.noise, stream);
            let file = format!("{name}.{body}.pcd");
            write_cloud_pcd(places.work.join(&file), &PointCloud::from_points(points.clone()))?;
            Ok((points, file))
        };
        let (room, room_file) = cloud(room, self.room_spacing, 1, "room")?;
        let (piano, piano_file) = cloud(piano, self.piano_spacing, 2, "piano")?;
        let mut file = truth.clone();
        for case in &mut file.cases {
            case.scene.clone_from(&room_file);
            case.object.clone_from(&piano_file);
        }
        let cases = places.work.join(format!("{name}.json"));
        file.write(&cases)?;
        Ok(Sampled { cases, shown: format!("target/evaluate/{name}.json"), piano, room })
    }
}

/// Samples with the given mean spacing and Gaussian noise, m.
fn noisy(mesh: &TriangleMesh, spacing: f64, noise: f64, stream: u64) -> Vec<Point3> {
    let count = (area(mesh) / spacing.powi(2)).round() as usize;
    let samples = sample_surface(mesh, count, seed::derive(SEED, stream, 0));
    add_noise(&positions(&samples), NoiseKind::Gaussian, noise, seed::derive(SEED, stream, 1))
}

/// How near the two clouds come to one another.
#[derive(Debug, PartialEq)]
pub(super) struct Meeting {
    /// The smallest distance between a point of one and a point of the other, m; at most the reach.
    pub(super) gap: f64,
    /// Points of the piano within the reach of a point of the room.
    pub(super) points: usize,
}

impl Sampled {
    /// What of the piano, at the pose of the case, comes within `reach` metres of the room.
    pub(super) fn meeting(&self, case: &Case, reach: f64) -> Result<Meeting> {
        let rows: Vec<f64> = case.pose.iter().flatten().copied().collect();
        let pose = Pose::try_from_matrix(&Matrix4::from_row_slice(&rows))?;
        let placed: Vec<Point3> = self.piano.iter().map(|p| pose.transform_point(p)).collect();
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
        Ok(meeting)
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_testkit::scene;

    use super::*;

    #[test]
    fn the_count_follows_from_the_spacing() {
        let piano = scene::piano();
        let points = noisy(&piano, 0.1, 0.002, 2);
        assert_eq!(points.len(), (area(&piano) / 0.01).round() as usize);
        assert_eq!(points, noisy(&piano, 0.1, 0.002, 2));
    }

    #[test]
    fn the_gap_is_between_the_placed_points() {
        let sampled = Sampled {
            cases: PathBuf::new(),
            shown: String::new(),
            piano: vec![Point3::origin(), Point3::new(0.0, 0.0, 5.0)],
            room: vec![Point3::new(1.0, 0.25, 0.0)],
        };
        let case: Case = serde_json::from_value(serde_json::json!({
            "id": "x", "scene": "s", "object": "o",
            "pose": [[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
        }))
        .unwrap();
        assert_eq!(sampled.meeting(&case, 1.0).unwrap(), Meeting { gap: 0.25, points: 1 });
        assert_eq!(sampled.meeting(&case, 0.125).unwrap(), Meeting { gap: 0.125, points: 0 });
    }
}
