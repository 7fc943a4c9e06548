// L*, a* and b* against the aspecular angle: the curve of the paint, what its lobes show, and its readings, which can be
// dragged.

class Curves {
  constructor(app) {
    this.app = app;
    this.svg = document.getElementById("curves");
    this.hint = document.getElementById("curves-hint");
    this.plots = ["L*", "a*", "b*"].map((name, channel) => {
      const top = 8 + 105 * channel;
      this.svg.append(drawn("rect", { x: 34, y: top, width: 372, height: 86, class: "grid" }),
                      drawn("text", { x: 4, y: top + 10 }, name));
      const plot = { top, channel, sight: drawn("path", { class: "sight" }), way: drawn("polyline", { class: "way" }), seen: drawn("polyline", { class: "seen" }),
                     marks: drawn("g"), readings: drawn("g") };
      this.svg.append(plot.marks, plot.seen, plot.way, plot.sight, plot.readings);
      for (const angle of [15, 25, 45, 75, 110])
        this.svg.append(drawn("text", { x: this.x(angle) - 6, y: top + 95 }, angle + "°"));
      return plot;
    });
  }

  x(angle) { return 34 + ((angle - 10) / 100) * 372; }
  y(plot, value) { return plot.top + 86 - (86 * (value - plot.low)) / (plot.high - plot.low); }

  show(description, fit) {
    const rows = description.rows.filter((row) => !row.out_of_plane && row.angle >= 10 && row.angle <= 110);
    const seen = fit ? fit.seen : [];
    for (const plot of this.plots) {
      const c = plot.channel;
      if (!this.dragging) {
        const values = [...description.curve, ...rows].map((point) => point.lab[c]);
        const low = Math.min(...values), high = Math.max(...values), air = Math.max(4, 0.15 * (high - low));
        plot.low = Math.floor(low - air);
        plot.high = Math.ceil(high + air);
        if (c === 0) plot.low = Math.max(0, plot.low);
      }
      const points = (list) => list.map((p) => `${this.x(p.angle)},${clamped(this.y(plot, p.lab[c]), plot.top, plot.top + 86)}`);
      plot.way.setAttribute("points", points(description.curve).join(" "));
      plot.seen.setAttribute("points", points(seen).join(" "));
      plot.marks.replaceChildren(
        drawn("text", { x: 4, y: plot.top + 26 }, String(plot.high)), drawn("text", { x: 4, y: plot.top + 84 }, String(plot.low)));
      this.showReadings(plot, rows);
    }
    this.hint.textContent = rows.length > 0
      ? words("Drag a reading, or focus it and use the up and down keys. The broken line is what the lobes show.")
      : words("This paint is designed: face, flop and travel make its curve. The broken line is what the lobes show.");
  }

  // A cross at the color of one angle in every plot: {angle, lab}, or null for none.
  point(at) {
    for (const plot of this.plots) {
      const inside = at !== null && at.angle >= 10 && at.angle <= 110 && plot.high > plot.low;
      if (!inside) {
        plot.sight.setAttribute("d", "");
        continue;
      }
      const x = this.x(at.angle), y = clamped(this.y(plot, at.lab[plot.channel]), plot.top, plot.top + 86);
      plot.sight.setAttribute("d", `M${x},${plot.top}v86M${x - 9},${y}h18`);
    }
  }

  // Readings keep their elements while they are the same, so that dragging and the keyboard do not lose them.
  showReadings(plot, rows) {
    const key = rows.map((row) => row.geometry).join(" ");
    if (plot.key !== key) {
      plot.key = key;
      plot.handles = rows.map((row, i) => this.reading(plot, row.geometry, i));
      plot.readings.replaceChildren(...plot.handles);
    }
    this.rows = rows;
    rows.forEach((row, i) => {
      const handle = plot.handles[i], value = row.lab[plot.channel];
      handle.setAttribute("cx", this.x(row.angle));
      handle.setAttribute("cy", clamped(this.y(plot, value), plot.top, plot.top + 86));
      handle.style.fill = row.css;
      handle.setAttribute("aria-valuenow", rounded(value));
    });
  }

  reading(plot, geometry, number) {
    const names = ["L*", "a*", "b*"];
    const circle = drawn("circle", { r: 5, class: "handle", tabindex: 0, role: "slider",
                                     "aria-label": told`${names[plot.channel]} at ${geometry}` });
    const edit = (value) => {
      const lab = this.rows[number].lab.map((old, i) => (i === plot.channel ? rounded(value) : old));
      return { set: [{ geometry, lab: [Math.max(0, lab[0]), lab[1], lab[2]] }] };
    };
    let last = null;
    draggable(circle, {
      begin: () => {
        last = null;
        this.dragging = true;
      },
      move: (event) => {
        const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(this.svg.getScreenCTM().inverse());
        const y = clamped(at.y, plot.top, plot.top + 86);
        last = edit(plot.low + ((plot.top + 86 - y) / 86) * (plot.high - plot.low));
        this.app.preview(last);
      },
      end: () => {
        this.dragging = false;
        if (last) this.app.commit(last);
      },
    });
    circle.addEventListener("keydown", (event) => {
      const step = { ArrowUp: 1, ArrowDown: -1 }[event.key];
      if (!step) return;
      event.preventDefault();
      this.app.commit(edit(this.rows[number].lab[plot.channel] + step * (event.shiftKey ? 5 : 1)), true);
    });
    return circle;
  }
}
