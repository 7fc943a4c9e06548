// The library of the page. Its paints stand in one text, a line for each, and become objects when they are asked for.

class PaintStore {
  constructor(text, layouts) {
    this.text = text;
    this.layouts = layouts;
    const ends = [];
    for (let at = text.indexOf("\n"); at >= 0; at = text.indexOf("\n", at + 1)) ends.push(at);
    this.ends = Uint32Array.from([...ends, text.length]);
  }
  get count() { return this.ends.length; }

  // {file, paint} of a paint.
  at(number) {
    const line = JSON.parse(this.text.slice(number > 0 ? this.ends[number - 1] + 1 : 0, this.ends[number]));
    if (!Array.isArray(line)) return line;
    const [layout, name, code, kind, ...values] = line, { file, rows, gloss, ...measurement } = this.layouts[layout];
    const paint = { name, ...(code && { code }), ...(kind && { class: kind }) };
    paint.measurement = { ...measurement, rows: rows.map((geometry, i) => ({ geometry, lab: values.slice(3 * i, 3 * i + 3) })) };
    if (gloss.length > 0) paint.gloss = gloss.map((angle, i) => [angle, values[3 * rows.length + i]]);
    return { file, paint };
  }
  paint(number) { return this.at(number).paint; }
}

const metricNames = { flop_index: "flop index", chroma_index: "chroma index", hue_shift_index: "hue shift index", gloss: "gloss", L15: "lightness of the face", chroma15: "chroma of the face" };
const rowHeight = 30;  // pixels of the window, as in page.css

// A list of all paints that pass a filter, of which only the rows in sight are elements.
class LibraryPanel {
  constructor(app) {
    this.app = app;
    this.places = [];
    this.current = 0;  // row of the list that the keyboard is at
    this.list = document.getElementById("paint-list");
    this.space = made("div", { class: "space", role: "presentation" });
    this.list.append(this.space);
    const form = document.getElementById("filters");
    for (const [name, text] of Object.entries(metricNames)) {
      const field = (side) => made("input", { type: "number", step: "any", "data-metric": name, "data-side": side, "aria-label": `${words(side === "low" ? "lowest" : "highest")} ${words(text)}` });
      form.append(made("div", { class: "range" }, [made("span", { words: text }), field("low"), made("span", { words: "to" }), field("high")]));
    }
    const order = document.getElementById("order");
    order.append(made("option", { value: "", words: "the library's order" }), ...Object.entries(metricNames).map(([value, text]) => made("option", { value, words: text })));
    document.getElementById("search").addEventListener("input", () => this.filter());
    for (const element of [order, document.getElementById("paint-class")]) element.addEventListener("change", () => this.filter());
    form.addEventListener("input", () => this.filter());
    this.list.addEventListener("scroll", () => this.scrollTo(this.list.scrollTop));
    this.list.addEventListener("keydown", (event) => this.key(event));
    this.top = 0;  // how far the list is scrolled; to ask for it lays out the page
    this.height = 0;
    new ResizeObserver(() => {
      this.height = this.list.clientHeight;
      this.showRows();
    }).observe(this.list);
    this.filter();
  }

  filter() {
    const begin = performance.now(), kind = document.getElementById("paint-class").value, order = document.getElementById("order").value;
    const ranges = {};
    document.querySelectorAll("#filters input[data-metric]").forEach((field) => {
      if (Number.isFinite(field.valueAsNumber)) (ranges[field.dataset.metric] ??= { metric: field.dataset.metric })[field.dataset.side] = field.valueAsNumber;
    });
    const request = { do: "filter", text: document.getElementById("search").value, classes: kind ? [kind] : [], ranges: Object.values(ranges), ...(order && { order }) };
    if (this.app.attempt(() => this.app.engine.ask(request)) === undefined) return;
    this.places = this.app.engine.list("filtered");
    this.current = 0;
    if (this.top > 0) this.list.scrollTop = this.top = 0;
    this.space.style.height = `${rowHeight * this.places.length}px`;
    document.getElementById("paint-count").textContent = told`${this.places.length} of ${this.app.library.count} paints`;
    this.showRows();
    this.filter_ms = performance.now() - begin;
  }

  scrollTo(top) {
    this.top = top;
    this.showRows();
  }
  showRows() {
    const first = Math.floor(this.top / rowHeight), count = Math.ceil(this.height / rowHeight) + 1, places = [...this.places.slice(first, first + count)];
    const rows = places.length > 0 ? this.app.engine.ask({ do: "rows", places }).list : [];
    this.space.replaceChildren(...rows.map(({ name, code, colors }, i) => {
      const chip = made("span", { class: "chip", "aria-hidden": "true" }), place = places[i], row = first + i;
      chip.style.background = colors.length > 1 ? `linear-gradient(90deg, ${colors.join(", ")})` : colors[0] ?? "none";
      const element = made("div", { class: "paint-row", role: "option", id: `paint-row-${row}`, "aria-selected": row === this.current, "aria-setsize": this.places.length, "aria-posinset": row + 1,
                                    onclick: () => this.choose(row) },
                           [chip, made("span", { class: "name", text: name }), made("span", { class: "code", text: code })]);
      element.dataset.place = place;
      element.style.top = `${rowHeight * row}px`;
      return element;
    }));
    this.list.setAttribute("aria-activedescendant", `paint-row-${this.current}`);
  }
  choose(row) {
    this.current = row;
    this.showRows();
    this.showChosen();
  }
  get place() { return this.places[this.current]; }
  showChosen() {
    const chosen = document.getElementById("chosen"), place = this.place;
    if (place === undefined) return;
    const { paint } = this.app.library.at(place);
    chosen.replaceChildren(made("span", { text: paint.name + (paint.code ? `, ${paint.code}` : "") }),
                           made("button", { type: "button", words: "Start from this paint", onclick: () => this.app.start(place) }),
                           made("button", { type: "button", words: "Compare with it", onclick: () => this.app.compareWith(place) }));
  }
  key(event) {
    const page = Math.max(1, Math.floor(this.list.clientHeight / rowHeight) - 1), step = { ArrowUp: -1, ArrowDown: 1, PageUp: -page, PageDown: page, Home: -Infinity, End: Infinity }[event.key];
    if (event.key === "Enter" && this.place !== undefined) this.app.start(this.place);
    else if (step === undefined || this.places.length === 0) return;
    else {
      const row = clamped(this.current + step, 0, this.places.length - 1), top = rowHeight * row;
      this.list.scrollTop = this.top = clamped(this.top, top + rowHeight - this.height, top);
      this.choose(row);
    }
    event.preventDefault();
  }
}

// All paints as points in L*a*b* at one angle, and the design among them. [Shimizu2009] figures 5.9 to 5.11
class Cloud {
  constructor(app) {
    this.app = app;
    this.canvas = document.getElementById("cloud");
    this.turn = 30;
    this.tilt = 25;
    const list = document.getElementById("cloud-angle");
    list.append(...app.geometries.map(({ geometry, angle }) => made("option", { value: geometry, "data-angle": angle, text: `${rounded(angle, 1)}° (${geometry})` })));
    list.addEventListener("change", () => this.load());
    document.getElementById("cloud-shown").addEventListener("toggle", () => this.load());
    let from = null;
    draggable(this.canvas, {
      begin: (event) => { from = { x: event.clientX, y: event.clientY, turn: this.turn, tilt: this.tilt, moved: false }; },
      move: (event) => {
        from.moved ||= Math.hypot(event.clientX - from.x, event.clientY - from.y) > 4;
        this.look(from.turn - 0.5 * (event.clientX - from.x), from.tilt + 0.5 * (event.clientY - from.y));
      },
      end: () => { if (!from.moved) this.pick(from.x, from.y); },
    });
    this.canvas.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: [5, 0], ArrowRight: [-5, 0], ArrowUp: [0, -5], ArrowDown: [0, 5] }[event.key];
      if (!step) return;
      event.preventDefault();
      this.look(this.turn + step[0], this.tilt + step[1]);
    });
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }
  get open() { return document.getElementById("cloud-shown").open && this.app.geometries.length > 0; }

  load(anew = false) {
    if (anew) this.geometry = null;
    if (!this.open) return;
    const geometry = document.getElementById("cloud-angle").value;
    if (this.geometry !== geometry) {
      this.app.engine.ask({ do: "cloud", geometry });
      this.geometry = geometry;
      this.points = this.app.engine.list("cloud");
      this.colors = this.app.engine.list("cloudColors");
      this.paints = this.app.engine.list("cloudPaints");
    }
    this.show();
  }
  // The design's own color at that angle, after the paint changed.
  show() {
    if (!this.open || !this.points) return;
    const angle = Number(document.getElementById("cloud-angle").selectedOptions[0].dataset.angle);
    const found = this.app.attempt(() => this.app.engine.ask({ do: "at", paint: this.app.paint, angle }));
    this.design = found ? found : null;
    if (found) document.getElementById("cloud-text").textContent = told`The design, with the cross, has L* ${found.lab[0].toFixed(1)}, a* ${found.lab[1].toFixed(1)}, b* ${found.lab[2].toFixed(1)} there, among ${this.paints.length} paints.`;
    this.draw();
  }
  look(turn, tilt) {
    this.turn = turn;
    this.tilt = clamped(tilt, -90, 90);
    cancelAnimationFrame(this.drawing);
    this.drawing = requestAnimationFrame(() => this.draw());
  }
  // Where a color stands in the picture: right and down in pixels, and how near it is.
  projector() {
    const { width, height } = this.canvas, scale = Math.min(width, height) / 240;
    const t = (this.turn * Math.PI) / 180, e = (this.tilt * Math.PI) / 180, c = Math.cos(t), s = Math.sin(t), ce = Math.cos(e), se = Math.sin(e);
    return (L, a, b) => {
      const x = c * a - s * b, y = s * a + c * b, z = 1.6 * (L - 50);
      return [width / 2 + scale * x, height / 2 - scale * (ce * z + se * y), se * z - ce * y];
    };
  }
  draw() {
    if (!this.open || !this.points) return;
    const ratio = Math.min(window.devicePixelRatio || 1, 2), width = Math.max(16, Math.round(this.canvas.clientWidth * ratio)), height = Math.max(16, Math.round(this.canvas.clientHeight * ratio));
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    const context = this.canvas.getContext("2d", { colorSpace: "display-p3" }), at = this.projector(), image = context.createImageData(width, height, { colorSpace: this.app.stage.screen });
    const pixels = new Uint32Array(image.data.buffer), depth = new Float32Array(width * height).fill(-Infinity), { points, colors } = this;
    const size = this.paints.length > 20000 ? 1 : 3;
    for (let i = 0; i < colors.length; ++i) {
      const [x, y, near] = at(points[3 * i], points[3 * i + 1], points[3 * i + 2]), left = Math.round(x) - (size >> 1), top = Math.round(y) - (size >> 1);
      if (left < 0 || top < 0 || left + size > width || top + size > height) continue;
      for (let dy = 0; dy < size; ++dy)
        for (let dx = 0; dx < size; ++dx) {
          const place = (top + dy) * width + left + dx;
          if (near < depth[place]) continue;
          depth[place] = near;
          pixels[place] = colors[i];
        }
    }
    context.putImageData(image, 0, 0);
    const ink = getComputedStyle(this.canvas).color;
    context.strokeStyle = context.fillStyle = ink;
    context.font = `${11 * ratio}px sans-serif`;
    context.lineWidth = ratio;
    for (const [name, from, to] of [["L*", [0, 0, 0], [100, 0, 0]], ["+a*", [50, -100, 0], [50, 100, 0]], ["+b*", [50, 0, -100], [50, 0, 100]]]) {
      const [x0, y0] = at(...from), [x1, y1] = at(...to);
      context.globalAlpha = 0.5;
      context.beginPath();
      context.moveTo(x0, y0);
      context.lineTo(x1, y1);
      context.stroke();
      context.globalAlpha = 1;
      context.fillText(name, x1 + 3, y1);
    }
    if (!this.design) return;
    const [x, y] = at(...this.design.lab), arm = 9 * ratio;
    for (const [style, line] of [["#000", 5 * ratio], ["#fff", 3 * ratio], [this.design.css, ratio]]) {
      context.strokeStyle = style;
      context.lineWidth = line;
      context.beginPath();
      context.moveTo(x - arm, y);
      context.lineTo(x + arm, y);
      context.moveTo(x, y - arm);
      context.lineTo(x, y + arm);
      context.stroke();
    }
  }
  // The paint whose point is nearest to a place of the window becomes the chosen one of the list.
  pick(clientX, clientY) {
    const box = this.canvas.getBoundingClientRect(), x = ((clientX - box.left) / box.width) * this.canvas.width, y = ((clientY - box.top) / box.height) * this.canvas.height;
    const at = this.projector();
    let best = -1, least = 15;
    for (let i = 0; i < this.paints.length; ++i) {
      const [px, py] = at(this.points[3 * i], this.points[3 * i + 1], this.points[3 * i + 2]), apart = Math.hypot(px - x, py - y);
      if (apart < least) [best, least] = [i, apart];
    }
    if (best < 0) return;
    const row = this.app.panel.places.indexOf(this.paints[best]);
    if (row >= 0) this.app.panel.choose(row);
    else this.app.say(told`${this.app.library.paint(this.paints[best]).name} does not pass the filter of the list.`);
  }
}
