//! Clouds that the figures are drawn from.

use cloudtouch::noise::SensorModel;
use cloudtouch::{PaperCloudSettings, PaperModel};
use cloudtouch_geom::seed::derive;
use cloudtouch_geom::{PointCloud, TriangleMesh};
use cloudtouch_testkit::noise::{NoiseKind, add_noise};
use cloudtouch_testkit::surface::{positions, sample_surface};

/// Everything random comes from this.
pub(super) const SEED: u64 = 2011;

pub(super) fn by_paper(std: f64, model: PaperModel) -> PaperCloudSettings {
    PaperCloudSettings { model, ..PaperCloudSettings::new(SensorModel::Isotropic { std }) }
}

/// A surface in so many points with normal noise of this standard deviation, m.
pub(super) fn sampled(mesh: &TriangleMesh, points: usize, std: f64, stream: u64) -> PointCloud {
    let exact = positions(&sample_surface(mesh, points, derive(SEED, 1, stream)));
    let seed = derive(SEED, 2, stream);
    PointCloud::from_points(add_noise(&exact, NoiseKind::Gaussian, std, seed))
}
