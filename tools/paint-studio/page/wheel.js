// The plane of a* and b*, where an arrow leads from the face to the flop, and beside it their lightness.

class Wheel {
  constructor(app) {
    this.app = app;
    this.svg = document.getElementById("wheel");
    this.column = document.getElementById("lightness");
    const back = document.getElementById("wheel-back");  // what seldom changes
    this.border = drawn("g");  // what the screen shows at the lightness of the face
    back.append(this.border);
    for (const radius of [25, 50, 75, 100]) back.append(drawn("circle", { r: radius, class: "grid" }));
    for (const [x, y] of [[1, 0], [0, 1]])
      back.append(drawn("line", { x1: -105 * x, y1: -105 * y, x2: 105 * x, y2: 105 * y, class: "grid" }));
    [["+a*", 90, -3], ["-a*", -108, -3], ["+b*", 3, -101], ["-b*", 3, 108]].forEach(([text, x, y]) =>
      back.append(drawn("text", { x, y }, text)));
    this.printed = drawn("polygon", { class: "printed", id: "print-border" });
    this.svg.append(this.printed);
    this.match = drawn("polyline", { class: "seen", id: "match-way" });  // of the nearest paint
    this.way = drawn("polyline", { class: "way" });
    this.arrow = drawn("path", { class: "arrow" });
    this.svg.append(this.match, this.way, this.arrow);
    for (let L = 0; L <= 150; L += 25) {
      this.column.append(drawn("line", { x1: 18, x2: 44, y1: this.heightOf(L), y2: this.heightOf(L), class: "grid" }));
      this.column.append(drawn("text", { x: 0, y: this.heightOf(L) + 3 }, String(L)));
    }
    this.columns = ["face", "flop"].map((end) => drawn("path", { class: "printed", id: `print-${end}` }));
    this.column.append(...this.columns);
    this.handles = {};
    for (const end of ["face", "flop"]) {
      this.handles[end] = this.handle(this.svg, end, words("a* and b*"), (event) => this.placeOf(event),
                                      { ArrowLeft: [0, -1, 0], ArrowRight: [0, 1, 0], ArrowUp: [0, 0, 1], ArrowDown: [0, 0, -1] });
      this.handles[end + "L"] = this.handle(this.column, end, words("lightness"), (event) => this.lightnessOf(event),
                                            { ArrowUp: [1, 0, 0], ArrowDown: [-1, 0, 0] });
    }
  }

  // A handle that moves a part of the color of one end; `from` tells the part of an event, as a color with holes.
  handle(svg, end, what, from, keys) {
    const circle = drawn("circle", { r: end === "face" ? 7 : 5.5, class: "handle", tabindex: 0, role: "slider",
                                     "aria-label": told`${what} of the ${words(end)}`, "aria-valuenow": 0 });
    const edit = (lab) => ({ [end]: lab.map((value) => rounded(value)), ...this.app.controls.residual() });
    const merged = (part) => this.app.description.appearance[end].map((value, i) => part[i] ?? value);
    let last = null, apart = null;  // from where the pointer took the handle to its middle
    draggable(circle, {
      begin: (event) => {
        last = null;
        const taken = from(event);
        apart = merged([null, null, null]).map((value, i) => (taken[i] === null ? 0 : value - taken[i]));
      },
      move: (event) => {
        last = edit(merged(from(event).map((value, i) => (value === null ? null : Math.max(i === 0 ? 0 : -Infinity, value + apart[i])))));
        this.app.preview(last);
      },
      end: () => { if (last) this.app.commit(last); },
    });
    circle.addEventListener("keydown", (event) => {
      const step = keys[event.key];
      if (!step) return;
      event.preventDefault();
      const size = event.shiftKey ? 5 : 1, lab = this.app.description.appearance[end];
      this.app.commit(edit([Math.max(0, lab[0] + size * step[0]), lab[1] + size * step[1], lab[2] + size * step[2]]), true);
    });
    svg.append(circle);
    return circle;
  }

  heightOf(L) { return 205 - 1.27 * clamped(L, 0, 152); }
  pointOf(svg, event) {
    return new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
  }
  placeOf(event) {
    const at = this.pointOf(this.svg, event);
    return [null, clamped(at.x, -108, 108), clamped(-at.y, -108, 108)];
  }
  lightnessOf(event) { return [clamped((205 - this.pointOf(this.column, event).y) / 1.27, 0, 150), null, null]; }

  // A point of a border, no farther out than the plane goes.
  borderPoint({ a, b }) { return [a, -b].map((value) => value * Math.min(1, 108 / Math.hypot(a, b, 1e-9))).join(); }
  // The border of a print at the lightness of the face, and between which lightnesses it has the colors of face and flop.
  showPrint(print) {
    this.printed.setAttribute("points", print.border.map(this.borderPoint).join(" "));
    ["face", "flop"].forEach((end, i) => {
      const { low, high } = print[end], x = [16, 48][i];
      this.columns[i].setAttribute("d", low === undefined ? "" : `M${x - 3},${this.heightOf(high)} h6 M${x},${this.heightOf(high)} V${this.heightOf(low)} M${x - 3},${this.heightOf(low)} h6`);
    });
  }
  showBorder(border) {
    const key = JSON.stringify(border);
    if (this.borderKey === key) return;
    this.borderKey = key;
    const at = this.borderPoint, before = (i) => border[(i + border.length - 1) % border.length];
    while (this.border.children.length < border.length) this.border.append(drawn("polygon", { class: "shown" }));
    border.forEach((point, i) => {
      const wedge = this.border.children[i];
      wedge.setAttribute("points", `0,0 ${at(before(i))} ${at(point)}`);
      wedge.style.fill = point.css;
    });
  }

  place(lab) { return [clamped(lab[1], -108, 108), clamped(-lab[2], -108, 108)]; }
  pathOf(curve) { return curve.map((point) => this.place(point.lab).join(",")).join(" "); }
  showMatch(curve) { this.match.setAttribute("points", this.pathOf(curve)); }
  show(description) {
    const { face, flop, face_css, flop_css } = description.appearance;
    this.showBorder(description.screen.border);
    if (description.print) this.showPrint(description.print);
    const from = this.place(face), to = this.place(flop);
    this.way.setAttribute("points", this.pathOf(description.curve));
    const dx = to[0] - from[0], dy = to[1] - from[1], length = Math.hypot(dx, dy);
    let path = "";
    if (length > 14) {
      const ux = dx / length, uy = dy / length, tip = [to[0] - 7 * ux, to[1] - 7 * uy];
      path = `M${from} L${tip} M${tip[0] - 6 * ux + 4 * uy},${tip[1] - 6 * uy - 4 * ux} L${tip} ` +
             `L${tip[0] - 6 * ux - 4 * uy},${tip[1] - 6 * uy + 4 * ux}`;
    }
    this.arrow.setAttribute("d", path);
    const set = (name, x, y, fill, label) => {
      const handle = this.handles[name];
      handle.setAttribute("cx", x);
      handle.setAttribute("cy", y);
      handle.style.fill = fill;
      handle.setAttribute("aria-valuetext", label);
    };
    // Where both ends are near each other, the face is a ring about the flop.
    this.handles.face.setAttribute("r", length < 14 ? 12 : 7);
    set("face", from[0], from[1], face_css, `a* ${rounded(face[1])}, b* ${rounded(face[2])}`);
    set("flop", to[0], to[1], flop_css, `a* ${rounded(flop[1])}, b* ${rounded(flop[2])}`);
    set("faceL", 26, this.heightOf(face[0]), face_css, `L* ${rounded(face[0])}`);
    set("flopL", 38, this.heightOf(flop[0]), flop_css, `L* ${rounded(flop[0])}`);
    for (const [name, lab] of [["faceL", face], ["flopL", flop]])
      this.handles[name].setAttribute("aria-valuenow", rounded(lab[0]));
    for (const [name, lab] of [["face", face], ["flop", flop]])
      this.handles[name].setAttribute("aria-valuenow", rounded(Math.hypot(lab[1], lab[2])));
  }
}
