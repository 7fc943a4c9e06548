// The page of paint-studio --empty: its car is seen in its light in every paint, and a paint, a car and a light of one's own are
// opened on it.
//
//   empty.js PAGE.html FOLDER
"use strict";
const fs = require("node:fs");
const path = require("node:path");
const { check, drive } = require("./drive.js");

drive("the empty page is whole", { width: 1000, height: 700 }, async ({ browser, folder, value, shot, quiet, give, checkNames }) => {
  await quiet();
  await shot("empty");
  check("its parts are told by their names", JSON.stringify(await value("studio.stage.mesh.parts.map(({ name, row }) => [name, row])").then((parts) => [...new Set(parts.map((part) => part.join(" ")))])) === JSON.stringify(["Body 0", "Glass 2", "Roof 0", "Tires 3", "Rims 4"]));
  const paints = await value("studio.library.count"), means = [];
  for (let i = 0; i < paints; ++i) {
    await value(`studio.start(${i})`);
    const mean = await value("(() => { const values = studio.stage.radiance(studio.stageView.camera, 64, 36, studio.weights, 0); return values.reduce((sum, x) => sum + x, 0) / values.length; })()");
    means.push(mean);
    check(`a paint is seen: ${mean}`, mean > 0.01 && mean < 100);
    check("its lobes meet it", (await value("studio.fit.de00_mean")) < 1);
  }
  check("paints differ", new Set(means.map((mean) => mean.toFixed(5))).size === paints);
  const tires = await value(`(() => {
    const { parts } = studio, all = parts.list.filter(({ name }) => name === "Tires");
    parts.wear(all[1], -1);
    studio.openSession(studio.savedSession());
    const rows = all.map(({ row }) => row).join();
    parts.wear(all[1], all[1].told);
    return rows; })()`);
  check(`of parts of one name each keeps its own: ${tires}`, tires === "3,-1,3,3");
  // The commands name a file that the page saves.
  await value("studio.commit({ gloss: 30 })");
  await browser.click("#save-xml");
  const name = `${await value("fileName(studio.paint.name)")}.paints.xml`;
  fs.writeFileSync(path.join(folder, name), await browser.download(name));
  fs.writeFileSync(path.join(folder, "empty-command.txt"), await value("document.getElementById('command').textContent"));
  fs.writeFileSync(path.join(folder, "own.csv"), "sample,geometry,illuminant,observer,L,a,b\nown,45as15,D65,10,60,20,10\nown,45as45,D65,10,40,15,8\nown,45as110,D65,10,30,12,6\n");
  fs.writeFileSync(path.join(folder, "own.obj"), "o Body\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  const pixels = Buffer.concat(Array.from({ length: 32 * 16 }, (_, i) => Buffer.from([i % 250, 120, 90, i % 32 === 4 ? 132 : 128])));
  fs.writeFileSync(path.join(folder, "own.hdr"), Buffer.concat([Buffer.from("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16 +X 32\n"), pixels]));
  await give("#open-files", ["own.csv", "own.obj", "own.hdr"].map((name) => path.join(folder, name)));
  await browser.until("studio.data.environments.length === 2");
  check("they came together", (await value("studio.paint.name")) === "own" && (await value("studio.stage.mesh.parts.length")) === 1);
  await checkNames();
});
