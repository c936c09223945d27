//! A cloud whose points come, go and move.

mod again;
mod carry;
mod frame;
mod lost;
mod patch;
mod regrow;

use std::sync::Arc;
use std::time::Instant;

use cloudtouch_geom::{Point3, PointCloud, Vector3, bounding_box};

use crate::check::coordinates::LARGEST_COORDINATE;
use crate::cloud::local::origin_for;
use crate::cloud::prepare::Cloud;
use crate::cloud::prepared::Prepared;
use crate::cloud::scans::Scans;
use crate::cloud::settings::CloudSettings;
use crate::error::ChangeError;

/// What a change did to a cloud.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Change {
    /// Points that came.
    pub inserted: usize,
    /// Points that went.
    pub removed: usize,
    /// Points that are elsewhere.
    pub moved: usize,
    /// Points whose surface was computed before and is kept.
    pub surfaces_kept: usize,
    /// Points whose surface was computed before and is not known any more; it is computed when a query
    /// comes near, or at once in a cloud that is [refined](Cloud::refined).
    pub surfaces_lost: usize,
    /// Whether the local frame was laid anew, for the middle of the cloud has moved by more than its
    /// size: then all surfaces are lost.
    pub is_recentred: bool,
    /// Whether index and tree were built anew, and not only where something changed.
    pub is_rebuilt: bool,
}

/// So many points that are all in the cloud already are a scan that was given before.
const LEAST_REPEATED: usize = 100;

impl Cloud {
    /// Adds what another scan of the same frame has, filtered and with the noise by its own settings, as
    /// if both had been [merged](Self::merge): its points come after those that there are.
    ///
    /// Index, tree and surface are made anew where something changed and kept elsewhere. A changed cloud
    /// answers as one prepared from the same points does, up to rounding, which a classifier may raise to a
    /// thousandth; but for lonely samples. What a sample stands for is limited by how far apart samples
    /// are in the boxes of the tree around it, and a tree that was changed in place has other boxes than one
    /// that is built over the same points. So where surfaces meet at samples that are much farther apart than those
    /// about them, probabilities may differ, as they do in a fresh cloud that has a few more points
    /// elsewhere: by a thousandth on average for a camera that walks about a room, seldom by a tenth. After
    /// [`Self::rebuild`] nothing differs, to the bit as long as the middle of the box around all points stays.
    /// That comes by itself ([`Change::is_rebuilt`]) when as many points came or went as there are, two in five at
    /// once, or leaves are half again as loose; and where samples are far denser than their noise, at each change.
    ///
    /// ```
    /// use cloudtouch::geom::{Point3, PointCloud};
    /// use cloudtouch::noise::SensorModel;
    /// use cloudtouch::{Cloud, CloudSettings};
    ///
    /// let sheet = |z: f64| -> PointCloud {
    ///     let at = |i: u32| Point3::new(0.01 * f64::from(i % 20), 0.01 * f64::from(i / 20), z);
    ///     PointCloud::from_points((0..400).map(at).collect())
    /// };
    /// let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.001 });
    /// let mut cloud = Cloud::prepare(&sheet(0.0), &settings)?;
    /// assert_eq!(cloud.insert(&sheet(0.2), &settings)?.inserted, 400);
    /// assert_eq!(cloud.remove(&[0, 1, 2])?.removed, 3);
    /// cloud.move_points(&[(0, Point3::new(0.03, 0.0, 0.001))])?;
    /// assert_eq!(cloud.len(), 797);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`Self::prepare`] for the scan, or for all together; and where it is there already.
    pub fn insert(
        &mut self,
        scan: &PointCloud,
        settings: &CloudSettings,
    ) -> Result<Change, ChangeError> {
        let added = Scans::of(&[(scan, settings.preparation())])?;
        if self.has_all_of(&added) {
            return Err(ChangeError::RepeatedScan { count: added.points.len() });
        }
        let all: Vec<u32> = (0..self.len() as u32).collect();
        self.keep_and_append(&all, Some(added))
    }

    /// Whether each of many points is where one is already. Maps of cells may well hold all of a smaller one.
    fn has_all_of(&self, added: &Scans) -> bool {
        let origin = self.prepared.origin();
        let is_known = |place: &Point3| self.prepared.distance_to(&(place - origin)) == Some(0.0);
        // Few may be there by chance, of a sensor that counts in millimetres.
        added.points.len() >= LEAST_REPEATED
            && !added.rows.is_empty()
            && added.points.iter().all(is_known)
    }

    /// Removes points, by their indices as filtered ([`Self::point`]); those after them move up.
    ///
    /// For the answers see [`Self::insert`]. Depth images keep what they saw.
    ///
    /// # Errors
    /// When there is no such point, one is named twice, or none would be left.
    pub fn remove(&mut self, indices: &[usize]) -> Result<Change, ChangeError> {
        let is_named = self.named(indices.iter().copied())?;
        let kept: Vec<u32> = (0..).zip(&is_named).filter(|(_, n)| !**n).map(|(i, _)| i).collect();
        if kept.is_empty() {
            return Err(ChangeError::NothingLeft { count: self.len() });
        }
        self.keep_and_append(&kept, None)
    }

    /// Moves points, by their indices as filtered, to other places in the frame of the file, m; they keep their
    /// indices and their noise.
    ///
    /// For the answers see [`Self::insert`].
    ///
    /// # Errors
    /// When there is no such point, one is named twice, or a place is not finite or beyond 1e10 m.
    pub fn move_points(&mut self, moves: &[(usize, Point3)]) -> Result<Change, ChangeError> {
        let is_named = self.named(moves.iter().map(|(index, _)| *index))?;
        let mut scans = self.prepared.scans.clone();
        let mut places = Vec::with_capacity(2 * moves.len());
        for &(index, place) in moves {
            let is_beyond = |v: &f64| v.is_nan() || v.abs() > LARGEST_COORDINATE;
            if let Some(&value) = place.iter().find(|v| is_beyond(v)) {
                return Err(ChangeError::Coordinate { index, value });
            }
            places.extend([scans.points[index], place]);
            Arc::make_mut(&mut scans.points)[index] = place;
        }
        let before = (0..).zip(&is_named).map(|(i, moved)| (!moved).then_some(i)).collect();
        let change = self.become_of(scans, before, places)?;
        Ok(Change { moved: moves.len(), ..change })
    }

    /// Builds index and tree anew, and keeps the surface: from then on the answers are those of a cloud
    /// prepared from the same points as far as [`Self::insert`] says, lonely samples included.
    ///
    /// A change does it by itself where much has changed since the last time; this is for moments when
    /// nobody waits.
    ///
    /// # Errors
    /// None that the last change did not have.
    pub fn rebuild(&mut self) -> Result<Change, ChangeError> {
        let start = Instant::now();
        let same: Vec<Option<u32>> = (0..self.len() as u32).map(Some).collect();
        let known = self.prepared.known_count();
        let (scans, origin) = (self.prepared.scans.clone(), self.prepared.origin);
        let surfaces_kept = self.prepare_anew(scans, origin, &same, Vec::new())?;
        Ok(self.changed(start, [known, surfaces_kept], false, true))
    }

    /// Keeps points, given in order, and adds others.
    pub(super) fn keep_and_append(
        &mut self,
        kept: &[u32],
        added: Option<Scans>,
    ) -> Result<Change, ChangeError> {
        let own = &self.prepared.scans;
        let mut is_kept = vec![false; own.points.len()];
        kept.iter().for_each(|&index| is_kept[index as usize] = true);
        let gone = own.points.iter().zip(&is_kept).filter(|(_, is_kept)| !**is_kept);
        let mut places: Vec<Point3> = gone.map(|(place, _)| *place).collect();
        let removed = places.len();
        let mut scans = own.kept(kept);
        let mut before: Vec<Option<u32>> = kept.iter().copied().map(Some).collect();
        if let Some(added) = added {
            places.extend(added.points.iter());
            before.extend(added.points.iter().map(|_| None));
            scans.append(added);
        }
        let inserted = places.len() - removed;
        let change = self.become_of(scans, before, places)?;
        Ok(Change { inserted, removed, ..change })
    }

    /// Which points are named, each once.
    fn named(&self, indices: impl Iterator<Item = usize>) -> Result<Vec<bool>, ChangeError> {
        let count = self.len();
        let mut is_named = vec![false; count];
        for index in indices {
            match is_named.get_mut(index) {
                None => return Err(ChangeError::NoSuchPoint { index, count }),
                Some(true) => return Err(ChangeError::Twice { index }),
                Some(named) => *named = true,
            }
        }
        Ok(is_named)
    }

    /// Becomes the cloud of other points: `before` has the index that each had, if it is where it was, and
    /// `places` are those (file frame, m) that points left, came to or moved between.
    fn become_of(
        &mut self,
        scans: Scans,
        before: Vec<Option<u32>>,
        places: Vec<Point3>,
    ) -> Result<Change, ChangeError> {
        let start = Instant::now();
        let own = &mut self.prepared;
        let corners = bounding_box(scans.points.iter());
        let origin =
            corners.map_or(own.origin, |(low, high)| origin_for(own.origin, (&low, &high)));
        let is_recentred = origin != own.origin;
        let local: Vec<Point3> = places.into_iter().map(|place| place - origin).collect();
        let known = own.known_count();
        let prospect = if is_recentred { None } else { own.prospect(&scans, &before)? };
        let is_rebuilt = prospect.is_none();
        let surfaces_kept = match prospect {
            Some(prospect) => own.patch(scans, prospect, &before, local)?,
            None => self.prepare_anew(scans, origin, &before, local)?,
        };
        Ok(self.changed(start, [known, surfaces_kept], is_recentred, is_rebuilt))
    }

    /// A change that is done, but for the points that came, went or moved.
    fn changed(
        &mut self,
        start: Instant,
        [known, surfaces_kept]: [usize; 2],
        is_recentred: bool,
        is_rebuilt: bool,
    ) -> Change {
        self.prepared.prepare_time = start.elapsed();
        let [inserted, removed, moved] = [0; 3];
        let surfaces_lost = known - surfaces_kept;
        Change { inserted, removed, moved, surfaces_kept, surfaces_lost, is_recentred, is_rebuilt }
    }

    /// The same with an index and a tree that are built anew; `changed` are places in the new local frame.
    fn prepare_anew(
        &mut self,
        scans: Scans,
        origin: Vector3,
        before: &[Option<u32>],
        changed: Vec<Point3>,
    ) -> Result<usize, ChangeError> {
        let own = &self.prepared;
        let mut prepared =
            Prepared::of_scans(scans, own.noise, own.tree.settings(), Some(origin), None)?;
        let surfaces_kept = prepared.carry_over(own, before, changed)?;
        let shift = origin - own.origin;
        let measured = (own.points(), own.sensor());
        let views = own.views.iter().filter_map(|view| view.settled(measured, &shift));
        prepared.views = views.chain(std::mem::take(&mut prepared.views)).collect();
        if own.is_refined() {
            prepared.refine()?;
        }
        self.prepared = prepared;
        Ok(surfaces_kept)
    }
}
