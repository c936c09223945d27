//! Where the mesh files of a URDF are.

use std::path::{Path, PathBuf};

use crate::error::RobotFault;

/// The file that a link's mesh is in.
///
/// `package://name/rest` is looked up among `packages`; else in a folder of that name that holds the
/// URDF's, or lies beside one that does, as packages do in a ROS workspace.
pub(crate) fn locate(
    link: &str,
    uri: &str,
    folder: &Path,
    packages: &[(String, PathBuf)],
) -> Result<PathBuf, RobotFault> {
    let (link, owned) = (link.to_owned(), uri.to_owned());
    if uri.trim().is_empty() {
        return Err(RobotFault::UnnamedMesh { link });
    }
    let path = if let Some(path) = uri.strip_prefix("file://") {
        // Relative ones are not by the standard, and common.
        folder.join(path)
    } else if let Some((package, rest)) = in_package(uri) {
        let given = packages.iter().find(|(name, _)| name == package).map(|(_, at)| at.clone());
        let Some(at) = given.or_else(|| around(folder, package)) else {
            return Err(RobotFault::UnknownPackage {
                link,
                uri: owned,
                package: package.to_owned(),
            });
        };
        at.join(rest)
    } else if uri.contains("://") {
        return Err(RobotFault::Scheme { link, uri: owned });
    } else {
        folder.join(uri)
    };
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("dae")) {
        return Err(RobotFault::Collada { link, uri: owned });
    }
    if !path.is_file() {
        return Err(RobotFault::MissingMesh { link, uri: owned, path });
    }
    Ok(path)
}

/// The package of a file, and where it is in that.
pub(crate) fn in_package(uri: &str) -> Option<(&str, &str)> {
    let rest = uri.strip_prefix("package://").or_else(|| uri.strip_prefix("model://"))?;
    // Some write one slash too many.
    let rest = rest.trim_start_matches('/');
    Some(rest.split_once('/').unwrap_or((rest, "")))
}

fn around(folder: &Path, package: &str) -> Option<PathBuf> {
    // Of a file that is named without a folder that is empty, which is no path.
    let folder = std::path::absolute(Path::new(".").join(folder)).ok()?;
    folder.ancestors().find_map(|at| {
        let is_it = at.file_name().is_some_and(|name| name == package);
        let beside = at.join(package);
        is_it.then(|| at.to_owned()).or_else(|| beside.is_dir().then_some(beside))
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    /// Of `arm.urdf` alone, as one writes it in its folder, the folder is empty.
    #[test]
    fn the_package_around_a_file_of_the_working_folder_was_not_known() {
        let here = std::env::current_dir().unwrap();
        let name = here.file_name().unwrap().to_str().unwrap();
        assert_eq!(around(Path::new(""), name), Some(here.clone()));
        assert_eq!(around(Path::new(""), "src"), Some(here.join("src")));
        assert_eq!(around(Path::new("src"), name), Some(here));
    }
}
