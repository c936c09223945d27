//! A laser scanner with few rings over a floor: what lies between them, and what a map keeps of them as it moves.

use crate::common::{at, mesh, uniform};
use cloudtouch::geom::{Point3, PointCloud, Pose, Vector3};
use cloudtouch::noise::{Neighborhoods, SensorModel};
use cloudtouch::{Cloud, CloudSettings, Query, QuerySettings, Verdict};
use cloudtouch_testkit::scene;

fn settings() -> CloudSettings {
    CloudSettings::new(SensorModel::Lidar { range_std: 0.01, beam_rad: 0.003 })
}

/// What rings of a scanner over the floor of a hall measure, at these elevations (rad), `steps` each.
fn scan(pose: Pose, elevations: &[f64], steps: usize) -> PointCloud {
    let scanner = pose.translation();
    let seen = |i: usize| {
        let up = elevations[i / steps];
        let round = std::f64::consts::TAU * (i % steps) as f64 / steps as f64;
        let ray = Vector3::new(up.cos() * round.cos(), up.cos() * round.sin(), up.sin());
        let wall = (0..2).map(|k| (9.0 - scanner[k] * ray[k].signum()) / ray[k].abs());
        let floor = if ray.z < 0.0 { scanner.z / -ray.z } else { f64::INFINITY };
        Point3::from(scanner + ray * wall.fold(floor, f64::min))
    };
    let rings = elevations.len();
    let points = (0..rings * steps).map(seen).collect();
    let image_size = Some((steps, rings));
    PointCloud { sensor_pose: Some(pose), image_size, ..PointCloud::from_points(points) }
}

/// What 16 rings 1.5 m above the floor measure.
fn frame(x: f64) -> PointCloud {
    let elevations: Vec<f64> =
        (0..16).map(|ring| f64::to_radians(-15.0 + 2.0 * f64::from(ring))).collect();
    scan(at(x, 0.0, 1.5), &elevations, 720)
}

/// Between two rings, decimetres apart on the floor, what was some centimetres under it counted as seen to be empty:
/// what reached into it there read free.
#[test]
fn nothing_that_reaches_into_the_floor_between_two_rings_is_free() {
    let cloud = Cloud::prepare(&frame(0.0), &settings()).unwrap();
    let held = mesh(&scene::cuboid([0.2; 3]));
    let query = Query::new(QuerySettings::default()).unwrap();
    let free = |depth: f64| {
        let verdict = |k: u64| {
            let (far, round) = (5.7 + 2.0 * uniform(k, 0), std::f64::consts::TAU * uniform(k, 1));
            let pose = at(far * round.cos(), far * round.sin(), 0.1 - depth);
            query.run(&cloud, &held, &pose).unwrap().verdict
        };
        (0..100).filter(|&k| verdict(k) == Verdict::Free).count()
    };
    assert_eq!(free(0.04), 0);
    let above = free(-0.1);
    assert!(above > 90, "{above}");
}

/// A scanner with a third of a degree between the rings in the middle and ten between the lowest.
const UNEVEN: [f64; 32] = [
    15.0, 10.333, 7.0, 4.667, 3.333, 2.333, 1.667, 1.333, 1.0, 0.667, 0.333, 0.0, -0.333, -0.667,
    -1.0, -1.333, -1.667, -2.0, -2.333, -2.667, -3.0, -3.333, -3.667, -4.0, -4.667, -5.333, -6.148,
    -7.254, -8.843, -11.31, -15.639, -25.0,
];

/// Of cubes sunk in a floor, and of others above it, how many are free.
fn free_in_and_over(scan: &PointCloud, far: [f64; 2], size: f64) -> [usize; 2] {
    let cloud = Cloud::prepare(scan, &settings()).expect("a usable scan");
    let cube = mesh(&scene::cuboid([size; 3]));
    let query = Query::new(QuerySettings::default()).expect("good settings");
    [[-0.05, -0.12], [0.04, 0.1]].map(|over: [f64; 2]| {
        let verdict = |k: u64| {
            let far = far[0] + (far[1] - far[0]) * uniform(k, 0);
            let round = std::f64::consts::TAU * uniform(k, 1);
            let over = over[0] + (over[1] - over[0]) * uniform(k, 2);
            let pose = at(far * round.cos(), far * round.sin(), 0.5 * size + over);
            query.run(&cloud, &cube, &pose).expect("an answer").verdict
        };
        (0..200).filter(|&k| verdict(k) == Verdict::Free).count()
    })
}

/// The lines of a cell were those of rings in the middle, or one of two rings at once, and where rings are farther apart
/// than they are in the mean none was found: of 139 cubes 4.6 to 4.8 m away 132 were free.
#[test]
fn rings_that_are_not_even_see_no_more_between_them() {
    let elevations = UNEVEN.map(f64::to_radians);
    // The last are a metre apart there: a small cube over the floor may hit what no ring met.
    for (height, columns, far, size, least) in [
        (1.0, 1024, [4.2, 5.2], 0.25, 180),
        (1.9, 900, [5.5, 7.0], 0.7, 30),
        (1.9, 900, [5.5, 7.0], 0.25, 0),
    ] {
        let told = free_in_and_over(&scan(at(0.0, 0.0, height), &elevations, columns), far, size);
        assert_eq!(told[0], 0, "{height} m, {columns} columns, {size} m: {told:?}");
        assert!(told[1] >= least, "{height} m, {columns} columns, {size} m: {told:?}");
    }
}

/// One row that was written as the origin of the map, on the floor below the scanner, widened its view down to there, and
/// of 519 cubes between two rings 43 were free.
#[test]
fn a_stray_return_below_a_scanner_is_no_ring_of_it() {
    let elevations: Vec<f64> =
        (0..16).map(|ring| f64::to_radians(-25.0 + 2.667 * f64::from(ring))).collect();
    let frame = scan(at(0.0, 0.0, 1.2), &elevations, 512);
    for stray in [Point3::origin(), Point3::new(0.2, 0.0, 0.0), Point3::new(0.0, 0.1, 0.6)] {
        let mut frame = frame.clone();
        frame.points[40] = stray;
        for far in [[0.4, 2.5], [2.6, 4.0]] {
            let told = free_in_and_over(&frame, far, 0.25);
            assert_eq!(told[0], 0, "{stray} {far:?}: {told:?}");
        }
    }
}

/// What a scanner sees that turns no farther than this to either side, rad.
fn sector(of: &PointCloud, to_side: f64) -> PointCloud {
    let (width, height) = of.image_size.unwrap_or_default();
    let round = |column: usize| std::f64::consts::TAU * column as f64 / width as f64;
    let is_in = |column: &usize| round(*column).cos() > to_side.cos();
    // From right to left: what is right of straight ahead comes last in a full turn.
    let columns = (width / 2..width).chain(0..width / 2).filter(is_in).collect::<Vec<_>>();
    let rows = (0..height).flat_map(|row| columns.iter().map(move |column| row * width + column));
    let points = rows.map(|pixel| of.points[pixel]).collect();
    PointCloud { points, image_size: Some((columns.len(), height)), ..of.clone() }
}

/// Where all that it measured is ahead, as of a camera, what is between two rings counted as seen; with `lidar` stated,
/// nothing beside it was free.
#[test]
fn a_scanner_that_looks_ahead_sees_no_more_between_its_rings() {
    let held = mesh(&scene::cuboid([0.2; 3]));
    let query = Query::new(QuerySettings::default()).unwrap();
    for to_side in [0.4, 0.8, 1.3, 2.2] {
        let scan = sector(&frame(0.0), to_side);
        for settings in [settings(), CloudSettings::new(SensorModel::Isotropic { std: 0.01 })] {
            let cloud = Cloud::prepare(&scan, &settings).unwrap();
            let free = |depth: f64| {
                let verdict = |k: u64| {
                    let (far, round) = (5.7 + 2.0 * uniform(k, 0), 0.5 * uniform(k, 1) - 0.25);
                    let pose = at(far * round.cos(), far * round.sin(), 0.1 - depth);
                    query.run(&cloud, &held, &pose).unwrap().verdict
                };
                (0..60).filter(|&k| verdict(k) == Verdict::Free).count()
            };
            let told = [0.04, -0.1].map(free);
            assert!(told[0] == 0 && told[1] >= 55, "{to_side}: {told:?}");
        }
    }
}

/// A scanner that creeps over a floor: each ring took for measured again what the ring before it had measured up to the
/// mean of the steps along and across rings aside, and floor that was swept over was lost.
#[test]
fn rings_that_move_on_leave_what_they_measured() {
    let frames: Vec<PointCloud> = (0..8).map(|k| frame(-1.0 + 0.05 * f64::from(k))).collect();
    let mut map = Cloud::prepare(&frames[0], &settings()).unwrap();
    for frame in &frames[1..] {
        map.replace_frame(frame, &settings()).unwrap();
    }
    let kept = (0..map.len()).map(|i| map.point(i)).collect::<Vec<_>>();
    let kept = Neighborhoods::new(kept).unwrap();
    let measured = frames.iter().flat_map(|frame| &frame.points);
    let floor: Vec<&Point3> = measured.filter(|p| p.z.abs() < 1e-6).collect();
    let is_lost = |p: &&&Point3| kept.nearest_to(p, 1)[0].squared_distance > 0.01;
    let lost = floor.iter().filter(is_lost).count();
    assert!(floor.len() > 20_000 && lost < floor.len() / 100, "{lost} of {}", floor.len());
}

/// Up to a cell and a half past the last of a raster's rows counted as seen, and half of one before the first. With the
/// scanner hung upside down the last is the lowest: what reached into the floor just inside the innermost ring read free.
#[test]
fn nothing_that_reaches_into_the_floor_inside_the_innermost_ring_is_free() {
    let rod = mesh(&scene::cylinder(0.02, 0.4, 24));
    let query = Query::new(QuerySettings::default()).unwrap();
    let elevations: Vec<f64> = (0..32).map(|ring| -0.5 + 1.1 * f64::from(ring) / 31.0).collect();
    let innermost = 1.1 / f64::tan(0.5);
    for roll in [0.0, std::f64::consts::PI] {
        let pose = Pose::from_translation_rpy(Vector3::new(0.0, 0.0, 1.1), [roll, 0.0, 0.0]);
        let cloud = Cloud::prepare(&scan(pose, &elevations, 1800), &settings()).unwrap();
        let verdict = |k: u64| {
            let round = std::f64::consts::TAU * uniform(k, 0);
            // Its surface ends before the ring.
            let far = innermost - 0.021 - 0.3 * uniform(k, 1);
            let pose = at(far * round.cos(), far * round.sin(), 0.2 - 0.03 - 0.06 * uniform(k, 2));
            query.run(&cloud, &rod, &pose).unwrap().verdict
        };
        let free = (0..300).filter(|&k| verdict(k) == Verdict::Free).count();
        assert_eq!(free, 0, "turned by {roll}");
    }
}
