//! The cleaning pipeline, stage by stage, by the counts it reports.

use std::sync::Arc;

use crate::common::{at, measured, mesh};
use cloudtouch::geom::{Covariance, Point3, PointCloud, Pose, Vector3, seed};
use cloudtouch::noise::SensorModel;
use cloudtouch::{
    Cloud, CloudSettings, FilterError, FilterSettings, OutlierSettings, PrepareError, SelfMesh,
    StageReport, VeilSettings, filter,
};
use cloudtouch_testkit::camera::DepthCamera;
use cloudtouch_testkit::exact::{ExactMesh, brute};
use cloudtouch_testkit::scene;

/// What one stage removed; fails when it did not run.
fn removed(stages: &[StageReport], stage: &str) -> usize {
    let found = stages.iter().find(|s| s.stage == stage);
    found.unwrap_or_else(|| panic!("no stage {stage} in {stages:?}")).removed
}

/// Nothing but the stages a test switches on.
fn off() -> FilterSettings {
    FilterSettings { drop_duplicates: false, ..FilterSettings::default() }
}

fn grid(count: usize) -> Vec<Point3> {
    (0..count).map(|i| Point3::new(0.01 * (i % 20) as f64, 0.01 * (i / 20) as f64, 1.0)).collect()
}

#[test]
fn rows_that_are_not_finite_always_go() {
    let mut points = grid(100);
    points[3].x = f64::NAN;
    points[50].z = f64::INFINITY;
    points[99] = Point3::from(Vector3::repeat(f64::NAN));
    let filtered = filter(&PointCloud::from_points(points), &off(), &SensorModel::Exact).unwrap();
    assert_eq!(filtered.stages, [StageReport { stage: "missing", before: 100, removed: 3 }]);
    assert_eq!(filtered.rows.len(), 97);
    assert!([3, 50, 99].iter().all(|row| !filtered.rows.contains(row)));
    // What is kept is what was there, in its order, with the row it came from.
    for (point, &row) in filtered.cloud.points.iter().zip(&filtered.rows) {
        assert_eq!(*point, grid(100)[row]);
    }
}

#[test]
fn the_range_is_measured_from_the_sensor_and_includes_its_ends() {
    let points: Vec<Point3> = (0..10).map(|i| Point3::new(5.0, 0.0, f64::from(i))).collect();
    let cloud = PointCloud {
        sensor_pose: Some(Pose::from_translation(Vector3::new(5.0, 0.0, 0.0))),
        ..PointCloud::from_points(points)
    };
    let settings = FilterSettings { min_range: Some(2.0), max_range: 7.0, ..off() };
    let filtered = filter(&cloud, &settings, &SensorModel::Exact).unwrap();
    assert_eq!(filtered.rows, [2, 3, 4, 5, 6, 7]);
    assert_eq!(removed(&filtered.stages, "range"), 4);
}

/// A post at the origin of a map was dropped for being too near a scanner that had never been there.
#[test]
fn what_is_near_the_origin_of_a_map_was_taken_for_no_return() {
    let mut points: Vec<Point3> =
        (0..20).map(|i| Point3::new(0.01 * f64::from(i), 0.0, 0.0)).collect();
    points.extend(grid(50));
    let count = points.len();
    let map = PointCloud::from_points(points);
    for sensor in ["lidar:0.02,0.003", "kinect", "stereo:0.09,570,0.2"] {
        let settings = FilterSettings::for_sensor(&sensor.parse().unwrap());
        let dropped = |cloud: &PointCloud, settings: &FilterSettings| {
            let stages = filter(cloud, settings, &SensorModel::Exact).unwrap().stages;
            removed(&stages, "missing") + removed(&stages, "range")
        };
        // Missing returns are written so.
        assert_eq!(dropped(&map, &settings), 1, "{sensor}");
        // Said to be in the middle of what it measured, a sensor was elsewhere: 14 points went.
        let sensor_pose = Some(Pose::from_translation(Vector3::new(0.155, 0.0, 0.0)));
        let said = PointCloud { sensor_pose, ..map.clone() };
        assert_eq!(dropped(&said, &settings), 0, "{sensor}");
        let said = PointCloud { sensor_pose: Some(Pose::identity()), ..map.clone() };
        assert_eq!(dropped(&said, &settings), 1, "{sensor}");
        // Of an image it is told whether its sensor was there, and what is at that is no surface.
        let image = PointCloud { image_size: Some((count / 2, 2)), ..map.clone() };
        assert_eq!(dropped(&image, &settings), 10, "{sensor}");
        let asked_for = FilterSettings { min_range: Some(0.055), ..settings };
        assert_eq!(dropped(&map, &asked_for), 6, "{sensor}");
    }
}

#[test]
fn of_duplicates_the_first_stays() {
    let mut points = grid(50);
    points.extend(grid(20));
    points.push(Point3::new(-0.0, 0.0, 1.0));
    let settings = FilterSettings { drop_duplicates: true, ..off() };
    let filtered =
        filter(&PointCloud::from_points(points), &settings, &SensorModel::Exact).unwrap();
    assert_eq!(removed(&filtered.stages, "duplicates"), 21);
    assert_eq!(filtered.rows, (0..50).collect::<Vec<_>>());
}

/// Which of them counted hung on the order of the rows.
#[test]
fn of_duplicates_with_their_own_noise_the_least_certain_stays() {
    let points = [0, 1, 0, 2, 0, 1].map(|x| Point3::new(f64::from(x), 0.0, 1.0));
    let variances = [1.0, 5.0, 4.0, 2.0, 4.0, 3.0];
    let settings = FilterSettings { drop_duplicates: true, ..off() };
    let kept = |order: [usize; 6]| {
        let cloud = PointCloud {
            covariances: Some(order.map(|i| Covariance::isotropic(variances[i])).to_vec()),
            ..PointCloud::from_points(order.map(|i| points[i]).to_vec())
        };
        filter(&cloud, &settings, &SensorModel::Exact).unwrap().rows
    };
    assert_eq!(kept([0, 1, 2, 3, 4, 5]), [1, 2, 3]);
    assert_eq!(kept([5, 4, 3, 2, 1, 0]), [1, 2, 4]);
}

#[test]
fn covariances_follow_their_points() {
    let mut points = grid(10);
    points[4].y = f64::NAN;
    let covariances = (0..10).map(|i| Covariance::isotropic(f64::from(i))).collect();
    let cloud = PointCloud { covariances: Some(covariances), ..PointCloud::from_points(points) };
    let kept = filter(&cloud, &off(), &SensorModel::Exact).unwrap();
    let covariances = kept.cloud.covariances.expect("covariances are kept");
    for (covariance, &row) in covariances.iter().zip(&kept.rows) {
        assert_eq!(*covariance, Covariance::isotropic(row as f64));
    }
}

#[test]
fn points_of_the_robot_go_inside_and_within_the_padding() {
    // A line of points through a box of 20 cm centred at x = 0.5.
    let points: Vec<Point3> =
        (0..=100).map(|i| Point3::new(0.01 * f64::from(i), 0.0, 0.0)).collect();
    let link = |padding: f64| SelfMesh {
        mesh: Arc::new(mesh(&scene::cuboid([0.2; 3]))),
        cloud_from_link: Pose::from_translation_rpy(Vector3::new(0.5, 0.0, 0.0), [0.0, 0.0, 1.0]),
        padding,
    };
    let square = SelfMesh { cloud_from_link: at(0.5, 0.0, 0.0), ..link(0.025) };
    let settings = FilterSettings { robot: vec![square], ..off() };
    let filtered =
        filter(&PointCloud::from_points(points.clone()), &settings, &SensorModel::Exact).unwrap();
    // Inside from 0.4 to 0.6, padded to 0.375 and 0.625: rows 38 to 62.
    assert_eq!(removed(&filtered.stages, "robot"), 25);
    assert!(filtered.rows.iter().all(|row| !(38..=62).contains(row)));
    // Turned about z by 1 rad the padded box is wider along the line; all links count.
    let settings = FilterSettings { robot: vec![link(0.0), link(0.025)], ..off() };
    let turned =
        filter(&PointCloud::from_points(points.clone()), &settings, &SensorModel::Exact).unwrap();
    let cut = 0.1 / 1.0_f64.sin();
    let inside = |row: &usize| (points[*row].x - 0.5).abs() < cut;
    assert!(turned.rows.iter().all(|row| !inside(row)));
    // An open mesh has no inside: only its padding removes points.
    let sheet = SelfMesh {
        mesh: Arc::new(mesh(&scene::plane_patch(1.0))),
        cloud_from_link: at(0.5, 0.0, 0.04),
        padding: 0.03,
    };
    let settings = FilterSettings { robot: vec![sheet], ..off() };
    let filtered =
        filter(&PointCloud::from_points(points), &settings, &SensorModel::Exact).unwrap();
    assert_eq!(removed(&filtered.stages, "robot"), 0);
}

/// A box before a wall, seen by a depth camera; and how far each return is from either.
///
/// The box is turned so that no face is within 20 degrees of the rays: steeper ones the veil stage
/// takes for veil, as its settings say.
fn view_with_veils() -> (PointCloud, Vec<f64>) {
    let ahead = |z: f64| Pose::from_translation_rpy(Vector3::new(0.05, 0.02, z), [0.7, 0.7, 0.0]);
    let block = ExactMesh::new(&scene::moved(&scene::cuboid([0.5; 3]), &ahead(1.5)));
    let wall = ExactMesh::new(&scene::moved(&scene::plane_patch(6.0), &at(0.0, 0.0, 2.8)));
    let camera =
        DepthCamera { depth_std: 0.0005, depth_std_growth: 0.0005, ..DepthCamera::default() };
    let cloud = camera.scan(&[&block, &wall], &Pose::identity(), 5);
    let off = |p: &Point3| {
        brute::point_distance(block.mesh(), p).min(brute::point_distance(wall.mesh(), p))
    };
    let distances = cloud.points.iter().map(off).collect();
    (cloud, distances)
}

/// Farther from every surface than eight deviations of the noise (4 mm at the wall): veil.
const VEIL_DISTANCE: f64 = 0.035;

/// How many veil points of a view there are and went, and how many surface points there are and went, given how far each
/// return is from the surfaces in it.
fn count_veil(cloud: &PointCloud, distances: &[f64]) -> [usize; 4] {
    let settings = FilterSettings { veil: Some(VeilSettings::default()), ..off() };
    // Of the wall; the block's is half of it.
    let sensor = SensorModel::Isotropic { std: 0.0044 };
    let filtered = filter(cloud, &settings, &sensor).expect("good settings");
    let mut kept = vec![false; cloud.len()];
    filtered.rows.iter().for_each(|&row| kept[row] = true);
    let mut counts = [0; 4];
    for (distance, kept) in distances.iter().zip(kept) {
        if distance.is_nan() {
            continue;
        }
        let kind = if *distance > VEIL_DISTANCE { 0 } else { 2 };
        counts[kind] += 1;
        counts[kind + 1] += usize::from(!kept);
    }
    let total = removed(&filtered.stages, "veil");
    assert_eq!(total, counts[1] + counts[3], "the count is what went");
    counts
}

#[test]
fn in_an_image_most_veil_points_go_and_hardly_any_surface_point() {
    let (cloud, distances) = view_with_veils();
    let [veil, veil_gone, surface, surface_gone] = count_veil(&cloud, &distances);
    assert!(veil > 50, "only {veil} veil points to find");
    // Measured on this view; see the message for the counts.
    let message = format!("{veil_gone} of {veil} veil, {surface_gone} of {surface} surface points");
    assert!(veil_gone as f64 > 0.8 * veil as f64, "{message}");
    assert!((surface_gone as f64) < 0.01 * surface as f64, "{message}");
}

/// At edges some pixels float and others have no return, side by side: of these veils 54 of 69 points stayed.
#[test]
fn veil_points_beside_pixels_without_return_go_too() {
    let (mut cloud, mut distances) = view_with_veils();
    let (width, _) = cloud.image_size.unwrap();
    let is_veil: Vec<bool> = distances.iter().map(|distance| *distance > VEIL_DISTANCE).collect();
    for (index, by_chance) in (0..cloud.len()).zip(0..) {
        let beside = [index.wrapping_sub(1), index + 1, index.wrapping_sub(width), index + width];
        let at_veil = beside.iter().any(|&other| is_veil.get(other).is_some_and(|&veil| veil));
        let is_lost = seed::unit(seed::derive(8, by_chance, 0)) < 0.6;
        if at_veil && is_lost && !is_veil[index] {
            cloud.points[index] = Point3::new(f64::NAN, f64::NAN, f64::NAN);
            distances[index] = f64::NAN;
        }
    }
    let [veil, veil_gone, surface, surface_gone] = count_veil(&cloud, &distances);
    let message = format!("{veil_gone} of {veil} veil, {surface_gone} of {surface} surface points");
    assert!(veil > 50 && veil_gone as f64 > 0.75 * veil as f64, "{message}");
    assert!((surface_gone as f64) < 0.01 * surface as f64, "{message}");
}

#[test]
fn a_plain_surface_has_no_veil() {
    // A wall seen straight on and one seen at 60 degrees, to within 30 degrees of the rays.
    for tilt in [0.0, 1.05] {
        let pose = Pose::from_translation_rpy(Vector3::new(0.0, 0.0, 2.0), [0.0, tilt, 0.0]);
        let wall = ExactMesh::new(&scene::moved(&scene::plane_patch(10.0), &pose));
        let camera = DepthCamera { veil_probability: 0.0, ..DepthCamera::default() };
        let cloud = camera.scan(&[&wall], &Pose::identity(), 6);
        let settings = FilterSettings { veil: Some(VeilSettings::default()), ..off() };
        // Noise of 9 mm and more against steps of 1.4 cm between pixels: chance makes some that run along the ray.
        let sensor = SensorModel::Stereo { baseline: 1.0, focal_px: 140.0, disparity_std: 0.28 };
        for (sensor, most) in [(SensorModel::Exact, 0.02), (sensor, 5e-4)] {
            let filtered = filter(&cloud, &settings, &sensor).unwrap();
            let share = removed(&filtered.stages, "veil") as f64 / filtered.stages[1].before as f64;
            assert!(share < most, "{share} of a wall at {tilt} rad");
        }
    }
}

#[test]
fn specks_are_outliers_and_a_surface_is_not() {
    let mut points = measured(&scene::plane_patch(0.4), 0.01, 0.001, 1);
    let surface = points.len();
    points.extend((0..5).map(|i| Point3::new(0.1 * f64::from(i) - 0.2, 0.0, 0.3)));
    let settings = FilterSettings { outliers: Some(OutlierSettings::default()), ..off() };
    let filtered =
        filter(&PointCloud::from_points(points), &settings, &SensorModel::Exact).unwrap();
    assert!(filtered.rows.iter().all(|&row| row < surface), "a speck stayed");
    assert_eq!(removed(&filtered.stages, "outliers"), 5, "a surface point went");
}

#[test]
fn a_collision_map_holds_one_point_for_each_occupied_cell() {
    let points = measured(&scene::plane_patch(0.4), 0.002, 0.0, 1);
    let cloud = PointCloud::from_points(points.iter().map(|p| p + Vector3::z() * 0.013).collect());
    let settings = FilterSettings { collision_map: Some(0.02), ..off() };
    let filtered = filter(&cloud, &settings, &SensorModel::Exact).unwrap();
    // 20 by 20 cells, perhaps one more a side where rounding reaches the next.
    let cells = filtered.cloud.len();
    assert!((400..=441).contains(&cells), "{cells} cells");
    assert_eq!(removed(&filtered.stages, "collision map"), cloud.len() - cells);
    assert!(filtered.rows.is_empty());
    // Every point is within half a diagonal of a cell centre.
    let reach = 0.5 * 0.02 * 3.0_f64.sqrt() + 1e-9;
    for p in cloud.points.iter().step_by(37) {
        assert!(filtered.cloud.points.iter().any(|c| (c - p).norm() <= reach), "{p} has no cell");
    }
}

#[test]
fn stages_run_in_order_and_their_counts_add_up() {
    let (mut cloud, _) = view_with_veils();
    cloud.points[7] = cloud.points[8];
    let link = SelfMesh {
        mesh: Arc::new(mesh(&scene::cuboid([0.2; 3]))),
        cloud_from_link: at(0.0, 0.0, 0.2),
        padding: 0.01,
    };
    let settings = FilterSettings {
        min_range: Some(0.1),
        max_range: 4.0,
        drop_duplicates: true,
        robot: vec![link],
        veil: Some(VeilSettings::default()),
        outliers: Some(OutlierSettings::default()),
        collision_map: Some(0.01),
    };
    let filtered = filter(&cloud, &settings, &SensorModel::Exact).unwrap();
    let names: Vec<&str> = filtered.stages.iter().map(|s| s.stage).collect();
    let expected = ["missing", "range", "duplicates", "robot", "veil", "outliers", "collision map"];
    assert_eq!(names, expected);
    let mut left = cloud.len();
    for stage in &filtered.stages {
        assert_eq!(stage.before, left, "{stage:?}");
        left -= stage.removed;
    }
    assert_eq!(left, filtered.cloud.len());
    // A prepared cloud tells the same.
    let settings = CloudSettings { filter: settings, ..CloudSettings::new(SensorModel::Exact) };
    let prepared = Cloud::prepare(&cloud, &settings).unwrap();
    assert_eq!(prepared.filter_stages(), filtered.stages);
    assert_eq!(prepared.len(), left);
}

#[test]
fn nothing_left_is_an_error_that_says_where_the_points_went() {
    let mut points = vec![Point3::from(Vector3::repeat(f64::NAN)); 4];
    points.extend(grid(6));
    let mut settings = CloudSettings::new(SensorModel::Exact);
    settings.filter.min_range = Some(50.0);
    let error = Cloud::prepare(&PointCloud::from_points(points), &settings).unwrap_err();
    assert!(matches!(error, PrepareError::NothingLeft { before: 10, .. }), "{error:?}");
    let text = error.to_string();
    for part in ["10", "missing removed 4", "range removed 6"] {
        assert!(text.contains(part), "`{part}` is not in `{text}`");
    }
    let empty = Cloud::prepare(&PointCloud::default(), &settings).unwrap_err();
    assert!(matches!(empty, PrepareError::NothingLeft { before: 0, .. }), "{empty:?}");
    // It was told to loosen the filter.
    assert_eq!(empty.to_string(), "the cloud has no points: check where it comes from");
}

#[test]
fn bad_settings_are_refused_before_any_point_is_looked_at() {
    let refuse = |settings: FilterSettings| {
        filter(&PointCloud::from_points(grid(10)), &settings, &SensorModel::Exact)
            .expect_err("a bad setting")
    };
    let range = |min, max_range| FilterSettings { min_range: Some(min), max_range, ..off() };
    for settings in [range(-1.0, 2.0), range(2.0, 2.0), range(f64::NAN, 2.0), range(0.0, f64::NAN)]
    {
        assert!(matches!(refuse(settings), FilterError::Range { .. }));
    }
    for padding in [-0.1, f64::NAN, f64::INFINITY] {
        let link = SelfMesh {
            mesh: Arc::new(mesh(&scene::cuboid([0.2; 3]))),
            cloud_from_link: Pose::identity(),
            padding,
        };
        let error = refuse(FilterSettings { robot: vec![link], ..off() });
        assert!(matches!(error, FilterError::Padding { .. }), "{error}");
    }
    // It removed nothing, so that the robot stayed in its scan.
    let link = SelfMesh {
        mesh: Arc::new(mesh(&scene::cuboid([0.2; 3]))),
        cloud_from_link: at(f64::NAN, 0.0, 0.0),
        padding: 0.01,
    };
    let error = refuse(FilterSettings { robot: vec![link], ..off() });
    assert!(matches!(error, FilterError::LinkPose { .. }), "{error}");
    for max_angle in [0.0, -1.0, 2.0, f64::NAN] {
        let error = refuse(FilterSettings { veil: Some(VeilSettings { max_angle }), ..off() });
        assert!(matches!(error, FilterError::VeilAngle { .. }), "{error}");
    }
    for (neighbors, deviations) in [(0, 3.0), (8, f64::NAN), (8, 0.0), (8, -3.0)] {
        let outliers = Some(OutlierSettings { neighbors, deviations });
        let error = refuse(FilterSettings { outliers, ..off() });
        assert!(matches!(error, FilterError::Outliers { .. }), "{error}");
    }
    for resolution in [0.0, -0.01, f64::NAN, f64::INFINITY] {
        let error = refuse(FilterSettings { collision_map: Some(resolution), ..off() });
        assert!(matches!(error, FilterError::Resolution { .. }), "{error}");
    }
    // A cell so small that the grid has no numbers for it.
    let error = refuse(FilterSettings { collision_map: Some(1e-300), ..off() });
    assert!(matches!(error, FilterError::CollisionMap(_)), "{error}");
}

#[test]
fn stages_with_nothing_to_work_on_remove_nothing() {
    let settings = FilterSettings {
        veil: Some(VeilSettings::default()),
        outliers: Some(OutlierSettings::default()),
        ..off()
    };
    for count in [0, 1, 2] {
        let filtered =
            filter(&PointCloud::from_points(grid(count)), &settings, &SensorModel::Exact).unwrap();
        assert_eq!(filtered.cloud.len(), count);
    }
    // Equal points: no distance is larger than any other.
    let same = PointCloud::from_points(vec![Point3::new(0.0, 0.0, 1.0); 30]);
    assert_eq!(filter(&same, &settings, &SensorModel::Exact).unwrap().cloud.len(), 30);
}

#[test]
fn lists_of_different_lengths_are_refused() {
    let refused = |cloud: &PointCloud| filter(cloud, &off(), &SensorModel::Exact).unwrap_err();
    for covariances in [0, 99, 101] {
        let mut cloud = PointCloud::from_points(grid(100));
        cloud.covariances = Some(vec![Covariance::zero(); covariances]);
        assert_eq!(
            refused(&cloud),
            FilterError::Count { what: "covariances", count: covariances, points: 100 }
        );
    }
    for (width, height) in [(20, 4), (0, 0), (usize::MAX, 2)] {
        let mut cloud = PointCloud::from_points(grid(100));
        cloud.image_size = Some((width, height));
        let error = FilterError::ImageSize { points: 100, width, height };
        assert_eq!(refused(&cloud), error);
        let settings = CloudSettings::new(SensorModel::Exact);
        assert_eq!(Cloud::prepare(&cloud, &settings).unwrap_err(), PrepareError::Filter(error));
    }
}
