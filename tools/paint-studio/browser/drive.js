// Parts that the scripts share that drive a page: they open it, note what does not hold, and end with what was wrong.
"use strict";
const path = require("node:path");
const { pathToFileURL } = require("node:url");
const { Browser } = require("./browser.js");

const problems = [];
function check(what, holds) {
  if (!holds) problems.push(what);
}

// The functions by which a script acts on a page.
function handles(browser, folder) {
  const value = (expression) => browser.evaluate(expression);
  return {
    browser, folder, value, shot: (name) => browser.screenshot(path.join(folder, name + ".png")),
    // Waits until all pictures are drawn, and shadows are found.
    quiet: (seconds) => browser.until("studio.tiles.waiting.length === 0 && studio.tiles.timer === undefined && !studio.stage.occlusion.busy && studio.stageView.drawing === undefined && studio.stageView.sharp", seconds),
    status: () => value("document.getElementById('status').textContent"),
    // Takes the entry of a list that has this text, or, with `part`, that contains it.
    choose: (id, text, part = false) => value(`(() => { const list = document.getElementById("${id}"), text = ${JSON.stringify(text)};
      list.value = [...list.options].find((one) => ${part ? "one.textContent.includes(text)" : "one.textContent === text"}).value;
      list.dispatchEvent(new Event("change")); })()`),
    fill: (id, number) => value(`(() => { const field = document.getElementById("${id}"); field.value = ${number};
      field.dispatchEvent(new Event("change")); })()`),
    // Gives files to a field that opens them.
    give: async (selector, files) => {
      const { root } = await browser.send("DOM.getDocument");
      const { nodeId } = await browser.send("DOM.querySelector", { nodeId: root.nodeId, selector });
      await browser.send("DOM.setFileInputFiles", { nodeId, files: files.map((file) => path.resolve(file)) });
    },
    checkNames: async () => {
      const unnamed = await value(`[...document.querySelectorAll("button, input, select, [role=slider]")].filter((one) =>
        !(one.getAttribute("aria-label") || one.textContent.trim() || one.labels?.length)).map((one) => one.outerHTML)`);
      check("every control has a name: " + unnamed.join(" "), unnamed.length === 0);
    },
  };
}

// Opens the page that the command line names, runs the script on it, and ends the process: with status 1 where something
// did not hold or the page wrote an error.
async function drive(wellDone, window, script) {
  try {
    const [page, folder, ...more] = process.argv.slice(2);
    const browser = await Browser.open(pathToFileURL(path.resolve(page)).href, window);
    await browser.until("window.studio !== undefined || document.getElementById('status').textContent !== ''");
    await script(handles(browser, folder), ...more);
    await browser.close();
    problems.push(...browser.problems);
  } catch (error) {
    console.error(error.stack);
    process.exit(1);
  }
  for (const problem of problems) console.log("wrong: " + problem);
  console.log(problems.length === 0 ? wellDone : `${problems.length} things are wrong`);
  process.exit(problems.length === 0 ? 0 : 1);
}

module.exports = { check, drive };
