// Writes the radiance that a page shows of some paints in each of its environments, as raw floats from the upper left
// corner: FOLDER/PAINT-ENVIRONMENT.f32, four channels a pixel. Prints how far the pictures from layers of gathered light are
// from these, and the time of an edit until its picture is there.
//
//   node pictures.js PAGE.html FOLDER WIDTHxHEIGHT PAINT...
"use strict";
const fs = require("node:fs");
const path = require("node:path");
const { pathToFileURL } = require("node:url");
const { Browser } = require("./browser.js");

async function main() {
  const [page, folder, size, ...paints] = process.argv.slice(2), [width, height] = size.split("x").map(Number);
  const browser = await Browser.open(pathToFileURL(path.resolve(page)).href);
  await browser.until("window.studio !== undefined || document.getElementById('status').textContent !== ''");
  const environments = await browser.evaluate("studio.data.environments.map((one) => one.name)");
  // The engine gl throws no shadows.
  await browser.evaluate("(() => { while (studio.stage.occlusion.step()); studio.stage.occlusion.columns = 0; })()");
  // How far a picture from layers is from one by the shading program: of the value of a channel, and a hundredth of white.
  await browser.evaluate(`window.apart = (ours, theirs, number) => {
    const least = 0.01 * studio.stage.environment(number).white;
    const all = ours.map((value, i) => Math.abs(value - theirs[i]) / (Math.abs(theirs[i]) + least)).sort();
    return { p95: all[Math.floor(0.95 * all.length)], most: all.at(-1) };
  }`);
  const layers = [];
  for (const paint of paints)
    for (let number = 0; number < environments.length; ++number) {
      const base64 = await browser.evaluate(`(() => {
        const app = studio, all = [...Array(app.library.count).keys()];
        const one = app.library.paint(all.find((i) => app.library.paint(i).name === ${JSON.stringify(paint)}));
        app.tiles.stop();
        app.engine.ask({ do: "fit", paint: one });
        const weights = app.stage.weights(app.engine);
        const values = app.stage.radiance(cameraOf(app.data.mesh.view), ${width}, ${height}, weights, ${number});
        window.gatheredApart = apart(app.stage.gatheredRadiance(cameraOf(app.data.mesh.view), ${width}, ${height}, weights, ${number}), values, ${number});
        const bytes = new Uint8Array(values.buffer);
        let text = "";
        for (let i = 0; i < bytes.length; i += 32768) text += String.fromCharCode(...bytes.subarray(i, i + 32768));
        return btoa(text);
      })()`);
      layers.push({ paint, environment: environments[number], ...(await browser.evaluate("gatheredApart")) });
      fs.writeFileSync(path.join(folder, `${paint}-${environments[number]}.f32`), Buffer.from(base64, "base64"));
    }
  // The first paint with the lamp of the page, in each environment turned by a right angle, without its ground, and without a shadow there.
  const variant = async (name, before, after) => {
    for (let number = 0; number < environments.length; ++number) {
      const base64 = await browser.evaluate(`(() => {
        const app = studio, all = [...Array(app.library.count).keys()];
        app.engine.ask({ do: "fit", paint: app.library.paint(all.find((i) => app.library.paint(i).name === ${JSON.stringify(paints[0])})) });
        const weights = app.stage.weights(app.engine);
        app.stageView.environment = ${number};
        ${before}
        const values = app.stage.radiance(cameraOf(app.data.mesh.view), ${width}, ${height}, weights, ${number});
        ${after}
        const bytes = new Uint8Array(values.buffer);
        let text = "";
        for (let i = 0; i < bytes.length; i += 32768) text += String.fromCharCode(...bytes.subarray(i, i + 32768));
        return btoa(text);
      })()`);
      fs.writeFileSync(path.join(folder, `${paints[0]}-${environments[number]}-${name}.f32`), Buffer.from(base64, "base64"));
    }
  };
  await variant("lamp", "app.stageView.setLamp({ on: true, azimuth: -25, elevation: 40, stops: -1 });", "app.stageView.setLamp({ on: false });");
  await variant("turned", "app.stageView.turnTo(90);", "app.stageView.turnTo(0);");
  await variant("groundless", "app.stage.ground = false;", "app.stage.ground = true;");
  await variant("shadeless", "window.shade = app.data.environments[app.stageView.environment].ground_light; delete app.data.environments[app.stageView.environment].ground_light;",
                "app.data.environments[app.stageView.environment].ground_light = window.shade;");
  await variant("unsent", "weights.meshColor = [0, 0, 0];", "");
  // With the shadow of the mesh on itself, and with the shadows that the page finds by itself.
  await browser.evaluate("studio.stage.occlusion.columns = vertexColumns");
  await variant("shaded", "", "");
  await browser.evaluate("studio.grounds = studio.data.environments.map((one) => one.ground_light)");
  await browser.evaluate("(() => { const { occlusion } = studio.stage; for (const one of studio.data.environments) delete one.ground_light; occlusion.begin(); while (occlusion.step()); })()");
  await variant("found", "", "");
  // Steps of pictures in several lights come in turn; a ground may be hidden. As a control, pictures of two lights differ.
  const inTurn = await browser.evaluate(`(() => {
    const { stage } = studio, camera = cameraOf(studio.data.mesh.view), weights = stage.weights(studio.engine), last = studio.data.environments.length - 1;
    const radiance = (environment) => stage.radiance(camera, ${width / 2}, ${height / 2}, weights, environment), found = {};
    for (const ground of [true, false]) {
      stage.ground = ground;
      const first = radiance(0), gbuffer = stage.gbuffer("kept", camera, ${width / 2}, ${height / 2}, [0, 0], 0);
      const other = radiance(last), between = stage.valuesOf(stage.shade("kept", gbuffer, weights, 0));
      found[ground ? "shown" : "hidden"] = { again: apart(radiance(0), first, 0).most, between: apart(between, first, 0).most, other: apart(other, first, 0).most };
    }
    stage.ground = true;
    return found;
  })()`);
  // A search for shadows finds the same after pictures in light of lamps came between its steps, and after another one that was broken off.
  const search = await browser.evaluate(`(() => {
    const { stage, parts } = studio, { gl, occlusion } = stage, all = () => { while (occlusion.shown === null) occlusion.step(); };  // of the mesh
    const bits = () => {
      const { columns, rows, bits: { framebuffer } } = occlusion.mesh, values = new Uint32Array(4 * columns * rows);
      gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
      gl.readBuffer(gl.COLOR_ATTACHMENT0);
      gl.readPixels(0, 0, columns, rows, gl.RGBA_INTEGER, gl.UNSIGNED_INT, values);
      return values.join();
    };
    const begin = () => { occlusion.begin(); for (let i = 0; i < 20; ++i) occlusion.step(); };
    occlusion.shown = null;
    occlusion.begin();
    all();
    const found = bits();
    occlusion.shown = null;
    begin();
    stage.turnTo(20);
    studio.data.environments.forEach((_, i) => stage.gbuffer("between", cameraOf(studio.data.mesh.view), 64, 36, [0, 0], i));
    stage.turnTo(0);
    all();
    const between = bits() === found, part = parts.list.find(({ row }) => row === 0);
    part.row = -1;
    begin();
    const other = bits() !== found;
    part.row = 0;
    occlusion.begin();
    all();
    const brokenOff = bits() === found;
    while (occlusion.step());
    return { lamps: studio.data.environments.some(({ lamps }) => lamps.length > 0), between, other, broken_off: brokenOff };
  })()`);
  await browser.evaluate("studio.data.environments.forEach((one, i) => { one.ground_light = studio.grounds[i]; })");
  // Layers that were drawn for one paint show another one: that whose wide lobes look elsewhere most, of all that little gloss makes
  // of paints of the library; and with the lamp. The control takes layers as they are.
  // Half of the width and of the height is enough for these.
  const moved = await browser.evaluate(`(() => {
    const app = studio, { stage } = app, { gathered } = stage, camera = cameraOf(app.data.mesh.view);
    const shown = (paint) => { app.engine.ask({ do: "fit", paint }); return stage.weights(app.engine); };
    const shifts = (weights) => gathered.layers.list.flatMap((layer) => gathered.shiftsOf(layer, weights));
    let a = null, b = null, farthest = -1;
    for (let i = 0; i < Math.min(app.library.count, 100); ++i) {
      const before = shown(app.library.paint(i)), from = shifts(before);
      const after = shown(app.engine.ask({ do: "edit", paint: app.library.paint(i), edit: { gloss: 4 } }).paint);
      const way = shifts(after).reduce((most, shift, j) => Math.max(most, Math.abs(shift - from[j])), 0);
      if (gathered.ownOf(before) === gathered.ownOf(after) && way > farthest) [farthest, a, b] = [way, before, after];
    }
    const pair = (before, after) => {
      gathered.drop();
      stage.gatheredRadiance(camera, ${width / 2}, ${height / 2}, before, 0);
      const kept = stage.gatheredRadiance(camera, ${width / 2}, ${height / 2}, after, 0);
      return apart(kept, stage.radiance(camera, ${width / 2}, ${height / 2}, after, 0), 0);
    };
    const result = { shift: farthest, moved: pair(a, b) };
    gathered.fits = (layer) => gathered.held.drawn.has(layer.slot);
    result.control = pair(a, b);
    delete gathered.fits;
    app.stageView.environment = 0;
    app.stageView.setLamp({ on: true, azimuth: -25, elevation: 40, stops: -1 });
    result.lamp = pair(a, b);
    app.stageView.setLamp({ on: false });
    // With little memory, layers give way to others, and a picture that has no room for its own is refused.
    const room = Math.max(...[a, b].map((weights) => gathered.needed(weights, true).length)) + 1;
    gathered.capacity = () => room;
    result.little = pair(a, b);
    gathered.capacity = () => room - 2;
    try { pair(a, b); } catch (error) { result.refused = error.message; }
    delete gathered.capacity;
    gathered.drop();
    return result;
  })()`);
  // Samples of the pixels that differ from those beside them, and of all pixels; the control has none. No value counts more than in those. Of a stride of two the first
  // of four pixels is as it is in the whole picture.
  const smooth = await browser.evaluate(`(() => {
    const app = studio, { stage } = app, camera = cameraOf(app.data.mesh.view), width = ${width / 2}, height = ${height / 2}, count = mostSamples;
    app.engine.ask({ do: "fit", paint: app.library.paint([...Array(app.library.count).keys()].find((i) => app.library.paint(i).name === ${JSON.stringify(paints[0])})) });
    const weights = stage.weights(app.engine), gbuffer = (name, shift) => stage.gbuffer(name, camera, width, height, shift, 0);
    const most = mostCounted * stage.environment(0).white, held = (value) => Math.min(value, most);
    const sum = stage.shade("check", gbuffer("check", [0, 0]), weights, 0), plain = stage.valuesOf(sum).map(held), mean = new Float32Array(plain.length);
    for (const _ of stage.smooth("check", sum, camera, weights, 0, 0, count));
    const ours = stage.valuesOf(sum).map(held);
    for (const shift of sampleShifts) stage.valuesOf(stage.shade("other", gbuffer("other", shift), weights, 0)).forEach((value, i) => { mean[i] += held(value) / count; });
    const off = (values) => values.reduce((all, value, i) => all + Math.abs(value - mean[i]), 0) / values.length / stage.environment(0).white;
    const whole = stage.gatheredRadiance(camera, width, height, weights, 0), half = stage.valuesOf(stage.gathered.shade("half", gbuffer("radiance", [0, 0]), weights, 0, 2));
    stage.gathered.drop();
    return { off: off(ours), off_plain: off(plain), strided: half.every((value, i) => value === whole[4 * (2 * Math.floor(i / 4 / (width / 2)) * width + 2 * (Math.floor(i / 4) % (width / 2))) + (i % 4)]) };
  })()`);
  // From an edit to its pixels, which are read back so that nothing is still to be drawn: by the shading program.
  const times = await browser.evaluate(`(() => {
    const app = studio, all = [], fits = [], gl = app.stage.gl, pixel = new Uint8Array(4);
    app.stageView.environment = 0;
    app.stageView.rest(null);
    for (let i = 0; i < 5; ++i) {
      app.tiles.stop();
      const begin = performance.now();
      const { paint } = app.edited({ "hue-shift": 3 * i + 1 });
      const fit = app.engine.ask({ do: "fit", paint });
      fits.push(fit.time_us / 1000);
      app.weights = app.stage.weights(app.engine, app.weights);
      app.stage.draw("centers", cameraOf(app.data.mesh.view), ${width}, ${height}, app.weights, 0, 0);
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      all.push(performance.now() - begin);
    }
    const middle = (list) => list.sort((a, b) => a - b)[list.length >> 1];
    return { edit_to_picture_ms: middle(all), fit_ms: middle(fits) };
  })()`);
  // The times in the page as a whole, whose view has come to rest: all that an edit changes besides the small pictures.
  const settled = await browser.evaluate(`(async () => {
    const { stageView, stage } = studio, view = stageView, all = [], frame = () => new Promise(requestAnimationFrame);
    view.canvas.style.width = "${width}px";
    view.canvas.style.height = "${height}px";
    view.canvas.style.aspectRatio = "auto";
    view.full_ms = 0;
    view.redraw();
    const ready = () => stage.gathered.held && stage.gathered.waiting(view.weights, view.environment, true).length === 0;
    for (const end = performance.now() + 60000; !ready() && performance.now() < end;) await new Promise((resolve) => setTimeout(resolve, 20));
    for (let i = 0; i < 5; ++i) {
      studio.tiles.stop();
      view.rest(null);
      await frame();
      const begin = performance.now();
      studio.display(studio.edited({ "hue-shift": 3 * i + 1 }).paint, false);
      view.drawNow(false);
      view.rest(null);
      await stage.drawn();
      all.push(performance.now() - begin);
    }
    return { settled_ms: all.sort((a, b) => a - b)[2], settled_size: [view.canvas.width, view.canvas.height], layers_drawn: ready() ? stage.gathered.held.drawn.size : 0, layer_bytes: stage.gathered.bytes };
  })()`);
  // The time that a designer meets: a handle that moves, until the picture of its frame is drawn, with as many pixels as the page takes for
  // this computer; the pixels are read back here too.
  const dragged = await browser.evaluate(`(async () => {
    const view = studio.stageView, all = [], frame = () => new Promise(requestAnimationFrame);
    studio.tiles.stop();
    view.canvas.style.width = "${width}px";
    view.canvas.style.height = "${height}px";
    view.canvas.style.aspectRatio = "auto";
    await frame();
    for (let i = 0; i < 12; ++i) {
      const begin = performance.now();
      studio.preview({ "hue-shift": 2 * i + 1 });
      await frame();
      await view.stage.drawn();
      all.push(performance.now() - begin);
    }
    const late = all.slice(6).sort((a, b) => a - b);
    return { dragged_ms: late[3], dragged_size: [view.canvas.width, view.canvas.height] };
  })()`);
  // How many timers eight steps take.
  const timers = await browser.evaluate(`(async () => {
    const set = window.setTimeout;
    let count = 0;
    window.setTimeout = (action, ms, ...more) => { count += ms === 0; return set(action, ms, ...more); };
    await new Promise((done) => studio.stageView.rest((function* () { for (let i = 0; i < 8; ++i) yield; done(); })()));
    window.setTimeout = set;
    return count;
  })()`);
  await browser.close();
  console.log(JSON.stringify({ timers, in_turn: inTurn, search, ...times, ...settled, ...dragged, environments, layers, smooth, ...moved, problems: browser.problems }));
  if (browser.problems.length > 0) process.exit(1);
}

main().catch((error) => {
  console.error(error.stack);
  process.exit(1);
});
