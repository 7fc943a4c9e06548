// Opens a page in several tabs of one browser: a new one, and a copy of a tab, which has its number. Each edits a paint; all
// sessions stay, and each comes back in its own tab.
//
//   node tabs.js PAGE.html FOLDER
"use strict";
const { check, drive } = require("./drive.js");

drive("every tab has its session", { width: 1000, height: 700 }, async ({ browser, value, quiet }) => {
  await quiet();
  await value("studio.commit({ gloss: 11 })");
  const url = await value("location.href"), open = () => browser.send("Target.createTarget", { url }, null);
  const copy = () => browser.send("Runtime.evaluate", { expression: "void window.open(location.href)", userGesture: true });
  const tabs = [browser], gloss = (tab) => tab.evaluate("studio.paint.gloss[0][1]");
  for (const [number, make] of [open, copy].entries()) {
    const tab = await browser.tab(make);
    await tab.until("window.studio?.paint !== undefined");
    check("a new tab begins with the last session", (await gloss(tab)) === 11);
    await tab.evaluate(`studio.commit({ gloss: ${22 + 11 * number} })`);
    tabs.push(tab);
  }
  const numbers = async () => Promise.all(tabs.map((tab) => tab.evaluate("studio.tab")));
  for (const end = Date.now() + 10000; Date.now() < end && new Set(await numbers()).size < tabs.length;) await new Promise((resolve) => setTimeout(resolve, 50));
  check(`each tab has a number of its own: ${await numbers()}`, new Set(await numbers()).size === tabs.length);
  await value("studio.commit({ gloss: 44 })");  // the first writes after the others
  const held = async () => (await value("studio.kept().map(({ session }) => JSON.parse(session).history.states.at(-1).edit?.gloss)")).sort().join();
  check(`all sessions are kept: ${await held()}`, (await held()) === "22,33,44");
  for (const [i, tab] of tabs.entries()) {
    await tab.evaluate("(window.before = true, location.reload())");
    await tab.until("window.before === undefined && window.studio?.paint !== undefined");
    check(`tab ${i} has its own session again: ${await gloss(tab)}`, (await gloss(tab)) === [44, 22, 33][i]);
  }
  // Another tab removes the session of this one, which writes it again.
  await tabs[1].evaluate("localStorage.removeItem(studio.kept().find(({ session }) => session.includes('\"gloss\":44')).place)");
  await browser.until("studio.kept().some(({ session }) => session.includes('\"gloss\":44'))", 10);
});
