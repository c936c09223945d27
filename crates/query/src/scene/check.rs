//! Which bodies of a scene may touch.

use std::collections::{BTreeMap, BTreeSet};

use cloudtouch_geom::{Point3, Pose};
use rayon::prelude::*;

use crate::body::BodyRef;
use crate::doubt::of_pair::of_body;
use crate::doubt::warning::Which;
use crate::query::{Detail, Query};

use super::answer::{BodyWarning, Checked, Outside, PairAnswer};
use super::bodies::Scene;
use super::broad::BroadPhase;
use super::near::{Corners, everywhere, meeting};
use super::stray::{Beside, beside_others, in_scene};

impl Scene {
    /// All pairs of bodies that do not read as free at the thresholds of the query, the worst first, on
    /// all threads of the current rayon pool, with the same bits whatever their number.
    ///
    /// It is the answer to all pairs asked one by one ([`Query::among_many`]), the larger body first, but that the boxes
    /// around most rule them out. Being far from one body is no reason to doubt the pose of another
    /// ([`Undecided::Units`](crate::Undecided::Units)), only being far from all of them.
    /// A pair without an answer, and one that is undecided for whatever reason, such as space that a
    /// depth image did not see, is among those returned. Pairs whose boxes do not meet are not looked at,
    /// the others take a test of two boxes, and those near each other, or in doubt, a query. A deadline of the
    /// query counts for all pairs together: those that it leaves no time for are undecided.
    #[must_use]
    pub fn check(&self, query: &Query) -> Checked {
        let query = &query.begun_now();
        let broad = BroadPhase::new(query);
        let members = self.members();
        let asked: Vec<PairAnswer> = self
            .candidates(&members, &broad)
            .par_iter()
            .filter(|pair| broad.urgency(pair.bodies(), &pair.a_from_b, pair.is_astray).is_some())
            .map(|pair| pair.ask(query))
            .collect();
        let (count, allowed) = (pairs_of(self.bodies.len()), self.allowed.len());
        let ruled_out = count - allowed - asked.len();
        let outside = members.iter().filter(|member| member.beside.is_outside());
        let outside = outside.map(|&Member { name, beside: Beside { gap_m, size_m }, .. }| {
            Outside { name: name.to_owned(), gap_m, size_m }
        });
        let outside = outside.collect();
        let warnings = warnings(&members, query);
        let mut checked = Checked {
            count,
            allowed,
            unchecked: self.unchecked(),
            ruled_out,
            asked: asked.len(),
            pairs: asked,
            outside,
            warnings,
        };
        checked.pairs.retain(|pair| !pair.is_free());
        checked.pairs.sort_by(PairAnswer::by_gravity);
        checked.outside.sort_by(|p, q| p.name.cmp(&q.name));
        checked
    }

    /// One pair of bodies that does not read as free, or `None` where all do, or all may touch: the pairs are asked
    /// one after the other, those whose boxes overlap most first, and those after it are not. Which one is
    /// found depends on nothing but the scene.
    ///
    /// With [`Detail::Free`] it is known soonest; [`Self::is_free`] tells no more than whether there is one. A
    /// deadline is that of each pair; [`Query::begun_now`] makes it that of all.
    #[must_use]
    pub fn check_first(&self, query: &Query) -> Option<PairAnswer> {
        let broad = BroadPhase::new(query);
        let members = self.members();
        let candidates = self.candidates(&members, &broad);
        let urgency =
            |pair: &Candidate<'_>| broad.urgency(pair.bodies(), &pair.a_from_b, pair.is_astray);
        let mut open: Vec<(f64, &Candidate<'_>)> =
            candidates.par_iter().filter_map(|pair| Some((urgency(pair)?, pair))).collect();
        open.sort_by(|(p, _), (q, _)| p.total_cmp(q));
        open.into_iter().map(|(_, pair)| pair.ask(query)).find(|pair| !pair.is_free())
    }

    /// Whether all pairs read as free: the verdict of [`Self::check`], sooner, for the pairs are asked one after the
    /// other until one is surely not free ([`Detail::Free`]). Where there is no pair to ask, nothing is known, and
    /// nothing free. A deadline is that of all pairs together.
    #[must_use]
    pub fn is_free(&self, query: &Query) -> bool {
        let query = query.with_detail(Detail::Free).begun_now();
        self.allowed.len() < pairs_of(self.bodies.len()) && self.check_first(&query).is_none()
    }

    /// Lowest and highest corner of each body along the axes of the scene, m, by its name: of its own box turned
    /// by the pose, and so never too small. For people to see whether the poses are those they meant.
    pub fn boxes(&self) -> BTreeMap<&str, [Point3; 2]> {
        let boxed = |of: Member<'_>| in_scene(of.body.shape(), &of.pose);
        self.members().into_iter().map(|member| (member.name, boxed(member))).collect()
    }

    /// The bodies, the largest first: of a pair the query takes the larger, A, for the surroundings.
    fn members(&self) -> Vec<Member<'_>> {
        let mut bodies: Vec<Member<'_>> = Vec::with_capacity(self.bodies.len());
        for (name, placed) in &self.bodies {
            // Every name of the map is in the scene.
            let Ok(pose) = self.pose(name) else { continue };
            let body = BodyRef::from(&*placed.body);
            let beside = Beside { gap_m: 0.0, size_m: 0.0 };
            bodies.push(Member { name, body, pose, size: body.shape().size(), beside });
        }
        let places: Vec<_> = bodies.iter().map(|of| (of.body.shape(), of.pose)).collect();
        for (member, beside) in bodies.iter_mut().zip(beside_others(&places)) {
            member.beside = beside;
        }
        bodies.sort_by(|p, q| q.size.total_cmp(&p.size));
        bodies
    }

    /// The pairs that may not touch and whose boxes meet.
    fn candidates<'a>(&self, bodies: &[Member<'a>], broad: &BroadPhase) -> Vec<Candidate<'a>> {
        let smallest = bodies.iter().rfind(|of| of.size > 0.0).or(bodies.last());
        let Some(smallest) = smallest.map(|of| of.body.shape()) else { return Vec::new() };
        let zone = |(k, of): (usize, &Member<'_>)| match of.beside.is_astray() {
            true => everywhere(),
            false => {
                let largest = (k > 0).then(|| bodies[0].body.shape());
                let others = bodies.iter().enumerate().rev().filter(|(place, _)| *place != k);
                let others = others.map(|(_, other)| other.body.shape());
                broad.zone(of.body.shape(), &of.pose, smallest, largest, others)
            }
        };
        let zones: Vec<Corners> = bodies.iter().enumerate().map(zone).collect();
        let allowed: BTreeSet<[&str; 2]> =
            self.allowed.iter().map(|pair| pair.each_ref().map(String::as_str)).collect();
        let near = meeting(&zones).into_iter().map(|pair| pair.map(|k| &bodies[k]));
        near.filter(|[a, b]| !allowed.contains(&[a.name.min(b.name), a.name.max(b.name)]))
            .map(|[a, b]| Candidate::new(a, b))
            .collect()
    }
}

/// Of the smallest body it is taken for granted, as of an object, that it may have a back.
fn warnings(members: &[Member<'_>], query: &Query) -> Vec<BodyWarning> {
    let limits = &query.settings().safeguards;
    let last = members.len().saturating_sub(1);
    let mut all = Vec::new();
    for (place, member) in members.iter().enumerate() {
        let which = if place == last && place > 0 { Which::B } else { Which::A };
        let found = of_body(which, member.body.shape(), limits).into_iter();
        all.extend(found.map(|warning| BodyWarning { name: member.name.to_owned(), warning }));
    }
    all.sort_by(|p, q| p.name.cmp(&q.name));
    all
}

/// How many pairs so many bodies make.
fn pairs_of(bodies: usize) -> usize {
    bodies * bodies.saturating_sub(1) / 2
}

/// A body of the scene, and where it is.
struct Member<'a> {
    name: &'a str,
    body: BodyRef<'a>,
    /// Into the frame of the scene.
    pose: Pose,
    /// m.
    size: f64,
    /// Where it is beside all others.
    beside: Beside,
}

/// Two bodies that may not touch.
struct Candidate<'a> {
    names: [&'a str; 2],
    bodies: [BodyRef<'a>; 2],
    scene_from_a: Pose,
    a_from_b: Pose,
    is_astray: bool,
}

impl<'a> Candidate<'a> {
    fn new(a: &Member<'a>, b: &Member<'a>) -> Self {
        Self {
            names: [a.name, b.name],
            bodies: [a.body, b.body],
            scene_from_a: a.pose,
            a_from_b: a.pose.inverse().after(&b.pose),
            is_astray: a.beside.is_astray() || b.beside.is_astray(),
        }
    }

    fn bodies(&self) -> (BodyRef<'a>, BodyRef<'a>) {
        self.bodies.into()
    }

    fn ask(&self, query: &Query) -> PairAnswer {
        let mut answer = query.run_in_scene(self.bodies(), &self.a_from_b, self.is_astray);
        for contact in answer.iter_mut().flat_map(|report| &mut report.contacts) {
            contact.point = self.scene_from_a.transform_point(&contact.point);
            contact.normal_a_to_b = self.scene_from_a.transform_vector(&contact.normal_a_to_b);
        }
        let [a, b] = self.names.map(str::to_owned);
        PairAnswer { a, b, answer }
    }
}
