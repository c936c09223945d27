//! A cloud that a moving camera keeps up to date: what it looks at is as it sees it, the rest stays.

use cloudtouch_geom::{Point3, PointCloud, Vector3};
use rayon::prelude::*;

use super::again::Again;
use crate::cloud::change::Change;
use crate::cloud::prepare::Cloud;
use crate::cloud::scans::Scans;
use crate::cloud::settings::CloudSettings;
use crate::cloud::view::SingleView;
use crate::error::{ChangeError, PrepareError};
use crate::filter::Taken;

/// Views that a cloud keeps of its frames: what only older ones saw to be empty counts as unseen again.
const MOST_VIEWS: usize = 32;

impl Cloud {
    /// Brings the cloud up to date by a depth image in its frame, whose `sensor_pose` says where the camera
    /// stood: points that it sees through, or measures again, are removed, and its own are added.
    ///
    /// A point is seen through where the image has returns clearly behind it, in its own direction and
    /// in all those about two pixels around it, or where these are on a plane that is; it is measured again where
    /// a return is within its noise and a pixel, or a cell of the collision map that the settings ask for. What is hidden behind returns,
    /// in a hole of the image or beside it by more than that stays as it was.
    /// So the number of points is bounded by the surface there is, and the memory by that and the last
    /// 32 images, which tell what was seen to be empty; those from before a thing came tell nothing of what is within and
    /// behind it. Filter stages are those of the frame.
    ///
    /// A panorama, as of a turning laser scanner, removes what it sees through and nothing that it measures again,
    /// for between its lines lies surface that it does not: the cloud grows with every frame. A
    /// [collision map](crate::FilterSettings::collision_map) of its points, prepared anew from time to time, bounds it.
    ///
    /// For the answers see [`Self::insert`].
    ///
    /// # Errors
    /// When the frame is no depth image, or as [`Self::insert`].
    pub fn replace_frame(
        &mut self,
        frame: &PointCloud,
        settings: &CloudSettings,
    ) -> Result<Change, ChangeError> {
        if !frame.is_image() {
            return Err(ChangeError::NotAnImage);
        }
        let mut added = Scans::of(&[(frame, settings.preparation())])?;
        for image in &mut added.images {
            image.is_later = true;
        }
        let cell = settings.filter.collision_map.unwrap_or(0.0);
        let (kept, taken) = self.not_seen_by(&added, cell)?;
        added.taken.extend(taken);
        let stages = added.stages.clone();
        let change = self.keep_and_append(&kept, Some(added))?;
        self.prepared.forget_frames(MOST_VIEWS, stages);
        Ok(change)
    }

    /// The points that a frame neither sees through nor measures again, be it by cells this wide, m; and of what was
    /// taken for the robot that which the frame does not take for it again either.
    fn not_seen_by(
        &self,
        frame: &Scans,
        cell: f64,
    ) -> Result<(Vec<u32>, Vec<Taken>), PrepareError> {
        let own = &self.prepared.scans;
        let all = || Ok(((0..own.points.len() as u32).collect(), own.taken.clone()));
        let Some(image) = frame.images.first() else { return all() };
        let view = SingleView::new(image.clone(), &Vector3::zeros());
        let Some(seeing) = view.over((&frame.points, &frame.noise)) else { return all() };
        let again = Again::of(frame, (&seeing, image.sensor_origin), cell);
        let by_tree = |place: &Point3, std: f64| {
            again.as_ref().is_none_or(|again| !again.by_tree(place, std))
        };
        // PERF: pixels tell of nearly all, many times as fast as a tree of the frame, which is made for the rest.
        let by_pixels = |place: &Point3, std: f64| match &again {
            _ if seeing.looks_past(place, std) => Some(false),
            Some(again) => again.by_pixels(place, std).map(|is_again| !is_again),
            None => Some(true),
        };
        let std = |index: u32| own.noise[index as usize].max_std();
        let place = |index: u32| &own.points[index as usize];
        let points = 0..own.points.len() as u32;
        let told = |index: u32| by_pixels(place(index), std(index));
        let told: Vec<Option<bool>> = points.clone().into_par_iter().map(told).collect();
        if let Some(again) = again.as_ref().filter(|_| told.contains(&None)) {
            // Here, for it takes all threads.
            again.tree();
        }
        let stays = |&index: &u32| {
            told[index as usize].unwrap_or_else(|| by_tree(place(index), std(index)))
        };
        let kept = points.into_par_iter().filter(stays).collect();
        let is_taken_again = |place: &Point3| frame.taken.iter().any(|new| new.is_about(place));
        let is_still = |place: &Point3| {
            by_pixels(place, 0.0).unwrap_or_else(|| by_tree(place, 0.0)) && !is_taken_again(place)
        };
        let still: Result<Vec<_>, _> = own.taken.iter().map(|old| old.only(is_still)).collect();
        Ok((kept, still?.into_iter().flatten().collect()))
    }
}
