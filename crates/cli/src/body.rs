//! Prepared bodies of either path, and what the commands ask of both paths alike.

use anyhow::{Context as _, Result, bail, ensure};
use cloudtouch::geom::{Point3, PointCloud, Pose};
use cloudtouch::noise::SensorModel;
use cloudtouch::paper::{LeafClassifier, RadiusRule};
use cloudtouch::{
    BodyRef, Cloud, CloudSettings, FilterSettings, Mesh, PaperBodyRef, PaperCloud,
    PaperCloudSettings, PaperQuery, Penetration, Placement, PoseDistribution, PoseGradient,
    PrepareError, Query, QueryError, Report, StageReport, UnderPoses,
};

use crate::margin::{Nearness, SHARE};
use crate::paper_settings::Settings;

/// A cloud prepared for one of the paths, or a mesh.
#[allow(clippy::large_enum_variant, reason = "there are a few, each far larger on the heap")]
pub(crate) enum Body<C> {
    Cloud(C),
    Mesh(Mesh),
}

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

/// The default path or the paper's: it asks only about bodies that were prepared for it.
pub(crate) trait Estimator: Sync {
    type Cloud: PreparedCloud;

    /// How likely it is that two bodies collide.
    fn ask(
        &self,
        scene: &Body<Self::Cloud>,
        object: &Body<Self::Cloud>,
        scene_from_object: &Pose,
    ) -> Result<Report, QueryError>;

    /// The same with the classifiers trained, of which the default path tells none.
    fn explain(
        &self,
        scene: &Body<Self::Cloud>,
        object: &Body<Self::Cloud>,
        scene_from_object: &Pose,
    ) -> Result<(Report, Vec<LeafClassifier>), QueryError> {
        Ok((self.ask(scene, object, scene_from_object)?, Vec::new()))
    }

    /// The same with how likely they are within a margin (m) of each other, where one is asked about; the
    /// paper's path knows no distances.
    fn ask_within(
        &self,
        scene: &Body<Self::Cloud>,
        object: &Body<Self::Cloud>,
        scene_from_object: &Pose,
        _margin: Option<f64>,
    ) -> Result<(Report, Option<Nearness>), QueryError> {
        Ok((self.ask(scene, object, scene_from_object)?, None))
    }

    /// How likely a collision is over all poses that may be; `None` on the paper's path.
    fn uncertain(
        &self,
        _scene: &Body<Self::Cloud>,
        _object: &Body<Self::Cloud>,
        _scene_from_object: &PoseDistribution,
    ) -> Result<Option<UnderPoses>, QueryError> {
        Ok(None)
    }

    /// What a small motion of the object changes; `None` on the paper's path.
    fn slopes(
        &self,
        _scene: &Body<Self::Cloud>,
        _object: &Body<Self::Cloud>,
        _scene_from_object: &Pose,
    ) -> Result<Option<PoseGradient>, QueryError> {
        Ok(None)
    }

    /// The least translation found that ends a collision; `None` where none does, and on the paper's path.
    fn way_out(
        &self,
        _scene: &Body<Self::Cloud>,
        _object: &Body<Self::Cloud>,
        _scene_from_object: &Pose,
        _probability: f64,
    ) -> Result<Option<Penetration>, QueryError> {
        Ok(None)
    }

    /// Where the object lies in the scene.
    fn place(
        &self,
        scene: &Body<Self::Cloud>,
        object: &Body<Self::Cloud>,
        scene_from_object: &Pose,
    ) -> Placement;
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

impl<'a> From<&'a Body<Cloud>> for BodyRef<'a> {
    fn from(body: &'a Body<Cloud>) -> Self {
        match body {
            Body::Cloud(cloud) => cloud.into(),
            Body::Mesh(mesh) => mesh.into(),
        }
    }
}

impl<'a> From<&'a Body<PaperCloud>> for PaperBodyRef<'a> {
    fn from(body: &'a Body<PaperCloud>) -> Self {
        match body {
            Body::Cloud(cloud) => cloud.into(),
            Body::Mesh(mesh) => mesh.into(),
        }
    }
}

impl Estimator for Query {
    type Cloud = Cloud;

    fn ask(
        &self,
        scene: &Body<Cloud>,
        object: &Body<Cloud>,
        scene_from_object: &Pose,
    ) -> Result<Report, QueryError> {
        self.run(scene, object, scene_from_object)
    }

    fn ask_within(
        &self,
        scene: &Body<Cloud>,
        object: &Body<Cloud>,
        scene_from_object: &Pose,
        margin: Option<f64>,
    ) -> Result<(Report, Option<Nearness>), QueryError> {
        let Some(margin) = margin else {
            return Ok((self.ask(scene, object, scene_from_object)?, None));
        };
        let (report, within, interval) =
            self.nearness(scene, object, scene_from_object, margin, SHARE)?;
        Ok((report, Some(Nearness { within, interval })))
    }

    fn uncertain(
        &self,
        scene: &Body<Cloud>,
        object: &Body<Cloud>,
        scene_from_object: &PoseDistribution,
    ) -> Result<Option<UnderPoses>, QueryError> {
        Ok(Some(self.run_uncertain(scene, object, scene_from_object)?.1))
    }

    fn slopes(
        &self,
        scene: &Body<Cloud>,
        object: &Body<Cloud>,
        scene_from_object: &Pose,
    ) -> Result<Option<PoseGradient>, QueryError> {
        Ok(Some(self.gradient(scene, object, scene_from_object)?.1))
    }

    fn way_out(
        &self,
        scene: &Body<Cloud>,
        object: &Body<Cloud>,
        scene_from_object: &Pose,
        probability: f64,
    ) -> Result<Option<Penetration>, QueryError> {
        Ok(self.penetration(scene, object, scene_from_object, probability)?.1)
    }

    fn place(
        &self,
        scene: &Body<Cloud>,
        object: &Body<Cloud>,
        scene_from_object: &Pose,
    ) -> Placement {
        BodyRef::from(scene).placement(object.into(), scene_from_object)
    }
}

impl Estimator for PaperQuery {
    type Cloud = PaperCloud;

    fn ask(
        &self,
        scene: &Body<PaperCloud>,
        object: &Body<PaperCloud>,
        scene_from_object: &Pose,
    ) -> Result<Report, QueryError> {
        self.run(scene, object, scene_from_object)
    }

    fn explain(
        &self,
        scene: &Body<PaperCloud>,
        object: &Body<PaperCloud>,
        scene_from_object: &Pose,
    ) -> Result<(Report, Vec<LeafClassifier>), QueryError> {
        Self::explain(self, scene, object, scene_from_object)
    }

    fn place(
        &self,
        scene: &Body<PaperCloud>,
        object: &Body<PaperCloud>,
        scene_from_object: &Pose,
    ) -> Placement {
        PaperBodyRef::from(scene).placement(object.into(), scene_from_object)
    }
}
