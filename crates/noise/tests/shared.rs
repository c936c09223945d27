//! Noise that is stated and does not scatter neighbours is an error that they share: none of them is known better for how
//! many there are.

use cloudtouch_geom::nalgebra::Rotation3;
use cloudtouch_geom::{Covariance, Point3, Vector3};
use cloudtouch_noise::{Combination, Refined, quantize_to_grid};

use crate::common::{gaussian, isotropic, model, noisy, plane, refine_all};

const CELL: f64 = 0.02;
/// Of a place in a cell, along any axis, m.
const CELL_STD: f64 = 0.288_675_134_594_812_9 * CELL;

fn refined(points: &[Point3], std: f64) -> Vec<Refined> {
    refine_all(&model(Combination::SurfacePosterior), points, &isotropic(std, points))
}

/// Standard deviation along a normal in parts of what was stated, and what is shared, in the mean of all points well
/// inside a square of a metre.
fn told(points: &[Point3], std: f64, normal: Vector3) -> [f64; 2] {
    let inside: Vec<Refined> =
        refined(points, std).into_iter().filter(|r| r.point.mean.coords.norm() < 0.3).collect();
    let along = |covariance: &Covariance| covariance.std_along(&normal) / std;
    let mean =
        |of: &dyn Fn(&Refined) -> f64| inside.iter().map(of).sum::<f64>() / inside.len() as f64;
    [mean(&|r| along(&r.point.covariance)), mean(&|r| r.shared)]
}

/// A wall along the grid was known to a sixth of a cell, however far off the middle of its cells it is.
#[test]
fn cells_of_a_wall_along_them_are_all_off_by_as_much() {
    let wall: Vec<Point3> =
        plane(1.0, 0.004, 1).points.iter().map(|p| p + Vector3::z() * 0.95 * CELL).collect();
    let [std, shared] = told(&quantize_to_grid(&wall, CELL).unwrap(), CELL_STD, Vector3::z());
    assert!((0.95..=1.001).contains(&std) && shared > 0.9, "{std} {shared}");
}

/// Cells of one aslant lie on both sides of it.
#[test]
fn cells_of_a_wall_aslant_are_off_each_by_its_own() {
    let turn = Rotation3::from_euler_angles(0.5, 0.4, 0.0);
    let wall: Vec<Point3> = plane(1.0, 0.004, 1).points.iter().map(|p| turn * p).collect();
    let cells = quantize_to_grid(&wall, CELL).unwrap();
    let [_, shared] = told(&cells, CELL_STD, turn * Vector3::z());
    assert!(shared < 0.15, "{shared}");
}

#[test]
fn noise_that_is_there_is_shared_by_none() {
    for (spacing, std) in
        [(0.02, 0.0001), (0.02, 0.0007), (0.02, 0.002), (0.02, 0.01), (0.02, 0.02), (0.01, 0.02)]
    {
        let points = noisy(&plane(1.0, spacing, 1).points, std, 7);
        let sharing = refined(&points, std).iter().filter(|r| r.shared > 0.0).count();
        let most = points.len() / 100;
        assert!(sharing <= most, "{spacing} {std}: {sharing} of {}", points.len());
    }
}

/// As a camera's that smooths what it measures.
#[test]
fn noise_in_waves_longer_than_the_neighbourhood_is_shared() {
    const SPACING: f64 = 0.005;
    const STD: f64 = 0.004;
    let waves: Vec<[Vector3; 2]> =
        (0..40).map(|k| [gaussian(3, k) * 8.0, gaussian(4, k) * 3.0]).collect();
    let bent = |p: &Point3| {
        let of = |[way, phase]: &[Vector3; 2]| (way.dot(&p.coords) + phase.x).sin();
        p + Vector3::z() * STD * waves.iter().map(of).sum::<f64>() / 20.0_f64.sqrt()
    };
    let points: Vec<Point3> = plane(1.0, SPACING, 1).points.iter().map(bent).collect();
    let [std, shared] = told(&points, STD, Vector3::z());
    assert!(std > 0.9 && shared > 0.8, "{std} {shared}");
}
