//! Ours and the peers, asked the same: does the piano, so placed, touch the room?

use anyhow::{Result, anyhow};
use capt::Capt;
use cloudtouch::{Cloud, CloudSettings, Mode, Query, QuerySettings, noise::SensorModel};
use cloudtouch_geom::{Point3, PointCloud, Pose, TriangleMesh};
use glamx::DPose3;
use parry3d_f64::{
    math::Vector,
    query::intersection_test,
    shape::{Shape, Voxels},
};

use super::timing::timed;
use crate::methods::{CloudIndex, parry_mesh, spread};

/// Side of a voxel and radius of a sphere, m.
pub(super) const SIZE: f64 = 0.01;
/// What ours is called, on clouds whose surface was computed beforehand.
pub(super) const OURS: &str = "ours";
/// What it is called on clouds that compute it where they are asked.
pub(super) const LAZY: &str = "ours, not refined";
/// The peer that targets name.
pub(super) const MESHES: &str = "parry3d, meshes";
/// The peer on clouds that takes any number of points.
pub(super) const DISTANCE: &str = "kiddo, smallest distance";

/// What a method says of a pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Said {
    /// Larger for a more likely collision.
    pub(super) score: f64,
    /// Whether it is one; none of a method that only orders poses.
    pub(super) verdict: Option<bool>,
}

impl From<bool> for Said {
    fn from(collides: bool) -> Self {
        Self { score: f64::from(u8::from(collides)), verdict: Some(collides) }
    }
}

/// A method that was given both bodies.
pub(super) struct Method {
    pub(super) name: &'static str,
    /// Time to prepare both bodies, s.
    pub(super) prepare: f64,
    pub(super) ask: Box<dyn Fn(&Pose) -> Result<Said>>,
}

impl Method {
    /// Times `prepare`, which makes what is asked.
    fn new<Ask: Fn(&Pose) -> Result<Said> + 'static>(
        name: &'static str,
        prepare: impl FnOnce() -> Result<Ask>,
    ) -> Result<Self> {
        let (ask, prepare) = timed(prepare);
        Ok(Self { name, prepare, ask: Box::new(ask?) })
    }
}

/// A cloud as a query wants it.
pub(super) fn prepare(cloud: &PointCloud, std: f64) -> Result<Cloud> {
    let sensor = SensorModel::Isotropic { std };
    Ok(Cloud::prepare(cloud, &CloudSettings::new(sensor, Mode::Calibrated))?)
}

/// Two refined clouds in the calibrated mode, all settings at their defaults.
pub(super) fn ours(clouds: [&PointCloud; 2], std: f64) -> Result<Method> {
    query(OURS, clouds, QuerySettings::default(), |cloud| Ok(prepare(cloud, std)?.refined()?))
}

/// The same without the classifier: no probability is in doubt.
pub(super) fn geometry(clouds: [&PointCloud; 2], std: f64) -> Result<Method> {
    let settings = QuerySettings { doubt: [0.5; 2], ..QuerySettings::default() };
    let refined = |cloud: &PointCloud| Ok(prepare(cloud, std)?.refined()?);
    query("ours, geometry alone", clouds, settings, refined)
}

/// As ours, of clouds that are not refined.
pub(super) fn lazy(name: &'static str, clouds: [&PointCloud; 2], std: f64) -> Result<Method> {
    query(name, clouds, QuerySettings::default(), |cloud| prepare(cloud, std))
}

fn query(
    name: &'static str,
    [room, piano]: [&PointCloud; 2],
    settings: QuerySettings,
    prepare: impl Fn(&PointCloud) -> Result<Cloud>,
) -> Result<Method> {
    Method::new(name, || {
        let (room, piano, query) = (prepare(room)?, prepare(piano)?, Query::new(settings)?);
        Ok(move |pose: &Pose| {
            let probability = query.run(&room, &piano, pose)?.collision_probability;
            Ok(Said { score: probability, verdict: Some(probability >= 0.5) })
        })
    })
}

/// The surfaces that the clouds were drawn from, which no sensor knows.
pub(super) fn meshes([room, piano]: &[TriangleMesh; 2]) -> Result<Method> {
    Method::new(MESHES, || Ok(shapes_touch(parry_mesh(room)?, parry_mesh(piano)?)))
}

/// Cubes of 1 cm about the points of the room against the surface of the piano.
pub(super) fn voxels(room: &PointCloud, piano: &TriangleMesh) -> Result<Method> {
    Method::new("parry3d, voxels", || {
        let points: Vec<Vector> = room.points.iter().map(|p| Vector::new(p.x, p.y, p.z)).collect();
        let voxels = Voxels::from_points(Vector::splat(SIZE), &points);
        Ok(shapes_touch(voxels, parry_mesh(piano)?))
    })
}

fn shapes_touch(a: impl Shape, b: impl Shape) -> impl Fn(&Pose) -> Result<Said> {
    move |pose| {
        let placed = DPose3::from(*pose.isometry());
        let touch = intersection_test(&DPose3::IDENTITY, &a, &placed, &b)?;
        Ok(touch.intersecting.into())
    }
}

/// The smallest distance between points, each sought no farther than the smallest so far.
pub(super) fn distance([room, piano]: [&PointCloud; 2]) -> Result<Method> {
    let points = piano.points.clone();
    Method::new(DISTANCE, || {
        let index = CloudIndex::new(&room.points)?;
        let score = move |pose: &Pose| -index.distance(&points, pose);
        Ok(move |pose: &Pose| Ok(Said { score: score(pose), verdict: None }))
    })
}

/// Balls of 1 cm about the points of the piano against the points of the room, up to the first hit.
pub(super) fn spheres([room, piano]: [&PointCloud; 2]) -> Result<Method> {
    // Single precision, which that tree is made for.
    let single = |point: &Point3| [point.x, point.y, point.z].map(|v| v as f32);
    let points = piano.points.clone();
    Method::new("capt, spheres", || {
        let entries: Vec<[f32; 3]> = room.points.iter().map(single).collect();
        // One lane: more take a nightly compiler.
        let tree = Capt::<3>::try_new(&entries, (SIZE as f32, SIZE as f32), 1)
            .map_err(|error| anyhow!("capt: {error:?}"))?;
        Ok(move |pose: &Pose| {
            let hit = |p: &Point3| tree.collides(&single(&pose.transform_point(p)), SIZE as f32);
            Ok(spread(&points).any(hit).into())
        })
    })
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Vector3;
    use cloudtouch_testkit::{
        scene::cuboid,
        surface::{positions, sample_surface},
    };

    use super::*;

    #[test]
    fn all_tell_apart_boxes_that_cross_and_boxes_far_apart() {
        let mesh = cuboid([0.4; 3]);
        let cloud = |seed| PointCloud::from_points(positions(&sample_surface(&mesh, 3000, seed)));
        let clouds = [&cloud(1), &cloud(2)];
        let methods = [
            ours(clouds, 0.002),
            geometry(clouds, 0.002),
            lazy(LAZY, clouds, 0.002),
            meshes(&[mesh.clone(), mesh.clone()]),
            voxels(clouds[0], &mesh),
            distance(clouds),
            spheres(clouds),
        ];
        for method in methods {
            let method = method.unwrap();
            let ask = |x: f64| {
                // Turned: nothing lies along the sides of the voxels.
                let offset = Vector3::new(x, 0.11, 0.07);
                let pose = Pose::from_translation_rpy(offset, [0.2, 0.3, 0.4]);
                (method.ask)(&pose).unwrap()
            };
            let (apart, crossing) = (ask(1.0), ask(0.23));
            assert!(crossing.score > apart.score, "{}", method.name);
            if let (Some(apart), Some(crossing)) = (apart.verdict, crossing.verdict) {
                assert!(!apart && crossing, "{}", method.name);
            }
        }
    }
}
