// The page as a whole: it shows the paint of the history, or the preview of an edit that is being made.

const mostKept = 4e6;    // letters of pictures that a browser is asked to keep; most keep five million in all
const mostListed = 500;  // paints in a list that the browser unfolds

// The number of a tab, which pages of plain HTTP make, too.
const newNumber = () => crypto.getRandomValues(new Uint32Array(4)).join("-");

class App {
  constructor(engine, data, library, module, code) {
    this.engine = engine;
    this.data = data;
    this.library = library;
    this.palette = [];
    this.highlight = 0;  // degrees, of the highlight of the light
    this.compared = { choice: "none", name: "", weights: null };
    this.key = "paint-studio " + data.title + " " + data.basis.name + " " + library.count;
    ({ geometries: this.geometries } = engine.ask({ do: "load", basis: data.basis, print: data.print, attached: true }));
    this.traced = new TracedViews(this);
    this.stageView = new StageView(this);
    this.stage = this.stageView.stage;
    this.controls = new NumberControls(this);
    this.wheel = new Wheel(this);
    this.curves = new Curves(this);
    this.tiles = new Tiles(this);
    this.handoff = new Handoff(this);
    this.surface = new Surface(this);
    this.pictures = new Pictures(this);
    this.parts = new Parts(this);
    this.card = new Card(this);
    this.tour = new Tour(this);
    document.getElementById("geometry-note").append(noted("45as15"));
    this.opening = new Opening(this, module, code);
    this.panel = new LibraryPanel(this);
    this.cloud = new Cloud(this);
    this.makeHeader();
    this.history = new EditHistory([this.fresh(this.firstPaint())]);
    this.reopen();
    this.show();
    document.getElementById("loading").remove();
    this.follow();
    window.addEventListener("hashchange", () => this.follow());
    matchMedia("(color-gamut: p3)").addEventListener("change", () => this.screenChanged());
    window.addEventListener("storage", ({ key, newValue }) => { if (this.tab && key === this.place) this.keepApart(newValue !== null); });
  }
  // The paint of a small library that shows most: one of interference, else a pearl, else a metallic.
  firstPaint() {
    const kinds = ["interference", "pearl", "metallic"], all = this.library.count <= mostListed ? [...Array(this.library.count).keys()] : [];
    const rank = (i) => (kinds.indexOf(this.library.paint(i).class) + 4) % 4;
    return all.reduce((best, i) => (rank(i) < rank(best) ? i : best), 0);
  }
  // An address that ends with #paint=NAME starts from the paint of that name, one with #design={file, paint, board} from
  // that paint, which paint-pick made of a mood board, and one with #p=... is a link that this page made.
  follow() {
    const words = new URLSearchParams(location.hash.slice(1)), name = words.get("paint"), design = words.get("design"), link = words.get("p");
    if (name === null && design === null && link === null) return;
    location.hash = "";
    if (link !== null) unpackedText(link).then((text) => this.attempt(() => this.openLink(text)), () => this.say(words("The address of this page is cut: copy the whole link.")));
    if (design !== null) this.attempt(() => this.restore(this.picked(design)));
    if (name === null) return;
    this.attempt(() => {
      this.engine.ask({ do: "filter", text: name });
      const place = this.engine.list("filtered").find((i) => this.library.paint(i).name === name);
      if (place === undefined) throw new Error(told`This library has no paint named ${name}.`);
      this.start(place);
    });
  }

  // The state of a paint that an address holds. Throws a sentence where it is none.
  picked(text) {
    let own = null;
    try {
      own = JSON.parse(text);
    } catch {
      own = null;
    }
    if (typeof own?.file !== "string" || typeof own.board !== "string") throw new Error(words("The address of this page holds no paint."));
    this.engine.ask({ do: "describe", paint: own.paint });
    return { own: { file: own.file, board: own.board, paint: own.paint }, steps: [], paint: own.paint };
  }
  fresh(number) {
    const paint = this.library.paint(number);
    return { start: number, of: paint.name, steps: [], paint };
  }
  // {file, paint} that a state began with.
  origin({ start, own }) { return own ?? this.library.at(start); }
  // Paints of a file that was opened: the design begins with the first, and all of them are in the palette.
  openPaints(file, paints) {
    const states = paints.map((paint) => ({ own: { file, paint }, steps: [], paint }));
    for (const state of states) this.engine.ask({ do: "describe", paint: state.paint });
    if (states.length > 1) this.palette.push(...states);
    this.restore(states[0]);
  }
  glossAngle() { return this.paint.gloss && this.paint.gloss.length > 0 ? this.paint.gloss[0][0] : 60; }

  say(text) { document.getElementById("status").textContent = text; }
  // Runs an action, and says what it refused.
  attempt(action) {
    try {
      return action();
    } catch (error) {
      this.say(error.message);
      return undefined;
    }
  }

  makeHeader() {
    const byId = (id) => document.getElementById(id), library = byId("library");
    byId("title").textContent = this.data.title;
    const shown = this.library.count <= mostListed ? this.library.count : 0;  // of more, the list of the library shows all
    for (let i = 0; i < shown; ++i) library.append(made("option", { value: i, text: this.library.paint(i).name }));
    library.addEventListener("change", () => { if (library.value !== "own") this.start(Number(library.value)); });
    byId("compare").addEventListener("change", () => this.compare(byId("compare").value));
    byId("gradient").addEventListener("click", () => this.attempt(() => this.gradient()));
    byId("undo").addEventListener("click", () => this.turn("undo"));
    byId("redo").addEventListener("click", () => this.turn("redo"));
    byId("metric").addEventListener("change", () => this.tiles.nearest());
    for (const what of ["name", "code"])
      byId("paint-" + what).addEventListener("change", () => this.label(byId("paint-name").value.trim(), byId("paint-code").value.trim()));
    document.addEventListener("focusout", () => { this.history.now.by_key = ""; });
    document.addEventListener("keydown", (event) => {
      if (!(event.ctrlKey || event.metaKey) || event.altKey || event.target.matches?.("textarea, input[type=text], input[type=search]")) return;
      const key = event.key.toLowerCase();
      if (key !== "z" && key !== "y") return;
      event.preventDefault();
      this.turn(key === "y" || event.shiftKey ? "redo" : "undo");
    });
  }

  // After the light changed: what counts angles from it.
  lightChanged() {
    if (this.paint) this.highlight = this.engine.ask({ do: "fit", paint: this.paint, extent: Math.max(0.1, this.stageView.light.extent) }).highlight;
    this.surface?.again();
  }

  // After the graphics were lost and came back: what they held is made anew.
  graphicsCame() {
    ({ stage: this.stage } = this.stageView);
    this.weights = this.comparedWeights = this.tiles.weights = null;
    this.traced.sides = [null, null];
    this.traced.tileTexture = null;
    this.compare(this.compared.choice);
    this.show();
  }
  // After the page came to another screen.
  screenChanged() {
    this.stage.takeScreen();
    this.panel.showRows();
    this.cloud.load(true);
    this.show();
  }
  // After parts or the second paint changed.
  partsChanged() {
    const { second } = this.parts;
    if (second) this.engine.ask({ do: "fit", paint: second.paint });
    this.stage.partsChanged(second ? this.engine.list("weights") : null);
    this.stageView.shadow();
    this.stageView.cells = [];
    this.compare(this.compared.choice);
    this.show();
  }

  // The paint that an edit would make, shown while it is being made.
  preview(edit) {
    this.wanted = edit;
    this.tiles.stop();
    if (this.frame !== undefined) return;
    this.frame = requestAnimationFrame(() => {
      this.frame = undefined;
      if (this.wanted) this.attempt(() => this.display(this.edited(this.wanted).paint, true));
      // Where the computer is fast, the variations follow while a handle is dragged.
      if (this.stageView.full_ms > 0 && this.stageView.full_ms < 16) this.tiles.variations();
    });
  }
  // Shows the paint of the history in the place of a preview that is given up.
  abandon() {
    if (!this.wanted) return;
    this.wanted = null;
    this.show();
  }
  edited(edit) { return this.engine.ask({ do: "edit", paint: this.history.now.paint, edit }); }

  // Makes an edit, which becomes a step of the history. Edits by keys that state the same thing one after the other are one
  // step, until the control loses the focus.
  commit(edit, by_key = false) {
    this.wanted = null;
    this.stageView.asked = performance.now();
    const what = by_key ? Object.keys(edit).join() : "", again = what && this.history.now.by_key === what;
    if (again) this.history.undo();
    const made = this.attempt(() => {
      const done = this.edited(edit), now = this.history.now;
      if (done.skipped.length > 0) {
        this.say(words("This cannot be done:") + " " + done.skipped.join("; "));
        return false;
      }
      if (JSON.stringify(done.paint) !== JSON.stringify(now.paint)) {
        const name = now.name ?? this.copyName(now.paint.name);
        this.history.push({ start: now.start, of: now.of, own: now.own, steps: [...now.steps, edit], ...labeled(done.paint, name, now.code), goesOn: true, by_key: what });
        this.say(done.clipped.length > 0 ? words("Clipped:") + " " + done.clipped.join("; ") : "");
      }
      return true;
    });
    if (again && !made) this.history.redo();
    this.show();
  }
  start(number) { this.restore(this.fresh(number)); }
  // A state of elsewhere, such as of the palette, becomes that of the design.
  restore(state) {
    this.history.push({ ...state, goesOn: false, by_key: "" });
    this.show();
  }
  turn(way) {
    this.history[way]();
    this.show();
  }
  // A name that no paint of the palette has.
  copyName(name) {
    const taken = new Set(this.palette.map((state) => state.paint.name)), copy = name + " copy";
    for (let number = 2;; ++number) {
      const next = number === 2 ? copy : `${copy} ${number - 1}`;
      if (!taken.has(next)) return next;
    }
  }
  // Gives the design a name and a code.
  label(name, code) {
    const { now } = this.history;
    if (!name || (name === now.paint.name && code === (now.paint.code ?? ""))) return this.show();
    this.history.push({ ...now, ...labeled(now.paint, name, code), goesOn: false, by_key: "" });
    return this.show();
  }
  // The paint that the design began with, in the list of the header.
  showStart({ start, own }) {
    const list = document.getElementById("library");
    list.querySelector("option[data-more]")?.remove();
    if (own) list.append(made("option", { value: "own", text: told`${own.paint.name} of ${own.file}`, "data-more": "" }));
    else if (start >= list.options.length) list.append(made("option", { value: start, text: this.library.paint(start).name, "data-more": "" }));
    list.value = own ? "own" : String(start);
  }
  // Moves a paint of the palette to another place of it, or, where `to` is -1, takes it away.
  arrange(from, to) {
    const compared = this.compared.choice.startsWith("palette ") ? this.comparedState() : null, [state] = this.palette.splice(from, 1);
    if (to >= 0) this.palette.splice(to, 0, state);
    if (compared) this.compared.choice = `palette ${this.palette.indexOf(compared)}`;
    this.tiles.palette();
    this.showChoices();
    this.store();
  }
  keep() {
    this.palette.push(this.history.now);
    this.tiles.palette();
    this.showChoices();
    this.store();
  }

  // Shows the paint of the history, and what follows from it.
  show() {
    const now = this.history.now;
    this.attempt(() => this.display(now.paint, false));
    document.getElementById("undo").disabled = !this.history.canUndo;
    document.getElementById("redo").disabled = !this.history.canRedo;
    this.showStart(now);
    this.showChoices();
    this.handoff.show();
    for (const what of ["name", "code"]) document.getElementById("paint-" + what).value = now.paint[what] ?? "";
    this.attempt(() => this.tiles.again());
    this.store();
  }

  // Shows one paint; `moving` while an edit is being made. The picture is asked for first: while it is drawn, the rest of
  // the page follows.
  display(paint, moving) {
    const begin = performance.now();
    const fit = this.fit = this.engine.ask({ do: "fit", paint, extent: Math.max(0.1, this.stageView.light.extent) });
    const fitted = performance.now();
    this.paint = paint;
    this.highlight = fit.highlight;
    this.weights = this.stage.weights(this.engine, this.weights ?? null);
    this.weights.paint = paint;
    this.description = this.engine.ask({ do: "describe", paint });
    this.stageView.drawNow(moving);
    this.wheel.show(this.description);
    // Where graphics are drawn by the processor, the panels cost more than the picture: they follow a few times a second.
    clearTimeout(this.panelsSoon);
    const now = performance.now(), slow = this.stageView.full_ms > firstBudget_ms / 2;
    if (!moving || !slow || now - (this.panelsShown ?? 0) > 300) this.showPanels(fit, moving);
    else this.panelsSoon = setTimeout(() => this.showPanels(fit, moving), 300);
    this.times = { fit_us: fit.time_us, request_ms: fitted - begin, show_ms: performance.now() - begin };
  }
  showPanels(fit, moving) {
    this.panelsShown = performance.now();
    this.controls.show(this.description);
    this.curves.show(this.description, fit);
    this.showFigures(fit);
    this.stageView.showBorder();
    this.surface.again();
    if (!moving) this.cloud.show();
  }

  // Puts the paint beside another one: "none", "start", "step N" of the history, "palette N" or "library N".
  compare(choice) {
    const [kind, number] = choice.split(" ");
    this.compared = { choice };
    const found = this.comparedState()?.paint ?? null;
    this.compared = { choice: found ? choice : "none", name: found ? found.name : "", weights: null };
    if (found) {
      this.attempt(() => {
        this.engine.ask({ do: "fit", paint: found });
        this.comparedWeights = this.stage.weights(this.engine, this.comparedWeights ?? null);
        this.comparedWeights.paint = found;
        this.compared.weights = this.comparedWeights;
      });
      if (kind === "step") this.compared.name += `, ${words("step")} ${number}`;
      if (kind === "start") this.compared.name += words(", as it was");
    }
    this.stageView.showBorder();
    this.stageView.redraw();
  }
  // So many paints that stand beside the design: the one that it is compared with, or the one it began with, and the nearest
  // of the library.
  beside(count) {
    const first = this.comparedState()?.paint ?? this.origin(this.history.now).paint;
    const others = [...(this.near ?? []).map((number) => this.library.paint(number)), ...this.palette.map((state) => state.paint), first].filter((paint) => paint.name !== first.name);
    const key = JSON.stringify([first, others.map(({ name }) => name), count]);
    if (this.besideKey !== key) [this.besideKey, this.besideList] = [key, [first, ...others, first, first].slice(0, count)];
    return this.besideList;
  }
  // Paints between the design and the one that it is compared with, into the palette.
  gradient() {
    const field = document.getElementById("gradient-steps"), count = clamped(Math.round(field.valueAsNumber || 3), 1, 24), to = this.comparedState();
    if (!to) return this.say(words("Choose a paint to compare with: the gradient leads to it."));
    const from = this.history.now, { list } = this.engine.ask({ do: "gradient", from: from.paint, to: to.paint, count });
    const states = [from, to].map(saidState);
    this.palette.push(...list.map((paint) => ({ own: { file: "gradient.paints.xml", paint, gradient: { ends: states, count } }, steps: [], paint })));
    this.tiles.palette();
    this.showChoices();
    this.store();
    return this.say(told`${count} paints between ${from.paint.name} and ${to.paint.name} are in the palette.`);
  }
  // The state of the paint that the design is compared with; null for none.
  comparedState() {
    const [kind, number] = this.compared.choice.split(" "), { states, now } = this.history;
    return { none: () => null, start: () => ({ start: now.start, of: now.of, own: now.own, steps: [], paint: this.origin(now).paint }), step: () => states[number] ?? null,
             palette: () => this.palette[number] ?? null, library: () => this.fresh(Number(number)) }[kind]();
  }
  compareWith(place) {
    const list = document.getElementById("compare"), value = `library ${place}`;
    if (![...list.options].some((one) => one.value === value)) list.append(made("option", { value, text: this.library.paint(place).name }));
    list.value = value;
    this.compare(value);
  }
  // The choices for a comparison with the paint, anew after the history or the palette changed.
  showChoices() {
    const list = document.getElementById("compare"), group = (label, options) => options.length > 0 && list.append(made("optgroup", { label }, options));
    const option = (value, text) => made("option", { value, text });
    list.replaceChildren(option("none", words("nothing")), option("start", words("the paint it began with")));
    const { states, at } = this.history, first = Math.max(0, states.length - 40);
    group(words("History"), states.slice(first).map((state, i) => [first + i, state]).filter(([i]) => i !== at).map(([i, state]) =>
      option(`step ${i}`, `${words("step")} ${i}: ${state.paint.name}${state.steps.length > 0 ? ", " + Object.keys(state.steps.at(-1)).join(" ") : ""}`)));
    group(words("Palette"), this.palette.map((state, i) => option(`palette ${i}`, `${i + 1}: ${state.paint.name}`)));
    const { choice } = this.compared, number = Number(choice.slice(8));
    const listed = this.library.count <= mostListed ? [...Array(this.library.count).keys()] : choice.startsWith("library") ? [number] : [];
    group(words("Library"), listed.map((i) => option(`library ${i}`, this.library.paint(i).name)));
    list.value = choice;
    if (list.value !== choice) this.compare("none");
    else if (choice !== "none" && JSON.stringify(this.comparedState().paint) !== JSON.stringify(this.comparedWeights?.paint)) this.compare(choice);
  }

  showFigures(fit) {
    const number = (value, digits = 1) => (value === null ? words("does not apply") : value.toFixed(digits));
    const { metrics } = this.description;
    const rows = [[words("Name"), this.paint.name], [words("flop index"), number(metrics.flop_index)],
                  [words("chroma index"), number(metrics.chroma_index)], [words("hue shift index"), number(metrics.hue_shift_index)],
                  [[noted("Lobes"), " ", words("miss the readings by")], told`${number(fit.de00_mean, 2)} on average, ${number(fit.de00_max, 2)} at most (CIEDE2000)`]];
    if (fit.gamut_de00 > 0.05) rows.push([words("Lost outside the working space"), number(fit.gamut_de00, 2) + " (CIEDE2000)"]);
    if (metrics.flags.length > 0) rows.push([words("Flags"), metrics.flags.join(", ")]);
    document.getElementById("figures").replaceChildren(
      ...rows.flatMap(([name, value]) => [made("dt", {}, [name].flat()), made("dd", { text: value })]));
  }

  // The contents of a link: the design, by the library's paint and the edits, and how it is seen.
  linked() {
    const { view, environment, stops, lamp, stage } = this.stageView, { environments, mesh } = this.data;
    return JSON.stringify({ ...saidState(this.history.now), view, usual: mesh.view.distance, light: environments[environment].name, stops, lamp, turn: stage.turn });
  }
  openLink(text) {
    const link = JSON.parse(text), { view, lamp, stops, turn } = link;
    const numbers = [view?.azimuth, view?.elevation, view?.distance, view?.fov, ...(view?.target ?? []), lamp?.azimuth, lamp?.elevation, lamp?.stops, stops, turn];
    if (numbers.length !== 12 || !numbers.every(Number.isFinite)) throw new Error(words("This link does not say how the paint is seen."));
    this.restore(this.replayed(link));
    this.stageView.see(link);
  }

  // The session: the library paints and edits of all states, the palette, and the boards with their pictures and
  // droppers. Paints are made again when it is opened.
  savedSession(withPictures = true) {
    return JSON.stringify({ kind: "paint-studio session", version: 1, title: this.data.title,
                            history: this.history.saved(), palette: this.palette.map(saidState), parts: this.parts.saved(), notes: this.card.notes.value || undefined,
                            ...(withPictures && this.pictures.boards.length > 0 ? { pictures: this.pictures.saved() } : {}) });
  }
  // Throws unless this library has the paint that a state began with, or those between which a gradient made it.
  checkOrigin({ start, of, own }) {
    const known = own ? typeof own.file === "string" : Number.isInteger(start) && start >= 0 && start < this.library.count;
    if (!known) throw new Error(words("This file is no session of a page with this library."));
    if (own) own.gradient?.ends.forEach((end) => this.checkOrigin(end));
    else if (of !== undefined && this.library.paint(start).name !== of) throw new Error(told`A page with another library made this: it starts from "${of}".`);
  }
  // The state that these edits of a library paint lead to. Throws what a request refuses.
  replayed({ start, of, own, steps, name, code }) {
    this.checkOrigin({ start, of, own });
    if (!Array.isArray(steps)) throw new Error(words("This file is no session of a page with this library."));
    let { paint } = this.origin({ start, own });
    if (own) this.engine.ask({ do: "describe", paint });  // refuses what is no paint
    for (const edit of steps) ({ paint } = this.engine.ask({ do: "edit", paint, edit }));
    return { start, of, own, steps, ...(name === undefined ? { paint } : labeled(paint, name, code)) };
  }
  openSession(text) {
    const session = JSON.parse(text), { states: saved, at } = session.history ?? {}, { worn = [] } = session.parts ?? {}, { notes = "", palette: kept = [] } = session, states = [];
    if (session.kind !== "paint-studio session" || ![saved, kept, worn].every(Array.isArray) || !Number.isInteger(at) || !saved[at] || typeof notes !== "string")
      throw new Error(words("This file is no session of a page."));
    for (const one of saved) {
      const last = states.at(-1);
      if (one.edit === undefined || !last) states.push(this.replayed(one));
      else states.push({ start: last.start, of: last.of, own: last.own, steps: [...last.steps, one.edit], goesOn: true,
                         ...labeled(this.engine.ask({ do: "edit", paint: last.paint, edit: one.edit }).paint, one.name ?? last.paint.name, one.code) });
    }
    const palette = kept.map((one) => this.replayed(one));
    const second = session.parts?.second ? this.replayed(session.parts.second) : null;
    this.history = new EditHistory(states, at);
    this.palette = palette;
    this.card.notes.value = notes;
    if (session.pictures || this.pictures.boards.length > 0)
      this.pictures.restore(session.pictures ?? { made: 0, open: -1, boards: [], droppers: [] }).catch((error) => this.say(error.message));
    this.parts.restore(worn, second);
  }
  // Each tab keeps a session of its own, and a new tab begins with the last one. The newest eight stay. Browsers may refuse
  // to store anything, or so much as pictures take; the page then works without.
  store() {
    if (this.pictures.coming > 0) return;  // it stores when they are there
    const refused = (lost) => {
      if (this.storeRefused !== lost) this.say(told`The browser does not keep ${lost}: save the session as a file.`);
      this.storeRefused = lost;
    };
    const small = this.pictures.size <= mostKept;
    if (!small) refused(words("pictures of this size"));
    for (const withPictures of small && this.pictures.size > 0 ? [true, false] : [false])
      try {
        if (!this.tab) {
          this.takeNumber(sessionStorage.getItem("paint-studio tab") ?? newNumber());
          for (const { place } of this.kept().slice(7)) localStorage.removeItem(place);
        }
        localStorage.setItem(this.place, JSON.stringify({ time: Date.now(), session: this.savedSession(withPictures) }));
        return;
      } catch {
        refused(withPictures ? words("pictures of this size") : words("this session"));
      }
  }
  get place() { return `${this.key} ${this.tab}`; }
  takeNumber(tab) { sessionStorage.setItem("paint-studio tab", (this.tab = tab)); }
  // Another tab wrote the session of this one, as a copy of this tab does, or took it away: each has a place of its own.
  keepApart(written) {
    if (written) this.takeNumber(newNumber());
    this.store();
  }
  // The sessions of all tabs, the newest first.
  kept() {
    const places = Object.keys(localStorage).filter((place) => place.startsWith(this.key + " "));
    return places.map((place) => ({ place, ...JSON.parse(localStorage.getItem(place)) })).sort((a, b) => b.time - a.time);
  }
  // A session that cannot be opened stays where it is kept.
  reopen() {
    let found;
    try {
      const kept = this.kept();
      found = kept.find(({ place }) => place === `${this.key} ${sessionStorage.getItem("paint-studio tab")}`) ?? kept[0];
      if (found) this.openSession(found.session);
    } catch (error) {
      if (!found) return;  // the browser keeps nothing
      this.takeNumber(newNumber());
      this.say(error.message);
    }
  }
}

async function begin(code) {
  translatePage();
  try {
    if (typeof DecompressionStream === "undefined") throw new Error(words("This browser cannot decompress the data of the page: it takes a newer one."));
    const data = JSON.parse(taken("data")), module = await WebAssembly.compile(await inflated("compiled")), engine = await makeEngine(module);
    await inflated("index", (size) => engine.attach(size));
    pageNumbers = await inflated("binary");
    const app = new App(engine, data, new PaintStore(taken("paints"), data.layouts), module, code);
    window.studio = app;
    window.studioOpened_ms = performance.now();
    app.stageView.turnAround();
  } catch (error) {
    document.getElementById("status").textContent = "The page cannot start: " + error.message;
    throw error;
  }
}

// A worker, which has no document, runs this script too.
if (typeof document !== "undefined") begin(document.currentScript.textContent);
else if (typeof self !== "undefined") serveLight();
