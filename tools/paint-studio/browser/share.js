// The script holds what a page says and gives away: its texts in two languages by one table, notes of words, the tour, the card of one
// sheet and the film of a turn.
//
//   share.js PAGE.html FOLDER PAGE.HTML-SOURCE
"use strict";
const fs = require("node:fs");
const path = require("node:path");
const { check, drive } = require("./drive.js");
const { german, tourSteps, notes: explained } = require("../page/texts.js");

// Texts and labels that stand in the source of the page.
function textsOf(source) {
  const body = source.slice(source.indexOf("<body>"), source.indexOf('<script type="application/json"'));
  const texts = [...body.matchAll(/>([^<>@]+)</g), ...body.matchAll(/(?:title|aria-label|placeholder)="([^"]+)"/g)].map(([, text]) => text.replace(/\s+/g, " ").trim());
  return texts.filter((text) => /[A-Za-z]{3}/.test(text) && !["English", "Deutsch"].includes(text));
}

// Sentences that the scripts tell and do not look up.
function toldPlainly(folder) {
  return fs.readdirSync(folder).filter((name) => name.endsWith(".js")).flatMap((name) => [...fs.readFileSync(path.join(folder, name), "utf8").matchAll(/\b(?:say|Error)\((?:"[A-Z]|`).{0,60}/g)].map(([text]) => text));
}

// Texts that the scripts look up in the table: words("..."), words: "..." and told`...`, whose values become {}.
function lookedUp(folder) {
  return fs.readdirSync(folder).filter((name) => name.endsWith(".js") && name !== "texts.js").flatMap((name) => {
    const script = fs.readFileSync(path.join(folder, name), "utf8"), plain = [...script.matchAll(/\bwords(?:\(|: )"([^"]+)"/g)].map(([, text]) => text);
    const filled = [...script.matchAll(/\btold`([^`]*)`/g)].map(([, text]) => {
      let depth = 0, key = "";
      for (const c of text.replaceAll("${", "\u0001")) {
        if (c === "\u0001" && depth++ === 0) key += "{}";
        else if (c === "}" && depth > 0) --depth;
        else if (c !== "\u0001" && depth === 0) key += c;
      }
      return key;
    });
    return [...plain, ...filled];
  });
}

drive("the page speaks and gives away", { width: 1000, height: 700 }, async ({ browser, folder, value, shot, quiet, choose, fill, give, checkNames }, source) => {
  const texts = textsOf(fs.readFileSync(source, "utf8")), ofScripts = lookedUp(path.dirname(source)), missing = [...texts, ...ofScripts, ...tourSteps.map(([, text]) => text), ...Object.values(explained)].filter((text) => !(text in german));
  check(`every text is in the table: ${missing.join(" | ")}`, texts.length > 80 && ofScripts.length > 50 && missing.length === 0);
  const plain = toldPlainly(path.dirname(source));
  check(`every message is looked up: ${plain.join(" | ")}`, plain.length === 0);
  await quiet();
  check("the tour is offered once", /tour/i.test(await value("document.getElementById('status').textContent")));

  // The tour leads through the page; each step has the focus.
  await browser.click("#begin-tour");
  for (let i = 0; i < tourSteps.length; ++i) {
    check(`step ${i} of the tour stands in the window`, await value(`(() => { const box = document.getElementById("tour").getBoundingClientRect(); return !document.getElementById("tour").hidden && box.left >= 0 && box.right <= innerWidth && box.bottom <= innerHeight && document.querySelector(".toured") !== null; })()`));
    if (i === 1) await shot("share-tour");
    await value("document.querySelector('#tour button').click()");
  }
  check("the tour ends", await value("document.getElementById('tour').hidden && document.querySelector('.toured') === null"));

  // Words of the field have notes that the focus shows.
  await value("document.querySelector('abbr').focus()");
  check("a note is shown", (await value("getComputedStyle(document.querySelector('abbr'), '::after').content")).length > 30);
  check("four words have notes", (await value("new Set([...document.querySelectorAll('abbr')].map((one) => one.textContent)).size")) === 4);

  // The card of one sheet.
  await choose("library", "candy_red");
  const notes = "for the spring line -- two coats";
  await fill("notes", JSON.stringify(notes));
  await quiet();
  await value("studio.card.fill()");
  const card = await value(`(() => { const { description } = studio, chips = [...document.querySelectorAll("#card .chip")].map((one) => one.style.background);
    const rgb = (css) => Object.assign(document.createElement("i").style, { background: css }).background;
    return { chips, wanted: [description.appearance.face_css, ...chipAngles.map((angle) => studio.engine.ask({ do: "at", paint: studio.paint, angle }).css), description.appearance.flop_css].map(rgb), text: document.getElementById("card").textContent }; })()`);
  check(`the chips are right: ${card.chips}`, card.chips.length === 7 && card.chips.join() === card.wanted.join());
  check("the card has name, notes and command", ["candy_red", "for the spring line", "fit-paint"].every((text) => card.text.includes(text)));
  // Notes and code are in the file, which gives them back.
  await fill("paint-code", JSON.stringify("S-17"));
  await browser.click("#save-xml");
  const saved = await browser.download("candy_red.paints.xml");
  check("paint XML has code and notes", saved.includes('code="S-17"') && saved.includes("<!-- Notes: for the spring line &#45;&#45; two coats -->"));
  await fill("notes", JSON.stringify(""));
  fs.writeFileSync(path.join(folder, "noted.paints.xml"), saved);
  await give("#open-files", [path.join(folder, "noted.paints.xml")]);
  await browser.until("studio.history.now.own?.file === 'noted.paints.xml'", 10);
  check("an opened file has them too", (await value("[studio.paint.code, document.getElementById('notes').value].join()")) === `S-17,${notes}`);
  await choose("library", "candy_red");
  await quiet();
  const { data } = await browser.send("Page.printToPDF", { preferCSSPageSize: true, printBackground: true }), pdf = Buffer.from(data, "base64");
  fs.writeFileSync(path.join(folder, "card.pdf"), pdf);
  check("the card is one sheet of A4", (pdf.toString("latin1").match(/\/Type\s*\/Page\b/g) ?? []).length === 1 && /\/MediaBox\s*\[0 0 59[45][^ ]* 84[12]/.test(pdf.toString("latin1")));

  // A turn as a film.
  await value("document.getElementById('film').click()");
  await browser.until("/saved/.test(document.getElementById('status').textContent)", 120);
  await browser.download("candy_red.webm");
  const film = fs.readFileSync(path.join(browser.folder, "candy_red.webm"));
  check(`the film is WebM: ${film.length}`, film.readUInt32BE(0) === 0x1a45dfa3 && film.length > 20000);

  // German, and back.
  await value("(() => { const list = document.getElementById('language'); list.value = 'de'; list.dispatchEvent(new Event('change')); })()");
  await new Promise((resolve) => setTimeout(resolve, 500));
  await browser.until("window.studio !== undefined && document.documentElement.lang === 'de'");
  await quiet();
  check("the notes are kept", (await value("document.getElementById('notes').value")) === notes);
  const shown = await value("document.body.innerText"), english = [...texts, ...ofScripts].filter((text) => text.length > 12 && german[text] !== text && shown.includes(text));
  check(`no English text is left: ${english.join(" | ")}`, english.length === 0 && shown.includes("Nächste Lacke"));
  check("classes keep their values", (await value("document.getElementById('paint-class').options[2].value")) === "metallic");
  await shot("share-german");
  await checkNames();
});
