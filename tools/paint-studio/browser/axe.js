// The script runs axe-core on a page: as it opens, with all that it can show, and in a dark and narrow window.
//
//   node axe.js PAGE.html FOLDER AXE.js
"use strict";
const fs = require("node:fs");
const { check, drive } = require("./drive.js");

drive("axe finds nothing", { width: 1000, height: 700 }, async ({ browser, value, quiet }, axe) => {
  const run = async (what) => {
    await quiet();
    const found = await value("axe.run(document).then(({ violations }) => violations.map(({ id, nodes }) => id + ': ' + nodes.map(({ html }) => html.slice(0, 120)).join(' ')))");
    check(`${what}: ${found.join("; ")}`, found.length === 0);
  };
  await value(fs.readFileSync(axe, "utf8") + "; 0");
  await run("as it opens");
  await value("document.querySelectorAll('details').forEach((one) => { one.open = true; })");
  await value("studio.keep(); studio.compare('start'); studio.surface.setKind('color'); studio.commit({ face: [60, 120, 110] }); studio.pictures.addBoard(); studio.pictures.show()");
  await run("with all panels");
  await browser.send("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value: "dark" }] });
  await browser.send("Emulation.setDeviceMetricsOverride", { width: 390, height: 844, deviceScaleFactor: 1, mobile: false });
  await run("dark and narrow");
  // The control: a button without a name is found.
  await value("document.body.append(document.createElement('button'))");
  check("a button without a name is found", (await value("axe.run(document).then(({ violations }) => violations.map(({ id }) => id))")).includes("button-name"));
});
