// The script opens a page in Firefox by WebDriver BiDi, edits its paint, and compares the radiance with that of Chromium, which
// pictures.js wrote. Firefox draws WebGL on a display alone.
//
//   xvfb-run -a node --experimental-websocket firefox.js PAGE.html PAINT PAINT-ENVIRONMENT.f32 WIDTHxHEIGHT
"use strict";
const { spawn } = require("node:child_process");
const fs = require("node:fs");
const os = require("node:os");
const path = require("node:path");
const { pathToFileURL } = require("node:url");

async function main() {
  const [page, paint, known, size] = process.argv.slice(2), [width, height] = size.split("x").map(Number), folder = fs.mkdtempSync(path.join(os.tmpdir(), "paint-studio-"));
  fs.writeFileSync(path.join(folder, "user.js"), ["webgl.force-enabled", "remote.active-protocols"].map((name) => `user_pref("${name}", ${name.startsWith("webgl") ? true : 1});\n`).join(""));
  const firefox = spawn("firefox", ["--no-remote", "--profile", folder, "--remote-debugging-port", "0"], { stdio: ["ignore", "ignore", "pipe"] });
  try {
    const address = await new Promise((resolve, reject) => {
      let told = "";
      firefox.stderr.on("data", (text) => {
        const found = /BiDi listening on (ws:\S+)/.exec((told += text));
        if (found) resolve(found[1]);
      });
      firefox.on("exit", () => reject(new Error("Firefox ended: " + told)));
    });
    const socket = new WebSocket(address + "/session"), waiting = new Map();
    await new Promise((resolve) => { socket.onopen = resolve; });
    socket.onmessage = ({ data }) => {
      const message = JSON.parse(data);
      waiting.get(message.id)?.(message);
    };
    const send = (method, params = {}) => new Promise((resolve) => {
      waiting.set(waiting.size + 1, resolve);
      socket.send(JSON.stringify({ id: waiting.size, method, params }));
    });
    await send("session.new", { capabilities: {} });
    const { context } = (await send("browsingContext.getTree")).result.contexts[0];
    const value = async (expression) => (await send("script.evaluate", { expression, target: { context }, awaitPromise: true })).result?.result?.value;
    const until = async (expression) => {
      for (const end = Date.now() + 60000; Date.now() < end; await new Promise((resolve) => setTimeout(resolve, 100))) if ((await value(expression)) === true) return;
      throw new Error(`still not: ${expression}; ${await value("document.getElementById('status').textContent")}`);
    };
    await send("browsingContext.navigate", { context, url: pathToFileURL(path.resolve(page)).href, wait: "complete" });
    await until("typeof studio === 'object'");
    await value("studio.commit({ gloss: 40 })");
    await until("studio.history.now.steps.length === 1 && studio.stageView.times.sharp_ms > 0");
    const text = await value(`(() => {
      while (studio.stage.occlusion.step());
      studio.stage.occlusion.columns = 0;
      studio.engine.ask({ do: "fit", paint: studio.library.paint([...Array(studio.library.count).keys()].find((i) => studio.library.paint(i).name === "${paint}")) });
      const bytes = new Uint8Array(studio.stage.radiance(cameraOf(studio.data.mesh.view), ${width}, ${height}, studio.stage.weights(studio.engine), 0).buffer);
      let text = "";
      for (let i = 0; i < bytes.length; i += 32768) text += String.fromCharCode(...bytes.subarray(i, i + 32768));
      return btoa(text); })()`);
    const floats = (bytes) => new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length)), ours = floats(Buffer.from(text, "base64")), theirs = floats(fs.readFileSync(known));
    const off = theirs.map((one, i) => Math.abs(one - ours[i]) / (Math.abs(one) + 0.01)).sort();
    console.log(`Firefox differs from Chromium by ${off[Math.floor(0.95 * off.length)]} in 95 of 100 values`);
    await send("browser.close");
    // Graphics may weigh texels by eight bits.
    process.exitCode = theirs.length === ours.length && off[Math.floor(0.95 * off.length)] < 1 / 256 ? 0 : 1;
  } finally {
    firefox.kill();
    await new Promise((resolve) => setTimeout(resolve, 1000));
    fs.rmSync(folder, { recursive: true, force: true, maxRetries: 5 });
  }
  process.exit();
}

main().catch((error) => {
  console.error(error.stack);
  process.exit(1);
});
