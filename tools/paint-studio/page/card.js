// The forms in which a design is shown away from the page: a card of one sheet, and a film of the turning mesh.

const chipAngles = [15, 25, 45, 75, 110];  // degrees, at which designs are stated
const filmFrames = 90, filmRate = 15;      // of one turn; a second

class Card {
  constructor(app) {
    this.app = app;
    this.notes = document.getElementById("notes");
    this.notes.addEventListener("change", () => app.store());
    document.getElementById("print-card").addEventListener("click", () => {
      this.fill();
      window.print();
    });
    const film = document.getElementById("film");
    film.addEventListener("click", () => {
      film.disabled = true;  // a second one would begin in the middle of the first
      this.film().catch((error) => app.say(error.message)).finally(() => { film.disabled = false; });
    });
  }

  chip(name, lab, css) {
    const swatch = made("span", { class: "chip" });
    swatch.style.background = css;
    return made("div", {}, [swatch, made("b", { text: name }), made("span", { text: `L* ${lab[0].toFixed(1)}  a* ${lab[1].toFixed(1)}  b* ${lab[2].toFixed(1)}` })]);
  }
  // The card of the design as it is shown. Chips are those of the wheel and of the curve at the angles of export, in sRGB.
  fill() {
    const { app } = this, { paint, stageView } = app, ask = (wanted) => app.engine.ask({ ...wanted, paint, screen: "srgb" });
    const { face, flop, face_css, flop_css, travel } = ask({ do: "describe" }).appearance, curve = chipAngles.map((angle) => [angle, ask({ do: "at", angle })]), light = document.getElementById("environment").selectedOptions[0].textContent;
    const gloss = (paint.gloss ?? []).map(([angle, units]) => told`${units.toFixed(0)} GU at ${angle}°`), figures = document.getElementById("figures").cloneNode(true), curves = document.getElementById("curves").cloneNode(true);
    for (const one of [figures, curves]) one.removeAttribute("id");
    for (const handle of curves.querySelectorAll(".handle, .sight")) handle.remove();
    document.getElementById("card").replaceChildren(
      made("h1", { text: paint.name + (paint.code ? `, ${paint.code}` : "") }),
      made("img", { src: stageView.canvas.toDataURL("image/png"), alt: `The mesh in ${paint.name}` }),
      made("p", { text: [told`Light: ${light}.`, told`Travel ${travel.toFixed(0)}°.`, ...(gloss.length > 0 ? [told`Gloss ${gloss.join(", ")}.`] : [])].join(" ") }),
      made("div", { class: "chips" }, [this.chip(words("face"), face, face_css), ...curve.map(([angle, { lab, css }]) => this.chip(`${angle}°`, lab, css)), this.chip(words("flop"), flop, flop_css)]),
      made("div", { class: "row" }, [curves, figures]),
      ...(this.notes.value ? [made("p", { text: this.notes.value })] : []),
      made("pre", { text: document.getElementById("command").textContent }));
  }

  // One turn of the camera as WebM.
  async film() {
    const { app } = this, { stageView } = app, { canvas } = stageView, first = stageView.view, kind = "video/webm";
    if (!window.MediaRecorder?.isTypeSupported(kind)) throw new Error(words("This browser makes no WebM films."));
    if (stageView.traced !== null) throw new Error(words("The camera of a traced view stays as it is: choose a light."));
    const stream = canvas.captureStream(filmRate), recorder = new MediaRecorder(stream, { mimeType: kind, videoBitsPerSecond: 12e6 }), pieces = [];
    recorder.ondataavailable = ({ data }) => pieces.push(data);
    const ended = new Promise((resolve) => { recorder.onstop = resolve; });
    recorder.start();
    for (let i = 0; i < filmFrames; ++i) {
      app.say(told`The film: ${Math.round((100 * i) / filmFrames)} %`);
      stageView.view = { ...first, azimuth: first.azimuth + (360 * i) / filmFrames };
      stageView.drawNow(true);
      await new Promise((resolve) => setTimeout(resolve, 1000 / filmRate));
    }
    recorder.stop();
    await ended;
    for (const track of stream.getTracks()) track.stop();
    stageView.look(first);
    save(`${fileName(app.paint.name)}.webm`, new Blob(pieces, { type: kind }), kind);
    app.say(words("The film is saved."));
  }
}
