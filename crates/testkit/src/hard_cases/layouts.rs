//! Few points, equal points, and points in a line, a plane or a grid.

use cloudtouch_geom::{Point3, Vector3};

use super::case::{HardCase, patch};

pub(super) fn few_points() -> Vec<HardCase> {
    let one = |z: f64| vec![Point3::new(0.0, 0.0, z)];
    vec![
        HardCase::new("both-empty", "no points to take a mean of", vec![], vec![]),
        HardCase::new("empty-and-patch", "one class is missing", vec![], patch(0.0, 100, 1)),
        HardCase::new("two-points", "one point a side: no spacing, no normal", one(0.0), one(0.05))
            .collides(false),
        HardCase::new(
            "two-equal-points",
            "two equal points a side: a split leaves everything in one half",
            [one(0.0), one(0.0)].concat(),
            [one(0.05), one(0.05)].concat(),
        )
        .collides(false),
        HardCase::new("equal-points", "distance zero, no direction", one(0.0), one(0.0)),
        HardCase::new(
            "point-and-patch",
            "classes of very different size",
            one(0.05),
            patch(0.0, 100, 1),
        )
        .collides(false),
        HardCase::new(
            "point-and-100000",
            "balance of classes, cost of a tree",
            one(0.05),
            patch(0.0, 100_000, 1),
        )
        .collides(false),
    ]
}

/// Without extent in some direction, or with far too much.
pub(super) fn flat() -> Vec<HardCase> {
    let line =
        |y: f64| (0..50).map(|i| Point3::new(0.004 * f64::from(i), y, 0.0)).collect::<Vec<_>>();
    let strip = |z: f64| {
        let at = |i: u32| Point3::new(0.5 * f64::from(i), 1e-3 * f64::from(i % 2), z);
        (0..2000).map(at).collect::<Vec<_>>()
    };
    let patch_points = patch(0.0, 100, 1);
    let beside = patch_points.iter().map(|p| p + Vector3::x() * 0.25).collect();
    let mut with_outlier = patch(0.05, 100, 2);
    with_outlier.push(Point3::new(1e6, 0.0, 0.0));
    vec![
        HardCase::new(
            "all-equal",
            "boxes, spacing and spread are zero; a split never ends",
            vec![Point3::origin(); 50],
            vec![Point3::new(0.0, 0.0, 0.05); 50],
        )
        .collides(false),
        HardCase::new(
            "collinear",
            "two directions without spread; normals undefined",
            line(0.0),
            line(0.05),
        )
        .collides(false),
        HardCase::new(
            "coplanar",
            "both clouds in one plane, side by side",
            patch_points.clone(),
            beside,
        )
        .collides(false),
        HardCase::new(
            "far-outlier",
            "one point a thousand kilometres away: a box around it has no room for the rest",
            patch_points,
            with_outlier,
        )
        .collides(false),
        HardCase::new(
            "slivers",
            "strips a kilometre long, a millimetre wide, 5 cm apart",
            strip(0.0),
            strip(0.05),
        )
        .collides(false),
    ]
}

/// The same points, or the same coordinates, again and again.
pub(super) fn repeated() -> Vec<HardCase> {
    let tenfold = |z: f64| [patch(z, 20, 1).as_slice()].repeat(10).concat();
    let patch_points = patch(0.0, 100, 1);
    let every_third = patch_points.iter().step_by(3).copied().collect();
    let grid: Vec<Point3> = (0..4000)
        .map(|i| {
            Point3::new(
                0.01 * f64::from(i % 20),
                0.01 * f64::from(i / 20 % 20),
                0.01 * f64::from(i / 400),
            )
        })
        .collect();
    let above = grid.iter().map(|p| p + Vector3::z() * 0.15).collect();
    vec![
        HardCase::new(
            "duplicates",
            "every point ten times: k neighbours at distance zero",
            tenfold(0.0),
            tenfold(0.05),
        )
        .collides(false),
        HardCase::new(
            "identical",
            "labels contradict each other at every point",
            patch_points.clone(),
            patch_points.clone(),
        )
        .collides(true),
        HardCase::new(
            "subset",
            "one cloud is every third point of the other",
            patch_points,
            every_third,
        )
        .collides(true),
        HardCase::new(
            "grid-1cm",
            "thousands of points share each coordinate: ties everywhere",
            grid,
            above,
        )
        .collides(false),
    ]
}
