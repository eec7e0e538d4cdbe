//! A headless browser for pages, driven over a pair of pipes with the
//! Chrome DevTools Protocol (<https://chromedevtools.github.io/devtools-protocol/>).

use std::io::{BufRead as _, BufReader, Write as _};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use base64::Engine as _;
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::{Tool, tool};

/// Longest time that a browser may take to answer.
const PATIENCE: Duration = Duration::from_secs(60);

const OPTIONS: &str = "--headless --remote-debugging-pipe --no-sandbox --disable-gpu --disable-dev-shm-usage \
    --no-first-run --disable-background-networking --disable-component-update --disable-sync --hide-scrollbars \
    --force-device-scale-factor=1";

/// Printable width and height of A4 with the margins of a page, px: 186 by 271 mm.
pub const A4_PX: [f64; 2] = [186.0 / 25.4 * 96.0, 271.0 / 25.4 * 96.0];

/// A running browser with one page.
pub struct Browser {
    child: Child,
    commands: ChildStdin,
    messages: Receiver<Value>,
    events: Vec<Value>,
    session: Option<String>,
    last: u64,
    /// The profile of the browser, removed with it.
    _profile: TempDir,
}

impl Browser {
    /// Starts a browser with a window of a size, px; `None` where there is none ([`tool`]).
    #[track_caller]
    pub fn start(size: [u32; 2]) -> Option<Self> {
        let program = tool(Tool::Chromium)?;
        let profile = tempfile::tempdir().unwrap();
        // The browser reads commands from descriptor 3 and answers on descriptor 4.
        let mut child = Command::new("sh")
            .args(["-c", "exec \"$0\" \"$@\" 3<&0 4>&1 1>/dev/null 2>/dev/null"])
            .arg(program)
            .args(OPTIONS.split_whitespace())
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .arg(format!("--window-size={},{}", size[0], size[1]))
            .arg("about:blank")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let (sender, messages) = channel();
        let answers = BufReader::new(child.stdout.take().unwrap());
        std::thread::spawn(move || {
            let messages = answers.split(0).map_while(Result::ok);
            let mut parsed = messages.filter_map(|message| serde_json::from_slice(&message).ok());
            parsed.try_for_each(|message| sender.send(message))
        });
        let mut browser = Self {
            commands: child.stdin.take().unwrap(),
            child,
            messages,
            events: Vec::new(),
            session: None,
            last: 0,
            _profile: profile,
        };
        browser.attach(size);
        Some(browser)
    }

    fn attach(&mut self, size: [u32; 2]) {
        let target = self.call("Target.createTarget", json!({ "url": "about:blank" }));
        let target = json!({ "targetId": target["targetId"], "flatten": true });
        let attached = self.call("Target.attachToTarget", target);
        self.session = attached["sessionId"].as_str().map(str::to_owned);
        for domain in ["Page", "Runtime", "Log", "Network"] {
            self.call(&format!("{domain}.enable"), json!({}));
        }
        self.resize(size);
    }

    /// Sends a command and waits for its result.
    pub fn call(&mut self, method: &str, parameters: Value) -> Value {
        self.last += 1;
        let id = self.last;
        let mut message = json!({ "id": id, "method": method, "params": parameters });
        if let Some(session) = &self.session {
            message["sessionId"] = json!(session);
        }
        write!(self.commands, "{message}\0").unwrap();
        self.commands.flush().unwrap();
        loop {
            let message = self.next(method);
            if message["id"] == id {
                assert!(message["error"].is_null(), "{method}: {}", message["error"]);
                return message["result"].clone();
            }
            self.events.push(message);
        }
    }

    fn next(&self, waiting_for: &str) -> Value {
        let message = self.messages.recv_timeout(PATIENCE);
        message.unwrap_or_else(|_| panic!("the browser does not answer: {waiting_for}"))
    }

    /// Waits for an event.
    fn wait_for(&mut self, event: &str) {
        while !self.events.iter().any(|one| one["method"] == event) {
            let message = self.next(event);
            self.events.push(message);
        }
    }

    /// Sets the size of the window, px.
    pub fn resize(&mut self, [width, height]: [u32; 2]) {
        self.call(
            "Emulation.setDeviceMetricsOverride",
            json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false }),
        );
    }

    /// Chooses the dark theme or the light one.
    pub fn set_dark(&mut self, dark: bool) {
        let value = if dark { "dark" } else { "light" };
        let scheme = json!({ "features": [{ "name": "prefers-color-scheme", "value": value }] });
        self.call("Emulation.setEmulatedMedia", scheme);
    }

    /// Opens a file and waits until it is loaded and has been painted.
    pub fn open(&mut self, file: &Path) {
        self.events.clear();
        let path = file.canonicalize().unwrap();
        let url = format!("file://{}", path.display());
        self.call("Page.navigate", json!({ "url": url }));
        self.wait_for("Page.loadEventFired");
        self.evaluate(
            "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(0))))",
        );
    }

    /// Value of a JavaScript expression; a promise is awaited.
    pub fn evaluate(&mut self, expression: &str) -> Value {
        let asked =
            json!({ "expression": expression, "returnByValue": true, "awaitPromise": true });
        let result = self.call("Runtime.evaluate", asked);
        let thrown = &result["exceptionDetails"];
        assert!(thrown.is_null(), "{expression}: {thrown}");
        result["result"]["value"].clone()
    }

    /// The same as a number.
    pub fn number(&mut self, expression: &str) -> f64 {
        self.evaluate(expression).as_f64().unwrap_or(f64::NAN)
    }

    /// Errors and warnings of the console and exceptions since the page was opened.
    pub fn console_errors(&mut self) -> Vec<String> {
        self.drain();
        let of = |event: &Value| {
            let parameters = &event["params"];
            match event["method"].as_str()? {
                "Runtime.exceptionThrown" => Some(parameters["exceptionDetails"].to_string()),
                "Runtime.consoleAPICalled" => Some(parameters["args"].to_string()),
                "Log.entryAdded" => Some(parameters["entry"]["text"].to_string()),
                _ => None,
            }
        };
        self.events.iter().filter_map(of).collect()
    }

    /// Addresses that the page asked for, itself and those within it (`data:`) aside.
    pub fn requests(&mut self) -> Vec<String> {
        self.drain();
        let sent = self.events.iter();
        let sent = sent.filter(|event| event["method"] == "Network.requestWillBeSent");
        let urls = sent.filter_map(|event| event["params"]["request"]["url"].as_str());
        let page = |url: &&str| url.starts_with("file://") && url.ends_with(".html");
        urls.filter(|url| !page(url) && !url.starts_with("data:"))
            .map(str::to_owned)
            .collect()
    }

    fn drain(&mut self) {
        // Whatever came before this answer has arrived with it.
        self.evaluate("0");
        self.events.extend(self.messages.try_iter());
    }

    /// Time from the start of the navigation to the first paint with content, s.
    pub fn first_paint_s(&mut self) -> f64 {
        let expression = "new Promise((done) => {
            const found = () => performance.getEntriesByName('first-contentful-paint')[0];
            const look = () => found() ? done(found().startTime) : setTimeout(look, 20);
            look();
        })";
        self.number(expression) / 1000.0
    }

    /// Drags the mouse from one point of the window to another.
    pub fn drag(&mut self, from: [f64; 2], to: [f64; 2]) {
        let middle = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])];
        for (kind, [x, y], buttons) in [
            ("mouseMoved", from, 0),
            ("mousePressed", from, 1),
            ("mouseMoved", middle, 1),
            ("mouseMoved", to, 1),
            ("mouseReleased", to, 0),
        ] {
            self.call(
                "Input.dispatchMouseEvent",
                json!({ "type": kind, "x": x, "y": y, "button": "left", "buttons": buttons, "clickCount": 1 }),
            );
        }
    }

    /// A picture of the window as PNG.
    pub fn screenshot(&mut self) -> Vec<u8> {
        let picture = self.call("Page.captureScreenshot", json!({ "format": "png" }));
        decoded(&picture["data"])
    }

    /// The page as PDF on A4, margins as the page says.
    pub fn pdf(&mut self) -> Vec<u8> {
        let print = json!({ "preferCSSPageSize": true, "printBackground": true });
        let pdf = self.call("Page.printToPDF", print);
        decoded(&pdf["data"])
    }
}

fn decoded(data: &Value) -> Vec<u8> {
    let decoder = base64::engine::general_purpose::STANDARD;
    decoder.decode(data.as_str().unwrap()).unwrap()
}

impl Drop for Browser {
    fn drop(&mut self) {
        let close = json!({ "id": 0, "method": "Browser.close" });
        let _ = write!(self.commands, "{close}\0");
        let start = Instant::now();
        while start.elapsed() < Duration::from_secs(5) {
            if matches!(self.child.try_wait(), Ok(Some(_))) {
                return;
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
