//! What does cleaning take away from a depth image, and what does it leave?
//!
//! Run with `cargo run -p cloudtouch --example clean_depth_image`.

use std::sync::Arc;

use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh};
use cloudtouch::noise::SensorModel;
use cloudtouch::{FilterSettings, Mesh, SelfMesh, filter};

const WIDTH: usize = 80;
const HEIGHT: usize = 60;

/// A post at 1 m before a wall at 2 m; the columns at its edges return depths in between, the top
/// row nothing, and the robot's own hand is in view at 30 cm.
fn image() -> PointCloud {
    let depth = |column: usize, row: usize| match (column, row) {
        (_, 0) => f64::NAN,
        (35..=44, 50..) => 0.3,
        (30 | 49, _) => 1.2 + 0.01 * row as f64,
        (31..=48, _) => 1.0,
        _ => 2.0,
    };
    let pixel = |i: usize| {
        let (column, row) = (i % WIDTH, i / WIDTH);
        let ray = [(column as f64 - 39.5) / 100.0, (row as f64 - 29.5) / 100.0];
        let z = depth(column, row);
        Point3::new(ray[0] * z, ray[1] * z, z)
    };
    let points = (0..WIDTH * HEIGHT).map(pixel).collect();
    PointCloud { image_size: Some((WIDTH, HEIGHT)), ..PointCloud::from_points(points) }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // The hand as the robot knows it: a flat patch, taken with 2 cm of padding.
    let corners = [[-0.02, 0.05], [0.02, 0.05], [0.02, 0.1], [-0.02, 0.1]];
    let corners = corners.map(|[x, y]| Point3::new(x, y, 0.3)).to_vec();
    let hand = Mesh::prepare(&TriangleMesh::new(corners, vec![[0, 1, 2], [0, 2, 3]])?)?;
    let hand = SelfMesh { mesh: Arc::new(hand), cloud_from_link: Pose::identity(), padding: 0.02 };
    // A camera drops returns nearer than 10 cm and veils; the robot is ours to add.
    let settings =
        FilterSettings { robot: vec![hand], ..FilterSettings::for_sensor(&SensorModel::Kinect) };

    let filtered = filter(&image(), &settings, &SensorModel::Kinect)?;
    for stage in &filtered.stages {
        println!("{:12} {:5} of {:5}", stage.stage, stage.removed, stage.before);
    }
    let removed =
        |name: &str| filtered.stages.iter().find(|s| s.stage == name).map_or(0, |s| s.removed);
    assert_eq!(removed("missing"), WIDTH);
    assert_eq!(removed("robot"), 10 * 10);
    // Two columns of 59 rows; whoever wants the post gets nothing else.
    assert!(removed("veil") >= 110, "{} of 118", removed("veil"));
    assert!(filtered.cloud.points.iter().all(|p| (p.z - 1.0).abs() < 0.1 || p.z == 2.0));
    Ok(())
}

#[cfg(test)]
mod tests {
    #[test]
    fn it_finds_what_it_says() -> Result<(), Box<dyn std::error::Error>> {
        super::main()
    }
}
