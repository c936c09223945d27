//! What speaks against believing that a pair is free, whatever the evidence says: what the bodies are
//! like, and how they lie to one another.

use cloudtouch_geom::{Point3, Pose};

use crate::cloud::{Clumps, Makeup, Overstated, Prepared, SensorDoubt};
use crate::doubt::safeguards::Safeguards;
use crate::doubt::taken::taken_for_robot;
use crate::doubt::unseen::Unseen;
use crate::doubt::warning::{Warning, Which};
use crate::placement::box_gap;
use crate::shape::{Shape, TURNED};

/// No body is so many times as large as the other, ...
const LARGEST_RATIO: f64 = 1000.0;
/// ... and no object as its scene, where there is nothing else, ...
const LARGEST_OBJECT_RATIO: f64 = 120.0;
/// ... or among many bodies as another.
const LARGEST_RATIO_AMONG_MANY: f64 = 200.0;
/// Meshes seldom say their unit. In metres none is so large, m, that is an object, or ...
const LARGE_MESH: f64 = 100.0;
/// ... a scene beside a body so many times smaller, ...
const LARGE_MESH_RATIO: f64 = 100.0;
/// ... and no object is, m, ...
const LARGE_OBJECT: f64 = 20.0;
/// ... in a scene so many times smaller.
const LARGE_OBJECT_RATIO: f64 = 3.0;
/// No side of a box is so small a part of its diagonal but of a floor, a wall, or what is like these.
const FLAT: f64 = 0.05;
/// Surroundings are larger than what moves in them; an inch is so many centimetres, nearly.
const EXCHANGED_RATIO: f64 = 3.0;
/// The same of two meshes.
const EXCHANGED_MESHES_RATIO: f64 = 20.0;
/// An object is not so many sizes of the larger body away from it, ...
const FARTHEST_SIZES: f64 = 40.0;
/// ... nor so far, m, and this many. A pose given in millimetres is, unless the object lies within 2 cm of the scene's
/// origin, or a hundredth of that size.
const FAR: [f64; 2] = [20.0, 8.0];
/// Coordinates of a mesh are not this part of either body apart, ...
const COARSE: f64 = 0.02;
/// ... nor those of a cloud, whose points scatter anyway, ...
const COARSE_CLOUD: f64 = 0.1;
/// ... and beside a body no farther away than so many steps, ...
const NEAR_STEPS: f64 = 2.0;
/// ... which rounding by this part of a step in the mean tells apart from the noise.
const ROUNDING_STD: f64 = 0.289;
/// Noise beyond this part of the other body had better be there: its fingers are a tenth of it.
const LARGE_NOISE: f64 = 0.05;

/// The warnings about a pair, gravest first. `a_from_b` maps local frames; the two may be all there is, a
/// scene and an object in it, or two of many.
pub(crate) fn doubts(
    (a, b): (Shape<'_>, Shape<'_>),
    a_from_b: Option<&Pose>,
    unseen: Option<&Unseen>,
    are_alone: bool,
    limits: &Safeguards,
) -> Vec<Warning> {
    let bodies = [(Which::A, a, b), (Which::B, b, a)];
    let middles = a_from_b.map(|a_from_b| {
        [a_from_b.transform_point(&b.middle()), a_from_b.inverse().transform_point(&a.middle())]
    });
    let mut warnings: Vec<Warning> =
        bodies.into_iter().flat_map(|(body, shape, _)| of_surface(body, shape, limits)).collect();
    let smaller = a.size().min(b.size());
    let gap = a_from_b.map(|a_from_b| box_gap(a, b, a_from_b));
    let sizes = (smaller, gap.unwrap_or(0.0));
    warnings.extend(bodies.into_iter().filter_map(|(body, shape, _)| coarse(body, shape, sizes)));
    warnings.extend(units((a, b), are_alone));
    warnings.extend(bodies.into_iter().filter_map(|(body, shape, other)| match shape {
        Shape::Cloud(cloud) => {
            scale(body, cloud, other, middles.map(|of_other| of_other[body as usize]))
        }
        Shape::Mesh(_) => None,
    }));
    warnings.extend(bodies.into_iter().flat_map(|(body, shape, _)| of_sensor(body, shape)));
    warnings.extend(exchanged(a, b).filter(|_| are_alone));
    warnings.extend(a_from_b.zip(gap).and_then(|(a_from_b, gap)| apart((a, b), a_from_b, gap)));
    warnings.extend(unseen.and_then(|unseen| limits.exceeded_by(unseen)));
    warnings.extend(a_from_b.and_then(|a_from_b| taken_for_robot((a, b), a_from_b, 0.0, limits)));
    warnings
}

/// Coordinates that are farther apart than they should be, beside a body of such a size and so far away, m.
fn coarse(body: Which, shape: Shape<'_>, (smaller, gap): (f64, f64)) -> Option<Warning> {
    let is_coarse = |step: &f64| match shape {
        Shape::Mesh(_) => *step > COARSE * smaller,
        Shape::Cloud(cloud) => {
            let is_noise = ROUNDING_STD * step <= cloud.makeup().std;
            *step > COARSE_CLOUD * smaller || !is_noise && gap <= NEAR_STEPS * step
        }
    };
    let step = match shape {
        Shape::Mesh(mesh) => mesh.rounded_to(),
        Shape::Cloud(cloud) => cloud.makeup().step,
    };
    let step_m = step.filter(is_coarse)?;
    Some(Warning::Rounded { body, step_m })
}

/// What is to be said of a body by itself, whatever it is asked with; `body` is what it may be among others.
pub(crate) fn of_body(body: Which, shape: Shape<'_>, limits: &Safeguards) -> Vec<Warning> {
    of_surface(body, shape, limits).chain(of_sensor(body, shape)).collect()
}

/// Whether its points or triangles span a surface and are all there.
fn of_surface(body: Which, shape: Shape<'_>, limits: &Safeguards) -> impl Iterator<Item = Warning> {
    let (points, missing) = match shape {
        Shape::Mesh(mesh) => ((!mesh.has_area()).then(|| 3 * mesh.triangle_count()), 0.0),
        Shape::Cloud(cloud) => {
            let Makeup { is_line, distinct, missing, .. } = *cloud.makeup();
            (is_line.then_some(distinct), missing)
        }
    };
    let none = points.map(|points| Warning::NoSurface { body, points });
    let missed =
        (missing > limits.max_missing).then_some(Warning::Missing { body, share: missing });
    none.into_iter().chain(missed)
}

/// How its points lie, and whether its sensor can have seen them; nothing of a mesh.
fn of_sensor(body: Which, shape: Shape<'_>) -> impl Iterator<Item = Warning> {
    let cloud = match shape {
        Shape::Cloud(cloud) => Some(cloud),
        Shape::Mesh(_) => None,
    };
    cloud.into_iter().flat_map(move |cloud| {
        let makeup = cloud.makeup();
        let clumps = makeup.clumps.map(|Clumps { across, apart }| Warning::Clumps {
            body,
            across_m: across,
            apart_m: apart,
        });
        let elsewhere = cloud.robot_passed().map(|share| Warning::RobotElsewhere { body, share });
        clumps.into_iter().chain(elsewhere).chain(sensors(body, makeup))
    })
}

fn units((a, b): (Shape<'_>, Shape<'_>), are_alone: bool) -> Option<Warning> {
    let of = |body, shape: Shape<'_>, other: Shape<'_>| {
        let (size_m, other_size_m) = (shape.core_size(), other.core_size());
        let is_mesh = matches!(shape, Shape::Mesh(_));
        let is_object = body == Which::B;
        let is_beside_cloud = !are_alone && matches!(other, Shape::Cloud(_));
        let ratio_of_object =
            if are_alone { LARGEST_OBJECT_RATIO } else { LARGEST_RATIO_AMONG_MANY };
        let too_large = [
            (true, 0.0, LARGEST_RATIO),
            (is_object, 0.0, ratio_of_object),
            (is_mesh, LARGE_MESH, LARGE_MESH_RATIO),
            (is_mesh && is_object, LARGE_MESH, 0.0),
            (is_mesh && is_object, LARGE_OBJECT, LARGE_OBJECT_RATIO),
            (is_beside_cloud && is_large_object(shape), LARGE_OBJECT, LARGE_OBJECT_RATIO),
        ];
        let is_beyond = |&(is_one, size, ratio): &(bool, f64, f64)| {
            is_one && size_m > size && size_m > ratio * other_size_m
        };
        // A single point has no size; another warning tells of it.
        let is_suspicious = other_size_m > 0.0 && too_large.iter().any(is_beyond);
        is_suspicious.then_some(Warning::Units { body, size_m, other_size_m })
    };
    of(Which::A, a, b).or_else(|| of(Which::B, b, a))
}

/// Whether a mesh is larger than objects are and not flat, as floors and walls are: among many bodies it may be what moves,
/// though it is the larger one.
pub(crate) fn is_large_object(shape: Shape<'_>) -> bool {
    let [low, high] = shape.corners();
    let (size, thickness) = (shape.size(), (high - low).min());
    matches!(shape, Shape::Mesh(_)) && size > LARGE_OBJECT && thickness >= FLAT * size
}

/// Points too far apart, or too noisy, to tell of a body of such a size, m, with its middle there: most of them
/// and those nearest to it too. What is far behind it is both, and says nothing about what is beside it.
fn scale(
    body: Which,
    cloud: &Prepared,
    other: Shape<'_>,
    middle_of_other: Option<Point3>,
) -> Option<Warning> {
    let Makeup { spacing, std, .. } = *cloud.makeup();
    let (size, finest) = (other.size(), spacing.max(std));
    // PERF: no box is wider than its turned one by more than that; mostly it is far larger.
    let may_be_coarse = size < coarse_beside(Shape::Cloud(cloud));
    let other_size_m = if may_be_coarse { other.breadth() } else { size };
    let is_beyond = finest > other_size_m;
    let near = middle_of_other.filter(|_| is_beyond).and_then(|middle| cloud.scale_near(&middle));
    let [spacing_m, std_m] =
        near.map_or([spacing, std], |near| [near[0].min(spacing), near[1].min(std)]);
    if other_size_m == 0.0 {
        None
    } else if spacing_m > other_size_m {
        Some(Warning::Sparse { body, spacing_m, other_size_m })
    } else if std_m > other_size_m {
        Some(Warning::Noise { body, std_m, other_size_m })
    } else if std_m > LARGE_NOISE * other_size_m {
        let overstated = |Overstated { stated: std_m, seen: seen_m }| Warning::NoiseOverstated {
            body,
            std_m,
            seen_m,
        };
        cloud.overstated().map(overstated)
    } else {
        None
    }
}

/// Beside no body of this size or larger, m, is the cloud too coarse, whatever the other is like ([`scale`]); 0 of a
/// mesh.
pub(crate) fn coarse_beside(shape: Shape<'_>) -> f64 {
    match shape {
        Shape::Cloud(cloud) => TURNED * cloud.makeup().spacing.max(cloud.makeup().std),
        Shape::Mesh(_) => 0.0,
    }
}

fn sensors(body: Which, cloud: &Makeup) -> impl Iterator<Item = Warning> + '_ {
    cloud.sensor_doubts.iter().filter_map(move |doubt| match *doubt {
        SensorDoubt::Beside { share } => Some(Warning::SensorPose { body, share }),
        SensorDoubt::Turn { share } => Some(Warning::SensorTurn { body, share }),
        SensorDoubt::Range { median, limit } => {
            Some(Warning::SensorRange { body, range_m: median, limit_m: limit })
        }
        SensorDoubt::Layout => Some(Warning::SensorLayout { body }),
        SensorDoubt::Misplaced => Some(Warning::ImagePlace { body }),
        SensorDoubt::Robot { share } => Some(Warning::SelfFilter { body, share }),
        SensorDoubt::NoRobot => Some(Warning::NoRobot { body }),
        SensorDoubt::Padding { share } => Some(Warning::Padding { body, share }),
        // Of an object it is taken for granted that it may have a back.
        SensorDoubt::NoImage => (body == Which::A).then_some(Warning::NoImage { body }),
    })
}

/// What is many times as large as what it is to be moved in is rather the scene, or in another unit.
fn exchanged(a: Shape<'_>, b: Shape<'_>) -> Option<Warning> {
    let (size_m, other_size_m) = (b.size(), a.size());
    // Of two meshes either may be the scene.
    let any_cloud = [a, b].iter().any(|body| matches!(body, Shape::Cloud(_)));
    let ratio = if any_cloud { EXCHANGED_RATIO } else { EXCHANGED_MESHES_RATIO };
    let is_larger = other_size_m > 0.0 && size_m > ratio * other_size_m;
    is_larger.then_some(Warning::Exchanged { size_m, other_size_m })
}

fn apart((a, b): (Shape<'_>, Shape<'_>), a_from_b: &Pose, gap_m: f64) -> Option<Warning> {
    let larger = a.size().max(b.size());
    let [far, sizes] = FAR;
    let is_far = gap_m > FARTHEST_SIZES * larger || gap_m > far && gap_m > sizes * larger;
    if larger > 0.0 && is_far {
        return Some(Warning::FarAway { gap_m, size_m: larger });
    }
    // Between a camera and what it saw is nowhere else.
    let is_in_view = || match a {
        Shape::Cloud(cloud) => {
            cloud.has_looked_past(&a_from_b.transform_point(&b.middle()), b.breadth())
        }
        Shape::Mesh(_) => false,
    };
    (gap_m > b.size() && !is_in_view()).then(|| Warning::OutsideScene { gap_m, size_m: a.size() })
}
