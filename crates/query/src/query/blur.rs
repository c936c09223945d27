//! How blurred the samples of two bodies are: what their judge goes by.

use crate::body::BodyRef;
use crate::judge::Blur;

/// Noise over spacing, both in the median of a body, of two bodies together. Of a pair, so that it adds no jump along
/// a path, and a cloud of which a part is denser is judged as a whole.
pub(crate) fn blur((a, b): (BodyRef<'_>, BodyRef<'_>)) -> Blur {
    let (a, b) = (of(a), of(b));
    Blur { noise: a.noise.hypot(b.noise), scatter: a.scatter.hypot(b.scatter) }
}

/// Beyond this, samples are so dense that some are near by chance, if they scatter by as much as is stated.
const SHARP: f64 = 0.5;
/// Where points are too few to tell, that counts no further than this.
const UNKNOWN: f64 = 2.0;

/// None of a mesh, and of what has no neighbours.
fn of(body: BodyRef<'_>) -> Blur {
    match body {
        BodyRef::Mesh(_) => Blur::shown(0.0),
        BodyRef::Cloud(cloud) => {
            let makeup = cloud.prepared().makeup();
            let noise = if makeup.spacing > 0.0 { makeup.std / makeup.spacing } else { 0.0 };
            if noise <= SHARP {
                return Blur::shown(noise);
            }
            // Noise that is not there, or that neighbours share, brings none of many near by chance.
            let scatter = match cloud.prepared().shows_noise() {
                Some(shows) => SHARP + shows * (noise - SHARP),
                None => noise.min(UNKNOWN),
            };
            Blur { noise, scatter }
        }
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Point3, PointCloud};
    use cloudtouch_noise::SensorModel;
    use cloudtouch_testkit::noise::{NoiseKind, add_noise};
    use cloudtouch_testkit::{scene, surface};

    use super::*;
    use crate::cloud::{Cloud, CloudSettings};

    fn stated(points: Vec<Point3>, std: f64) -> Blur {
        let settings = CloudSettings::new(SensorModel::Isotropic { std });
        let cloud = Cloud::prepare(&PointCloud::from_points(points), &settings);
        of(BodyRef::from(&cloud.expect("a good cloud")))
    }

    /// Of a sheet of a metre with so many samples, which has this noise, of which is said that.
    fn of_sheet(count: usize, is: f64, said: f64) -> Blur {
        let sheet = scene::plane_patch(1.0);
        let samples = surface::positions(&surface::sample_surface(&sheet, count, 3));
        stated(add_noise(&samples, NoiseKind::Gaussian, is, 4), said)
    }

    #[test]
    fn noise_that_shows_counts_in_full() {
        for (count, std, least) in
            [(100_000, 0.05, 3.0), (40_000, 0.01, 1.2), (40_000, 0.005, 0.6), (10_000, 0.005, 0.3)]
        {
            let blur = of_sheet(count, std, std);
            assert!(blur.noise > least && blur.scatter == blur.noise, "{blur:?}");
        }
    }

    #[test]
    fn noise_that_points_do_not_scatter_by_counts_no_further_than_that_of_sharp_ones() {
        for (count, is, said) in [
            (10_000, 0.002, 0.05),
            (40_000, 0.0002, 0.01),
            (40_000, 0.0, 0.01),
            (40_000, 0.0, 0.05),
        ] {
            let blur = of_sheet(count, is, said);
            assert!(blur.noise > 1.5 && blur.scatter < SHARP + 0.1, "{blur:?}");
        }
    }

    /// All that are a step of the disparity apart are off by as much to the same side.
    #[test]
    fn neither_does_what_was_rounded_to_steps() {
        let slope = |i: u64| {
            let [x, y] = [i % 200, i / 200].map(|k| 0.005 * k as f64);
            let step = 0.03;
            Point3::new(x, y, ((0.1 * x + 0.02 * y) / step).round() * step)
        };
        let blur = stated((0..40_000).map(slope).collect(), 0.03 / 12.0_f64.sqrt());
        assert!(blur.noise > 1.0 && blur.scatter < SHARP + 0.1, "{blur:?}");
    }

    #[test]
    fn points_too_few_to_tell_are_taken_at_their_word() {
        let places = (0..11).map(|i| Point3::new(0.01 * f64::from(i), 0.0, 0.0));
        let few = stated(places.collect(), 0.03);
        assert!(few.noise > SHARP && few.scatter == few.noise, "{few:?}");
    }
}
