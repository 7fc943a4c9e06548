// The light of a view, kept in layers: what each slot of weights meets at every pixel. While the view and the light stay,
// the picture of a paint is a sum of its weights times these layers, with no look-up in maps and no sum over lamps.
// goniochrome-rendering(7), "Layers".

const mostLayerBytes = 96e6;
// Wide lobes look a little beside the mirror direction, by as much as their gloss and their flakes call for. A layer is drawn
// again where that moved by more than this, relative to a direction of length 1.
const shiftTolerance = 1e-5, firstTolerance = 0.03;  // the second in a picture of few pixels, which a better one follows

class GatheredLight {
  constructor(stage) {
    this.stage = stage;
    this.layers = stage.data.layers;
    this.held = null;
    const size = 8 * stage.data.finishes.slots;  // numbers of a segment
    this.segments = (4 * stage.columns) / size;
    this.numbersAt = (slot, segment) => segment * size + 8 * slot;
    this.ofFinishes = new Set(this.layers.list.filter((layer) => this.isUsed(layer, stage.finishes)));
    this.known = { version: -1, withLamps: false, list: [] };
  }

  drop() {
    if (!this.held) return;
    this.stage.gl.deleteTexture(this.held.texture);
    this.stage.gl.deleteFramebuffer(this.held.framebuffer);
    this.held = null;
  }
  get bytes() { return this.held ? 8 * this.held.width * this.held.height * this.held.capacity : 0; }
  // How many layers of pictures of this size may be kept.
  capacity(width, height) { return Math.min(this.layers.list.length + 1, Math.floor(mostLayerBytes / (8 * width * height))); }

  // True if any row of these weights has numbers in a slot. The last number of a lamp's color is no weight.
  isUsed({ slot, lamps }, values) {
    const ends = lamps ? [0, 1, 2, 4, 5, 6] : [0, 1, 2, 3, 4, 5, 6, 7], row = 4 * this.stage.columns;
    for (let begin = 0; begin < values.length; begin += row)
      for (let segment = 0; segment < this.segments; ++segment)
        if (ends.some((i) => values[begin + this.numbersAt(slot, segment) + i] !== 0)) return true;
    return false;
  }
  // The layers that a paint and the finishes of other parts show.
  needed({ values, version }, withLamps) {
    if (this.known.version !== version || this.known.withLamps !== withLamps) {
      const list = this.layers.list.filter((layer) => (withLamps || !layer.lamps) && (this.ofFinishes.has(layer) || this.isUsed(layer, values)));
      this.known = { version, withLamps, list };
    }
    return this.known.list;
  }

  // The shifts that a layer depends on: by how much its lobe looks beside the mirror direction, for each segment.
  shiftsOf({ shift }, { values }) {
    if (!shift) return [];
    const [slot, channel] = shift;
    return Array.from({ length: 2 * this.segments }, (_, i) => values[this.numbersAt(slot, i >> 1) + 4 * (i & 1) + channel]);
  }
  fits(layer, weights, tolerance = shiftTolerance) {
    const known = this.held.drawn.get(layer.slot);
    return known !== undefined && !(tolerance === shiftTolerance && this.held.mixed.has(layer.slot)) && this.shiftsOf(layer, weights).every((shift, i) => Math.abs(shift - known[i]) <= tolerance);
  }
  // The values of a paint that all layers depend on: the index of its coat and its tilted normals.
  ownOf({ values, tiltValues }) { return [values[this.numbersAt(this.layers.light_slot, 0) + 3], ...(tiltValues ?? [])].join(" "); }
  // The key of everything else that they depend on.
  keyOf(camera, width, height, environment) {
    const { lamp, ground, turn } = this.stage;
    return JSON.stringify([width, height, camera, turn, environment, lamp, ground]);
  }

  // True if all layers of this view in this light are kept that show a paint: to draw others takes longer than a picture of few pixels.
  serves(key, weights, environment, stride = 1) {
    const { held } = this;
    if (this.stage.hasSecond || !held || held.key !== key || held.own !== this.ownOf(weights) || !held.drawn.has(this.layers.beside)) return false;
    return this.waiting(weights, environment, false, stride).length === 0;
  }
  // Layers that are still to be drawn: those that the paint needs, and then all others for which there is room.
  waiting(weights, environment, others, stride = 1) {
    const { held } = this, withLamps = this.stage.shading(environment, weights.tilts !== null).lamps.length > 0;
    const needed = this.needed(weights, withLamps), room = held.capacity - 1;
    if (needed.length > room) return this.layers.list;
    // Where there is no room for another layer, one gives way that the paint does not need.
    const list = needed.filter((layer) => !this.fits(layer, weights, stride > 1 ? firstTolerance : shiftTolerance));
    if (!others) return list;
    const rest = this.layers.list.filter((layer) => (withLamps || !layer.lamps) && !needed.includes(layer) && !held.drawn.has(layer.slot));
    const kept = held.drawn.size - (held.drawn.has(this.layers.beside) ? 1 : 0);
    return [...list, ...rest.slice(0, Math.max(0, room - kept - list.length))];
  }

  // Draws so many rows of some of the layers that wait, and returns whether there is more to be drawn. Where the view or the light is another
  // one, those before are dropped.
  gather(key, gbuffer, weights, environment, others = true, rows = gbuffer.height) {
    if (this.stage.hasSecond) return false;
    const own = this.ownOf(weights);
    if (!this.held || this.held.key !== key || this.held.own !== own) this.begin(gbuffer, key, own);
    const { held } = this, { at_once, beside } = this.layers, program = this.stage.shading(environment, weights.tilts !== null, "gathering");
    const waiting = this.waiting(weights, environment, others);
    if (waiting.length > held.capacity - 1) return false;  // they have no room
    // Those of maps and those of lamps are drawn apart, since a sum over lamps is for four layers at once.
    const kind = waiting.filter((layer) => layer.lamps === waiting[0].lamps);
    const list = (held.drawn.has(beside) ? kind : [{ slot: beside, sampler: "mirror" }, ...kind]).slice(0, at_once);
    if (list.length === 0) return false;
    const band = `${weights.version} ${list.map(({ slot }) => slot)}`, begin = held.band === band ? held.row : 0, end = Math.min(gbuffer.height, begin + rows);
    this.draw(gbuffer, weights, environment, list, program, begin, end);
    Object.assign(held, { band, row: end });
    if (end < gbuffer.height) return true;
    for (const layer of list) {
      held.drawn.set(layer.slot, this.shiftsOf(layer, weights));
      held.mixed.delete(layer.slot);
    }
    held.band = "";
    return waiting.length > list.filter(({ slot }) => slot !== beside).length;
  }
  begin({ width, height }, key, own) {
    const { gl } = this.stage;
    this.drop();
    const capacity = this.capacity(width, height), texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, texture);
    gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, gl.RGBA16F, width, height, capacity);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D_ARRAY, filter, gl.NEAREST);
    // `drawn` has the shifts of each layer that is there, by its slot, and `mixed` the slots of those whose rows were drawn for several paints.
    this.held = { key, own, width, height, capacity, texture, framebuffer: gl.createFramebuffer(), drawn: new Map(), mixed: new Set(), places: new Map(), scales: new Map() };
  }
  // The place of a layer in the texture: its own, a free one, or that of a layer that the paint does not need.
  placeOf(slot, keep) {
    const { held } = this;
    if (held.places.has(slot)) return held.places.get(slot);
    let place = held.places.size;  // what is seen beside the mesh comes first
    if (place >= held.capacity) {
      const away = [...held.places.keys()].find((other) => other !== this.layers.beside && !keep.has(other));
      place = held.places.get(away);
      held.places.delete(away);
      held.drawn.delete(away);
    }
    held.places.set(slot, place);
    return place;
  }
  // The divisor of a layer, so that halves can hold it.
  scaleOf({ sampler, lamps, slot }, environment, program) {
    const cube = this.stage.data.environments[environment].cubes.find((one) => one.sampler === sampler);
    if (!lamps) return cube ? cube.scale : 1;
    const last = this.layers.list.at(-1).slot === slot;  // the mirror images of lamps
    const most = program.lamps.reduce((sum, { white, disc }) => sum + Math.PI * Math.max(...white) * (last ? Math.max(1, disc[2]) : 4), 0);
    return 2 ** Math.max(0, Math.ceil(Math.log2(most / 30000)));
  }
  draw(gbuffer, weights, environment, list, program, begin, end) {
    const { gl } = this.stage, { held } = this, { at_once, none } = this.layers, buffers = [];
    const keep = new Set(this.needed(weights, true).map(({ slot }) => slot)), slots = new Int32Array(at_once).fill(none), scales = new Float32Array(at_once).fill(1);
    this.stage.groundShade(environment);  // before a target is bound
    gl.bindFramebuffer(gl.FRAMEBUFFER, held.framebuffer);
    for (let i = 0; i < at_once; ++i) {
      const layer = list[i], at = gl.COLOR_ATTACHMENT0 + i;
      buffers.push(layer ? at : gl.NONE);
      if (!layer) {
        gl.framebufferTexture2D(gl.FRAMEBUFFER, at, gl.TEXTURE_2D, null, 0);
        continue;
      }
      gl.framebufferTextureLayer(gl.FRAMEBUFFER, at, held.texture, 0, this.placeOf(layer.slot, keep));
      slots[i] = layer.slot;
      scales[i] = this.scaleOf(layer, environment, program);
      held.scales.set(layer.slot, scales[i]);
      held.mixed.add(layer.slot);  // until all rows are there
    }
    gl.drawBuffers(buffers);
    gl.disable(gl.BLEND);
    gl.bindVertexArray(this.stage.noVertices);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(0, begin, held.width, end - begin);
    this.stage.castOne(gbuffer, weights, environment, program, null, ({ at }) => {
      gl.uniform1iv(at("slots[0]"), slots);
      gl.uniform1fv(at("scales[0]"), scales);
    });
    gl.disable(gl.SCISSOR_TEST);
    gl.activeTexture(gl.TEXTURE0);
  }

  // The radiance of a paint that is served, in the target of that name, at one of `stride` pixels along each side.
  shade(name, gbuffer, weights, environment, stride = 1) {
    const { stage, held } = this, { gl } = stage, withLamps = stage.shading(environment, weights.tilts !== null).lamps.length > 0;
    const target = stage.target("sum " + name, Math.ceil(held.width / stride), Math.ceil(held.height / stride), stage.sumKind, false), list = this.needed(weights, withLamps);
    const program = (this.program ??= stage.tileProgram(this.layers.program));
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.framebuffer);
    gl.viewport(0, 0, target.width, target.height);
    gl.disable(gl.BLEND);
    gl.bindVertexArray(stage.noVertices);
    for (const one of [program.beside, program]) {
      gl.useProgram(one.program);
      [["gbuffer", gl.TEXTURE_2D, gbuffer.texture], ["weights", gl.TEXTURE_2D, weights.texture], ["layers", gl.TEXTURE_2D_ARRAY, held.texture]].forEach(([sampler, kind, texture], unit) => {
        gl.activeTexture(gl.TEXTURE0 + unit);
        gl.bindTexture(kind, texture);
        gl.uniform1i(one.at(sampler), unit);
      });
      for (const name of ["corner", "right", "down"]) gl.uniform3fv(one.at(name), gbuffer.view[name]);
      gl.uniform3fv(one.at("mesh_color"), weights.meshColor);
      gl.uniform1i(one.at("count"), list.length);
      gl.uniform1i(one.at("stride"), stride);
      gl.uniform1f(one.at("beside_scale"), held.scales.get(this.layers.beside));
      if (list.length > 0) {
        gl.uniform2iv(one.at("used[0]"), list.flatMap(({ slot }) => [slot, held.places.get(slot)]));
        gl.uniform1fv(one.at("scales[0]"), list.map(({ slot }) => held.scales.get(slot)));
      }
      if (one === program) stage.drawTiles(program, target, gbuffer.texture, 3, { stride });
      else gl.drawArrays(gl.TRIANGLES, 0, 3);
    }
    gl.activeTexture(gl.TEXTURE0);
    return Object.assign(target, { stride, samples: 1 });
  }
}
