//! Clouds prepared for either path.

use anyhow::{Context as _, Result, bail, ensure};
use cloudtouch::geom::{Point3, PointCloud, Pose};
use cloudtouch::noise::SensorModel;
use cloudtouch::paper::RadiusRule;
use cloudtouch::{
    Cloud, CloudSettings, FilterSettings, Mesh, PaperCloud, PaperCloudSettings, PrepareError,
    StageReport,
};

use crate::paper_settings::Settings;

/// A prepared cloud of one of the paths.
pub(crate) trait PreparedCloud: Sized + Send + Sync {
    /// Prepares scans of one frame by the defaults for their sensor and what a settings file says, as
    /// `change` leaves filter and sensor.
    fn prepare(
        scans: &[PointCloud],
        sensor: SensorModel,
        file: Option<&Settings>,
        change: impl FnOnce(&mut FilterSettings, &mut SensorModel),
    ) -> Result<Self, PrepareError>;

    /// With its surface computed everywhere, where that changes the time of a query.
    fn refined(self) -> Result<Self, PrepareError>;
    /// With a κ for each row of the file; the default path has none.
    fn with_kappas(self, by_row: &[f64], rule: RadiusRule) -> Result<Self>;

    /// The kept points in the file's frame, m.
    fn points(&self) -> Vec<Point3>;

    /// For every kept point its row in the file; empty for the cells of a collision map.
    fn file_rows(&self) -> &[usize];

    /// The points measured inside of a closed mesh, each with the probability that it is.
    fn inside(&self, mesh: &Mesh, mesh_from_cloud: &Pose) -> Vec<(usize, f64)>;

    /// How many points were kept.
    fn count(&self) -> usize;

    /// What the filter removed.
    fn stages(&self) -> &[StageReport];
}

/// The clouds of the two paths have no trait in common, and the same functions.
macro_rules! prepared_cloud {
    ($cloud:ty, $settings:ty, $refine:expr, $by_file:expr, $with_kappas:expr) => {
        impl PreparedCloud for $cloud {
            fn prepare(
                scans: &[PointCloud],
                sensor: SensorModel,
                file: Option<&Settings>,
                change: impl FnOnce(&mut FilterSettings, &mut SensorModel),
            ) -> Result<Self, PrepareError> {
                let mut settings = <$settings>::new(sensor);
                let by_file: fn(&mut $settings, &Settings) = $by_file;
                file.into_iter().for_each(|file| by_file(&mut settings, file));
                change(&mut settings.filter, &mut settings.sensor);
                let scans: Vec<_> = scans.iter().map(|scan| (scan, &settings)).collect();
                Self::merge(&scans)
            }

            fn with_kappas(self, by_row: &[f64], rule: RadiusRule) -> Result<Self> {
                let with_kappas: fn(Self, &[f64], RadiusRule) -> Result<Self> = $with_kappas;
                with_kappas(self, by_row, rule)
            }

            fn refined(self) -> Result<Self, PrepareError> {
                $refine(self)
            }

            fn points(&self) -> Vec<Point3> {
                (0..self.len()).map(|i| self.point(i)).collect()
            }

            fn file_rows(&self) -> &[usize] {
                self.rows()
            }

            fn inside(&self, mesh: &Mesh, mesh_from_cloud: &Pose) -> Vec<(usize, f64)> {
                self.points_inside(mesh, mesh_from_cloud)
            }

            fn count(&self) -> usize {
                self.len()
            }

            fn stages(&self) -> &[StageReport] {
                self.filter_stages()
            }
        }
    };
}

prepared_cloud!(Cloud, CloudSettings, Cloud::refined, |_, _| (), |_, _, _| {
    bail!("kappas are of the paper's mode")
});
prepared_cloud!(
    PaperCloud,
    PaperCloudSettings,
    // The paper's algorithm has no use for a surface.
    Ok,
    |settings, file| settings.model = file.cloud,
    |cloud, by_row, rule| {
        let (rows, found) = (cloud.filter_stages().first().map_or(0, |of| of.before), by_row.len());
        ensure!(
            found == rows,
            "{found} kappas, and the scene has {rows} rows: a line for each row is needed"
        );
        let kappa = |&row: &usize| by_row.get(row).copied();
        let kept: Option<Vec<f64>> = cloud.rows().iter().map(kappa).collect();
        let kept = kept.filter(|kept| kept.len() == cloud.len());
        let kept = kept.context("the file of kappas needs a line for each row of the scene")?;
        Ok(cloud.with_kappas(&kept, rule)?)
    }
);
