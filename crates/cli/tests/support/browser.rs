//! A headless Chromium: what it is called, and one that is spoken to by its own protocol, as a hand would use it.

use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};

use serde_json::{Value, json};
use tempfile::TempDir;

use super::Inputs;

/// Names under which distributions ship it.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

/// `CHROMIUM` in the environment, or what is found under one of the names.
pub(crate) fn chromium() -> Option<String> {
    let named = std::env::var("CHROMIUM").ok();
    let names = named.into_iter().chain(NAMES.map(str::to_owned));
    names.into_iter().find(|name| {
        Command::new(name).arg("--version").output().is_ok_and(|found| found.status.success())
    })
}

/// For a picture without a graphics card, in a profile of its own.
pub(crate) fn flags(profile: &Path) -> Vec<String> {
    let fixed = [
        "--headless",
        "--no-sandbox",
        "--use-angle=swiftshader",
        "--enable-unsafe-swiftshader",
        "--hide-scrollbars",
        "--force-device-scale-factor=1",
    ];
    let own = format!("--user-data-dir={}", profile.display());
    fixed.map(str::to_owned).into_iter().chain([own]).collect()
}

/// What a page gave: its elements when its script was through, and what the console said.
pub(crate) struct Seen {
    pub(crate) elements: String,
    pub(crate) console: Vec<String>,
}

/// Opens a page as by its address and tells what it gave.
pub(crate) fn open(browser: &str, inputs: &Inputs, address: &str, more: &[&str]) -> Seen {
    let url = format!("file://{}", inputs.path(address).display());
    let profile = tempfile::tempdir().unwrap();
    let output = Command::new(browser)
        .args(flags(profile.path()))
        .args(["--enable-logging=stderr", "--virtual-time-budget=5000"])
        .args(more)
        .arg(url)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    Seen {
        elements: String::from_utf8(output.stdout).unwrap(),
        console: said.lines().filter(|line| line.contains("CONSOLE")).map(str::to_owned).collect(),
    }
}

/// Red, green and blue of each pixel of a corner of a picture, at the upper left.
pub(crate) fn corner(path: &Path, [width, height]: [usize; 2]) -> Vec<[i32; 3]> {
    let decoder = png::Decoder::new(BufReader::new(File::open(path).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!(info.bit_depth, png::BitDepth::Eight);
    let samples = info.color_type.samples();
    let rows = bytes.chunks_exact(samples * info.width as usize).take(height);
    rows.flat_map(|row| row.chunks_exact(samples).take(width))
        .map(|pixel| std::array::from_fn(|k| i32::from(pixel[k])))
        .collect()
}

/// A page in a browser that is spoken to by the DevTools protocol.
pub(crate) struct Tab {
    browser: Child,
    to: File,
    from: BufReader<File>,
    session: Option<String>,
    last: u64,
    _folder: TempDir,
}

impl Tab {
    /// Opens a file in a window of so many pixels, of a phone or of a desktop.
    pub(crate) fn open(browser: &str, file: &Path, [width, height]: [u32; 2], touch: bool) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let [to, from] = ["to", "from"].map(|name| folder.path().join(name));
        assert!(Command::new("mkfifo").args([&to, &from]).status().unwrap().success());
        // It reads commands from descriptor 3 and answers on 4.
        let browser = Command::new("sh")
            .args(["-c", "exec \"$0\" \"$@\" 3<\"$TO\" 4>\"$FROM\"", browser])
            .args(flags(&folder.path().join("profile")))
            .args(["--remote-debugging-pipe", "about:blank"])
            .envs([("TO", &to), ("FROM", &from)])
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let to = File::options().write(true).open(&to).unwrap();
        let from = BufReader::new(File::open(&from).unwrap());
        let mut tab = Self { browser, to, from, session: None, last: 0, _folder: folder };
        let made = tab.ask("Target.createTarget", json!({"url": "about:blank"}));
        let target = json!({"targetId": made["targetId"], "flatten": true});
        let attached = tab.ask("Target.attachToTarget", target);
        tab.session = attached["sessionId"].as_str().map(str::to_owned);
        let screen =
            json!({"width": width, "height": height, "deviceScaleFactor": 1, "mobile": touch});
        tab.ask("Emulation.setDeviceMetricsOverride", screen);
        tab.ask("Emulation.setTouchEmulationEnabled", json!({"enabled": touch}));
        tab.ask("Page.enable", json!({}));
        tab.ask("Page.navigate", json!({"url": format!("file://{}", file.display())}));
        while tab.value("document.readyState") != "complete" {}
        tab.settle();
        tab
    }

    /// Sends a command and waits for its answer; events in between are passed over.
    pub(crate) fn ask(&mut self, method: &str, parameters: Value) -> Value {
        self.last += 1;
        let mut message = json!({"id": self.last, "method": method, "params": parameters});
        if let Some(session) = &self.session {
            message["sessionId"] = json!(session);
        }
        self.to.write_all(format!("{message}\0").as_bytes()).unwrap();
        loop {
            let mut answer = Vec::new();
            self.from.read_until(0, &mut answer).unwrap();
            let answer: Value = serde_json::from_slice(answer.strip_suffix(&[0]).unwrap()).unwrap();
            if answer["id"] == self.last {
                assert!(answer.get("error").is_none(), "{method}: {answer}");
                return answer["result"].clone();
            }
        }
    }

    /// What an expression is in the page.
    pub(crate) fn value(&mut self, expression: &str) -> Value {
        let asked = json!({"expression": expression, "returnByValue": true, "awaitPromise": true});
        let found = self.ask("Runtime.evaluate", asked);
        assert!(found.get("exceptionDetails").is_none(), "{expression}: {found}");
        found["result"]["value"].clone()
    }

    /// Waits until what was wished for is drawn.
    pub(crate) fn settle(&mut self) {
        let frame =
            "new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)))";
        self.value(&format!("{frame}.then(() => 0)"));
    }
}

impl Drop for Tab {
    fn drop(&mut self) {
        // It may be gone already.
        let _ = self.browser.kill();
        let _ = self.browser.wait();
    }
}
