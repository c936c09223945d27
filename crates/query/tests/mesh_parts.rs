//! Meshes of several parts: what one of them encloses is inside, whatever the others are and however they are
//! turned.

use crate::common::{ask, at, measured, mesh, prepare, query};
use cloudtouch::geom::{Point3, Pose, TriangleMesh, Vector3};
use cloudtouch::{Mesh, Mode, Verdict};
use cloudtouch_testkit::scene;

fn block(size: f64, centre: [f64; 3]) -> TriangleMesh {
    scene::moved(&scene::cuboid([size; 3]), &Pose::from_translation(centre.into()))
}

fn inside_out(mesh: &TriangleMesh) -> TriangleMesh {
    let turned = mesh.triangles().iter().map(|&[a, b, c]| [a, c, b]).collect();
    TriangleMesh::new(mesh.vertices().to_vec(), turned).expect("the same vertices")
}

/// A square floor at a height, its normals up.
fn floor(height: f64) -> TriangleMesh {
    let corners = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]];
    let vertices = corners.map(|[x, y]| Point3::new(x, y, height)).to_vec();
    TriangleMesh::new(vertices, vec![[0, 1, 2], [0, 2, 3]]).expect("a square")
}

/// Verdicts on a small ball, as a cloud and as a mesh, at a place.
fn of_a_ball_at(solid: &Mesh, place: [f64; 3]) -> [Verdict; 2] {
    let ball = scene::sphere(0.03, 2);
    let cloud = prepare(measured(&ball, 0.008, 0.001, 1), 0.001, Mode::Calibrated);
    let [x, y, z] = place;
    let of_cloud = ask(Mode::Calibrated, &cloud, solid, &at(-x, -y, -z));
    let pose = Pose::from_translation(Vector3::from(place));
    let of_mesh = query(Mode::Calibrated).run(solid, &mesh(&ball), &pose).expect("good bodies");
    [of_cloud.verdict, of_mesh.verdict]
}

const COLLIDES: [Verdict; 2] = [Verdict::InCollision; 2];
const FREE: [Verdict; 2] = [Verdict::Free; 2];

/// The floor took half a turn from the inside of what stands on it: it read free there.
#[test]
fn a_floor_takes_nothing_from_the_inside_of_a_box() {
    for turned in [false, true] {
        for height in [0.0, -0.05, -5.0] {
            let floor = if turned { inside_out(&floor(height)) } else { floor(height) };
            let solid = mesh(&scene::assemble([block(0.3, [0.0, 0.0, 0.15]), floor]));
            assert_eq!(of_a_ball_at(&solid, [0.0, 0.0, 0.15]), COLLIDES, "{turned} {height}");
            assert_eq!(of_a_ball_at(&solid, [0.5, 0.0, 0.15]), FREE, "{turned} {height}");
        }
    }
}

/// Of two boxes of which one was mirrored, what is in both read free.
#[test]
fn a_part_turned_inside_out_is_a_cavity_only_within_another() {
    let one = block(0.4, [0.0; 3]);
    for other in [block(0.4, [0.2; 3]), inside_out(&block(0.4, [0.2; 3]))] {
        let solid = mesh(&scene::assemble([one.clone(), other]));
        for place in [[0.1; 3], [0.3; 3], [-0.1; 3]] {
            assert_eq!(of_a_ball_at(&solid, place), COLLIDES, "{place:?}");
        }
        assert_eq!(of_a_ball_at(&solid, [0.7, 0.0, 0.0]), FREE);
    }
    let hollow = mesh(&scene::assemble([one, inside_out(&block(0.3, [0.0; 3]))]));
    assert_eq!(of_a_ball_at(&hollow, [0.0; 3]), FREE);
}

/// A room with its walls turned inward, and a cupboard in it: inside the cupboard it read free.
#[test]
fn a_cupboard_in_a_room_turned_inward_is_full() {
    let room = inside_out(&block(4.0, [0.0; 3]));
    let solid = mesh(&scene::assemble([room, block(0.5, [1.0, 0.0, 0.0])]));
    assert_eq!(of_a_ball_at(&solid, [1.0, 0.0, 0.0]), COLLIDES);
}

/// Faces that do not share vertices, one of them turned round: the middle read free.
#[test]
fn a_box_of_separate_faces_of_which_one_is_turned_is_no_free_space() {
    let whole = scene::cuboid([0.4; 3]);
    for turned in [None, Some(0), Some(3)] {
        let face = |k: usize| {
            let [a, b, c] = whole.triangles()[k];
            // A tenth of a millimetre outward.
            let apart = |i: u32| {
                let p = whole.vertices()[i as usize];
                p + 1e-4 * whole.corners(k).iter().map(|q| q.coords).sum::<Vector3>().normalize()
            };
            let triangle = if turned == Some(k / 2) { [0, 2, 1] } else { [0, 1, 2] };
            TriangleMesh::new([a, b, c].map(apart).to_vec(), vec![triangle]).expect("a triangle")
        };
        let solid = mesh(&scene::assemble((0..12).map(face)));
        for verdict in of_a_ball_at(&solid, [0.02, 0.01, 0.0]) {
            assert_ne!(verdict, Verdict::Free, "{turned:?}");
        }
        assert_eq!(of_a_ball_at(&solid, [0.6, 0.0, 0.0]), FREE, "{turned:?}");
    }
}

/// A part that is written from both sides wrapped around nothing beside any other: what was in it read free.
#[test]
fn a_box_written_from_both_sides_is_full_beside_others() {
    let one = block(0.3, [0.0; 3]);
    let both = scene::assemble([one.clone(), inside_out(&one)]);
    let others = [
        block(0.1, [0.5, 0.0, 0.0]),
        floor(-0.5),
        block(0.2, [0.2, 0.0, 0.0]),
        block(1.0, [0.0; 3]),
    ];
    for (k, other) in others.into_iter().enumerate() {
        let solid = mesh(&scene::assemble([both.clone(), other]));
        assert_eq!(of_a_ball_at(&solid, [-0.02, 0.01, 0.0]), COLLIDES, "{k}");
    }
}

/// Two boxes side by side, the wall between them there once for each.
fn with_a_wall_between() -> TriangleMesh {
    scene::assemble([block(0.4, [-0.2, 0.0, 0.0]), block(0.4, [0.2, 0.0, 0.0])])
}

/// Beside an open part boxes that share a wall had no inside.
#[test]
fn a_floor_takes_nothing_from_the_inside_of_boxes_with_a_wall_between() {
    for boxes in [with_a_wall_between(), inside_out(&with_a_wall_between())] {
        let solid = mesh(&scene::assemble([boxes, floor(-0.5)]));
        for x in [-0.2, 0.2] {
            assert_eq!(of_a_ball_at(&solid, [x, 0.0, 0.05]), COLLIDES, "{x}");
        }
        assert_eq!(of_a_ball_at(&solid, [0.6, 0.0, 0.0]), FREE);
    }
}

/// Boxes that share a wall, turned inside out, took from another box what they had in common: it read free there.
#[test]
fn boxes_with_a_wall_between_that_are_turned_inside_out_take_nothing_from_others() {
    let other = block(0.4, [0.2, 0.15, 0.15]);
    for boxes in [with_a_wall_between(), inside_out(&with_a_wall_between())] {
        let solid = mesh(&scene::assemble([boxes, other.clone()]));
        for place in [[0.2, 0.1, 0.1], [0.2, -0.1, -0.1], [-0.2, 0.1, 0.1]] {
            assert_eq!(of_a_ball_at(&solid, place), COLLIDES, "{place:?}");
        }
    }
}

/// Of a part with many triangles only some were asked whether it is within another: a ball turned inside out that looks
/// out of a box between them was taken for a cavity, and what was in it read free.
#[test]
fn a_part_of_many_triangles_that_looks_out_of_another_is_no_cavity() {
    let centre = [0.1, 0.05, 0.02];
    for turn in [[0.0; 3], [0.3, -0.2, 0.5], [1.1, 0.4, 0.0]] {
        let pose = Pose::from_translation_rpy(centre.into(), turn);
        let ball = inside_out(&scene::moved(&scene::sphere(0.4, 5), &pose));
        let highest = ball.vertices().iter().map(|p| p.z).fold(0.0, f64::max);
        for (deep, expected) in [(1e-4, COLLIDES), (-1e-3, FREE)] {
            let top = Pose::from_translation(Vector3::z() * (highest - deep - 1.0));
            let around = scene::moved(&scene::cuboid([2.0; 3]), &top);
            let solid = mesh(&scene::assemble([around, ball.clone()]));
            assert_eq!(of_a_ball_at(&solid, centre), expected, "{turn:?} {deep}");
        }
    }
}
