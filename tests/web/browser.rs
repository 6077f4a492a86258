//! A browser with the page, driven by WebDriver.

use std::net::TcpListener;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use serde_json::{Value, json};

/// Longest time that anything in the page may take, on a slow machine without a graphics card.
const PATIENCE: Duration = Duration::from_secs(60);

/// Headless Chromium with the page, and the servers of both.
pub struct Browser {
    servers: Vec<Child>,
    agent: ureq::Agent,
    session: String,
    page: String,
}

impl Drop for Browser {
    fn drop(&mut self) {
        let _ = self.agent.delete(&self.session).call();
        for server in &mut self.servers {
            let _ = server.kill();
            let _ = server.wait();
        }
    }
}

impl Browser {
    /// Opens the page with what follows its address, such as `#tour=1`, and waits for the first
    /// frame. Downloads go to a folder.
    pub fn open(link: &str, downloads: &Path) -> Self {
        let folder =
            std::env::var("IK_ARM_PAGE").expect("IK_ARM_PAGE names the folder of the page");
        let [page_port, driver_port] = [free_port(), free_port()].map(|port| port.to_string());
        let page = Command::new("python3")
            .args(["-m", "http.server", "--bind", "127.0.0.1", "--directory", &folder, &page_port])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("python3 serves the page");
        let driver = Command::new("chromedriver")
            .arg(format!("--port={driver_port}"))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("chromedriver starts");
        let agent = ureq::Agent::config_builder().http_status_as_error(false).build().into();
        let mut browser = Self {
            servers: vec![page, driver],
            agent,
            session: format!("http://127.0.0.1:{driver_port}/session"),
            page: format!("http://127.0.0.1:{page_port}/"),
        };
        let capabilities = json!({ "capabilities": { "alwaysMatch": {
            "browserName": "chrome",
            "goog:chromeOptions": {
                "args": [
                    "--headless=new", "--no-sandbox", "--enable-unsafe-webgpu",
                    "--use-webgpu-adapter=swiftshader", "--enable-features=Vulkan",
                    "--use-vulkan=swiftshader", "--use-angle=swiftshader",
                    "--window-size=1280,900",
                ],
                "prefs": { "download.default_directory": downloads },
            },
        } } });
        let id = browser.eventually("chromedriver begins a session", |browser| {
            let answer = browser.try_post("", &capabilities)?;
            Some(answer["sessionId"].as_str()?.to_owned())
        });
        browser.session = format!("{}/{id}", browser.session);
        browser.go(link);
        browser
    }

    /// Goes to the page with what follows its address, and waits for the first frame.
    pub fn go(&mut self, link: &str) {
        // A link alone would not load the page again.
        self.post("/url", &json!({ "url": "about:blank" }));
        self.post("/url", &json!({ "url": format!("{}{link}", self.page) }));
        let ready = self.eventually("the first frame", |browser| {
            assert_eq!(browser.failure(), "", "{link}");
            let ready = browser.run("return document.body.dataset.ready ?? null");
            ready.as_str().map(str::to_owned)
        });
        println!("{link}: first frame after {ready} ms");
    }

    /// Runs a script in the page, and returns what it returns.
    pub fn run(&self, script: &str) -> Value {
        self.post("/execute/sync", &json!({ "script": script, "args": [] }))
    }

    /// The pose of the shown limb, by the page's own message.
    pub fn pose(&self) -> Value {
        let script = "const done = arguments[arguments.length - 1];
            addEventListener('message', event => {
                if (event.data && 'ik_arm' in event.data) done(event.data.ik_arm);
            });
            postMessage({ read: true });";
        self.post("/execute/async", &json!({ "script": script, "args": [] }))
    }

    /// The hand in Root space.
    pub fn hand(&self) -> [f64; 3] {
        serde_json::from_value(self.pose()["hand"].clone()).expect("a hand")
    }

    /// Presses the mouse at one place and releases it at another.
    pub fn drag(&self, from: [i32; 2], to: [i32; 2]) {
        self.point("mouse", from, to);
    }

    /// Puts a finger on one place and lifts it at another.
    pub fn drag_with_finger(&self, from: [i32; 2], to: [i32; 2]) {
        self.point("touch", from, to);
    }

    /// Puts two fingers on places beside `middle` and spreads them to twice their distance.
    pub fn spread_fingers(&self, middle: [i32; 2]) {
        let finger = |id: &str, side: i32| {
            let at = |distance| [middle[0] + side * distance, middle[1]];
            let mut steps =
                vec![move_to(at(40), 100), json!({ "type": "pointerDown", "button": 0 })];
            steps.extend((1..=8).map(|step| move_to(at(40 + 5 * step), 60)));
            steps.push(json!({ "type": "pointerUp", "button": 0 }));
            let parameters = json!({ "pointerType": "touch" });
            json!({ "type": "pointer", "id": id, "parameters": parameters, "actions": steps })
        };
        self.act_with(&[finger("thumb", -1), finger("index finger", 1)]);
    }

    fn point(&self, pointer: &str, from: [i32; 2], to: [i32; 2]) {
        let mut steps = vec![move_to(from, 200), json!({ "type": "pointerDown", "button": 0 })];
        for step in 1..=8 {
            let at = [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * step / 8);
            steps.push(move_to(at, 60));
        }
        steps.push(json!({ "type": "pause", "duration": 300 }));
        steps.push(json!({ "type": "pointerUp", "button": 0 }));
        let parameters = json!({ "pointerType": pointer });
        let source =
            json!({ "type": "pointer", "id": pointer, "parameters": parameters, "actions": steps });
        self.act(&source);
    }

    /// Clicks, which gives the keyboard to the page.
    pub fn click(&self, at: [i32; 2]) {
        self.drag(at, at);
    }

    /// Presses a key while Ctrl is held.
    pub fn press_with_ctrl(&self, key: &str) {
        const CTRL: &str = "\u{e009}";
        let down = |key: &str| json!({ "type": "keyDown", "value": key });
        let up = |key: &str| json!({ "type": "keyUp", "value": key });
        let steps = [down(CTRL), down(key), up(key), up(CTRL)];
        self.act(&json!({ "type": "key", "id": "keyboard", "actions": steps }));
    }

    /// Types a text and presses Enter.
    pub fn enter(&self, text: &str) {
        const ENTER: char = '\u{e007}';
        let key = |key: char| {
            [json!({ "type": "keyDown", "value": key }), json!({ "type": "keyUp", "value": key })]
        };
        let steps: Vec<Value> = text.chars().chain([ENTER]).flat_map(key).collect();
        self.act(&json!({ "type": "key", "id": "keyboard", "actions": steps }));
    }

    /// Waits until a file is downloaded with this name.
    pub fn downloaded(&self, path: &Path) -> Vec<u8> {
        self.eventually("the download", |_| std::fs::read(path).ok())
    }

    /// Chooses a file in the browser's file dialog, which Ctrl+O opens.
    pub fn choose_file(&self, path: &Path) {
        const ELEMENT: &str = "element-6066-11e4-a52e-4f735466cecf";
        // Without a screen, the dialog would cancel itself.
        let catch = json!({
            "cmd": "Page.setInterceptFileChooserDialog", "params": { "enabled": true },
        });
        self.post("/goog/cdp/execute", &catch);
        self.press_with_ctrl("o");
        let input = json!({ "using": "css selector", "value": "input[type=file]" });
        let input = self.eventually("the dialog", |browser| {
            let found = browser.try_post("/element", &input)?;
            Some(found[ELEMENT].as_str()?.to_owned())
        });
        self.post(&format!("/element/{input}/value"), &json!({ "text": path }));
    }

    /// Drops a file on the page.
    pub fn drop_file(&self, name: &str, bytes: &[u8]) {
        let script = "const bytes = Uint8Array.from(atob(arguments[1]), it => it.charCodeAt(0));
            const files = new DataTransfer();
            files.items.add(new File([bytes], arguments[0]));
            document.dispatchEvent(new DragEvent('drop', { dataTransfer: files }));";
        let bytes = BASE64_STANDARD.encode(bytes);
        self.post("/execute/sync", &json!({ "script": script, "args": [name, bytes] }));
    }

    /// Waits until `look` finds something.
    pub fn eventually<T>(&self, what: &str, mut look: impl FnMut(&Self) -> Option<T>) -> T {
        let started = Instant::now();
        loop {
            if let Some(found) = look(self) {
                return found;
            }
            if started.elapsed() > PATIENCE {
                let picture = std::env::temp_dir().join("ik-arm-page.png");
                let _ = std::fs::write(&picture, self.screenshot());
                panic!("{what} does not come; see {}", picture.display());
            }
            std::thread::sleep(Duration::from_millis(100));
        }
    }

    /// What the browser shows, as PNG.
    pub fn screenshot(&self) -> Vec<u8> {
        let answer = self.agent.get(format!("{}/screenshot", self.session)).call();
        let answer: Option<Value> = answer.ok().and_then(|mut it| it.body_mut().read_json().ok());
        let text = answer.as_ref().and_then(|answer| answer["value"].as_str());
        BASE64_STANDARD.decode(text.unwrap_or_default()).unwrap_or_default()
    }

    /// The page's own words for a failure; empty if there is none.
    pub fn failure(&self) -> String {
        let failure = self.run("return document.body.dataset.failure ?? ''");
        failure.as_str().unwrap_or_default().to_owned()
    }

    fn act(&self, source: &Value) {
        self.act_with(std::slice::from_ref(source));
    }

    fn act_with(&self, sources: &[Value]) {
        self.post("/actions", &json!({ "actions": sources }));
        std::thread::sleep(Duration::from_millis(300));
    }

    fn post(&self, path: &str, body: &Value) -> Value {
        self.try_post(path, body).unwrap_or_else(|| panic!("{path} with {body}"))
    }

    /// The value of the answer; `None` for an error.
    fn try_post(&self, path: &str, body: &Value) -> Option<Value> {
        let sent = self.agent.post(format!("{}{path}", self.session)).send_json(body);
        let answer: Value = sent.ok()?.body_mut().read_json().ok()?;
        let value = answer.get("value")?.clone();
        value.get("error").is_none().then_some(value)
    }
}

fn move_to([x, y]: [i32; 2], milliseconds: u32) -> Value {
    json!({ "type": "pointerMove", "x": x, "y": y, "duration": milliseconds })
}

fn free_port() -> u16 {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    listener.local_addr().expect("an address").port()
}
