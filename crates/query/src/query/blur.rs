//! How blurred the samples of two bodies are: what their judge goes by.

use crate::body::BodyRef;

/// Noise over spacing, both in the median of a body, of two bodies together. One number of a pair, so that
/// it adds no jump along a path, and a cloud of which a part is denser is judged as a whole. Ratios above 2 count
/// only as far as the scatter of the points confirms them.
pub(crate) fn noise_over_spacing((a, b): (BodyRef<'_>, BodyRef<'_>)) -> f64 {
    of(a).hypot(of(b))
}

/// Beyond this, samples are so dense that many are near by chance, if they scatter by as much as is stated.
const DENSE: f64 = 2.0;

/// None of a mesh, and of what has no neighbours.
fn of(body: BodyRef<'_>) -> f64 {
    match body {
        BodyRef::Mesh(_) => 0.0,
        BodyRef::Cloud(cloud) => {
            let makeup = cloud.prepared().makeup();
            let stated = if makeup.spacing > 0.0 { makeup.std / makeup.spacing } else { 0.0 };
            // Noise that is stated and not there makes no cloud denser than it is sharp.
            if stated > DENSE {
                DENSE + cloud.prepared().shows_noise() * (stated - DENSE)
            } else {
                stated
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::PointCloud;
    use cloudtouch_noise::SensorModel;
    use cloudtouch_testkit::noise::{NoiseKind, add_noise};
    use cloudtouch_testkit::{scene, surface};

    use super::*;
    use crate::cloud::{Cloud, CloudSettings};

    /// Of a sheet of a metre with so many samples, which has this noise, of which is said that.
    fn of_sheet(count: usize, is: f64, said: f64) -> f64 {
        let sheet = scene::plane_patch(1.0);
        let samples = surface::positions(&surface::sample_surface(&sheet, count, 3));
        let points = PointCloud::from_points(add_noise(&samples, NoiseKind::Gaussian, is, 4));
        let settings = CloudSettings::new(SensorModel::Isotropic { std: said });
        of(BodyRef::from(&Cloud::prepare(&points, &settings).expect("a good cloud")))
    }

    #[test]
    fn only_noise_that_shows_makes_a_cloud_denser_than_sharp() {
        let dense = of_sheet(100_000, 0.05, 0.05);
        assert!(dense > 3.0, "{dense}");
        let overstated = of_sheet(10_000, 0.002, 0.05);
        assert!((overstated - DENSE).abs() < 0.3, "{overstated}");
        let sharp = of_sheet(10_000, 0.005, 0.005);
        assert!((0.3..0.8).contains(&sharp), "{sharp}");
    }
}
