// Views whose light was traced: the compiled library shows every paint on them as render-osmesa --gbuffer does. Their
// camera and their light stay as they are.

class TracedViews {
  constructor(app) {
    this.app = app;
    this.list = app.data.views;
    this.loaded = this.list.map(() => false);
    this.sides = [null, null];  // {texture, width, height, paint, number, small} on each side of the border
    this.answer = null;         // what the library said of the design
    this.full_ms = 0;           // what a picture of all points took, once that is known
  }

  // The picture of a paint: {width, height, values, answer}, radiance as R G B A. Throws a sentence where the light of the
  // view cannot show that paint.
  picture(number, paint, small = false) {
    const { engine } = this.app, view = this.list[number];
    if (!this.loaded[number]) {
      const bytes = numbersOf(view.light, Uint8Array);
      engine.attach(bytes.length).set(bytes);
      engine.ask({ do: "view", view: number, parts: view.parts, mirrors: view.mirrors, operator: view.operator });
      this.loaded[number] = true;
    }
    const begin = performance.now(), answer = engine.ask({ do: "show", view: number, paint, small });
    if (!small) this.full_ms = performance.now() - begin;
    return { width: answer.width, height: answer.height, values: engine.list("picture"), answer };
  }

  // Draws a view on the canvas: `weights` as Stage.shade() has them. While the paint moves, slow computers show few points.
  draw(number, weights, stops, overlay, moving) {
    const { stage } = this.app, view = this.list[number], small = moving && this.full_ms > firstBudget_ms;
    const paints = weights.left ? [weights.left.paint, weights.right.paint] : [weights.paint];
    const sides = paints.map((paint, i) => this.side(i, number, paint, small)), { width, height } = sides[0];
    stage.resize(width, height);
    const border = weights.left ? Math.round(weights.at * width) : width;
    stage.showSides(sides, border, view.white, stops);
    if (overlay) stage.drawOver(stage.gbuffer("traced", view.camera, width, height, [0, 0], null), overlay);
    this.answer = this.sides[0].answer;
  }
  side(i, number, paint, small) {
    const known = this.sides[i];
    if (known && known.number === number && known.paint === paint && known.small === small) return known;
    const { width, height, values, answer } = this.picture(number, paint, small);
    const texture = this.app.stage.pictureTexture(width, height, values, known?.texture);
    return (this.sides[i] = { texture, width, height, number, paint, small, answer });
  }

  // A small picture of a paint, as pixels of a canvas.
  tile(number, paint, stops) {
    const { stage } = this.app, { width, height, values } = this.picture(number, paint, true);
    this.tileTexture = stage.pictureTexture(width, height, values, this.tileTexture);
    return stage.pixels({ texture: this.tileTexture, width, height }, this.list[number].white, stops);
  }

  // The text about a view beside the picture.
  text(number) {
    const parts = [this.list[number].floor ? words("This view was traced: shadows, the floor and the light that parts send to each other are in it. Its camera and its light stay as they are.") :
                   words("This view was traced: shadows and the light that parts send to each other are in it. Its camera and its light stay as they are.")];
    if (this.answer?.scaled) {
      const error = this.answer.bounced_de00_p95;
      parts.push(error === null ? words("Parts that wore one paint wear several now: bounced light is doubtful.") :
        told`Bounced light was traced in other paints and is scaled to this one: off by ${error.toFixed(2)} (CIEDE2000, at most in 95 of 100 points).`);
      if (this.answer.trace_again) parts.push(words("That is doubtful: trace the view again in this paint, by render-osmesa --aov transport."));
    }
    if (this.answer?.coat_changed)
      parts.push(words("A paint with a coat took the place of one without it, or the other way round: toward grazing the picture is that of the paint that was traced."));
    return parts.join(" ");
  }
}
