//! A simulated depth camera: rays against meshes, noise that grows with depth, veils at edges.

use cloudtouch_geom::{Point3, PointCloud, Pose, Vector3, seed};
use parry3d_f64::query::{Ray, RayCast};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

use crate::exact::{ExactMesh, parry_vector};

/// A pinhole depth camera. Its frame is the optical one: x right, y down, z forward.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepthCamera {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Focal length in pixels; the principal point is the middle of the image.
    pub focal_px: f64,
    /// Depths beyond this give no return, m.
    pub max_depth: f64,
    /// Standard deviation of the depth close by, m.
    pub depth_std: f64,
    /// What is added to that per square metre of depth: std(z) = `depth_std` + this · z², 1/m.
    pub depth_std_growth: f64,
    /// Probability that a pixel at a depth edge returns a point of the veil between both sides.
    pub veil_probability: f64,
    /// A step in depth to a neighbouring pixel that counts as an edge, m.
    pub edge_step: f64,
}

impl Default for DepthCamera {
    /// 160 × 120 pixels over about 60°, 1 mm + 2 mm/m² depth noise, veils at three edge pixels in
    /// ten.
    fn default() -> Self {
        Self {
            width: 160,
            height: 120,
            focal_px: 140.0,
            max_depth: 8.0,
            depth_std: 0.001,
            depth_std_growth: 0.002,
            veil_probability: 0.3,
            edge_step: 0.1,
        }
    }
}

impl DepthCamera {
    /// The standard deviation of a depth of `z` metres, m.
    pub fn std_at(&self, z: f64) -> f64 {
        self.depth_std + self.depth_std_growth * z * z
    }

    /// The direction of a pixel's ray with z = 1, in the camera's frame.
    pub fn ray(&self, column: usize, row: usize) -> Vector3 {
        let offset =
            |pixel: usize, count: usize| (pixel as f64 + 0.5 - 0.5 * count as f64) / self.focal_px;
        Vector3::new(offset(column, self.width), offset(row, self.height), 1.0)
    }

    /// An organised cloud in the camera's frame, NaN where there is no return.
    ///
    /// `world_from_camera` is where the camera stands; the meshes are in the world frame.
    pub fn scan(&self, meshes: &[&ExactMesh], world_from_camera: &Pose, seed: u64) -> PointCloud {
        let depths = self.true_depths(meshes, world_from_camera);
        let mut rng = seed::generator(seed);
        let points = (0..depths.len())
            .map(|i| {
                // Every pixel draws the same numbers whatever it sees, so that a change of one
                // mesh leaves the noise of the other pixels alone.
                let [chance, mix] = [rng.random::<f64>(), rng.random::<f64>()];
                let error: f64 = StandardNormal.sample(&mut rng);
                let mut z = depths[i];
                if let Some(other) = self.depth_across_edge(&depths, i)
                    && chance < self.veil_probability
                {
                    z += mix * (other - z);
                }
                z += error * self.std_at(z);
                // NaN depths pass through the product.
                Point3::from(self.ray(i % self.width, i / self.width) * z)
            })
            .map(|p| if p.z > 0.0 { p } else { Point3::from(Vector3::repeat(f64::NAN)) })
            .collect();
        PointCloud {
            points,
            covariances: None,
            normals: None,
            sensor_pose: Some(Pose::identity()),
            image_size: Some((self.width, self.height)),
        }
    }

    /// Depths along z without noise, row by row, NaN where there is no return, m.
    pub fn true_depths(&self, meshes: &[&ExactMesh], world_from_camera: &Pose) -> Vec<f64> {
        let origin = parry_vector(&world_from_camera.translation());
        (0..self.width * self.height)
            .map(|i| {
                let ray = self.ray(i % self.width, i / self.width);
                let direction = parry_vector(&world_from_camera.transform_vector(&ray));
                meshes
                    .iter()
                    .filter_map(|mesh| {
                        mesh.shape().cast_local_ray(
                            &Ray::new(origin, direction),
                            self.max_depth,
                            false,
                        )
                    })
                    .min_by(f64::total_cmp)
                    // The direction has z = 1, so its multiple is the depth.
                    .unwrap_or(f64::NAN)
            })
            .collect()
    }

    /// The depth of a pixel to the right or below that lies across a depth edge, if any.
    pub(crate) fn depth_across_edge(&self, depths: &[f64], i: usize) -> Option<f64> {
        let right = (!(i + 1).is_multiple_of(self.width)).then_some(i + 1);
        [right, Some(i + self.width)]
            .into_iter()
            .flatten()
            .filter_map(|j| depths.get(j).copied())
            .find(|other| (other - depths[i]).abs() > self.edge_step)
    }
}
