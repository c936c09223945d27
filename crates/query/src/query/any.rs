//! Many pairs of bodies, asked until one is not free.

use cloudtouch_geom::Pose;

use crate::body::BodyRef;
use crate::error::QueryError;
use crate::report::{Report, Verdict};

use super::run::Query;

/// A pair that does not read as free.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct NotFree {
    /// Which of the pairs asked about, from 0.
    pub index: usize,
    /// Its report; or why it has none, which is not free either.
    pub answer: Result<Report, QueryError>,
}

impl Query {
    /// The first of these pairs, each with its pose `a_from_b`, that does not read as free: whose
    /// probability may be [`reject`](crate::QuerySettings::reject) or more, that is undecided, or that
    /// cannot be asked. Those after it are not looked at; `None` where all are free.
    ///
    /// With [`Detail::Verdict`](crate::Detail::Verdict) it is known soonest. A deadline is that of each pair;
    /// [`Self::begun_now`] makes it that of all.
    ///
    /// ```
    /// use cloudtouch::geom::{Point3, PointCloud, Pose, Vector3};
    /// use cloudtouch::noise::SensorModel;
    /// use cloudtouch::{Cloud, CloudSettings, Query, QuerySettings, Verdict};
    ///
    /// let sheet = |z: f64| -> Vec<Point3> {
    ///     (0..400).map(|i| Point3::new(0.01 * (i % 20) as f64, 0.01 * (i / 20) as f64, z)).collect()
    /// };
    /// let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.001 });
    /// let prepare = |z| Cloud::prepare(&PointCloud::from_points(sheet(z)), &settings);
    /// let (table, plate) = (prepare(0.0)?, prepare(0.05)?);
    /// let query = Query::new(QuerySettings::default())?;
    /// let lowered = |by: f64| (&table, &plate, Pose::from_translation(Vector3::new(0.0, 0.0, -by)));
    /// assert_eq!(query.any([lowered(0.0), lowered(0.02)]), None);
    /// let found = query.any([lowered(0.0), lowered(0.05), lowered(0.02)]).unwrap();
    /// assert_eq!(found.index, 1);
    /// assert_ne!(found.answer?.verdict, Verdict::Free);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn any<'a, A: Into<BodyRef<'a>>, B: Into<BodyRef<'a>>>(
        &self,
        pairs: impl IntoIterator<Item = (A, B, Pose)>,
    ) -> Option<NotFree> {
        let answers = pairs.into_iter().map(|(a, b, a_from_b)| self.run(a, b, &a_from_b));
        let is_free = |answer: &Result<Report, QueryError>| matches!(answer, Ok(report) if report.verdict == Verdict::Free);
        let mut open = answers.enumerate().filter(|(_, answer)| !is_free(answer));
        open.next().map(|(index, answer)| NotFree { index, answer })
    }
}
