//! The ball step: the best cone vector of one point while all multipliers stay.

use cloudtouch_geom::Vector3;

/// Newton's method ends when the length is off by this share: its next step would square that, but
/// the ball step itself is one of many.
const ROUGHLY: f64 = 1e-11;

/// Minimises ½ pᵀMp − h·p over |p| ≤ `radius`, with M = diag(`m`) and m descending and ≥ 0.
///
/// Axes with m = 0 must have h = 0 (a direction without variance has no gradient either) and get 0.
/// Isotropic M takes the closed form, others Newton's method on 1/`radius` − 1/|p(μ)| = 0, which
/// climbs monotonically from the lower bound |h|/`radius` − m₁.
pub(crate) fn ball_minimiser(m: &Vector3, h: &Vector3, radius: f64) -> Vector3 {
    let length = h.norm();
    if radius <= 0.0 || length == 0.0 || !length.is_finite() {
        return Vector3::zeros();
    }
    let at = |mu: f64| Vector3::from_fn(|k, _| if h[k] == 0.0 { 0.0 } else { h[k] / (m[k] + mu) });
    if m[0] - m[2] <= 1e-12 * m[0] {
        return if length <= m[0] * radius { h / m[0] } else { h * (radius / length) };
    }
    let free = at(0.0);
    if length_of(&free) <= radius {
        return free;
    }
    let mut mu = (length / radius - m[0]).max(0.0);
    for _ in 0..50 {
        let inverse = Vector3::from_fn(|k, _| if h[k] == 0.0 { 0.0 } else { 1.0 / (m[k] + mu) });
        let p = h.component_mul(&inverse);
        let squared = p.norm_squared();
        let excess = squared.sqrt() / radius - 1.0;
        if excess <= ROUGHLY {
            break;
        }
        let step = squared / p.component_mul(&p).dot(&inverse) * excess;
        if !step.is_finite() || mu + step == mu {
            break;
        }
        mu += step;
    }
    // What is left, and the last rounding: never leave the ball.
    clip_to_ball(&at(mu), radius)
}

/// `p`, shortened to `radius` when it is longer.
pub(crate) fn clip_to_ball(p: &Vector3, radius: f64) -> Vector3 {
    let norm = length_of(p);
    if norm > radius { p * (radius / norm) } else { *p }
}

/// Below it the squares of what a vector is made of lose digits, and vanish.
const SQUARABLE: f64 = 1e-145;

/// How long a vector is, however short.
fn length_of(p: &Vector3) -> f64 {
    let norm = p.norm();
    let largest = p.amax();
    if norm < SQUARABLE && largest > 0.0 { (p / largest).norm() * largest } else { norm }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn what_is_too_short_to_be_squared_is_clipped_too() {
        for (at, radius) in [(1e-304, f64::MIN_POSITIVE), (1e-160, 1e-170), (-1e-200, 1e-200)] {
            let clipped = clip_to_ball(&Vector3::repeat(at), radius);
            let expected = radius / 3_f64.sqrt() * at.signum();
            assert!((clipped / expected - Vector3::repeat(1.0)).amax() < 1e-9, "{at} {clipped}");
            let within = Vector3::repeat(0.5 * at.signum() * radius);
            assert_eq!(clip_to_ball(&within, radius), within);
        }
    }

    proptest! {
        #[test]
        fn satisfies_the_optimality_conditions(
            m in prop::array::uniform3(-6.0..3.0_f64),
            h in prop::array::uniform3(-1.0..1.0_f64),
            radius in -4.0..4.0_f64,
            shape in 0..4,
        ) {
            let mut m = m.map(|e| 10_f64.powf(e));
            m.sort_by(|a, b| b.total_cmp(a));
            let (mut m, mut h, radius) = (Vector3::from(m), Vector3::from(h), 10_f64.powf(radius));
            match shape {
                1 => m = Vector3::repeat(m[0]),
                2 => { m[2] = 0.0; h[2] = 0.0; }
                3 => { m[1] = 0.0; h[1] = 0.0; m[2] = 0.0; h[2] = 0.0; }
                _ => {}
            }
            let p = ball_minimiser(&m, &h, radius);
            prop_assert!(p.norm() <= radius * (1.0 + 1e-12));
            // h − Mp must be a non-negative multiple of p, and zero inside the ball.
            let residual = h - m.component_mul(&p);
            if p.norm() < radius * (1.0 - 1e-9) {
                prop_assert!(residual.norm() <= 1e-9 * h.norm());
            } else {
                let multiplier = residual.dot(&p) / p.norm_squared();
                prop_assert!(multiplier >= -1e-9 * m[0]);
                prop_assert!((residual - p * multiplier).norm() <= 1e-8 * h.norm());
            }
        }
    }
}
