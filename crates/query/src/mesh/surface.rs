//! The surface of a mesh about a place, in parts small enough to count by a few places each.

use cloudtouch_geom::{Point3, Vector3};

use super::prepare::Mesh;
use super::subdivide::{MAX_DEPTH, halved};
use super::winding::{Winding, centroid};

/// A place that stands for a part of a surface.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Piece {
    pub place: Point3,
    /// Of the part, m².
    pub area: f64,
    /// The same times its unit normal, out of what it encloses; zero where it encloses nothing.
    pub outward: Vector3,
}

impl Mesh {
    /// Calls `visit` with pieces that stand for all the surface within `reach` (m) of a
    /// place, and may go on beyond: three for a triangle or a piece of one that reaches no farther than
    /// `fine` (m) from its middle, where its sides are halved, which is as good as the whole of it for all
    /// that is quadratic in the place; and one for a group of triangles half as wide. Local frame.
    pub(crate) fn visit_surface_within(
        &self,
        place: &Point3,
        reach: f64,
        fine: f64,
        mut visit: impl FnMut(Piece),
    ) {
        for (part, is_solid) in
            [(Some(&self.winding), self.has_solids()), (self.sheets.as_ref(), false)]
        {
            let outward = |piece: &Piece| if is_solid { piece.outward } else { Vector3::zeros() };
            let mut visit = |piece: Piece| visit(Piece { outward: outward(&piece), ..piece });
            if let Some(part) = part {
                visit_within(part, (place, reach), fine, &mut visit);
            }
        }
    }
}

fn visit_within(
    part: &Winding,
    (place, reach): (&Point3, f64),
    fine: f64,
    visit: &mut impl FnMut(Piece),
) {
    let mut at = 0;
    while let Some(group) = part.groups.get(at) {
        let beyond = reach + group.squared_radius.sqrt();
        at = if (group.center - place).norm_squared() > beyond * beyond {
            group.next
        } else if 4.0 * group.squared_radius <= fine * fine {
            visit(Piece { place: group.center, area: group.size, outward: group.area });
            group.next
        } else if group.is_leaf {
            let [from, to] = group.range;
            for triangle in &part.triangles()[from..to] {
                visit_parts(*triangle, (place, reach), fine, MAX_DEPTH, visit);
            }
            group.next
        } else {
            at + 1
        };
    }
}

/// The parts of a triangle, halved across its longest side.
fn visit_parts(
    corners: [Point3; 3],
    (place, reach): (&Point3, f64),
    fine: f64,
    halvings: usize,
    visit: &mut impl FnMut(Piece),
) {
    let [a, b, c] = corners;
    let middle = centroid(&corners);
    let squared = |corner: &Point3| (corner - middle).norm_squared();
    let radius = corners.iter().map(squared).fold(0.0, f64::max).sqrt();
    let beyond = reach + radius;
    if (middle - place).norm_squared() > beyond * beyond {
        return;
    }
    // PERF: most are small enough, and need not be halved to be told so.
    let is_small = radius <= fine || halvings == 0;
    match (!is_small).then(|| halved(&corners).1).flatten() {
        Some(halves) => {
            for half in halves {
                visit_parts(half, (place, reach), fine, halvings - 1, visit);
            }
        }
        None => {
            let third = (b - a).cross(&(c - a)) / 6.0;
            let area = third.norm();
            for (from, to) in [(a, b), (b, c), (c, a)] {
                visit(Piece { place: nalgebra::center(&from, &to), area, outward: third });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Pose, TriangleMesh, Vector3};
    use cloudtouch_testkit::scene;
    use proptest::prelude::*;

    use super::*;

    fn parts(mesh: &TriangleMesh, reach: f64, fine: f64) -> Vec<(Point3, f64)> {
        pieces(mesh, reach, fine).into_iter().map(|piece| (piece.place, piece.area)).collect()
    }

    fn pieces(mesh: &TriangleMesh, reach: f64, fine: f64) -> Vec<Piece> {
        let mut pieces = Vec::new();
        let prepared = Mesh::prepare(mesh).unwrap();
        let place = Point3::new(0.1, 0.05, 0.0);
        prepared.visit_surface_within(&place, reach, fine, |piece| pieces.push(piece));
        pieces
    }

    #[test]
    fn parts_of_a_sheet_have_its_area_and_their_middles_its_middle() {
        for edge in [0.8, 0.1, 0.02] {
            let sheet = scene::subdivide_to_max_edge(&scene::plane_patch(0.8), edge);
            let parts = parts(&sheet, 10.0, 0.05);
            let area: f64 = parts.iter().map(|part| part.1).sum();
            let middle = parts.iter().map(|part| part.0.coords * part.1).sum::<Vector3>();
            assert!((area - 0.64).abs() < 1e-9 && middle.norm() < 1e-9, "{edge}: {area} {middle}");
            // As exact as the sheet itself, about its middle.
            let square = |part: &(Point3, f64)| part.0.x * part.0.x * part.1;
            let squares: f64 = parts.iter().map(square).sum();
            assert!((squares / (0.8_f64.powi(4) / 12.0) - 1.0).abs() < 0.01, "{edge}: {squares}");
            // As many as the sheet needs, however fine its triangles are.
            assert!((240..=2048).contains(&parts.len()), "{edge}: {}", parts.len());
        }
    }

    #[test]
    fn a_sheet_beside_a_closed_part_was_left_out() {
        let aside = Pose::from_translation(Vector3::new(0.0, 0.0, 0.5));
        let block = scene::moved(&scene::cuboid([0.2; 3]), &aside);
        let both = scene::assemble([scene::plane_patch(0.8), block]);
        let area: f64 = parts(&both, 10.0, 0.05).iter().map(|part| part.1).sum();
        assert!((area - (0.64 + 0.24)).abs() < 1e-9, "{area}");
    }

    /// A closed part knows its outside, and a sheet beside it has none.
    #[test]
    fn pieces_of_what_encloses_something_look_out_of_it() {
        let aside = Pose::from_translation(Vector3::new(0.0, 0.0, 0.5));
        // About the middle of the box around both.
        let centre = Point3::new(0.0, 0.0, 0.15);
        for edge in [0.2, 0.02] {
            let ball = scene::subdivide_to_max_edge(&scene::sphere(0.2, 3), edge);
            let both = scene::assemble([scene::plane_patch(0.8), scene::moved(&ball, &aside)]);
            let pieces = pieces(&both, 9.0, 0.1);
            let (of_sheet, of_ball): (Vec<&Piece>, Vec<&Piece>) =
                pieces.iter().partition(|piece| piece.place.z < -0.2);
            let looks_out = |piece: &&&Piece| {
                let (out, length) = (piece.place - centre, piece.outward.norm());
                piece.outward.dot(&out) > 0.95 * length * out.norm() && length > 0.8 * piece.area
            };
            assert_eq!(of_ball.iter().filter(looks_out).count(), of_ball.len(), "{edge}");
            assert!(of_ball.len() > 9 && of_sheet.len() > 50, "{edge}");
            assert!(of_sheet.iter().all(|piece| piece.outward == Vector3::zeros()), "{edge}");
        }
        let sheet = self::pieces(&scene::plane_patch(0.8), 9.0, 0.1);
        assert!(sheet.iter().all(|piece| piece.outward == Vector3::zeros()));
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 32, failure_persistence: None, ..ProptestConfig::default() })]

        /// Beside the area of the disc that is cut out of the sheet.
        #[test]
        fn what_is_within_reach_is_visited_and_hardly_more(reach in 0.05..0.25_f64, edge in 0.02..0.8_f64) {
            let sheet = scene::subdivide_to_max_edge(&scene::plane_patch(0.8), edge);
            let fine = 0.05 * reach;
            let area: f64 = parts(&sheet, reach, fine).iter().map(|part| part.1).sum();
            let disc = |radius: f64| std::f64::consts::PI * radius * radius;
            prop_assert!(area >= disc(reach) - 1e-12, "{area} of {}", disc(reach));
            prop_assert!(area <= disc(reach + 2.0 * fine) + 1e-12, "{area} of {}", disc(reach));
        }
    }
}
