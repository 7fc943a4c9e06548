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
        const app = studio, one = app.data.paints.find((each) => each.paint.name === ${JSON.stringify(paint)}).paint;
        app.tiles.stop();
        app.engine.ask({ do: "fit", paint: one });
        const weights = app.stage.weights(app.engine.weights());
        const values = app.stage.radiance(cameraOf(app.data.mesh.view), ${width}, ${height}, weights, ${number});
        const bytes = new Uint8Array(values.buffer);
        let text = "";
        for (let i = 0; i < bytes.length; i += 32768) text += String.fromCharCode(...bytes.subarray(i, i + 32768));
        return btoa(text);
      })()`);
      fs.writeFileSync(path.join(folder, `${paint}-${environments[number]}.f32`), Buffer.from(base64, "base64"));
    }
  // From an edit to its pixels, which are read back so that nothing is still to be drawn.
  const times = await browser.evaluate(`(() => {
    const app = studio, all = [], fits = [], gl = app.stage.gl, pixel = new Uint8Array(4);
    app.environment = 0;
    for (let i = 0; i < 12; ++i) {
      app.tiles.stop();
      const begin = performance.now();
      const { paint } = app.edited({ "hue-shift": 3 * i + 1 });
      const fit = app.engine.ask({ do: "fit", paint });
      fits.push(fit.time_us / 1000);
      app.weights = app.stage.weights(app.engine.weights(), app.weights);
      app.stage.draw(cameraOf(app.data.mesh.view), ${width}, ${height}, app.weights, 0, 0);
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      all.push(performance.now() - begin);
    }
    const middle = (list) => list.sort((a, b) => a - b)[list.length >> 1];
    return { edit_to_picture_ms: middle(all), fit_ms: middle(fits) };
  })()`);
  await browser.close();
  console.log(JSON.stringify({ ...times, environments, problems: browser.problems }));
  if (browser.problems.length > 0) process.exit(1);
}

main().catch((error) => {
  console.error(error.stack);
  process.exit(1);
});
