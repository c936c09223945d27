//! Samples far off a surface: by chance, as one in some hundreds is, or of a thing there.

use cloudtouch_geom::Point3;
use cloudtouch_noise::Combination;

use crate::common::{isotropic, model, noisy, plane, refine_all};

const SPACING: f64 = 0.005;
/// Standard deviations of the noise, m: small beside the spacing, and as large.
const STDS: [f64; 2] = [0.0005, 0.005];

/// How high samples of a plane come out, in standard deviations, of those that were measured so high and of those
/// that `is_of_thing` picks among all.
fn heights(points: &[Point3], std: f64, is_wanted: impl Fn(&Point3) -> bool) -> Vec<f64> {
    let refined =
        refine_all(&model(Combination::SurfacePosterior), points, &isotropic(std, points));
    let wanted = points.iter().zip(refined).filter(|(point, _)| is_wanted(point));
    wanted.map(|(_, refined)| refined.point.mean.z.abs() / std).collect()
}

/// Two of three of these stayed where they were measured, a speck each that stopped what was well clear of the plane; all
/// did where the noise was less than a quarter of the spacing.
#[test]
fn a_sample_far_off_its_surface_by_chance_is_of_it() {
    for std in STDS {
        let measured = noisy(&plane(1.0, SPACING, 1).points, std, 7);
        let inside = |p: &Point3| p.x.abs() < 0.45 && p.y.abs() < 0.45;
        let heights = heights(&measured, std, |p| inside(p) && p.z.abs() > 3.3 * std);
        let specks = heights.iter().filter(|height| **height > 2.0).count();
        assert!(heights.len() > 20 && 6 * specks < heights.len(), "{specks} of {heights:?}");
    }
}

/// A rod over the plane, thinner than the samples are apart.
#[test]
fn samples_in_a_row_are_of_a_thing() {
    for std in STDS {
        let mut points = plane(0.6, SPACING, 1).points;
        let is_on_rod = |p: &Point3| p.y.abs() < 0.6 * SPACING;
        points.iter_mut().filter(|p| is_on_rod(p)).for_each(|p| p.z = 4.0 * std);
        let measured = noisy(&points, std, 7);
        let heights = heights(&measured, std, |p| p.z > 3.5 * std && p.x.abs() < 0.25);
        let lost = heights.iter().filter(|height| **height < 2.0).count();
        assert!(
            heights.len() > 40 && 20 * lost < heights.len(),
            "{std}: {lost} of {}",
            heights.len()
        );
    }
}
