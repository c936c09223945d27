//! The committed script is what its sources give. Skipped, with the reason, without node, npm or their registry.
#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// What npm says when it cannot reach its registry.
const UNREACHABLE: [&str; 6] =
    ["ENOTFOUND", "ECONNREFUSED", "ECONNRESET", "ETIMEDOUT", "EAI_AGAIN", "ENOTCACHED"];

fn run(folder: &Path, program: &str, arguments: &[&str]) -> Option<Output> {
    Command::new(program).args(arguments).current_dir(folder).output().ok()
}

/// A cloud that one view asked about, in the next, which did not: it kept its coloured points, and a robot that is
/// free was drawn with those of a collision.
const PLAIN_AGAIN: &str = "
import { Body } from './src/body.js';
import { Picture } from './src/picture.js';
const base64 = (list) => Buffer.from(list.buffer).toString('base64');
const body = new Body({ middle: [0, 0, 0], positions: base64(new Float32Array(9)) }, '#8b949e');
body.color({ points: base64(new Uint32Array([1])), probabilities: base64(new Uint8Array([255])) });
const asked = body.group.children.length;
Picture.prototype.showOther.call({ data: [{}], body: () => body, stand: () => null }, { body: 0 });
process.exit(asked === 2 && body.group.children.length === 1 ? 0 : 1);
";

#[test]
fn the_script_is_what_its_sources_give() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let sources = here.join("../../viewer");
    if !sources.is_dir() {
        return println!("skipped: the sources in viewer/ are not part of the package");
    }
    let is_there = |program| run(here, program, &["--version"]).is_some_and(|o| o.status.success());
    if let Some(missing) = ["node", "npm"].into_iter().find(|program| !is_there(program)) {
        return println!("skipped: {missing} is not there");
    }
    let folder = tempfile::tempdir().unwrap();
    let copy = |name: &str| fs::copy(sources.join(name), folder.path().join(name)).unwrap();
    for name in ["package.json", "package-lock.json", "build.mjs"] {
        copy(name);
    }
    fs::create_dir(folder.path().join("src")).unwrap();
    for file in fs::read_dir(sources.join("src")).unwrap() {
        copy(&format!("src/{}", file.unwrap().file_name().to_str().unwrap()));
    }
    let install = [
        "ci",
        "--ignore-scripts",
        "--no-audit",
        "--no-fund",
        "--prefer-offline",
        "--fetch-retries=0",
    ];
    let installed = run(folder.path(), "npm", &install).unwrap();
    let said = String::from_utf8_lossy(&installed.stderr).into_owned();
    if !installed.status.success() && UNREACHABLE.iter().any(|code| said.contains(code)) {
        return println!("skipped: the registry of npm cannot be reached");
    }
    assert!(installed.status.success(), "{said}");
    let plain = run(folder.path(), "node", &["--input-type=module", "-e", PLAIN_AGAIN]).unwrap();
    assert!(plain.status.success(), "{}", String::from_utf8_lossy(&plain.stderr));
    fs::create_dir(folder.path().join("out")).unwrap();
    let built = run(folder.path(), "node", &["build.mjs", "out/viewer.js"]).unwrap();
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    for name in ["viewer.js", "LICENSE-three.txt"] {
        let made = fs::read(folder.path().join("out").join(name)).unwrap();
        let committed = fs::read(here.join("viewer").join(name)).unwrap();
        assert!(made == committed, "{name} is stale: run `npm ci && npm run build` in viewer/");
    }
}
