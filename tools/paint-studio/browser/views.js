// Looks at the traced views of a page: writes the radiance of some paints in each of them as raw floats,
// FOLDER/PAINT-VIEW.f32, and drives what the page offers on them. Prints how long a picture takes.
//
//   node views.js PAGE.html FOLDER PAINT...
"use strict";
const fs = require("node:fs");
const path = require("node:path");
const { check, drive } = require("./drive.js");

drive("the views were looked at", { width: 1000, height: 1000 }, async ({ browser, folder, value, status, shot, quiet, choose, fill, give }, ...paints) => {
  const views = await value("studio.data.views.map((one) => one.name)"), named = (name) => `(() => { const app = studio;
    return app.library.paint([...Array(app.library.count).keys()].find((i) => app.library.paint(i).name === ${JSON.stringify(name)})); })()`;
  const base64 = (expression) => value(`(() => { const bytes = new Uint8Array((${expression}).buffer); let text = "";
    for (let i = 0; i < bytes.length; i += 32768) text += String.fromCharCode(...bytes.subarray(i, i + 32768));
    return btoa(text); })()`);
  for (const paint of paints)
    for (let i = 0; i < views.length; ++i)
      fs.writeFileSync(path.join(folder, `${paint}-${views[i]}.f32`), Buffer.from(await base64(`studio.traced.picture(${i}, ${named(paint)}).values`), "base64"));

  // A view is chosen beside the lights; its camera and its light stay.
  const said = () => value("document.getElementById('traced-text').textContent"), canvas = () => value("document.getElementById('stage').toDataURL()");
  const drawn = async () => { await value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"); await quiet(); };
  await choose("library", paints[0]);
  await choose("environment", views[0]);
  await drawn();
  await shot("view-1");
  check("the page says that it was traced: " + (await said()), (await said()).startsWith("This view was traced: shadows, the floor and the light"));
  check("what moves the light is off", await value("['turn', 'lamp', 'reset-view'].every((id) => document.getElementById(id).disabled)"));
  check("what moves the camera is off", await value("[...document.querySelectorAll('#drag-kinds .around')].every((one) => one.disabled)"));
  check("the canvas has the points of the view", await value("(() => { const c = document.getElementById('stage'), v = studio.data.views[0]; return c.width === v.width && c.height === v.height; })()"));
  const before = await canvas();
  await browser.drag("#stage", 120, 40);
  await drawn();
  check("dragging does not turn it", (await canvas()) === before && (await value("document.getElementById('drag-hint').textContent")).includes("stay as they are"));

  // The surface under the pointer, and the cross whose buttons change the color there.
  await value("(() => { const drag = document.querySelector('input[value=color]'); drag.checked = true; drag.dispatchEvent(new Event('change')); })()");
  const angle = await value(`(() => {
    for (let y = 0.45; y < 0.8; y += 0.02)
      for (let x = 0.5; x < 0.8; x += 0.02) {
        studio.surface.placeCross([x, y]);
        if (studio.surface.seen) return studio.surface.seen.angle;
      }
    return null;
  })()`);
  check("the angle under the cross is read: " + angle, angle !== null && angle > 0 && angle < 180);
  check("the color there is told", (await value("document.getElementById('under-text').textContent")).includes("mirror direction of the brightest light"));

  // An edit changes the picture, and exposure does.
  await value("studio.commit({ 'lightness-shift': 12 })");
  await drawn();
  const lighter = await canvas();
  check("an edit changes the picture", lighter !== before);
  await fill("exposure", 1);
  await value("document.getElementById('exposure').dispatchEvent(new Event('input'))");
  await drawn();
  check("exposure changes the picture", (await canvas()) !== lighter);
  await value("(() => { const range = document.getElementById('exposure'); range.value = 0; range.dispatchEvent(new Event('input')); })()");

  // Beside another paint: the left half is the design's, the right half the other's.
  await choose("compare", paints[1]);
  await drawn();
  await shot("view-2");
  const halves = await value(`(() => { const { width, height } = studio.data.views[0], mean = (values, other, from, to) => { let sum = 0;
      for (let y = 0; y < height; ++y) for (let x = from; x < to; ++x) sum += Math.abs(values[4 * (y * width + x)] - other[4 * (y * width + x)]);
      return sum; };
    const sides = studio.traced.sides, of = (i) => studio.traced.picture(0, sides[i].paint).values;
    return { left: sides[0].paint.name, right: sides[1].paint.name, apart: mean(of(0), of(1), 0, width) }; })()`);
  check("both paints are shown: " + JSON.stringify(halves), halves.left === `${paints[0]} copy` && halves.right === paints[1] && halves.apart > 0);
  await value("document.getElementById('overlay').click()");
  await drawn();
  await shot("view-3");
  await value("document.getElementById('overlay').click()");
  await choose("compare", "nothing");

  // Far from the paint that was traced, bounced light is doubtful; a brushed paint cannot be shown at all.
  const errors = [];
  for (const paint of paints) {
    await choose("library", paint);
    await drawn();
    errors.push(await value("studio.traced.answer.bounced_de00_p95"));
    check(`what is said of ${paint} is what the library found`, (await said()).includes("That is doubtful") === (await value("studio.traced.answer.trace_again")));
  }
  await value("studio.commit({ anisotropy: [0.05, 0.3] })");
  await drawn();
  check("a brushed paint is refused: " + (await status()), (await status()).includes("brushed otherwise"));
  await value("studio.turn('undo')");
  await drawn();
  check("what was said of it is taken back: " + (await status()), (await status()) === "");

  // The other views, and back to a light.
  for (const view of views.slice(1)) {
    await choose("environment", view);
    await drawn();
    await shot(`view-${view}`);
  }
  await choose("environment", await value("studio.data.environments[0].name"));
  await drawn();
  check("the camera moves again", await value("!document.getElementById('turn').disabled && document.getElementById('traced-text').hidden"));
  await shot("view-4");

  await choose("environment", views[0]);
  await drawn();
  // Small pictures wait while something moves, and come after that.
  check("small pictures wait", await value(`(async () => { const { tiles, stageView } = studio;
    stageView.full_ms = 100;
    tiles.again();
    stageView.drawNow(true);
    await new Promise((done) => setTimeout(done, 100));
    return tiles.waiting.length > 0 && tiles.timer === undefined; })()`));
  await value("studio.stageView.drawNow(false)");
  await browser.until("studio.tiles.waiting.length === 0", 20);

  // From an edit to its picture on a view.
  const times = await value(`(async () => { const app = studio, all = [], shows = [];
    app.tiles.stop();
    for (let i = 0; i < 10; ++i) {
      const begin = performance.now(), { paint } = app.edited({ "hue-shift": 3 * i + 1 });
      app.weights.paint = paint;
      app.traced.draw(0, app.weights, 0, null, false);
      await app.stage.drawn();
      all.push(performance.now() - begin);
      shows.push(app.traced.full_ms);
    }
    const middle = (list) => list.sort((a, b) => a - b)[list.length >> 1];
    return { edit_to_picture_ms: middle(all), shading_ms: middle(shows), memory_mb: app.engine.bytes() / 1e6 }; })()`);
  // They are of their mesh alone.
  await give("#open-files", [path.join(process.env.TESTDATA, "box.obj")]);
  await browser.until("studio.stage.mesh.parts.length === 4");
  check("another mesh has no traced views", await value("studio.stageView.traced === null && document.querySelector('#environment optgroup') === null"));
  console.log(JSON.stringify({ ...times, bounced_de00_p95: errors }));
});
