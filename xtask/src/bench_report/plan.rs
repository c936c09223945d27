//! How much a run measures.

/// Fewer poses than this are a trial: everything else is small too.
const TRIAL_BELOW: usize = 30;

/// Numbers of problems, poses and points of the parts of a run.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Plan {
    /// How often each query is timed; the least counts.
    pub(super) repeats: usize,
    /// How often each small leaf problem is solved; the least time counts.
    pub(super) solves: usize,
    /// Depth frames of each kind.
    pub(super) frames: usize,
    /// Points of a side and the number of robust problems of each cell.
    pub(super) robust: &'static [(usize, usize)],
    /// Points of a side and the number of problems of each cell without ellipsoids.
    pub(super) exact: &'static [(usize, usize)],
    /// Points of the growing scene.
    pub(super) sizes: &'static [usize],
    /// Poses asked of each size, at most.
    pub(super) growth_poses: usize,
    /// Poses of the batch.
    pub(super) batch: usize,
}

impl Plan {
    /// What suits so many poses of the piano in the room.
    pub(super) fn of(poses: usize) -> Self {
        if poses < TRIAL_BELOW {
            return Self {
                repeats: 2,
                solves: 2,
                frames: 3,
                robust: &[(20, 3), (40, 2)],
                exact: &[(40, 3)],
                sizes: &[10_000, 30_000],
                growth_poses: 6,
                batch: 200,
            };
        }
        Self {
            repeats: 7,
            solves: 3,
            frames: 20,
            // Clarabel takes a second for 2 × 100 points and many for 2 × 200.
            robust: &[(20, 30), (40, 30), (100, 6), (200, 3)],
            exact: &[(40, 30), (200, 15)],
            sizes: &[10_000, 30_000, 100_000, 300_000, 1_000_000],
            growth_poses: 30,
            batch: 10_000,
        }
    }
}
