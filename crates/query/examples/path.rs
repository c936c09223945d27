//! A blade swung past a sheet and through it in one step: free at both ends, and found.
//!
//! Run with `cargo run -p cloudtouch --example path`.

use cloudtouch::geom::{Point3, PointCloud, Pose, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Path, Query, QuerySettings, Verdict};

/// A flat piece of 20 cm across `up`, with a point every centimetre.
fn piece(up: Vector3) -> PointCloud {
    let place = |k: usize| 0.01 * k as f64 - 0.095;
    let (first, second) = (Vector3::new(up.y, up.z, up.x), Vector3::new(up.z, up.x, up.y));
    let point = |i: usize| Point3::from(first * place(i % 20) + second * place(i / 20));
    PointCloud::from_points((0..400).map(point).collect())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.001 });
    let sheet = Cloud::prepare(&piece(Vector3::z()), &settings)?;
    let blade = Cloud::prepare(&piece(Vector3::x()), &settings)?;
    let query = Query::new(QuerySettings::default())?;
    let at = |x: f64, z: f64| Pose::from_translation(Vector3::new(x, 0.0, z));

    // Beside the sheet it swings down; then it comes back up, through it.
    let poses = [at(0.2, 0.2), at(0.2, -0.2), at(0.0, -0.2), at(0.0, 0.2)];
    for pose in &poses {
        assert_eq!(query.run(&sheet, &blade, pose)?.verdict, Verdict::Free);
    }
    let swept = query.sweep(&sheet, &blade, &Path::through(&poses)?, 0.005)?;
    let first = swept.first.ok_or("it passes the sheet")?;
    println!(
        "free for certain for {:.0} % of the way, in collision in segment {} at t = {:.2}",
        100.0 * swept.certified_free_until,
        first.at.segment,
        first.at.t
    );
    // Its upper edge is at the sheet after 10 of 40 cm.
    assert!(first.at.segment == 2 && (0.25..0.35).contains(&first.at.t));
    assert!((0.6..0.75).contains(&swept.certified_free_until));
    assert_eq!(swept.verdict, Verdict::InCollision);
    Ok(())
}

#[cfg(test)]
mod tests {
    #[test]
    fn it_finds_what_it_says() -> Result<(), Box<dyn std::error::Error>> {
        super::main()
    }
}
