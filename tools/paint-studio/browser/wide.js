// Holds that a page shows a color alike in its picture and beside it, on a screen of sRGB and on one of Display P3 that the page comes to.
//
//   node wide.js PAGE.html FOLDER
"use strict";
const { check, drive } = require("./drive.js");

// L*a*b* under D65 of signals 0..1. [CSS Color Module Level 4, sample code]
const toXyz = { srgb: [[0.41239, 0.35758, 0.18048], [0.21264, 0.71517, 0.07219], [0.01933, 0.11919, 0.95053]],
                "display-p3": [[0.48657, 0.26567, 0.19822], [0.22897, 0.69174, 0.07929], [0, 0.04511, 1.04394]] };
function labOf(screen, signals) {
  const light = signals.map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4));
  const [x, y, z] = toXyz[screen].map((row, i) => row.reduce((sum, part, k) => sum + part * light[k], 0) / [0.95046, 1, 1.08906][i]).map((t) => (t > 216 / 24389 ? Math.cbrt(t) : (24389 / 27 * t + 16) / 116));
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}
function labOfCss(css) {
  const numbers = css.replace("display-p3", "").match(/-?[\d.]+/g).map(Number);
  return css.includes("display-p3") ? labOf("display-p3", numbers.slice(0, 3)) : labOf("srgb", numbers.slice(0, 3).map((code) => code / 255));
}
const apart = (a, b) => Math.hypot(...a.map((value, i) => value - b[i]));

drive("colors beside the picture are its own", { width: 1000, height: 700 }, async ({ browser, value, quiet, choose }) => {
  const border = () => value("studio.description.screen.border.map(({ a, b }) => Math.hypot(a, b))");
  const shown = async () => {
    const { screen, ...seen } = await value(`(async () => {
      const { stage } = studio, { gl } = stage, { rgb } = studio.engine.ask({ do: "color", lab: studio.description.appearance.face }), pixel = new Uint8Array(4);
      const picture = { texture: stage.floatTexture(1, 1, new Float32Array([...rgb, 1])), width: 1, height: 1 };
      stage.display(picture, 1, 0, null);
      gl.readPixels(0, gl.drawingBufferHeight - 1, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      const small = await stage.pixels(picture, 1, 0);
      return { screen: gl.drawingBufferColorSpace, stage: [...pixel.slice(0, 3)], small: [...small.data.slice(0, 3)], smallScreen: small.colorSpace,
               swatch: getComputedStyle(document.querySelector("#numbers .swatch")).backgroundColor, handle: getComputedStyle(document.querySelector("#wheel .handle")).fill }; })()`);
    const of = (codes, kind = screen) => labOf(kind, codes.map((code) => code / 255));
    return { screen, stage: of(seen.stage), small: of(seen.small, seen.smallScreen), swatch: labOfCss(seen.swatch), handle: labOfCss(seen.handle) };
  };
  const loss = () => value("document.getElementById('screen-loss').textContent"), say = (one) => JSON.stringify(one, (_, number) => (typeof number === "number" ? Number(number.toFixed(2)) : number));
  await choose("library", "candy_red");
  await value("studio.commit({ face: [50, 20, 10], flop: [40, 10, 5] })");
  await value("(() => { document.getElementById('cloud-shown').open = true; })()");
  await quiet();
  const narrow = await border(), points = await value("document.querySelector('#wheel-back polygon').getAttribute('points')");
  await browser.send("Emulation.setEmulatedMedia", { features: [{ name: "color-gamut", value: "p3" }] });
  await browser.until("studio.stage.screen === 'display-p3'", 10);
  const wide = await border();
  check(`the border moves outward: ${say(wide)} ${say(narrow)}`, wide.every((chroma, i) => chroma > narrow[i] - 0.5) && wide.some((chroma, i) => chroma > narrow[i] + 10));
  check("so it does in the wheel", (await value("document.querySelector('#wheel-back polygon').getAttribute('points')")) !== points);

  // A color that only the wide screen has, in the direction of a*, 30 degrees from it.
  const chroma = 0.5 * (narrow[6] + wide[6]), face = [50, chroma * Math.cos(Math.PI / 6), chroma * Math.sin(Math.PI / 6)];
  await value(`studio.commit({ face: ${JSON.stringify(face)} })`);
  const onWide = await shown();
  check(`the wide screen shows it, and all its pictures and swatches: ${say([face, onWide])}`,
        onWide.screen === "display-p3" && apart(onWide.stage, face) < 2 && ["small", "swatch", "handle"].every((one) => apart(onWide[one], onWide.stage) < 0.7));
  check(`and tells no loss: ${await loss()}`, !(await loss()).includes("face"));
  await quiet();
  const spaces = await value("[...document.querySelectorAll('.tile canvas'), document.getElementById('cloud')].map((one) => one.getContext('2d').getContextAttributes().colorSpace)");
  check(`small pictures are of that screen: ${spaces}`, spaces.length > 3 && spaces.every((one) => one === "display-p3"));
  check("a row of the library has its colors", (await value("document.querySelector('#paint-list .chip').style.background")).includes("color(display-p3"));
  await value("studio.card.fill()");
  check("a card has those of sRGB", /^rgb/.test(await value("document.querySelector('#card .chip').style.background")));
  await value("studio.commit({ face: [60, 120, 110] })");
  check(`a color that it has not either is told: ${await loss()}`, /The screen shows the face \d+\.\d/.test(await loss()));
  const nearest = await value("studio.description.screen.face.nearest");
  await value("studio.turn('undo')");

  await browser.send("Emulation.setEmulatedMedia", { features: [{ name: "color-gamut", value: "srgb" }] });
  await browser.until("studio.stage.screen === 'srgb'", 10);
  const onNarrow = await shown();
  check(`a screen of sRGB shows another color, the same in all: ${say(onNarrow)}`,
        onNarrow.screen === "srgb" && apart(onNarrow.stage, face) > 3 && ["small", "swatch", "handle"].every((one) => apart(onNarrow[one], onNarrow.stage) < 0.7));
  check(`and tells so: ${await loss()}`, /The screen shows the face \d\.\d/.test(await loss()));
  await value("studio.commit({ face: [60, 120, 110] })");
  const inside = await value("studio.description.screen.face.nearest");
  check(`the nearest is that of the screen: ${say([nearest, inside])}`, Math.hypot(nearest[1], nearest[2]) > Math.hypot(inside[1], inside[2]) + 1);
});
