//! What a prepared cloud takes, measured in a process of its own.

use std::{fs, path::Path, process::Command};

use anyhow::{Context, Result, ensure};
use cloudtouch::{Query, QuerySettings};
use cloudtouch_geom::{PointCloud, Pose};
use cloudtouch_io::{read_cloud, write_cloud_pcd};

use super::{
    methods::prepare,
    scene::{Posed, STD},
};

/// What the kernel says of the process.
const STATUS: &str = "/proc/self/status";

/// Memory of one prepared cloud, bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Memory {
    /// Resident after preparation and queries, without what was there before.
    pub(super) held: f64,
    /// The most that was resident at any time, likewise.
    pub(super) peak: f64,
}

/// Prepares the room in a fresh process, asks it about the poses and says what that takes; the
/// bytes of its input and of the piano do not count. None where the kernel does not say.
///
/// # Errors
/// When the process fails.
pub(super) fn measure([room, piano]: [&PointCloud; 2], poses: &[Posed]) -> Result<Option<Memory>> {
    if !Path::new(STATUS).exists() {
        return Ok(None);
    }
    let folder = std::env::temp_dir().join(format!("bench-report-{}", std::process::id()));
    fs::create_dir_all(&folder)?;
    write_cloud_pcd(folder.join("room.pcd"), room)?;
    write_cloud_pcd(folder.join("piano.pcd"), piano)?;
    let rows: Vec<[f64; 16]> = poses.iter().map(|posed| entries(&posed.pose)).collect();
    fs::write(folder.join("poses.json"), serde_json::to_string(&rows)?)?;
    let program = std::env::current_exe().context("find this program")?;
    let mut child = Command::new(program);
    // Large buffers that are given back go back to the kernel: none hides what is taken next.
    child.env("MALLOC_MMAP_THRESHOLD_", "131072");
    let output = child.args(["bench-report", "--probe-memory"]).arg(&folder).output()?;
    fs::remove_dir_all(&folder)?;
    let errors = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "the process that measures memory failed: {errors}");
    let [held, peak] = serde_json::from_slice(&output.stdout)?;
    Ok(Some(Memory { held, peak }))
}

/// The child's part: prints both numbers.
///
/// # Errors
/// When the files of the parent cannot be read, or the kernel does not say what is resident.
pub(super) fn probe(folder: &Path) -> Result<()> {
    let piano = prepare(&read_cloud(folder.join("piano.pcd"))?, STD)?;
    let room = read_cloud(folder.join("room.pcd"))?;
    let rows: Vec<Vec<f64>> = serde_json::from_slice(&fs::read(folder.join("poses.json"))?)?;
    let poses: Vec<Pose> = rows.iter().map(|row| pose(row)).collect::<Result<_>>()?;
    let query = Query::new(QuerySettings::default())?;
    let before = resident("VmRSS:")?;
    let prepared = prepare(&room, STD)?;
    for pose in &poses {
        query.run(&prepared, &piano, pose)?;
    }
    let (held, peak) = (resident("VmRSS:")? - before, resident("VmHWM:")? - before);
    // The cloud has to live until here.
    ensure!(prepared.len() == room.len(), "the filter dropped points");
    println!("[{held}, {peak}]");
    Ok(())
}

/// The homogeneous matrix, column by column.
fn entries(pose: &Pose) -> [f64; 16] {
    let matrix = pose.isometry().to_homogeneous();
    std::array::from_fn(|i| matrix[i])
}

fn pose(entries: &[f64]) -> Result<Pose> {
    ensure!(entries.len() == 16, "a pose of {} numbers", entries.len());
    Ok(Pose::try_from_matrix(&nalgebra::Matrix4::from_column_slice(entries))?)
}

/// A line of the status of this process, bytes.
fn resident(name: &str) -> Result<f64> {
    let text = fs::read_to_string(STATUS).with_context(|| format!("read {STATUS}"))?;
    kibibytes(&text, name).map(|k| 1024.0 * k).with_context(|| format!("{name} in {STATUS}"))
}

fn kibibytes(text: &str, name: &str) -> Option<f64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    line.trim().strip_suffix("kB")?.trim().parse().ok()
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Vector3;

    use super::*;

    #[test]
    fn a_line_of_the_status_is_a_number() {
        let text = "Name:\tx\nVmHWM:\t   5120 kB\nVmRSS:\t    1024 kB\n";
        assert_eq!(kibibytes(text, "VmRSS:"), Some(1024.0));
        assert_eq!(kibibytes(text, "VmSwap:"), None);
    }

    #[test]
    fn the_child_gets_the_poses_that_were_meant() {
        let sent = Pose::from_translation_rpy(Vector3::new(1.0, 2.0, 3.0), [0.1, 0.2, 0.3]);
        let got = pose(&entries(&sent)).unwrap();
        assert!((entries(&got).iter().zip(entries(&sent))).all(|(a, b)| (a - b).abs() < 1e-12));
    }
}
