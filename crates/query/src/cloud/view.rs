//! A single depth image: what its camera did not look at, or not see, was never seen to be empty.
//!
//! Directions are looked up in a raster over the view, of cells two pixels wide, and not among the
//! measured directions: a query looks at hundreds of them.

use std::f64::consts::TAU;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

use cloudtouch_geom::{Point3, Vector3};
use cloudtouch_noise::SensorNoise;

/// Edge of a raster's cell in pixels: no cell between measured pixels is left empty by chance.
const CELL_PIXELS: f64 = 2.0;
/// A place is in a hole when nothing was measured so many cells around its own: smaller holes are
/// specks that no surface hides in.
const HOLE_CELLS: isize = 2;
/// Standard deviations of the measured surface that count as clearly behind it.
const CLEARLY: f64 = 3.0;
/// An image with a direction so far off its middle (cosine) is a panorama: 80° and more.
const PANORAMA: f64 = 0.17;
/// Cells of a raster at most, and columns or rows: beyond, they become wider.
const MOST_CELLS: f64 = 1e7;
const MOST_COLUMNS: f64 = 1e4;

/// What a camera knows of a place; what comes first is known better.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Sight {
    /// It looked there and beyond, and met nothing on the way.
    Seen,
    /// It met a surface before the place.
    BehindReturns,
    /// No return came from there.
    Hole,
    /// The place is beside what it looked at.
    OutsideView,
    /// The place is behind the camera's back.
    BehindCamera,
}

/// Where the sensor stood, and the raster of its view once that is needed.
#[derive(Debug)]
pub(crate) struct SingleView {
    /// In the cloud's local frame, m.
    sensor_origin: Point3,
    /// Which points of the cloud are those of the image.
    points: Range<usize>,
    raster: OnceLock<Option<Arc<Raster>>>,
}

impl SingleView {
    pub(super) fn new(sensor_origin: Point3, points: Range<usize>) -> Self {
        Self { sensor_origin, points, raster: OnceLock::new() }
    }

    /// What the camera knows of places, all in the cloud's local frame, given what it measured and
    /// with which noise; `None` where the measured points have no directions.
    pub(crate) fn sight<'a>(
        &'a self,
        measured: (&[Point3], &SensorNoise),
    ) -> Option<impl Fn(&Point3) -> Sight + 'a> {
        let raster = self.raster(measured)?;
        Some(move |place: &Point3| raster.sight(&(place - self.sensor_origin)))
    }

    /// Whether the camera looked past places, each with a standard deviation of its own, in their
    /// direction and in all around it; and how far apart its pixels are, per metre of distance. `None`
    /// where the measured points have no directions.
    pub(super) fn looks_past<'a>(
        &'a self,
        measured: (&[Point3], &SensorNoise),
    ) -> Option<(impl Fn(&Point3, f64) -> bool + Sync + 'a, f64)> {
        let raster = self.raster(measured)?;
        let looks_past =
            move |place: &Point3, std| raster.looks_past(&(place - self.sensor_origin), std);
        Some((looks_past, raster.pitch / CELL_PIXELS))
    }

    fn raster(&self, (points, noise): (&[Point3], &SensorNoise)) -> Option<&Raster> {
        let raster = self.raster.get_or_init(|| {
            let own = self.points.clone().map(|index| (points[index], noise[index].std_bound()));
            Raster::new(&self.sensor_origin, own).map(Arc::new)
        });
        raster.as_deref()
    }

    /// The same view as it was measured, whatever becomes of its points, in a frame that lies at
    /// `shift` in the old one; `None` where the measured points have no directions.
    pub(super) fn settled(
        &self,
        measured: (&[Point3], &SensorNoise),
        shift: &Vector3,
    ) -> Option<Self> {
        let _looked = self.sight(measured)?;
        let (sensor_origin, raster) = (self.sensor_origin - shift, self.raster.clone());
        Some(Self { sensor_origin, points: 0..0, raster })
    }
}

/// How far was seen in each direction of a view.
#[derive(Debug)]
struct Raster {
    lens: Lens,
    low: [f64; 2],
    pitch: f64,
    /// Columns and rows.
    size: [usize; 2],
    /// The range, m, clearly behind the farthest return of each cell; zero without one.
    clearly_behind: Vec<f64>,
    /// The range, m, clearly before the nearest return of each cell; infinite without one.
    clearly_before: Vec<f64>,
}

impl Raster {
    /// Of the points measured, each with an upper bound of its standard deviations, m.
    fn new(origin: &Point3, measured: impl Iterator<Item = (Point3, f64)>) -> Option<Self> {
        let rays: Vec<(Vector3, f64)> = measured.map(|(p, std)| (p - origin, std)).collect();
        let lens = Lens::of(rays.iter().map(|(ray, _)| ray))?;
        let placed: Vec<([f64; 2], [f64; 2])> = rays
            .iter()
            .filter_map(|(ray, std)| {
                let range = ray.norm();
                Some(([range - CLEARLY * std, range + CLEARLY * std], lens.project(ray)?))
            })
            .collect();
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for (_, at) in &placed {
            for axis in 0..2 {
                low[axis] = low[axis].min(at[axis]);
                high[axis] = high[axis].max(at[axis]);
            }
        }
        let extent = [high[0] - low[0], high[1] - low[1]];
        let area = extent[0] * extent[1];
        let pitch = (CELL_PIXELS * (area / placed.len().max(1) as f64).sqrt())
            .max((area / MOST_CELLS).sqrt())
            .max(extent[0].max(extent[1]) / MOST_COLUMNS);
        if !(pitch > 0.0 && pitch.is_finite()) {
            return None;
        }
        // A pixel's surface reaches beyond its middle: half a cell around the outermost ones.
        let low = low.map(|v| v - 0.5 * pitch);
        let size = extent.map(|side| (side / pitch + 1.0).ceil() as usize);
        let cells = size[0] * size[1];
        let (clearly_behind, clearly_before) = (vec![0.0; cells], vec![f64::INFINITY; cells]);
        let mut raster = Self { lens, low, pitch, size, clearly_behind, clearly_before };
        for ([before, behind], at) in placed {
            if let Some(cell) = raster.cell(at).and_then(|[x, y]| raster.index(x, y)) {
                raster.clearly_behind[cell] = raster.clearly_behind[cell].max(behind);
                raster.clearly_before[cell] = raster.clearly_before[cell].min(before);
            }
        }
        Some(raster)
    }

    fn sight(&self, ray: &Vector3) -> Sight {
        if self.lens.is_behind(ray) {
            return Sight::BehindCamera;
        }
        let Some([x, y]) = self.lens.project(ray).and_then(|at| self.cell(at)) else {
            return Sight::OutsideView;
        };
        let range = ray.norm();
        // The nearest ring of cells with a return tells; within a ring, the farthest return.
        for ring in 0..=HOLE_CELLS {
            let mut farthest = 0.0_f64;
            for dy in -ring..=ring {
                let step = if dy.abs() == ring { 1 } else { 2 * ring.max(1) };
                for dx in (-ring..=ring).step_by(step as usize) {
                    if let Some(cell) = self.index(x + dx, y + dy) {
                        farthest = farthest.max(self.clearly_behind[cell]);
                    }
                }
            }
            if farthest > 0.0 {
                return if range > farthest { Sight::BehindReturns } else { Sight::Seen };
            }
        }
        Sight::Hole
    }

    /// Whether every return of the cell of a ray, where there is one, and of those around it is clearly
    /// behind a place known this well.
    fn looks_past(&self, ray: &Vector3, std: f64) -> bool {
        let Some([x, y]) = self.lens.project(ray).and_then(|at| self.cell(at)) else {
            return false;
        };
        let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| [x + dx, y + dy]));
        let cells = around.filter_map(|[x, y]| self.index(x, y));
        let nearest = cells.map(|cell| self.clearly_before[cell]).fold(f64::INFINITY, f64::min);
        let has_return = self.index(x, y).is_some_and(|cell| self.clearly_behind[cell] > 0.0);
        has_return && ray.norm() + CLEARLY * std < nearest
    }

    /// The cell of a place of the view; `None` outside of it.
    fn cell(&self, at: [f64; 2]) -> Option<[isize; 2]> {
        let [x, y] = [0, 1].map(|axis| ((at[axis] - self.low[axis]) / self.pitch).floor());
        let is_within = |v: f64, axis: usize| v >= 0.0 && v < self.size[axis] as f64;
        (is_within(x, 0) && is_within(y, 1)).then_some([x as isize, y as isize])
    }

    fn index(&self, x: isize, y: isize) -> Option<usize> {
        let (x, y) = (usize::try_from(x).ok()?, usize::try_from(y).ok()?);
        (x < self.size[0] && y < self.size[1]).then_some(y * self.size[0] + x)
    }
}

/// How directions become places of a view.
#[derive(Debug)]
enum Lens {
    /// A camera: right, down and forward as the points lie, whatever the file says of its turn.
    Camera([Vector3; 3]),
    /// All around the vertical of the file: by azimuth and elevation.
    Panorama,
}

impl Lens {
    fn of<'a>(rays: impl Iterator<Item = &'a Vector3> + Clone) -> Option<Self> {
        let directions = || rays.clone().filter_map(|ray| ray.try_normalize(0.0));
        let forward = directions().sum::<Vector3>().try_normalize(0.0)?;
        if directions().any(|direction| direction.dot(&forward) < PANORAMA) {
            return Some(Self::Panorama);
        }
        let aside = Vector3::ith(forward.iamin(), 1.0);
        let down = forward.cross(&aside).normalize();
        Some(Self::Camera([down.cross(&forward), down, forward]))
    }

    fn is_behind(&self, ray: &Vector3) -> bool {
        match self {
            Self::Camera([_, _, forward]) => ray.dot(forward) <= 0.0,
            Self::Panorama => false,
        }
    }

    /// `None` for a direction that no view of this kind has.
    fn project(&self, ray: &Vector3) -> Option<[f64; 2]> {
        match self {
            Self::Camera([right, down, forward]) => {
                let depth = ray.dot(forward);
                (depth > 0.0).then(|| [ray.dot(right) / depth, ray.dot(down) / depth])
            }
            Self::Panorama => {
                let range = ray.norm();
                (range > 0.0).then(|| [ray.y.atan2(ray.x).rem_euclid(TAU), (ray.z / range).asin()])
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Covariance, Pose, seed};
    use cloudtouch_testkit::camera::DepthCamera;
    use cloudtouch_testkit::exact::ExactMesh;
    use cloudtouch_testkit::scene;

    use super::*;

    const STD: f64 = 0.004;

    /// What is known beyond doubt from all measured points around a ray, looked at one by one.
    fn by_every_ray(points: &[Point3], place: &Point3, pixel: f64) -> Option<Sight> {
        let aside = |p: &Point3| p.coords.angle(&place.coords) / pixel;
        let around = |pixels: f64| points.iter().filter(move |p| aside(p) < pixels);
        let ranges = || around(8.0).map(|p| p.coords.norm());
        let range = place.coords.norm();
        if place.z <= 0.0 {
            Some(Sight::BehindCamera)
        } else if around(14.0).next().is_none() {
            Some(Sight::Hole)
        } else if around(1.0).next().is_none() {
            None
        } else if range < ranges().fold(f64::INFINITY, f64::min) {
            Some(Sight::Seen)
        } else {
            let farthest = ranges().fold(0.0, f64::max);
            (range > farthest + 4.0 * STD).then_some(Sight::BehindReturns)
        }
    }

    /// A block before a wall with a window, from a camera that may be turned any way.
    #[test]
    fn the_raster_says_what_every_single_ray_says() {
        let at = |x: f64, y: f64, z: f64| Pose::from_translation(Vector3::new(x, y, z));
        let part = |size: [f64; 3], pose: &Pose| scene::moved(&scene::cuboid(size), pose);
        let wall = ExactMesh::new(&scene::assemble([
            part([2.0, 4.0, 0.05], &at(-1.3, 0.0, 2.5)),
            part([2.0, 4.0, 0.05], &at(1.3, 0.0, 2.5)),
        ]));
        let block = ExactMesh::new(&part([0.4; 3], &at(-0.4, 0.2, 1.4)));
        let camera = DepthCamera::default();
        let image = camera.scan(&[&wall, &block], &Pose::identity(), 3);
        let seen: Vec<Point3> = image.points.into_iter().filter(|p| p.z.is_finite()).collect();
        let noise = SensorNoise::uniform(Covariance::isotropic(STD * STD), seen.len());
        let mut told = [0; 4];
        for turn in [[0.0; 3], [0.7, -1.1, 2.9], [-2.0, 0.3, 0.4]] {
            let turned = Pose::from_translation_rpy(Vector3::zeros(), turn);
            let points: Vec<Point3> = seen.iter().map(|p| turned.transform_point(p)).collect();
            let view = SingleView::new(Point3::origin(), 0..points.len());
            let sight = view.sight((&points, &noise)).expect("points with directions");
            for index in 0..700 {
                let unit = |k: u64| 2.0 * seed::unit(seed::derive(7, index, k)) - 1.0;
                let place = Point3::new(2.0 * unit(0), 1.5 * unit(1), 1.5 + 2.0 * unit(2));
                let Some(sure) = by_every_ray(&seen, &place, 1.0 / camera.focal_px) else {
                    continue;
                };
                let found = sight(&turned.transform_point(&place));
                let agrees = match sure {
                    // Where nothing was measured the reference does not tell a hole from the rim.
                    Sight::Hole => matches!(found, Sight::Hole | Sight::OutsideView),
                    // The camera's back is told from what it measured, not from its axis.
                    Sight::BehindCamera => {
                        matches!(found, Sight::BehindCamera | Sight::OutsideView)
                    }
                    sure => found == sure,
                };
                assert!(agrees, "{place}: {found:?}, but {sure:?} by every ray");
                told[match sure {
                    Sight::Seen => 0,
                    Sight::BehindCamera => 1,
                    Sight::BehindReturns => 2,
                    Sight::Hole | Sight::OutsideView => 3,
                }] += 1;
            }
        }
        assert!(told.iter().all(|&count| count > 50), "{told:?}");
    }
}
