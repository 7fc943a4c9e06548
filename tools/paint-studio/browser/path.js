// A designer's path through a page, by mouse and keyboard: open, pick a variation, drag the face, set travel and gloss,
// drag a reading, go back and on, compare with the nearest paints, keep, save. Prints the commands that the page shows,
// and writes the files that it saves and a few screenshots.
//
//   node path.js PAGE.html FOLDER
"use strict";
const fs = require("node:fs");
const path = require("node:path");
const { check, drive } = require("./drive.js");

drive("the path was walked", { width: 1000, height: 1000 }, async ({ browser, folder, value, shot, quiet, checkNames }) => {
  const paint = async () => JSON.stringify(await value("studio.paint"));
  await quiet();
  await shot("1-open");

  // A red whose face and flop are far apart.
  await value(`(() => { const list = document.getElementById("library");
    list.value = [...list.options].find((one) => one.textContent === "candy_red").value;
    list.dispatchEvent(new Event("change")); })()`);
  await quiet();
  const first = await paint();
  await browser.click("#variations .tile:nth-child(2)");
  check("a variation changes the paint", (await paint()) !== first);
  await browser.drag("#wheel .handle", 25, -15);
  check("dragging the face is one step", (await value("studio.history.now.steps.length")) === 2);
  check("the face is stated", (await value("'face' in studio.history.now.steps[1]")));
  await value("document.querySelector('#numbers input[aria-label=travel][type=number]').focus()");
  await value(`(() => { const field = document.activeElement; field.value = 52; field.dispatchEvent(new Event("change")); })()`);
  check("the travel is what the field says", Math.abs((await value("studio.description.appearance.travel")) - 52) < 1e-9);
  await value(`(() => { const range = document.querySelector("#numbers input[aria-label=gloss][type=range]");
    range.value = 70; range.dispatchEvent(new Event("input")); range.dispatchEvent(new Event("change")); })()`);
  check("the gloss is what the slider says", (await value("studio.paint.gloss[0][1]")) === 70);
  await quiet();
  await shot("2-edited");

  const edited = await paint(), steps = await value("studio.history.now.steps.length");
  const handle = "#curves g .handle";
  if (await value(`document.querySelector(${JSON.stringify(handle)}) !== null`)) {
    await value(`document.querySelector(${JSON.stringify(handle)}).focus()`);
    await browser.key("ArrowUp");
    check("a reading moves by the keyboard", (await value("studio.history.now.steps.length")) === steps + 1);
    await browser.key("z", 2);
    check("Ctrl+Z takes it back", (await paint()) === edited);
    await browser.click("#redo");
    check("redo makes it again", (await paint()) !== edited);
    await browser.click("#undo");
  }
  check("undo leads back", (await paint()) === edited);
  await browser.click("#keep");
  check("the palette has the paint", (await value("document.querySelectorAll('#palette .tile').length")) === 1);
  check("five paints are near", (await value("document.querySelectorAll('#nearest .tile').length")) === 5);
  await browser.drag("#stage", 120, 40);
  await value("(() => { const light = document.getElementById('environment'); light.selectedIndex = light.length - 1; light.dispatchEvent(new Event('change')); })()");
  await quiet();
  await shot("3-turned");

  fs.writeFileSync(path.join(folder, "command.txt"), await value("document.getElementById('command').textContent"));
  const name = await value("fileName(studio.paint.name)");
  for (const [button, ending] of [["save-xml", ".paints.xml"], ["save-fitted", ".fitted.paints.xml"], ["save-csv", ".csv"],
                                  ["save-session", ".session.json"]]) {
    await browser.click("#" + button);
    fs.writeFileSync(path.join(folder, "saved" + ending), await browser.download(name + ending));
  }
  // The session comes back by itself when the page is opened again.
  await browser.send("Page.reload");
  await new Promise((resolve) => setTimeout(resolve, 500));
  await browser.until("window.studio !== undefined && document.readyState === 'complete'");
  check("the session is kept", (await paint()) === edited);
  await browser.click("#nearest .tile");
  check("a near paint starts anew", (await value("studio.history.now.steps.length")) === 0);
  // Narrow and dark.
  await browser.send("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value: "dark" }] });
  await browser.send("Emulation.setDeviceMetricsOverride", { width: 360, height: 740, deviceScaleFactor: 1, mobile: false });
  await quiet();
  await shot("4-narrow");
  check("nothing is wider than the window", (await value("document.documentElement.scrollWidth")) <= 360);
  await checkNames();
});
