//! What the Python package `cloudtouch` is built on. Nobody imports this by itself: checks of arrays,
//! names and documentation are in `python/cloudtouch`, which calls in here with arrays of numbers.

#![warn(clippy::print_stdout, clippy::print_stderr)]

mod answer;
mod arrays;
mod batch;
mod body;
mod error;
mod files;
mod page;
mod pool;
mod prepare;
mod query;
mod robot;
mod rows;
mod scene;
mod sensor;
mod sweep;

#[pyo3::pymodule]
mod _native {
    #[pymodule_export]
    use crate::batch::refused;
    #[pymodule_export]
    use crate::body::Body;
    #[pymodule_export]
    use crate::error::CloudtouchError;
    #[pymodule_export]
    use crate::files::{check_camera, check_unit, read_cloud, read_faces};
    #[pymodule_export]
    use crate::prepare::{cloud, mesh};
    #[pymodule_export]
    use crate::query::Query;
    #[pymodule_export]
    use crate::robot::{Robot, RobotChecker};
    #[pymodule_export]
    use crate::scene::Scene;
    #[pymodule_export]
    use crate::sensor::check_sensor;

    #[pymodule_init]
    fn init(_module: &pyo3::Bound<'_, pyo3::types::PyModule>) -> pyo3::PyResult<()> {
        crate::pool::note_process();
        Ok(())
    }

    #[pymodule_export]
    #[allow(non_upper_case_globals, reason = "the name Python gives a version")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
