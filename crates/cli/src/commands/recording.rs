//! `cloudtouch info run.mcap`: which scans a recording holds, and what one of them is.

use anyhow::{Result, ensure};
use cloudtouch::geom::PointCloud;
use cloudtouch_io::recording::{RecordedScan, Recording, ScanName, Topic};
use cloudtouch_io::scaled_cloud;

use crate::answers::print::one_line;
use crate::args::InfoArguments;
use crate::usage::WrongUsage;

/// The topics of a recording, or where and when the scan named was taken and what `describe_cloud`
/// says of it.
pub(super) fn describe(
    name: &ScanName,
    arguments: &InfoArguments,
    describe_cloud: impl Fn(&PointCloud) -> Result<String>,
) -> Result<String> {
    let mut recording = Recording::open(&name.file, &arguments.limits.read_limits())?;
    if name.topic.is_none() && name.at.is_none() {
        ensure!(
            arguments.unit.is_none() && arguments.cloud_unit.is_none(),
            WrongUsage(
                "--unit and --cloud-unit are for meshes and clouds, and this is a recording: name a \
                 scan of it, as in run.mcap#/topic@SECONDS"
                    .to_owned()
            )
        );
        return Ok(list(name, &recording.topics()?));
    }
    ensure!(
        arguments.unit.is_none(),
        WrongUsage("--unit is for meshes, and this is a cloud: give --cloud-unit".to_owned())
    );
    let RecordedScan { scan, topic, time } = recording.scan(name.topic.as_deref(), name.at)?;
    let unit = arguments.cloud_unit.unwrap_or_default();
    let text = describe_cloud(&scaled_cloud(scan.cloud, unit.in_metres()))?;
    let (topic, frame) = (one_line(&topic), one_line(&scan.frame_id));
    let stamp = scan.stamp_ns as f64 / 1e9;
    Ok(format!("scan        {topic} at {time} s, frame {frame}, stamp {stamp:.3} s\n{text}"))
}

/// Each topic in a line; times are rounded down, so that they can be asked for.
fn list(name: &ScanName, topics: &[Topic]) -> String {
    let Some(example) = topics.first() else {
        return "no topic holds sensor_msgs/PointCloud2".to_owned();
    };
    let longest = topics.iter().map(|topic| topic.name.chars().count()).max().unwrap_or_default();
    let mut lines: Vec<String> = topics
        .iter()
        .map(|Topic { name, frame_id, messages, first, last }| {
            let (first, last) = (milliseconds(*first), milliseconds(*last));
            let name = one_line(name);
            let frame = match frame_id {
                Ok(frame) => format!("frame {}", one_line(frame)),
                Err(problem) => {
                    format!("the first is not read: {}", one_line(&problem.to_string()))
                }
            };
            format!("{name:longest$}  {messages} scans, {first} to {last} s, {frame}")
        })
        .collect();
    lines.push(format!(
        "Seconds count from the beginning of the recording; {}#{}@{} is the first scan.",
        name.file.display(),
        one_line(&example.name),
        milliseconds(example.first)
    ));
    lines.join("\n")
}

fn milliseconds(seconds: f64) -> String {
    format!("{:.3}", (seconds * 1e3).floor() / 1e3)
}
