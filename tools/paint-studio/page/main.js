// The page as a whole: it shows the paint of the history, or the preview of an edit that is being made.

class App {
  constructor(engine, data) {
    this.engine = engine;
    this.data = data;
    this.view = { ...data.mesh.view };
    this.environment = 0;
    this.stops = 0;
    this.palette = [];
    this.dragScale = 1;
    this.key = "paint-studio " + data.title + " " + data.basis.name + " " + data.paints.length;
    engine.ask({ do: "load", basis: data.basis, paints: data.paints.map((one) => one.paint) });
    this.canvas = document.getElementById("stage");
    this.stage = new Stage(this.canvas, data);
    this.controls = new NumberControls(this);
    this.wheel = new Wheel(this);
    this.curves = new Curves(this);
    this.tiles = new Tiles(this);
    this.handoff = new Handoff(this);
    this.makeHeader();
    this.makeStage();
    this.history = new EditHistory([this.fresh(0)]);
    this.reopen();
    this.show();
    new ResizeObserver(() => this.redraw()).observe(this.canvas);
  }

  fresh(number) { return { start: number, steps: [], paint: this.data.paints[number].paint }; }
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
    this.data.paints.forEach((one, i) => library.append(made("option", { value: i, text: one.paint.name })));
    library.addEventListener("change", () => this.start(Number(library.value)));
    byId("undo").addEventListener("click", () => this.turn("undo"));
    byId("redo").addEventListener("click", () => this.turn("redo"));
    byId("metric").addEventListener("change", () => this.tiles.nearest());
    document.addEventListener("keydown", (event) => {
      if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
      const key = event.key.toLowerCase();
      if (key !== "z" && key !== "y") return;
      event.preventDefault();
      this.turn(key === "y" || event.shiftKey ? "redo" : "undo");
    });
  }

  makeStage() {
    const byId = (id) => document.getElementById(id), lights = byId("environment"), exposure = byId("exposure");
    this.data.environments.forEach((one, i) => lights.append(made("option", { value: i, text: one.name })));
    lights.addEventListener("change", () => {
      this.environment = Number(lights.value);
      this.redraw();
      this.tiles.again();
    });
    exposure.addEventListener("input", () => {
      this.stops = Number(exposure.value);
      byId("exposure-value").textContent = exposure.value;
      this.redraw();
    });
    exposure.addEventListener("change", () => this.tiles.again());
    byId("reset-view").addEventListener("click", () => this.look({ ...this.data.mesh.view }));
    let from = null;
    draggable(this.canvas, {
      begin: (event) => { from = { x: event.clientX, y: event.clientY, view: { ...this.view } }; },
      move: (event) => this.look({
        ...from.view,
        azimuth: from.view.azimuth - 0.4 * (event.clientX - from.x),
        elevation: clamped(from.view.elevation + 0.3 * (event.clientY - from.y), -85, 85),
      }, true),
      end: () => this.settle(),
    });
    this.canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.closer(event.deltaY > 0 ? 1.08 : 1 / 1.08);
    }, { passive: false });
    this.canvas.addEventListener("keydown", (event) => {
      const turn = { ArrowLeft: [5, 0], ArrowRight: [-5, 0], ArrowUp: [0, 5], ArrowDown: [0, -5] }[event.key];
      if (turn) this.look({ ...this.view, azimuth: this.view.azimuth + turn[0],
                            elevation: clamped(this.view.elevation + turn[1], -85, 85) });
      else if (event.key === "+" || event.key === "=") this.closer(1 / 1.1);
      else if (event.key === "-") this.closer(1.1);
      else return;
      event.preventDefault();
    });
  }

  closer(factor) {
    const usual = this.data.mesh.view.distance;
    this.look({ ...this.view, distance: clamped(this.view.distance * factor, 0.3 * usual, 4 * usual) });
  }
  look(view, moving = false) {
    this.view = view;
    this.redraw(moving);
    if (!moving) this.settle();
  }
  // After the view came to rest: the small pictures follow.
  settle() {
    clearTimeout(this.settling);
    this.settling = setTimeout(() => this.tiles.again(), 250);
    this.redraw();
  }

  // The paint that an edit would make, shown while it is being made.
  preview(edit) {
    this.wanted = edit;
    this.tiles.stop();
    if (this.frame !== undefined) return;
    this.frame = requestAnimationFrame(() => {
      this.frame = undefined;
      if (this.wanted) this.attempt(() => this.display(this.edited(this.wanted).paint, true));
    });
  }
  edited(edit) { return this.engine.ask({ do: "edit", paint: this.history.now.paint, edit }); }

  // Makes an edit, which becomes a step of the history.
  commit(edit) {
    this.wanted = null;
    this.attempt(() => {
      const done = this.edited(edit), now = this.history.now;
      if (done.skipped.length > 0) {
        this.say("This cannot be done: " + done.skipped.join("; "));
      } else if (JSON.stringify(done.paint) !== JSON.stringify(now.paint)) {
        this.history.push({ start: now.start, steps: [...now.steps, edit], paint: done.paint, goesOn: true });
        this.say(done.clipped.length > 0 ? "Clipped: " + done.clipped.join("; ") : "");
      }
    });
    this.show();
  }
  start(number) { this.restore(this.fresh(number)); }
  restore(state) {
    this.history.push(state);
    this.show();
  }
  turn(way) {
    this.history[way]();
    this.show();
  }
  keep() {
    this.palette.push(this.history.now);
    this.tiles.palette();
    this.store();
  }

  // Shows the paint of the history, and what follows from it.
  show() {
    const now = this.history.now;
    this.attempt(() => this.display(now.paint, false));
    document.getElementById("undo").disabled = !this.history.canUndo;
    document.getElementById("redo").disabled = !this.history.canRedo;
    document.getElementById("library").value = String(now.start);
    this.handoff.show();
    this.attempt(() => this.tiles.again());
    this.store();
  }

  // Shows one paint; `moving` while an edit is being made.
  display(paint, moving) {
    const begin = performance.now();
    const fit = this.engine.ask({ do: "fit", paint });
    const fitted = performance.now();
    this.paint = paint;
    this.weights = this.stage.weights(this.engine.weights(), this.weights ?? null);
    this.description = this.engine.ask({ do: "describe", paint });
    this.controls.show(this.description);
    this.wheel.show(this.description);
    this.curves.show(this.description, fit);
    this.showFigures(fit);
    this.redraw(moving);
    this.times = { fit_us: fit.time_us, request_ms: fitted - begin, show_ms: performance.now() - begin };
  }

  showFigures(fit) {
    const number = (value, digits = 1) => (value === null ? "does not apply" : value.toFixed(digits));
    const { metrics } = this.description;
    const rows = [["Name", this.paint.name], ["Flop index", number(metrics.flop_index)],
                  ["Chroma index", number(metrics.chroma_index)], ["Hue shift index", number(metrics.hue_shift_index)],
                  ["Lobes miss the readings by", `${number(fit.de00_mean, 2)} on average, ${number(fit.de00_max, 2)} at most (CIEDE2000)`]];
    if (fit.gamut_de00 > 0.05) rows.push(["Lost outside the working space", number(fit.gamut_de00, 2) + " (CIEDE2000)"]);
    if (metrics.flags.length > 0) rows.push(["Flags", metrics.flags.join(", ")]);
    document.getElementById("figures").replaceChildren(
      ...rows.flatMap(([name, value]) => [made("dt", { text: name }), made("dd", { text: value })]));
  }

  // Draws the picture: while something moves by few pixels where the computer is slow, at rest with many samples.
  redraw(moving = false) {
    if (!this.weights) return;
    cancelAnimationFrame(this.resting);
    clearTimeout(this.restSoon);
    if (this.drawing !== undefined) cancelAnimationFrame(this.drawing);
    this.drawing = requestAnimationFrame((now) => {
      this.drawing = undefined;
      if (moving && this.lastFrame !== undefined && now - this.lastFrame < 400) {
        const frame = now - this.lastFrame;
        if (frame > 60) this.dragScale = Math.max(0.3, 0.85 * this.dragScale);
        else if (frame < 22) this.dragScale = Math.min(1, 1.1 * this.dragScale);
      }
      this.lastFrame = moving ? now : undefined;
      const [width, height] = this.size(moving ? this.dragScale : 1);
      this.stage.draw(cameraOf(this.view), width, height, this.weights, this.environment, this.stops);
      if (!moving) this.restSoon = setTimeout(() => this.rest(0), 150);
    });
  }
  size(scale) {
    const ratio = Math.min(window.devicePixelRatio || 1, 2) * scale;
    return [Math.max(16, Math.round(this.canvas.clientWidth * ratio)), Math.max(9, Math.round(this.canvas.clientHeight * ratio))];
  }
  // Sharpens a picture at rest, one sample at a time: of 16 to a pixel where the first took little time, else of 4.
  rest(sample, samples = 4) {
    const begin = performance.now();
    this.stage.refine(cameraOf(this.view), this.weights, this.environment, this.stops, sample, samples);
    if (sample === 0 && samples === 4) {
      this.stage.wait();
      if (performance.now() - begin < 40) samples = 16;
      if (samples === 16) sample = -1;
    }
    if (sample + 1 < samples) this.resting = requestAnimationFrame(() => this.rest(sample + 1, samples));
  }

  // The session: the library paints and edits of all states, and the palette. Paints are made again when it is opened.
  savedSession() {
    return JSON.stringify({ kind: "paint-studio session", version: 1, title: this.data.title,
                            history: this.history.saved(), palette: this.palette.map(saidState) });
  }
  // The state that these edits of a library paint lead to. Throws what a request refuses.
  replayed({ start, steps }) {
    if (!Number.isInteger(start) || !this.data.paints[start] || !Array.isArray(steps))
      throw new Error("This file is no session of a page with this library.");
    let paint = this.data.paints[start].paint;
    for (const edit of steps) ({ paint } = this.engine.ask({ do: "edit", paint, edit }));
    return { start, steps, paint };
  }
  openSession(text) {
    const session = JSON.parse(text), saved = session.history?.states, at = session.history?.at, states = [];
    if (session.kind !== "paint-studio session" || !Array.isArray(saved) || !(saved.length > at) || !(at >= 0))
      throw new Error("This file is no session of a page.");
    for (const one of saved) {
      const last = states.at(-1);
      if (one.edit === undefined || !last) states.push(this.replayed(one));
      else states.push({ start: last.start, steps: [...last.steps, one.edit], goesOn: true,
                         paint: this.engine.ask({ do: "edit", paint: last.paint, edit: one.edit }).paint });
    }
    const palette = (session.palette ?? []).map((one) => this.replayed(one));
    this.history = new EditHistory(states, at);
    this.palette = palette;
    this.show();
  }
  // Browsers may refuse to store anything; the page then works without.
  store() {
    try {
      localStorage.setItem(this.key, this.savedSession());
    } catch {
      if (!this.storeRefused) this.say("The browser does not keep this session: save it as a file.");
      this.storeRefused = true;
    }
  }
  reopen() {
    try {
      const text = localStorage.getItem(this.key);
      if (text) this.openSession(text);
    } catch {
      this.history = new EditHistory([this.fresh(0)]);
      this.palette = [];
    }
  }
}

async function begin() {
  const text = (id) => document.getElementById(id).textContent;
  try {
    const data = JSON.parse(text("data")), engine = await makeEngine(bytesOf(text("compiled")), data.paints.length);
    window.studio = new App(engine, data);
  } catch (error) {
    document.getElementById("status").textContent = "The page cannot start: " + error.message;
    throw error;
  }
}

if (typeof document !== "undefined") begin();
