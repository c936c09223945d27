//! May a gripper go where a camera saw a mug?
//!
//! The gripper is a mesh: exact and watertight, so that points deep inside it are found too.
//! Run with `cargo run -p cloudtouch --example cloud_and_gripper`.

use cloudtouch::geom::{MeshError, Point3, PointCloud, Pose, TriangleMesh, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Mesh, Query, QuerySettings, Verdict};

/// A closed box between two corners, as (vertices, triangles) appended to those there are.
fn push_box(low: [f64; 3], high: [f64; 3], parts: &mut (Vec<Point3>, Vec<[u32; 3]>)) {
    let first = parts.0.len() as u32;
    let pick = |corner: u32, k: usize| if corner >> k & 1 == 0 { low[k] } else { high[k] };
    parts.0.extend((0..8).map(|c| Point3::new(pick(c, 0), pick(c, 1), pick(c, 2))));
    // Corner numbers in binary are zyx; each face twice, anticlockwise from outside.
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    for [a, b, c, d] in faces.map(|face| face.map(|corner: u32| first + corner)) {
        parts.1.extend([[a, b, c], [a, c, d]]);
    }
}

/// Two fingers of 8 cm below a palm, 9 cm apart; the origin is between the finger tips.
fn gripper() -> Result<TriangleMesh, MeshError> {
    let mut parts = (Vec::new(), Vec::new());
    push_box([-0.065, -0.01, 0.0], [-0.045, 0.01, 0.08], &mut parts);
    push_box([0.045, -0.01, 0.0], [0.065, 0.01, 0.08], &mut parts);
    push_box([-0.08, -0.02, 0.081], [0.08, 0.02, 0.12], &mut parts);
    TriangleMesh::new(parts.0, parts.1)
}

/// The side of a mug 8 cm wide and 10 cm high, standing at the origin.
fn mug() -> PointCloud {
    let ring = |i: usize| std::f64::consts::TAU * (i % 50) as f64 / 50.0;
    let on_side = |i| {
        Point3::new(0.04 * f64::cos(ring(i)), 0.04 * f64::sin(ring(i)), 0.005 * (i / 50) as f64)
    };
    PointCloud::from_points((0..1050).map(on_side).collect())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.001 });
    let mug = Cloud::prepare(&mug(), &settings)?;
    let gripper = Mesh::prepare(&gripper()?)?;
    assert!(gripper.is_watertight());

    let query = Query::new(QuerySettings::default())?;
    let ask = |what: &str, x: f64, z: f64| {
        let mug_from_gripper = Pose::from_translation(Vector3::new(x, 0.0, z));
        let report = query.run(&mug, &gripper, &mug_from_gripper)?;
        let p = report.collision_probability;
        println!("{what}: P = {p:.3}, {:?}, clearance {:?}", report.verdict, report.clearance_m);
        Ok::<Verdict, cloudtouch::QueryError>(report.verdict)
    };
    assert_eq!(ask("astride the rim   ", 0.0, 0.06)?, Verdict::Free);
    assert_eq!(ask("a centimetre aside", 0.01, 0.06)?, Verdict::InCollision);
    assert_eq!(ask("palm in the rim   ", 0.0, 0.01)?, Verdict::InCollision);
    Ok(())
}

#[cfg(test)]
mod tests {
    #[test]
    fn it_finds_what_it_says() -> Result<(), Box<dyn std::error::Error>> {
        super::main()
    }
}
