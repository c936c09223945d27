//! A cloud that changes in place: index, tree and surface are made anew where something changed, and
//! kept elsewhere.

use std::collections::BTreeMap;
use std::mem;

use cloudtouch_bvh::{Patched, Primitive};
use cloudtouch_geom::{Point3, Vector3};
use cloudtouch_noise::Neighborhoods;
use rayon::prelude::*;

use super::lost::{Before, after};
use crate::cloud::local::local;
use crate::cloud::makeup::Makeup;
use crate::cloud::makeup::spread::sample_of;
use crate::cloud::pieces::Pieces;
use crate::cloud::prepared::{Prepared, makeup_of};
use crate::cloud::primitives::measured_point;
use crate::cloud::scans::Scans;
use crate::cloud::surface::slots::{LazySurface, spacing_cap};
use crate::cloud::view::SingleView;
use crate::error::PrepareError;

/// A tree is built anew when so many times as many points as it holds have come or gone ...
const MOST_DRIFT: f64 = 1.0;
/// ... or come or go at once, as a share of those there are then: from there on every leaf is another, and to patch
/// them takes longer than to build all, in a refined cloud too ...
const MOST_AT_ONCE: f64 = 0.4;
/// ... or its leaves are so many times as loose ([`cloudtouch_bvh::Tree::quality`]).
const LOOSEST: f64 = 1.5;
/// A standard deviation so large (m) overflows somewhere: such a cloud is prepared anew, or refused.
const MOST_STD: f64 = 1e50;

/// What a changed cloud has been found to be before anything is changed.
#[derive(Debug)]
pub(super) struct Prospect {
    near: Neighborhoods,
    makeup: Makeup,
}

impl Prepared {
    /// Whether the cloud can become that of other points in place, and what it will be like: `before`
    /// says which index each point had, if it is where it was. `None` where it is to be prepared anew.
    pub(super) fn prospect(
        &self,
        scans: &Scans,
        before: &[Option<u32>],
    ) -> Result<Option<Prospect>, PrepareError> {
        let new = || before.iter().enumerate().filter(|(_, b)| b.is_none()).map(|(index, _)| index);
        let (at_once, drift) = (self.replaced_by(before), self.drift_after(before));
        if !self.pieces.is_each()
            || !scans.is_like(&self.scans)
            || at_once as f64 > MOST_AT_ONCE * before.len() as f64
            || drift as f64 > MOST_DRIFT * self.len() as f64
            || self.tree.should_rebuild(LOOSEST)
            || new().any(|index| scans.noise[index].max_std() > MOST_STD)
        {
            return Ok(None);
        }
        let points = local(&scans.points, &self.origin);
        let near = match self.neighborhoods.changed(points.clone(), before)? {
            Some(near) => near,
            None => Neighborhoods::sharing(points)?,
        };
        let sample = sample_of(near.points());
        let chosen = || Pieces::chosen(&near, &scans.noise, &sample);
        let is_each = scans.normals.is_some() || chosen()?.is_each();
        if !is_each {
            return Ok(None);
        }
        let makeup = makeup_of(scans, (&near, &sample), &self.origin)?;
        Ok(Some(Prospect { near, makeup }))
    }

    /// Points that came or went since the tree was built, after one more change.
    fn drift_after(&self, before: &[Option<u32>]) -> usize {
        self.drift + self.replaced_by(before)
    }

    /// Points that come with a change or go, whichever are more.
    fn replaced_by(&self, before: &[Option<u32>]) -> usize {
        let kept = before.iter().flatten().count();
        (before.len() - kept).max(self.len() - kept)
    }

    /// Becomes the cloud of other points, as was found to be possible; says at how many the surface is
    /// kept. `changed` are the places (local frame, m) that points left, came to or moved between.
    pub(super) fn patch(
        &mut self,
        mut scans: Scans,
        Prospect { near, makeup }: Prospect,
        before: &[Option<u32>],
        changed: Vec<Point3>,
    ) -> Result<usize, PrepareError> {
        let changed = Neighborhoods::new(changed)?;
        let new = before.iter().enumerate().filter(|(_, before)| before.is_none());
        let added: Vec<Primitive> =
            new.map(|(index, _)| measured_point(index, &near, &scans.noise, 1.0)).collect();
        let patched = self.tree.patch(before, &added)?;
        self.drift = self.drift_after(before);

        let measured = (self.points(), self.sensor());
        let settled = |view: &SingleView| view.settled(measured, &Vector3::zeros());
        let mut views: Vec<SingleView> = self.views.iter().filter_map(settled).collect();
        let image = |image| SingleView::new(image, &self.origin);
        views.extend(mem::take(&mut scans.images).into_iter().map(image));
        self.views = views;
        self.sensor_origins = scans.origins.iter().map(|place| place - self.origin).collect();
        (self.neighborhoods, self.makeup, self.scans) = (near, makeup, scans);

        let old = self.take_surface(before, &patched);
        let lost = self.lost(&old, before, &changed, &patched);
        let kept = self.regrow(old, before, &patched, &lost)?;
        self.around = self.tree.root().map(|root| root.obb());
        Ok(kept)
    }

    /// Gives the surface room for the new points, with what leaves that did not change hold.
    fn take_surface(&mut self, before: &[Option<u32>], patched: &Patched) -> Before {
        let tree = &self.tree;
        let surface = &mut self.surface;
        let caps = &surface.spacing_caps;
        let cap = |before: &Option<u32>| before.map_or(0.0, |before| caps[before as usize]);
        let mut spacing_caps: Vec<f32> = before.iter().map(cap).collect();
        for leaf in patched.leaves.iter().filter_map(|&id| tree.leaf(id)) {
            let cap = spacing_cap(tree, leaf);
            leaf.primitive_indices().iter().for_each(|&i| spacing_caps[i as usize] = cap);
        }
        let fresh = LazySurface { spacing_caps, ..LazySurface::empty() };
        let mut old = mem::replace(surface, fresh);
        let mut moved_house = BTreeMap::new();
        for leaf in &patched.stale {
            old.edges.take(leaf.index());
            let known = old.leaves.take(leaf.index());
            let surfels = known.into_iter().flat_map(|leaf| leaf.surfels);
            moved_house.extend(surfels.map(|surfel| (surfel.index, surfel)));
        }
        surface.leaves = mem::take(&mut old.leaves);
        surface.edges = mem::take(&mut old.edges);
        surface.leaves.set_count(tree.node_slots());
        surface.edges.set_count(tree.node_slots());
        let after = after(before, old.piece_count());
        let mut numbered = (0..).zip(before);
        let is_renumbered =
            numbered.any(|(index, before)| before.is_some_and(|before| before != index));
        surface.leaves.par_iter_mut().for_each(|leaf| {
            // Where a piece ends others tell, of which some may be lost.
            leaf.ended.take();
            if is_renumbered {
                leaf.surfels.iter_mut().for_each(|s| s.index = after[s.index as usize]);
            }
        });
        if is_renumbered {
            surface.edges.par_iter_mut().for_each(|leaf| leaf.renumber(&after));
        }
        Before { surface: old, moved_house, after }
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{PointCloud, UncertainPoint, seed};
    use cloudtouch_noise::{Scratch, SensorModel};
    use proptest::prelude::*;

    use super::*;
    use crate::cloud::surface::surfel::{End, Surfel};
    use crate::{Cloud, CloudSettings};

    fn unit(stream: u64, index: u64) -> f64 {
        2.0 * seed::unit(seed::derive(stream, index, 0)) - 1.0
    }

    /// Whether a limit to its spacing acts on a piece.
    fn is_limited(cloud: &Prepared, piece: u32) -> bool {
        let spacing = cloud.fit(piece, &mut Scratch::default()).spacing;
        spacing >= cloud.surface.cap(piece)
    }

    /// All of a piece but what is left of its covariance where it ends.
    fn as_fitted(surfel: &Surfel) -> Surfel {
        let point = UncertainPoint::exact(surfel.point.mean);
        Surfel { point, end: End::Nowhere, ..*surfel }
    }

    /// The edges between pieces such as these, in order.
    fn edges(cloud: &Prepared, is_one: impl Fn(u32) -> bool) -> Vec<[u32; 2]> {
        let ids: Vec<_> = cloud.tree.leaves().map(|leaf| leaf.id()).collect();
        let edges = ids.iter().flat_map(|&id| cloud.leaf_edges(id, &mut Scratch::default()).iter());
        let mut all: Vec<[u32; 2]> = edges
            .map(|edge| {
                let [p, q] = edge.points;
                [p.min(q), p.max(q)]
            })
            .filter(|ends| ends.iter().all(|&piece| is_one(piece)))
            .collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

        /// A surface is that of a fresh cloud, to the bit, wherever no limit to its spacing acts; and each
        /// of its edges is there.
        #[test]
        fn what_is_kept_and_what_is_computed_is_the_surface_of_a_fresh_cloud(
            seed in any::<u64>(),
            changes in prop::collection::vec((0..700_usize, 1..40_usize, -0.03..0.03_f64), 1..5),
            is_refined in any::<bool>(), kind in 0..4_u8,
        ) {
            let sensor = if kind & 2 == 2 { SensorModel::PerPoint } else { SensorModel::Isotropic { std: 0.001 } };
            let by = CloudSettings::new(sensor);
            // A sheet of 30 cm, one half of it wavy and one folded, with corners that keep the middle of its box
            // where it is.
            let at = |i: u64| {
                let (x, y) = (0.15 * unit(seed, 2 * i), 0.15 * unit(seed, 2 * i + 1));
                let z = if y > 0.0 { 1.2 * x.abs() } else { 0.03 * (20.0 * x).sin() };
                Point3::new(x, y, z)
            };
            let corners = [-1.0, 1.0].map(|side| Point3::new(side, side, side));
            let mut points: Vec<Point3> = corners.into_iter().chain((0..900).map(at)).collect();
            let mut ids: Vec<u64> = (0..points.len() as u64).collect();
            let mut next = 10_000;
            let given = |points: &[Point3], ids: &[u64]| {
                let mut scan = PointCloud::from_points(points.to_vec());
                if kind & 1 == 1 {
                    let normal = |&i: &u64| cloudtouch_geom::UnitVector3::new_normalize(Vector3::new(
                        0.4 * unit(seed ^ 1, i), 0.4 * unit(seed ^ 2, i), 1.0));
                    scan.normals = Some(ids.iter().map(normal).collect());
                }
                if kind & 2 == 2 {
                    let one = |&i: &u64| cloudtouch_geom::Covariance::isotropic(1e-6 * (1.2 + unit(seed ^ 3, i)));
                    scan.covariances = Some(ids.iter().map(one).collect());
                }
                scan
            };
            let made = |points: &[Point3], ids: &[u64]| {
                let scan = given(points, ids);
                let cloud = Cloud::prepare(&scan, &by).unwrap();
                if is_refined { cloud.refined().unwrap() } else { cloud }
            };
            let mut changed = made(&points, &ids);
            let mut scratch = Scratch::default();
            for (first, count, by_m) in changes {
                for piece in (0..changed.len() as u32).step_by(2) {
                    changed.prepared.fit(piece, &mut scratch);
                }
                for piece in (0..changed.len() as u32).step_by(3) {
                    changed.prepared.of_leaf(piece);
                }
                let moved: Vec<(usize, Point3)> = (2 + first..2 + first + count)
                    .map(|i| (i, points[i] + Vector3::new(by_m, 0.3 * by_m, 0.1 * by_m)))
                    .collect();
                prop_assert!(!changed.move_points(&moved).unwrap().is_rebuilt);
                moved.iter().for_each(|(i, place)| points[*i] = *place);
                let gone: Vec<usize> = (2 + first / 2..2 + first / 2 + count).step_by(3).collect();
                changed.remove(&gone).unwrap();
                for &index in gone.iter().rev() {
                    points.remove(index);
                    ids.remove(index);
                }
                // And some come.
                let new: Vec<u64> = (0..count as u64).map(|k| next + k).collect();
                next += count as u64;
                let places: Vec<Point3> = new.iter().map(|&i| at(i)).collect();
                changed.insert(&given(&places, &new), &by).unwrap();
                points.extend(places);
                ids.extend(new);
            }
            let fresh = made(&points, &ids);
            let [changed, fresh] = [&changed.prepared, &fresh.prepared];
            prop_assert_eq!(changed.tree.validate(), Ok(()));
            let is_whole = |piece| ![changed, fresh].iter().any(|cloud| is_limited(cloud, piece));
            let mut cut_off = 0;
            let mut kept = 0;
            for piece in 0..points.len() as u32 {
                if is_whole(piece) {
                    let [one, other] = [changed, fresh].map(|cloud| cloud.told(piece, &mut scratch));
                    // Where it ends, pieces tell that may be limited themselves.
                    let beside = fresh.beside(piece);
                    let is_same =
                        beside.is_none_or(|all| all.pieces.iter().all(|&near| is_whole(near)));
                    let told = |surfel| if is_same { surfel } else { as_fitted(&surfel) };
                    prop_assert_eq!(told(one), told(other));
                    cut_off += usize::from(one.end == End::CutOff);
                    kept += 1;
                }
            }
            prop_assert!(2 * kept > points.len() && (kind & 1 == 1 || cut_off > 0), "{kept}, {cut_off} of them ending");
            prop_assert_eq!(edges(changed, is_whole), edges(fresh, is_whole));
        }
    }
}
