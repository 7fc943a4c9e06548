// Writes the radiance that a page shows of some paints in each of its environments, and that of the first one with the lamp of the page and in light
// that is turned by a right angle: FOLDER/PAINT-ENVIRONMENT.f32, -lamp and -turned. Prints how far the pictures from layers of gathered light are from
// these.
//
//   node pictures.js PAGE.html FOLDER WIDTHxHEIGHT PAINT...
"use strict";
const { drive } = require("./drive.js");
const { radiances } = require("./radiance.js");

drive("the pictures are written", {}, async (handles, size, ...paints) => {
  const { value, width, height, environments, write } = await radiances(handles, size), layers = [];
  for (const paint of paints)
    for (const [number, environment] of environments.entries()) {
      await write(`${paint}-${environment}`, paint, number, "", `window.off = apart(studio.stage.gatheredRadiance(cameraOf(studio.data.mesh.view), ${width}, ${height}, weights, ${number}), values, ${number});`);
      layers.push({ paint, environment, ...(await value("off")) });
    }
  for (const [number, environment] of environments.entries()) {
    await write(`${paints[0]}-${environment}-lamp`, paints[0], number, `studio.stageView.environment = ${number}; studio.stageView.setLamp({ on: true, azimuth: -25, elevation: 40, stops: -1 });`, "studio.stageView.setLamp({ on: false });");
    await write(`${paints[0]}-${environment}-turned`, paints[0], number, "studio.stageView.turnTo(90);", "studio.stageView.turnTo(0);");
  }
  console.log(JSON.stringify({ layers }));
});
