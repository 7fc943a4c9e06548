// A designer's path through a page, by mouse and keyboard: open, pick a variation, drag the face, set the travel on the
// surface and the gloss, drop a picture and take its color, drag a reading, go back and on, compare with the nearest paint,
// keep, save. Writes the commands that the page shows, the files that it saves, the radiance that it shows at the end as
// path.f32 (see pictures.js), and a few screenshots.
//
//   node path.js PAGE.html FOLDER
"use strict";
const fs = require("node:fs");
const path = require("node:path");
const { check, drive } = require("./drive.js");
const { png } = require("./png.js");

drive("the path was walked", { width: 1000, height: 1000 }, async ({ browser, folder, value, shot, quiet, choose, checkNames }) => {
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
  // The travel ends on the surface where the mouse lets it go.
  await browser.click("#drag-kinds input[value=travel]");
  await value("document.getElementById('stage').scrollIntoView({ block: 'center' })");
  const ended = await value(`(() => {
    const box = studio.stageView.canvas.getBoundingClientRect();
    let best = null;
    for (let y = 0.3; y < 0.75; y += 0.01)
      for (let x = 0.15; x < 0.85; x += 0.01) {
        const at = { x: box.left + x * box.width, y: box.top + y * box.height }, seen = studio.stageView.pointAt(at.x, at.y);
        if (seen && seen.lit && (!best || Math.abs(seen.angle - 52) < Math.abs(best.angle - 52))) best = { ...at, angle: seen.angle };
      }
    return best;
  })()`);
  await browser.mouseDrag(await browser.middle("#stage"), ended);
  check("the travel ends where it was dragged to on the surface", Math.abs((await value("studio.description.appearance.travel")) - ended.angle) < 0.06);
  await browser.click("#drag-kinds input[value=view]");
  await value(`(() => { const range = document.querySelector("#numbers input[aria-label=gloss][type=range]");
    range.value = 70; range.dispatchEvent(new Event("input")); range.dispatchEvent(new Event("change")); })()`);
  check("the gloss is what the slider says", (await value("studio.paint.gloss[0][1]")) === 70);
  await quiet();
  await shot("2-edited");
  // A picture is dropped on the page, and the dropper of the face takes the color in its middle.
  const picture = path.join(path.resolve(folder), "dropped.png");
  fs.writeFileSync(picture, png(200, 120, (x, y) => [150 + (x >> 3), 60 + (y >> 3), 35]));
  const over = await browser.middle("#controls h2"), data = { items: [], files: [picture], dragOperationsMask: 1 };
  for (const type of ["dragEnter", "dragOver", "drop"]) await browser.send("Input.dispatchDragEvent", { type, ...over, data });
  await browser.until("studio.pictures.current !== null && studio.pictures.place.querySelector('canvas')?.clientWidth > 0", 20);
  await browser.click("input[name=dropper][value=face]");
  await browser.drag("#picture canvas", 10, 5);
  const lab = await value(`studio.engine.ask({ do: "describe", paint: studio.paint }).appearance.face`);
  check("the face has the color of the picture: " + lab, lab[1] > 15 && lab[2] > 15 && lab[0] > 25 && lab[0] < 60);
  await value("document.getElementById('picture-panel').scrollIntoView()");
  await quiet();
  await shot("3-picture");

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
  const near = await value("document.querySelector('#nearest .tile span').textContent");
  await choose("compare", near);
  check("the nearest paint is beside the design", (await value("studio.compared.name")) === near && (await value("!document.getElementById('border').hidden")));
  await value("document.getElementById('stage').scrollIntoView()");
  await quiet();
  await shot("4-compared");
  await choose("compare", "nothing");
  const shown = await value(`(() => {
    studio.tiles.stop();
    studio.stage.occlusion.columns = 0;  // the engine gl throws no shadows
    const values = studio.stage.radiance(cameraOf(studio.data.mesh.view), 640, 360, studio.weights, 0), bytes = new Uint8Array(values.buffer);
    let text = "";
    for (let i = 0; i < bytes.length; i += 32768) text += String.fromCharCode(...bytes.subarray(i, i + 32768));
    studio.tiles.go();
    return btoa(text);
  })()`);
  fs.writeFileSync(path.join(folder, "path.f32"), Buffer.from(shown, "base64"));
  await browser.drag("#stage", 120, 40);
  await value("(() => { const light = document.getElementById('environment'); light.selectedIndex = light.length - 1; light.dispatchEvent(new Event('change')); })()");
  await quiet();
  await shot("5-turned");

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
  const nearest = await value("document.querySelector('#nearest .tile span').textContent");
  await browser.click("#nearest .tile");
  check("a near paint is on the car by one click", (await value("studio.compared.name")) === nearest && (await value("!document.getElementById('border').hidden")));
  check("its way is in the wheel", (await value("document.getElementById('match-way').getAttribute('points')")).split(" ").length > 5);
  const cars = async (count) => {
    await choose("car-count", count);
    await browser.until("document.querySelectorAll('#cars span').length > 1");
    await quiet();
    return value(`(() => { studio.stageView.drawCars(false); const { gl } = studio.stage, { width, height } = studio.stage.canvas, pixels = new Uint8Array(4 * width * height);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      const { columns, rows } = studio.stageView.grid, mean = (column, row) => { let sum = 0; for (let y = row * height / rows | 0; y < ((row + 1) * height / rows | 0); y += 3) for (let x = column * width / columns | 0; x < ((column + 1) * width / columns | 0); x += 3) sum += pixels[4 * (y * width + x)] - pixels[4 * (y * width + x) + 2]; return sum; };
      return { names: [...document.querySelectorAll("#cars span")].map((one) => one.textContent), sums: [...Array(columns * rows).keys()].map((i) => mean(i % columns, Math.floor(i / columns))) }; })()`);
  };
  const two = await cars("two cars");
  await shot("7-two-cars");
  check(`two cars wear two paints: ${JSON.stringify(two)}`, two.names[1] === nearest && Math.abs(two.sums[0] - two.sums[1]) > 1e-3 * Math.abs(two.sums[0]));
  const four = await cars("four cars");
  await shot("7-four-cars");
  check(`four cars wear four paints: ${JSON.stringify(four)}`, new Set(four.names).size === 4 && new Set(four.sums).size === 4);
  await choose("car-count", "one car with a border");
  await choose("compare", "nothing");
  await browser.click("#nearest .corner");
  check("a near paint starts anew", (await value("studio.history.now.steps.length")) === 0);
  // Narrow and dark.
  await browser.send("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value: "dark" }] });
  await browser.send("Emulation.setDeviceMetricsOverride", { width: 360, height: 740, deviceScaleFactor: 1, mobile: false });
  await quiet();
  await shot("6-narrow");
  check("nothing is wider than the window", (await value("document.documentElement.scrollWidth")) <= 360);
  await checkNames();
});
