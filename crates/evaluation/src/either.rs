//! Both paths under one name, for what is measured of either.

use cloudtouch::{
    BodyRef, Cloud, CloudSettings, Mesh, Mode, PaperBodyRef, PaperCloud, PaperCloudSettings,
    PaperQuery, PaperSettings, PrepareError, Query, QueryError, QuerySettings, Report, StageReport,
    noise::SensorModel,
};
use cloudtouch_geom::{PointCloud, Pose};

/// A cloud prepared with the default settings of a path.
pub(crate) enum EitherCloud {
    Calibrated(Cloud),
    Paper(PaperCloud),
}

/// What either path may be asked about.
#[derive(Clone, Copy)]
pub(crate) enum EitherRef<'a> {
    Cloud(&'a EitherCloud),
    Mesh(&'a Mesh),
}

/// A query with the default settings of a path.
pub(crate) enum EitherQuery {
    Calibrated(Box<Query>),
    Paper(PaperQuery),
}

impl EitherCloud {
    pub(crate) fn prepare(
        cloud: &PointCloud,
        sensor: SensorModel,
        mode: Mode,
    ) -> Result<Self, PrepareError> {
        Ok(match mode {
            Mode::Calibrated => {
                Self::Calibrated(Cloud::prepare(cloud, &CloudSettings::new(sensor))?)
            }
            Mode::Paper => {
                Self::Paper(PaperCloud::prepare(cloud, &PaperCloudSettings::new(sensor))?)
            }
        })
    }

    pub(crate) fn filter_stages(&self) -> &[StageReport] {
        match self {
            Self::Calibrated(cloud) => cloud.filter_stages(),
            Self::Paper(cloud) => cloud.filter_stages(),
        }
    }
}

impl<'a> From<&'a EitherCloud> for EitherRef<'a> {
    fn from(cloud: &'a EitherCloud) -> Self {
        Self::Cloud(cloud)
    }
}

impl<'a> From<&'a Mesh> for EitherRef<'a> {
    fn from(mesh: &'a Mesh) -> Self {
        Self::Mesh(mesh)
    }
}

impl<'a> EitherRef<'a> {
    fn calibrated(self) -> BodyRef<'a> {
        match self {
            Self::Cloud(EitherCloud::Calibrated(cloud)) => cloud.into(),
            Self::Cloud(EitherCloud::Paper(_)) => unreachable!("prepared by the paper"),
            Self::Mesh(mesh) => mesh.into(),
        }
    }

    fn paper(self) -> PaperBodyRef<'a> {
        match self {
            Self::Cloud(EitherCloud::Paper(cloud)) => cloud.into(),
            Self::Cloud(EitherCloud::Calibrated(_)) => unreachable!("not prepared by the paper"),
            Self::Mesh(mesh) => mesh.into(),
        }
    }
}

impl EitherQuery {
    pub(crate) fn new(mode: Mode) -> Self {
        // Default settings are checked by the library's own tests.
        match mode {
            Mode::Calibrated => Self::Calibrated(Box::new(
                Query::new(QuerySettings::default()).expect("default settings are allowed"),
            )),
            Mode::Paper => Self::Paper(
                PaperQuery::new(PaperSettings::default()).expect("default settings are allowed"),
            ),
        }
    }

    /// Asks about bodies that were prepared for the same path.
    pub(crate) fn run<'a>(
        &self,
        a: impl Into<EitherRef<'a>>,
        b: impl Into<EitherRef<'a>>,
        a_from_b: &Pose,
    ) -> Result<Report, QueryError> {
        let (a, b) = (a.into(), b.into());
        match self {
            Self::Calibrated(query) => query.run(a.calibrated(), b.calibrated(), a_from_b),
            Self::Paper(query) => query.run(a.paper(), b.paper(), a_from_b),
        }
    }
}
