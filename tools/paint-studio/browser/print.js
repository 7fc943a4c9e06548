// Holds that a page shows the gamut of a printer of print_profile.py, and tells what a print loses, with the nearest color that it has.
//
//   node print.js PAGE.html FOLDER
"use strict";
const { check, drive } = require("./drive.js");

drive("prints are told", { width: 1000, height: 700 }, async ({ browser, value, shot, quiet, choose }) => {
  const told = () => value("document.getElementById('screen-loss').textContent"), near = (x, y, by) => Math.abs(x - y) <= by;
  await choose("library", "candy_red");
  await value("studio.commit({ face: [50, 20, 10], flop: [40, 10, 5] })");
  check(`colors inside lose nothing: ${await told()}`, (await told()) === "");
  const print = await value("studio.description.print"), right = print.border.find(({ b, a }) => b === 0 && a > 0), corner = print.border.find(({ a, b }) => a > 0 && near(a, b, 1e-6));
  check(`the border is that of the profile: ${JSON.stringify([right, corner])}`, near(right.a, 60, 4) && near(corner.a, 60, 4));
  check(`and between its lightnesses: ${print.face.low}, ${print.face.high}`, near(print.face.low, 20, 2) && near(print.face.high, 95, 2));
  const points = await value("document.getElementById('print-border').getAttribute('points')");
  check("the wheel has the border, and the column its ends", points.split(" ").length === print.border.length && (await value("document.getElementById('print-face').getAttribute('d')")).startsWith("M"));
  await value("studio.commit({ face: [105, 0, 0], flop: [40, 75, 0] })");
  check(`losses in print are told: ${await told()}`, /A print by printer shows the face \d\.\d .*take L\* 9[3456]\.\d.*A print by printer shows the flop \d+\.\d/.test(await told()));
  await quiet();
  await shot("print");
  await browser.click("#screen-loss p:last-child button");
  const flop = await value("studio.description.appearance.flop");
  check(`the nearest color is taken: ${flop}`, near(flop[0], 40, 0.01) && near(flop[1], 60, 4) && near(flop[2], 0, 0.01) && !(await told()).includes("flop"));
});
