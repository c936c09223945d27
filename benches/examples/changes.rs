//! What a change of a cloud takes beside preparing it anew, in work of all cores together (Linux). Of a room of
//! 171,000 points one in a hundred moves, those nearest to a place that is another each time; the index and the tree
//! are built anew now and then.

use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Mesh, Query, QuerySettings};
use cloudtouch_geom::{Point3, PointCloud, Pose, Vector3, seed};
use cloudtouch_testkit::measured::measured;
use cloudtouch_testkit::scene;

const CHANGES: usize = 30;
const STD: f64 = 0.001;

fn main() {
    for is_refined in [false, true] {
        measure(is_refined);
    }
}

fn measure(is_refined: bool) {
    let mut points = measured(&scene::room(), 0.0302, STD, 1);
    let (mut changed, whole) = worked(|| prepared(&points, is_refined));
    let (mut single, mut rebuilt, mut lost) = (Vec::new(), Vec::new(), 0);
    for k in 0..CHANGES {
        let about = points[(k + 1) * points.len() / (CHANGES + 1)];
        let moves = lifted(&points, &about);
        let (change, work) =
            worked(|| changed.move_points(&moves).expect("indices and places of the cloud"));
        moves.iter().for_each(|(i, place)| points[*i] = *place);
        lost += change.surfaces_lost;
        if change.is_rebuilt { rebuilt.push(work) } else { single.push(work) }
    }
    // Of none 0, which an empty sum is the negative of.
    let mean = |all: &[f64]| all.iter().sum::<f64>() / all.len().max(1) as f64 + 0.0;
    let share = |work: f64| 100.0 * work / whole;
    let all = single.iter().chain(&rebuilt).sum::<f64>() / CHANGES as f64;
    // How much more a search looks at in the end.
    let fresh = prepared(&points, is_refined);
    let looser = visited(&changed, &points) as f64 / visited(&fresh, &points) as f64;
    println!(
        "{} points, {}: made in {:.0} ms; a change {:.0} ms ({:.1} %), {} of {CHANGES} with a rebuild {:.0} ms; \
         all in all {:.1} % a change, {} surfaces computed anew at each, and searches visit {looser:.3} times as many \
         pairs of nodes in the end",
        points.len(),
        if is_refined { "refined" } else { "as prepared" },
        1e3 * whole,
        1e3 * mean(&single),
        share(mean(&single)),
        rebuilt.len(),
        1e3 * mean(&rebuilt),
        share(all),
        lost / CHANGES,
    );
}

fn prepared(points: &[Point3], is_refined: bool) -> Cloud {
    let settings = CloudSettings::new(SensorModel::Isotropic { std: STD });
    let cloud = Cloud::prepare(&PointCloud::from_points(points.to_vec()), &settings);
    let cloud = cloud.expect("a usable cloud");
    if is_refined { cloud.refined().expect("ordinary noise") } else { cloud }
}

/// One point in a hundred, those nearest to a place, each a millimetre higher.
fn lifted(points: &[Point3], about: &Point3) -> Vec<(usize, Point3)> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&i, &j| (points[i] - about).norm().total_cmp(&(points[j] - about).norm()));
    let nearest = order.iter().take(points.len() / 100);
    nearest.map(|&i| (i, points[i] + Vector3::z() * 1e-3)).collect()
}

/// Pairs of nodes that searches visit for a finger at 200 places above points of the cloud.
fn visited(cloud: &Cloud, points: &[Point3]) -> usize {
    let query = Query::new(QuerySettings::default()).expect("default settings");
    let finger = Mesh::prepare(&scene::cuboid([0.05, 0.04, 0.1])).expect("a box");
    let at = |k| points[(seed::unit(seed::derive(5, k, 0)) * points.len() as f64) as usize];
    let poses = (0..200).map(|k| Pose::from_translation(at(k).coords + Vector3::z() * 0.06));
    let asked = poses.map(|pose| query.run(cloud, &finger, &pose).expect("a finite pose"));
    asked.map(|report| report.stats.nodes_visited).sum()
}

/// What something makes, and the work of this process on it, s.
fn worked<T>(make: impl FnOnce() -> T) -> (T, f64) {
    let start = cpu_seconds();
    let made = make();
    (made, cpu_seconds() - start)
}

/// What this process has worked, on all cores and whatever else the machine does, s.
fn cpu_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").expect("a Linux system");
    // Ticks of 10 ms, counted behind the name in brackets.
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or(&stat).split_whitespace().collect();
    [11, 12].map(|field| fields[field].parse::<f64>().expect("a number")).iter().sum::<f64>()
        / 100.0
}
