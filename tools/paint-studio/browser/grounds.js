// Writes the radiance that a page shows of a paint on its ground in each of its environments: FOLDER/PAINT-ENVIRONMENT-WHAT.f32, where the ground is
// groundless, shadeless, unsent (without the light that the mesh sends to it), shaded (as is the mesh by itself), or found (with the shadow that the
// page finds). Prints whether shadows are the same in whatever order they are drawn and searched.
//
//   node grounds.js PAGE.html FOLDER WIDTHxHEIGHT PAINT
"use strict";
const { drive } = require("./drive.js");
const { radiances } = require("./radiance.js");

drive("the grounds are written", {}, async (handles, size, paint) => {
  const { value, width, height, environments, write } = await radiances(handles, size);
  const variant = async (name, before, after) => {
    for (const [number, environment] of environments.entries()) await write(`${paint}-${environment}-${name}`, paint, number, `const light = studio.data.environments[${number}]; ${before}`, after);
  };
  await variant("groundless", "studio.stage.ground = false;", "studio.stage.ground = true;");
  await variant("shadeless", "const shade = light.ground_light; delete light.ground_light;", "light.ground_light = shade;");
  await variant("unsent", "weights.meshColor = [0, 0, 0];", "");
  // With the shadow of the mesh on itself, and with the shadows that the page finds by itself.
  await value("studio.stage.occlusion.columns = vertexColumns");
  await variant("shaded", "", "");
  await value("(() => { const { occlusion } = studio.stage; for (const one of studio.data.environments) delete one.ground_light; occlusion.begin(); while (occlusion.step()); })()");
  await variant("found", "", "");
  // Steps of pictures in several lights come in turn; a ground may be hidden. As a control, pictures of two lights differ.
  const inTurn = await value(`(() => {
    const { stage } = studio, camera = cameraOf(studio.data.mesh.view), weights = studioPaint(${JSON.stringify(paint)}), last = studio.data.environments.length - 1;
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
  const search = await value(`(() => {
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
  console.log(JSON.stringify({ in_turn: inTurn, search }));
});
