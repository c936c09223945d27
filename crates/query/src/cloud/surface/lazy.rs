//! The surface of a cloud: its noise model is computed when a query first comes near, and kept.

use cloudtouch_bvh::NodeId;
use cloudtouch_geom::Point3;
use cloudtouch_noise::{Neighbor, Scratch};

use super::leaf::LeafSurface;
use super::slots::{Basis, Fitted, NEIGHBORS};
use super::surfel::{End, Surfel};
use crate::cloud::prepared::Prepared;

impl Prepared {
    /// The surface at the points of a leaf, as it is fitted, and whether this call computed it.
    pub(crate) fn leaf(&self, id: NodeId) -> (&[Surfel], bool) {
        let (leaf, computed) = match self.known_leaf(id) {
            // PERF: buffers that are not used cost as much as the rest.
            Some(leaf) => (leaf, false),
            None => self.leaf_surface(id, &mut Scratch::default()),
        };
        (&leaf.surfels, computed)
    }

    /// [`Self::leaf`] with what encloses it, where it was computed.
    pub(crate) fn known_leaf(&self, id: NodeId) -> Option<&LeafSurface> {
        self.surface.leaves.get(id.index()).map(|leaf| &**leaf)
    }

    /// [`Self::leaf`] with what encloses it, by buffers that leaves nearby were computed with.
    pub(crate) fn leaf_surface(&self, id: NodeId, scratch: &mut Scratch) -> (&LeafSurface, bool) {
        let mut computed = false;
        let leaf = self.surface.leaves.get_or_init(id.index(), || {
            computed = true;
            let pieces = self.tree.node(id).map_or(&[][..], |leaf| leaf.primitive_indices());
            self.gather_around(pieces, scratch);
            let surfels = pieces.iter().map(|&piece| *self.fit(piece, scratch)).collect();
            Box::new(LeafSurface::new(surfels, self.thin_side(id)))
        });
        (leaf, computed)
    }

    /// Visits the surface, as it is fitted, at those points of a leaf that are asked for by where they were
    /// measured, in the local frame; whether any of it was computed for that.
    pub(crate) fn visit_some_of_leaf(
        &self,
        id: NodeId,
        mut is_wanted: impl FnMut(&Point3) -> bool,
        scratch: &mut Scratch,
        mut visit: impl FnMut(u32, &Surfel),
    ) -> bool {
        let pieces = self.tree.leaf(id).map_or(&[][..], |leaf| leaf.primitive_indices());
        if let Some(leaf) = self.surface.leaves.get(id.index()) {
            pieces.iter().zip(&leaf.surfels).for_each(|(&piece, surfel)| visit(piece, surfel));
            return false;
        }
        let places = self.near_pieces().points();
        let wanted: Vec<u32> =
            pieces.iter().copied().filter(|&piece| is_wanted(&places[piece as usize])).collect();
        let known = pieces.iter().find_map(|&piece| self.known_reach(piece));
        self.gather(&wanted, known, scratch);
        wanted.iter().for_each(|&piece| visit(piece, self.fit(piece, scratch)));
        !wanted.is_empty()
    }

    /// The pieces measured nearest to a place in the local frame, with the surface there as it is fitted.
    pub(crate) fn fits_near(
        &self,
        place: &Point3,
        count: usize,
        scratch: &mut Scratch,
    ) -> Vec<(u32, Surfel)> {
        let nearest = self.near_pieces().nearest_to(place, count);
        let pieces = nearest.iter().map(|near| near.index as u32);
        pieces.map(|piece| (piece, *self.fit(piece, scratch))).collect()
    }

    /// Makes buffers ready for the fits at those of some pieces near one another where the surface is not
    /// known, given how far one of them looked, m, if any is known. Where a few stand for all their fits
    /// look elsewhere.
    pub(super) fn gather(&self, pieces: &[u32], reach: Option<f64>, scratch: &mut Scratch) {
        if !self.pieces.is_each() || self.scans.normals.is_some() {
            return;
        }
        let is_unknown = |piece: &&u32| !self.is_known(**piece);
        let unknown: Vec<usize> =
            pieces.iter().filter(is_unknown).map(|&piece| piece as usize).collect();
        if unknown.len() > 1 {
            self.noise.gather(unknown.into_iter(), &self.neighborhoods, reach, scratch);
        }
    }

    /// [`Self::gather`] for all pieces of a leaf.
    pub(super) fn gather_around(&self, pieces: &[u32], scratch: &mut Scratch) {
        let known = pieces.iter().find_map(|&piece| self.known_reach(piece));
        self.gather(pieces, known, scratch);
    }

    /// The surface at one piece as it is fitted, but that a refined cloud knows no covariance other than what
    /// is left of it where it ends.
    pub(in crate::cloud) fn fit(&self, piece: u32, scratch: &mut Scratch) -> &Surfel {
        if self.is_refined() {
            return self.of_leaf(piece);
        }
        let fitted = || Box::new(self.fitted(piece, scratch));
        &self.surface.fits.get_or_init(piece as usize, fitted).surfel
    }

    /// The surface at one piece as it is fitted, where that is known.
    pub(in crate::cloud) fn known(&self, piece: u32) -> Option<Fitted> {
        if !self.is_refined() {
            return self.surface.fits.get(piece as usize).map(|fitted| (**fitted).clone());
        }
        let surfel = *self.of_leaf(piece);
        let basis = self.basis(piece).filter(|_| surfel.end != End::CutOff)?.clone();
        Some(Fitted { surfel: Surfel { end: basis.end(), ..surfel }, basis })
    }

    /// What the surface at a piece rests on, where it was computed.
    pub(in crate::cloud) fn basis(&self, piece: u32) -> Option<&Basis> {
        self.surface.basis(piece)
    }

    /// The pieces nearest to one, where its surface was computed and tells.
    pub(in crate::cloud) fn known_nearest(&self, piece: u32) -> Option<[u32; NEIGHBORS]> {
        self.basis(piece)?.nearest
    }

    /// The pieces nearest to one; with fewer of them the piece itself fills the rest, to which no edge leads.
    pub(super) fn nearest(&self, piece: u32, scratch: &mut Scratch) -> [u32; NEIGHBORS] {
        self.known_nearest(piece).unwrap_or_else(|| self.sought_nearest(piece, scratch))
    }

    /// The same by the index.
    pub(super) fn sought_nearest(&self, piece: u32, scratch: &mut Scratch) -> [u32; NEIGHBORS] {
        let mut nearest = [piece; NEIGHBORS];
        let found = self.near_pieces().nearest_with(piece as usize, NEIGHBORS, scratch);
        for (slot, neighbor) in nearest.iter_mut().zip(found) {
            *slot = neighbor.index as u32;
        }
        nearest
    }

    /// How far the fit at a piece looked, m, where that is known and not everywhere.
    pub(super) fn known_reach(&self, piece: u32) -> Option<f64> {
        let fitted = self.surface.fits.get(piece as usize)?;
        Some(fitted.basis.reach).filter(|reach| reach.is_finite())
    }

    /// Whether the surface at one piece was computed already.
    pub(in crate::cloud) fn is_known(&self, piece: u32) -> bool {
        self.is_refined() || self.surface.fits.get(piece as usize).is_some()
    }

    /// Whether the surface was computed everywhere and the tree fitted to it.
    pub(crate) fn is_refined(&self) -> bool {
        self.surface.fits.is_empty()
    }

    /// The surface at one piece as its leaf holds it: in a refined cloud, where else.
    pub(in crate::cloud) fn of_leaf(&self, piece: u32) -> &Surfel {
        let leaf = self.tree.leaf_of(piece as usize).and_then(|id| self.tree.leaf(id));
        let leaf = leaf.expect("no piece is ever removed");
        let place = leaf.primitive_indices().iter().position(|&own| own == piece);
        &self.leaf(leaf.id()).0[place.expect("a leaf holds its pieces")]
    }

    /// Computes the surface at one piece.
    pub(in crate::cloud) fn fitted(&self, piece: u32, scratch: &mut Scratch) -> Fitted {
        let index = self.pieces.index(piece);
        let cap = self.surface.cap(piece);
        let near = &self.neighborhoods;
        let refined = match self.scans.normals.as_ref().map(|normals| normals[index]) {
            Some(normal) => {
                let sensor = &self.scans.noise[index];
                self.noise.with_normal(index, normal, near, sensor, cap, scratch)
            }
            None => {
                let measured = (&self.noise, near, &self.scans.noise);
                self.pieces.refine(piece, measured, cap, scratch)
            }
        };
        let surfel = Surfel::new(index as u32, &refined);
        let found = self.found_by_fit(scratch);
        let nearest = found.first_chunk::<NEIGHBORS>().map(|all| all.map(|near| near.index as u32));
        let reach = scratch.reach();
        let (beside, reach) = self.look_beside(&surfel, piece, reach, scratch);
        let basis = Basis { reach, nearest, beside };
        Fitted { surfel: Surfel { end: basis.end(), ..surfel }, basis }
    }

    /// The pieces near the one that was fitted last, in order; none where it was not, for its normal is known.
    pub(super) fn found_by_fit<'a>(&self, scratch: &'a Scratch) -> &'a [Neighbor] {
        match (self.pieces.is_each(), &self.scans.normals) {
            (true, None) => scratch.neighbors(),
            (false, None) => scratch.near_representatives(),
            (_, Some(_)) => &[],
        }
    }
}
