//! A body with the surface of the other all around it: nothing near says that it touches, and nothing
//! says on which side of that surface it is.

mod discs;
mod open_side;
mod samples;
mod sight;
mod squares;
mod way;

use cloudtouch_geom::{Point3, Pose};

use crate::cloud::Prepared;
use crate::mesh::Mesh;
use crate::placement::box_gap;
use crate::shape::Shape;

use discs::{Directions, Discs};
use open_side::has_open_side;
use samples::Samples;
use sight::sees;
use squares::{CLOSED, MOST_SQUARES, Squares};

/// Whether the surface of a cloud is all around the other body, so that neither knows whether the space
/// between them is empty. Where a sensor's place is known and it looks at the inner one past no
/// surface, that space was seen to be. On which side of a closed mesh something is, the mesh tells; an open
/// one, as a single triangle that is missing leaves it, surrounds what a cloud would.
pub(crate) fn is_enclosed(a: Shape<'_>, b: Shape<'_>, a_from_b: &Pose) -> bool {
    let of = |body: Shape<'_>| {
        let obb = match body {
            Shape::Cloud(cloud) => cloud.around().copied(),
            Shape::Mesh(mesh) => mesh.tree().root().map(|root| root.obb()),
        };
        obb.map_or((Point3::origin(), 0.0), |obb| (obb.centre, obb.radius()))
    };
    let ((middle_of_a, radius_of_a), (middle_of_b, radius_of_b)) = (of(a), of(b));
    // The larger one cannot be within the smaller, but part of it may be.
    let (outer, inner, middle, outer_from_inner) = if radius_of_a >= radius_of_b {
        (a, b, middle_of_b, *a_from_b)
    } else {
        (b, a, middle_of_a, a_from_b.inverse())
    };
    if holds_part_of((inner, &middle), outer, &outer_from_inner) {
        return true;
    }
    let place = outer_from_inner.transform_point(&middle);
    // The middle of a ring is in its hole.
    let own = || Some(outer_from_inner.transform_point(&nearest_of(inner, &middle)?));
    match outer {
        Shape::Cloud(cloud) => surrounds(cloud, (inner, &place), own),
        Shape::Mesh(mesh) => nearly_surrounds(mesh, &place),
    }
}

/// Whether all but a few of the directions from a place in its local frame end on an open mesh, or where a triangle of
/// it is missing: of a box a single one is a twelfth of all directions.
fn nearly_surrounds(mesh: &Mesh, place: &Point3) -> bool {
    let is_within = || {
        let [low, high] = mesh.corners_of_box();
        (0..3).all(|k| low[k] <= place[k] && place[k] <= high[k])
    };
    !mesh.is_closed() && is_within() && mesh.is_all_around(place, CLOSED)
}

/// Whether the surface of a body, of which the middle is given, is all around the place of a larger one that is nearest
/// to its middle, as around a thing of a scene.
fn holds_part_of(
    (body, middle): (Shape<'_>, &Point3),
    larger: Shape<'_>,
    larger_from_body: &Pose,
) -> bool {
    let may_hold = match body {
        Shape::Cloud(_) => true,
        Shape::Mesh(mesh) => !mesh.is_closed(),
    };
    // PERF: most of what is far from an object is beside its box; looking for the nearest asks for memory.
    let is_beside = || box_gap(body, larger, &larger_from_body.inverse()) > 0.0;
    let nearest = || {
        let place = nearest_of(larger, &larger_from_body.transform_point(middle))?;
        Some(larger_from_body.inverse().transform_point(&place))
    };
    may_hold
        && !is_beside()
        && nearest().is_some_and(|place| match body {
            Shape::Cloud(cloud) => surrounds(cloud, (larger, &place), || Some(place)),
            Shape::Mesh(mesh) => nearly_surrounds(mesh, &place),
        })
}

/// The place of a body that is nearest to one, in its local frame.
fn nearest_of(body: Shape<'_>, place: &Point3) -> Option<Point3> {
    match body {
        Shape::Cloud(cloud) => cloud.measured_nearest(place),
        Shape::Mesh(mesh) => Some(mesh.nearest(place).0),
    }
}

/// Whether a cloud surrounds a body, of which the middle is given, or what stands for it, and some place of its own.
fn surrounds(
    cloud: &Prepared,
    (body, middle): (Shape<'_>, &Point3),
    own: impl FnOnce() -> Option<Point3>,
) -> bool {
    let Some(around) = cloud.around().filter(|around| around.contains(middle)) else {
        return false;
    };
    // Along the box, so that nothing hangs on the axes of the file.
    let axes = around.axes;
    let samples = Samples::of(cloud, axes);
    // An open side is four of the smallest squares: more than may be empty. Where the surface is near it may be so
    // by chance, but hardly with a spacing about it.
    let near = cloud.makeup().spacing;
    if samples.are_many()
        && cloud.is_searched_at_every_point()
        && has_open_side(cloud.tree(), (cloud.points(), near), (middle, &axes))
    {
        return false;
    }
    // Where a depth image looked past each pixel tells more than how near points are to a single line.
    if cloud.has_looked_past(middle, body.breadth()) {
        return false;
    }
    let filled = samples.around(middle);
    let mut sensors = cloud.sensor_origins().iter();
    let mut discs = Discs::of(cloud);
    if filled.are_all() {
        return !sensors.any(|sensor| sees(cloud, sensor, middle))
            && !own().is_some_and(|own| discs.hold(&own));
    }
    // Near the surface samples are too few for that.
    let directions =
        Directions::new(Squares::new(axes, MOST_SQUARES).middles(), |way| filled.hold(way));
    discs.close_empty(middle, &directions)
        && own().is_some_and(|own| {
            !discs.hold(&own)
                && discs.close_all(&own, &directions)
                && sensors.all(|sensor| discs.part(sensor, &own))
        })
}
