//! Where a piece of surface ends at another face, its covariance does.

use cloudtouch_geom::{Covariance, Point3, Pose, UnitVector3, Vector3, normal, unit};
use cloudtouch_noise::Face;
use proptest::prelude::*;

fn face(place: [f64; 3], normal: Vector3, std: f64) -> Face {
    Face { place: Point3::from(place), normal, across: std * std }
}

/// A wall above a floor that both reach to the edge between them: of the wall three rows, of the floor two.
fn wall_and_floor(std: f64) -> Vec<Face> {
    let columns = || (-2..=2).map(|k| 0.005 * f64::from(k));
    let wall = [0.0025, 0.0075, 0.0125].into_iter();
    let wall = wall.flat_map(|z| columns().map(move |y| face([0.0, y, z], Vector3::x(), std)));
    let floor = [0.0025, 0.0075].into_iter();
    let floor = floor.flat_map(|x| columns().map(move |y| face([x, y, 0.0], Vector3::z(), std)));
    wall.chain(floor).collect()
}

/// Variance of what is normal about `mean`, given that it is above a plane at zero that is known to `std`:
/// by sums over a fine grid.
fn variance_above(mean: f64, variance: f64, std: f64) -> f64 {
    let (mut total, mut first, mut second) = (0.0, 0.0, 0.0);
    for k in -40_000..=40_000 {
        let off = 8.0 * variance.sqrt() * f64::from(k) / 40_000.0;
        let weight = normal::density(off / variance.sqrt()) * normal::cdf((mean + off) / std);
        total += weight;
        first += weight * off;
        second += weight * off * off;
    }
    second / total - (first / total).powi(2)
}

#[test]
fn what_is_left_is_the_variance_of_what_lies_above_the_plane() {
    for std in [0.0002, 0.001, 0.004] {
        let near = wall_and_floor(std);
        for height in [-0.004, 0.0, 0.001, 0.0025, 0.006] {
            let own = face([0.0, 0.0, height], Vector3::x(), std);
            let covariance = Covariance::from_axis(&Vector3::x_axis(), std, 0.002);
            let left = own.cut_off(&covariance, &near).unwrap();
            let expected = variance_above(height, 0.002_f64.powi(2), std);
            let found = left.variance_along(&Vector3::z());
            assert!(
                (found / expected - 1.0).abs() < 1e-6,
                "{std} {height}: {found} for {expected}"
            );
            for kept in [Vector3::x(), Vector3::y()] {
                let [was, is] = [&covariance, &left].map(|all| all.variance_along(&kept));
                assert!((is / was - 1.0).abs() < 1e-12, "{std} {height} {kept}: {is} of {was}");
            }
        }
    }
}

#[test]
fn a_surface_that_goes_on_past_another_does_not_end_there() {
    let near = wall_and_floor(0.0005);
    // As much of the wall is below the floor.
    let below = near.iter().filter(|face| face.normal.x == 1.0).map(|face| {
        let [x, y, z] = face.place.coords.into();
        Face { place: Point3::new(x, y, -z), ..*face }
    });
    let both: Vec<Face> = near.iter().copied().chain(below).collect();
    let own = face([0.0, 0.0, 0.001], Vector3::x(), 0.0005);
    let covariance = Covariance::isotropic(1e-6);
    assert!(own.cut_off(&covariance, &near).is_some());
    assert_eq!(own.cut_off(&covariance, &both), None);
    // Nor one that bends by less than 45 degrees, nor where there is nothing else.
    let bent = near.iter().map(|face| match face.normal.x == 1.0 {
        true => *face,
        false => Face { normal: Vector3::new(0.8, 0.0, 0.6), ..*face },
    });
    assert_eq!(own.cut_off(&covariance, &bent.collect::<Vec<_>>()), None);
    assert_eq!(own.cut_off(&covariance, &[]), None);
}

#[test]
fn at_a_corner_it_ends_at_both_of_the_other_faces() {
    let near = wall_and_floor(0.0002);
    let side = |face: &Face| {
        let [x, y, z] = face.place.coords.into();
        // The floor stood up beside the wall.
        Face { place: Point3::new(x, -0.0125 - z, y.abs()), normal: Vector3::y(), ..*face }
    };
    let sides = near.iter().filter(|face| face.normal.z == 1.0).map(side);
    let near: Vec<Face> = near.iter().copied().chain(sides).collect();
    let own = face([0.0, -0.0115, 0.001], Vector3::x(), 0.0002);
    let left = own.cut_off(&Covariance::isotropic(0.002_f64.powi(2)), &near).unwrap();
    for along in [Vector3::y(), Vector3::z()] {
        let std = left.std_along(&along);
        assert!((0.0011..0.0016).contains(&std), "{along} {std}");
    }
    assert!((left.std_along(&Vector3::x()) - 0.002).abs() < 1e-12);
}

/// Exact faces, and pieces far behind what they end at: no number ends.
#[test]
fn nothing_breaks_where_nothing_is_uncertain() {
    let near = wall_and_floor(0.0);
    for height in [-1e3, -0.01, 0.0, 1e-9, 0.01, 1e3] {
        let own = face([0.0, 0.0, height], Vector3::x(), 0.0);
        for covariance in [Covariance::zero(), Covariance::isotropic(1e-6)] {
            let left = own.cut_off(&covariance, &near).unwrap();
            assert!(left.is_finite(), "{height} {left:?}");
            assert!(left.max_std() <= covariance.max_std() * (1.0 + 1e-9), "{height} {left:?}");
        }
    }
}

fn direction() -> impl Strategy<Value = UnitVector3> {
    prop::array::uniform3(-1.0..1.0_f64)
        .prop_filter_map("no direction", |of| unit(&Vector3::from(of)).ok())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_direction_gains_and_neither_frame_nor_sign_matters(
        near in prop::collection::vec(
            (prop::array::uniform3(-0.01..0.01_f64), direction(), 0.0..0.003_f64), 0..20),
        own in (direction(), 0.0..0.003_f64),
        stds in prop::array::uniform3(1e-4..0.005_f64),
        turn in prop::array::uniform3(-3.0..3.0_f64),
        shift in prop::array::uniform3(-1.0..1.0_f64),
        along in direction(),
    ) {
        let near: Vec<Face> =
            near.into_iter().map(|(place, n, std)| face(place, n.into_inner(), std)).collect();
        let own = face([0.0; 3], own.0.into_inner(), own.1);
        let covariance = Covariance::diagonal(stds.map(|std| std * std));
        let left = own.cut_off(&covariance, &near);
        if let Some(left) = left {
            let [was, is] = [&covariance, &left].map(|all| all.variance_along(&along));
            prop_assert!(is <= was * (1.0 + 1e-9), "{is} of {was}");
        }
        let pose = Pose::from_translation_rpy(Vector3::from(shift), turn);
        let moved = |face: &Face, sign: f64| Face {
            place: pose.transform_point(&face.place),
            normal: pose.transform_vector(&face.normal) * sign,
            ..*face
        };
        let signs = [1.0, -1.0].into_iter().cycle();
        let moved_near: Vec<Face> = near.iter().zip(signs).map(|(f, s)| moved(f, s)).collect();
        let again = moved(&own, -1.0).cut_off(&covariance.rotated(pose.rotation()), &moved_near);
        prop_assert_eq!(left.is_some(), again.is_some());
        if let (Some(left), Some(again)) = (left, again) {
            let off = (left.rotated(pose.rotation()).matrix() - again.matrix()).abs().max();
            prop_assert!(off < 1e-12, "{off}");
        }
    }
}

/// So deep that Φ is told by its tail, of which two terms left less than nothing.
#[test]
fn nothing_was_left_of_what_is_deep_behind_a_plane() {
    let near = wall_and_floor(1e-10);
    let covariance = Covariance::isotropic(1e-12);
    for depth in [29.9, 30.1, 40.0, 1000.0] {
        let own = face([0.0, 0.0, -depth * 1e-6], Vector3::x(), 1e-10);
        let left = own.cut_off(&covariance, &near).unwrap().std_along(&Vector3::z());
        // Of an exponential tail.
        assert!((left * depth / 1e-6 - 1.0).abs() < 0.01, "{left} at {depth}");
    }
}
