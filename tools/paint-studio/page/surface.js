// The actions of the pointer and the keyboard on the picture, and the values under them: the aspecular angle, the color that the paint has
// there, and a cross with buttons that move that color. [Shimizu2009] 3.6

const dragKinds = {
  view: "Dragging goes around the mesh; arrow keys do so too. A click on a part lets you choose what it wears.",
  light: "Dragging turns the light around the mesh; arrow keys do so too.",
  lamp: "The highlight of the lamp goes where you drag it; arrow keys move the lamp.",
  color: "Drag the cross over the picture, or move it by arrow keys; its buttons change the color there.",
  travel: "The color stops changing where you drag to; arrow keys change the travel.",
  gloss: "The highlight falls to half its brightness where you drag to; arrow keys change the gloss.",
};

class Surface {
  constructor(app) {
    this.app = app;
    this.canvas = document.getElementById("stage");
    this.cross = null;  // where the cross stands, as parts of the picture
    this.hover = null;  // where the pointer is, in the window
    this.text = document.getElementById("under-text");
    this.swatch = document.getElementById("under-swatch");
    document.querySelectorAll("input[name=drag]").forEach((radio) => radio.addEventListener("change", () => this.setKind(radio.value)));
    this.setKind("view");
    this.makeTweaks();
    this.makePointer();
    this.canvas.addEventListener("keydown", (event) => this.key(event));
  }

  // True if dragging would move the camera or the light of a traced view, which stay.
  get fixed() { return this.app.stageView.traced !== null && ["view", "light", "lamp"].includes(this.kind); }

  setKind(kind) {
    this.kind = kind;
    document.getElementById("drag-hint").textContent = words(this.fixed ? "The camera and the light of a traced view stay as they are." : dragKinds[kind]);
    if (kind === "lamp" && !this.fixed && !this.app.stageView.lamp.on) this.app.stageView.setLamp({ on: true });
    if (kind === "color") this.placeCross(this.cross ?? [0.5, 0.5]);
    else this.placeCross(null);
  }

  makePointer() {
    const view = this.app.stageView;
    let from = null, last = null;
    this.makeFingers(() => { last = null; });
    draggable(this.canvas, {
      begin: (event) => {
        from = { x: event.clientX, y: event.clientY, view: { ...view.view }, turn: view.stage.turn, moved: false };
        last = null;
        if (this.kind !== "view" && this.kind !== "light") last = this.dragged(event, from) ?? last;
      },
      move: (event) => {
        from.moved ||= Math.hypot(event.clientX - from.x, event.clientY - from.y) > 4;
        last = this.dragged(event, from) ?? last;
      },
      end: () => {
        if (this.kind === "view" && !this.fixed && !from.moved && !this.pinched) this.app.parts.choose(view.hit(from.x, from.y)?.part ?? null);
        if (this.kind === "travel" || this.kind === "gloss") {
          if (last) this.app.commit(last);
        } else if (this.kind !== "color" && !this.fixed) {
          view.settle();
        }
      },
    });
    let soon;
    this.canvas.addEventListener("pointermove", (event) => {
      if (event.buttons !== 0 || this.kind === "color") return;
      cancelAnimationFrame(soon);
      this.hover = [event.clientX, event.clientY];
      soon = requestAnimationFrame(() => this.read(event.clientX, event.clientY));
    });
    this.canvas.addEventListener("pointerleave", () => {
      cancelAnimationFrame(soon);
      this.hover = null;
      if (this.kind !== "color") this.show(null);
    });
  }

  // Two fingers come closer and move the target, as the right button does; a double click goes around what is under it.
  makeFingers(stop) {
    const view = this.app.stageView;
    let pair = null;  // {span, x, y, view} at the last move
    this.fingers = new Map();
    const now = () => {
      const [a, b] = [...this.fingers.values()];
      return { span: Math.max(1, Math.hypot(a.x - b.x, a.y - b.y)), x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
    };
    this.canvas.addEventListener("pointerdown", (event) => {
      if (event.pointerType === "touch") this.fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
      this.pinched = this.fingers.size > 1;  // until another finger comes alone
      if (this.fingers.size !== 2) return;
      stop();
      this.app.abandon();
      pair = now();
    }, { capture: true });
    this.canvas.addEventListener("pointermove", (event) => {
      if (!this.fingers.has(event.pointerId)) return;
      this.fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
      if (this.fingers.size !== 2) return;
      const next = now();
      view.pan(view.view, next.x - pair.x, next.y - pair.y);
      view.closer(pair.span / next.span, true);
      pair = next;
    });
    for (const kind of ["pointerup", "pointercancel"])
      this.canvas.addEventListener(kind, (event) => {
        if (this.fingers.delete(event.pointerId) && this.fingers.size === 1) view.settle();
      });
    this.canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    draggable(this.canvas, {
      begin: (event) => { pair = { x: event.clientX, y: event.clientY, view: view.view }; },
      move: (event) => view.pan(pair.view, event.clientX - pair.x, event.clientY - pair.y),
      end: () => view.settle(),
    }, 2);
    this.canvas.addEventListener("dblclick", (event) => { if (this.kind === "view") view.retarget(event.clientX, event.clientY); });
  }

  // One move of a drag; the edit that it stands for, if it is one.
  dragged(event, from) {
    const view = this.app.stageView, dx = event.clientX - from.x, dy = event.clientY - from.y;
    if (this.fixed || this.pinched) return null;
    if (this.kind === "view") {
      view.look({ ...from.view, azimuth: from.view.azimuth - 0.4 * dx, elevation: clamped(from.view.elevation + 0.3 * dy, -85, 85) }, true);
    } else if (this.kind === "light") {
      view.turnTo(from.turn + 0.4 * dx, true);
    } else if (this.kind === "color") {
      const box = this.canvas.getBoundingClientRect();
      this.placeCross([clamped((event.clientX - box.left) / box.width, 0, 1), clamped((event.clientY - box.top) / box.height, 0, 1)]);
    } else {
      const seen = view.pointAt(event.clientX, event.clientY);
      this.hover = [event.clientX, event.clientY];
      if (seen) return this.draggedTo(seen);
    }
    return null;
  }
  // The drag over the surface: the lamp goes to where its highlight is seen there; travel and gloss end there.
  draggedTo(seen) {
    if (this.kind === "lamp") {
      const { azimuth, elevation } = anglesOf(turnedAgainst(seen.mirror, -this.app.stageView.stage.turn));
      this.app.stageView.setLamp({ on: true, azimuth: rounded(azimuth, 1), elevation: rounded(elevation, 1) }, true);
      return null;
    }
    if (!seen.lit) return null;
    const edit = this.kind === "travel" ? this.app.controls.edit("travel", clamped(rounded(seen.angle, 1), 15.5, 180)) : this.glossTo(seen.angle);
    if (edit) this.app.preview(edit);
    return edit;
  }
  glossTo(angle) {
    const { extent } = this.app.stageView.light, meter = this.app.glossAngle();
    const answer = this.app.attempt(() => this.app.engine.ask({ do: "gloss", edge: clamped(angle, 0.1, 89), extent, meter }));
    return answer ? this.app.controls.edit("gloss", rounded(answer.units, 1)) : null;
  }

  key(event) {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key], view = this.app.stageView;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === "+" || event.key === "=") view.closer(1 / 1.1);
    else if (event.key === "-") view.closer(1.1);
    else if (!step) return;
    else this.stepped(step, event.shiftKey ? 5 : 1);
    event.preventDefault();
  }
  stepped([x, y], size) {
    const { app } = this, view = app.stageView, step = x + y;
    if (this.fixed) return;
    if (this.kind === "view") {
      view.look({ ...view.view, azimuth: view.view.azimuth - 5 * x, elevation: clamped(view.view.elevation + 5 * y, -85, 85) });
    } else if (this.kind === "light") {
      view.turnTo(view.stage.turn + 5 * step);
    } else if (this.kind === "lamp") {
      view.setLamp({ on: true, azimuth: ((view.lamp.azimuth + 2 * size * x + 540) % 360) - 180, elevation: clamped(view.lamp.elevation + 2 * size * y, -90, 90) });
    } else if (this.kind === "color") {
      this.placeCross([clamped(this.cross[0] + 0.01 * size * x, 0, 1), clamped(this.cross[1] - 0.015 * size * y, 0, 1)]);
    } else if (this.kind === "travel") {
      app.commit(app.controls.edit("travel", clamped(rounded(app.description.appearance.travel + size * step, 1), 15.5, 180)), true);
    } else {
      const now = app.paint.gloss && app.paint.gloss.length > 0 ? app.paint.gloss[0][1] : 0;
      app.commit(app.controls.edit("gloss", clamped(rounded(now + size * step, 1), 0, 100)), true);
    }
  }

  // The buttons about the cross, in the source's order: lightness above and below, chroma beside, hue at the corners.
  makeTweaks() {
    const place = document.getElementById("tweaks"), step = () => clamped(document.getElementById("tweak-step").valueAsNumber || 3, 0.5, 40);
    const chroma = (sign) => ({ "chroma-factor": rounded(Math.max(0, (this.seenColor.chroma + sign * step()) / this.seenColor.chroma), 4) });
    const kinds = [["hue -", () => ({ "hue-shift": -step() })], ["lighter", () => ({ "lightness-shift": step() })], ["hue +", () => ({ "hue-shift": step() })],
                   ["less chroma", () => chroma(-1)], null, ["more chroma", () => chroma(1)],
                   ["darker", () => ({ "lightness-shift": -step() })]];
    for (const kind of kinds) {
      if (kind === null) place.append(made("span", { id: "tweak-angle" }));
      else place.append(made("button", { type: "button", "data-kind": kind[0], words: kind[0], onclick: () => this.tweak(kind[1]()) }));
    }
  }
  tweak(move) {
    if (!this.seen) return;
    this.app.commit({ at: rounded(this.seen.angle, 1), ...move });
  }

  // Puts the cross there, or takes it away.
  placeCross(cross) {
    if (cross) this.cross = cross;
    const shown = cross !== null;
    for (const id of ["cross", "tweak-panel"]) document.getElementById(id).hidden = !shown;
    if (!shown) return;
    const mark = document.getElementById("cross");
    mark.style.left = `${100 * cross[0]}%`;
    mark.style.top = `${100 * cross[1]}%`;
    this.again();
  }
  // Reads under the cross or the pointer again, after the paint, the view or the light changed.
  again() {
    if (this.kind !== "color" && this.hover) this.read(...this.hover);
    if (this.kind !== "color" || !this.cross) return;
    const box = this.canvas.getBoundingClientRect();
    this.read(box.left + this.cross[0] * box.width, box.top + this.cross[1] * box.height);
  }

  read(x, y) {
    if (!this.app.paint) return;
    this.show(this.app.attempt(() => this.app.stageView.pointAt(x, y)) ?? null);
  }
  // Says what is seen at a point of the surface.
  show(seen) {
    this.seen = seen && seen.lit ? seen : null;
    this.seenColor = this.seen ? this.app.attempt(() => this.app.engine.ask({ do: "at", paint: this.app.paint, angle: seen.angle })) : null;
    const view = this.app.stageView, lightName = view.traced === null && view.lamp.on ? words("the lamp") : words("the brightest light");
    document.querySelectorAll("#tweaks button").forEach((button) => {
      const chroma = button.dataset.kind.includes("chroma") || button.dataset.kind.includes("hue");
      button.disabled = !this.seenColor || (chroma && this.seenColor.chroma < 0.5);
    });
    if (!this.seenColor) {
      this.text.textContent = !seen ? words("Point at the mesh to read its color.") : seen.painted ? told`This place is turned away from ${lightName}.` : words("This part does not wear the paint.");
      this.swatch.style.background = "none";
      document.getElementById("tweak-angle").textContent = "-";
      this.app.curves.point(null);
      return;
    }
    const { lab, chroma, hue, css } = this.seenColor, [L, a, b] = lab.map((value) => value.toFixed(1));
    const turned = chroma < 0.5 ? words("gray") : told`chroma ${chroma.toFixed(1)}, hue ${hue.toFixed(0)}°`;
    this.text.textContent = told`${seen.angle.toFixed(1)}° from the mirror direction of ${lightName}: L* ${L}, a* ${a}, b* ${b} (${turned})`;
    this.swatch.style.background = css;
    document.getElementById("tweak-angle").textContent = seen.angle.toFixed(1) + "°";
    this.app.curves.point({ angle: seen.angle, lab });
  }
}
