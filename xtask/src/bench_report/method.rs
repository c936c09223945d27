//! Ours and the peers, asked the same: does the piano, so placed, touch the room?

use anyhow::{Result, anyhow};
use capt::Capt;
use cloudtouch::{Cloud, Query, QuerySettings};
use cloudtouch_geom::{Point3, PointCloud, Pose, TriangleMesh};
use glamx::DPose3;
use parry3d_f64::{
    math::Vector,
    query::intersection_test,
    shape::{Shape, TriMesh, Voxels},
};

use super::{scene::prepare, timing::timed};
use crate::sweep::rivals::{Index, spread};

/// Side of a voxel and radius of a sphere, m.
pub(super) const SIZE: f64 = 0.01;

/// What a method says of a pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Said {
    /// Larger for a more likely collision.
    pub(super) score: f64,
    /// Whether it is one; none of a method that only orders poses.
    pub(super) verdict: Option<bool>,
}

impl Said {
    fn verdict(collides: bool) -> Self {
        Self { score: f64::from(u8::from(collides)), verdict: Some(collides) }
    }
}

type Ask = Box<dyn Fn(&Pose) -> Result<Said>>;

/// A method that was given both bodies.
pub(super) struct Method {
    pub(super) name: &'static str,
    /// Time to prepare both bodies, s.
    pub(super) prepare: f64,
    pub(super) ask: Ask,
}

/// What ours is called, on clouds whose surface was computed beforehand.
pub(super) const OURS: &str = "ours";
/// What it is called on clouds that compute it where they are asked.
pub(super) const LAZY: &str = "ours, not refined";
/// What it is called on refined clouds without the classifier.
pub(super) const GEOMETRY: &str = "ours, geometry alone";
/// The peer that targets name.
pub(super) const MESHES: &str = "parry3d, meshes";
/// The peer on clouds that takes any number of points.
pub(super) const DISTANCE: &str = "kiddo, smallest distance";

/// Two refined clouds in the calibrated mode, all settings at their defaults.
pub(super) fn ours(clouds: [&PointCloud; 2], std: f64) -> Result<Method> {
    let settings = QuerySettings::default();
    prepared(OURS, clouds, settings, |cloud| Ok(prepare(cloud, std)?.refined()?))
}

/// The same without the classifier: no probability is in doubt.
pub(super) fn geometry(clouds: [&PointCloud; 2], std: f64) -> Result<Method> {
    let settings = QuerySettings { doubt: [0.5; 2], ..QuerySettings::default() };
    prepared(GEOMETRY, clouds, settings, |cloud| Ok(prepare(cloud, std)?.refined()?))
}

/// The same of clouds that are not refined.
pub(super) fn lazy(clouds: [&PointCloud; 2], std: f64) -> Result<Method> {
    prepared(LAZY, clouds, QuerySettings::default(), |cloud| prepare(cloud, std))
}

fn prepared(
    name: &'static str,
    [room, piano]: [&PointCloud; 2],
    settings: QuerySettings,
    prepare: impl Fn(&PointCloud) -> Result<Cloud>,
) -> Result<Method> {
    let (bodies, prepare) = timed(|| -> Result<_> { Ok([prepare(room)?, prepare(piano)?]) });
    let [room, piano] = bodies?;
    let query = Query::new(settings)?;
    let ask = move |pose: &Pose| {
        let probability = query.run(&room, &piano, pose)?.collision_probability;
        Ok(Said { score: probability, verdict: Some(probability >= 0.5) })
    };
    Ok(Method { name, prepare, ask: Box::new(ask) })
}

/// The surfaces that the clouds were drawn from, which no sensor knows.
pub(super) fn meshes(meshes: [&TriangleMesh; 2]) -> Result<Method> {
    let (shapes, prepare) = timed(|| meshes.map(shape));
    let [room, piano] = shapes;
    Ok(Method { name: MESHES, prepare, ask: shapes_touch(room?, piano?) })
}

/// Cubes of 1 cm about the points of the room against the surface of the piano.
pub(super) fn voxels(room: &PointCloud, piano: &TriangleMesh) -> Result<Method> {
    let build = || {
        let points: Vec<Vector> = room.points.iter().map(vector).collect();
        (Voxels::from_points(Vector::splat(SIZE), &points), shape(piano))
    };
    let ((voxels, piano), prepare) = timed(build);
    Ok(Method { name: "parry3d, voxels", prepare, ask: shapes_touch(voxels, piano?) })
}

/// The smallest distance between points, each sought no farther than the smallest so far.
pub(super) fn distance([room, piano]: [&PointCloud; 2]) -> Result<Method> {
    let (index, prepare) = timed(|| Index::try_new(&room.points));
    let (index, points) = (index?, piano.points.clone());
    let ask = move |pose: &Pose| {
        let mut smallest = f64::INFINITY;
        for i in spread(points.len()) {
            let moved = pose.transform_point(&points[i]);
            if let Some(found) = index.nearest_within(&moved, smallest) {
                smallest = smallest.min(found.distance);
            }
        }
        Ok(Said { score: -smallest, verdict: None })
    };
    Ok(Method { name: DISTANCE, prepare, ask: Box::new(ask) })
}

/// Balls of 1 cm about the points of the piano against the points of the room, up to the first hit.
pub(super) fn spheres([room, piano]: [&PointCloud; 2]) -> Result<Method> {
    let build = || {
        let points: Vec<[f32; 3]> = room.points.iter().map(single).collect();
        // One lane: more take a nightly compiler.
        Capt::<3>::try_new(&points, (SIZE as f32, SIZE as f32), 1)
    };
    let (tree, prepare) = timed(build);
    let tree = tree.map_err(|error| anyhow!("capt: {error:?}"))?;
    let points = piano.points.clone();
    let ask = move |pose: &Pose| {
        let hits = |i: usize| {
            let moved = pose.transform_point(&points[i]);
            tree.collides(&single(&moved), SIZE as f32)
        };
        Ok(Said::verdict(spread(points.len()).any(hits)))
    };
    Ok(Method { name: "capt, spheres", prepare, ask: Box::new(ask) })
}

fn shapes_touch(a: impl Shape + 'static, b: impl Shape + 'static) -> Ask {
    Box::new(move |pose| {
        let placed = DPose3::from(*pose.isometry());
        let touch = intersection_test(&DPose3::IDENTITY, &a, &placed, &b)
            .map_err(|error| anyhow!("parry: {error}"))?;
        Ok(Said::verdict(touch.intersecting))
    })
}

fn shape(mesh: &TriangleMesh) -> Result<TriMesh> {
    let vertices = mesh.vertices().iter().map(vector).collect();
    TriMesh::new(vertices, mesh.triangles().to_vec()).map_err(|error| anyhow!("parry: {error}"))
}

fn vector(point: &Point3) -> Vector {
    Vector::new(point.x, point.y, point.z)
}

/// Single precision, which that tree is made for.
fn single(point: &Point3) -> [f32; 3] {
    [point.x as f32, point.y as f32, point.z as f32]
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
            meshes([&mesh, &mesh]),
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
