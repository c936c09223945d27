//! What the clouds of both paths tell of themselves.

/// The public accessors of a cloud whose field `prepared` is a `Prepared`.
macro_rules! cloud_accessors {
    ($cloud:ident) => {
        impl $cloud {
            /// How many points the filter kept.
            pub fn len(&self) -> usize {
                self.prepared.len()
            }

            /// Never true: preparing an empty cloud is an error.
            pub fn is_empty(&self) -> bool {
                self.len() == 0
            }

            /// A kept point in the file's frame, m.
            ///
            /// # Panics
            /// When the index is out of range.
            pub fn point(&self, index: usize) -> $crate::geom::Point3 {
                self.prepared.point(index)
            }

            /// For every kept point its row in the input; empty when a collision map replaced the
            /// points.
            pub fn rows(&self) -> &[usize] {
                self.prepared.rows()
            }

            /// The points that were likely measured inside of a mesh without a border, as (index, probability)
            /// in index order: of a point d metres inside, known with the standard deviation σ, Φ(d/σ).
            /// For pictures: a report's
            /// [`point_probabilities`](crate::Report::point_probabilities) are of points that may touch.
            pub fn points_inside(
                &self,
                mesh: &$crate::Mesh,
                mesh_from_cloud: &$crate::geom::Pose,
            ) -> Vec<(usize, f64)> {
                $crate::cloud::points_inside(&self.prepared, mesh, mesh_from_cloud)
            }

            /// What the filter removed, stage by stage.
            pub fn filter_stages(&self) -> &[$crate::StageReport] {
                self.prepared.filter_stages()
            }

            /// How long preparation took.
            pub fn prepare_time(&self) -> std::time::Duration {
                self.prepared.prepare_time()
            }

            pub(crate) fn prepared(&self) -> &$crate::cloud::Prepared {
                &self.prepared
            }
        }
    };
}

pub(crate) use cloud_accessors;
