//! What is too large to be reckoned with is an error that names it, and takes no memory.

#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use cloudtouch::bvh::Traversal;
use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{
    Cloud, CloudSettings, Mesh, PaperCloud, PaperCloudSettings, PaperQuery, PaperSettings,
    PrepareError, Query, QueryError, QuerySettings, SubdivisionError,
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
    Mesh::prepare(&TriangleMesh::try_new(corners, vec![[0, 1, 2]]).unwrap())
}

#[test]
fn coordinates_beyond_reckoning_are_refused() {
    for value in [1e51, -1e200, f64::MAX] {
        let error = cloud(vec![Point3::origin(), Point3::new(0.0, value, 0.0)]).unwrap_err();
        assert_eq!(error, PrepareError::CoordinateRange { index: 1, value });
        assert!(error.to_string().len() < 150, "{error}");
        let error = triangle(value).unwrap_err();
        assert!(matches!(error, PrepareError::CoordinateRange { index: 0, .. }), "{error}");
    }
}

#[test]
fn poses_beyond_reckoning_are_refused() {
    let (a, b) = (cloud(vec![Point3::origin()]).unwrap(), triangle(1.0).unwrap());
    let query = Query::new(QuerySettings::default()).unwrap();
    for value in [1e51, -f64::MAX, f64::INFINITY] {
        let pose = Pose::from_translation(Vector3::new(0.0, value, 0.0));
        let error = query.run(&a, &b, &pose).unwrap_err();
        assert_eq!(error, QueryError::Pose { value });
        assert!(error.to_string().contains("1e50"), "{error}");
    }
    let far = query.run(&a, &b, &Pose::from_translation(Vector3::new(0.0, 1e50, 0.0))).unwrap();
    assert_eq!(far.collision_probability, 0.0);
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
    let by_default = Query::new(QuerySettings::default()).unwrap().run(&a, &b, &Pose::identity());
    let settings = PaperCloudSettings::new(SensorModel::Exact);
    let a = PaperCloud::prepare(&PointCloud::from_points(points), &settings).unwrap();
    let certified = PaperSettings { traversal: Traversal::Certified, ..PaperSettings::default() };
    // In its plane: exact points that are apart from it need no classifier.
    let within = Pose::from_translation(Vector3::new(0.0, 0.0, 0.001));
    let by_the_paper = PaperQuery::new(certified).unwrap().run(&a, &b, &within);
    for error in [by_default.unwrap_err(), by_the_paper.unwrap_err()] {
        assert!(
            matches!(error, QueryError::Subdivision(SubdivisionError { max_parts: 20_000, .. })),
            "{error}"
        );
    }
}

#[test]
fn pictures_of_a_mesh_take_no_more_points_than_allowed() {
    let mesh = triangle(1.0).unwrap();
    // 4 + 16 + 64 parts, and the triangle itself.
    assert!(mesh.surface_points(0.4, 85).is_ok());
    assert_eq!(
        mesh.surface_points(1e-9, 1_000_000),
        Err(SubdivisionError { spacing: 1e-9, max_parts: 1_000_000 })
    );
}
