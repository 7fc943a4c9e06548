// Drives what a page offers on its picture, by mouse, finger and keyboard: the border between two paints, the turn of the
// light, the lamp by its highlight, the rings, the reading under the pointer, the cross with its buttons, and travel and
// gloss by dragging. Writes a few screenshots.
//
//   node surface.js PAGE.html FOLDER
"use strict";
const { check, drive } = require("./drive.js");

drive("the picture answers", { width: 1400, height: 720 }, async ({ browser, value, shot, quiet, choose, fill, checkNames }) => {
  const kind = (name) => browser.click(`#drag-kinds input[value=${name}]`);
  // A place of the window where the mesh is painted and the light is seen at about this angle.
  const place = (degrees) => value(`(() => {
    const box = studio.stageView.canvas.getBoundingClientRect();
    let best = null;
    for (let y = 0.3; y < 0.75; y += 0.01)
      for (let x = 0.15; x < 0.85; x += 0.01) {
        const at = { x: box.left + x * box.width, y: box.top + y * box.height }, seen = studio.stageView.pointAt(at.x, at.y);
        if (seen && seen.lit && (!best || Math.abs(seen.angle - ${degrees}) < Math.abs(best.angle - ${degrees}))) best = { ...at, angle: seen.angle };
      }
    return best;
  })()`);
  const angleAt = (at) => value(`studio.stageView.pointAt(${at.x}, ${at.y})?.angle`);
  await choose("library", "candy_red");
  await quiet();
  // A slider that comes back to its place leaves a whole picture of the design.
  for (const range of ["#exposure", "#numbers input[type=range][aria-label=travel]"]) {
    const one = `document.querySelector(${JSON.stringify(range)})`, number = () => value(`${one}.valueAsNumber`), before = await number();
    const from = await value(`(() => { const one = ${one}; one.scrollIntoView({ block: "center" });
      const box = one.getBoundingClientRect(); return { x: box.left + 8 + ((one.value - one.min) / (one.max - one.min)) * (box.width - 16), y: box.top + box.height / 2 }; })()`);
    await browser.mouse("mousePressed", from.x, from.y);
    for (const by of [-10, -20]) await browser.mouse("mouseMoved", from.x + by, from.y);
    check(`${range} moves`, (await number()) !== before);
    for (const by of [0, 1, -1, 2, -2, 3, -3]) if ((await number()) !== before) await browser.mouse("mouseMoved", from.x + by, from.y);
    await browser.mouse("mouseReleased", from.x, from.y);
    check(`${range} is back`, (await number()) === before);
    await browser.until("!studio.wanted && studio.stageView.lastFrame === undefined && studio.stageView.sharp && studio.stage.canvas.width === studio.stageView.size(1)[0]");
    check(`${range} leaves the design`, await value("JSON.stringify(studio.paint) === JSON.stringify(studio.history.now.paint) && studio.history.at === 1"));
  }
  await value("document.getElementById('stage').scrollIntoView()");

  // The lamp goes to where its highlight is dragged, by mouse and finger; keys and numbers move it too.
  await kind("lamp");
  check("the lamp is lit", await value("studio.stageView.lamp.on"));
  const first = await place(60), second = await place(20), middle = await browser.middle("#stage");
  await browser.mouseDrag(middle, first);
  check("the highlight is where the mouse let it go", (await angleAt(first)) < 1.5);
  await browser.touchDrag(first, second);
  check("the highlight is where the finger let it go", (await angleAt(second)) < 1.5);
  const azimuth = await value("studio.stageView.lamp.azimuth");
  await value("studio.stageView.canvas.focus()");
  await browser.key("ArrowRight");
  check("an arrow key moves the lamp by two degrees", Math.abs((((await value("studio.stageView.lamp.azimuth")) - azimuth - 2 + 540) % 360) - 180) < 1e-6);
  await fill("lamp-elevation", 50);
  check("the elevation is what the field says", (await value("studio.stageView.lamp.elevation")) === 50);
  await quiet();
  await shot("surface-1-lamp");

  // Rings lie where their angles are. A ring is 1.6 times the change of the angle along both axes wide to each side, which
  // is up to 2.3 pixels, and angles are read from a buffer whose pixels lie up to half a pixel beside: within 2.8 pixels of
  // every point of a ring lies its angle.
  await browser.click("#overlay");
  await quiet();
  await value("(() => { studio.stageView.full_ms = 1; studio.stageView.drawNow(false); })()");
  const rings = await value(`(() => {
    const { stage, canvas } = studio.stageView, gl = stage.gl, pixels = new Uint8Array(4 * canvas.width * canvas.height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    const box = canvas.getBoundingClientRect(), found = { near: [0, 0], middle: [0, 0] };
    for (let y = 0; y < canvas.height; ++y)
      for (let x = 0; x < canvas.width; ++x) {
        const at = 4 * ((canvas.height - 1 - y) * canvas.width + x), [r, g, b] = pixels.subarray(at, at + 3);
        const name = r > 235 && g > 195 && g < 230 && b < 60 ? "near" : r < 80 && g > 215 && b > 235 ? "middle" : null;
        if (!name) continue;
        const around = [[0, 0], [2.8, 0], [-2.8, 0], [0, 2.8], [0, -2.8], [2, 2], [-2, 2], [2, -2], [-2, -2]].map(([dx, dy]) => studio.stageView.pointAt(
          box.left + ((x + 0.5 + dx) / canvas.width) * box.width, box.top + ((y + 0.5 + dy) / canvas.height) * box.height)?.angle).filter(Number.isFinite);
        const wanted = name === "near" ? 15 : 45;
        ++found[name][0];
        if (Math.min(...around) <= wanted + 0.5 && Math.max(...around) >= wanted - 0.5) ++found[name][1];
      }
    return found;
  })()`);
  console.log("rings: " + JSON.stringify(rings));
  for (const [name, [drawn, right]] of Object.entries(rings)) check(`the ring ${name} is drawn where it belongs`, drawn > 20 && right > 0.9 * drawn);
  await shot("surface-2-rings");

  // The light turns with the pointer, the keyboard and by number.
  await kind("light");
  await browser.mouseDrag(middle, { x: middle.x + 100, y: middle.y });
  check("100 pixels turn the light by 40 degrees", (await value("studio.stage.turn")) === 40);
  await value("studio.stageView.canvas.focus()");
  await browser.key("ArrowLeft");
  check("an arrow key turns it by five", (await value("studio.stage.turn")) === 35);
  await fill("turn", 0);

  // Travel and gloss end where they are dragged to.
  await kind("travel");
  const ended = await place(63);
  await browser.mouseDrag(middle, ended);
  check("the travel is the angle where it was dragged to", Math.abs((await value("studio.description.appearance.travel")) - ended.angle) < 0.06);
  check("dragging the travel is one step", (await value("studio.history.now.steps.length")) === 1);
  await value("studio.stageView.canvas.focus()");
  await browser.key("ArrowUp");
  check("an arrow key lengthens it by one degree", Math.abs((await value("studio.description.appearance.travel")) - ended.angle - 1) < 0.06);
  await kind("gloss");
  const edge = await place(8);
  await browser.mouseDrag(middle, edge);
  const gloss = await value("studio.paint.gloss[0][1]");
  check("the gloss falls where the highlight is wide", gloss > 0 && gloss < 60);
  await value("studio.stageView.canvas.focus()");
  await browser.key("ArrowUp");
  check("an arrow key adds a gloss unit", Math.abs((await value("studio.paint.gloss[0][1]")) - gloss - 1) < 1e-6);

  // The cross: every button moves the color there by what it says.
  await kind("color");
  const at = await place(35);
  await browser.mouseDrag(middle, at);
  const seen = () => value("studio.surface.seenColor"), angle = await value("studio.surface.seen.angle");
  check("the cross reads the angle where it stands", Math.abs(angle - at.angle) < 1.5);
  check("the text tells the angle and the color", /^\d+\.\d° from the mirror direction of the lamp: L\* /.test(await value("studio.surface.text.textContent")));
  await shot("surface-3-cross");
  for (const [name, member, by] of [["lighter", (s) => s.lab[0], 3], ["darker", (s) => s.lab[0], -3], ["more chroma", (s) => s.chroma, 3],
                                    ["less chroma", (s) => s.chroma, -3], ["hue +", (s) => s.hue, 3], ["hue -", (s) => s.hue, -3]]) {
    const before = member(await seen());
    await browser.click(`#tweaks button[data-kind="${name}"]`);
    const moved = member(await seen()) - before;
    console.log(`${name}: ${moved.toFixed(3)}`);
    // The angle is written to a tenth of a degree, over which the color changes by less than this.
    check(`"${name}" moves the color there by ${by}, not ${moved}`, Math.abs(((moved - by + 540) % 360) - 180) < 0.1);
  }
  await value("studio.stageView.canvas.focus()");
  await browser.key("ArrowLeft", 8);
  check("arrow keys move the cross", (await value("studio.surface.seen?.angle")) !== angle);

  // The border between two paints.
  await choose("compare", "began with", true);
  check("there are two paints", await value("studio.stageView.weights.left !== undefined && !document.getElementById('border').hidden"));
  const border = await browser.middle("#border"), box = await value("(() => { const b = studio.stageView.canvas.getBoundingClientRect(); return { left: b.left, width: b.width }; })()");
  await browser.touchDrag(border, { x: box.left + 0.25 * box.width, y: border.y });
  check("a finger drags the border", Math.abs((await value("studio.stageView.border")) - 0.25) < 0.01);
  await value("document.getElementById('border').focus()");
  await browser.key("End");
  await browser.key("ArrowLeft", 8);
  check("keys move it too", Math.abs((await value("studio.stageView.border")) - 0.9) < 1e-6);
  // Left of the border is the design alone, right of it the other paint alone.
  const sides = await value(`(() => {
    const { stageView, stage } = studio, camera = stageView.camera, size = [160, 90], sum = (from, to, values) => {
      let total = 0;
      for (let y = 0; y < 90; ++y) for (let x = from; x < to; ++x) total += Math.abs(values[4 * (160 * y + x)]);
      return total;
    };
    const picture = (weights) => stage.radiance(camera, ...size, weights, stageView.environment);
    const both = picture({ left: studio.weights, right: studio.compared.weights, at: 0.5 });
    const own = picture(studio.weights), other = picture(studio.compared.weights), apart = (a, b) => a.map((value, i) => value - b[i]);
    return [sum(0, 80, apart(both, own)), sum(80, 160, apart(both, other)), sum(0, 160, apart(own, other))];
  })()`);
  check("each side shows its paint: " + sides, sides[0] === 0 && sides[1] === 0 && sides[2] > 1);
  // The two paints from gathered light; a step of a channel is what rounding may change.
  const gathered = await value(`(() => {
    const { stageView, stage } = studio, gl = stage.gl, view = [stageView.camera, 320, 180, stageView.weights, stageView.environment];
    const pixels = () => {
      const bytes = new Uint8Array(4 * 320 * 180);
      gl.bindFramebuffer(gl.FRAMEBUFFER, null);
      gl.readPixels(0, 0, 320, 180, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
      return bytes;
    };
    studio.tiles.stop();
    stageView.rest(null);
    stage.draw("centers", ...view, stageView.stops);
    const direct = pixels(), before = stage.drawGathered("centers", ...view, stageView.stops);
    while (stage.gather("centers", ...view));
    const drawn = stage.drawGathered("centers", ...view, stageView.stops), ours = pixels();
    const elsewhere = stage.drawGathered("centers", { ...stageView.camera, fov: 20 }, ...view.slice(1), stageView.stops);
    stageView.redraw();
    studio.tiles.go();
    return { before, drawn, elsewhere, kept: stage.gathered.held !== null, most: ours.reduce((most, value, i) => Math.max(most, Math.abs(value - direct[i])), 0) };
  })()`);
  check("gathered light shows both paints: " + JSON.stringify(gathered), !gathered.before && gathered.drawn && gathered.most <= 1);
  check("it is dropped where the view is another one", !gathered.elsewhere && !gathered.kept);
  await quiet();
  await shot("surface-4-two");
  await checkNames();
});
