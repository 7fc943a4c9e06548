// The script holds what must stay while one works on a page: the stage beside the panels in windows of six sizes, the picture after the graphics
// were lost, the sessions of two tabs, and a design in a link. The camera by wheel, fingers and double click, handles that
// lie on each other, steps of keys, colors that the screen does not show, names and the palette.
//
//   node stay.js PAGE.html FOLDER
"use strict";
const { check, drive } = require("./drive.js");

drive("everything stays", { width: 1400, height: 900 }, async ({ browser, value, shot, quiet, choose, fill, checkNames }) => {
  await value(`(() => { const draw = Tiles.prototype.drawTile; window.tilesDrawn = 0;
    Tiles.prototype.drawTile = function (...of) { ++window.tilesDrawn; return draw.apply(this, of); }; })()`);
  const paint = () => value("studio.paint"), steps = () => value("studio.history.now.steps.length"), near = (a, b, by) => Math.abs(a - b) <= by;
  check("the first paint is one of interference, where there is one", await value(`(() => {
    const kinds = [...Array(studio.library.count).keys()].map((i) => studio.library.paint(i).class);
    return !kinds.includes("interference") || studio.paint.class === "interference"; })()`));
  for (const [width, height] of [[390, 844], [844, 390], [768, 1024], [1000, 1000], [1400, 900], [3840, 2160]]) {
    await browser.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: false });
    const seen = await value(`(() => {
      document.getElementById("controls").scrollTo(0, 1e6);
      const last = document.getElementById("copy").getBoundingClientRect();
      document.getElementById("controls").scrollTo(0, 0);
      const inside = (box) => box.top >= -1 && box.left >= -1 && box.right <= innerWidth + 1 && box.bottom <= innerHeight + 1;
      const stage = document.getElementById("stage").getBoundingClientRect(), wheel = document.getElementById("wheel").getBoundingClientRect();
      return { stage: inside(stage) && stage.height >= 0.25 * innerHeight, last: inside(last), wheel: wheel.top < innerHeight - 60,
               wide: document.documentElement.scrollWidth <= innerWidth, tall: document.documentElement.scrollHeight <= innerHeight }; })()`);
    check(`at ${width}x${height} the stage is seen beside the first and the last control: ${JSON.stringify(seen)}`, Object.values(seen).every((one) => one));
    await shot(`stay-${width}x${height}`);
  }
  await browser.send("Emulation.setDeviceMetricsOverride", { width: 1000, height: 700, deviceScaleFactor: 1, mobile: false });
  await quiet();

  // Small pictures have the shadow that was found after the page opened, and wait for it; it is found while the car turns, too.
  const tiles = await value("[window.tilesDrawn, document.querySelectorAll('.tile canvas').length]");
  check(`small pictures are drawn once: ${tiles}`, tiles[0] <= tiles[1]);
  const tile = () => value("(() => { const one = document.querySelector('#variations canvas'); return [...one.getContext('2d').getImageData(0, 0, one.width, one.height).data]; })()");
  const opened = await tile();
  await value("studio.tiles.again()");
  await quiet();
  check("a small picture that is drawn again is the same", JSON.stringify(await tile()) === JSON.stringify(opened));
  await value("(() => { Object.assign(studio.stageView, { full_ms: 0.1, lastFrame: 1 }); studio.stage.occlusion.shown = null; studio.stageView.shadow(); })()");
  await browser.until("!studio.stage.occlusion.busy");
  await quiet();
  check("a picture that takes longer than was thought is measured", (await value("studio.stageView.full_ms")) > 0.1);

  // The wheel, fingers, the right button and a double click.
  const view = () => value("studio.stageView.view"), middle = await browser.middle("#stage"), first = await view();
  const wheel = (modifiers) => browser.send("Input.dispatchMouseEvent", { type: "mouseWheel", ...middle, deltaX: 0, deltaY: 120, modifiers });
  await value("document.activeElement.blur()");
  await wheel(0);
  check("the wheel alone scrolls the panels", (await view()).distance === first.distance && (await value("document.getElementById('controls').scrollTop")) > 0);
  await wheel(2);
  check("the wheel with Ctrl moves the camera", (await view()).distance > first.distance);
  const touch = (type, points) => browser.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x: middle.x + x, y: middle.y + y, id })) });
  await touch("touchStart", [[-50, 0]]);
  await touch("touchStart", [[-50, 0], [50, 0]]);
  await touch("touchMove", [[-100, 0], [100, 0]]);
  await touch("touchEnd", []);
  check("two fingers that part come closer", near((await view()).distance, 1.08 * first.distance / 2, 0.02 * first.distance));
  await browser.click("#reset-view");
  const pinched = await value(`(() => {
    const { canvas } = studio.stageView, seen = [], by = (type, pointerId, x) => canvas.dispatchEvent(new PointerEvent(type, { pointerId, pointerType: "touch", clientX: ${middle.x} + x, clientY: ${middle.y}, bubbles: true }));
    canvas.setPointerCapture = () => {};
    for (const stays of [11, 12]) {
      for (const [type, pointerId, x] of [["pointerdown", 11, -50], ["pointerdown", 12, 50], ["pointermove", 11, -100], ["pointermove", 12, 100], ["pointerup", 23 - stays, 0]]) by(type, pointerId, x);
      const before = JSON.stringify(studio.stageView.view);
      by("pointermove", stays, 10);
      seen.push(JSON.stringify(studio.stageView.view) === before);
      by("pointerup", stays, 10);
    }
    delete canvas.setPointerCapture;
    return seen; })()`);
  check(`the finger that stays moves nothing: ${pinched}`, pinched.every((one) => one));
  await browser.click("#reset-view");
  const button = (type, x, y) => browser.send("Input.dispatchMouseEvent", { type, x, y, button: "right", buttons: 2, clickCount: 1 });
  await button("mousePressed", middle.x, middle.y);
  await button("mouseMoved", middle.x + 80, middle.y);
  await button("mouseReleased", middle.x + 80, middle.y);
  const panned = await view(), to = await value(`(() => {
    const camera = widened(cameraOf(studio.stageView.view), studio.stageView.canvas.clientWidth / studio.stageView.canvas.clientHeight), box = studio.stageView.canvas.getBoundingClientRect();
    const { clip } = projected(camera, box.width, box.height, studio.stage.mesh, [0, 0]), p = [...${JSON.stringify(first.target)}, 1];
    const row = (i) => [0, 1, 2, 3].reduce((sum, k) => sum + clip[4 * k + i] * p[k], 0);
    return (0.5 + 0.5 * row(0) / row(3)) * box.width - 0.5 * box.width; })()`);
  check(`what the camera goes around follows the right button: ${to}`, near(to, 80, 1) && panned.azimuth === first.azimuth);
  await browser.click("#reset-view");
  for (const clickCount of [1, 2])
    for (const type of ["mousePressed", "mouseReleased"])
      await browser.send("Input.dispatchMouseEvent", { type, ...middle, button: "left", buttons: 1, clickCount });
  const target = (await view()).target, box = await value("(({ low, high }) => ({ low, high }))(studio.stage.mesh)");
  check("a double click goes around a point of the mesh", target.every((x, i) => x >= box.low[i] - 1e-3 && x <= box.high[i] + 1e-3) && target.some((x, i) => Math.abs(x - first.target[i]) > 1e-6));
  await browser.click("#reset-view");

  // Steps of keys on a slider are one step of the history; an edited paint has a name of its own.
  await choose("library", "candy_red");
  await quiet();
  await value("document.querySelector('#numbers input[type=range][aria-label=gloss]').focus()");
  for (let i = 0; i < 10; ++i) await browser.key("ArrowLeft");
  check("ten keys are one step", (await steps()) === 1);
  await value("studio.curves.plots[0].handles[0].focus()");
  for (let i = 0; i < 3; ++i) await browser.key("ArrowUp");
  check("three keys on a reading are one step", (await steps()) === 2);
  await value("studio.turn('undo')");
  const focused = await value(`["#parts select", "#variations button"].map((one) => {
    const element = document.querySelector(one);
    element.focus();
    if (element.tagName === "SELECT") element.dispatchEvent(new Event("change"));
    else element.click();
    return document.activeElement === document.querySelector(one); })`);
  check(`what is made anew keeps the focus: ${focused}`, focused.every((one) => one));
  await value("while (studio.history.now.steps.length > 1) studio.turn('undo')");
  check("a paint that was edited is a copy", (await paint()).name === "candy_red copy" && (await value("document.getElementById('command').textContent")).includes("--rename"));
  await fill("paint-name", JSON.stringify("evening red"));
  check("it gets the name that is asked for", (await paint()).name === "evening red");
  await browser.click("#keep");
  check("the palette has it by its name", (await value("document.querySelector('#palette .tile span').textContent")) === "1: evening red");
  const red = JSON.stringify(await paint());
  await choose("library", "arctic_white");
  await browser.click("#palette .tile");
  await value("(() => { studio.openSession(studio.savedSession()); studio.show(); })()");
  check("a kept paint is the same in a session", JSON.stringify(await paint()) === red);
  // A session of another library is refused, and stays where it is kept.
  const refused = await value(`(() => {
    const { place } = studio, session = studio.savedSession().replaceAll('"of":"', '"of":"another '), text = JSON.stringify({ time: Date.now(), session });
    localStorage.setItem(place, text);
    studio.reopen();
    studio.show();
    const stays = localStorage.getItem(place) === text;
    localStorage.removeItem(place);
    return { stays, said: document.getElementById("status").textContent }; })()`);
  check(`a session of another library is refused: ${JSON.stringify(refused)}`, refused.stays && refused.said.includes("another library"));
  check("the design stays", JSON.stringify(await paint()) === red);
  // A damaged session or link changes nothing, and pictures that are no such data leave their board.
  const broken = await value(`(() => {
    const before = studio.history, refused = (open, text, harm) => { const made = JSON.parse(text); harm(made); try { open(JSON.stringify(made)); return false; } catch (error) { return /no session|does not say/.test(error.message) && studio.history === before; } };
    return [...[(one) => { one.history.states.push(one.history.states[0]); one.history.at = 0.5; }, (one) => { one.history.at = "0"; }, (one) => { one.palette = 5; }, (one) => { one.parts = { worn: 1 }; }, (one) => { one.notes = {}; }]
      .map((harm) => refused((text) => studio.openSession(text), studio.savedSession(), harm)), ...[(one) => { one.view.azimuth = "x"; }, (one) => { delete one.view.target; }, (one) => { one.lamp = {}; }]
      .map((harm) => refused((text) => studio.openLink(text), studio.linked(), harm))]; })()`);
  check(`damaged sessions and links are refused: ${broken}`, broken.length === 8 && broken.every((one) => one));
  const boards = await value(`(async () => {
    const session = JSON.parse(studio.savedSession()), kept = "data:image/gif;base64,R0lGODlhAQABAIAAAAAAAP///yH5BAEAAAAALAAAAAABAAEAAAIBRAA7";
    session.pictures = { made: 1, open: 0, droppers: [{ kind: "face" }], boards: [{ name: "one", zoom: 0, pictures: [{ name: "cut", data: "data:image/png;base64,%%" }, { name: "dot", data: kept }] }] };
    studio.openSession(JSON.stringify(session));
    await studio.pictures.restored;
    const seen = studio.pictures.all.map(({ name }) => name), said = document.getElementById("status").textContent;
    session.pictures.boards.push({ name: "none" });
    studio.openSession(JSON.stringify(session));
    await studio.pictures.restored.catch(() => {});
    const stay = studio.pictures.all.length;
    studio.pictures.remove();
    return [seen, said, stay]; })()`);
  check(`what is no picture leaves its board, and boards stay: ${JSON.stringify(boards)}`, boards[0].join() === "dot" && boards[1].includes("cut is no picture") && boards[2] === 1);
  check("notes of a session are kept", await value(`(() => { studio.openSession(JSON.stringify({ ...JSON.parse(studio.savedSession()), notes: "as seen at noon" })); return JSON.parse(studio.kept()[0].session).notes === "as seen at noon"; })()`));
  await value("document.getElementById('notes').focus()");
  await browser.key("z", 2);
  check("undo in a text is of the text", JSON.stringify(await paint()) === red);
  // A field shows what the paint has.
  const gloss = await value(`(() => { const field = document.querySelector("#numbers input[type=number][aria-label=gloss]"); field.focus(); field.value = 500; field.dispatchEvent(new Event("change")); return [field.valueAsNumber, studio.paint.gloss[0][1]]; })()`);
  check(`a field shows what the paint has: ${gloss}`, gloss.join() === "100,100");
  await browser.click("#undo");

  // The paint that is named beside the design is the one that is shown there.
  const beside = () => value("[document.getElementById('compare').selectedOptions[0].textContent, document.getElementById('side-right').textContent, studio.compared.weights?.paint.name]");
  await value("(() => { studio.keep(); studio.compare('palette 1'); studio.showChoices(); studio.arrange(0, -1); })()");
  check(`the second of the palette is the first when that goes: ${await beside()}`, (await beside()).join() === "1: evening red,evening red,evening red");
  await value("(() => { studio.compare('start'); studio.showChoices(); })()");
  await choose("library", "arctic_white");
  check(`what it began with is another paint: ${await beside()}`, (await beside()).slice(1).join() === "arctic_white, as it was,arctic_white");
  await value("(() => { studio.compare('none'); studio.showChoices(); })()");

  // Handles on each other, each of which moves from where it is taken.
  await value("studio.commit({ face: [50, 20, 10], flop: [50, 20, 10] })");
  const ends = () => value("studio.description.appearance"), place = await browser.middle("#wheel .handle");
  const scale = await value("document.getElementById('wheel').getScreenCTM().a"), ring = { x: place.x + 9.5 * scale, y: place.y };
  await browser.mouseDrag(ring, { x: ring.x + 10 * scale, y: ring.y });
  const moved = await ends();
  check(`the ring is the face, and does not jump: ${moved.face}`, near(moved.face[1], 30, 0.7) && near(moved.face[2], 10, 0.7) && near(moved.flop[1], 20, 0.01));
  await browser.click("#undo");
  await browser.mouseDrag(place, { x: place.x, y: place.y - 10 * scale });
  const flop = await ends();
  check(`its middle is the flop: ${flop.flop}`, near(flop.flop[2], 20, 0.7) && near(flop.face[2], 10, 0.01));

  // The page tells a color that the screen does not show, with the nearest that it shows.
  await value("studio.commit({ face: [60, 120, 110] })");
  check("a loss is told", /The screen shows the face \d+\.\d/.test(await value("document.getElementById('screen-loss').textContent")));
  await shot("stay-loss");
  await browser.click("#screen-loss button");
  check("the nearest color is shown as it is", !(await value("document.getElementById('screen-loss').textContent")).includes("face"));
  // A swatch shows what a matt surface of the color shows in the picture, however bright.
  const { css, rgb } = await value("studio.engine.ask({ do: 'color', lab: [133, 0, 30] })"), swatch = css.slice(1).match(/../g).map((code) => parseInt(code, 16));
  const shown = await value(`(() => {
    const texture = studio.stage.floatTexture(1, 1, new Float32Array([...${JSON.stringify(rgb)}, 1]));
    return studio.stage.pixels({ texture, width: 1, height: 1 }, 1, 0).then(({ data }) => [...data.slice(0, 3)]); })()`);
  check(`a swatch is what the stage shows: ${swatch}, ${shown}`, swatch.every((code, i) => Math.abs(code - shown[i]) <= 1));

  // The graphics are lost and come back.
  await quiet();
  const radiance = "[...studio.stage.radiance(cameraOf(studio.stageView.view), 64, 36, studio.weights, studio.stageView.environment)]";
  const before = await value(radiance), kept = JSON.stringify(await paint());
  await value("(window.losing = studio.stage.gl.getExtension('WEBGL_lose_context')).loseContext()");
  await browser.until("studio.stageView.lost");
  check("the loss is said", /graphics/.test(await value("document.getElementById('status').textContent")));
  await value("studio.commit({ gloss: 40 })");
  await value("losing.restoreContext()");
  await browser.until("!studio.stageView.lost");
  await value("studio.turn('undo')");
  await quiet();
  const after = await value(radiance), off = Math.max(...before.map((x, i) => Math.abs(x - after[i]) / (1 + x)));
  check("the design is back", JSON.stringify(await paint()) === kept);
  check(`the picture is back: ${off}`, before.some((x) => x > 0) && off <= 1e-6);

  // A link holds the design and how it is seen.
  await value("studio.stageView.turnTo(30)");
  const link = await value("packedText(studio.linked())"), seen = JSON.stringify([await paint(), await view(), await value("studio.stage.turn")]);
  check(`a link is short: ${link.length}`, link.length <= 2000);
  await choose("library", "arctic_white");
  await value("studio.stageView.turnTo(0)");
  await value(`(() => { location.hash = "p=${link}"; })()`);
  await browser.until(`JSON.stringify([studio.paint, studio.stageView.view, studio.stage.turn]) === ${JSON.stringify(seen)}`, 10);

  const usual = await value("studio.data.mesh.view.distance"), other = (members) => value(`(() => { const link = JSON.parse(studio.linked()); Object.assign(link, ${members}); studio.openLink(JSON.stringify(link)); return document.getElementById("status").textContent; })()`);
  await other("{ usual: 1e3 * link.usual, view: { ...link.view, distance: 1e3 * link.view.distance } }");
  check("a link that was made with another mesh shows this one", (await view()).distance === usual);
  check("a link in a light that is not there is told", (await other("{ light: 'moon' }")).includes("the light of the link: moon"));

  // Another tab has a session of its own; both are kept.
  const own = await value("studio.tab");
  await value("(() => { sessionStorage.setItem('paint-studio tab', 'other'); studio.tab = undefined; studio.store(); })()");
  check("two tabs keep two sessions", (await value("studio.kept().map(({ place }) => place.split(' ').pop())")).sort().join() === [own, "other"].sort().join());
  await browser.click("#palette .remove");
  check("a paint leaves the palette", (await value("studio.palette.length")) === 0);

  // A browser that keeps nothing.
  await browser.send("Page.addScriptToEvaluateOnNewDocument", { source: `for (const name of ["localStorage", "sessionStorage"])
    Object.defineProperty(window, name, { get() { throw new DOMException("denied", "SecurityError"); } });` });
  await value("(window.before = true, location.reload())");
  await browser.until("window.before === undefined && window.studio?.paint !== undefined && document.getElementById('loading') === null");
  check("a session that is not kept is told", (await value("document.getElementById('status').textContent")).includes("does not keep this session"));
  await value("studio.commit({ gloss: 40 })");
  check("the page works without", (await steps()) === 1);
  await checkNames();
});
