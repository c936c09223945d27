//! A cloud that a camera keeps up to date: it forgets what it sees through, and does not grow for ever.
#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::common::{at, mesh, uniform};
use cloudtouch::geom::{Covariance, Point3, PointCloud, Pose, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{
    Cloud, CloudSettings, FilterSettings, Judge, Query, QuerySettings, SelfMesh, Undecided, Verdict,
};
use cloudtouch_testkit::camera::DepthCamera;
use cloudtouch_testkit::exact::ExactMesh;
use cloudtouch_testkit::scene;

fn camera() -> DepthCamera {
    DepthCamera { width: 48, height: 36, focal_px: 42.0, ..DepthCamera::default() }
}

fn settings() -> CloudSettings {
    CloudSettings::new(SensorModel::Kinect)
}

/// What a camera sees of the meshes from its place, in their frame.
fn frame(meshes: &[&ExactMesh], place: &Pose, seed: u64) -> PointCloud {
    camera().scan(meshes, place, seed).transformed(place)
}

fn wall() -> ExactMesh {
    ExactMesh::new(&scene::moved(&scene::plane_patch(6.0), &at(0.0, 0.0, 2.5)))
}

fn block() -> ExactMesh {
    ExactMesh::new(&scene::moved(&scene::cuboid([0.5; 3]), &at(0.0, 0.0, 1.5)))
}

fn count(cloud: &Cloud, is_wanted: impl Fn(&Point3) -> bool) -> usize {
    (0..cloud.len()).filter(|&index| is_wanted(&cloud.point(index))).count()
}

/// On the block, or behind it on the wall.
fn is_of_block(p: &Point3) -> bool {
    p.x.abs() < 0.3 && p.y.abs() < 0.3 && p.z < 2.0
}

fn is_hidden(p: &Point3) -> bool {
    p.x.abs() < 0.35 && p.y.abs() < 0.35 && p.z > 2.0
}

/// What the robot holds, and has in its model, is let go. Where it was in the frame before counted as seen.
#[test]
fn a_parcel_that_the_robot_put_down_read_free_inside() {
    let floor = ExactMesh::new(&scene::moved(&scene::plane_patch(6.0), &at(0.0, 0.0, 2.0)));
    let (size, there, here) = ([0.3; 3], at(0.0, 0.0, 1.848), Pose::identity());
    let parcel = ExactMesh::new(&scene::moved(&scene::cuboid(size), &there));
    let by = CloudSettings::new(SensorModel::Isotropic { std: 0.01 });
    let mut held = by.clone();
    let mesh_of = Arc::new(mesh(&scene::cuboid(size)));
    held.filter.robot = vec![SelfMesh { mesh: mesh_of, cloud_from_link: there, padding: 0.03 }];
    let scan = |seed| frame(&[&floor, &parcel], &here, seed);
    let mut cloud = Cloud::prepare(&scan(3), &held).unwrap();
    let ball = mesh(&scene::sphere(0.03, 3));
    let query = Query::new(QuerySettings::default()).unwrap();
    for seed in 30..34 {
        cloud.replace_frame(&scan(seed), &by).unwrap();
        for [x, y, z] in [[0.0, 0.0, 1.83], [0.08, -0.04, 1.88], [-0.08, 0.08, 1.93]] {
            let report = query.run(&cloud, &ball, &at(x, y, z)).unwrap();
            assert_eq!(report.verdict, Verdict::Undecided, "{seed} {x} {y} {z}: {report:?}");
        }
    }
}

/// Behind itself nothing is known to have come since.
#[test]
fn a_robot_that_moved_toward_the_camera_may_go_back() {
    let floor = ExactMesh::new(&scene::moved(&scene::plane_patch(6.0), &at(0.0, 0.0, 2.0)));
    let (size, here) = ([0.3; 3], Pose::identity());
    let (before, after) = (at(0.0, 0.0, 1.7), at(0.0, 0.0, 1.1));
    let frame_of = |place: &Pose, seed| {
        let link = ExactMesh::new(&scene::moved(&scene::cuboid(size), place));
        let mut by = CloudSettings::new(SensorModel::Isotropic { std: 0.01 });
        let mesh = Arc::new(mesh(&scene::cuboid(size)));
        by.filter.robot = vec![SelfMesh { mesh, cloud_from_link: *place, padding: 0.03 }];
        (frame(&[&floor, &link], &here, seed), by)
    };
    let ((first, by), (second, by_second)) = (frame_of(&before, 3), frame_of(&after, 4));
    let mut cloud = Cloud::prepare(&first, &by).unwrap();
    cloud.replace_frame(&second, &by_second).unwrap();
    let query = Query::new(QuerySettings::default()).unwrap();
    let report = query.run(&cloud, &mesh(&scene::cuboid(size)), &before).unwrap();
    let unseen = report.unseen.expect("an image").share();
    assert!(unseen < 0.01 && report.verdict != Verdict::Undecided, "{report:?}");
}

#[test]
fn what_the_camera_sees_through_goes_and_what_is_hidden_stays() {
    let (wall, block, here) = (wall(), block(), Pose::identity());
    let by = settings();
    let mut cloud = Cloud::prepare(&frame(&[&wall], &here, 1), &by).unwrap();
    let hidden = count(&cloud, is_hidden);
    assert!(hidden > 50 && count(&cloud, is_of_block) == 0);
    // The block comes: it is there, and the wall behind it still is.
    let change = cloud.replace_frame(&frame(&[&wall, &block], &here, 2), &by).unwrap();
    let on_block = count(&cloud, is_of_block);
    assert!(on_block > 200, "{on_block}");
    assert_eq!(count(&cloud, is_hidden), hidden);
    assert!(change.removed > 0 && change.inserted > change.removed, "{change:?}");
    // It goes again: nothing of it is left.
    cloud.replace_frame(&frame(&[&wall], &here, 3), &by).unwrap();
    assert_eq!(count(&cloud, is_of_block), 0);
    let query = Query::new(QuerySettings::default()).unwrap();
    let ball = mesh(&scene::sphere(0.08, 2));
    let report = query.run(&cloud, &ball, &at(0.0, 0.0, 1.4)).unwrap();
    assert_eq!(report.verdict, Verdict::Free, "{report:?}");
    // Behind the camera nothing was ever seen.
    let report = query.run(&cloud, &ball, &at(0.0, 0.0, -0.5)).unwrap();
    assert_eq!(report.undecided_by, Some(Undecided::Unseen));
}

/// All its points go and come with each frame: every second was patched in place, at twice the cost of a rebuild.
#[test]
fn frames_of_a_camera_that_stands_still_were_patched_point_by_point() {
    let (wall, here, by) = (wall(), Pose::identity(), settings());
    let mut cloud = Cloud::prepare(&frame(&[&wall], &here, 1), &by).unwrap();
    for seed in 2..6 {
        let change = cloud.replace_frame(&frame(&[&wall], &here, seed), &by).unwrap();
        assert!(change.is_rebuilt && 2 * change.removed > cloud.len(), "{seed}: {change:?}");
    }
    // A few are no reason.
    let few: Vec<usize> = (0..cloud.len() / 4).collect();
    assert!(!cloud.remove(&few).unwrap().is_rebuilt);
}

/// What an older frame saw to be empty is known, as long as the frame is remembered.
#[test]
fn space_seen_from_elsewhere_counts_as_seen() {
    let wall = wall();
    let by = settings();
    let aside = Pose::from_translation_rpy(Vector3::new(-2.0, 0.0, 0.0), [0.0; 3]);
    let mut cloud = Cloud::prepare(&frame(&[&wall], &aside, 1), &by).unwrap();
    cloud.replace_frame(&frame(&[&wall], &Pose::identity(), 2), &by).unwrap();
    let query = Query::new(QuerySettings::default()).unwrap();
    let ball = mesh(&scene::sphere(0.08, 2));
    let report = query.run(&cloud, &ball, &at(-2.0, 0.0, 1.0)).unwrap();
    assert_eq!(report.verdict, Verdict::Free, "{report:?}");
    for seed in 3..40 {
        cloud.replace_frame(&frame(&[&wall], &Pose::identity(), seed), &by).unwrap();
    }
    let report = query.run(&cloud, &ball, &at(-2.0, 0.0, 1.0)).unwrap();
    assert_eq!(report.undecided_by, Some(Undecided::Unseen));
}

/// Frames from before a thing was put down say nothing of what is within it and behind it: its inside read free for as
/// long as one of them was remembered.
#[test]
fn what_is_behind_a_thing_that_came_is_not_known_by_frames_from_before() {
    let (wall, block) = (wall(), block());
    let by = settings();
    // A camera that moves to the right and turns to the left as it goes.
    let here = |k: u64| {
        let aside = Vector3::new(0.02 * k as f64, 0.0, 0.0);
        Pose::from_translation_rpy(aside, [0.0, -0.01 * k as f64, 0.0])
    };
    let mut cloud = Cloud::prepare(&frame(&[&wall], &here(0), 1), &by).unwrap();
    let query = Query::new(QuerySettings::default()).unwrap();
    let ball = mesh(&scene::sphere(0.08, 2));
    let asked = |cloud: &Cloud, x: f64, z: f64| query.run(cloud, &ball, &at(x, 0.0, z)).unwrap();
    for k in 1..4 {
        cloud.replace_frame(&frame(&[&wall], &here(k), k), &by).unwrap();
    }
    assert_eq!(asked(&cloud, 0.0, 1.5).verdict, Verdict::Free);
    for k in 4..9 {
        cloud.replace_frame(&frame(&[&wall, &block], &here(k), k), &by).unwrap();
        for z in [1.5, 1.9] {
            let report = asked(&cloud, 0.0, z);
            assert_eq!(report.undecided_by, Some(Undecided::Unseen), "{k}, {z}: {report:?}");
        }
        // Beside it nothing is hidden, and it is no reason to forget what was seen to be empty.
        assert_eq!(asked(&cloud, -0.6, 1.5).verdict, Verdict::Free, "{k}");
    }
    cloud.replace_frame(&frame(&[&wall], &here(9), 9), &by).unwrap();
    assert_eq!(asked(&cloud, 0.0, 1.5).verdict, Verdict::Free);
}

/// From elsewhere it is hidden by what was always there: then a frame from before the thing came told that there was
/// nothing, within the thing too.
#[test]
fn a_thing_that_came_was_forgotten_where_something_old_hides_it_from_the_last_frame() {
    let (wall, block) = (wall(), block());
    let by = settings();
    // Beside the view of the camera that looks ahead, and before what came as the one from the side sees it.
    let old = ExactMesh::new(&scene::moved(&scene::cuboid([0.5; 3]), &at(1.5, 0.0, 1.0)));
    let side = Vector3::new(3.0, 0.0, 0.1);
    let turn = (-side.x).atan2(1.9 - side.z);
    let aside = Pose::from_translation_rpy(side, [0.0, turn, 0.0]);
    let here = Pose::identity();
    let mut cloud = Cloud::prepare(&frame(&[&wall, &old], &here, 1), &by).unwrap();
    let query = Query::new(QuerySettings::default()).unwrap();
    let ball = mesh(&scene::sphere(0.08, 2));
    let asked = |cloud: &Cloud, z: f64| query.run(cloud, &ball, &at(0.0, 0.0, z)).unwrap();
    let all = [&wall, &old, &block];
    for (place, seed) in [(&here, 2), (&aside, 3)] {
        cloud.replace_frame(&frame(&all, place, seed), &by).unwrap();
        for z in [1.5, 1.9] {
            let report = asked(&cloud, z);
            assert_eq!(report.undecided_by, Some(Undecided::Unseen), "{seed}, {z}: {report:?}");
        }
    }
}

/// The robot's own arm comes and goes; what earlier frames saw where it is now is still there.
#[test]
fn what_is_behind_the_robot_is_known_by_frames_from_before() {
    let (wall, block) = (wall(), block());
    let mut by = settings();
    let mut cloud = Cloud::prepare(&frame(&[&wall], &Pose::identity(), 1), &by).unwrap();
    let link = Arc::new(mesh(&scene::cuboid([0.5; 3])));
    let cloud_from_link = at(0.0, 0.0, 1.5);
    by.filter.robot = vec![SelfMesh { mesh: link, cloud_from_link, padding: 0.05 }];
    let query = Query::new(QuerySettings::default()).unwrap();
    let ball = mesh(&scene::sphere(0.08, 2));
    for k in 2..5 {
        cloud.replace_frame(&frame(&[&wall, &block], &Pose::identity(), k), &by).unwrap();
        let report = query.run(&cloud, &ball, &at(0.0, 0.0, 2.0)).unwrap();
        assert_eq!(report.verdict, Verdict::Free, "{k}: {report:?}");
    }
}

#[test]
fn a_camera_that_keeps_still_adds_nothing_for_ever() {
    let (wall, block) = (wall(), block());
    let by = settings();
    let image = |seed| frame(&[&wall, &block], &Pose::identity(), seed);
    let mut cloud = Cloud::prepare(&image(0), &by).unwrap();
    let first = cloud.len();
    for seed in 1..60 {
        cloud.replace_frame(&image(seed), &by).unwrap();
    }
    assert!(cloud.len() * 10 < first * 12, "{first} points at first, {} now", cloud.len());
}

/// Where the camera is at a frame of a walk about a room at 10 frames a second, one round in four seconds.
fn place(k: u64) -> Pose {
    let turn = std::f64::consts::TAU * k as f64 / 40.0;
    // Level, and looking along its way: z forward, y down.
    let level =
        Pose::from_translation_rpy(Vector3::zeros(), [-std::f64::consts::FRAC_PI_2, 0.0, 0.0]);
    let way = Pose::from_translation_rpy(
        Vector3::new(1.2 * turn.cos(), 0.9 * turn.sin(), 1.3),
        [0.0, 0.0, turn],
    );
    way.after(&level)
}

/// A walk about a room: the cloud at its end, how many points it had at each frame, and how often its tree was
/// built anew.
struct Walk {
    room: ExactMesh,
    cloud: Cloud,
    counts: Vec<usize>,
    rebuilds: usize,
}

impl Walk {
    fn of(frames: u64) -> Self {
        let room = ExactMesh::new(&scene::room());
        let by = settings();
        let mut cloud = Cloud::prepare(&frame(&[&room], &place(0), 0), &by).unwrap();
        let (mut counts, mut rebuilds) = (vec![cloud.len()], 0);
        for k in 1..frames {
            let change = cloud.replace_frame(&frame(&[&room], &place(k), k), &by).unwrap();
            rebuilds += usize::from(change.is_rebuilt);
            counts.push(cloud.len());
        }
        Self { room, cloud, counts, rebuilds }
    }

    /// A cloud prepared from the points that there are at the end, each with the noise it was seen with, and
    /// from others.
    fn fresh(&self, others: &[Point3]) -> Cloud {
        let pixels = camera().width * camera().height;
        let mut seen: BTreeMap<usize, PointCloud> = BTreeMap::new();
        let covariances = self.cloud.rows().iter().map(|row| {
            let (k, pixel) = (row / pixels, row % pixels);
            let image =
                seen.entry(k).or_insert_with(|| frame(&[&self.room], &place(k as u64), k as u64));
            let alone = PointCloud {
                points: vec![image.points[pixel]],
                sensor_pose: image.sensor_pose,
                ..PointCloud::default()
            };
            SensorModel::Kinect.covariances(&alone).unwrap()[0]
        });
        let exact = others.iter().map(|_| Covariance::isotropic(1e-6));
        let covariances = covariances.chain(exact).collect();
        let own = (0..self.cloud.len()).map(|index| self.cloud.point(index));
        let points = own.chain(others.iter().copied()).collect();
        let scan = PointCloud { covariances: Some(covariances), ..PointCloud::from_points(points) };
        let by = CloudSettings {
            filter: FilterSettings::default(),
            ..CloudSettings::new(SensorModel::PerPoint)
        };
        let fresh = Cloud::prepare(&scan, &by).unwrap();
        assert_eq!(fresh.len(), self.cloud.len() + others.len());
        fresh
    }

    /// How far probabilities by geometry are from those of a fresh cloud, all over the room: of this cloud, and
    /// of a fresh one with a few points far off, whose tree is cut elsewhere.
    fn apart(&self) -> [Apart; 2] {
        let settings = QuerySettings {
            judge: Judge::default().without_classifier(),
            stop_above: 1.0,
            ..QuerySettings::default()
        };
        let (query, ball) = (Query::new(settings).unwrap(), mesh(&scene::sphere(0.15, 2)));
        let far = [-4.0, 4.0].map(|side| Point3::new(side, 0.3 * side, 0.5 * side));
        let [fresh, other] = [self.fresh(&[]), self.fresh(&far)];
        let of = |cloud: &Cloud, k: u64| {
            let draw = |n| uniform(7, 3 * k + n);
            let pose = at(5.0 * draw(0) - 2.5, 4.0 * draw(1) - 2.0, 2.6 * draw(2));
            query.run(cloud, &ball, &pose).unwrap().collision_probability
        };
        [&self.cloud, &other]
            .map(|cloud| Apart((0..1000).map(|k| (of(cloud, k) - of(&fresh, k)).abs()).collect()))
    }
}

/// Differences of probabilities.
struct Apart(Vec<f64>);

impl Apart {
    fn within(&self, most: f64) -> f64 {
        self.0.iter().filter(|apart| **apart <= most).count() as f64 / self.0.len() as f64
    }

    fn mean(&self) -> f64 {
        self.0.iter().sum::<f64>() / self.0.len() as f64
    }

    fn print(&self, what: &str) {
        let (mean, worst) = (self.mean(), self.0.iter().copied().fold(0.0, f64::max));
        let [rounding, a_thousandth, a_hundredth] =
            [1e-9, 1e-3, 1e-2].map(|most| self.within(most));
        println!(
            "{what}: {rounding:.3} up to rounding, {a_thousandth:.3} within .001, {a_hundredth:.3} within .01; mean {mean:.5}, worst {worst:.3}"
        );
    }
}

/// The largest number of points in a round.
fn most(counts: &[usize]) -> usize {
    counts.iter().copied().max().unwrap()
}

/// What changes in place leave is of the size of what a few points far off do to a fresh cloud; built anew, nothing
/// differs.
fn answers_as_a_fresh_cloud(mut walk: Walk) {
    let [changed, other] = walk.apart();
    changed.print("changed and fresh");
    other.print("fresh with points far off and fresh");
    assert!(changed.within(1e-3) > 0.9 && changed.mean() < 0.003, "mean {}", changed.mean());
    walk.cloud.rebuild().unwrap();
    let [rebuilt, _] = walk.apart();
    rebuilt.print("rebuilt and fresh");
    assert!(rebuilt.within(1e-9) == 1.0);
}

#[test]
fn a_camera_that_walks_about_a_room_has_seen_it_after_some_rounds() {
    let walk = Walk::of(120);
    let [second, third] = [most(&walk.counts[40..80]), most(&walk.counts[80..])];
    println!("at most {second} points in the second round, {third} in the third");
    assert!(third * 100 < second * 115, "{second} and {third}");
    // The tree is built anew when as many points came or went as there are, not at each frame.
    assert!((1..40).contains(&walk.rebuilds), "{} rebuilds", walk.rebuilds);
    answers_as_a_fresh_cloud(walk);
}

/// `cargo test --release -p cloudtouch --test suite frames:: -- --ignored --nocapture`.
#[test]
#[ignore = "takes minutes"]
fn ten_minutes_of_frames_take_no_more_memory_than_one() {
    let start = std::time::Instant::now();
    let walk = Walk::of(6000);
    let rounds: Vec<usize> = walk.counts.chunks(600).map(most).collect();
    let pages = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
    println!(
        "6000 frames in {:.0} s; pages of memory at the end: {pages}",
        start.elapsed().as_secs_f64()
    );
    println!("most points minute by minute: {rounds:?}; {} rebuilds", walk.rebuilds);
    assert!(rounds[9] * 100 < rounds[1] * 110, "{rounds:?}");
    answers_as_a_fresh_cloud(walk);
}
