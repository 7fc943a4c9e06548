// The script edits flakes by their sliders, takes them back and takes them away, and saves the paint and the commands.
//
//   node flakes.js PAGE.html FOLDER
"use strict";
const fs = require("node:fs");
const path = require("node:path");
const { check, drive } = require("./drive.js");

drive("flakes are edited", { width: 1000, height: 700 }, async ({ browser, folder, value, shot, quiet, choose, fill, checkNames }) => {
  const field = (name) => value(`document.querySelector('#numbers input[type=number][aria-label="${name}"]').value`), seen = async () => [await field("flake size"), await field("coverage")].join();
  const slide = (name, to) => value(`(() => { const range = document.querySelector('#numbers input[type=range][aria-label="${name}"]'); range.value = ${to};
    for (const kind of ["input", "change"]) range.dispatchEvent(new Event(kind)); })()`);
  const flakes = async () => JSON.stringify(await value("studio.paint.flakes ?? null")), text = () => value("studio.controls.flakesText.textContent");
  const takeAway = "#numbers [aria-label=Flakes] button", fixed = () => value(`document.querySelector("${takeAway}").disabled`);
  await choose("library", "stated");
  check(`stated flakes are shown: ${await seen()}`, (await seen()) === "40,0.2" && (await text()).includes("states") && !(await fixed()));
  await choose("library", "signal_white");
  check(`a solid has none: ${await seen()}`, (await seen()) === "," && (await text()).includes("no flakes") && (await fixed()));
  await choose("library", "silver_fine");
  check(`those of a class are told as assumed: ${await seen()}`, (await seen()) === "30,0.5" && (await text()).includes("assumed") && (await text()).includes("metallic") && (await fixed()));
  const before = JSON.stringify(await value("studio.paint"));
  await slide("flake size", 62);
  check("the slider states them", (await flakes()) === "[62,0.5,0.5]" && (await value("studio.history.now.steps.length")) === 1 && !(await fixed()));
  await browser.click("#undo");
  check("one step takes them back", JSON.stringify(await value("studio.paint")) === before && (await seen()) === "30,0.5");
  await choose("library", "stated");
  await slide("coverage", 0.31);
  check("the spread stays", (await flakes()) === "[40,0.31,0.7]");
  await browser.click(takeAway);
  check("they are taken away", (await flakes()) === "null" && (await text()).includes("assumed"));
  await browser.click("#undo");
  await quiet();
  await value("document.querySelector('#numbers [aria-label=Flakes]').scrollIntoView({ block: 'center' })");
  await shot("flakes");
  // The code that the paint had is emptied, and stays so in a session.
  const code = () => value("[studio.paint.code ?? '', document.getElementById('paint-code').value].join()");
  await fill("paint-code", "''");
  check(`a code is taken away: ${await code()}`, (await code()) === ",");
  await value("studio.turn('undo')");
  check(`undo brings it back: ${await code()}`, (await code()) === "K1,K1");
  await value("(() => { studio.turn('redo'); studio.openSession(studio.savedSession()); studio.show(); })()");
  check(`a session has none either: ${await code()}`, (await code()) === ",");
  await fill("paint-code", "'K2'");
  await fill("paint-code", "''");
  fs.writeFileSync(path.join(folder, "flakes-command.txt"), await value("document.getElementById('command').textContent"));
  await browser.click("#save-xml");
  fs.writeFileSync(path.join(folder, "flakes-saved.xml"), await browser.download("stated_copy.paints.xml"));
  await checkNames();
});
