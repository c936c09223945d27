//! A stretch of a path of joints: how far a robot gets from its place in the middle, and what it may meet
//! there.

use cloudtouch::{Body, BodyRef, Query};

use crate::carried::Carried;
use crate::checker::{RobotChecker, SURROUNDINGS};
use crate::ways::ways;

/// A part or the surroundings, and another part.
pub(crate) type Pair = (Option<usize>, usize);

impl RobotChecker {
    /// Of every pair that may touch the largest probability that it meets on the way from one position to the
    /// other, of which `middle` is the middle: of the surroundings (`None`) or a part, and another part.
    pub(crate) fn around<'a>(
        &'a self,
        query: &'a Query,
        middle: &[f64],
        ends: [&[f64]; 2],
    ) -> impl Iterator<Item = (Pair, f64)> + use<'a> {
        let (tree, parts) = (&self.robot.tree, &self.carried);
        let poses = tree.poses(middle);
        let at = move |i: usize| self.scene_from_base.after(&parts[i].pose(&poses));
        let of_all = |i: usize| std::iter::once(None).chain((0..i).map(Some)).map(move |j| (j, i));
        let may_touch = |&(j, i): &Pair| {
            let other = j.map_or(SURROUNDINGS, |j| &*parts[j].name);
            self.scene.is_allowed(&parts[i].name, other) != Ok(true)
        };
        let of_part = |part: &Carried| ways(tree, (part.link, part.radius), ends);
        let ways: Vec<Vec<f64>> = parts.iter().map(of_part).collect();
        let way = move |i: usize, beside: usize| ways[i][beside];
        let query = query.among_many();
        let at_most = move |(j, i): Pair| {
            let b = &*parts[i].body;
            let found = match j.map(|j| (j, &*parts[j].body)) {
                Some((j, a)) => {
                    let way = way(i, parts[j].link) + way(j, parts[i].link);
                    let bound = |a, b, a_from_b| query.bound_around(a, b, &a_from_b, way).ok();
                    match is_larger_mesh(b, a) {
                        true => bound(b, a, at(i).inverse().after(&at(j))),
                        false => bound(a, b, at(j).inverse().after(&at(i))),
                    }
                }
                None => {
                    let a = self.scene.body(SURROUNDINGS).ok();
                    a.and_then(|a| query.bound_around(&**a, b, &at(i), way(i, tree.root())).ok())
                }
            };
            // What cannot be asked is not clear.
            found.unwrap_or(1.0)
        };
        (0..parts.len()).flat_map(of_all).filter(may_touch).map(move |pair| (pair, at_most(pair)))
    }
}

/// Whether a mesh is larger than another, and has to be asked about as the first of the two: how near they come either
/// tells, of clouds not, which turn against what keeps still.
fn is_larger_mesh(mesh: &Body, other: &Body) -> bool {
    let size = |body: &Body| {
        let [low, high] = BodyRef::from(body).corners();
        (high - low).norm()
    };
    let are_meshes = matches!((mesh, other), (Body::Mesh(_), Body::Mesh(_)));
    are_meshes && size(mesh) > size(other)
}

/// The position at a time from 0 to 1 on the way from one to another.
pub(crate) fn between(from: &[f64], to: &[f64], time: f64) -> Vec<f64> {
    from.iter().zip(to).map(|(from, to)| from + (to - from) * time).collect()
}
