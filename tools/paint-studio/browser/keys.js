// Goes through a page by the keyboard alone: every control is reached by Tab, in the window and with its focus visible, and a paint
// is chosen, edited, turned, kept and saved.
//
//   keys.js PAGE.html FOLDER
"use strict";
const { check, drive } = require("./drive.js");

drive("the keyboard is enough", { width: 1000, height: 700 }, async ({ browser, folder, value, shot, quiet }) => {
  await quiet();
  const focused = () => value(`(() => {
    const one = document.activeElement, box = one.getBoundingClientRect(), style = getComputedStyle(one);
    window.places ??= new Map();
    if (!places.has(one)) places.set(one, places.size);
    return { number: places.get(one), name: one.id || one.getAttribute("aria-label") || one.textContent.trim().slice(0, 30), body: one === document.body,
             inside: box.bottom > 0 && box.top < innerHeight && box.right > 0 && box.left < innerWidth,
             seen: one.matches(":focus-visible") && ((style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 2) || parseFloat(style.strokeWidth) >= 4) }; })()`);
  const tabTo = async (selector) => {
    for (let i = 0; i < 200; ++i) {
      if (await value(`document.activeElement.matches(${JSON.stringify(selector)})`)) return;
      await browser.key("Tab");
    }
    check(`Tab comes to ${selector}`, false);
  };
  await value("document.activeElement.blur()");
  const met = [];
  for (let i = 0; i < 400; ++i) {
    await browser.key("Tab");
    const one = await focused();
    if (one.body || met.some(({ number }) => number === one.number)) break;
    met.push(one);
    if (i === 3) await shot("keys-focus");
  }
  for (const one of met) check(`the focus on ${one.name} is seen: ${JSON.stringify(one)}`, one.inside && one.seen);
  const missed = await value(`[...document.querySelectorAll("button, input, select, textarea, summary, [tabindex='0']")].filter((one) =>
    one.checkVisibility() && !one.disabled && one.tabIndex >= 0 && one.type !== "radio" && one.type !== "file" && !places.has(one)).map((one) => one.outerHTML.slice(0, 80))`);
  check(`Tab comes to every control: ${missed.join(" ")}`, met.length > 40 && missed.length === 0);

  const name = () => value("studio.paint.name"), first = await name();
  await value("document.activeElement.blur()");
  await tabTo("#library");
  await browser.key("ArrowDown");
  check("another paint is chosen", (await name()) !== first);
  await tabTo("#stage");
  const azimuth = await value("studio.stageView.view.azimuth");
  await browser.key("ArrowRight");
  check("the camera goes around", (await value("studio.stageView.view.azimuth")) !== azimuth);
  await tabTo("#wheel .handle");
  const face = JSON.stringify(await value("studio.description.appearance"));
  await browser.key("ArrowRight");
  check("the wheel is moved", JSON.stringify(await value("studio.description.appearance")) !== face);
  await tabTo("#numbers input[type=range][aria-label=gloss]");
  for (let i = 0; i < 5; ++i) await browser.key("ArrowLeft");
  check("the slider is moved", (await value("studio.history.now.steps.length")) === 2);
  await browser.key("z", 2);
  check("a step is undone", (await value("studio.history.now.steps.length")) === 1);
  await tabTo("#keep");
  await browser.key("Enter");
  check("the paint is kept", (await value("studio.palette.length")) === 1);
  await tabTo("#save-xml");
  await browser.key("Enter");
  check("the paint is saved", (await browser.download(`${await value("fileName(studio.paint.name)")}.paints.xml`)).includes("<paint "));
});
