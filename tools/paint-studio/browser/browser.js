// Drives a headless Chromium through its debugging pipe, so that tests need nothing but Node and the browser.
"use strict";
const { spawn } = require("node:child_process");
const fs = require("node:fs");
const os = require("node:os");
const path = require("node:path");

// The browser's program, or null where there is none.
function chromium() {
  const names = process.env.CHROMIUM ? [process.env.CHROMIUM] : ["/usr/bin/chromium", "/usr/bin/chromium-browser"];
  return names.find((name) => fs.existsSync(name)) ?? null;
}

class Browser {
  static async open(url, { width = 1400, height = 1000, dark = false } = {}) {
    const browser = new Browser();
    browser.folder = fs.mkdtempSync(path.join(os.tmpdir(), "paint-studio-"));
    browser.problems = [];
    browser.process = spawn(chromium(), [
      "--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic",
      "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
      "--disable-dev-shm-usage", "--force-color-profile=srgb", `--user-data-dir=${browser.folder}`,
      "--remote-debugging-pipe", "about:blank"], { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
    browser.waiting = new Map();
    browser.number = 0;
    let rest = "";
    browser.process.stdio[4].on("data", (bytes) => {
      const messages = (rest + bytes.toString("utf8")).split("\0");
      rest = messages.pop();
      for (const message of messages) browser.take(JSON.parse(message));
    });
    const { targetInfos } = await browser.send("Target.getTargets", {}, null);
    const target = targetInfos.find((info) => info.type === "page");
    await browser.attach(target.targetId);
    await browser.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: false });
    await browser.send("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value: dark ? "dark" : "light" }] });
    await browser.send("Browser.setDownloadBehavior", { behavior: "allow", downloadPath: browser.folder }, null);
    const loaded = new Promise((resolve) => { browser.loaded = resolve; });
    await browser.send("Page.navigate", { url });
    await loaded;
    return browser;
  }

  async attach(targetId) {
    ({ sessionId: this.session } = await this.send("Target.attachToTarget", { targetId, flatten: true }, null));
    for (const domain of ["Page", "Runtime", "Log"]) await this.send(domain + ".enable");
  }
  // A tab of the same browser that `make` opens, to be driven as this one is.
  async tab(make) {
    const pages = async () => (await this.send("Target.getTargets", {}, null)).targetInfos.filter(({ type }) => type === "page").map(({ targetId }) => targetId);
    const before = await pages(), other = Object.assign(Object.create(Browser.prototype), this);
    other.send = (method, params = {}, session = other.session) => this.send(method, params, session);
    await make();
    for (let made; !made;) if ((made = (await pages()).find((one) => !before.includes(one)))) await other.attach(made);
    return other;
  }

  send(method, params = {}, session = this.session) {
    const id = ++this.number;
    this.process.stdio[3].write(JSON.stringify({ id, method, params, ...(session ? { sessionId: session } : {}) }) + "\0");
    return new Promise((resolve, reject) => this.waiting.set(id, { resolve, reject, method }));
  }

  take(message) {
    if (message.id) {
      const { resolve, reject, method } = this.waiting.get(message.id);
      this.waiting.delete(message.id);
      if (message.error) reject(new Error(`${method}: ${message.error.message}`));
      else resolve(message.result);
    } else if (message.method === "Page.loadEventFired") {
      this.loaded();
    } else if (message.method === "Runtime.exceptionThrown") {
      const details = message.params.exceptionDetails;
      this.problems.push(details.exception?.description ?? details.text);
    } else if (message.method === "Log.entryAdded" && message.params.entry.level === "error") {
      this.problems.push(message.params.entry.text);
    } else if (message.method === "Runtime.consoleAPICalled" && ["error", "warning"].includes(message.params.type)) {
      this.problems.push(message.params.args.map((one) => one.value ?? one.description).join(" "));
    }
  }

  // The value of an expression in the page; promises are waited for.
  async evaluate(expression) {
    const { result, exceptionDetails } = await this.send("Runtime.evaluate",
                                                         { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }
  async until(expression, seconds = 180) {
    for (const end = Date.now() + 1000 * seconds; Date.now() < end;) {
      if (await this.evaluate(expression).catch(() => false)) return;  // a page that loads has no answer yet
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
    throw new Error(`after ${seconds} s still not: ${expression}; ${this.problems.join("; ")}`);
  }

  // The middle of an element in the window.
  middle(selector) {
    return this.evaluate(`(() => { const element = document.querySelector(${JSON.stringify(selector)});
      element.scrollIntoView({ block: "center" });
      const box = element.getBoundingClientRect();
      return { x: box.x + box.width / 2, y: box.y + box.height / 2 }; })()`);
  }
  mouse(type, x, y) {
    return this.send("Input.dispatchMouseEvent", { type, x, y, button: "left", buttons: 1, clickCount: 1 });
  }
  async click(selector) {
    const { x, y } = await this.middle(selector);
    await this.mouse("mousePressed", x, y);
    await this.mouse("mouseReleased", x, y);
  }
  async drag(selector, dx, dy, steps = 5) {
    const { x, y } = await this.middle(selector);
    await this.mouse("mousePressed", x, y);
    for (let i = 1; i <= steps; ++i) await this.mouse("mouseMoved", x + (dx * i) / steps, y + (dy * i) / steps);
    await this.mouse("mouseReleased", x + dx, y + dy);
  }
  // A drag by a finger.
  async touchDrag(from, to, steps = 5) {
    const touch = (type, points) => this.send("Input.dispatchTouchEvent", { type, touchPoints: points });
    await touch("touchStart", [from]);
    for (let i = 1; i <= steps; ++i)
      await touch("touchMove", [{ x: from.x + ((to.x - from.x) * i) / steps, y: from.y + ((to.y - from.y) * i) / steps }]);
    await touch("touchEnd", []);
  }
  async mouseDrag(from, to, steps = 5) {
    await this.mouse("mousePressed", from.x, from.y);
    for (let i = 1; i <= steps; ++i)
      await this.mouse("mouseMoved", from.x + ((to.x - from.x) * i) / steps, from.y + ((to.y - from.y) * i) / steps);
    await this.mouse("mouseReleased", to.x, to.y);
  }
  async key(key, modifiers = 0) {
    const code = { ArrowUp: 38, ArrowDown: 40, ArrowLeft: 37, ArrowRight: 39, z: 90, y: 89, Tab: 9, Enter: 13, Home: 36, End: 35 }[key];
    const text = key === "Enter" ? "\r" : undefined;
    for (const type of ["keyDown", "keyUp"])
      await this.send("Input.dispatchKeyEvent", { type, key, code: key, text, modifiers, windowsVirtualKeyCode: code });
  }
  async screenshot(file) {
    const { data } = await this.send("Page.captureScreenshot", { format: "png" });
    fs.writeFileSync(file, Buffer.from(data, "base64"));
  }
  // A file that the page saved.
  async download(name, seconds = 20) {
    const file = path.join(this.folder, name);
    for (const end = Date.now() + 1000 * seconds; Date.now() < end;) {
      if (fs.existsSync(file) && fs.statSync(file).size > 0) return fs.readFileSync(file, "utf8");
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
    throw new Error(`the page did not save ${name}: ${fs.readdirSync(this.folder)}`);
  }
  async close() {
    const ended = new Promise((resolve) => this.process.on("exit", resolve));
    await this.send("Browser.close", {}, null).catch(() => {});
    await Promise.race([ended, new Promise((resolve) => setTimeout(resolve, 5000))]);
    if (this.process.exitCode === null) this.process.kill("SIGKILL");
    fs.rmSync(this.folder, { recursive: true, force: true, maxRetries: 5 });
  }
}

module.exports = { Browser, chromium };
