//! How far apart two oriented boxes are, by separating axes.

use cloudtouch_geom::{Matrix3, Vector3};

use crate::Obb;

/// The separation of two boxes along the axis that separates them most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gap {
    /// Signed distance (m) between the projections of the boxes on `axis`.
    ///
    /// Positive: the boxes are disjoint, and this is at most their true distance, because a
    /// projection never lengthens. Negative: they overlap, and this is minus the shortest
    /// translation that would part them.
    pub signed: f64,
    /// Unit vector from the first box toward the second.
    ///
    /// When the gap is positive, the plane across it in the middle of the gap separates the boxes,
    /// and every point of either is at least half the gap away from it.
    pub axis: Vector3,
}

/// Below this sine² two edges count as parallel: their cross product is mostly rounding. Leaving an
/// axis out can only make the gap smaller, which is the safe side.
const PARALLEL: f64 = 1e-12;

/// The largest separation of two boxes in one frame over the 15 axes of the separating axis
/// theorem: three face normals of each and nine cross products of edges.
///
/// Reduced by the rounding of its own arithmetic, so that a positive gap is a lower bound of the
/// true distance in floating point too. Degenerate boxes (a point, a segment, a rectangle) and
/// parallel edges are ordinary input.
pub fn signed_gap(a: &Obb, b: &Obb) -> Gap {
    signed_gap_up_to(a, b, f64::INFINITY)
}

/// The same, but an axis with a gap of `enough` ends the search for a wider one; what is found is a
/// lower bound of the true distance all the same.
pub(crate) fn signed_gap_up_to(a: &Obb, b: &Obb, enough: f64) -> Gap {
    // Everything along the axes of a: b's axes are the columns of `r`, its centre is `t`. Plain
    // arrays: this is the innermost loop of every search.
    let columns = |m: &Matrix3| [0, 1, 2].map(|k| [m[(0, k)], m[(1, k)], m[(2, k)]]);
    let (axes_a, axes_b) = (columns(&a.axes), columns(&b.axes));
    let r = axes_a.map(|of_a| axes_b.map(|of_b| dot(&of_a, &of_b)));
    let abs_r = r.map(|row| row.map(f64::abs));
    let offset: [f64; 3] = (b.centre - a.centre).into();
    let t = axes_a.map(|of_a| dot(&of_a, &offset));
    let t_along_b = axes_b.map(|of_b| dot(&of_b, &offset));
    let (ha, hb): ([f64; 3], [f64; 3]) = (a.half_extents.into(), b.half_extents.into());
    let size = |v: &[f64; 3]| v[0].abs() + v[1].abs() + v[2].abs();
    let rounding = 8.0 * f64::EPSILON * (size(&t) + size(&ha) + size(&hb));

    let mut best = (f64::NEG_INFINITY, [1.0, 0.0, 0.0]);
    for i in 0..3 {
        let separation = t[i].abs() - ha[i] - dot(&abs_r[i], &hb);
        if separation > best.0 {
            let mut axis = [0.0; 3];
            axis[i] = 1.0;
            best = (separation, axis);
        }
    }
    if best.0 - rounding < enough {
        for j in 0..3 {
            let reach_a = abs_r[0][j] * ha[0] + abs_r[1][j] * ha[1] + abs_r[2][j] * ha[2];
            let separation = t_along_b[j].abs() - hb[j] - reach_a;
            if separation > best.0 {
                best = (separation, [r[0][j], r[1][j], r[2][j]]);
            }
        }
    }
    best.0 -= rounding;
    if best.0 < enough {
        best = across_edges(best, (&r, &abs_r), &t, (&ha, &hb), rounding);
    }
    let (signed, axis) = best;
    let axis = Vector3::from(axis);
    let toward_b = if axis.dot(&Vector3::from(t)) < 0.0 { -axis } else { axis };
    Gap { signed, axis: (a.axes * toward_b).normalize() }
}

/// The better of an axis already found and the nine across an edge of each box.
fn across_edges(
    mut best: (f64, [f64; 3]),
    (r, abs_r): (&[[f64; 3]; 3], &[[f64; 3]; 3]),
    t: &[f64; 3],
    (ha, hb): (&[f64; 3], &[f64; 3]),
    rounding: f64,
) -> (f64, [f64; 3]) {
    for i in 0..3 {
        let (i1, i2) = ((i + 1) % 3, (i + 2) % 3);
        for j in 0..3 {
            let (j1, j2) = ((j + 1) % 3, (j + 2) % 3);
            // e_i × r_j has the components −r[i2] at i1 and r[i1] at i2.
            let sine_squared = r[i1][j] * r[i1][j] + r[i2][j] * r[i2][j];
            if sine_squared < PARALLEL {
                continue;
            }
            let distance = (t[i2] * r[i1][j] - t[i1] * r[i2][j]).abs();
            let reach = ha[i1] * abs_r[i2][j]
                + ha[i2] * abs_r[i1][j]
                + hb[j1] * abs_r[i][j2]
                + hb[j2] * abs_r[i][j1];
            let numerator = distance - reach - rounding;
            // Most axes lose by far: compare before paying for the root.
            if best.0 > 0.0
                && (numerator <= 0.0 || numerator * numerator <= best.0 * best.0 * sine_squared)
            {
                continue;
            }
            let sine = sine_squared.sqrt();
            if numerator / sine > best.0 {
                let mut axis = [0.0; 3];
                axis[i1] = -r[i2][j] / sine;
                axis[i2] = r[i1][j] / sine;
                best = (numerator / sine, axis);
            }
        }
    }
    best
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Point3, Pose, seed};
    use proptest::prelude::*;

    use super::*;

    fn aligned(centre: [f64; 3], half: [f64; 3]) -> Obb {
        Obb {
            centre: Point3::from(centre),
            axes: Matrix3::identity(),
            half_extents: Vector3::from(half),
        }
    }

    fn any_box() -> impl Strategy<Value = Obb> {
        (
            prop::array::uniform3(-2.0..2.0_f64),
            prop::array::uniform3(-3.2..3.2_f64),
            // A third of the extents are zero, so that flat and thin boxes are common.
            prop::array::uniform3(prop_oneof![1 => Just(0.0), 2 => 0.0..1.0_f64]),
            // Exactly parallel axes are common too.
            any::<bool>(),
        )
            .prop_map(|(centre, angles, half, turned)| {
                let angles = if turned { angles } else { [0.0; 3] };
                aligned([0.0; 3], half)
                    .transformed(&Pose::from_translation_rpy(Vector3::from(centre), angles))
            })
    }

    /// Nearest distance by alternating projection between the two convex boxes: converges from
    /// above, so it never understates the distance.
    fn distance(a: &Obb, b: &Obb) -> f64 {
        let clamp = |o: &Obb, p: &Point3| {
            let local = o.to_local(p);
            let inside = local.sup(&-o.half_extents).inf(&o.half_extents);
            o.centre + o.axes * inside
        };
        let mut on_a = a.centre;
        let mut on_b = clamp(b, &on_a);
        for _ in 0..20_000 {
            on_a = clamp(a, &on_b);
            on_b = clamp(b, &on_a);
        }
        (on_a - on_b).norm()
    }

    fn interval(o: &Obb, axis: &Vector3) -> (f64, f64) {
        let (middle, half) = (o.centre.coords.dot(axis), o.half_width_along(axis));
        (middle - half, middle + half)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(1500))]

        #[test]
        fn never_exceeds_the_distance_and_has_its_sign(a in any_box(), b in any_box()) {
            let gap = signed_gap(&a, &b);
            let true_distance = distance(&a, &b);
            prop_assert!(gap.signed <= true_distance + 1e-12, "{} > {true_distance}", gap.signed);
            // The theorem: boxes apart are apart along one of the 15 axes, where the gap shrinks
            // at most by √3 for a corner against a corner. Alternating projection has converged
            // to 1e-3 when the boxes are that close.
            if true_distance > 5e-3 {
                prop_assert!(gap.signed > 0.0, "{} at distance {true_distance}", gap.signed);
            }
        }

        #[test]
        fn the_axis_shows_the_gap(a in any_box(), b in any_box()) {
            let gap = signed_gap(&a, &b);
            prop_assert!((gap.axis.norm() - 1.0).abs() < 1e-12);
            let (_, a_high) = interval(&a, &gap.axis);
            let (b_low, _) = interval(&b, &gap.axis);
            prop_assert!((b_low - a_high - gap.signed).abs() < 1e-9);
        }

        #[test]
        fn depth_is_the_shortest_parting_translation(a in any_box(), b in any_box()) {
            // Most random pairs are disjoint: pull the second toward the first.
            let mut b = b;
            b.centre = a.centre + (b.centre - a.centre) * 0.02;
            let gap = signed_gap(&a, &b);
            prop_assume!(gap.signed < 0.0);
            let mut parted = b;
            parted.centre += gap.axis * (-gap.signed + 1e-9);
            prop_assert!(signed_gap(&a, &parted).signed > 0.0);
            // No random direction parts them with less.
            for trial in 0..20 {
                let draw = |k| seed::unit(seed::derive(1, trial, k)) - 0.5;
                let direction = Vector3::new(draw(0), draw(1), draw(2)).normalize();
                let (_, a_high) = interval(&a, &direction);
                let (b_low, _) = interval(&b, &direction);
                prop_assert!(a_high - b_low >= -gap.signed - 1e-9);
            }
        }

        #[test]
        fn swapping_turns_the_axis(a in any_box(), b in any_box()) {
            let (ab, ba) = (signed_gap(&a, &b), signed_gap(&b, &a));
            prop_assert!((ab.signed - ba.signed).abs() < 1e-12);
        }

        #[test]
        fn aligned_boxes_have_the_analytic_gap(
            centre in prop::array::uniform3(-2.0..2.0_f64),
            half_a in prop::array::uniform3(0.0..1.0_f64),
            half_b in prop::array::uniform3(0.0..1.0_f64),
        ) {
            let gap = signed_gap(&aligned([0.0; 3], half_a), &aligned(centre, half_b));
            let expected = (0..3)
                .map(|k| centre[k].abs() - half_a[k] - half_b[k])
                .fold(f64::NEG_INFINITY, f64::max);
            prop_assert!((gap.signed - expected).abs() < 1e-13);
        }
    }

    #[test]
    fn crossed_edges_need_their_cross_product() {
        // Two square rods, each turned 45° about its length, crossing at right angles.
        let quarter = std::f64::consts::FRAC_PI_4;
        let along_x = aligned([0.0; 3], [1.0, 0.1, 0.1])
            .transformed(&Pose::from_translation_rpy(Vector3::zeros(), [quarter, 0.0, 0.0]));
        let along_y = aligned([0.0; 3], [0.1, 1.0, 0.1]).transformed(&Pose::from_translation_rpy(
            Vector3::new(0.0, 0.0, 0.3),
            [0.0, quarter, 0.0],
        ));
        let gap = signed_gap(&along_x, &along_y);
        assert!((gap.signed - (0.3 - 0.2 * 2.0_f64.sqrt())).abs() < 1e-12);
        assert!((gap.axis - Vector3::z()).norm() < 1e-12);
    }

    #[test]
    fn two_points_are_as_far_as_their_largest_coordinate() {
        let gap = signed_gap(&aligned([0.0; 3], [0.0; 3]), &aligned([3.0, 4.0, 0.0], [0.0; 3]));
        assert!((gap.signed - 4.0).abs() < 1e-13);
        let same = signed_gap(&aligned([1.0; 3], [0.0; 3]), &aligned([1.0; 3], [0.0; 3]));
        assert!(same.signed <= 0.0 && same.signed > -1e-13);
    }
}
