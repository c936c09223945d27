//! The triangles of a mesh that are within so many deviations of a place, or that something may pass through.

use std::cell::Cell;

use cloudtouch_bvh::{NodeId, Obb};
use cloudtouch_geom::{Matrix3, Motion, Point3, Vector3};

use crate::body::BodyRef;
use crate::cloud::Surfel;
use crate::search::compare::facet::Facet;
use crate::search::compare::whitening::Whitening;

use super::around::OfMesh;

/// Of what is told of boxes, relative, generously.
const ROUNDING: f64 = 1e-9;

/// A place in the frame of A, and how lengths about it are measured.
#[derive(Debug, Clone, Copy)]
pub(in crate::search) struct Metric {
    place: Point3,
    /// Maps directions to lengths in deviations when they are across a plane, and their largest square.
    root: Matrix3,
    most: f64,
}

impl Metric {
    /// In the deviations of a piece.
    pub(in crate::search) fn of(surfel: &Surfel, whitening: &Whitening) -> Self {
        Self { place: surfel.point.mean, root: *whitening.root(), most: surfel.most_variance }
    }

    /// In metres.
    pub(in crate::search) fn metres(place: Point3) -> Self {
        Self { place, root: Matrix3::identity(), most: 1.0 }
    }

    /// The same in the local frame of a mesh.
    fn back(&self, a_from_mesh: Option<&Motion>) -> Self {
        a_from_mesh.map_or(*self, |motion| Self {
            place: motion.point_back(&self.place),
            root: self.root * motion.rotation(),
            ..*self
        })
    }

    /// The square of how far a box is at least: across each of its faces, and the shortest way.
    fn squared_to(&self, obb: &Obb) -> f64 {
        let offset = self.place - obb.centre;
        let slack = ROUNDING * (offset.lp_norm(1) + obb.half_extents.sum());
        let beyond = obb.to_local(&self.place).abs() - obb.half_extents;
        let beyond = beyond.map(|along| (along - slack).max(0.0));
        let across = |k: usize| match beyond[k] {
            0.0 => 0.0,
            gap => gap * gap / (self.root * obb.axes.column(k)).norm_squared(),
        };
        (0..3).map(across).fold(beyond.norm_squared() / self.most, f64::max)
    }
}

/// What may pass through facets: the piece of a plane about a place, or a straight line.
#[derive(Debug, Clone, Copy)]
pub(in crate::search) enum Passing {
    /// Within a radius (m) of its middle, across a unit normal.
    Disc {
        middle: Point3,
        normal: Vector3,
        radius: f64,
    },
    Line {
        ends: [Point3; 2],
    },
}

impl Passing {
    /// The same in the local frame of a mesh.
    fn back(self, a_from_mesh: Option<&Motion>) -> Self {
        let Some(motion) = a_from_mesh else { return self };
        match self {
            Self::Disc { middle, normal, radius } => Self::Disc {
                middle: motion.point_back(&middle),
                normal: motion.vector_back(&normal),
                radius,
            },
            Self::Line { ends } => Self::Line { ends: ends.map(|end| motion.point_back(&end)) },
        }
    }

    /// Whether it may pass through what is in a box: not where a face parts them, nor the plane of a disc.
    fn may_pass(&self, obb: &Obb) -> bool {
        let slack = |offset: &Vector3| ROUNDING * (offset.lp_norm(1) + obb.half_extents.sum());
        match self {
            Self::Disc { middle, normal, radius } => {
                let offset = middle - obb.centre;
                let slack = slack(&offset);
                let half = obb.half_width_along(normal);
                let beyond = obb.to_local(middle).abs() - obb.half_extents;
                normal.dot(&offset).abs() <= half + slack
                    && beyond.map(|along| along.max(0.0)).norm() <= radius + slack
            }
            Self::Line { ends: [from, to] } => {
                let offset = nalgebra::center(from, to) - obb.centre;
                let half = obb.axes.tr_mul(&(0.5 * (to - from))).abs();
                let beyond = obb.axes.tr_mul(&offset).abs() - half - obb.half_extents;
                beyond.max() <= slack(&offset)
            }
        }
    }
}

impl OfMesh<'_> {
    /// Calls `visit` for the facets of each leaf that may be less than so many deviations off, squared; it says what
    /// counts from then on. None of a cloud.
    pub(in crate::search) fn visit_within(
        &mut self,
        metric: &Metric,
        squared: f64,
        mut visit: impl FnMut(NodeId, &[Facet]) -> f64,
    ) {
        let local = metric.back(self.a_from_mesh);
        let limit = Cell::new(squared);
        let is_within = |obb: &Obb| local.squared_to(obb) < limit.get();
        self.visit_where(is_within, |id, facets| limit.set(visit(id, facets)));
    }

    /// Calls `visit` for the facets of each leaf that something may pass through. None of a cloud.
    pub(in crate::search) fn visit_passed(
        &mut self,
        by: Passing,
        visit: impl FnMut(NodeId, &[Facet]),
    ) {
        let local = by.back(self.a_from_mesh);
        self.visit_where(|obb| local.may_pass(obb), visit);
    }

    fn visit_where(
        &mut self,
        is_wanted: impl Fn(&Obb) -> bool,
        mut visit: impl FnMut(NodeId, &[Facet]),
    ) {
        let Self { known, body, a_from_mesh } = self;
        let BodyRef::Mesh(mesh) = *body else { return };
        mesh.visit_leaves_where(is_wanted, |leaf| {
            visit(leaf.id(), known.facets(mesh, leaf.id(), *a_from_mesh));
        });
    }
}
