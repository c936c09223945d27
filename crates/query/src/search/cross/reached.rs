//! Places that a mesh reaches about a disc, and what moves them as the mesh moves.

use cloudtouch_geom::Vector3;

/// A place of a mesh in the coordinates of a disc.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reached {
    pub at: Vector3,
    pub pulled_by: Pull,
}

/// What the height of a place, or its distance from the middle, changes by as the mesh moves.
#[derive(Debug, Clone, Copy)]
pub(super) enum Pull {
    Known(Vector3),
    /// On an edge that runs so, where it passes the wall of the cylinder.
    Wall(Vector3),
    /// On the rim of the disc in a plane with this normal.
    Rim(Vector3),
}

impl Reached {
    /// What its height or distance changes by as the mesh moves, in the coordinates of a disc so wide. Of few
    /// places, so that it is told when it is asked for.
    pub(super) fn force(&self, radius: f64) -> Vector3 {
        let Self { at, pulled_by } = self;
        match pulled_by {
            Pull::Known(force) => *force,
            Pull::Wall(along) => {
                // It keeps to the wall, by its way along the edge.
                let outward = Vector3::new(at.x, at.y, 0.0) / radius;
                Vector3::z() - outward * (along.z / outward.dot(along))
            }
            Pull::Rim(normal) => normal / normal.z,
        }
    }
}

/// Where a facet passes height zero, nearest to the middle.
pub(super) fn passes_nearest(corners: &[Vector3; 3]) -> Option<Reached> {
    let mut ends = (0..3).filter_map(|k| {
        let (from, to) = (corners[k], corners[(k + 1) % 3]);
        let crosses = (from.z < 0.0) != (to.z < 0.0);
        crosses.then(|| (from + (to - from) * (from.z / (from.z - to.z)), to - from))
    });
    let ((from, edge_from), (to, edge_to)) = (ends.next()?, ends.next()?);
    let along = to - from;
    let length = along.norm_squared();
    let t = if length > 0.0 { (-from.dot(&along) / length).clamp(0.0, 1.0) } else { 0.0 };
    let at = from + along * t;
    let away = at.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
    let force = if t > 0.0 && t < 1.0 {
        // Across the line where both planes meet, as the plane of the facet moves.
        let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
        normal / normal.dot(&away)
    } else {
        let edge = if t > 0.0 { edge_to } else { edge_from };
        away - Vector3::z() * (away.dot(&edge) / edge.z)
    };
    Some(Reached { at, pulled_by: Pull::Known(force) })
}
