//! What the families' sensors see: points of the surface, noise as stated, fresh for each seed.

use cloudtouch_geom::{Point3, Vector3};
use cloudtouch_testkit::{
    exact::{Touch, brute},
    family::{Family, Observation, Side},
    noise::NoiseKind,
    poses::NEAR,
    surface::{SurfaceSample, sample_surface},
};

const SIDES: [Side; 2] = [Side::A, Side::B];

/// Rows that are on a surface.
fn on_surface(seen: &Observation) -> impl Iterator<Item = (Point3, SurfaceSample)> {
    let rows = seen.cloud.points.iter().zip(&seen.truth);
    rows.filter_map(|(p, truth)| truth.map(|t| (*p, t)))
}

#[test]
fn solids_are_closed() {
    for &family in Family::ALL {
        for seed in [1, 2, 3] {
            let scene = family.scene(seed);
            for mesh in [scene.a.mesh(), scene.b.mesh()] {
                assert_eq!(mesh.open_edges() == 0, scene.touch == Touch::Solids, "{family:?}");
                assert!(mesh.triangles().len() < 2000, "truth would be slow");
            }
        }
    }
}

#[test]
fn parts_of_a_moving_body_keep_out_of_one_another() {
    for &family in Family::ALL {
        for seed in [1, 2, 3] {
            let scene = family.scene(seed);
            if scene.touch == Touch::Surfaces {
                continue;
            }
            for sample in sample_surface(scene.b.mesh(), 300, seed) {
                let wound = |step: f64| {
                    scene.b.winding_number(&(sample.position + sample.normal * step)).round()
                };
                assert_eq!([wound(-1e-5), wound(1e-5)], [1.0, 0.0], "{family:?} {seed}");
            }
        }
    }
}

#[test]
fn what_is_seen_shows_what_is_true() {
    for &family in Family::ALL {
        let scene = family.scene(1);
        let cloud = scene.observe(Side::A, 20_000, NoiseKind::Gaussian, 0.0, 1).cloud;
        let spacing = scene.spacing(Side::A, 20_000);
        for pose in scene.poses(4, 1) {
            let object_from_scene = pose.scene_from_object.inverse();
            let (low, high) = scene.b.mesh().bounding_box().unwrap();
            let points = cloud.points.iter().map(|p| object_from_scene.transform_point(p));
            let reach = pose.signed_distance.max(0.0) + 3.0 * spacing;
            let nearest = points
                .filter(|p| (0..3).all(|k| p[k] > low[k] - reach && p[k] < high[k] + reach))
                .map(|p| brute::point_distance(scene.b.mesh(), &p))
                .fold(f64::INFINITY, f64::min);
            if pose.in_collision {
                assert!(nearest < 3.0 * spacing, "{family:?}: {nearest} in collision");
            } else {
                assert!(nearest > pose.signed_distance - 1e-9, "{family:?}: {nearest}");
                assert!(
                    pose.signed_distance > NEAR || nearest < reach + 0.005,
                    "{family:?}: {nearest} for {}",
                    pose.signed_distance
                );
            }
        }
    }
}

#[test]
fn without_noise_points_are_on_the_surface_with_outward_normals() {
    for &family in Family::ALL {
        let scene = family.scene(4);
        for (side, body) in SIDES.into_iter().zip([&scene.a, &scene.b]) {
            let seen = scene.observe(side, 3000, NoiseKind::Gaussian, 0.0, 5);
            assert_eq!(seen.cloud.len(), seen.truth.len());
            let rows: Vec<_> = on_surface(&seen).collect();
            assert!(rows.len() > 2900, "{family:?}: {}", rows.len());
            let mut outward = 0;
            for (point, truth) in rows.iter().step_by(15) {
                assert_eq!(*point, truth.position);
                assert!((truth.normal.norm() - 1.0).abs() < 1e-12);
                assert!(brute::point_distance(body.mesh(), point) < 1e-9, "{family:?}");
                let step = truth.normal * 1e-4;
                outward +=
                    usize::from(body.contains(&(point - step)) && !body.contains(&(point + step)));
            }
            // Where parts reach into one another, a triangle that is mostly seen has hidden points.
            let checked = rows.len().div_ceil(15);
            let enough = if scene.touch == Touch::Solids { 0.97 * checked as f64 } else { 0.0 };
            assert!(outward as f64 >= enough, "{family:?} {side:?}: {outward} of {checked}");
        }
    }
}

#[test]
fn places_depend_on_the_seed_alone_and_errors_have_the_standard_deviation_asked_for() {
    for &family in Family::ALL {
        let scene = family.scene(2);
        for side in SIDES {
            let observe = |std, seed| scene.observe(side, 4000, NoiseKind::Gaussian, std, seed);
            let seen = observe(0.01, 7);
            assert_eq!(seen.truth, observe(0.0, 7).truth, "{family:?}");
            assert_ne!(seen.truth, observe(0.01, 8).truth, "{family:?}");
            // As text, in which missing returns are equal.
            assert_eq!(format!("{seen:?}"), format!("{:?}", observe(0.01, 7)), "{family:?}");
            // The noise of a depth image has a test of its own.
            if family == Family::Tabletop && side == Side::A {
                continue;
            }
            let errors: Vec<Vector3> = on_surface(&seen).map(|(p, t)| p - t.position).collect();
            let mean_square =
                errors.iter().map(Vector3::norm_squared).sum::<f64>() / (3.0 * errors.len() as f64);
            assert!((mean_square.sqrt() / 0.01 - 1.0).abs() < 0.04, "{family:?}");
            assert_eq!(seen.std, 0.01);
        }
        let [a, b] = SIDES.map(|side| scene.observe(side, 100, NoiseKind::HeavyTailed, 0.02, 1));
        assert_ne!(a.cloud.points[..50], b.cloud.points[..50]);
    }
}

#[test]
fn ten_thousand_points_are_as_far_apart_as_promised() {
    for &family in Family::ALL {
        for seed in 1..=4 {
            let scene = family.scene(seed);
            let [a, b] = SIDES.map(|side| scene.spacing(side, 10_000));
            let [expected_a, expected_b] = match family {
                Family::PianoRoom => [0.032..0.042, 0.015..0.019],
                Family::Tabletop => [0.005..0.01, 0.001..0.003],
                Family::Furniture => [0.025..0.055, 0.015..0.035],
                Family::LivingRoom | Family::Doorway | Family::Staircase => {
                    [0.02..0.035, 0.002..0.015]
                }
                Family::SettingDown => [0.012..0.025, 0.003..0.015],
                Family::Desk
                | Family::Kitchen
                | Family::Workbench
                | Family::BoxesInBin
                | Family::Bookcase => [0.012..0.03, 0.001..0.007],
                _ => [0.012..0.032, 0.01..0.025],
            };
            assert!(expected_a.contains(&a) && expected_b.contains(&b), "{family:?}: {a}, {b}");
        }
    }
}

#[test]
fn neighbours_are_half_the_spacing_away_on_average() {
    for &family in Family::ALL.iter().filter(|&&f| f != Family::Tabletop) {
        let scene = family.scene(1);
        for side in SIDES {
            let points = scene.observe(side, 4000, NoiseKind::Gaussian, 0.0, 3).cloud.points;
            let nearest = |i: usize| {
                let others = points.iter().enumerate().filter(|&(j, _)| j != i);
                others.map(|(_, q)| (points[i] - q).norm()).fold(f64::INFINITY, f64::min)
            };
            let mean = (0..4000).step_by(10).map(nearest).sum::<f64>() / 400.0;
            let ratio = mean / scene.spacing(side, 4000);
            // 0.5 for points thrown at random on a plane; edges and layers change it.
            assert!((0.42..0.6).contains(&ratio), "{family:?} {side:?}: {ratio}");
        }
    }
}

#[test]
fn no_sensor_sees_the_room_from_outside() {
    let scene = Family::PianoRoom.scene(3);
    let (_, high) = scene.a.mesh().bounding_box().unwrap();
    let seen = scene.observe(Side::A, 10_000, NoiseKind::Gaussian, 0.0, 1);
    for (point, truth) in on_surface(&seen) {
        let outer_wall = (0..2)
            .any(|k| point[k].abs() > high[k] - 1e-6 && truth.normal[k] * point[k].signum() > 0.5);
        assert!(!outer_wall && point.z > -0.05, "{point} is outside");
    }
}

#[test]
fn a_depth_image_has_the_points_asked_for_and_the_noise_it_states() {
    for (seed, points) in [(1, 2500), (2, 10_000), (3, 40_000)] {
        let std = 0.02;
        let scene = Family::Tabletop.scene(seed);
        let image = scene.observe(Side::A, points, NoiseKind::Gaussian, std, 9);
        let (width, height) = image.cloud.image_size.unwrap();
        assert_eq!((image.cloud.len(), image.truth.len()), (width * height, width * height));
        let returns = image.cloud.points.iter().filter(|p| p.x.is_finite()).count();
        assert!((returns as f64 / points as f64 - 1.0).abs() < 0.05, "{returns} for {points}");

        let covariances = image.cloud.covariances.as_ref().unwrap();
        let (mut squares, mut count) = (0.0, 0.0);
        for i in 0..image.truth.len() {
            let (point, covariance) = (&image.cloud.points[i], &covariances[i]);
            let Some(truth) = image.truth[i] else { continue };
            // Along the ray, with the share of the depth's square that was asked for.
            assert!(truth.position.coords.cross(&point.coords).norm() < 1e-9);
            let error = (point.z - truth.position.z) / truth.position.z.powi(2);
            squares += (error / std).powi(2);
            count += 1.0;
            let stated = covariance.std_along(&Vector3::z());
            assert!((stated - std * point.z.powi(2)).abs() < 1e-9, "{stated}");
            // Nothing is seen from behind.
            assert!(truth.normal.dot(&truth.position.coords) < 0.0);
        }
        let tolerance = 5.0 / f64::sqrt(2.0 * count);
        assert!((f64::sqrt(squares / count) - 1.0).abs() < tolerance, "{}", squares / count);
        let veils = returns as f64 - count;
        assert!(veils > 5.0 && veils < 0.03 * count, "{veils} veil points");
    }
}
