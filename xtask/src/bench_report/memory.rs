//! What a prepared cloud takes, measured in a process of its own.

use std::{
    fs::File,
    io::{BufReader, BufWriter, Read, Write},
    path::Path,
    process::Command,
};

use anyhow::{Context, Result, ensure};
use cloudtouch::{Query, QuerySettings};
use cloudtouch_geom::{Point3, PointCloud, Pose};
use nalgebra::Matrix4;

use super::scene::{STD, prepare};

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

/// Whether memory can be measured here.
pub(super) fn is_possible() -> bool {
    Path::new(STATUS).exists()
}

/// Prepares the room in a fresh process, asks it about the poses and says what that takes; the
/// bytes of its input and of the piano do not count.
pub(super) fn measure(
    folder: &Path,
    [room, piano]: [&PointCloud; 2],
    poses: &[Pose],
) -> Result<Memory> {
    let file = folder.join("memory.bin");
    write(&file, [room, piano], poses)?;
    let program = std::env::current_exe().context("find this program")?;
    let output =
        Command::new(program).args(["bench-report", "--probe-memory"]).arg(&file).output()?;
    std::fs::remove_file(&file)?;
    let errors = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "the process that measures memory failed: {errors}");
    let text = String::from_utf8(output.stdout)?;
    let bytes: Vec<f64> = text.split_whitespace().map(str::parse).collect::<Result<_, _>>()?;
    let [held, peak] = bytes[..].try_into().context("two numbers were expected")?;
    Ok(Memory { held, peak })
}

/// The child's part: prints both numbers.
pub(super) fn probe(file: &Path) -> Result<()> {
    let mut input = BufReader::new(File::open(file)?);
    // Read point by point: a large buffer that is given back would hide what is taken next.
    let mut count = || -> Result<usize> { Ok(number(&mut input)? as usize) };
    let [rooms, pianos, poses] = [count()?, count()?, count()?];
    let room = read_points(&mut input, rooms)?;
    let piano = prepare(&read_points(&mut input, pianos)?, STD)?;
    let mut placed = Vec::with_capacity(poses);
    for _ in 0..poses {
        let mut matrix = Matrix4::zeros();
        for entry in matrix.iter_mut() {
            *entry = number(&mut input)?;
        }
        placed.push(Pose::try_from_matrix(&matrix)?);
    }
    let query = Query::new(QuerySettings::default())?;
    let before = resident("VmRSS:")?;
    let prepared = prepare(&room, STD)?;
    for pose in &placed {
        query.run(&prepared, &piano, pose)?;
    }
    let (held, peak) = (resident("VmRSS:")? - before, resident("VmHWM:")? - before);
    // The cloud has to live until here.
    ensure!(prepared.len() == room.len(), "the filter dropped points");
    println!("{held} {peak}");
    Ok(())
}

fn write(path: &Path, clouds: [&PointCloud; 2], poses: &[Pose]) -> Result<()> {
    let mut out = BufWriter::new(File::create(path)?);
    let counts = [clouds[0].len(), clouds[1].len(), poses.len()].map(|count| count as f64);
    let points = clouds.iter().flat_map(|c| &c.points).flat_map(|p| [p.x, p.y, p.z]);
    let matrices = poses.iter().map(|pose| pose.isometry().to_homogeneous());
    let entries: Vec<f64> = matrices.flat_map(|m| m.iter().copied().collect::<Vec<_>>()).collect();
    for value in counts.into_iter().chain(points).chain(entries) {
        out.write_all(&value.to_le_bytes())?;
    }
    Ok(out.flush()?)
}

fn read_points(input: &mut impl Read, count: usize) -> Result<PointCloud> {
    let mut points = Vec::with_capacity(count);
    for _ in 0..count {
        points.push(Point3::new(number(input)?, number(input)?, number(input)?));
    }
    Ok(PointCloud::from_points(points))
}

fn number(input: &mut impl Read) -> Result<f64> {
    let mut bytes = [0; 8];
    input.read_exact(&mut bytes)?;
    Ok(f64::from_le_bytes(bytes))
}

/// A line of the status of this process, bytes.
fn resident(name: &str) -> Result<f64> {
    let text = std::fs::read_to_string(STATUS).with_context(|| format!("read {STATUS}"))?;
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
    fn what_the_child_reads_is_what_was_written() {
        let path = std::env::temp_dir().join(format!("xtask-memory-{}.bin", std::process::id()));
        let cloud = |x| PointCloud::from_points(vec![Point3::new(x, 2.0, 3.0); 2]);
        let pose = Pose::from_translation_rpy(Vector3::new(1.0, 2.0, 3.0), [0.1, 0.2, 0.3]);
        write(&path, [&cloud(1.0), &cloud(-1.0)], &[pose]).unwrap();
        let mut input = BufReader::new(File::open(&path).unwrap());
        let counts = [0; 3].map(|_| number(&mut input).unwrap());
        assert_eq!(counts, [2.0, 2.0, 1.0]);
        assert_eq!(read_points(&mut input, 2).unwrap(), cloud(1.0));
        assert_eq!(read_points(&mut input, 2).unwrap(), cloud(-1.0));
        let entries: Vec<f64> = (0..16).map(|_| number(&mut input).unwrap()).collect();
        let matrix = Matrix4::from_column_slice(&entries);
        let read = Pose::try_from_matrix(&matrix).unwrap();
        assert!((read.isometry().to_homogeneous() - matrix).amax() < 1e-12);
        assert!(number(&mut input).is_err());
        std::fs::remove_file(path).unwrap();
    }
}
