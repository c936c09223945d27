//! The layers: geom <- {noise, svm, bvh} <- cloudtouch <- robot <- cli, io and testkit on geom alone.

use toml::Value;

use super::manifest::{KINDS, Manifest};

/// A development dependency of whoever likes, and of nobody otherwise among the published.
const TESTKIT: &str = "cloudtouch-testkit";

/// From the lowest layer upwards: what a crate may use comes before it.
const LAYERS: [&str; 10] = [
    "cloudtouch-geom",
    "cloudtouch-noise",
    "cloudtouch-svm",
    "cloudtouch-bvh",
    "cloudtouch",
    "cloudtouch-io",
    "cloudtouch-page",
    "cloudtouch-robot",
    "cloudtouch-cli",
    "cloudtouch-evaluation",
];

/// What of the project a crate may depend on; `None` for one that nobody has placed yet.
fn may_use(name: &str) -> Option<&'static [&'static str]> {
    Some(match name {
        "cloudtouch-geom" => &[],
        "cloudtouch-noise" | "cloudtouch-svm" | "cloudtouch-bvh" | "cloudtouch-io" | TESTKIT => {
            &LAYERS[..1]
        }
        "cloudtouch" => &LAYERS[..4],
        "cloudtouch-page" => &LAYERS[4..5],
        "cloudtouch-robot" => &LAYERS[4..6],
        "cloudtouch-cli" | "cloudtouch-python" => &LAYERS[4..8],
        "cloudtouch-benches" | "cloudtouch-fuzzing" | "cloudtouch-evaluation" => &LAYERS[..9],
        "xtask" => &LAYERS,
        _ => return None,
    })
}

/// Dependencies that point sideways or up, or from a published crate to an unpublished one.
pub(super) fn check(manifests: &[Manifest]) -> Vec<String> {
    let members: Vec<&str> = manifests.iter().map(Manifest::name).collect();
    let mut found = Vec::new();
    for manifest in manifests {
        let (name, folder) = (manifest.name(), &manifest.folder);
        let Some(allowed) = may_use(name) else {
            found.push(format!("{folder}/Cargo.toml: `{name}` has no place in the layers"));
            continue;
        };
        for kind in KINDS {
            for (key, value) in manifest.dependencies(kind) {
                let used = value.get("package").and_then(Value::as_str).unwrap_or(key);
                let for_tests =
                    used == TESTKIT && (kind == "dev-dependencies" || !manifest.is_published());
                if members.contains(&used) && !allowed.contains(&used) && !for_tests {
                    found.push(format!(
                        "{folder}/Cargo.toml: `{name}` must not use `{used}` ({kind})"
                    ));
                }
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tidy::manifest::tests::manifest;

    /// The faults of a project whose crates are given as name, published and dependency lines.
    fn faults(crates: &[(&str, bool, &str)]) -> Vec<String> {
        let of = |(name, published, dependencies): &(&str, bool, &str)| {
            let package = format!("package = {{ name = '{name}', publish = {published} }}");
            manifest(&format!("{package}\n{dependencies}"))
        };
        check(&crates.iter().map(of).collect::<Vec<_>>())
    }

    #[test]
    fn what_points_down_passes_and_sideways_upward_unpublished_and_unknown_are_named() {
        let all = [
            ("cloudtouch-geom", true, ""),
            ("cloudtouch-noise", true, ""),
            ("cloudtouch-testkit", false, ""),
        ];
        let of = |name: &str, dependencies: &str| {
            faults(&[&all[..], &[(name, true, dependencies)]].concat())
        };
        let for_tests = "[dependencies]\ncloudtouch-geom.workspace = true\n\
                         [dev-dependencies]\ncloudtouch-testkit.workspace = true";
        assert_eq!(of("cloudtouch-svm", for_tests), Vec::<String>::new());
        let noise = "cloudtouch-noise.workspace = true";
        for (name, dependencies, named) in [
            ("cloudtouch-svm", format!("[dependencies]\n{noise}"), "cloudtouch-noise"),
            ("cloudtouch-svm", format!("[dev-dependencies]\n{noise}"), "dev-"),
            ("cloudtouch-io", format!("[build-dependencies]\n{noise}"), "build-"),
            ("cloudtouch-bvh", for_tests.replace("[dev-dependencies]", ""), "testkit"),
            ("cloudtouch-io", "dependencies.n.package = 'cloudtouch-noise'".into(), "-noise"),
            ("cloudtouch-new", String::new(), "no place"),
        ] {
            let found = of(name, &dependencies);
            assert!(found.len() == 1 && found[0].contains(named), "{dependencies}: {found:?}");
        }
        let upward = ("cloudtouch-geom", true, "[dependencies]\ncloudtouch.workspace = true");
        assert_eq!(faults(&[upward, ("cloudtouch", true, "")]).len(), 1);
    }
}
