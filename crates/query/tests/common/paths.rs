//! Both paths under one name, for what holds of either.

use cloudtouch::geom::{Point3, PointCloud, Pose};
use cloudtouch::noise::SensorModel;
use cloudtouch::{
    BodyRef, Cloud, CloudSettings, Mesh, Mode, PaperBodyRef, PaperCloud, PaperCloudSettings,
    PaperQuery, PaperSettings, PrepareError, Query, QueryError, QuerySettings, Report, StageReport,
};

pub(crate) const MODES: [Mode; 2] = [Mode::Calibrated, Mode::Paper];

/// A cloud prepared for a path.
#[derive(Debug)]
pub(crate) enum Scan {
    Calibrated(Cloud),
    Paper(PaperCloud),
}

impl Scan {
    /// Prepares a cloud with the settings of a path for ordinary use: the paper's with our amendments, for
    /// what the printed ones do is tested apart.
    pub(crate) fn of(
        cloud: &PointCloud,
        sensor: SensorModel,
        mode: Mode,
    ) -> Result<Self, PrepareError> {
        Ok(match mode {
            Mode::Calibrated => {
                Self::Calibrated(Cloud::prepare(cloud, &CloudSettings::new(sensor))?)
            }
            Mode::Paper => {
                Self::Paper(PaperCloud::prepare(cloud, &PaperCloudSettings::amended(sensor))?)
            }
        })
    }

    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Calibrated(cloud) => cloud.len(),
            Self::Paper(cloud) => cloud.len(),
        }
    }

    pub(crate) fn filter_stages(&self) -> &[StageReport] {
        match self {
            Self::Calibrated(cloud) => cloud.filter_stages(),
            Self::Paper(cloud) => cloud.filter_stages(),
        }
    }

    pub(crate) fn point(&self, index: usize) -> Point3 {
        match self {
            Self::Calibrated(cloud) => cloud.point(index),
            Self::Paper(cloud) => cloud.point(index),
        }
    }
}

/// What either path may be asked.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Asked<'a> {
    Calibrated(&'a Cloud),
    Paper(&'a PaperCloud),
    Mesh(&'a Mesh),
}

impl<'a> From<&'a Scan> for Asked<'a> {
    fn from(scan: &'a Scan) -> Self {
        match scan {
            Scan::Calibrated(cloud) => Self::Calibrated(cloud),
            Scan::Paper(cloud) => Self::Paper(cloud),
        }
    }
}

impl<'a> From<&'a Cloud> for Asked<'a> {
    fn from(cloud: &'a Cloud) -> Self {
        Self::Calibrated(cloud)
    }
}

impl<'a> From<&'a PaperCloud> for Asked<'a> {
    fn from(cloud: &'a PaperCloud) -> Self {
        Self::Paper(cloud)
    }
}

impl<'a> From<&'a Mesh> for Asked<'a> {
    fn from(mesh: &'a Mesh) -> Self {
        Self::Mesh(mesh)
    }
}

impl<'a> Asked<'a> {
    pub(crate) fn calibrated(self) -> BodyRef<'a> {
        match self {
            Self::Calibrated(cloud) => cloud.into(),
            Self::Mesh(mesh) => mesh.into(),
            Self::Paper(_) => panic!("a cloud of the paper's path"),
        }
    }

    pub(crate) fn paper(self) -> PaperBodyRef<'a> {
        match self {
            Self::Paper(cloud) => cloud.into(),
            Self::Mesh(mesh) => mesh.into(),
            Self::Calibrated(_) => panic!("a cloud of the default path"),
        }
    }
}

/// A query of a path.
#[derive(Debug, Clone)]
pub(crate) enum AnyQuery {
    Calibrated(Box<Query>),
    Paper(Box<PaperQuery>),
}

impl AnyQuery {
    /// With the settings for ordinary use but for these.
    pub(crate) fn with(
        mode: Mode,
        calibrated: impl FnOnce(&mut QuerySettings),
        paper: impl FnOnce(&mut PaperSettings),
    ) -> Self {
        match mode {
            Mode::Calibrated => {
                let mut settings = QuerySettings::default();
                calibrated(&mut settings);
                Self::Calibrated(Box::new(Query::new(settings).expect("good settings")))
            }
            Mode::Paper => {
                let mut settings = PaperSettings::amended();
                paper(&mut settings);
                Self::Paper(Box::new(PaperQuery::new(settings).expect("good settings")))
            }
        }
    }

    pub(crate) fn run<'a>(
        &self,
        a: impl Into<Asked<'a>>,
        b: impl Into<Asked<'a>>,
        a_from_b: &Pose,
    ) -> Result<Report, QueryError> {
        let (a, b) = (a.into(), b.into());
        match self {
            Self::Calibrated(query) => query.run(a.calibrated(), b.calibrated(), a_from_b),
            Self::Paper(query) => query.run(a.paper(), b.paper(), a_from_b),
        }
    }

    pub(crate) fn run_batch<'a>(
        &self,
        a: impl Into<Asked<'a>>,
        b: impl Into<Asked<'a>>,
        a_from_b: &[Pose],
    ) -> Vec<Result<Report, QueryError>> {
        let (a, b) = (a.into(), b.into());
        match self {
            Self::Calibrated(query) => query.run_batch(a.calibrated(), b.calibrated(), a_from_b),
            Self::Paper(query) => query.run_batch(a.paper(), b.paper(), a_from_b),
        }
    }
}
