// Small pictures of paints: the nine variations, the nearest paints of the library, and the palette. They are drawn one
// by one between pictures of the stage, each with the view and the light of the large picture.

class Tiles {
  constructor(app) {
    this.app = app;
    this.waiting = [];
    this.weights = null;
    document.getElementById("variation-kind").addEventListener("change", () => this.variations());
    document.getElementById("variation-step").addEventListener("change", () => this.variations());
    document.getElementById("keep").addEventListener("click", () => app.keep());
  }

  canvas(width, height) {
    const canvas = made("canvas", { width, height, "aria-hidden": "true" });
    canvas.getContext("2d", { colorSpace: this.app.stage.screen });
    return canvas;
  }
  // A button with a picture. It calls chosen() when it is pressed.
  tile(paint, name, note, chosen, current = false) {
    const canvas = this.canvas(208, 117);
    const button = made("button", { type: "button", class: "tile", onclick: chosen },
                        [canvas, made("span", { text: name }), ...(note ? [made("small", { text: note })] : [])]);
    if (current) button.setAttribute("aria-current", "true");
    this.waiting.push({ canvas, paint });
    return button;
  }

  // Puts tiles in a place. Until a tile is drawn it shows what stood there before.
  put(place, tiles) {
    tiles.forEach((tile, i) => {
      const before = place.children[i]?.querySelector("canvas");
      if (before) tile.querySelector("canvas").getContext("2d").drawImage(before, 0, 0);
    });
    const held = [...place.children].findIndex((one) => one.contains(document.activeElement));
    place.replaceChildren(...tiles);
    const next = tiles[held];
    (next?.querySelector("button") ?? next)?.focus({ preventScroll: true });
    this.go();
  }

  // The nine variations: the paint itself, and its neighbors.
  variations() {
    const app = this.app, of = document.getElementById("variation-kind").value;
    const step = document.getElementById("variation-step").valueAsNumber, place = document.getElementById("variations");
    if (!(step > 0)) return;
    const list = app.engine.ask({ do: "variations", paint: app.paint, of, step }).list;
    const tiles = list.map((one) => this.tile(one.paint, one.name.replace(/[a-z]+/g, words), "", () => app.commit(one.edit)));
    tiles.splice(Math.ceil(tiles.length / 2), 0, this.tile(app.paint, words("as it is"), "", () => {}, true));
    this.put(place, tiles);
  }

  nearest() {
    const app = this.app, place = document.getElementById("nearest"), metric = document.getElementById("metric").value;
    let answer;
    document.getElementById("verdict").textContent = "";
    try {
      answer = app.engine.ask({ do: "nearest", paint: app.paint, metric, count: 5 });
    } catch (error) {
      place.replaceChildren(made("p", { class: "hint", text: error.message }));
      return;
    }
    const verdicts = [];
    if (answer.outside) verdicts.push(words("The design lies outside the library: its nearest paint differs by more than 10 on average."));
    if (answer.off_radial) verdicts.push(words("Its hue turns in another way than that of its nearest paint (off-radial)."));
    if (answer.hue_travel !== null && answer.matched_hue_travel !== null)
      verdicts.push(told`From face to flop its hue turns by ${answer.hue_travel.toFixed(0)}°, and that of the nearest paint, whose way is dashed in the wheel, by ${answer.matched_hue_travel.toFixed(0)}°.`);
    app.near = answer.list.map(({ place: number }) => number);
    app.wheel.showMatch(app.near.length > 0 ? app.attempt(() => app.engine.ask({ do: "describe", paint: app.library.paint(app.near[0]) }).curve) ?? [] : []);
    document.getElementById("verdict").textContent = verdicts.join(" ");
    this.put(place, answer.list.map((match) => {
      const differences = Object.entries(match.de_by_geometry).map(([geometry, de]) => `${geometry} ${de.toFixed(1)}`);
      const note = (match.code ? match.code + ", " : "") + told`sum ${match.distance.toFixed(2)}: ${differences.join(", ")}`;
      const start = made("button", { type: "button", class: "corner", "aria-label": told`Start from ${match.name}`, title: "Start from this paint", words: "start", onclick: () => app.start(match.place) });
      return made("div", { class: "kept" }, [this.tile(app.library.paint(match.place), match.name, note, () => app.compareWith(match.place)), start]);
    }));
  }

  palette() {
    const app = this.app, place = document.getElementById("palette");
    this.put(place, app.palette.map((state, number) => {
      const { name } = state.paint, tile = this.tile(state.paint, `${number + 1}: ${name}`, "", () => app.restore(state));
      const remove = made("button", { type: "button", class: "remove corner", "aria-label": told`Remove ${name} from the palette`, title: "Remove", text: "×", onclick: () => app.arrange(number, -1) });
      return made("div", { class: "kept", draggable: "true", ondragstart: (event) => event.dataTransfer.setData("application/x-kept", String(number)),
                           ondragover: (event) => { if (event.dataTransfer.types.includes("application/x-kept")) event.preventDefault(); },
                           ondrop: (event) => {
                             const from = event.dataTransfer.getData("application/x-kept");
                             if (from === "") return;
                             event.preventDefault();
                             event.stopPropagation();
                             app.arrange(Number(from), number);
                           } }, [tile, remove]);
    }));
  }

  // All of them again, after the view or the light changed.
  again() {
    this.waiting = [];
    this.variations();
    this.nearest();
    this.palette();
  }

  go() {
    if (this.timer === undefined) this.timer = setTimeout(() => this.drawNext(), idlePause_ms);
  }
  stop() {
    if (this.timer !== undefined) clearTimeout(this.timer);
    this.timer = undefined;
  }
  async drawNext() {
    this.timer = undefined;
    // They go on after the picture, and have the shadow that is sought.
    if (this.app.stageView.lost || this.app.stageView.comesFirst || this.app.stage.occlusion.busy) return;
    while (this.waiting.length > 0 && !this.waiting[0].canvas.isConnected) this.waiting.shift();
    const next = this.waiting.shift(), app = this.app, now = {};
    if (!next) return;
    this.timer = now;
    try {
      if (app.stageView.traced !== null) await this.drawTraced(next);
      else await this.drawTile(next, app.stageView.view);
    } catch (error) {
      next.canvas.replaceWith(made("small", { text: error.message }));
    }
    if (this.timer !== now) return;
    this.timer = undefined;
    this.go();
  }
  async drawTile({ canvas, paint }, view) {
    const { app } = this, { width, height } = canvas;
    app.engine.ask({ do: "fit", paint });
    this.weights = app.stage.weights(app.engine, this.weights);
    const picture = await app.stage.tile(cameraOf({ ...view, distance: 0.8 * view.distance }), width, height, this.weights, app.stageView.environment, app.stageView.stops);
    canvas.getContext("2d").putImageData(picture, 0, 0);
  }
  // The whole traced view, in the middle of the tile.
  async drawTraced({ canvas, paint }) {
    const { app } = this, picture = await app.traced.tile(app.stageView.traced, paint, app.stageView.stops);
    const whole = this.canvas(picture.width, picture.height), scale = Math.min(canvas.width / picture.width, canvas.height / picture.height);
    whole.getContext("2d").putImageData(picture, 0, 0);
    const context = canvas.getContext("2d"), width = scale * picture.width, height = scale * picture.height;
    context.clearRect(0, 0, canvas.width, canvas.height);
    context.drawImage(whole, (canvas.width - width) / 2, (canvas.height - height) / 2, width, height);
  }
}
