// Gives a page a picture and takes face, flop and gloss from it, by mouse, finger and keyboard. Writes the picture, the
// paint-pick command that the page shows, and what the page took, as taken.json.
//
//   node droppers.js PAGE.html FOLDER
"use strict";
const fs = require("node:fs");
const path = require("node:path");
const { check, drive } = require("./drive.js");
const { png } = require("./png.js");

drive("the droppers take what they are on", { width: 1700, height: 1000 }, async ({ browser, folder, value, shot, quiet, give }) => {
  const picture = path.join(path.resolve(folder), "two colors.png");
  // Light orange on the left, dark blue on the right, with a texture, and a highlight below.
  fs.writeFileSync(picture, png(320, 200, (x, y) => {
    const grain = (x * 7 + y * 13) % 23;
    if (y > 150) return x > 140 && x < 180 ? [250, 248, 240] : [60 + grain, 58, 50];
    return x < 160 ? [210 + grain, 140 + (y >> 3), 60] : [30, 40 + grain, 90 + (y >> 3)];
  }));
  await quiet();
  await give("#open-files", [picture]);
  await browser.until("studio.pictures.current !== null && studio.pictures.place.querySelector('canvas')?.clientWidth > 0");
  await value("document.getElementById('picture-panel').scrollIntoView()");
  const at = (x, y) => value(`(() => { const { canvas } = studio.pictures.current, box = canvas.getBoundingClientRect();
    return { x: box.left + ((${x} + 0.5) / canvas.width) * box.width, y: box.top + ((${y} + 0.5) / canvas.height) * box.height }; })()`);
  const kind = (name) => browser.click(`input[name=dropper][value=${name}]`);
  await browser.mouseDrag(await at(60, 100), await at(80, 70));
  check("the dropper of the face lies where the mouse let it go", JSON.stringify(await value("studio.pictures.droppers.face.at")) === "[80,70]");
  await kind("flop");
  await browser.touchDrag(await at(200, 100), await at(240, 60));
  check("that of the flop where the finger let it go", JSON.stringify(await value("studio.pictures.droppers.flop.at")) === "[240,60]");
  await value("studio.pictures.current.canvas.focus()");
  await browser.key("ArrowDown", 8);
  await browser.key("ArrowLeft");
  check("arrow keys move it", JSON.stringify(await value("studio.pictures.droppers.flop.at")) === "[239,70]");
  await kind("gloss");
  await value("document.getElementById('dropper-radius').value = 12");
  await browser.mouseDrag(await at(100, 180), await at(142, 178));
  const appearance = await value("studio.description.appearance"), command = await value("document.getElementById('pick-command').textContent");
  const taken = { face: appearance.face, flop: appearance.flop, gloss: await value("studio.paint.gloss[0][1]") };
  fs.writeFileSync(path.join(folder, "taken.json"), JSON.stringify(taken));
  fs.writeFileSync(path.join(folder, "pick-command.txt"), command);
  check("the paint has the droppers' colors", appearance.face[0] > appearance.flop[0]);
  await shot("droppers");
  // A flop that is lighter trades places with the face, unless that is to be kept.
  await kind("flop");
  await value("studio.pictures.current.canvas.focus()");
  for (let i = 0; i < 12; ++i) await browser.key("ArrowLeft", 8);
  check("face and flop trade places", (await value("studio.description.appearance.face[0] >= studio.description.appearance.flop[0]")));
  await browser.click("#retro");
  await value("studio.pictures.current.canvas.focus()");
  await browser.key("ArrowDown");
  const retro = await value("studio.description.appearance"), before = retro.face[0];
  await browser.click("#swap");
  check("the button trades them", Math.abs((await value("studio.description.appearance.flop[0]")) - before) < 0.01);
  // Zooming, and a file that is no picture.
  await value("(() => { const zoom = document.getElementById('zoom'); zoom.value = 2; zoom.dispatchEvent(new Event('input')); })()");
  check("the picture is shown four times as wide", (await value("studio.pictures.current.canvas.clientWidth")) === 1280);
  await kind("move");
  const from = await browser.middle("#picture");
  await browser.mouseDrag(from, { x: from.x - 80, y: from.y });
  check("the picture moves below the mouse", (await value("studio.pictures.place.scrollLeft")) === 80);
  const wrong = path.join(path.resolve(folder), "wrong.png");
  fs.writeFileSync(wrong, "no picture");
  await give("#open-files", [wrong]);
  await browser.until("document.getElementById('status').textContent.includes('wrong.png is no picture')", 10);
  check("nothing was added", (await value("studio.pictures.all.length")) === 1);

  // A second picture stands beside the first, and droppers on both make one paint; another board has its own.
  const second = path.join(path.resolve(folder), "third color.png");
  fs.writeFileSync(second, png(200, 120, (x, y) => [40, 120 + (x >> 3), 90 + (y >> 3)]));
  await give("#open-files", [second]);
  await browser.until("studio.pictures.all.length === 2");
  await value("studio.pictures.zoomTo(1)");
  await value("document.getElementById('picture-panel').scrollIntoView()");
  check("both pictures are in sight", (await value("[...document.querySelectorAll('#picture canvas')].map((one) => one.clientWidth).join()")) === "320,200");
  await kind("flop");
  await browser.mouseDrag(await at(20, 100), await at(50, 60));
  check("a dropper lies on the second picture", (await value("studio.pictures.droppers.flop.picture === studio.pictures.all[1] && studio.pictures.droppers.face.picture === studio.pictures.all[0]")));
  check("both pictures are in the command", /--face '?two.*--flop '?third/.test(await value("document.getElementById('pick-command').textContent")));
  check("each picture has its marks", (await value("[...document.querySelectorAll('.sheet')].map((one) => one.querySelectorAll('.dropper').length).join()")) === "2,1");
  await shot("droppers-2");
  // The session brings boards, pictures and droppers back. The control is a session without pictures.
  const shown = () => value(`JSON.stringify([studio.pictures.all.map(({ name, canvas }) => [name, canvas.toDataURL()]), studio.pictures.boards.map(({ name, zoom }) => [name, zoom]),
    Object.entries(studio.pictures.droppers).map(([kind, { picture, ...found }]) => [kind, studio.pictures.all.indexOf(picture), found])])`);
  const kept = await shown();
  await value("(() => { window.savedSession = studio.savedSession(); studio.openSession(studio.savedSession(false)); })()");
  await browser.until("studio.pictures.coming === 0");
  check("a session without pictures leaves none", (await value("studio.pictures.all.length")) === 0);
  await value("studio.openSession(window.savedSession)");
  await browser.until("Object.keys(studio.pictures.droppers).length === 3");
  check("the session has the boards with their pictures and droppers", (await shown()) === kept);
  const pictures = "JSON.parse(studio.kept()[0].session).pictures?.boards[0].pictures.length";
  check("the browser keeps them", (await value(pictures)) === 2);
  check("it keeps them while they come", (await value(`(() => { studio.openSession(window.savedSession); studio.show(); return ${pictures}; })()`)) === 2);
  await browser.until("Object.keys(studio.pictures.droppers).length === 3");
  await browser.click("#new-board");
  check("the new board is empty", (await value("document.querySelectorAll('#picture canvas').length")) === 0);
  await give("#open-files", [second]);
  await browser.until("studio.pictures.all.length === 3");
  await value("document.querySelector('#picture-tabs [aria-selected=true]').focus()");
  await browser.key("ArrowLeft");
  check("arrow keys change the board", (await value("document.querySelector('#picture-tabs [aria-selected=true]').textContent")) === "Board 1 (2)");
  await browser.click("#remove-picture");
  await browser.click("#remove-picture");
  check("an empty board goes", (await value("studio.pictures.boards.map((board) => board.name).join()")) === "Board 2");
});
