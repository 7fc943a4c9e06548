// Boards of pictures that are dropped on the page, and the droppers that take face, flop and gloss from them, as those of
// paint-pick(1). Each board has a tab, and its pictures stand beside each other. [Shimizu2009] 3.5

const mostPixels = 4096;  // of a side; larger pictures are made smaller

const dataOf = (file) => new Promise((resolve, reject) => {
  const reader = new FileReader();
  reader.onload = () => resolve(reader.result);
  reader.onerror = () => reject(reader.error);
  reader.readAsDataURL(file);
});

// The file of such data; one without bytes where they are damaged.
function fileOf(name, data) {
  try {
    return new File([bytesOf(data.slice(data.indexOf(",") + 1))], name, { type: /^data:([^;,]*)/.exec(data)?.[1] ?? "" });
  } catch {
    return new File([], name);
  }
}

class Pictures {
  constructor(app) {
    this.app = app;
    this.boards = [];  // {name, pictures, zoom}: pictures are {name, canvas, context}; a zoom of 0 fits them into the panel
    this.board = null;
    this.made = 0;  // boards so far, for their names
    this.coming = 0;  // of sessions, whose pictures are still to be read
    this.restored = Promise.resolve();
    this.droppers = {};  // of face, flop and gloss: {picture, at, radius} and what was found there
    this.current = null;  // the picture of the board that was used last
    this.place = document.getElementById("picture");
    this.tabs = document.getElementById("picture-tabs");
    this.kind = "face";
    document.querySelectorAll("input[name=dropper]").forEach((radio) => radio.addEventListener("change", () => {
      this.kind = radio.value;
      this.showMarks();
    }));
    document.getElementById("zoom").addEventListener("input", (event) => this.zoomTo(2 ** Number(event.target.value)));
    document.getElementById("new-board").addEventListener("click", () => {
      this.addBoard();
      this.show();
    });
    document.getElementById("remove-picture").addEventListener("click", () => this.remove());
    document.getElementById("swap").addEventListener("click", () => this.swap());
    this.show();
  }

  get size() { return this.all.reduce((sum, { data }) => sum + data.length, 0); }
  get all() { return this.boards.flatMap((board) => board.pictures); }
  addBoard() {
    this.board = { name: told`Board ${++this.made}`, pictures: [], zoom: 0 };
    this.boards.push(this.board);
    this.current = null;
  }
  openBoard(board) {
    this.board = board;
    this.current = board.pictures.at(-1) ?? null;
    this.show();
  }
  use(picture) {
    if (this.current === picture) return;
    this.current = picture;
    this.showMarks();
  }

  async add(files, keep = true) {
    for (const file of files) {
      try {
        const bitmap = await createImageBitmap(file);
        const scale = Math.min(1, mostPixels / Math.max(bitmap.width, bitmap.height));
        const canvas = made("canvas", { width: Math.max(1, Math.round(scale * bitmap.width)), height: Math.max(1, Math.round(scale * bitmap.height)), tabindex: 0,
                                        role: "application", "aria-label": told`Picture ${file.name}. Arrow keys move the dropper, with Shift by ten pixels.` });
        const context = canvas.getContext("2d", { willReadFrequently: true });
        context.drawImage(bitmap, 0, 0, canvas.width, canvas.height);
        bitmap.close();
        if (scale < 1) this.app.say(told`${file.name} was made smaller: its sides have at most ${mostPixels} pixels here.`);
        const picture = { name: file.name, canvas, context, data: scale < 1 ? canvas.toDataURL("image/png") : await dataOf(file) };
        this.listen(picture);
        if (!this.board) this.addBoard();
        this.board.pictures.push(picture);
        this.current = picture;
      } catch {
        this.app.say(told`${file.name} is no picture that this browser reads.`);
      }
    }
    this.show();
    if (keep) this.app.store();
  }
  // The pictures as a session has them: as the files that they came in, and droppers by the numbers of board and picture.
  saved() {
    const places = new Map();
    this.boards.forEach((board, b) => board.pictures.forEach((picture, i) => places.set(picture, [b, i])));
    return { made: this.made, open: this.boards.indexOf(this.board),
             boards: this.boards.map(({ name, zoom, pictures }) => ({ name, zoom, pictures: pictures.map(({ name: file, data }) => ({ name: file, data })) })),
             droppers: Object.entries(this.droppers).map(([kind, { picture, ...found }]) => ({ kind, place: places.get(picture), ...found })) };
  }
  // Takes the place of what stands here. A picture that cannot be read leaves its board without it, and is told.
  // Those of a session that is opened meanwhile come after them.
  restore(saved) {
    ++this.coming;
    const before = this.restored.catch(() => {});
    this.restored = before.then(() => this.putBack(saved)).finally(() => {
      --this.coming;
      this.app.store();
    });
    return this.restored;
  }
  async putBack({ made: count, open, boards, droppers }) {
    if (!Array.isArray(boards) || !boards.every((one) => Array.isArray(one?.pictures)) || !Array.isArray(droppers)) throw new Error(words("The pictures of this session are damaged."));
    Object.assign(this, { boards: [], board: null, current: null, droppers: {}, made: 0 });
    const places = [];
    for (const { name, zoom, pictures } of boards) {
      this.addBoard();
      const board = Object.assign(this.board, { name, zoom }), found = [];
      for (const { name: file, data } of pictures) {
        const before = board.pictures.length;
        await this.add([fileOf(file, data)], false);
        found.push(board.pictures.length > before ? board.pictures.at(-1) : null);
      }
      places.push(found);
    }
    this.made = count;
    for (const { kind, place, ...found } of droppers) {
      const picture = places[place?.[0]]?.[place?.[1]];
      if (picture) this.droppers[kind] = { picture, ...found };
    }
    const board = this.boards[open] ?? this.boards.at(-1);
    if (board) this.openBoard(board);
    else this.show();
  }
  // Takes the picture that was used last away, and a board that has none with it.
  remove() {
    const { pictures } = this.board, at = pictures.indexOf(this.current);
    for (const [kind, dropper] of Object.entries(this.droppers)) if (dropper.picture === this.current) delete this.droppers[kind];
    if (at >= 0) pictures.splice(at, 1);
    this.current = pictures[Math.max(0, at - 1)] ?? null;
    if (pictures.length === 0) {
      this.boards.splice(this.boards.indexOf(this.board), 1);
      this.board = this.boards.at(-1) ?? null;
      this.current = this.board?.pictures.at(-1) ?? null;
    }
    this.show();
    this.app.store();
  }

  listen(picture) {
    const { canvas } = picture;
    let last = null, from = null;
    const pixelOf = (event) => {
      const box = canvas.getBoundingClientRect();
      return [clamped(Math.floor(((event.clientX - box.left) / box.width) * canvas.width), 0, canvas.width - 1),
              clamped(Math.floor(((event.clientY - box.top) / box.height) * canvas.height), 0, canvas.height - 1)];
    };
    const dropped = (event) => {
      if (this.kind === "move") {
        this.place.scrollLeft = from.left - (event.clientX - from.x);
        this.place.scrollTop = from.top - (event.clientY - from.y);
      } else {
        last = this.drop(picture, pixelOf(event)) ?? last;
        if (last) this.app.preview(last);
      }
    };
    draggable(canvas, {
      begin: (event) => {
        this.use(picture);
        last = null;
        from = { x: event.clientX, y: event.clientY, left: this.place.scrollLeft, top: this.place.scrollTop };
        dropped(event);
      },
      move: dropped,
      end: () => { if (last) this.app.commit(last); },
    });
    canvas.addEventListener("focus", () => this.use(picture));
    canvas.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
      if (!step || this.kind === "move") return;
      event.preventDefault();
      const size = event.shiftKey ? 10 : 1, here = this.droppers[this.kind], now = here?.picture === picture ? here.at : [canvas.width >> 1, canvas.height >> 1];
      const edit = this.drop(picture, [clamped(now[0] + size * step[0], 0, canvas.width - 1), clamped(now[1] + size * step[1], 0, canvas.height - 1)]);
      if (edit) this.app.commit(edit, true);
    });
    canvas.addEventListener("wheel", (event) => {
      if (!event.ctrlKey) return;
      event.preventDefault();
      this.zoomTo(this.zoomOf(picture) * (event.deltaY > 0 ? 1 / 1.15 : 1.15));
    }, { passive: false });
  }

  // The edit that a dropper at this pixel stands for, or null where it finds nothing.
  drop(picture, [x, y]) {
    const radius = clamped(document.getElementById("dropper-radius").valueAsNumber || 0, 0, 200), reach = Math.ceil(radius);
    const { canvas, context } = picture, left = Math.max(0, x - reach), top = Math.max(0, y - reach);
    const width = Math.min(canvas.width, x + reach + 1) - left, height = Math.min(canvas.height, y + reach + 1) - top;
    const { data } = context.getImageData(left, top, width, height), signals = [];
    for (let row = 0; row < height; ++row)
      for (let column = 0; column < width; ++column) {
        const at = 4 * (row * width + column);
        if (Math.hypot(left + column - x, top + row - y) <= radius && data[at + 3] === 255) signals.push(data[at], data[at + 1], data[at + 2]);
      }
    if (signals.length === 0) {
      this.app.say(words("Every pixel below the dropper is transparent: move it."));
      return null;
    }
    const found = this.app.attempt(() => this.app.engine.ask({ do: "dropper", signals }));
    if (!found) return null;
    this.droppers[this.kind] = { picture, at: [x, y], radius, ...found };
    this.showMarks();
    return this.edit(this.kind, found);
  }
  // With two droppers for the color, both ends are theirs, and a flop that is lighter than the face trades places with it.
  edit(kind, { lab, gloss }) {
    if (kind === "gloss") return this.app.controls.edit("gloss", rounded(gloss, 1));
    const { face, flop } = this.droppers, color = (of) => of.lab.map((value) => rounded(value));
    if (!face || !flop) return { [kind]: color({ lab }) };
    const swapped = !document.getElementById("retro").checked && flop.lab[0] > face.lab[0];
    return swapped ? { face: color(flop), flop: color(face) } : { face: color(face), flop: color(flop) };
  }
  swap() {
    const { face, flop } = this.app.description.appearance, color = (lab) => lab.map((value) => rounded(value));
    this.app.commit({ face: color(flop), flop: color(face) });
  }

  // Pixels of the window for a pixel of the picture. Without a zoom, one picture takes the width of the panel, and several
  // take half of it.
  zoomOf({ canvas }) { return this.board.zoom || Math.min(1, (this.place.clientWidth / canvas.width) * (this.board.pictures.length > 1 ? 0.48 : 1)); }
  zoomTo(zoom) {
    if (!this.board) return;
    this.board.zoom = clamped(zoom, 1 / 16, 16);
    this.showZoom();
  }
  showZoom() {
    for (const picture of this.board.pictures) picture.canvas.style.width = `${this.zoomOf(picture) * picture.canvas.width}px`;
    if (this.current) document.getElementById("zoom").value = Math.log2(this.zoomOf(this.current));
    this.showMarks();
  }

  // The boards' tabs, and the pictures of the one that is open, with the droppers on them.
  show() {
    document.getElementById("picture-panel").hidden = !this.board;
    this.tabs.replaceChildren(...this.boards.map((board) => {
      const chosen = board === this.board;
      const tab = made("button", { type: "button", role: "tab", "aria-selected": chosen, tabindex: chosen ? 0 : -1, text: `${board.name} (${board.pictures.length})`,
                                   onclick: () => this.openBoard(board) });
      tab.addEventListener("keydown", (event) => {
        const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
        if (!step) return;
        event.preventDefault();
        this.openBoard(this.boards[(this.boards.indexOf(board) + step + this.boards.length) % this.boards.length]);
        this.tabs.querySelector("[aria-selected=true]").focus();
      });
      return tab;
    }));
    document.getElementById("remove-picture").disabled = !this.current;
    this.marks = {};
    for (const kind of ["face", "flop", "gloss"]) this.marks[kind] = made("span", { class: `dropper ${kind}`, "aria-hidden": "true", words: kind });
    this.sheets = new Map();
    if (!this.board) return;
    for (const picture of this.board.pictures) this.sheets.set(picture, made("div", { class: "sheet" }, [picture.canvas]));
    const hint = made("p", { class: "hint", words: "This board is empty: add pictures, or drop or paste them." });
    this.place.replaceChildren(...(this.sheets.size > 0 ? this.sheets.values() : [hint]));
    this.showZoom();
  }
  showMarks() {
    const { droppers } = this, parts = [];
    this.place.classList.toggle("moving", this.kind === "move");
    for (const [picture, sheet] of this.sheets) sheet.classList.toggle("current", this.sheets.size > 1 && picture === this.current);
    for (const [kind, mark] of Object.entries(this.marks)) {
      const dropper = droppers[kind], sheet = dropper && this.sheets.get(dropper.picture);
      if (dropper) parts.push(`--${kind} ${quoted(`${dropper.picture.name}@${dropper.at.join(",")},${dropper.radius}`)}`);
      if (!sheet) {
        mark.remove();
        continue;
      }
      const { canvas } = dropper.picture;
      sheet.append(mark);
      mark.style.left = `${((dropper.at[0] + 0.5) / canvas.width) * 100}%`;
      mark.style.top = `${((dropper.at[1] + 0.5) / canvas.height) * 100}%`;
      mark.style.background = dropper.css;
      mark.style.color = dropper.lab[0] > 50 ? "#000" : "#fff";
    }
    const reading = droppers[this.kind];
    document.getElementById("dropper-text").textContent = reading
      ? told`${words(this.kind)}: L* ${reading.lab[0].toFixed(1)}, a* ${reading.lab[1].toFixed(1)}, b* ${reading.lab[2].toFixed(1)}; contrast stands for ${reading.gloss.toFixed(0)} gloss units`
      : words("Point at the picture with a dropper, or focus it and use the arrow keys.");
    document.getElementById("pick-command").textContent = parts.length > 0
      ? `paint-pick ${parts.join(" ")}${document.getElementById("retro").checked ? " --retro" : ""} --travel ${rounded(this.app.description?.appearance.travel ?? 60, 1)} -o picked.paints.xml` : "";
  }
}
