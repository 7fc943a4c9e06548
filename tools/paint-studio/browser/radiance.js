// Parts of the scripts that compare radiances of a page as numbers.
"use strict";
const fs = require("node:fs");
const path = require("node:path");

// Makes a page throw no shadows, as the engine gl, and gives it two functions: studioPaint(NAME) has the weights of a paint of the library, and
// apart(OURS, THEIRS, NUMBER) how far a picture is from another one in an environment: of the value of a channel, and a hundredth of white.
// The `write` that is returned writes the radiance of a paint in an environment, by its number, as FOLDER/NAME.f32: raw floats from the upper
// left corner, four channels a pixel.
async function radiances({ folder, value }, size) {
  const [width, height] = size.split("x").map(Number), environments = await value("studio.data.environments.map((one) => one.name)");
  await value("(() => { while (studio.stage.occlusion.step()); studio.stage.occlusion.columns = 0; })()");
  await value(`window.studioPaint = (name) => {
    const { library, engine, stage, tiles } = studio;
    tiles.stop();
    engine.ask({ do: "fit", paint: library.paint([...Array(library.count).keys()].find((i) => library.paint(i).name === name)) });
    return stage.weights(engine);
  }`);
  await value(`window.apart = (ours, theirs, number) => {
    const least = 0.01 * studio.stage.environment(number).white;
    const all = ours.map((value, i) => Math.abs(value - theirs[i]) / (Math.abs(theirs[i]) + least)).sort();
    return { p95: all[Math.floor(0.95 * all.length)], most: all.at(-1) };
  }`);
  // `before` and `after` are statements around the drawing, which know `weights` and `values`.
  const write = async (name, paint, number, before = "", after = "") => {
    const base64 = await value(`(() => {
      const weights = studioPaint(${JSON.stringify(paint)});
      ${before}
      const values = studio.stage.radiance(cameraOf(studio.data.mesh.view), ${width}, ${height}, weights, ${number});
      ${after}
      const bytes = new Uint8Array(values.buffer);
      let text = "";
      for (let i = 0; i < bytes.length; i += 32768) text += String.fromCharCode(...bytes.subarray(i, i + 32768));
      return btoa(text);
    })()`);
    fs.writeFileSync(path.join(folder, name + ".f32"), Buffer.from(base64, "base64"));
  };
  return { value, width, height, environments, write };
}

module.exports = { radiances };
