//! What is too large to be reckoned with is an error that names it, and takes no memory.

#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use cloudtouch::bvh::Traversal;
use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{
    Cloud, CloudSettings, Mesh, PaperCloud, PaperCloudSettings, PaperQuery, PaperSettings,
    PrepareError, Query, QueryError, QuerySettings, Safeguards, SubdivisionError, Undecided,
};

fn cloud(points: Vec<Point3>) -> Result<Cloud, PrepareError> {
    let settings = CloudSettings::new(SensorModel::Exact);
    Cloud::prepare(&PointCloud::from_points(points), &settings)
}

fn triangle(size: f64) -> Result<Mesh, PrepareError> {
    let corners = vec![
        Point3::new(-size, -size, 0.0),
        Point3::new(size, 0.0, 0.0),
        Point3::new(0.0, size, 0.0),
    ];
    Mesh::prepare(&TriangleMesh::new(corners, vec![[0, 1, 2]]).unwrap())
}

#[test]
fn coordinates_beyond_reckoning_are_refused() {
    for value in [1.01e10, 1e17, -1e29] {
        // The row in the file, though the filter takes the first away.
        let points = [f64::NAN, 0.0, value].map(|y| Point3::new(0.0, y, 0.0));
        let error = cloud(points.to_vec()).unwrap_err();
        assert_eq!(error, PrepareError::CoordinateRange { index: 2, value });
        assert!(error.to_string().len() < 150, "{error}");
    }
    for value in [1.01e10, -1e200, f64::MAX] {
        let error = triangle(value).unwrap_err();
        assert!(matches!(error, PrepareError::CoordinateRange { index: 0, .. }), "{error}");
    }
}

/// One such row made a pair of clouds half likely to collide at any distance.
#[test]
fn the_largest_float_of_a_camera_was_a_point() {
    for placeholder in [f64::from(f32::MAX), -f64::from(f32::MAX), 1e30, f64::MAX] {
        let mut points: Vec<Point3> = (0..100)
            .map(|i| Point3::new(0.01 * f64::from(i % 10), 0.001 * f64::from(i), 0.0))
            .collect();
        points.insert(7, Point3::new(0.1, 0.2, placeholder));
        let a = cloud(points).unwrap();
        assert_eq!((a.len(), a.filter_stages()[0].removed), (100, 1));
        // Hundreds of sizes away are doubted unless they are meant.
        let safeguards = Safeguards { doubt_units: false, ..Safeguards::default() };
        let query = Query::new(QuerySettings { safeguards, ..QuerySettings::default() }).unwrap();
        let pose = Pose::from_translation(Vector3::new(50.0, 0.0, 0.0));
        let report = query.run(&a, &a, &pose).unwrap();
        assert!(report.bounds[1] < 0.01, "{placeholder}: {report:?}");
    }
}

#[test]
fn poses_beyond_reckoning_are_refused() {
    let (a, b) = (cloud(vec![Point3::origin()]).unwrap(), triangle(1.0).unwrap());
    let query = Query::new(QuerySettings::default()).unwrap();
    for value in [1.01e10, -f64::MAX, f64::INFINITY] {
        let pose = Pose::from_translation(Vector3::new(0.0, value, 0.0));
        let error = query.run(&a, &b, &pose).unwrap_err();
        assert_eq!(error, QueryError::Pose { value });
        assert!(error.to_string().contains("1e10"), "{error}");
    }
    let far = query.run(&a, &b, &Pose::from_translation(Vector3::new(0.0, 1e10, 0.0))).unwrap();
    assert!(far.collision_probability < 5e-4, "{far:?}");
}

#[test]
fn a_mesh_that_a_dense_cloud_would_split_millions_of_times_is_an_error() {
    // Bunches of points a micrometre apart, strewn over a metre: as dense, the triangle that they
    // lie on takes 4¹⁰ parts.
    let bunches = (0..10).flat_map(|bunch| {
        let x = 0.1 * f64::from(bunch) - 0.5;
        (0..10).map(move |i| Point3::new(x, 1e-6 * f64::from(i), 0.001))
    });
    let (points, b) = (bunches.collect::<Vec<_>>(), triangle(1.0).unwrap());
    let a = cloud(points.clone()).unwrap();
    // The default path takes the triangle as it is, a millimetre off; what is between the bunches nobody knows.
    let by_default = Query::new(QuerySettings::default()).unwrap().run(&a, &b, &Pose::identity());
    let by_default = by_default.unwrap();
    assert!(by_default.collision_probability < 0.1, "{by_default:?}");
    assert_eq!(by_default.undecided_by, Some(Undecided::Sparse));
    let settings = PaperCloudSettings::amended(SensorModel::Exact);
    let a = PaperCloud::prepare(&PointCloud::from_points(points), &settings).unwrap();
    let certified = PaperSettings { traversal: Traversal::Certified, ..PaperSettings::amended() };
    // In its plane: exact points that are apart from it need no classifier.
    let within = Pose::from_translation(Vector3::new(0.0, 0.0, 0.001));
    let by_the_paper = PaperQuery::new(certified).unwrap().run(&a, &b, &within);
    let error = by_the_paper.unwrap_err();
    assert!(
        matches!(error, QueryError::Subdivision(SubdivisionError { max_parts: 20_000, .. })),
        "{error}"
    );
}
