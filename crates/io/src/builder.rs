//! From rows of numbers to a checked cloud: which columns mean what, and what they must satisfy.

use std::path::Path;

use cloudtouch_geom::{Covariance, Matrix3, Point3, PointCloud};

use crate::{
    error::WriteError,
    fault::{Fault, FormatError, Place},
    limits::ReadLimits,
};

/// Names of the columns a cloud is made of: coordinates (m), then the covariance (m²).
pub(crate) const COLUMN_NAMES: [&str; 9] =
    ["x", "y", "z", "cov_xx", "cov_xy", "cov_xz", "cov_yy", "cov_yz", "cov_zz"];

/// The values of one row, in the order of [`COLUMN_NAMES`].
pub(crate) type Row = [f64; COLUMN_NAMES.len()];

/// For each column of the cloud (three, or nine with covariances) where it is among `names`.
///
/// Case does not matter. Of the covariance columns there must be all or none.
pub(crate) fn find_columns<'a>(
    names: impl Iterator<Item = &'a str> + Clone,
) -> Result<Vec<usize>, Fault> {
    let find = |wanted: &'static str| {
        let mut places =
            names.clone().enumerate().filter(|(_, n)| n.eq_ignore_ascii_case(wanted)).map(|p| p.0);
        match (places.next(), places.next()) {
            (Some(_), Some(_)) => Err(Fault::Repeated { entry: format!("the column {wanted}") }),
            (place, _) => Ok(place),
        }
    };
    let (mut columns, mut missing) = (Vec::new(), Vec::new());
    for name in COLUMN_NAMES {
        match find(name)? {
            Some(place) => columns.push(place),
            None => missing.push(name),
        }
    }
    match missing.first() {
        Some(&name) if columns.len() > 3 || missing.len() > 6 => Err(Fault::MissingColumn { name }),
        _ => Ok(columns),
    }
}

/// A cloud in the making.
#[derive(Debug)]
pub(crate) struct CloudBuilder {
    points: Vec<Point3>,
    covariances: Option<Vec<Covariance>>,
    limits: ReadLimits,
}

impl CloudBuilder {
    /// `columns` as found by [`find_columns`]; `capacity` must be backed by bytes of the file.
    pub(crate) fn new(columns: &[usize], capacity: usize, limits: &ReadLimits) -> Self {
        let capacity = capacity.min(limits.points);
        let covariances = (columns.len() > 3).then(|| Vec::with_capacity(capacity));
        Self { points: Vec::with_capacity(capacity), covariances, limits: *limits }
    }

    pub(crate) fn len(&self) -> usize {
        self.points.len()
    }

    /// Takes a row; a missing return need not have a covariance.
    pub(crate) fn push(&mut self, values: &Row, place: Place) -> Result<(), FormatError> {
        let [x, y, z, xx, xy, xz, yy, yz, zz] = *values;
        let point = Point3::new(x, y, z);
        self.limits.check_points(self.points.len() + 1, place)?;
        if let Some(covariances) = &mut self.covariances {
            let matrix = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
            covariances.push(match Covariance::try_from_matrix(&matrix) {
                Ok(covariance) => covariance,
                Err(_) if !point.iter().all(|v| v.is_finite()) => Covariance::zero(),
                Err(cause) => {
                    return Err(place.error(Fault::Covariance { row: self.points.len(), cause }));
                }
            });
        }
        self.points.push(point);
        Ok(())
    }

    pub(crate) fn finish(self) -> PointCloud {
        PointCloud { covariances: self.covariances, ..PointCloud::from_points(self.points) }
    }
}

/// Whether a cloud can be written: its lists must be of one length.
pub(crate) fn check_cloud(path: &Path, cloud: &PointCloud) -> Result<(), WriteError> {
    let points = cloud.len();
    let length = |what, found| WriteError::Length { path: path.to_owned(), what, found, points };
    if let Some(covariances) = cloud.covariances.as_ref().filter(|all| all.len() != points) {
        return Err(length("covariances", covariances.len()));
    }
    if let Some((width, height)) = cloud.image_size
        && width.checked_mul(height) != Some(points)
    {
        return Err(length("image pixels", width.saturating_mul(height)));
    }
    match cloud.from_sensor().non_finite_entry() {
        Some(value) => Err(WriteError::SensorPose { path: path.to_owned(), value }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_found_in_any_order_and_case() {
        let find = |names: &[&'static str]| find_columns(names.iter().copied());
        assert_eq!(find(&["rgb", "Z", "X", "Y"]), Ok(vec![2, 3, 1]));
        assert_eq!(find(&["x", "z"]), Err(Fault::MissingColumn { name: "y" }));
        assert_eq!(
            find(&["x", "y", "z", "X"]),
            Err(Fault::Repeated { entry: "the column x".into() })
        );
        let mut names = COLUMN_NAMES.to_vec();
        assert_eq!(find(&names).map(|c| c.len()), Ok(9));
        names.remove(4);
        assert_eq!(find(&names), Err(Fault::MissingColumn { name: "cov_xy" }));
    }

    #[test]
    fn only_a_missing_return_may_lack_a_covariance() {
        let columns = [0; 9];
        let mut builder = CloudBuilder::new(&columns, 0, &ReadLimits::default());
        let mut row = [f64::NAN; 9];
        builder.push(&row, Place::Line(1)).unwrap();
        row[..2].fill(1.0);
        builder.push(&row, Place::Line(1)).unwrap();
        row[2] = 1.0;
        let error = builder.push(&row, Place::Line(2)).unwrap_err();
        assert!(matches!(
            error,
            FormatError { place: Place::Line(2), fault: Fault::Covariance { row: 2, .. } }
        ));
        assert_eq!(builder.finish().covariances, Some(vec![Covariance::zero(); 2]));
    }
}
