//! What no pose about a pose exceeds.

use crate::common::{at, measured, uniform};
use cloudtouch::geom::{PointCloud, Pose, TriangleMesh, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Body, Cloud, CloudSettings, Mesh, Query, QuerySettings};
use cloudtouch_testkit::scene;

/// A plate, and how far its corners are from its middle, m.
const PLATE: [f64; 3] = [0.24, 0.2, 0.02];
const RADIUS: f64 = 0.1566;

fn cloud(shape: &TriangleMesh, spacing: f64, std: f64, seed: u64) -> Body {
    let points = PointCloud::from_points(measured(shape, spacing, std, seed));
    let settings = CloudSettings::new(SensorModel::Isotropic { std });
    let fresh = Cloud::prepare(&points, &settings).expect("a good cloud");
    Body::Cloud(fresh.refined().expect("a good cloud"))
}

fn mesh(shape: &TriangleMesh) -> Body {
    Body::from(Mesh::prepare(shape).expect("a good mesh"))
}

/// A turn by an angle about an axis of any length.
fn turn(axis: Vector3, angle: f64) -> Pose {
    let (sin, cos) = (0.5 * angle).sin_cos();
    let [x, y, z] = (axis.normalize() * sin).into();
    Pose::try_from_quaternion(Vector3::zeros(), [cos, x, y, z]).expect("a rotation")
}

/// Poses about one that take no point within the radius (m) farther than `way` metres: the one that lets down a corner
/// of the plate as far as may be, and others.
fn about(pose: &Pose, way: f64, radius: f64, stream: u64) -> impl Iterator<Item = Pose> {
    let corner = turn(Vector3::new(-PLATE[1], PLATE[0], 0.0), way / radius);
    let any = move |index: u64| {
        let draw = |k| 2.0 * uniform(stream + index, k) - 1.0;
        let [axis, shift] = [0, 3].map(|k| Vector3::new(draw(k), draw(k + 1), draw(k + 2)));
        let share = uniform(stream + index, 6);
        let shift = Pose::from_translation(shift.normalize() * (way * (1.0 - share)));
        shift.after(&turn(axis, share * way / radius))
    };
    std::iter::once(corner).chain((0..12).map(any)).map(|near| pose.after(&near))
}

/// Flat faces along one another speak against a collision as a corner as near does not: tilted, a plate was likelier
/// in collision than the margin that it moved by was to be kept.
#[test]
fn no_pose_about_one_is_likelier_than_is_told() {
    let query = Query::new(QuerySettings::default()).unwrap();
    let mut close = 0;
    for (is_mesh, std) in [(true, 0.001), (false, 0.001), (true, 0.0), (false, 0.006)] {
        let plate = scene::cuboid(PLATE);
        let table = cloud(&scene::plane_patch(0.6), 0.012, std, 3);
        let held = if is_mesh { mesh(&plate) } else { cloud(&plate, 0.012, std, 5) };
        for k in 0..30 {
            let way = [0.004, 0.01, 0.03][k as usize % 3];
            let gap = 0.012 * uniform(k, 9) + 1.5 * std;
            let pose = at(0.01, 0.02, 0.5 * PLATE[2] + way + gap);
            let bound = query.bound_around(&table, &held, &pose, way).unwrap();
            for near in about(&pose, way, RADIUS, 100 * k) {
                let found = query.run(&table, &held, &near).unwrap().collision_probability;
                assert!(found <= bound, "{std} {way} {gap}: {found} beyond {bound}");
                close += usize::from(bound < 4.0 * found && bound > 0.001);
            }
        }
    }
    assert!(close > 20, "{close}");
}

/// Between samples surfaces were found to cross that no way brought within two and a half deviations, and a disc of
/// an exact cloud that is turned has fewer of them.
#[test]
fn clouds_crossed_or_turned_within_the_way_were_likelier_in_collision_than_the_bound() {
    let query = Query::new(QuerySettings::default()).unwrap();
    let (cube, plate) = (scene::cuboid([0.06; 3]), scene::cuboid([0.06, 0.06, 0.004]));
    let table = mesh(&scene::plane_patch(0.4));
    let of_cube = |seed| cloud(&cube, 0.005, 0.001, seed);
    let of_plate = cloud(&plate, 0.008, 0.0, 5);
    // A scene, what is held above it at this height without a gap, how far its corners are, a way, between what gaps,
    // and how far it is tilted at most.
    let families = [
        (&of_cube(3), &of_cube(5), 0.06, 0.05197, 0.0013, [0.0015, 0.006], 0.0),
        (&table, &of_cube(5), 0.03, 0.05197, 0.0013, [0.0015, 0.006], 0.0),
        (&table, &of_plate, 0.002, 0.0425, 0.0145, [0.0, 0.04], 0.3),
    ];
    for (number, (scene, held, height, radius, way, [low, high], tilt)) in (0..).zip(families) {
        let mut certified = 0;
        for k in 0..200_u64 {
            let draw = |of: u64| 2.0 * uniform(k, 20 + of) - 1.0;
            let gap = low + (high - low) * uniform(k, 9);
            let tilted = turn(Vector3::new(draw(0), draw(1), draw(2)), tilt * uniform(k, 24));
            let above = at(0.02 * draw(4), 0.02 * draw(5), height + way + gap);
            let pose = above.after(&tilted);
            let bound = query.bound_around(scene, held, &pose, way).unwrap();
            certified += usize::from(bound < 0.1);
            if bound == 1.0 {
                continue;
            }
            // Moved down by all of the way, and turned by all of it.
            for near in 0..24 {
                let draw = |of: u64| 2.0 * uniform(1000 * k + near, of) - 1.0;
                let axis = Vector3::new(draw(0), draw(1), draw(2));
                let down = Vector3::new(0.1 * draw(3), 0.1 * draw(4), -1.0).normalize() * way;
                let near = match near % 2 {
                    0 => pose.after(&turn(axis, way / radius)),
                    _ => Pose::from_translation(down).after(&pose),
                };
                let found = query.run(scene, held, &near).unwrap().collision_probability;
                assert!(found <= bound, "{number} {gap}: {found} beyond {bound}");
            }
        }
        assert!(certified > 2, "{number}: {certified}");
    }
}

#[test]
fn a_way_that_may_close_the_gap_bounds_nothing() {
    let query = Query::new(QuerySettings::default()).unwrap();
    let table = cloud(&scene::plane_patch(0.6), 0.012, 0.001, 3);
    let bound = |way: f64| {
        query.bound_around(&table, &mesh(&scene::cuboid(PLATE)), &at(0.0, 0.0, 0.05), way)
    };
    assert!(bound(0.01).unwrap() < 0.001);
    assert_eq!(bound(0.05).unwrap(), 1.0);
    assert!(bound(-0.01).is_err() && bound(f64::NAN).is_err());
}
