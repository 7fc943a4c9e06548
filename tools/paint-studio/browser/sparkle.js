// Writes the radiance of a plate in the plane z = 0, without and with the light of single flakes, seen from so many meters, as
// FOLDER/plain-D.f32 and FOLDER/flaky-D.f32 (see pictures.js). Holds that a picture in which no eye sees single flakes is drawn
// without them.
//
//   node sparkle.js PAGE.html FOLDER PIXELS METERS,FOV...
"use strict";
const fs = require("node:fs");
const path = require("node:path");
const { check, drive } = require("./drive.js");

drive("flakes sparkle", { width: 1000, height: 700 }, async ({ folder, value, quiet, choose }, size, ...views) => {
  await choose("library", "stated");
  await quiet();
  await value("(studio.tiles.stop(), studio.stageView.rest(null), studio.stageView.setLamp({ on: true, azimuth: 12, elevation: 2, stops: 0 }))");
  for (const view of views) {
    const [meters, fov] = view.split(",").map(Number), camera = `cameraOf({ azimuth: 0, elevation: 0, distance: ${meters}, target: [0, 0, 0], fov: ${fov} })`;
    const pictures = await value(`(() => {
      const { stage, weights } = studio, gbuffer = stage.gbuffer("radiance", ${camera}, ${size}, ${size}, [0, 0], 0), sum = stage.shade("radiance", gbuffer, weights, 0);
      const texts = [sum, stage.sparkled(gbuffer, [sum], ${size}, weights, 0)[0]].map((one) => {
        const bytes = new Uint8Array(stage.valuesOf(one).buffer);
        let text = "";
        for (let i = 0; i < bytes.length; i += 32768) text += String.fromCharCode(...bytes.subarray(i, i + 32768));
        return btoa(text);
      });
      return texts; })()`);
    ["plain", "flaky"].forEach((name, i) => fs.writeFileSync(path.join(folder, `${name}-${meters}.f32`), Buffer.from(pictures[i], "base64")));
  }
  // Each of two paints has flakes on its own side.
  const [named] = await value("(() => { studio.compare(`library ${[...Array(studio.library.count).keys()].find((i) => studio.library.paint(i).name === 'silver_fine')}`); return [studio.compared.name]; })()");
  const sides = await value(`(() => {
    const { stage, weights, compared } = studio, camera = cameraOf({ azimuth: 0, elevation: 0, distance: 1, target: [0, 0, 0], fov: 15 });
    return [[weights, compared.weights], [compared.weights, weights]].map(([left, right]) => {
      stage.draw("check", camera, 64, 64, { left, right, at: 0.25 }, 0, 0);
      const { gbuffer, sums, border } = stage.shown;
      return [border, ...stage.sparkled(gbuffer, sums, border, { left, right, at: 0.25 }, 0).map((one, i) => one !== sums[i])];
    }); })()`);
  check(`flakes lie on the side of their paint: ${named} ${JSON.stringify(sides)}`, named === "silver_fine" && JSON.stringify(sides) === "[[16,true,false],[16,false,true]]");
  await value("studio.compare('none')");
  const drawn = (paint) => value(`(() => { const { stage, weights } = studio, gbuffer = stage.gbuffer("radiance", cameraOf({ azimuth: 0, elevation: 0, distance: 1, target: [0, 0, 0], fov: 15 }), 64, 64, [0, 0], 0), sum = stage.shade("radiance", gbuffer, weights, 0);
    return stage.sparkled(gbuffer, [sum], 64, weights, 0)[0] !== sum; })()`);
  check("flakes are drawn that an eye sees", await drawn());
  await value("studio.commit({ flakes: [1, 1, 0.5] })");
  check("dust is not drawn", !(await drawn()));
  await choose("library", "silver_fine");
  check("nor are flakes that are assumed", !(await drawn()));
});
