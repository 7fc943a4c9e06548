// Prints how far pictures from layers of gathered light are from those of the shading program, where layers were drawn for another paint, with a lamp and
// with little memory; what samples of edges are worth; and the time of an edit until its picture is there.
//
//   node layers.js PAGE.html FOLDER WIDTHxHEIGHT PAINT
"use strict";
const { drive } = require("./drive.js");
const { radiances } = require("./radiance.js");

drive("the layers are compared", {}, async (handles, size, paint) => {
  const { value, width, height } = await radiances(handles, size);
  await value("studio.stage.occlusion.columns = vertexColumns");  // with the shadow of the mesh on itself
  // Layers that were drawn for one paint show another one: that whose wide lobes look elsewhere most, of all that little gloss makes
  // of paints of the library; and with the lamp. The control takes layers as they are.
  // Half of the width and of the height is enough for these.
  const moved = await value(`(() => {
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
    // With little memory, layers give way to others, all that there is room for are drawn, and a picture that has no room for its own is refused.
    const room = Math.max(...[a, b].map((weights) => gathered.needed(weights, true).length)) + 1;
    gathered.capacity = () => room;
    result.little = pair(a, b);
    gathered.drop();
    while (stage.gather("radiance", camera, ${width / 2}, ${height / 2}, b, 0));
    result.full = gathered.held.drawn.size === room;
    gathered.capacity = () => room - 2;
    try { pair(a, b); } catch (error) { result.refused = error.message; }
    delete gathered.capacity;
    gathered.drop();
    return result;
  })()`);
  // Samples of the pixels that differ from those beside them, and of all pixels; the control has none. No value counts more than in those. Of a stride of two the first
  // of four pixels is as it is in the whole picture.
  const smooth = await value(`(() => {
    const app = studio, { stage } = app, camera = cameraOf(app.data.mesh.view), width = ${width / 2}, height = ${height / 2}, count = mostSamples;
    const weights = studioPaint(${JSON.stringify(paint)}), gbuffer = (name, shift) => stage.gbuffer(name, camera, width, height, shift, 0);
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
  const times = await value(`(() => {
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
  const settled = await value(`(async () => {
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
  const dragged = await value(`(async () => {
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
  const timers = await value(`(async () => {
    const set = window.setTimeout;
    let count = 0;
    window.setTimeout = (action, ms, ...more) => { count += ms === 0; return set(action, ms, ...more); };
    await new Promise((done) => studio.stageView.rest((function* () { for (let i = 0; i < 8; ++i) yield; done(); })()));
    window.setTimeout = set;
    return count;
  })()`);
  console.log(JSON.stringify({ timers, ...times, ...settled, ...dragged, smooth, ...moved }));
});
