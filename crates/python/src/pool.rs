//! The threads that the library computes on, apart from Python's.

use std::mem;
use std::process;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::error::refused;

/// The pool, with the process that started its threads.
static POOL: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);

/// The process that imported the package.
static HOME: LazyLock<u32> = LazyLock::new(process::id);

/// Does the work on all threads, and lets other Python threads run meanwhile.
pub(crate) fn on_all_threads<T: Send>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send,
) -> PyResult<T> {
    let pool = pool()?;
    Ok(py.detach(|| pool.install(work)))
}

/// Runs what mostly needs no other thread on this one, without the GIL. What does need others, such as the first
/// query of a blurred cloud, takes those of rayon's global pool, which in a forked process may be its parent's: there
/// it runs in the pool.
pub(crate) fn on_this_thread<T: Send>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send,
) -> PyResult<T> {
    if process::id() == *HOME { Ok(py.detach(work)) } else { on_all_threads(py, work) }
}

/// Notes which process the package was imported in.
pub(crate) fn note_process() {
    LazyLock::force(&HOME);
}

/// As many threads as the machine has cores, or as `RAYON_NUM_THREADS` says.
///
/// A forked process (`multiprocessing` on Linux before Python 3.14) has a copy of the pool and none of
/// its threads: work given to those would never end, as it would in rayon's global pool. Whoever comes
/// here holds the GIL, and so does who forks: the lock is free in the child.
pub(crate) fn pool() -> PyResult<Arc<ThreadPool>> {
    let mut known = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    let here = process::id();
    match &*known {
        Some((owner, pool)) if *owner == here => Ok(Arc::clone(pool)),
        _ => {
            let pool = Arc::new(ThreadPoolBuilder::new().build().map_err(refused)?);
            // The parent's: to drop it would be to talk to threads that are not there.
            mem::forget(known.replace((here, Arc::clone(&pool))));
            Ok(pool)
        }
    }
}
