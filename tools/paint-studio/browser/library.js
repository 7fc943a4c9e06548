// Opens a page with many paints: how long that takes, what memory it needs, and how long filters and the cloud take.
// Prints the figures as JSON; a filter's time is the least of five runs, and filter_ms the largest of these. Goes through the list by mouse and keyboard.
//
//   node library.js PAGE.html FOLDER
"use strict";
const { check, drive } = require("./drive.js");

drive("the library answers", { width: 1000, height: 700 }, async ({ browser, value, shot, quiet }) => {
  const open_ms = await value("studioOpened_ms");
  await quiet();
  await browser.send("HeapProfiler.collectGarbage");
  const memory = await value("({ heap_mb: performance.memory.usedJSHeapSize / 1e6, compiled_mb: studio.engine.bytes() / 1e6 })");
  const best = "Math.min(...[1, 2, 3, 4, 5].map(() => (studio.panel.filter(), studio.panel.filter_ms)))";
  const type = (text) => value(`(() => { const field = document.getElementById("search"); field.value = ${JSON.stringify(text)}; field.dispatchEvent(new Event("input")); return ${best}; })()`);
  const times = [];
  const count = await value("studio.library.count"), name = await value(`studio.library.paint(${count} - 1).name`);
  for (const text of ["1", "12", "p", "zzzz", name.toUpperCase()]) times.push(await type(text));
  check("the search finds a paint by its name, whatever its case", (await value("studio.panel.places.includes(studio.library.count - 1)")));
  await type("");
  check("without a word all paints are there", (await value("studio.panel.places.length")) === count);
  times.push(await value(`(() => { const field = document.querySelector("#filters input[data-metric=flop_index][data-side=low]"); field.value = 8; field.dispatchEvent(new Event("input", { bubbles: true })); return ${best}; })()`));
  const passing = await value("studio.panel.places.length");
  check("a filter leaves some paints out", passing > 0 && passing < count);
  times.push(await value(`(() => { const list = document.getElementById("order"); list.value = "flop_index"; list.dispatchEvent(new Event("change")); return ${best}; })()`));
  // Few rows are elements, wherever the list is scrolled to.
  await value("studio.panel.list.scrollIntoView({ block: 'center' })");
  await value("studio.panel.list.focus()");
  await browser.key("End");
  await browser.until("document.querySelector('.paint-row[aria-selected=true]') !== null");
  check("the last paint is chosen", (await value("document.querySelector('.paint-row[aria-selected=true]').getAttribute('aria-posinset')")) === String(passing));
  check("few rows are elements", (await value("document.querySelectorAll('.paint-row').length")) < 40);
  await shot("library-1");
  const chosen = await value("studio.panel.place");
  await browser.click("#chosen button:nth-of-type(1)");
  check("the design starts from the chosen paint", (await value("studio.history.now.start")) === chosen);
  await value("studio.panel.list.focus()");  // else the key scrolls the panel, which moves while it is clicked
  await browser.key("Home");
  check("the first paint is chosen", (await value("studio.panel.current")) === 0);
  await value("studio.panel.list.scrollIntoView({ block: 'center' })");
  await browser.click(".paint-row:nth-child(3)");
  await browser.click("#chosen button:nth-of-type(2)");
  check("the design is compared with the chosen paint", (await value("studio.compared.choice")).startsWith("library "));
  // The cloud at another angle; it turns by the keyboard, and a click on a point chooses its paint.
  const cloud_ms = await value(`(async () => { document.getElementById("cloud-shown").open = true; await new Promise((resolve) => setTimeout(resolve, 300));
    const begin = performance.now(), list = document.getElementById("cloud-angle"); list.selectedIndex = list.options.length > 2 ? 2 : 0; list.dispatchEvent(new Event("change")); return performance.now() - begin; })()`);
  const turn_ms = await value("(() => { const begin = performance.now(); studio.cloud.turn += 10; studio.cloud.draw(); return performance.now() - begin; })()");
  check("the cloud holds paints", (await value("studio.cloud.paints.length")) > 0);
  await value("studio.cloud.canvas.scrollIntoView({ block: 'center' })");
  await value("studio.cloud.canvas.focus()");
  const turn = await value("studio.cloud.turn");
  await browser.key("ArrowLeft");
  check("an arrow key turns the cloud", (await value("studio.cloud.turn")) === turn + 5);
  await value(`(() => { const field = document.querySelector("#filters input[data-metric=flop_index][data-side=low]"); field.value = ""; field.dispatchEvent(new Event("input", { bubbles: true })); })()`);
  // The filter and the layout after it come later on a busy machine: the point must stand still.
  let point, before;
  do {
    before = point;
    await new Promise((resolve) => setTimeout(resolve, 300));
    point = await value(`(() => { const { cloud } = studio, box = cloud.canvas.getBoundingClientRect(), at = cloud.projector();
    const [x, y] = at(cloud.points[0], cloud.points[1], cloud.points[2]);
    return { x: box.left + (x / cloud.canvas.width) * box.width, y: box.top + (y / cloud.canvas.height) * box.height }; })()`);
  } while (point.x !== before?.x || point.y !== before?.y);
  await browser.mouseDrag(point, point, 1);
  check("a click on a point chooses a paint", (await value("studio.cloud.paints.includes(studio.panel.place)")));
  await shot("library-2");
  console.log(JSON.stringify({ open_ms, ...memory, filter_ms: Math.max(...times), cloud_ms, turn_ms, count }));
});
