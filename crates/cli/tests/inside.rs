//! Points inside of a closed mesh are among those that pictures and tables tell.
#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use crate::support::Inputs;

/// x, y, z and probability of the points of a table.
fn rows(inputs: &Inputs, name: &str) -> Vec<[f64; 4]> {
    let text = std::fs::read_to_string(inputs.path(name)).unwrap();
    let row = |line: &str| {
        let mut cells = line.split(',').skip(2).map(|cell| cell.parse().unwrap());
        std::array::from_fn(|_| cells.next().unwrap())
    };
    text.lines().skip(1).map(row).collect()
}

/// They touch nothing, and in a box that stood deep in a floor none of them was red.
#[test]
fn a_table_said_nothing_of_points_inside_of_a_box() {
    let inputs = Inputs::new();
    let run = inputs.query_at(0.02, &["--csv=scene.csv"]);
    assert_eq!(run.code(), 0, "{}", run.stderr());
    let turned = ["query", "box.obj", "floor.pcd", "--object-sensor=iso:0.002"];
    let up = ["--translate=-0.01,-0.02,-0.02", "--csv=object.csv"];
    let run = inputs.run(&[&turned[..], &up].concat());
    assert_eq!(run.code(), 0, "{}", run.stderr());
    for name in ["scene.csv", "object.csv"] {
        let shift = if name == "scene.csv" { [0.01, 0.02, 0.02] } else { [0.0; 3] };
        let (mut inside, mut outside) = (0, 0);
        for [x, y, z, probability] in rows(&inputs, name) {
            let depth =
                [x, y, z].into_iter().zip(shift).map(|(v, s): (f64, f64)| 0.1 - (v - s).abs());
            let depth = depth.fold(f64::INFINITY, f64::min);
            if depth > 0.01 {
                inside += 1;
                assert!(probability > 0.99, "{name}: {probability} at {x}, {y}");
            } else if depth < -0.1 {
                outside += 1;
                assert!(probability < 0.1, "{name}: {probability} at {x}, {y}");
            }
        }
        assert!(inside > 5 && outside > 50, "{name}: {inside} and {outside}");
    }
}
