//! Where a piece of surface ends: at the plane of another face of the same thing.

use cloudtouch_geom::{Covariance, Point3, UnitVector3, Vector3, normal};

/// Faces whose normals are farther apart than this cosine (45°) are others.
const OTHER: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Normals nearer to one another than this cosine (30°) are of one plane.
const ALIKE: f64 = 0.866;
/// A piece ends at no more planes than this: at a corner there are two besides its own.
const MOST_PLANES: usize = 2;
/// So many of the pieces around that are not of a plane are on the same side of it, where it is an end.
const ONE_SIDE: f64 = 0.6;

/// A piece of surface as those beside it see it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Face {
    /// Where it is expected, m.
    pub place: Point3,
    /// Its unit normal, of either sign.
    pub normal: Vector3,
    /// Variance of the place along the normal, m².
    pub across: f64,
}

impl Face {
    /// What is left of the covariance (m²) of the place of this piece, given the pieces of surface
    /// nearest to it, some sixteen; `None` where it ends at none of them.
    ///
    /// Behind the plane of another face, more than 45° from this one, there is nothing: most of the pieces
    /// around are on the other side of it. Noise and disc of this piece do not go on there. Given that, with
    /// z the height of the place above the plane in deviations of both (v = uᵀΣu + σ², u the normal of the
    /// plane and σ² its variance), variance along u falls as that of a Gaussian that is cut off:
    /// Σ − Σu(Σu)ᵀ r (z + r)/v, r = φ(z)/Φ(z). The mean stays, for planes of noisy samples are rounded
    /// where they meet. Never more than `covariance` in any direction.
    ///
    /// ```
    /// use cloudtouch_geom::{Covariance, Point3, Vector3};
    /// use cloudtouch_noise::Face;
    ///
    /// // On a wall, 1 mm above the bottom of a box that is 4 mm away.
    /// let face = |x, y, z, normal| Face { place: Point3::new(x, y, z), normal, across: 1e-8 };
    /// let wall = |y, z| face(0.0, y, z, Vector3::x());
    /// let around = [wall(0.004, 0.001), wall(-0.004, 0.001), wall(0.0, 0.005), wall(0.0, 0.009)];
    /// let bottom = [1.0, 2.0, 3.0].map(|k| face(0.004 * k, 0.0, 0.0, Vector3::z()));
    /// let near: Vec<Face> = around.into_iter().chain(bottom).collect();
    ///
    /// let noise = Covariance::isotropic(0.002_f64.powi(2));
    /// let left = wall(0.0, 0.001).cut_off(&noise, &near).ok_or("no end")?;
    /// assert!(left.std_along(&Vector3::z()) < 0.0015);
    /// assert!((left.std_along(&Vector3::y()) - 0.002).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn cut_off(&self, covariance: &Covariance, near: &[Self]) -> Option<Covariance> {
        let mut others: Vec<&Self> = near.iter().filter(|face| self.cosine(face) < OTHER).collect();
        let mut left = None;
        for _ in 0..MOST_PLANES {
            let Some(plane) = Plane::of_most(&others) else { break };
            others.retain(|face| !plane.is_of(face));
            if let Some(end) = plane.with_most_above(near.iter().chain([self])) {
                left = Some(end.left_of(left.as_ref().unwrap_or(covariance), &self.place));
            }
        }
        left
    }

    /// |cos| of the angle between two faces.
    fn cosine(&self, other: &Self) -> f64 {
        self.normal.dot(&other.normal).abs()
    }
}

/// The plane that some pieces of surface lie in.
struct Plane<'a> {
    /// The piece that the others are like.
    like: &'a Face,
    normal: UnitVector3,
    /// Height of the plane above that piece, m.
    level: f64,
    /// How well that is known, m².
    variance: f64,
}

impl<'a> Plane<'a> {
    /// Of the most that are alike, the first among as many.
    fn of_most(faces: &[&'a Face]) -> Option<Self> {
        let alike = |one: &Face| faces.iter().filter(|other| one.cosine(other) > ALIKE).count();
        let mut most: Option<(usize, &'a Face)> = None;
        for &face in faces {
            let count = alike(face);
            if most.is_none_or(|(known, _)| count > known) {
                most = Some((count, face));
            }
        }
        let (count, like) = most?;
        let own = || faces.iter().filter(|face| like.cosine(face) > ALIKE);
        let turned = |face: &Face| face.normal * face.normal.dot(&like.normal).signum();
        let normal = UnitVector3::new_normalize(own().map(|face| turned(face)).sum());
        let mean =
            |of: &dyn Fn(&Face) -> f64| own().map(|face| of(face)).sum::<f64>() / count as f64;
        let level = mean(&|face| normal.dot(&(face.place - like.place)));
        let variance = mean(&|face| face.across);
        Some(Self { like, normal, level, variance })
    }

    fn is_of(&self, face: &Face) -> bool {
        self.like.cosine(face) > ALIKE
    }

    fn height(&self, place: &Point3) -> f64 {
        self.normal.dot(&(place - self.like.place)) - self.level
    }

    /// The plane as an end, turned to the side that most of some pieces are on; `None` where most are on
    /// neither or, as far as is known, on both. Its own do not count.
    fn with_most_above<'f>(self, faces: impl Iterator<Item = &'f Face>) -> Option<Self> {
        let known = self.variance.sqrt();
        let (mut above, mut below, mut count) = (0, 0, 0);
        for face in faces.filter(|face| !self.is_of(face)) {
            let height = self.height(&face.place);
            above += usize::from(height > -known);
            below += usize::from(height < known);
            count += 1;
        }
        let are_most = |some: usize| some as f64 >= ONE_SIDE * f64::from(count);
        match (are_most(above), are_most(below)) {
            (true, false) => Some(self),
            (false, true) => Some(Self { normal: -self.normal, level: -self.level, ..self }),
            _ => None,
        }
    }

    /// Of the covariance of a place, given that what is there is above the plane.
    fn left_of(&self, covariance: &Covariance, place: &Point3) -> Covariance {
        let matrix = covariance.matrix();
        let gain = matrix * self.normal.into_inner();
        let total = self.normal.dot(&gain) + self.variance;
        if total <= 0.0 {
            return *covariance;
        }
        let z = self.height(place) / total.sqrt();
        let lost = gain * gain.transpose() * (lost(z) / total);
        Covariance::from_symmetric(&(matrix - lost))
    }
}

/// Where Φ leaves what doubles tell, its tail.
const DEEP: f64 = -30.0;

/// r (z + r): the share of the variance across a plane that goes.
fn lost(z: f64) -> f64 {
    if z < DEEP {
        // z + r cancels.
        return 1.0 - z.powi(-2);
    }
    let slope = slope(z);
    slope * (z + slope)
}

/// r = φ(z)/Φ(z).
fn slope(z: f64) -> f64 {
    if z < DEEP { -z - 1.0 / z + 2.0 / z.powi(3) } else { normal::density(z) / normal::cdf(z) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Beyond ten thousand deviations all of the variance went, and from some billions on none.
    #[test]
    fn what_is_left_far_below_a_plane_falls_with_the_square_of_the_depth() {
        for z in [-20.0, -29.9, -30.1, -1e3, -1e4, -1e6] {
            let left = 1.0 - lost(z);
            assert!((left * z * z - 1.0).abs() < 0.02, "{z}: {left}");
        }
        assert!(lost(-1e9) <= 1.0 && lost(-1e9) > 0.999);
    }
}
