//! A hundred poses of one object: on one thread and on four, with the same answers.
//!
//! Run with `cargo run -p cloudtouch --example batch`.

use std::time::Instant;

use cloudtouch::geom::{Point3, PointCloud, Pose, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Query, QuerySettings, Verdict};

/// A square of 40 cm at the height of a wave, with a point every centimetre.
fn wave(height: f64) -> PointCloud {
    let place = |k: usize| 0.01 * k as f64 - 0.195;
    let points = (0..1600).map(|i| (place(i % 40), place(i / 40)));
    let up = |(x, y): (f64, f64)| Point3::new(x, y, height * (20.0 * x).sin() * (20.0 * y).cos());
    PointCloud::from_points(points.map(up).collect())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.002 });
    let ground = Cloud::prepare(&wave(0.01), &settings)?;
    let sheet = Cloud::prepare(&wave(0.02), &settings)?;
    let query = Query::new(QuerySettings::default())?;
    // Down from 10 cm above the ground, turning on the way.
    let poses: Vec<Pose> = (0..100)
        .map(|i| {
            let height = Vector3::new(0.0, 0.0, 0.10 - 0.001 * f64::from(i));
            Pose::from_translation_rpy(height, [0.0, 0.0, 0.03 * f64::from(i)])
        })
        .collect();

    let mut runs = Vec::new();
    for threads in [1, 4] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        let start = Instant::now();
        let reports = pool.install(|| query.run_batch(&ground, &sheet, &poses));
        let reports = reports.into_iter().collect::<Result<Vec<_>, _>>()?;
        println!("{threads} threads: {:.0} ms", 1e3 * start.elapsed().as_secs_f64());
        runs.push(reports);
    }

    for (one, four) in runs[0].iter().zip(&runs[1]) {
        // The same bits, not only about the same.
        assert_eq!(one.collision_probability, four.collision_probability);
        assert_eq!(one.contacts, four.contacts);
    }
    let free = runs[0].iter().take_while(|r| r.verdict == Verdict::Free).count();
    println!("free down to {} mm", 101 - free);
    assert!(free > 30 && runs[0][99].verdict == Verdict::InCollision);
    Ok(())
}

#[cfg(test)]
mod tests {
    #[test]
    fn it_finds_what_it_says() -> Result<(), Box<dyn std::error::Error>> {
        super::main()
    }
}
