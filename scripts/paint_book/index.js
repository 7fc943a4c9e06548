"use strict";
// The index of a book of several pages: a search by name and code over all of them.
const MOST = 200;  // paints that are listed
const byId = (id) => document.getElementById(id);

const pages = JSON.parse(byId("data").textContent);
// Each paint with its page, and what it is found by.
const rows = pages.flatMap(({ paints }, page) => paints.map(([name, code, kind, colors]) => ({ name, code, kind, colors, page })));
const keys = rows.map(({ name, code }) => `${name} ${code}`.toLowerCase());

// The first paints whose name or code has every word, and how many there are.
function found(words) {
  const list = [];
  let count = 0;
  for (let i = 0; i < keys.length; ++i) {
    if (!words.every((word) => keys[i].includes(word))) continue;
    if (list.length < MOST) list.push(rows[i]);
    ++count;
  }
  return { list, count };
}

function item({ name, code, kind, colors, page }) {
  const made = document.createElement("li"), link = document.createElement("a"), strip = document.createElement("span");
  const small = document.createElement("small");
  link.href = `${pages[page].page}#paint=${encodeURIComponent(name)}`;
  strip.className = "strip";
  strip.style.background = `linear-gradient(90deg,${colors.match(/#[0-9a-f]{6}/g).join(",")})`;
  small.textContent = [code && `code ${code}`, kind, `page ${page + 1}`].filter(Boolean).join(", ");
  link.append(name, strip, small);
  made.append(link);
  return made;
}

function search() {
  const words = byId("search").value.toLowerCase().split(/\s+/).filter(Boolean);
  const is_asked = words.length > 0;
  byId("found").hidden = !is_asked;
  byId("pages").hidden = is_asked;
  if (!is_asked) {
    byId("shown").textContent = `${rows.length} paints on ${pages.length} pages`;
    return;
  }
  const { list, count } = found(words);
  byId("found").replaceChildren(...list.map(item));
  byId("shown").textContent = `${count} of ${rows.length} paints${count > list.length ? `, of which ${list.length} are listed` : ""}`;
}

byId("search").addEventListener("input", search);
search();
