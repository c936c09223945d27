//! Second-order cone algebra in up to four dimensions; shorter vectors are padded with zeros.

use nalgebra::{Matrix4, Vector4};

/// First component, and the norm of the others.
fn parts(x: &Vector4<f64>) -> (f64, f64) {
    (x[0], x.fixed_rows::<3>(1).norm())
}

/// x₀² − |x₁|², as a product so that it keeps its digits near the boundary.
pub(crate) fn determinant(x: &Vector4<f64>) -> f64 {
    let (head, tail) = parts(x);
    (head - tail) * (head + tail)
}

/// The Jordan product (aᵀb, a₀b₁ + b₀a₁).
pub(crate) fn product(a: &Vector4<f64>, b: &Vector4<f64>) -> Vector4<f64> {
    let mut c = b * a[0] + a * b[0];
    c[0] = a.dot(b);
    c
}

/// The y with a∘y = b.
pub(crate) fn quotient(a: &Vector4<f64>, b: &Vector4<f64>) -> Vector4<f64> {
    let head = (2.0 * a[0] * b[0] - a.dot(b)) / determinant(a);
    let mut y = (b - a * head) / a[0];
    y[0] = head;
    y
}

/// The largest step from x along d that stays in the cone, at most 1.
pub(crate) fn longest_step(x: &Vector4<f64>, d: &Vector4<f64>) -> f64 {
    let square = |a: &Vector4<f64>, b: &Vector4<f64>| 2.0 * a[0] * b[0] - a.dot(b);
    // det(x + t d) = c + 2 b t + a t².
    let (a, b, c) = (determinant(d), square(x, d), determinant(x));
    // Without a tail the root is double, and rounding may leave it no real root: the first
    // component alone, which the boundary never outlasts, bounds the step as well.
    let bound = if d[0] < 0.0 { (-x[0] / d[0]).min(1.0) } else { 1.0 };
    let discriminant = b * b - a * c;
    if discriminant < 0.0 || (a >= 0.0 && b >= 0.0) {
        return bound;
    }
    let q = -(b + discriminant.sqrt().copysign(b));
    [q / a, c / q].into_iter().filter(|t| *t > 0.0).fold(bound, f64::min)
}

/// The Nesterov–Todd scaling W of a pair: W z = W⁻¹ s = λ, with W = β(2 q qᵀ − J) as a square root
/// of H = β²(2 w wᵀ − J).
pub(crate) struct Scaling {
    beta: f64,
    w: Vector4<f64>,
    /// The scaled point.
    pub(crate) lambda: Vector4<f64>,
}

impl Scaling {
    /// `None` when rounding has put z or s on the boundary.
    pub(crate) fn of(z: &Vector4<f64>, s: &Vector4<f64>) -> Option<Self> {
        let (det_z, det_s) = (determinant(z), determinant(s));
        if !(det_z > 0.0 && det_s > 0.0 && z[0] > 0.0 && s[0] > 0.0) {
            return None;
        }
        let (unit_z, unit_s) = (z / det_z.sqrt(), s / det_s.sqrt());
        let middle = (0.5 * (1.0 + unit_z.dot(&unit_s))).sqrt();
        let mut w = unit_s - unit_z;
        w[0] = unit_s[0] + unit_z[0];
        w /= 2.0 * middle;
        let mut scaling = Self { beta: (det_s / det_z).powf(0.25), w, lambda: Vector4::zeros() };
        scaling.lambda = scaling.apply(z);
        Some(scaling)
    }

    /// W x.
    pub(crate) fn apply(&self, x: &Vector4<f64>) -> Vector4<f64> {
        Self::unit_apply(&self.w, x) * self.beta
    }

    /// W⁻¹ x.
    pub(crate) fn apply_inverse(&self, x: &Vector4<f64>) -> Vector4<f64> {
        let mut mirrored = -self.w;
        mirrored[0] = self.w[0];
        Self::unit_apply(&mirrored, x) / self.beta
    }

    /// [w₀ w₁ᵀ; w₁ I + w₁w₁ᵀ/(1+w₀)] x.
    fn unit_apply(w: &Vector4<f64>, x: &Vector4<f64>) -> Vector4<f64> {
        let head = w.dot(x);
        let along = (head - w[0] * x[0]) / (1.0 + w[0]) + x[0];
        let mut y = x + w * along;
        y[0] = head;
        y
    }

    /// H x.
    pub(crate) fn apply_squared(&self, x: &Vector4<f64>) -> Vector4<f64> {
        let mut y = self.w * (2.0 * self.w.dot(x)) + x;
        y[0] -= 2.0 * x[0];
        y * (self.beta * self.beta)
    }

    /// H = W².
    pub(crate) fn squared(&self) -> Matrix4<f64> {
        let mut h = self.w * self.w.transpose() * 2.0 + Matrix4::identity();
        h[(0, 0)] -= 2.0;
        h * (self.beta * self.beta)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn interior() -> impl Strategy<Value = Vector4<f64>> {
        (prop::array::uniform3(-1.0..1.0_f64), -3.0..3.0_f64, 0..4_usize).prop_map(
            |(tail, head, pad)| {
                let mut x = Vector4::new(0.0, tail[0], tail[1], tail[2]);
                (4 - pad..4).for_each(|k| x[k] = 0.0);
                x[0] = x.norm() + 10_f64.powf(head);
                x
            },
        )
    }

    proptest! {
        #[test]
        fn the_scaling_maps_both_to_one_point(z in interior(), s in interior()) {
            let scaling = Scaling::of(&z, &s).unwrap();
            let size = scaling.lambda.norm();
            prop_assert!((scaling.apply(&z) - scaling.apply_inverse(&s)).norm() < 1e-9 * size);
            prop_assert!((scaling.squared() * z - s).norm() < 1e-8 * s.norm());
            prop_assert!((scaling.apply_squared(&z) - s).norm() < 1e-8 * s.norm());
            prop_assert!((scaling.apply(&scaling.apply(&z)) - s).norm() < 1e-8 * s.norm());
        }

        #[test]
        fn quotient_undoes_product(a in interior(), b in interior()) {
            prop_assert!((quotient(&a, &product(&a, &b)) - b).norm() < 1e-8 * b.norm());
        }

        #[test]
        fn the_longest_step_ends_on_the_boundary(x in interior(), d in prop::array::uniform4(-9.0..9.0_f64)) {
            let d = Vector4::from(d);
            let t = longest_step(&x, &d);
            let inside = |t: f64| { let y = x + d * t; y[0] - y.fixed_rows::<3>(1).norm() };
            prop_assert!(inside(t * (1.0 - 1e-9)) >= -1e-9 * x[0]);
            if t < 1.0 {
                prop_assert!(inside(t * (1.0 + 1e-6)) < 1e-6 * (x[0] + d.norm() * t));
            }
        }
    }

    #[test]
    fn without_a_tail_the_step_ends_where_the_first_component_does() {
        // The determinant has a double root there, which rounding can leave without a real one.
        for k in 1..1000 {
            let (x, d) = (0.1 * f64::from(k), -37.0 / f64::from(k) - 0.11 * f64::from(k));
            let along = |value: f64| Vector4::new(value, 0.0, 0.0, 0.0);
            let t = longest_step(&along(x), &along(d));
            assert!((t + x / d).abs() <= 1e-7, "{t} for {x} along {d}");
            // The quotient itself is rounded; what the solver does is stop short of it.
            assert!(x + 0.99 * t * d > 0.0);
        }
    }
}
