//! Adds what two leaves say, or a leaf of a cloud and all of a mesh.

use cloudtouch_bvh::{Settled, SurfacePair};
use cloudtouch_geom::{Motion, Vector3};

use crate::body::BodyRef;
use crate::stats::Stats;

use super::compare::meeting::Meeting;
use super::cross::leaves::cross;
use super::measure::nearest::{Nearest, nearest_pieces};
use super::measure::settled::Settlement;
use super::run::{Finding, Found};
use super::visit::around::OfMesh;
use super::visit::leaf::{Between, Leaf};

impl<'a> Found<'a> {
    /// Compares two leaves; which of them was compared with all of the other body.
    pub(super) fn add(
        &mut self,
        (a, b): (BodyRef<'a>, BodyRef<'a>),
        a_from_b: &Motion,
        pair: &SurfacePair,
        stats: &mut Stats,
    ) -> Option<Settled> {
        let most = self.deviations_of_interest();
        let Self { around, sides, few, .. } = self;
        let load_a = || around.load(a, pair.a, &mut sides[0], stats);
        let leaf_a = self.leaves_a.get_or_load(pair.a, load_a);
        let load_b = || around.load(b, pair.b, &mut sides[1], stats);
        let leaf_b = self.leaves_b.get_or_load(pair.b, load_b);
        for (leaf, which) in [(&*leaf_a, Settled::A), (&*leaf_b, Settled::B)] {
            if leaf.is_settled() {
                return Some(which);
            }
        }
        let Between { of_means, of_surfaces, most_std } = leaf_a.between(leaf_b);
        self.at_least = self.at_least.min(of_surfaces);
        // PERF: what the tree knows of leaves whose surface it has not seen is loose.
        let is_near = pair.deviations < most && of_means <= most * most_std;
        let nearest = is_near.then(|| nearest_pieces(leaf_a, leaf_b, most, sides));
        if pair.may_cross && of_surfaces <= 0.0 {
            let found = (&mut self.crossings, &mut *around, &mut self.memory);
            cross((a, b), a_from_b, (leaf_a, leaf_b), sides, found);
        }
        let toward_b = leaf_b.middle() - leaf_a.middle();
        let beside_mesh = match (leaf_a, leaf_b) {
            (Leaf::Noisy(noisy), Leaf::Exact(exact)) => Some((noisy, (pair.b, &*exact), true)),
            (Leaf::Exact(exact), Leaf::Noisy(noisy)) => Some((noisy, (pair.a, &*exact), false)),
            _ => None,
        };
        let settlement = beside_mesh.and_then(|(noisy, leaf, is_a)| {
            let (body, a_from_mesh) = if is_a { (b, Some(a_from_b)) } else { (a, None) };
            let (side, which) = if is_a { (0, Settled::A) } else { (1, Settled::B) };
            let mut mesh = OfMesh { known: around, body, a_from_mesh };
            let found = &mut self.crossings;
            let settlement =
                noisy.settle((leaf, *few), &mut mesh, most, &mut sides[side], found)?;
            Some((settlement, which))
        });
        if let Some(nearest) = nearest.flatten() {
            self.note(nearest, toward_b);
        }
        let (settlement, which) = settlement?;
        self.take((a, b), (pair, which), settlement, stats);
        Some(which)
    }

    /// Takes what is known of a leaf of a cloud beside all of a mesh.
    fn take(
        &mut self,
        (a, b): (BodyRef<'a>, BodyRef<'a>),
        (pair, which): (&SurfacePair, Settled),
        Settlement { nearest, at_least }: Settlement,
        stats: &mut Stats,
    ) {
        self.at_least = self.at_least.min(at_least);
        for (leaf, nearest) in nearest {
            let Self { around, sides, leaves_a, leaves_b, .. } = self;
            let (in_a, in_b, nearest) = match which {
                Settled::A => (pair.a, leaf, nearest),
                Settled::B => (leaf, pair.b, nearest.swapped()),
            };
            let load_a = || around.load(a, in_a, &mut sides[0], stats);
            let leaf_a = leaves_a.get_or_load(in_a, load_a);
            let load_b = || around.load(b, in_b, &mut sides[1], stats);
            let leaf_b = leaves_b.get_or_load(in_b, load_b);
            let toward_b = leaf_b.middle() - leaf_a.middle();
            self.note(nearest, toward_b);
        }
    }

    fn note(&mut self, nearest: Nearest, toward_b: Vector3) {
        self.deviations = self.deviations.min(nearest.squared.sqrt());
        if let Some(meeting) = Meeting::of(&nearest.a, &nearest.b) {
            self.findings.push(Finding { nearest, meeting, toward_b });
        }
    }
}
