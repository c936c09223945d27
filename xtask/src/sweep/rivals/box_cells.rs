//! A cloud as the boxes of a collision map.

use cloudtouch_geom::Point3;
use parry3d_f64::{
    bounding_volume::Aabb,
    math::Vector,
    partitioning::{Bvh, BvhBuildStrategy},
};

/// The cells of a grid that points fall into; the grid has a corner in the origin.
#[derive(Debug)]
pub(super) struct BoxCells {
    /// Middles of the cells, in the order of their coordinates, m.
    pub centers: Vec<Vector>,
    /// Half the side of a cell, m.
    pub half: f64,
}

impl BoxCells {
    /// The cells of side `side` that hold a point.
    pub(super) fn around(points: &[Point3], side: f64) -> Self {
        let mut corners: Vec<[f64; 3]> =
            points.iter().map(|p| p.coords.map(|v| (v / side).floor()).into()).collect();
        let by_axis = |a: &[f64; 3], b: &[f64; 3]| {
            a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])).then(a[2].total_cmp(&b[2]))
        };
        corners.sort_unstable_by(by_axis);
        corners.dedup();
        let centers = corners.iter().map(|c| Vector::from(c.map(|v| (v + 0.5) * side))).collect();
        Self { centers, half: 0.5 * side }
    }

    /// A tree over the boxes, whose leaves are named by their place in [`Self::centers`].
    pub(super) fn tree(&self) -> Bvh {
        let half = Vector::splat(self.half);
        let boxes: Vec<Aabb> =
            self.centers.iter().map(|&c| Aabb::from_half_extents(c, half)).collect();
        Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_is_in_a_cell_and_no_cell_is_there_twice() {
        let points: Vec<Point3> = [-0.011, -0.001, 0.0, 0.004, 0.0099, 0.01]
            .map(|x| Point3::new(x, 0.105, -0.0))
            .to_vec();
        let cells = BoxCells::around(&points, 0.01);
        let middles: Vec<f64> = cells.centers.iter().map(|c| (c.x * 1e3).round()).collect();
        assert_eq!(middles, [-15.0, -5.0, 5.0, 15.0]);
        assert_eq!(cells.half, 0.005);
        for p in &points {
            let inside =
                |c: &Vector| (0..3).all(|k| (p[k] - c[k]).abs() <= cells.half * (1.0 + 1e-12));
            assert!(cells.centers.iter().any(inside), "{p}");
        }
    }
}
