"use strict";
// Whether a paint is to be shown: its class is checked, its name or code has every word of the search, and each of its indices
// lies within its slider. If a slider reaches from end to end, it also lets pass a paint that does not have the index.
function matches(paint, wanted) {
  if (!wanted.classes.has(paint.class)) return false;
  const text = (paint.name + " " + paint.code).toLowerCase();
  if (!wanted.words.every((word) => text.includes(word))) return false;
  return wanted.ranges.every(({ index, low, high, whole }) =>
    whole || (paint[index] !== null && paint[index] >= low && paint[index] <= high));
}

const byId = (id) => document.getElementById(id);
const all = (selector, root = document) => Array.from(root.querySelectorAll(selector));

const paints = JSON.parse(byId("data").textContent);
const beside = byId("beside") && JSON.parse(byId("beside").textContent);
if (beside) for (const list of all(".tiles")) layOut(list);
const tiles = all(".tiles li");
const sections = all("section").map((section) => {
  const id = section.querySelector("h2, h3").id;
  return { section, heading: section.querySelector(".count"), link: document.querySelector(`nav a[href="#${id}"]`), count: 0 };
});
const places = tiles.map((tile) => sections.filter(({ section }) => section.contains(tile)));
// The tiles of a list in a book with a folder: those behind the first of a group wait until one scrolls to them.
const FIRST = 60, MORE = 120;
const lists = sections.filter(({ section }) => section.matches(".group")).map((section) => ({ section, waiting: [], last: null }));
const listOf = places.map((of) => lists.find(({ section }) => of.includes(section)));
const form = byId("filters");
const search = byId("search");
const card = byId("card");
let visible = [];  // the paints that are shown, in the order of the page

function rangeOf(fieldset) {
  const [low, high] = all("input", fieldset);
  const whole = low.value === low.min && high.value === high.max;
  return { index: fieldset.dataset.index, low: +low.value, high: +high.value, whole };
}

function wantedNow() {
  return {
    classes: new Set(all(".classes input:checked", form).map((box) => box.value)),
    words: search.value.toLowerCase().split(/\s+/).filter(Boolean),
    ranges: all(".range", form).map(rangeOf),
  };
}

function showRanges() {
  for (const fieldset of all(".range", form)) {
    const { low, high, whole } = rangeOf(fieldset);
    const [first] = all("input", fieldset);
    fieldset.querySelector("output").textContent = whole ? "all" : `${low} to ${high}`;
    // If both thumbs are at the far end, the lower one must lie on top, since only it can move.
    first.style.zIndex = low > (+first.min + +first.max) / 2 ? 2 : 1;
  }
}

function filter() {
  const wanted = wantedNow();
  visible = [];
  for (const place of sections) place.count = 0;
  for (const list of lists) list.waiting = [];
  tiles.forEach((tile, number) => {
    const index = +tile.dataset.paint, list = listOf[number], is_match = matches(paints[index], wanted);
    const waits = is_match && beside && list.section.count >= FIRST;
    if (waits) list.waiting.push(tile);
    if (tile.hidden === (is_match && !waits)) tile.hidden = !tile.hidden;
    if (!is_match) return;
    if (!waits) list.last = tile;
    visible.push(index);
    for (const place of places[number]) ++place.count;
  });
  if (beside) for (const list of lists) watchEnd(list);
  for (const { section, heading, link, count } of sections) {
    section.hidden = count === 0;
    heading.textContent = link.querySelector(".count").textContent = count;
    link.classList.toggle("empty", count === 0);
  }
  byId("nothing").hidden = visible.length > 0;
  byId("shown").textContent = `${visible.length} of ${paints.length} paint${paints.length === 1 ? "" : "s"}`;
  showRanges();
}

// A book whose pictures and cards lie beside it: its tiles are empty until they come near the window.
function layOut(list) {
  const fragment = document.createDocumentFragment();
  for (const index of JSON.parse(list.dataset.paints)) {
    const tile = document.createElement("li");
    tile.dataset.paint = index;
    fragment.append(tile);
  }
  list.append(fragment);
}

function element(name, className, ...inside) {
  const made = document.createElement(name);
  made.className = className;
  made.append(...inside);
  return made;
}

// Shows a paint's part of its sheet.
function place(picture, index) {
  const { columns, rows, width, height, left, top, right, down, tile, folder } = beside;
  const cell = index % (columns * rows), sheet = 1 + (index - cell) / (columns * rows);
  const x = left + (cell % columns) * right, y = top + Math.floor(cell / columns) * down;
  picture.style.backgroundImage = `url("${folder}/tiles-${String(sheet).padStart(4, "0")}.png")`;
  picture.style.backgroundSize = `${100 * width / tile[0]}% ${100 * height / tile[1]}%`;
  picture.style.backgroundPosition = `${100 * x / (width - tile[0])}% ${100 * y / (height - tile[1])}%`;
  return picture;
}

function fillTile(tile) {
  const index = +tile.dataset.paint, paint = paints[index];
  const button = element("button", "tile", place(element("span", "picture"), index), element("span", "strip"),
    element("span", "label", paint.name, element("small", "", paint.kind)));
  button.type = "button";
  button.setAttribute("aria-haspopup", "dialog");
  button.querySelector(".strip").style.background = paint.strip;
  button.querySelector(".strip").style.border = paint.border;
  tile.append(button);
}

if (beside) {
  const near = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      if (!isIntersecting) continue;
      near.unobserve(target);
      fillTile(target);
    }
  }, { rootMargin: "300% 0px" });
  for (const tile of tiles) near.observe(tile);
}

// Shows more of a list once its last tile comes near the window from below.
const ends = new IntersectionObserver((entries) => {
  for (const { target, isIntersecting } of entries) {
    const list = isIntersecting && lists.find(({ last }) => last === target);
    if (!list) continue;
    for (const tile of list.waiting.splice(0, MORE)) {
      tile.hidden = false;
      list.last = tile;
    }
    ends.unobserve(target);
    watchEnd(list);
  }
}, { rootMargin: "0px 0px 400% 0px" });
function watchEnd(list) {
  if (list.waiting.length > 0) ends.observe(list.last);
}

// Calls `then` with the card of a paint and its files, once they are there.
const arrived = new Map();  // the cards of each script that was loaded
function cardsArrived(number, cards) {
  arrived.set(number, cards);
}
function withCard(index, then) {
  if (!beside) return then(byId(`card-${index}`).content.cloneNode(true), paints[index].files);
  const number = 1 + Math.floor(index / beside.cards);
  const show = () => {
    const { card: text, files } = arrived.get(number)[index % beside.cards];
    const template = document.createElement("template");
    template.innerHTML = text;
    place(template.content.querySelector(".picture"), index);
    then(template.content, files);
  };
  if (arrived.has(number)) return show();
  const script = document.createElement("script");
  script.src = `${beside.folder}/cards-${String(number).padStart(4, "0")}.js`;
  script.onload = show;
  script.onerror = () => {
    byId("sheet").textContent = `The card is missing: ${beside.folder} must lie beside this page.`;
  };
  document.head.append(script);
}

// A thumb that is moved past the other one takes it along.
form.addEventListener("input", (event) => {
  const fieldset = event.target.closest(".range");
  if (fieldset) {
    const [low, high] = all("input", fieldset);
    if (+low.value > +high.value) (event.target === low ? high : low).value = event.target.value;
  }
  filter();
});
form.addEventListener("submit", (event) => event.preventDefault());
form.addEventListener("reset", () => {
  search.value = "";
  setTimeout(filter);
});
search.addEventListener("input", filter);
byId("again").addEventListener("click", () => {
  form.reset();
  search.focus();
});

// The card of a paint.
let opened = -1;

function download(name, type, text) {
  const link = document.createElement("a");
  link.href = `data:${type};charset=utf-8,${encodeURIComponent(text)}`;
  link.download = name;
  link.textContent = { xml: "XML", csv: "CSV", cxf: "CxF" }[name.slice(name.lastIndexOf(".") + 1)];
  link.setAttribute("aria-label", `Download ${name}`);
  return link;
}

function fill(index) {
  opened = index;
  const paint = paints[index];
  const sheet = byId("sheet");
  withCard(index, (content, files) => {
    if (opened !== index) return;  // another one was opened since
    sheet.replaceChildren(content);
    const picture = sheet.querySelector("img");
    if (picture) picture.src = document.querySelector(`li[data-paint="${index}"] img`).src;
    const downloads = sheet.querySelector(".downloads");
    for (const { name, type, text } of files) downloads.append(download(name, type, text));
    sheet.scrollTop = 0;
  });
  const place = visible.indexOf(index);
  byId("place").textContent = place < 0 ? "" : `${place + 1} of ${visible.length}`;
  byId("previous").disabled = place <= 0;
  byId("next").disabled = place < 0 || place === visible.length - 1;
  history.replaceState(null, "", `#paint=${encodeURIComponent(paint.name)}`);
}

function open(index) {
  fill(index);
  if (!card.open) card.showModal();
  byId("sheet").focus({ preventScroll: true });
}

function step(by) {
  const place = visible.indexOf(opened) + by;
  if (visible.includes(opened) && place >= 0 && place < visible.length) fill(visible[place]);
}

byId("book").addEventListener("click", (event) => {
  const tile = event.target.closest(".tile");
  if (tile) open(+tile.parentElement.dataset.paint);
});
byId("previous").addEventListener("click", () => step(-1));
byId("next").addEventListener("click", () => step(1));
byId("close").addEventListener("click", () => card.close());
card.addEventListener("click", (event) => {
  if (event.target === card) card.close();
});
card.addEventListener("keydown", (event) => {
  if (event.key === "ArrowLeft") step(-1);
  else if (event.key === "ArrowRight") step(1);
});
card.addEventListener("close", () => {
  history.replaceState(null, "", location.pathname + location.search);
  const tile = document.querySelector(`li[data-paint="${opened}"] .tile`);
  if (tile) tile.focus();
});

// On a narrow screen the filters are closed at first, so that the paints come first.
if (matchMedia("(max-width: 760px)").matches) byId("tools").open = false;
filter();
const named = /^#paint=(.*)$/.exec(location.hash);
const asked = named ? paints.findIndex((paint) => paint.name === decodeURIComponent(named[1])) : -1;
if (asked >= 0) open(asked);
