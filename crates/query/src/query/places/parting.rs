//! Which way two bodies part where they touch: across the plane that best separates what is around there.
//!
//! The normal of the pieces that touch says little of it: where an edge or a corner meets a face their
//! normals differ, and where surfaces cross none knows its side. Fisher's linear discriminant (1936) of the
//! samples of both bodies does: the direction along which their means are farthest apart for how far they
//! spread along it, S⁻¹(m_b − m_a). See docs/decisions/0026-normals-that-part.md.

use cloudtouch_geom::{Matrix3, Point3, Vector3};
use cloudtouch_noise::Scratch;

use super::spots::{Spot, Spots};
use crate::body::BodyRef;
use crate::cloud::Surfel;

/// The surroundings reach so many units, each the spacing of the samples or their noise. The first count in
/// which the bodies stand apart: in a deep overlap that is seen from farther off.
const REACHES: [f64; 3] = [3.0, 6.0, 12.0];
/// They do where the squared distance of their means is so many times their squared spread along it.
const APART: f64 = 1.0;
/// Where the outsides of surfaces look so far the other way, they have passed through one another: 1 is of flat ones.
const PASSED: f64 = 0.5;
/// Surfaces are not flatter than this part of a unit.
const ROUGHNESS: f64 = 0.2;
/// Parts of a mesh reach no farther than this part of its surroundings, and count by three places each.
const FINE: f64 = 0.5;

/// Contacts so many units from one whose direction is known have it too: they have most of their
/// surroundings in common.
const SHARED: f64 = 1.5;

/// Directions in which B leaves A, found so far.
#[derive(Debug, Default)]
pub(super) struct Partings(Vec<Parting>);

#[derive(Debug)]
struct Parting {
    place: Point3,
    /// How far from there it holds, m.
    within: f64,
    direction: Option<Vector3>,
}

impl Partings {
    /// The unit vector along which B leaves A at a spot; its own normal where one of them has no sample
    /// around.
    pub(super) fn at(&mut self, spot: &Spot, spots: &Spots<'_>) -> Vector3 {
        let is_near = |known: &Parting| (known.place - spot.place).norm() <= known.within;
        let at = self.0.iter().position(is_near).unwrap_or_else(|| {
            self.0.push(spots.parting(spot));
            self.0.len() - 1
        });
        self.0[at].direction.unwrap_or(spot.normal)
    }
}

impl Spots<'_> {
    fn parting(&self, spot: &Spot) -> Parting {
        let (a, b) = self.bodies;
        let in_b = self.a_from_b.point_back(&spot.place);
        let grains = [grain(a, &spot.place), grain(b, &in_b)];
        let unit =
            grains.iter().fold(spot.spacing, |most, grain| most.max(grain.spacing).max(grain.std));
        let own =
            (ROUGHNESS * unit).powi(2) + grains.iter().map(|grain| grain.std.powi(2)).sum::<f64>();
        let mut direction = None;
        let rotation = self.a_from_b.rotation();
        for reach in REACHES.map(|units| units * unit) {
            let of_a = Surroundings::of(a, spot.place, reach);
            let of_b = Surroundings::of(b, in_b, reach);
            let (Some(of_a), Some(of_b)) = (of_a.moments(), of_b.moments()) else { continue };
            let apart = self.a_from_b.vector(&of_b.mean) - of_a.mean;
            let spread = of_a.spread
                + rotation * of_b.spread * rotation.transpose()
                + Matrix3::identity() * own;
            let Some(across) = spread.cholesky().map(|root| root.solve(&apart)) else { continue };
            let outward = of_a.outward - self.a_from_b.vector(&of_b.outward);
            let Some(toward_b) = across.try_normalize(0.0) else { continue };
            // From face to face of two that are in each other the way out is back.
            let have_passed = outward.dot(&toward_b) < -PASSED;
            direction = Some(if have_passed { -toward_b } else { toward_b });
            if across.dot(&apart) >= APART {
                break;
            }
        }
        Parting { place: spot.place, within: SHARED * unit, direction }
    }
}

/// How finely a surface is known, m: the distance of its samples, and their noise.
#[derive(Debug, Clone, Copy, Default)]
struct Grain {
    spacing: f64,
    std: f64,
}

/// Of the piece nearest to a place; none of what is exact.
fn grain(body: BodyRef<'_>, place: &Point3) -> Grain {
    let BodyRef::Cloud(cloud) = body else { return Grain::default() };
    let of = |(_, nearest): &(u32, Surfel)| Grain {
        spacing: nearest.spacing,
        std: cloud.sensor_std(nearest.index),
    };
    let nearest = cloud.prepared().fits_near(place, 1, &mut Scratch::default());
    nearest.first().map(of).unwrap_or_default()
}

/// Samples about a place, those farther away counting less, down to nothing at the reach. All in the frame of
/// their body, places from the place on.
struct Surroundings {
    place: Point3,
    reach: f64,
    weight: f64,
    sum: Vector3,
    /// Of unit normals out of what a mesh encloses.
    outward: Vector3,
    /// Of x², xy, xz, y², yz and z².
    squares: [f64; 6],
}

/// Their mean, from the place on, m, and their covariance, m².
struct Moments {
    mean: Vector3,
    spread: Matrix3,
    /// The mean of their unit normals out of what a mesh encloses, shorter the less these agree; zero of what has no
    /// inside, and of a cloud.
    outward: Vector3,
}

impl Surroundings {
    fn of(body: BodyRef<'_>, place: Point3, reach: f64) -> Self {
        let (zero, squares) = (Vector3::zeros(), [0.0; 6]);
        let mut around = Self { place, reach, weight: 0.0, sum: zero, outward: zero, squares };
        match body {
            BodyRef::Cloud(cloud) => {
                let add = |sample: &Point3| {
                    around.add(sample, 1.0);
                };
                cloud.prepared().visit_places_within(&place, reach, add);
            }
            BodyRef::Mesh(mesh) => {
                mesh.visit_surface_within(&place, reach, FINE * reach, |piece| {
                    let nearness = around.add(&piece.place, piece.area);
                    around.outward += piece.outward * nearness;
                });
            }
        }
        around
    }

    /// Counts a place that stands for so much, and says by how much that is weighed.
    fn add(&mut self, sample: &Point3, share: f64) -> f64 {
        let offset = sample - self.place;
        let within = 1.0 - offset.norm_squared() / (self.reach * self.reach);
        let nearness = within.max(0.0).powi(2);
        if within > 0.0 {
            let weight = share * nearness;
            self.weight += weight;
            self.sum += offset * weight;
            // PERF: half of a symmetric matrix, whose other half has the same bits.
            let [x, y, z] = [offset.x, offset.y, offset.z];
            for (sum, square) in
                self.squares.iter_mut().zip([x * x, x * y, x * z, y * y, y * z, z * z])
            {
                *sum += square * weight;
            }
        }
        nearness
    }

    /// `None` of nothing.
    fn moments(&self) -> Option<Moments> {
        (self.weight > 0.0).then(|| {
            let mean = self.sum / self.weight;
            let [xx, xy, xz, yy, yz, zz] = self.squares;
            let squares = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
            let spread = squares / self.weight - mean * mean.transpose();
            Moments { mean, spread, outward: self.outward / self.weight }
        })
    }
}
