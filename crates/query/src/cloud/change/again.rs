//! Which places a frame measures again.

use std::sync::OnceLock;

use cloudtouch_geom::{Covariance, Point3};
use cloudtouch_noise::Neighborhoods;

use crate::cloud::scans::Scans;
use crate::cloud::view::Seeing;
use crate::cloud::view::near::{ByPixels, Spot};

/// A sample within so many of its standard deviations along the ray, and as many pixels across it, is
/// measured again by that of the frame.
const DEVIATIONS: f64 = 3.0;
/// What lengths are rounded by, relative, and what is across a ray, told by a difference of squares; generously.
const ROUNDING: [f64; 2] = [1e-9, 1e-7];
/// Squared distances that differ by no more, relative, may be taken for the same.
const TIED: f64 = 1e-6;

/// What a frame of a camera measured.
pub(super) struct Again<'a> {
    frame: &'a Scans,
    camera: Point3,
    /// How far apart pixels are, per metre of distance, and at least, m.
    pixel: f64,
    cell: f64,
    /// No standard deviation is larger, m.
    most_std: f64,
    by_pixels: Option<ByPixels<'a>>,
    /// Where pixels do not tell.
    tree: OnceLock<Option<Neighborhoods>>,
}

impl<'a> Again<'a> {
    /// Given how it is seen, from where, and how wide its cells are at least, m; `None` of a panorama: what its lines
    /// measure is no more than they, and the next of them may be far off.
    pub(super) fn of(
        frame: &'a Scans,
        (seeing, camera): (&Seeing<'a>, Point3),
        cell: f64,
    ) -> Option<Self> {
        let pixel = seeing.pixel()?;
        let most_std = frame.noise.iter().map(Covariance::std_bound).fold(0.0, f64::max);
        let by_pixels = seeing.by_pixels(&frame.points);
        Some(Self { frame, camera, pixel, cell, most_std, by_pixels, tree: OnceLock::new() })
    }

    /// Whether it measures a place, known so well (m), again: whether its point nearest to that is one of the place.
    /// `None` where [`Self::by_tree`] has to tell.
    pub(super) fn by_pixels(&self, place: &Point3, std: f64) -> Option<bool> {
        let pixels = self.by_pixels.as_ref()?;
        let ray = place - self.camera;
        let (range, spot) = (ray.norm(), pixels.spot(&ray)?);
        let squared = |index: usize| (self.frame.points[index] - place).norm_squared();
        // First those that may be of the place: all about its ray, and few.
        let pixel = self.pixel_at(range);
        let room = |other: f64| (DEVIATIONS * std.hypot(other) + pixel) * (1.0 + ROUNDING[0]);
        let most_along = room(self.most_std);
        let aside = pixel + ROUNDING[1] * (most_along + pixel);
        let first = Spot { depth: spot.depth * (1.0 - most_along / range), ..spot };
        let mut least = f64::INFINITY;
        let are_all = pixels.visit_about(first, aside, |index| {
            let along = ray.dot(&(self.frame.points[index] - place)) / range;
            let squared = squared(index);
            let is_near = squared - along * along <= aside * aside && squared < least;
            if is_near && along.abs() <= room(self.frame.noise[index].std_bound()) {
                least = squared;
            }
        });
        if !are_all {
            return None;
        }
        if least == f64::INFINITY {
            return Some(false);
        }
        let reach = |squared: f64| (squared * (1.0 + TIED)).sqrt();
        let mut nearest = least;
        let are_all = pixels.visit_about(spot, reach(least), |index| {
            nearest = nearest.min(squared(index));
        });
        if !are_all {
            return None;
        }
        // Of what is as near the tree tells which is taken.
        let [mut is_again, mut is_another] = [false; 2];
        let most = nearest * (1.0 + TIED);
        pixels.visit_about(spot, reach(nearest), |index| {
            if squared(index) <= most {
                let is_of = self.is_of(place, std, index);
                (is_again, is_another) = (is_again || is_of, is_another || !is_of);
            }
        });
        (is_again != is_another).then_some(is_again)
    }

    /// The same in many times the time.
    pub(super) fn by_tree(&self, place: &Point3, std: f64) -> bool {
        let nearest = self.tree().map(|tree| tree.nearest_to(place, 1));
        let nearest = nearest.as_deref().and_then(<[_]>::first);
        nearest.is_some_and(|near| self.is_of(place, std, near.index))
    }

    /// Made when first asked for. `None` of more points than there may be, which are refused elsewhere.
    pub(super) fn tree(&self) -> Option<&Neighborhoods> {
        let made = || Neighborhoods::sharing(self.frame.points.clone()).ok();
        self.tree.get_or_init(made).as_ref()
    }

    fn pixel_at(&self, range: f64) -> f64 {
        (self.pixel * range).max(self.cell)
    }

    /// Whether a point of it is within the noise of both and a pixel of a place.
    fn is_of(&self, place: &Point3, std: f64, index: usize) -> bool {
        let ray = place - self.camera;
        let pixel = self.pixel_at(ray.norm());
        let noise = std.hypot(self.frame.noise[index].max_std());
        let offset = self.frame.points[index] - place;
        let along = ray.try_normalize(0.0).map_or(0.0, |ray| ray.dot(&offset));
        let across = (offset.norm_squared() - along * along).max(0.0).sqrt();
        along.abs() <= DEVIATIONS * noise + pixel && across <= pixel
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::seed::{derive, unit};
    use cloudtouch_geom::{PointCloud, Vector3};
    use cloudtouch_noise::SensorModel;
    use proptest::prelude::*;

    use super::*;
    use crate::CloudSettings;
    use crate::cloud::view::SingleView;

    /// Of 40 by 30 pixels: a wall aslant with a board before it and a hole, in steps as disparities have, or without.
    fn image(seed: u64, noise: f64, is_stepped: bool) -> PointCloud {
        let point = |i: u64| {
            let [u, v] = [(i % 40) as f64 - 19.5, (i / 40) as f64 - 14.5].map(|k| k / 40.0);
            let depth = if (10..22).contains(&(i % 40)) { 0.8 } else { 2.0 + u };
            let depth = depth + noise * depth * depth * (unit(derive(seed, i, 0)) - 0.5);
            let depth = if is_stepped { (depth * 50.0).round() / 50.0 } else { depth };
            let lost = if (30..34).contains(&(i % 40)) && i < 500 { f64::NAN } else { 1.0 };
            Point3::new(u, v, 1.0) * (depth * lost)
        };
        let points = (0..1200).map(point).collect();
        PointCloud { image_size: Some((40, 30)), ..PointCloud::from_points(points) }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn what_pixels_tell_is_what_the_tree_tells(
            seed in any::<u64>(),
            noise in 0.0..0.05_f64,
            (is_stepped, is_kinect) in any::<(bool, bool)>(),
            std in prop_oneof![Just(0.0), 1e-4..0.1_f64],
            cell in prop_oneof![Just(0.0), 0.005..0.2_f64],
        ) {
            let sensor = match is_kinect {
                true => SensorModel::Kinect,
                false => SensorModel::Isotropic { std: 0.003 },
            };
            let by = CloudSettings::new(sensor);
            let frame = Scans::of(&[(&image(seed, noise, is_stepped), by.preparation())]).unwrap();
            let view = SingleView::new(frame.images[0].clone(), &Vector3::zeros());
            let seeing = view.over((&frame.points, &frame.noise)).unwrap();
            let again = Again::of(&frame, (&seeing, Point3::origin()), cell).unwrap();
            let (mut told, mut of_place) = (0, 0);
            for k in 0..600 {
                let draw = |stream| unit(derive(seed ^ 1, k, stream));
                let some = |stream| {
                    let count = frame.points.len() as f64;
                    frame.points[(draw(stream) * count) as usize].coords
                };
                let aside = Vector3::new(draw(0) - 0.5, draw(1) - 0.5, draw(2) - 0.5);
                let near = some(3) + aside * 10.0_f64.powf(-8.0 * draw(4));
                // As near to two of them, beside one, and anywhere.
                let place = match k % 3 {
                    0 => 0.5 * (some(3) + some(5)),
                    1 => near,
                    _ => some(3) * (0.2 + 1.5 * draw(6)),
                };
                let place = Point3::from(place);
                let by_tree = again.by_tree(&place, std);
                of_place += usize::from(by_tree);
                if let Some(is_again) = again.by_pixels(&place, std) {
                    prop_assert_eq!(is_again, by_tree, "{} of {}", k, place);
                    told += 1;
                }
            }
            prop_assert!(2 * told > 600 && of_place > 0, "{told}, {of_place}");
        }
    }
}
