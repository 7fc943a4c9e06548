// Fields and sliders of numbers. Elements are made by script, so that names of paints are text and never markup.

function made(tag, attributes = {}, children = []) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name === "text") element.textContent = value;
    else if (name === "words") element.textContent = words(value);
    else if (name === "aria-label" || name === "title") element.setAttribute(name, words(value));
    else element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}

function drawn(tag, attributes = {}, text = null) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  if (text !== null) element.textContent = text;
  return element;
}

const rounded = (value, digits = 2) => Number(value.toFixed(digits));
const clamped = (value, low, high) => Math.min(high, Math.max(low, value));

// An element that is dragged, by mouse, pen or touch: begin() and move() get the event, end() comes when it is let go.
function draggable(element, { begin, move, end }, button = 0) {
  element.addEventListener("pointerdown", (event) => {
    if (event.button !== button) return;
    event.preventDefault();
    if (element.focus) element.focus({ preventScroll: true });
    element.setPointerCapture(event.pointerId);
    if (begin) begin(event);
    const drag = new AbortController(), signal = drag.signal;
    const done = (next) => {
      if (next.pointerId !== event.pointerId) return;
      drag.abort();
      if (end) end();
    };
    element.addEventListener("pointermove", (next) => next.pointerId === event.pointerId && move(next), { signal });
    element.addEventListener("pointerup", done, { signal });
    element.addEventListener("pointercancel", done, { signal });
  });
}

const flakeNumbers = { "flake size": 0, coverage: 1 }, usualFlakes = [30, 0.5, 0.5];  // micrometers, part of the surface, degrees of spread
const lowest = { L: 0, a: -128, b: -128 }, highest = { L: 150, a: 128, b: 128 };

// The fields of face and flop, and the sliders of travel and gloss. `app` has preview(), commit() and the description.
class NumberControls {
  constructor(app) {
    this.app = app;
    this.fields = {};
    const grid = made("div", { class: "fields" });
    for (const end of ["face", "flop"]) {
      this.fields[end + "-swatch"] = made("span", { class: "swatch", "aria-hidden": "true" });
      grid.append(made("span", {}, [this.fields[end + "-swatch"], " " + words(end)]));
      ["L", "a", "b"].forEach((channel) => {
        const field = made("input", { type: "number", step: "0.5", min: lowest[channel], max: highest[channel],
                                      "aria-label": told`${channel}* of the ${words(end)}`,
                                      onchange: () => this.commitColor(end) });
        this.fields[end + channel] = field;
        grid.append(made("label", {}, [channel + "*", field]));
      });
    }
    this.loss = made("div", { role: "status", id: "screen-loss" });
    const keep = made("input", { type: "checkbox", id: "keep-residual" });
    this.fields.keep = keep;
    document.getElementById("numbers").append(
      grid, this.loss, this.slider("travel", 15.5, 180, 0.5, "°"), this.slider("gloss", 0, 100, 0.5, "GU"),
      made("label", {}, [keep, words("keep what the readings have beside the curve")]), this.brushed(), this.flakes());
    const averages = document.getElementById("averages");
    averages.append(this.slider("lightness", 0, 120, 0.5, ""), this.slider("chroma", 0, 140, 0.5, ""),
                    this.slider("hue", 0, 360, 1, "°"));
  }

  slider(name, low, high, step, unit) {
    const range = made("input", { type: "range", min: low, max: high, step, "aria-label": name,
                                  oninput: () => this.app.preview(this.edit(name, Number(range.value))),
                                  onpointerup: () => setTimeout(() => this.app.abandon(), 100),  // which a slider that ends where it began does not tell by a change
                                  onchange: () => this.app.commit(this.edit(name, Number(range.value)), true) });
    const field = made("input", { type: "number", min: low, max: high, step, "aria-label": name,
                                  onchange: () => this.commitNumber(name, low, high) });
    this.fields[name + "-range"] = range;
    this.fields[name] = field;
    return made("div", { class: "slider" }, [name in notes ? noted(name) : made("span", { words: name }), range, field, unit in notes ? noted(unit) : made("span", { text: unit })]);
  }

  // The widths of a brushed surface, as slopes.
  brushed() {
    ["x", "y"].forEach((axis, i) => {
      const along = i === 0 ? "sideways" : "upward", field = made("input", { type: "number", min: 0, max: 10, step: 0.01, "aria-label": told`width of the highlight ${words(along)}`,
                                                                            onchange: () => this.commitBrushed(i) });
      this.fields["brushed-" + axis] = field;
    });
    return made("div", { class: "row", role: "group", "aria-label": "Brushed surface" },
                [made("span", { words: "brushed" }), made("label", {}, [words("sideways"), this.fields["brushed-x"]]), made("label", {}, [words("upward"), this.fields["brushed-y"]]), made("span", { words: "0 for none" })]);
  }
  // A surface has both widths or none: where the other field has 0, it takes the same width.
  commitBrushed(changed) {
    const alphas = ["x", "y"].map((axis) => this.fields["brushed-" + axis].valueAsNumber), width = alphas[changed];
    const within = clamped(width, 0, 10), other = alphas[1 - changed], both = [within, within];
    if (within > 0 && other > 0) both[1 - changed] = clamped(other, 0, 10);
    if (Number.isFinite(width)) this.app.commit({ anisotropy: both });
    else this.app.show();
    this.show(this.app.description, true);
  }

  // Flakes have a size, a coverage and a spread, or are none. The spread has no slider.
  flakes() {
    this.flakesText = made("span", { class: "hint" });
    this.fields.takeFlakes = made("button", { type: "button", words: "Take away", onclick: () => this.app.commit({ flakes: [0, 0, usualFlakes[2]] }) });
    return made("div", { role: "group", "aria-label": "Flakes" }, [this.slider("flake size", 1, 200, 1, "µm"), this.slider("coverage", 0.01, 1, 0.01, ""),
                                                                   made("div", { class: "row" }, [this.flakesText, this.fields.takeFlakes])]);
  }
  showFlakes({ flakes, class: kind }) {
    this.fields.takeFlakes.disabled = !flakes || flakes.assumed;
    this.flakesText.textContent = !flakes ? words("The paint has no flakes.") : flakes.assumed ? told`Flakes are assumed, as usual in class ${words(kind)}.` : words("The paint states its flakes.");
  }

  // The edit that states one number.
  edit(name, value) {
    if (name in flakeNumbers) return { flakes: (this.app.description.flakes?.values ?? usualFlakes).map((known, i) => (i === flakeNumbers[name] ? value : known)) };
    const edit = { [name]: value };
    if (name === "travel") Object.assign(edit, this.residual());
    if (name === "gloss" && this.app.glossAngle() !== 60) edit["gloss-angle"] = this.app.glossAngle();
    return edit;
  }
  residual() { return this.fields.keep.checked ? { "keep-residual": true } : {}; }

  commitNumber(name, low, high) {
    const value = this.fields[name].valueAsNumber;
    if (Number.isFinite(value)) this.app.commit(this.edit(name, clamped(value, low, high)));
    else this.app.show();
    this.show(this.app.description, true);
  }
  commitColor(end) {
    const lab = ["L", "a", "b"].map((channel) => this.fields[end + channel].valueAsNumber);
    if (lab.every(Number.isFinite)) {
      const within = lab.map((value, i) => clamped(value, lowest["Lab"[i]], highest["Lab"[i]]));
      this.app.commit({ [end]: within, ...this.residual() });
    } else {
      this.app.show();
    }
    this.show(this.app.description, true);
  }

  // How far a medium shows an end off, and a button that takes the nearest color that it shows.
  lossOf(end, { nearest }, said) {
    const color = nearest.map((value) => rounded(value)), [L, a, b] = nearest.map((value) => value.toFixed(1));
    const text = Math.abs(nearest[0] - this.app.description.appearance[end][0]) > 0.05 ? told`take L* ${L}, a* ${a}, b* ${b}` : told`take a* ${a}, b* ${b}`;
    return made("p", { class: "loss" }, [said, " ", made("button", { type: "button", text, onclick: () => this.app.commit({ [end]: color, ...this.residual() }) })]);
  }
  losses({ screen, print }) {
    const off = (medium, say) => (medium ? ["face", "flop"].filter((end) => medium[end].de00 > 1).map((end) => this.lossOf(end, medium[end], say(words(end), medium[end].de00.toFixed(1)))) : []);
    return [...off(screen, (end, de00) => told`The screen shows the ${end} ${de00} (CIEDE2000) off.`), ...off(print, (end, de00) => told`A print by ${print.name} shows the ${end} ${de00} (CIEDE2000) off.`)];
  }

  // Shows the numbers of a paint: in all fields, or in those that nobody is typing in.
  show(description, all = false) {
    const { appearance, average, gloss, flakes } = description;
    const set = (field, value) => {
      if (all || document.activeElement !== field) field.value = value;
    };
    for (const end of ["face", "flop"]) {
      ["L", "a", "b"].forEach((channel, i) => set(this.fields[end + channel], rounded(appearance[end][i])));
      this.fields[end + "-swatch"].style.background = appearance[end + "_css"];
    }
    this.loss.replaceChildren(...this.losses(description));
    const numbers = { travel: appearance.travel, gloss: gloss.length > 0 ? gloss[0].units : 0,
                      lightness: average.L, chroma: average.chroma, hue: average.hue, "flake size": flakes?.values[0], coverage: flakes?.values[1] };
    for (const [name, value] of Object.entries(numbers)) {
      set(this.fields[name], value === undefined ? "" : rounded(value));
      set(this.fields[name + "-range"], value ?? 0);
    }
    this.showFlakes(description);
    ["x", "y"].forEach((axis, i) => set(this.fields["brushed-" + axis], rounded(description.anisotropy[i], 4)));
    const gray = average.chroma < 1e-6;
    for (const name of ["hue", "chroma"]) {
      this.fields[name].disabled = gray;
      this.fields[name + "-range"].disabled = gray;
    }
  }
}
