// The parts of the mesh and their surfaces: the design, a second paint, or a finish that nobody paints. Glass, rubber and chrome are
// told by the names of parts; all others wear the design until somebody chooses.

const wornWords = ["paint", "second paint", "glass", "rubber", "chrome"], hiddenRow = -1;

class Parts {
  constructor(app) {
    this.app = app;
    this.box = document.getElementById("part-box");
    document.getElementById("take-second").addEventListener("click", () => this.takeSecond(app.history.now));
    this.forMesh();
  }
  get list() { return this.app.stage.mesh.parts; }
  get summary() {
    const known = this.list.filter((part) => part.told > 0), kinds = [...new Set(known.map((part) => wornWords[part.told]))];
    const counts = kinds.map((word) => `${words(word)} ${known.filter((part) => wornWords[part.told] === word).length}`).join(", ") || words("none");
    return told`${this.list.length} parts: told by their names are ${counts}; ${this.list.length - known.length} not recognized, which wear the paint.`;
  }

  // After another mesh came: rows as its names tell them.
  forMesh() {
    this.chosen = null;
    this.app.data.mesh.parts.forEach((part) => { part.told ??= part.row; });
    this.show();
  }
  chooser(part) {
    const list = made("select", { "aria-label": told`What ${part.name || words("the part")} wears`, onchange: () => this.wear(part, Number(list.value)) });
    list.append(...wornWords.map((text, value) => made("option", { value, words: text })), made("option", { value: hiddenRow, words: "hidden" }));
    list.value = part.row;
    return list;
  }
  wear(part, row) {
    if (row === 1 && !this.second) this.second = this.app.history.now;
    part.row = row;
    this.changed();
  }
  // The paint of the design becomes the second one.
  takeSecond(state) {
    this.second = state;
    this.changed();
  }
  changed() {
    this.app.partsChanged();
    this.show();
    this.app.store();
  }
  // Shows the list, and the part that was clicked.
  show() {
    const rows = document.getElementById("parts"), held = [...rows.children, this.box].findIndex((one) => one.contains(document.activeElement));
    document.getElementById("parts-text").textContent = this.summary;
    document.getElementById("second-name").textContent = this.second ? this.second.paint.name : words("none yet");
    rows.replaceChildren(...this.list.map((part) => {
      const name = made("span", { class: "name", text: part.name || words("unnamed part") }), note = made("small", { words: part.told > 0 ? "by its name" : "not recognized" });
      const row = made("div", { class: "part" }, [name, note, this.chooser(part)]);
      if (part === this.chosen) row.setAttribute("aria-current", "true");
      return row;
    }));
    this.box.hidden = this.chosen === null;
    if (this.chosen) this.box.replaceChildren(made("span", { text: this.chosen.name || words("unnamed part") }), this.chooser(this.chosen),
                                              made("button", { type: "button", "aria-label": "Close", text: "×", onclick: () => this.choose(null) }));
    if (held >= 0) [...rows.children, this.box][held]?.querySelector("select")?.focus({ preventScroll: true });
  }
  choose(part) {
    this.chosen = part;
    this.show();
  }

  // The parts, each with its number among those of its name.
  get numbered() {
    const counts = new Map();
    return this.list.map((part) => {
      const number = counts.get(part.name) ?? 0;
      counts.set(part.name, number + 1);
      return [part, number];
    });
  }
  // The members of a session: parts that wear something else than their names tell, by name and number.
  saved() {
    const worn = this.numbered.filter(([part]) => part.row !== part.told).map(([{ name, row }, number]) => [name, row, number]);
    return worn.length > 0 || this.second ? { worn, second: this.second && saidState(this.second) } : undefined;
  }
  restore(worn, second) {
    this.second = second;
    for (const [part, number] of this.numbered) {
      const row = worn.find((one) => one?.[0] === part.name && (one[2] ?? 0) === number)?.[1];
      part.row = Number.isInteger(row) && row >= hiddenRow && row < wornWords.length && (row !== 1 || second) ? row : part.told;
    }
    this.app.partsChanged();
    this.show();
  }
}
