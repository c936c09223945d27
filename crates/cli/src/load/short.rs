//! Names of files, for messages, and without their folders, for titles.

use std::path::Path;

use cloudtouch_io::recording::file_of;

/// A file as it was named.
pub(super) fn named(path: &Path) -> String {
    path.display().to_string()
}

/// Of a body that was read from these files, each as it was named. What names a scan in a recording stays whole, with
/// the slashes of its topic.
pub(super) fn of(names: &[String]) -> String {
    let short: Vec<&str> = names.iter().map(|name| without_folder(name)).collect();
    short.join(", ")
}

fn without_folder(name: &str) -> &str {
    let file = file_of(Path::new(name));
    let last = file.file_name().and_then(|last| last.to_str());
    let folder = last.and_then(|last| file.to_str()?.strip_suffix(last)).unwrap_or_default();
    name.strip_prefix(folder).unwrap_or(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A scan of a recording was called `points@12.5`, and of several scans only the last was named.
    #[test]
    fn every_file_is_named_and_a_recording_with_its_topic() {
        for (names, short) in [
            (&["a/b/scan.pcd"][..], "scan.pcd"),
            (&["scan.pcd", "b/second.pcd"], "scan.pcd, second.pcd"),
            (&["runs/run.mcap#/lidar/points@12.5"], "run.mcap#/lidar/points@12.5"),
            (&["../run.mcap"], "run.mcap"),
            (&["a/b#2/scan#1.pcd"], "scan#1.pcd"),
            (&[".."], ".."),
        ] {
            let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
            assert_eq!(of(&names), short);
        }
    }
}
