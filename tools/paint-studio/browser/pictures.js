// Writes the radiance that a page shows of some paints in each of its environments, as raw floats from the upper left
// corner: FOLDER/PAINT-ENVIRONMENT.f32, four channels a pixel. Prints the time of an edit until its picture is there.
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
  for (const paint of paints)
    for (let number = 0; number < environments.length; ++number) {
      const base64 = await browser.evaluate(`(() => {
        const app = studio, all = [...Array(app.library.count).keys()];
        const one = app.library.paint(all.find((i) => app.library.paint(i).name === ${JSON.stringify(paint)}));
        app.tiles.stop();
        app.engine.ask({ do: "fit", paint: one });
        const weights = app.stage.weights(app.engine);
        const values = app.stage.radiance(cameraOf(app.data.mesh.view), ${width}, ${height}, weights, ${number});
        const bytes = new Uint8Array(values.buffer);
        let text = "";
        for (let i = 0; i < bytes.length; i += 32768) text += String.fromCharCode(...bytes.subarray(i, i + 32768));
        return btoa(text);
      })()`);
      fs.writeFileSync(path.join(folder, `${paint}-${environments[number]}.f32`), Buffer.from(base64, "base64"));
    }
  // The first paint with the lamp of the page, in each environment turned by a right angle, and without its ground.
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
  // From an edit to its pixels, which are read back so that nothing is still to be drawn.
  const times = await browser.evaluate(`(() => {
    const app = studio, all = [], fits = [], gl = app.stage.gl, pixel = new Uint8Array(4);
    app.stageView.environment = 0;
    app.stageView.rest(null);
    for (let i = 0; i < 12; ++i) {
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
  // The same as a designer meets it: a handle that moves, until the picture of its frame is drawn, with as many pixels as
  // the page takes for this computer; the pixels are read back here too.
  const dragged = await browser.evaluate(`(async () => {
    const view = studio.stageView, all = [], frame = () => new Promise(requestAnimationFrame);
    studio.tiles.stop();
    view.canvas.style.width = "${width}px";
    view.canvas.style.height = "${height}px";
    view.canvas.style.aspectRatio = "auto";
    await frame();
    for (let i = 0; i < 40; ++i) {
      const begin = performance.now();
      studio.preview({ "hue-shift": 2 * i + 1 });
      await frame();
      view.stage.wait();
      all.push(performance.now() - begin);
    }
    const late = all.slice(20).sort((a, b) => a - b);
    return { dragged_ms: late[10], dragged_size: [view.canvas.width, view.canvas.height] };
  })()`);
  await browser.close();
  console.log(JSON.stringify({ ...times, ...dragged, environments, problems: browser.problems }));
  if (browser.problems.length > 0) process.exit(1);
}

main().catch((error) => {
  console.error(error.stack);
  process.exit(1);
});
