//! What a cloud is on either path: filtered points, their position noise, an index and a tree.

use std::time::{Duration, Instant};

use cloudtouch_bvh::{Node, NodeId, Obb, Tree, TreeSettings};
use cloudtouch_geom::{Point3, PointCloud, Vector3, bounding_box};
use cloudtouch_noise::{
    Combination, Neighborhoods, NoiseModel, SensorNoise, spacings_at, typical_of_spacings,
};

use crate::error::PrepareError;
use crate::filter::StageReport;

use super::local::{local, origin_for};
use super::makeup::Makeup;
use super::makeup::copies::without_copies;
use super::makeup::median::median;
use super::makeup::scatter::{Overstated, Scatter, scatter};
use super::makeup::spread::{Sample, sample_of};
use super::pieces::Pieces;
use super::preparation::Preparation;
use super::primitives::{Weight, leaf_bounds, primitives_of};
use super::scans::Scans;
use super::surface::slots::{LazySurface, spacing_cap};
use super::view::SingleView;

/// Points with more noise than half the size of their cloud say nothing.
const MOST_NOISE: f64 = 0.5;

/// Points that tell what a cloud is like at a place.
const NEAR_PLACE: usize = 20;

/// A noisy cloud, ready to be queried in any pose, from many threads at once. Each path wraps it in
/// a type of its own.
#[derive(Debug)]
pub(crate) struct Prepared {
    /// What was subtracted from file coordinates, m: far offsets keep their millimetres.
    pub(super) origin: Vector3,
    /// What was measured, in the file's frame.
    pub(super) scans: Scans,
    /// The points kept by the filter, in the local frame, and which are near which.
    pub(super) neighborhoods: Neighborhoods,
    pub(super) pieces: Pieces,
    pub(super) noise: NoiseModel,
    pub(super) tree: Tree,
    /// The box around what was measured, whatever became of the tree's.
    pub(super) around: Option<Obb>,
    pub(super) surface: LazySurface,
    pub(super) makeup: Makeup,
    /// Depth images that it was seen in.
    pub(super) views: Vec<SingleView>,
    /// Where sensors stood, in the local frame, where the scans say so.
    pub(super) sensor_origins: Vec<Point3>,
    /// r of the ellipsoid of each point (eq. 11, 12), where they bring their own; else empty.
    radii: Vec<f64>,
    /// Points that came or went since the tree was built.
    pub(super) drift: usize,
    pub(super) prepare_time: Duration,
}

impl Prepared {
    /// Filters scans of one frame, models their sensors, and builds one index and tree over them, by
    /// the noise model and tree of the first. `weigh` says how much surface each of the points kept
    /// stands for in the coverage of a node; without it all stand for as much.
    pub(crate) fn new(
        scans: &[(&PointCloud, Preparation<'_>)],
        weigh: Option<Weight<'_>>,
    ) -> Result<Self, PrepareError> {
        let start = Instant::now();
        let count: usize = scans.iter().map(|(scan, _)| scan.len()).sum();
        let span = tracing::debug_span!("prepare_cloud", points = count);
        let _entered = span.enter();
        let all = Scans::of(scans)?;
        let Some((_, by)) = scans.first() else {
            let stages = "no scan was given".to_owned();
            return Err(PrepareError::NothingLeft { before: count, stages });
        };
        let noise = NoiseModel::new(by.noise)?;
        let mut prepared = Self::of_scans(all, noise, by.tree, None, weigh)?;
        let may_drop = weigh.is_none() && scans.iter().all(|(_, by)| by.filter.drop_duplicates);
        // An image has each of its rays once.
        if may_drop
            && prepared.views.is_empty()
            && let Some(kept) = without_copies(&prepared.neighborhoods, &prepared.makeup.places)
        {
            let once = prepared.scans.kept_once(&kept);
            prepared = Self::of_scans(once, noise, by.tree, None, None)?;
        }
        prepared.prepare_time = start.elapsed();
        Ok(prepared)
    }

    /// The same of what was measured, in a local frame about this origin where one is given.
    pub(super) fn of_scans(
        mut all: Scans,
        noise: NoiseModel,
        by_tree: &TreeSettings,
        origin: Option<Vector3>,
        weigh: Option<Weight<'_>>,
    ) -> Result<Self, PrepareError> {
        let (low, high) = corners_of(&all)?;
        let sensor = &all.noise;
        let origin = origin.unwrap_or_else(|| origin_for(Vector3::zeros(), (&low, &high)));
        let neighborhoods = Neighborhoods::sharing(local(&all.points, &origin))?;
        let sample = sample_of(neighborhoods.points());
        // A surface that is known needs no others to be told from, and one point is as good as the next.
        let is_fitted =
            noise.settings().combination == Combination::SurfacePosterior && all.normals.is_none();
        let pieces = match is_fitted {
            true => Pieces::chosen(&neighborhoods, sensor, &sample)?,
            false => Pieces::all(),
        };
        let primitives = primitives_of(&neighborhoods, &pieces, sensor, weigh);
        let measured = (&noise, &neighborhoods, sensor);
        let of_leaf = |tree: &Tree, leaf: Node<'_>| {
            let cap = spacing_cap(tree, leaf);
            (leaf_bounds(leaf, cap.into(), |piece| pieces.index(piece), measured), cap)
        };
        let (makeup, tree) = rayon::join(
            || makeup_of(&all, (&neighborhoods, &sample), &origin),
            || Tree::build_bounded(primitives, by_tree, of_leaf),
        );
        let (makeup, (tree, caps_of_leaves)) = (makeup?, tree?);
        let mut caps = vec![0.0; pieces.neighborhoods(&neighborhoods).points().len()];
        for (leaf, cap) in tree.leaves().zip(caps_of_leaves) {
            leaf.primitive_indices().iter().for_each(|&piece| caps[piece as usize] = cap);
        }
        let surface = LazySurface::new(&tree, caps);
        let view = |image| SingleView::new(image, &origin);
        let images = std::mem::take(&mut all.images);
        Ok(Self {
            origin,
            neighborhoods,
            pieces,
            noise,
            around: tree.root().map(|root| root.obb()),
            tree,
            surface,
            makeup,
            views: images.into_iter().map(view).collect(),
            sensor_origins: all.origins.iter().map(|place| place - origin).collect(),
            radii: Vec::new(),
            drift: 0,
            prepare_time: Duration::ZERO,
            scans: all,
        })
    }

    pub(crate) fn len(&self) -> usize {
        self.scans.noise.len()
    }

    /// A kept point in the file's frame, m.
    pub(crate) fn point(&self, index: usize) -> Point3 {
        self.scans.points[index]
    }

    /// For every kept point its row in the input; empty when a collision map replaced the points.
    pub(crate) fn rows(&self) -> &[usize] {
        &self.scans.rows
    }

    pub(crate) fn filter_stages(&self) -> &[StageReport] {
        &self.scans.stages
    }

    pub(crate) fn prepare_time(&self) -> Duration {
        self.prepare_time
    }

    pub(crate) fn origin(&self) -> Vector3 {
        self.origin
    }

    /// The points kept by the filter, in the local frame.
    pub(crate) fn points(&self) -> &[Point3] {
        self.neighborhoods.points()
    }

    /// Position noise of the points kept by the filter.
    pub(crate) fn sensor(&self) -> &SensorNoise {
        &self.scans.noise
    }

    /// The largest standard deviation of the position noise of a kept point, m.
    pub(crate) fn sensor_std(&self, index: u32) -> f64 {
        self.scans.noise[index as usize].max_std()
    }

    /// r of the ellipsoid of a point, where it brings one of its own.
    pub(crate) fn ellipsoid_radius(&self, index: u32) -> Option<f64> {
        self.radii.get(index as usize).copied()
    }

    /// Gives each point an ellipsoid of its own.
    pub(crate) fn set_radii(&mut self, radii: Vec<f64>) {
        self.radii = radii;
    }

    /// Whether its tree holds every point, not a few that stand for all.
    pub(crate) fn is_searched_at_every_point(&self) -> bool {
        self.pieces.is_each()
    }

    /// Which pieces of surface are near which, by their numbers in the tree.
    pub(super) fn near_pieces(&self) -> &Neighborhoods {
        self.pieces.neighborhoods(&self.neighborhoods)
    }

    pub(crate) fn tree(&self) -> &Tree {
        &self.tree
    }

    /// The box around what was measured, in the local frame.
    pub(crate) fn around(&self) -> Option<&Obb> {
        self.around.as_ref()
    }

    /// The direction in which a leaf is all but flat: along the shortest side of its box.
    pub(super) fn thin_side(&self, leaf: NodeId) -> Vector3 {
        self.tree.node(leaf).map_or_else(Vector3::z, |leaf| leaf.obb().axes.column(2).into())
    }

    pub(crate) fn sensor_origins(&self) -> &[Point3] {
        &self.sensor_origins
    }

    /// What the cloud is like as a whole.
    pub(crate) fn makeup(&self) -> &Makeup {
        &self.makeup
    }

    /// Noise that is stated and not there.
    pub(crate) fn overstated(&self) -> Option<Overstated> {
        self.scatter()?.overstated()
    }

    /// How much of the noise that is stated shows in the points, from 0 to 1; `None` where they do not tell.
    pub(crate) fn shows_noise(&self) -> Option<f64> {
        self.scatter().map(Scatter::shows)
    }

    fn scatter(&self) -> Option<Scatter> {
        let told = || scatter(&self.neighborhoods, &self.scans.noise, &self.makeup.places);
        *self.makeup.scatter.get_or_init(told)
    }

    /// Distance of a place in the local frame to the nearest point, m.
    pub(crate) fn distance_to(&self, place: &Point3) -> Option<f64> {
        Some(self.neighborhoods.nearest_to(place, 1).first()?.squared_distance.sqrt())
    }

    /// The typical spacing and standard deviation of some points nearest to a place in the local frame, m.
    pub(crate) fn scale_near(&self, place: &Point3) -> Option<[f64; 2]> {
        let nearest = self.neighborhoods.nearest_to(place, NEAR_PLACE);
        let spacings = spacings_at(&self.neighborhoods, nearest.iter().map(|near| near.index));
        let stds = nearest.iter().map(|near| self.scans.noise[near.index].max_std());
        (!nearest.is_empty()).then(|| [typical_of_spacings(&spacings), median(stds)])
    }

    /// Keeps what the last frames say of themselves, and no more of their filters than these stages.
    pub(super) fn forget_frames(&mut self, most: usize, stages: Vec<StageReport>) {
        let oldest = |count: usize| count.saturating_sub(most);
        self.views.drain(..oldest(self.views.len()));
        self.sensor_origins.drain(..oldest(self.sensor_origins.len()));
        self.scans.origins.drain(..oldest(self.scans.origins.len()));
        self.scans.stages = stages;
    }
}

/// Corners of the box around the points of scans, in the file's frame.
fn corners_of(all: &Scans) -> Result<(Point3, Point3), PrepareError> {
    let stages = String::new();
    bounding_box(all.points.iter()).ok_or(PrepareError::NothingLeft { before: 0, stages })
}

/// What a cloud of these scans is like as a whole, told from a sample of it, in a local frame about an origin.
///
/// # Errors
/// When there is no point, or they have more noise than the cloud has size.
pub(super) fn makeup_of(
    all: &Scans,
    (points, sample): (&Neighborhoods, &Sample),
    origin: &Vector3,
) -> Result<Makeup, PrepareError> {
    let (low, high) = corners_of(all)?;
    let corners = [low - origin, high - origin];
    let doubts = all.sensor_doubts.clone();
    let makeup =
        Makeup::new(corners, (points, &all.noise, sample), (all.missing, all.step), doubts);
    if makeup.std > MOST_NOISE * makeup.size() && makeup.size() > 0.0 {
        let middle = nalgebra::center(&low, &high);
        let range =
            all.origins.iter().map(|origin| (origin - middle).norm()).max_by(f64::total_cmp);
        return Err(PrepareError::NoiseBeyondSize { std: makeup.std, size: makeup.size(), range });
    }
    Ok(makeup)
}
