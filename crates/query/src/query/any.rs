//! Whether bodies are free and no more; many pairs of them, until one is not.

use cloudtouch_geom::Pose;

use crate::body::BodyRef;
use crate::error::QueryError;
use crate::report::{Report, Verdict};

use super::run::Query;
use super::settings::Detail;

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
    /// Whether a pair reads as free: the verdict of [`Self::run`], sooner, for no more is looked at than that takes
    /// ([`Detail::Free`]). What is not free may be uncertain, undecided or in collision.
    ///
    /// # Errors
    /// As [`Self::run`]; a pair that has no answer is not free.
    ///
    /// ```
    /// use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3};
    /// use cloudtouch::noise::SensorModel;
    /// use cloudtouch::{Cloud, CloudSettings, Mesh, Query, QuerySettings};
    ///
    /// let table = (0..400).map(|i| Point3::new(0.01 * (i % 20) as f64, 0.01 * (i / 20) as f64, 0.0));
    /// let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.001 });
    /// let table = Cloud::prepare(&PointCloud::from_points(table.collect()), &settings)?;
    /// let finger = [[0.08, 0.1, 0.0], [0.12, 0.08, 0.0], [0.12, 0.12, 0.0], [0.1, 0.1, 0.1]];
    /// let sides = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    /// let finger = Mesh::prepare(&TriangleMesh::new(finger.map(Point3::from).to_vec(), sides)?)?;
    /// let query = Query::new(QuerySettings::default())?;
    /// let at = |z: f64| Pose::from_translation(Vector3::new(0.0, 0.0, z));
    /// assert!(query.is_free(&table, &finger, &at(0.05))?);
    /// assert!(!query.is_free(&table, &finger, &at(-0.05))?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn is_free<'a>(
        &self,
        a: impl Into<BodyRef<'a>>,
        b: impl Into<BodyRef<'a>>,
        a_from_b: &Pose,
    ) -> Result<bool, QueryError> {
        let report = self.with_detail(Detail::Free).run(a, b, a_from_b)?;
        Ok(report.verdict == Verdict::Free)
    }

    /// The first of these pairs, each with its pose `a_from_b`, that does not read as free: whose
    /// probability may be [`reject`](crate::QuerySettings::reject) or more, that is undecided, or that
    /// cannot be asked. Those after it are not looked at; `None` where all are free.
    ///
    /// With [`Detail::Free`] it is known soonest. A deadline is that of each pair;
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
