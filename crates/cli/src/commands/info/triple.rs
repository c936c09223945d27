//! Coordinates as they are printed.

use cloudtouch::geom::Point3;

pub(super) fn triple(p: &Point3) -> String {
    format!("({:.3}, {:.3}, {:.3})", p.x, p.y, p.z)
}
