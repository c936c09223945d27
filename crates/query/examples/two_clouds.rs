//! How likely is it that two noisy clouds touch, and where?
//!
//! Run with `cargo run -p cloudtouch --example two_clouds`.

use cloudtouch::geom::{Point3, PointCloud, Pose, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Query, QuerySettings, Verdict};

/// A square of 40 cm with a point every centimetre, bent up or down by `bend` per metre.
fn sheet(bend: f64) -> PointCloud {
    let place = |k: usize| 0.01 * k as f64 - 0.195;
    let points = (0..1600).map(|i| (place(i % 40), place(i / 40)));
    PointCloud::from_points(
        points.map(|(x, y)| Point3::new(x, y, bend * (x * x + y * y))).collect(),
    )
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Both were measured with errors of 2 mm. Preparing is the costly part, and done once.
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.002 });
    let floor = Cloud::prepare(&sheet(0.0), &settings)?;
    let bowl = Cloud::prepare(&sheet(2.0), &settings)?;

    let query = Query::new(QuerySettings::default())?;
    println!("  gap    P      in            verdict");
    let mut answers = Vec::new();
    for gap in [0.04, 0.001, -0.04] {
        let floor_from_bowl = Pose::from_translation(Vector3::new(0.0, 0.0, gap));
        let report = query.run(&floor, &bowl, &floor_from_bowl)?;
        let (p, [lower, upper]) = (report.collision_probability, report.bounds);
        println!("{:4.0} mm  {p:.3}  [{lower:.3}, {upper:.3}]  {:?}", 1e3 * gap, report.verdict);
        answers.push(report);
    }

    assert_eq!(answers[0].verdict, Verdict::Free);
    assert_eq!(answers[2].verdict, Verdict::InCollision);
    // The normal points from A to B: from the floor up to the bowl, which touches near its middle.
    let contact = answers[1].contacts.first().ok_or("1 mm is within reach of the noise")?;
    println!("contact at {:.3}, normal {:.2}", contact.point, contact.normal_a_to_b);
    assert!(contact.normal_a_to_b.z > 0.9);
    Ok(())
}

#[cfg(test)]
mod tests {
    #[test]
    fn it_finds_what_it_says() -> Result<(), Box<dyn std::error::Error>> {
        super::main()
    }
}
