// Opens files of every kind on a page: paints in all formats, whose readings it writes as NAME.opened.csv, files that are wrong,
// meshes, a basis, a light, which it compares with the same light of the page, and a session. Parts wear what is chosen.
//
//   open.js PAGE.html FOLDER PAINTS...
"use strict";
const fs = require("node:fs");
const path = require("node:path");
const { check, drive } = require("./drive.js");

const data = process.env.TESTDATA;

drive("files of every kind are opened", { width: 1000, height: 700 }, async ({ browser, folder, value, shot, status, give, choose, quiet, checkNames }, ...paints) => {
  await quiet();
  const open = async (...files) => {
    await value("studio.say('')");
    await give("#open-files", files);
    await browser.until("((said) => said !== '' && !/is being (read|filtered)/.test(said))(document.getElementById('status').textContent)");
    await browser.until("!studio.stage.occlusion.busy");
    return status();
  };
  for (const file of paints) {
    const name = path.basename(file), said = await open(file);
    check(`the fit error of ${name} is said: ${said}`, /miss the readings of .* by \d+\.\d\d on average, \d+\.\d\d at most/.test(said));
    const list = await value("(() => { const { own } = studio.history.now; return [own.file, studio.palette.filter((state) => state.own?.file === own.file).length]; })()");
    check(`${name} is the design: ${list}`, list[0] === name);
    const states = list[1] > 0 ? `studio.palette.filter((state) => state.own?.file === ${JSON.stringify(name)})` : "[studio.history.now]";
    const texts = await value(`${states}.map((state) => studio.engine.ask({ do: "write", paint: state.paint, as: "csv" }).text)`);
    fs.writeFileSync(path.join(folder, name + ".opened.csv"), texts.map((text, i) => (i === 0 ? text : text.slice(text.indexOf("\n") + 1))).join(""));
    if (file === paints[0]) await shot("open-paints");
    await value("(() => { while (studio.palette.length > 0) studio.arrange(0, -1); })()");
  }

  // Chromium styles the error that its parser of XML makes, which the page's policy forbids.
  const send = browser.take.bind(browser);
  browser.take = (message) => { if (!/inline style/.test(message.params?.entry?.text ?? "")) send(message); };

  // Openings come one after the other, and none is of no files; a file that cannot be read is told.
  const order = await value(`(async () => {
    const { opening, engine } = studio, { give } = engine, order = [];
    const file = (name, ms, readable = true) => Object.assign(new File(["x"], name), { arrayBuffer: () => new Promise((done, fail) => setTimeout(() => (readable ? done(new ArrayBuffer(1)) : fail()), ms)) });
    engine.give = (name, ...more) => { order.push(name); return give.call(engine, name, ...more); };
    await Promise.all([[file("slow.csv", 60)], [], [file("fast.csv", 5)], [file("folder", 5, false)]].map((files) => opening.open(files)));
    engine.give = give;
    return order.join(); })()`);
  check(`files wait for those before: ${order}`, order === "slow.csv,,fast.csv,," && (await status()).includes("folder cannot be read"));

  // Errors are those of the tools, with the file and the line.
  const wrong = {
    "wrong.paints.xml": '<paints xmlns="urn:goniochrome:paint:1" version="1">\n <paint name="x">\n  <measurement illuminant="D65" observer="10">\n   <lab geometry="45as15" L="12,5" a="0" b="0"/>\n  </measurement>\n </paint>\n</paints>\n',
    "between.paints.xml": '<paints xmlns="urn:goniochrome:paint:1" version="1">\n <paint name="x">\n  <appearance travel="60">\n   <face L="1" a="0" b="0"/>\n\n   stray\n  </appearance>\n </paint>\n</paints>\n',
    "broken.xlsx": "PK\x03\x04PK\x05\x06" + "\xff".repeat(18), "cut.xml": '<paints xmlns="urn:goniochrome:paint:1" version="1">\n <paint name="x">\n',
    "wrong.csv": "sample,geometry,illuminant,observer,L,a,b\nx,45as15,D65,10,many,0,0\n", "wrong.obj": "v 0 0 0\nv 1 0 0\nf 1 2 9\n", "light.exr": "\x76\x2f\x31\x01rest",
    "empty.glb": "glTF", "archive.xlsx": "PK\x03\x04 and nothing more", "notes.txt": "no table at all\n" };
  const told = {};
  const before = JSON.stringify(await value("[studio.paint, studio.data.mesh.parts.length, studio.data.environments.length]"));
  for (const [name, text] of Object.entries(wrong)) {
    fs.writeFileSync(path.join(folder, name), text, "latin1");
    told[name] = await open(path.join(folder, name));
    check(`${name} is refused by name: ${told[name]}`, told[name].includes(name) && /\w{4}/.test(told[name].replace(name, "")));
  }
  check("what is refused changes nothing", JSON.stringify(await value("[studio.paint, studio.data.mesh.parts.length, studio.data.environments.length]")) === before);
  fs.writeFileSync(path.join(folder, "told.json"), JSON.stringify(told));

  check("lines of a comment count", (await value(`xmlEvents("<a>\\n<!-- one\\ntwo -->\\ntext\\n</a>").slice(-5).join("|")`)) === "t|5|\ntext\n|/|5");
  check("a basis is told", (await open(path.join(data, "b5.basis.xml"))).includes("is the basis of this page"));
  check("another basis is told", (await open(path.join(data, "b7.basis.xml"))).includes("--basis"));

  // The light of the probe, filtered in the page, beside the same light, filtered by the tool.
  const said = await open(path.join(folder, "probe.hdr"));
  check(`the light is filtered: ${said}`, /probe.hdr: the light was filtered in \d+\.\d s/.test(said));
  console.log(said);
  const radiance = (number) => `studio.stage.radiance(studio.stageView.camera, 96, 54, studio.weights, ${number})`;
  const apart = await value(`(() => {
    const ours = ${radiance("studio.data.environments.length - 1")}, theirs = ${radiance("studio.data.environments.findIndex((one) => one.name === 'probe')")}, others = ${radiance(0)};
    const distance = (a) => a.reduce((sum, x, i) => sum + Math.abs(x - theirs[i]), 0) / theirs.reduce((sum, x) => sum + x, 0);
    return [distance(ours), distance(others)]; })()`);
  check(`the light is that of the tool, and the control is not: ${apart}`, apart[0] <= 0.01 && apart[1] > 0.05);
  // OpenEXR by the scan-line reader: equal pixels give equal maps.
  const maps = (name) => value(`studio.opening.filtered(${JSON.stringify(name)}, new Uint8Array(Uint8Array.from(atob("${fs.readFileSync(path.join(folder, name)).toString("base64")}"), (c) => c.charCodeAt(0))))
    .then(({ numbers }) => crypto.subtle.digest("SHA-256", numbers)).then((digest) => [...new Uint8Array(digest)].join(), (error) => error.message)`);
  const unpacked = await maps("probe-none.exr");
  check("OpenEXR is the light of the probe", /^[\d,]+$/.test(unpacked) && unpacked === (await maps("probe.hdr")));
  for (const name of ["rle", "zips", "zip"]) check(`${name} unpacks to the same`, (await maps(`probe-${name}.exr`)) === unpacked);
  const crop = await maps("probe-crop.exr");
  check("a crop of halves stands in its window", crop !== unpacked && crop === (await maps("probe-full.exr")));
  fs.writeFileSync(path.join(folder, "probe-cut.exr"), fs.readFileSync(path.join(folder, "probe-zip.exr")).subarray(0, -40));
  for (const [name, what] of [["piz", "PIZ"], ["dwaa", "DWAA"], ["tiles", "tiles"], ["cut", "cut off"]]) {
    const told = await open(path.join(folder, `probe-${name}.exr`));
    check(`${name} is refused with a remedy: ${told}`, told.includes(what) && /save it as|fetch it/.test(told));
  }
  check(`OpenEXR is opened: ${await open(path.join(folder, "probe-half.exr"))}`, (await value("studio.data.environments.at(-1).name")) === "probe-half");
  check("the light is shown", (await value("studio.stageView.environment")) === (await value("studio.data.environments.length - 1")));
  await shot("open-light");

  // Meshes by the same readers; each replaces the one before.
  await choose("environment", "studio");
  const parts = () => value("studio.stage.mesh.parts.map(({ name, row }) => [name, row])");
  await value("(window.before = [...studio.stage.targets.values()].map(({ texture }) => texture)).length");
  const ofBox = await open(path.join(data, "box.obj"));
  check(`the box is there: ${ofBox}`, (await parts()).map(([name]) => name).join() === "White,Red,Green,Gray" && ofBox.includes("told by their names are none; 4 not recognized"));
  check("pictures of the mesh before are freed", await value("before.length > 0 && !before.some((one) => studio.stage.gl.isTexture(one))"));
  const ofDoors = await open(path.join(data, "doors.glb"));
  check(`the doors are there: ${ofDoors}`, (await parts()).map(([name]) => name).join() === "Closet,Left.Panel,Left.Pane,Right.Panel,Right.Pane");
  await browser.until("studio.stageView.full_ms > 0", 30).catch(() => {});
  await browser.until("!studio.stage.occlusion.busy");
  const covered = "studio.stage.radiance(studio.stageView.camera, 64, 36, studio.weights, 0)";
  check("the mesh is seen", (await value(`new Set(${covered}).size`)) > 100);
  await shot("open-mesh");

  // Parts wear what is chosen in the list, or after a click on them.
  const wear = (name, row) => value(`(() => { const list = [...document.querySelectorAll("#parts .part")].find((one) => one.textContent.includes(${JSON.stringify(name)})).querySelector("select");
    list.value = ${row}; list.dispatchEvent(new Event("change")); })()`).then(() => browser.until("!studio.stage.occlusion.busy"));
  const sums = () => value(`[...${covered}].reduce((sum, x) => sum + x, 0)`), plain = await sums();
  await wear("Closet", 3);
  const rubber = await sums();
  check(`rubber is dark: ${plain}, ${rubber}`, rubber < plain);
  await wear("Closet", -1);
  check("a hidden part is not seen", (await value(`!studio.stage.pointUnder(studio.stageView.camera, 16 / 9, 0.5, 0.5)?.part || studio.stage.pointUnder(studio.stageView.camera, 16 / 9, 0.5, 0.5).part.name !== "Closet"`)));
  await wear("Closet", 0);
  check("the design is back", Math.abs((await sums()) - plain) <= 1e-6 * plain);
  const first = JSON.stringify(await value("studio.paint"));
  await value("document.getElementById('take-second').click()");
  await value("studio.commit({ face: [20, 40, 30], flop: [10, 20, 15] })");
  const one = await sums();
  await wear("Closet", 1);
  check("the second paint is worn beside the first", Math.abs((await sums()) - one) > 1e-3 * one && JSON.stringify(await value("studio.parts.second.paint")) === first);
  const middle = await browser.middle("#stage");
  await browser.mouse("mousePressed", middle.x, middle.y);
  await browser.mouse("mouseReleased", middle.x, middle.y);
  check("a click chooses a part", (await value("studio.parts.chosen?.name ?? ''")) !== "" && !(await value("document.getElementById('part-box').hidden")));
  await shot("open-parts");

  // The session brings paints and parts back.
  await browser.click("#save-session");
  const file = `${await value("fileName(studio.paint.name)")}.session.json`, worn = JSON.stringify(await parts());
  fs.writeFileSync(path.join(folder, file), await browser.download(file));
  await value("studio.start(0)");
  await wear("Closet", 0);
  check("the session is open", (await open(path.join(folder, file))).includes("the session is open"));
  check("it has the parts", JSON.stringify(await parts()) === worn && (await value("studio.parts.second?.paint.name")) !== undefined);
  await checkNames();
});
