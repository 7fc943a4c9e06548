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
const tiles = all(".tiles li");
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
  for (const tile of tiles) {
    const index = +tile.dataset.paint;
    tile.hidden = !matches(paints[index], wanted);
    if (!tile.hidden) visible.push(index);
  }
  for (const section of all("section")) {
    const count = all(".tiles li:not([hidden])", section).length;
    section.hidden = count === 0;
    section.querySelector(".count").textContent = count;
    const link = document.querySelector(`nav a[href="#${section.querySelector("h2, h3").id}"]`);
    link.querySelector(".count").textContent = count;
    link.classList.toggle("empty", count === 0);
  }
  byId("nothing").hidden = visible.length > 0;
  byId("shown").textContent = `${visible.length} of ${paints.length} paint${paints.length === 1 ? "" : "s"}`;
  showRanges();
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
  sheet.replaceChildren(byId(`card-${index}`).content.cloneNode(true));
  sheet.querySelector("img").src = document.querySelector(`li[data-paint="${index}"] img`).src;
  const downloads = sheet.querySelector(".downloads");
  for (const { name, type, text } of paint.files) downloads.append(download(name, type, text));
  sheet.scrollTop = 0;
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
