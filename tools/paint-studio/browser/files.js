// Brings paints into a page and out of it: opens paint XML, makes a gradient, and saves XML and CxF. Writes the files that
// the page saves, and the commands that it shows.
//
//   node files.js PAGE.html FOLDER PAINTS.xml
"use strict";
const fs = require("node:fs");
const path = require("node:path");
const { check, drive } = require("./drive.js");

drive("paints come and go", { width: 1000, height: 1000 }, async ({ browser, folder, value, status, choose, give }, paints) => {
  const open = (file) => give("#open-files", [file]);

  // Paint XML: all of its paints come, and a file of another kind is refused.
  const count = (fs.readFileSync(paints, "utf8").match(/<paint /g) ?? []).length;
  await open(paints);
  await browser.until("studio.history.now.own !== undefined");
  check("all paints of the file are in the palette", (await value("studio.palette.length")) === count);
  fs.writeFileSync(path.join(folder, "opened.json"), await value("JSON.stringify(studio.palette.map((state) => studio.engine.ask({ do: 'write', paint: state.paint, as: 'xml' }).text))"));
  check("the list tells where the paint is from", (await value("document.getElementById('library').selectedOptions[0].textContent")).includes(path.basename(paints)));
  fs.writeFileSync(path.join(folder, "other.xml"), "<html/>");
  await open(path.join(folder, "other.xml"));
  await browser.until("document.getElementById('status').textContent.includes('other.xml')", 10);

  // A gradient, one of its paints and an edit of it; the session brings it back.
  await choose("library", "candy_red");
  await value("studio.commit({ travel: 48 })");
  await choose("compare", "silver_fine");
  await browser.click("#gradient");
  check("the gradient is told: " + (await status()), (await status()).startsWith("3 paints between candy_red copy and silver_fine"));
  await browser.click(`#palette .kept:nth-child(${count + 2}) .tile`);
  check("its middle is the paint", (await value("studio.paint.name")) === "candy_red copy-silver_fine.2");
  await value(`(() => { const range = document.querySelector("#numbers input[aria-label=gloss][type=range]");
    range.value = 55; range.dispatchEvent(new Event("input")); range.dispatchEvent(new Event("change")); })()`);
  fs.writeFileSync(path.join(folder, "gradient-command.txt"), await value("document.getElementById('command').textContent"));
  const name = await value("fileName(studio.paint.name)");
  for (const [button, ending] of [["save-fitted", ".fitted.paints.xml"], ["save-cxf", ".cxf"]]) {
    await browser.click("#" + button);
    fs.writeFileSync(path.join(folder, "gradient" + ending), await browser.download(name + ending));
  }
  fs.writeFileSync(path.join(folder, "cxf-status.txt"), await status());
  const before = JSON.stringify(await value("studio.paint"));
  await browser.send("Page.reload");
  await new Promise((resolve) => setTimeout(resolve, 500));
  await browser.until("window.studio !== undefined && document.readyState === 'complete'");
  check("the session is kept", JSON.stringify(await value("studio.paint")) === before);
  // A link of another page names a paint.
  await value("location.hash = '#paint=silver_fine'");
  await browser.until("studio.paint.name === 'silver_fine' && location.hash === ''", 10);
  await value("location.hash = '#paint=no%20such'");
  await browser.until("document.getElementById('status').textContent.includes('no paint named no such')", 10);
});
