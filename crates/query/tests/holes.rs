//! Pixels without return between a thing and what is behind it: a flank that is seen at a low angle sends none back.

use cloudtouch::geom::{Point3, PointCloud};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Mode, Verdict};
use cloudtouch_testkit::scene;

use crate::common::{at, mesh, query, uniform};

const SIZE: [usize; 2] = [320, 240];
const FOCAL_PX: f64 = 262.0;
const NEAR: f64 = 1.5;

/// A block from `NEAR` on right of a column, and a wall this far away, with so many columns without return before the block.
fn image(column: usize, strip: usize, far: f64) -> Cloud {
    let place = |i: usize| {
        let (x, y) = (i % SIZE[0], i / SIZE[0]);
        let noise = 0.005 * (uniform(i as u64, 0) - 0.5);
        let depth = match x {
            x if x < column => far + noise,
            x if x < column + strip => f64::NAN,
            _ => NEAR + noise,
        };
        let [across, down] =
            [(x, 159.5), (y, 119.5)].map(|(at, middle)| (at as f64 - middle) / FOCAL_PX);
        Point3::new(across * depth, down * depth, depth)
    };
    let points = (0..SIZE[0] * SIZE[1]).map(place).collect();
    let image =
        PointCloud { image_size: Some((SIZE[0], SIZE[1])), ..PointCloud::from_points(points) };
    let sensor = SensorModel::TimeOfFlight { std: 0.001, per_metre: 0.001 };
    Cloud::prepare(&image, &CloudSettings::new(sensor)).expect("a usable image")
}

/// Balls half in the flank of the block that no pixel met read free, as the wall's pixels beside it told.
#[test]
fn a_body_in_a_flank_without_returns_was_seen_through_to_the_wall() {
    for (far, radius) in [(2.0, 0.008), (2.0, 0.015), (3.0, 0.015)] {
        let ball = mesh(&scene::sphere(radius, 2));
        for (column, strip) in [160, 161].into_iter().flat_map(|c| (3..=7).map(move |s| (c, s))) {
            let image = image(column, strip, far);
            let left = |pixels: f64, depth: f64| (pixels - 0.5 - 159.5) / FOCAL_PX * depth;
            let [from, to] = [left((column + strip) as f64, NEAR), left(column as f64, far)];
            let verdict = |k: u64| {
                let depth = NEAR + 0.02 + (far - NEAR - 0.04) * uniform(k, 1);
                let x = from + (to - from) * (depth - NEAR) / (far - NEAR);
                let pose = at(x, 0.4 * (uniform(k, 2) - 0.5), depth);
                query(Mode::Calibrated).run(&image, &ball, &pose).expect("an answer").verdict
            };
            let free = (0..40).filter(|&k| verdict(k) == Verdict::Free).count();
            assert_eq!(free, 0, "{radius} {far}: {strip} columns from {column}");
        }
    }
}

/// Specks in a floor that is seen aslant hide nothing over it.
#[test]
fn what_is_over_specks_of_a_floor_is_free() {
    let place = |i: usize| {
        let (x, y) = (i % SIZE[0], i / SIZE[0]);
        let [across, down] =
            [(x, 159.5), (y, 119.5)].map(|(at, middle)| (at as f64 - middle) / FOCAL_PX);
        // Of a camera that looks down on it.
        let depth = 0.8 / (0.5 + 0.866 * down);
        let is_speck = (x / 3 * 7 + y / 3 * 11) % 13 == 0;
        Point3::new(across * depth, down * depth, if is_speck { f64::NAN } else { depth })
    };
    let points = (0..SIZE[0] * SIZE[1]).map(place).collect();
    let image =
        PointCloud { image_size: Some((SIZE[0], SIZE[1])), ..PointCloud::from_points(points) };
    let sensor = SensorModel::TimeOfFlight { std: 0.001, per_metre: 0.001 };
    let floor = Cloud::prepare(&image, &CloudSettings::new(sensor)).expect("a usable image");
    let ball = mesh(&scene::sphere(0.02, 2));
    let verdict = |over: f64, k: u64| {
        let [across, down] = [uniform(k, 0) - 0.5, 0.6 * (uniform(k, 1) - 0.5)];
        let depth = (0.8 - 0.02 - over) / (0.5 + 0.866 * down);
        let pose = at(across * depth, down * depth, depth);
        query(Mode::Calibrated).run(&floor, &ball, &pose).expect("an answer").verdict
    };
    let free = |over: f64| (0..80).filter(|&k| verdict(over, k) == Verdict::Free).count();
    assert_eq!(free(-0.01), 0);
    assert!(free(0.02) > 76, "{}", free(0.02));
}
