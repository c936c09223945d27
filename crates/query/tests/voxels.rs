//! Maps of occupied cells: where in its cells a floor is, nobody knows, and all of its cells are off by as much.

use cloudtouch::geom::{Point3, PointCloud};
use cloudtouch::noise::{SensorModel, quantize_to_grid};
use cloudtouch::{Cloud, CloudSettings, Mode, Verdict};
use cloudtouch_testkit::scene;

use crate::common::{at, mesh, query, uniform};

const CELL: f64 = 0.05;

/// A floor at this height in its cells, from 0 to 1, as a map of cells.
fn map(height: f64) -> Cloud {
    let place = |i: u64, k: u64| 40.0 * CELL * (uniform(i, k) - 0.5);
    let floor = (0..40_000).map(|i| Point3::new(place(i, 0), place(i, 1), height * CELL));
    let cells = quantize_to_grid(&floor.collect::<Vec<_>>(), CELL).expect("cells");
    let settings = CloudSettings::new(SensorModel::Grid { resolution: CELL });
    Cloud::prepare(&PointCloud::from_points(cells), &settings).expect("a usable map")
}

/// Carried 1.5 cm deep into the upper part of cells of 5 cm, boxes read free.
#[test]
fn a_box_in_the_upper_part_of_the_cells_of_a_floor_is_not_free() {
    for height in [0.05, 0.5, 0.75, 0.95] {
        let map = map(height);
        for size in [4.0, 8.0, 16.0].map(|cells| cells * CELL) {
            let held = mesh(&scene::cuboid([size; 3]));
            let verdict = |gap: f64| {
                let pose = at(0.3 * CELL, 0.2 * CELL, height * CELL + 0.5 * size + gap * CELL);
                query(Mode::Calibrated).run(&map, &held, &pose).expect("an answer").verdict
            };
            for depth in [0.05, 0.1, 0.2, 0.3, 0.4, 0.5] {
                let told = verdict(-depth);
                assert_ne!(told, Verdict::Free, "{height} {size}: {depth} cells deep");
            }
            assert_eq!(verdict(-1.0), Verdict::InCollision, "{height} {size}");
            assert_eq!(verdict(1.5), Verdict::Free, "{height} {size}");
        }
    }
}
