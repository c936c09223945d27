//! Who answers: ours, and what it is compared with.
//!
//! A method is prepared once for a draw of a scene and then asked at many poses, as a planner does.

mod balls;
mod distance;
mod fitted;
mod ours;
mod paper;
mod shapes;

use anyhow::Result;
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, FilterSettings, filter};
use cloudtouch_geom::{PointCloud, Pose, TriangleMesh};
use cloudtouch_testkit::family::Observation;
use cloudtouch_testkit::noise::{NoiseKind, add_noise};
use cloudtouch_testkit::surface::{positions, sample_surface};

pub use balls::Balls;
pub use distance::Distance;
pub use fitted::Fitted;
pub use ours::Ours;
pub use paper::Paper;
pub use shapes::{Boxes, ExactMeshes};

use crate::answers::{Pair, Said};

/// What there is to see of the two bodies of a draw.
#[derive(Clone, Copy)]
pub struct Draw<'a> {
    /// Name of the family, so that no method is judged with constants fitted on it.
    pub family: &'a str,
    /// The body that stays.
    pub a: &'a Observation,
    /// The moving body as it was observed, for [`Pair::CloudCloud`].
    pub b: &'a Observation,
    /// The moving body as it is, for [`Pair::CloudMesh`].
    pub mesh: &'a TriangleMesh,
}

/// A way to tell whether two bodies collide.
pub trait Method: Sync {
    /// Its name in tables.
    fn name(&self) -> String;

    /// Everything that does not depend on the pose.
    ///
    /// # Errors
    /// When the observations cannot be used.
    fn prepare(&self, draw: &Draw<'_>) -> Result<Prepared>;
}

/// What a method that knows the two bodies says of a pose of the moving body (`a_from_b`); `None` when
/// it does not answer for such a pair. It fails where it should not, which a sweep does not excuse.
pub type Prepared = Box<dyn Fn(Pair, &Pose) -> Result<Option<Said>>>;

/// So many points of a surface with noise of this standard deviation (m), of which nothing else is known;
/// the places and the errors follow from a seed each.
pub fn sampled(mesh: &TriangleMesh, points: usize, std: f64, seeds: [u64; 2]) -> Observation {
    let exact = positions(&sample_surface(mesh, points, seeds[0]));
    let noisy = add_noise(&exact, NoiseKind::Gaussian, std, seeds[1]);
    Observation { cloud: PointCloud::from_points(noisy), truth: Vec::new(), std }
}

/// An observation prepared as the noise that it says it has wants it.
pub fn prepared(observation: &Observation) -> Result<Cloud> {
    Ok(Cloud::prepare(&observation.cloud, &CloudSettings::new(sensor_of(observation)))?)
}

/// How noisy an observation says it is.
pub fn sensor_of(observation: &Observation) -> SensorModel {
    match &observation.cloud.covariances {
        Some(_) => SensorModel::PerPoint,
        None => SensorModel::Isotropic { std: observation.std },
    }
}

/// The cloud as ours cleans it: rows without a return are left out.
fn cleaned(observation: &Observation) -> Result<PointCloud> {
    let sensor = sensor_of(observation);
    Ok(filter(&observation.cloud, &FilterSettings::for_sensor(&sensor), &sensor)?.cloud)
}
