// The large picture: its camera, its light, the border between two paints, and when it is drawn. While something moves it
// has few pixels where the computer is slow; at rest it is drawn in full and then with many samples.

const firstBudget_ms = 30;  // a picture that takes longer is drawn with fewer pixels first
const slowPicture_ms = 40;  // the light of a view at rest is gathered where a picture takes longer
const stepBudget_ms = 40;   // of a draw of a better picture, behind which an edit may have to wait
const idleBudget_ms = 12;   // of a draw of what nobody waits for
const idlePause_ms = 10;    // between those, in which the page answers
const scales = [1, 0.7, 0.5, 0.35];  // few, so that what is visible is seldom drawn anew

class StageView {
  constructor(app) {
    this.app = app;
    this.canvas = document.getElementById("stage");
    this.lost = false;  // whether the graphics are away
    this.stage = new Stage(this.canvas, app.data, app.engine);
    this.view = { ...app.data.mesh.view };
    this.environment = 0;
    this.traced = null;  // the number of the traced view that is shown
    this.stops = 0;
    this.lamp = { on: false, azimuth: 20, elevation: 45, stops: 0 };
    this.border = 0.5;
    this.cars = 1;  // beside each other
    this.cells = [];  // weights of each
    this.level = 0;  // of `scales`, while something moves
    this.slow = this.fast = 0;  // frames in a row
    this.full_ms = 0;  // what a picture of all pixels took, once that is known
    this.gathered_ms = 0;  // the same from gathered light
    this.sharp = true;  // whether the picture is drawn with all samples
    this.times = {};  // first_ms, sharp_ms: from an edit or a move to its first picture, and to that of all samples
    this.makeControls();
    this.shadow();
    new ResizeObserver(() => {
      this.full_ms *= this.area ? (this.canvas.clientWidth * this.canvas.clientHeight) / this.area : 1;
      this.area = this.canvas.clientWidth * this.canvas.clientHeight;
      this.redraw();
    }).observe(this.canvas);
  }

  // How cars stand beside each other: two below each other where the picture is not wide.
  get grid() {
    const columns = this.cars === 2 && this.canvas.clientWidth < 1.3 * this.canvas.clientHeight ? 1 : Math.min(2, this.cars);
    return { columns, rows: this.cars / columns };
  }
  get camera() {
    const { columns, rows } = this.grid, { clientWidth, clientHeight } = this.canvas;
    return this.traced !== null ? this.app.data.views[this.traced].camera : widened(cameraOf(this.view), (clientWidth * rows) / (clientHeight * columns));
  }
  // Draws by graphics that are new, after they were lost.
  begin() {
    const { turn, lamp, ground, finishes } = this.stage;
    this.stage = Object.assign(new Stage(this.canvas, this.app.data, this.app.engine), { lamp, ground, finishes });
    this.stage.turnTo(turn);
    this.lost = false;
    this.cells = [];
    this.app.graphicsCame();
    this.shadow();
  }
  // True if all else waits for the picture.
  get comesFirst() { return !this.sharp || (this.lastFrame !== undefined && this.full_ms > 16); }
  // Finds the shadow of the mesh on itself between pictures.
  shadow() {
    const { stage } = this, go = async () => {
      if (stage !== this.stage || this.lost) return;
      const waits = this.comesFirst;
      if (!waits && !stage.occlusion.step()) return this.redraw();
      if (!waits) await stage.drawn();
      if (this.search === go) this.shadowing = setTimeout(go, waits ? 100 : idlePause_ms);
    };
    this.search = go;
    stage.occlusion.begin();
    clearTimeout(this.shadowing);
    this.shadowing = setTimeout(go, idlePause_ms);
  }
  // Shows another mesh, whose numbers are those bytes.
  takeMesh(mesh, bytes) {
    for (const name of ["positions", "normals", "corners"]) mesh[name].push(bytes);
    this.app.data.mesh = mesh;
    for (const light of this.app.data.environments) delete light.ground_light;  // the shadow of the mesh before
    this.view = { ...mesh.view };
    if (this.traced !== null) this.choose(document.getElementById("environment").value = "0");
    document.querySelector("#environment optgroup")?.remove();  // views of the mesh before
    this.stage.drop();
    this.begin();
    this.app.parts.forMesh();
  }
  // Shows the mesh in another light.
  takeLight(light, bytes) {
    for (const { texels } of [...light.cubes, ...(light.discs ? [light.discs] : [])]) texels.push(bytes);
    const list = document.getElementById("environment"), number = this.app.data.environments.push(light) - 1;
    this.stage.environments.push(null);
    this.shadow();
    list.insertBefore(made("option", { value: number, text: light.name }), list.querySelector("optgroup"));
    list.value = String(number);
    this.choose(list.value);
  }
  get weights() {
    const own = this.app.weights, other = this.app.compared.weights;
    return other ? { left: own, right: other, at: this.border } : own;
  }
  // Where the light stands that angles are counted from, as the environment sees it, and the angle that it spans.
  get light() {
    if (this.traced !== null) {
      const { direction, extent } = this.app.data.views[this.traced].brightest;
      return { toward: turnedAgainst(direction, this.stage.turn), extent };
    }
    const { direction, extent } = this.app.data.environments[this.environment].brightest;
    if (this.lamp.on) return { toward: turnedAgainst(this.lampDirection, this.stage.turn), extent: this.app.data.lamp.extent };
    return { toward: direction, extent };
  }
  get lampDirection() { return orbitDirection(this.lamp.azimuth, this.lamp.elevation); }
  get sparkles() { return document.getElementById("sparkle").checked; }
  get overlay() {
    if (!document.getElementById("overlay").checked || !this.app.description) return null;
    return { toward: this.light.toward, travel: this.app.description.appearance.travel, edge: this.app.highlight };
  }

  makeControls() {
    const byId = (id) => document.getElementById(id), lights = byId("environment"), exposure = byId("exposure");
    this.app.data.environments.forEach((one, i) => lights.append(made("option", { value: i, text: one.name })));
    const views = this.app.data.views.map((one, i) => made("option", { value: `view ${i}`, text: one.name }));
    if (views.length > 0) lights.append(made("optgroup", { label: words("Traced views") }, views));
    lights.addEventListener("change", () => this.choose(lights.value));
    exposure.addEventListener("input", () => {
      this.stops = Number(exposure.value);
      byId("exposure-value").textContent = exposure.value;
      this.redraw(true);
    });
    exposure.addEventListener("change", () => this.settle());
    byId("reset-view").addEventListener("click", () => this.look({ ...this.app.data.mesh.view }));
    const turn = byId("turn"), range = byId("turn-range");
    range.addEventListener("input", () => this.turnTo(Number(range.value), true));
    range.addEventListener("change", () => this.turnTo(Number(range.value)));
    turn.addEventListener("change", () => this.turnTo(turn.valueAsNumber));
    byId("lamp").addEventListener("change", () => this.setLamp({ on: byId("lamp").checked }));
    for (const [name, low, high] of [["azimuth", -180, 180], ["elevation", -90, 90], ["stops", -6, 6]]) {
      const field = byId("lamp-" + name);
      field.addEventListener("change", () => {
        if (Number.isFinite(field.valueAsNumber)) this.setLamp({ on: true, [name]: clamped(field.valueAsNumber, low, high) });
        else this.showLamp();
      });
    }
    for (const id of ["overlay", "sparkle"]) byId(id).addEventListener("change", () => this.redraw());
    byId("ground").addEventListener("change", () => {
      this.stage.ground = byId("ground").checked;
      this.settle();
    });
    this.makeBorder();
    // The wheel comes closer where the picture has the focus, and with Ctrl; else it scrolls the panels.
    this.canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      if (event.ctrlKey || document.activeElement === this.canvas) this.closer(event.deltaY > 0 ? 1.08 : 1 / 1.08);
      else byId("controls").scrollBy(0, event.deltaY);
    }, { passive: false });
    byId("car-count").addEventListener("change", () => this.setCars(Number(byId("car-count").value)));
    byId("save-picture").addEventListener("click", () => this.savePicture());
    byId("full-screen").addEventListener("click", () => {
      if (document.fullscreenElement) document.exitFullscreen();
      else byId("stage-section").requestFullscreen().catch(() => this.app.say(words("This browser shows no part of a page on the full screen.")));
    });
    this.canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault();
      this.lost = true;
      this.rest(null);
      this.app.say(words("The graphics of this computer were reset: the picture comes back when they do. Nothing is lost."));
    });
    this.canvas.addEventListener("webglcontextrestored", () => this.app.attempt(() => {
      this.begin();
      this.app.say(words("The graphics are back."));
    }));
    this.showLamp();
  }

  // Shows the mesh in an environment, by its number, or a traced view, "view" and its number.
  choose(value) {
    this.traced = value.startsWith("view ") ? Number(value.slice(5)) : null;
    const fixed = this.traced !== null, view = this.app.data.views[this.traced];
    this.takeBack();
    if (fixed && this.cars > 1) this.setCars(Number((document.getElementById("car-count").value = "1")));
    for (const one of document.querySelectorAll("#car-count, #turn, #turn-range, #lamp, #lamp-azimuth, #lamp-elevation, #lamp-stops, #reset-view, #ground, #drag-kinds .around"))
      one.disabled = fixed;
    const box = document.getElementById("stage-box");
    box.classList.toggle("shaped", fixed);
    if (fixed) box.style.setProperty("--shape", view.width / view.height);
    this.app.surface.setKind(this.app.surface.kind);
    if (fixed) {
      this.lightChanged();
    } else {
      this.environment = Number(value);
      this.setLamp({});  // its brightness is relative to the environment's
    }
    this.showTraced();
  }
  // The text about a traced view.
  showTraced() {
    const place = document.getElementById("traced-text"), text = this.traced === null ? "" : this.app.traced.text(this.traced);
    place.hidden = this.traced === null;
    if (place.textContent !== text) place.textContent = text;
  }

  // The handle of the border between the paint and the one that it is compared with.
  makeBorder() {
    const handle = document.getElementById("border");
    const to = (part, moving) => {
      this.border = clamped(part, 0, 1);
      this.showBorder();
      this.redraw(moving);
    };
    draggable(handle, {
      move: (event) => {
        const box = this.canvas.getBoundingClientRect();
        to((event.clientX - box.left) / box.width, true);
      },
      end: () => this.redraw(),
    });
    handle.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: -0.02, ArrowRight: 0.02, Home: -1, End: 1 }[event.key];
      if (!step) return;
      event.preventDefault();
      to(this.border + step * (event.shiftKey ? 5 : 1), false);
    });
  }
  showBorder() {
    const handle = document.getElementById("border"), shown = this.app.compared.weights !== null && this.cars === 1;
    handle.hidden = !shown;
    handle.style.left = `${100 * this.border}%`;
    handle.setAttribute("aria-valuenow", Math.round(100 * this.border));
    for (const side of ["left", "right"]) document.getElementById("side-" + side).hidden = !shown;
    document.getElementById("side-right").textContent = this.app.compared.name;
    document.getElementById("side-left").textContent = this.app.paint ? this.app.paint.name : "";
  }

  // The environment turned by these degrees.
  turnTo(degrees, moving = false) {
    if (!Number.isFinite(degrees)) return this.showLamp();
    const turned = ((((degrees + 180) % 360) + 360) % 360) - 180;
    this.stage.turnTo(turned);
    document.getElementById("turn").value = rounded(turned, 1);
    document.getElementById("turn-range").value = turned;
    this.lightChanged(moving);
  }
  // Members of the lamp: on, azimuth, elevation, stops.
  setLamp(members, moving = false) {
    Object.assign(this.lamp, members);
    const white = 2 ** this.lamp.stops * (this.app.data.environments[this.environment].white || 1);
    this.stage.lamp = this.lamp.on ? { direction: this.lampDirection, white: [white, white, white] } : null;
    this.showLamp();
    this.lightChanged(moving);
  }
  showLamp() {
    const set = (id, value) => { document.getElementById(id).value = rounded(value, 1); };
    document.getElementById("lamp").checked = this.lamp.on;
    for (const name of ["azimuth", "elevation", "stops"]) set("lamp-" + name, this.lamp[name]);
    set("turn", this.stage.turn);
  }
  lightChanged(moving = false) {
    this.app.lightChanged();
    if (moving) this.redraw(true);
    else this.settle();
  }

  closer(factor, moving = false) {
    if (this.traced !== null) return;
    const usual = this.app.data.mesh.view.distance;
    this.look({ ...this.view, distance: clamped(this.view.distance * factor, 0.05 * usual, 4 * usual) }, moving);
  }
  // Moves the target of the camera, by pixels of the window: the surface at the target follows the pointer.
  pan(view, dx, dy) {
    if (this.traced !== null) return;
    const { fov } = this.camera, pixel = (2 * view.distance * Math.tan((fov * Math.PI) / 360)) / this.canvas.clientHeight;
    const forward = scaled(orbitDirection(view.azimuth, view.elevation), -1), right = unit(crossed(forward, [0, 1, 0])), down = crossed(forward, right);
    this.look({ ...view, target: added(added(view.target, right, -dx * pixel), down, -dy * pixel) }, true);
  }
  // From now on the camera goes around the point of the mesh under a place of the window.
  retarget(clientX, clientY) {
    if (this.traced !== null) return;
    const hit = this.hit(clientX, clientY);
    if (hit) this.look({ ...this.view, target: hit.point });
  }
  // The point and the part of the mesh under a place of the window, as pointUnder() has them.
  hit(clientX, clientY) {
    const { x, y, aspect } = this.partsOf(clientX, clientY);
    return this.stage.pointUnder(this.camera, aspect, x, y);
  }
  // Shows what a link holds.
  see({ view, usual, light, stops, lamp, turn }) {
    const { environments, mesh } = this.app.data, environment = environments.findIndex(({ name }) => name === light);
    if (environment < 0) return this.app.say(told`This page does not have the light of the link: ${light}.`);
    if (usual !== mesh.view.distance) view = { ...mesh.view, azimuth: view.azimuth, elevation: view.elevation };  // of another mesh
    for (const [id, value] of [["environment", environment], ["exposure", stops]]) document.getElementById(id).value = value;
    document.getElementById("exposure-value").textContent = stops;
    Object.assign(this, { view, stops });
    this.choose(String(environment));
    this.turnTo(turn);
    return this.setLamp(lamp);
  }
  // Goes slowly around the mesh until somebody touches the page, where pictures are fast and motion is welcome.
  turnAround() {
    if (matchMedia("(prefers-reduced-motion: reduce)").matches) return;
    const stop = new AbortController(), { signal } = stop;
    for (const kind of ["pointerdown", "keydown", "wheel", "hashchange"]) window.addEventListener(kind, () => stop.abort(), { signal, capture: true });
    let last = null;
    const step = (now) => {
      if (signal.aborted) return this.settle();
      if (last !== null && this.traced === null) this.look({ ...this.view, azimuth: this.view.azimuth + 0.012 * Math.min(50, now - last) }, true);
      last = now;
      return requestAnimationFrame(step);
    };
    const begin = () => {
      if (signal.aborted || this.full_ms > 16) return;
      if (this.full_ms > 0) requestAnimationFrame(step);
      else setTimeout(begin, 500);
    };
    begin();
  }
  // The picture as the page shows it, in a PNG.
  savePicture() {
    const light = this.traced !== null ? this.app.data.views[this.traced].name : this.app.data.environments[this.environment].name;
    this.canvas.toBlob((blob) => save(`${fileName(this.app.paint.name)}-${fileName(light)}.png`, blob, "image/png"));
  }
  look(view, moving = false) {
    this.view = view;
    if (moving) this.redraw(true);
    else this.settle();
  }
  // After the view or the light came to rest: the small pictures follow.
  settle() {
    clearTimeout(this.settling);
    this.settling = setTimeout(() => this.app.tiles.again(), 250);
    this.redraw();
  }

  // Asks for a picture in the next frame.
  redraw(moving = false) {
    if (!this.app.weights) return;
    if (this.drawing !== undefined) cancelAnimationFrame(this.drawing);
    this.drawing = requestAnimationFrame((now) => this.drawNow(moving, now));
  }
  // Draws it at once: the frame is known that it belongs to.
  drawNow(moving, now = performance.now()) {
    if (this.drawing !== undefined) cancelAnimationFrame(this.drawing);
    this.drawing = undefined;
    clearTimeout(this.still);
    if (this.lost) return;
    if (moving) this.still = setTimeout(() => this.redraw(), 600);  // a slider that ends where it began tells no change
    this.rest(null);
    const since = this.since = this.asked ?? performance.now();
    this.asked = undefined;
    this.sharp = moving || this.traced !== null;
    this.drawFirst(moving, now);
    if (!moving) this.stage.drawn().then(() => { this.times.first_ms = performance.now() - since; });
  }
  drawFirst(moving, now) {
    this.stage.occlusion.held = moving && this.full_ms > 16;
    this.stage.sparkling = this.sparkles && this.full_ms > 0 && this.full_ms <= 16;
    if (moving && this.lastFrame !== undefined && now - this.lastFrame < 400) this.pace(now - this.lastFrame);
    this.lastFrame = moving ? now : undefined;
    if (this.traced !== null) {
      this.stage.gathered.drop();
      this.drawTraced(moving);
      if (!moving) this.app.tiles.go();
      return;
    }
    if (this.cars > 1) {
      this.drawCars(moving);
      return;
    }
    if (this.drawGathered(moving)) return;
    const known_ms = this.full_ms || Infinity, first = scales.find((scale) => scale * scale * known_ms <= firstBudget_ms) ?? scales.at(-1);
    const scale = moving ? Math.min(scales[this.level], first) : first, begin = performance.now();
    this.stage.draw(scale < 1 ? "first" : "centers", ...this.picture(scale), this.overlay);
    if (moving) return;
    this.rest(this.finishing(this.sharpening(scale)));
    // A picture that takes longer than the one before, as of another mesh, is measured again.
    if (scale === 1) this.stage.drawn().then(() => { if (performance.now() - begin > slowPicture_ms) this.full_ms = performance.now() - begin; });
  }
  // Whole cars beside each other in the same view and light: the design, and the paints of app.beside().
  drawCars(moving) {
    const [width, height] = this.size(moving ? scales[this.level] : 1), { columns, rows } = this.grid, paints = [this.app.paint, ...this.app.beside(this.cars - 1)];
    paints.forEach((paint, i) => {
      if (this.cells[i]?.paint === paint) return;
      this.app.engine.ask({ do: "fit", paint });
      this.cells[i] = Object.assign(this.stage.weights(this.app.engine, this.cells[i] ?? null), { paint });
    });
    const steps = (samples) => this.stage.showCells(this.camera, Math.floor(width / columns), Math.floor(height / rows), columns, paints.map((_, i) => this.cells[i]), this.environment, this.stops, samples);
    for (const _ of steps(1));
    document.getElementById("cars").style.gridTemplateColumns = `repeat(${columns}, 1fr)`;
    document.getElementById("cars").replaceChildren(...paints.map(({ name }) => made("span", { text: name })));
    if (!moving) this.rest(this.finishing(steps(4)));
  }
  setCars(count) {
    this.cars = count;
    this.cells = [];
    document.getElementById("cars").hidden = count === 1;
    this.showBorder();
    this.redraw();
  }
  // A place of the window as parts of the picture, or of its car where there are several.
  partsOf(clientX, clientY) {
    const box = this.canvas.getBoundingClientRect(), { columns, rows } = this.grid;
    const x = (columns * (clientX - box.left)) / box.width, y = (rows * (clientY - box.top)) / box.height;
    return { x: x - clamped(Math.floor(x), 0, columns - 1), y: y - clamped(Math.floor(y), 0, rows - 1), aspect: (box.width * rows) / (box.height * columns) };
  }
  // Draws an edit of a view at rest; returns whether it did.
  drawGathered(moving) {
    const scale = this.gatheredScale, name = scale < 1 ? "gathered" : "centers", expected_ms = this.gathered_ms || 0.7 * scale * scale * this.full_ms;
    const stride = clamped(Math.ceil(Math.sqrt(expected_ms / firstBudget_ms)), 1, 4);
    if (!this.stage.drawGathered(name, ...this.picture(scale), this.overlay, stride)) return false;
    if (!moving) this.rest(this.finishing(this.sharpening(scale, stride)));
    return true;
  }
  // The light is gathered at as many pixels as memory allows for half of all layers, which is what a paint takes.
  get gatheredScale() {
    return scales.find((scale) => this.stage.gathered.capacity(...this.size(scale)) > this.stage.gathered.layers.list.length / 2) ?? scales.at(-1);
  }
  drawTraced(moving) {
    const drawn = this.app.attempt(() => {
      this.app.traced.draw(this.traced, this.weights, this.stops, this.overlay, moving);
      return true;
    });
    if (drawn) {
      this.takeBack();
    } else {
      this.app.traced.answer = null;
      this.stage.blank();
      this.refusal = document.getElementById("status").textContent;
    }
    this.showTraced();
  }
  // Takes back what was said of a paint that a view cannot show.
  takeBack() {
    if (this.refusal && document.getElementById("status").textContent === this.refusal) this.app.say("");
    this.refusal = "";
  }
  // Takes fewer pixels after slow frames, and more after fast ones.
  pace(frame_ms) {
    this.slow = frame_ms > 70 ? this.slow + 1 : 0;
    this.fast = frame_ms < 25 ? this.fast + 1 : 0;
    if (this.slow >= 2) this.level = Math.min(scales.length - 1, this.level + 1);
    if (this.fast >= 8) this.level = Math.max(0, this.level - 1);
    if (this.slow >= 2 || this.fast >= 8) this.slow = this.fast = 0;
  }
  size(scale) {
    const ratio = Math.min(window.devicePixelRatio || 1, 2) * scale;
    return [Math.max(16, Math.round(this.canvas.clientWidth * ratio)), Math.max(9, Math.round(this.canvas.clientHeight * ratio))];
  }

  // The camera, size, paint and light of a picture of so many pixels, as Stage takes them.
  picture(scale) { return [this.camera, ...this.size(scale), this.weights, this.environment, this.stops]; }

  // The steps from a picture of those pixels to one of all and of many samples, or of four where the pixels took long.
  *sharpening(scale, stride = 1) {
    const { stage } = this;
    if (stride > 1) {
      yield* this.gathering(false);
      stage.drawGathered(scale < 1 ? "gathered" : "centers", ...this.picture(scale), this.overlay);
      this.gathered_ms = yield;
    }
    if (scale < 1) {
      const took_ms = yield* stage.drawSteps("centers", ...this.picture(1), stepBudget_ms, this.overlay);
      this.full_ms = this.full_ms === 0 ? took_ms : 0.5 * (this.full_ms + took_ms);
    }
    yield* this.smoothing(this.full_ms < slowPicture_ms ? mostSamples : 4);
  }
  smoothing(samples, budget_ms = stepBudget_ms) {
    return this.stage.smoothSteps("centers", this.camera, this.weights, this.environment, this.stops, samples, this.overlay, this.sparkles, budget_ms);
  }
  // The steps that gather the light of the view: what the paint needs, or all that there is room for.
  *gathering(others, budget_ms = stepBudget_ms) {
    const scale = this.gatheredScale, [camera, width, height, weights, environment] = this.picture(scale);
    for (let rows = 8; this.stage.gather(scale < 1 ? "gathered" : "centers", camera, width, height, weights, environment, others, rows);)
      rows = clamped(Math.floor((rows * budget_ms) / (yield)), 8, 4 * rows);
  }
  // Those steps, and then the small pictures and, where pictures take long, the light of the view and the samples that are left.
  *finishing(steps) {
    const { since } = this;
    yield* steps;
    yield;
    this.sharp = true;
    this.times.sharp_ms = performance.now() - since;
    this.app.tiles.go();
    if (this.full_ms < slowPicture_ms || this.cars > 1 || this.stage.occlusion.busy) return;
    yield* this.gathering(true, idleBudget_ms);
    yield* this.smoothing(mostSamples, idleBudget_ms);
  }

  // Runs steps, in the place of those that ran before. Each waits until the one before is drawn and is told how long that took, so that the
  // page can answer between them.
  rest(steps) {
    clearTimeout(this.resting);
    this.steps = steps;
    const next = async (took_ms) => {
      const begin = performance.now();
      if (this.steps !== steps || steps.next(took_ms).done) return;
      await this.stage.drawn();  // which is known after the page has answered
      next(performance.now() - begin);
    };
    if (steps) this.resting = setTimeout(next, 0, 0);
  }
  // The surface under a place of the window: null beside the mesh. `angle` is the aspecular angle to the light, and what is `lit` wears the
  // paint.
  pointAt(clientX, clientY) {
    const { x, y, aspect } = this.partsOf(clientX, clientY), seen = this.stage.surfaceAt(this.camera, aspect, x, y);
    if (!seen) return null;
    const mirror = mirrored(seen), { toward } = this.light;
    return { ...seen, mirror, angle: angleBetween(mirror, toward), lit: seen.painted && dotted(seen.normal, toward) > 0 };
  }
}
