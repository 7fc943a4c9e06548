// The picture: the mesh under prefiltered light, drawn by the project's own programs in WebGL 2.
// goniochrome-rendering(7), "RENDERING".

const mostSampleBytes = 120e6;  // of the G-buffers of samples that are kept while the view stays
const leastSparkle = 0.004;     // of a pixel's light; deviations of flakes below it are not drawn
const edgeContrast = 0.1;       // from one pixel to the next, of the brightness of the darker one

// Graphics that are drawn by the processor run both sides of a branch. Pixels that need the long side are therefore drawn in
// tiles, each of which is a point, and the others are not.
const meshTile = 8, edgeTile = 4;
const tileVertex = `#version 300 es
precision highp float;
precision highp sampler2D;
uniform sampler2D marks;  // what \`pick\` finds in it is not 0 where a pixel is to be drawn
uniform vec4 pick;
uniform ivec2 tiles;
uniform int tile, mark_stride;
void main() {
  ivec2 at = ivec2(gl_VertexID % tiles.x, gl_VertexID / tiles.x), end = min(tile * (at + 1), (textureSize(marks, 0) + mark_stride - 1) / mark_stride);
  bool drawn = false;
  for (int y = tile * at.y; y < end.y && !drawn; ++y)
    for (int x = tile * at.x; x < end.x && !drawn; ++x) drawn = dot(pick, texelFetch(marks, mark_stride * ivec2(x, y), 0)) != 0.0;
  gl_PointSize = float(tile);
  gl_Position = vec4(drawn ? (2.0 * vec2(at) + 1.0) / vec2(tiles) - 1.0 : vec2(2.0), 0.0, 1.0);
}
`;
const startOfMesh = "  vec3 n = point.xyz;\n";  // in all programs, after what is seen beside the mesh
const mostCounted = 4;          // of white, of a sample of an edge, so that single glints of lamps are no dots
const sampleFragment = `#version 300 es
precision highp float;
precision highp sampler2D;
uniform sampler2D picture;
uniform float most, share;
out vec4 color;
void main() { color = share * min(texelFetch(picture, ivec2(gl_FragCoord.xy), 0), most); }
`;
const edgeFragment = `#version 300 es
precision highp float;
precision highp sampler2D;
uniform sampler2D gbuffer, picture;
uniform float gain;  // to what a screen shows
out vec4 color;
ivec2 last;
int part(float w) { return w < 0.0 ? -(int(-w) & 7) : int(w) & 7; }
bool differ(vec4 a, float light, ivec2 at) {
  at = clamp(at, ivec2(0), last);
  vec4 b = texelFetch(gbuffer, at, 0);
  float other = min(gain * dot(texelFetch(picture, at, 0).rgb, vec3(0.2627, 0.678, 0.0593)), 2.0);
  return part(a.w) != part(b.w) || abs(light - other) > ${edgeContrast} * (min(light, other) + 0.02);
}
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  last = textureSize(gbuffer, 0) - 1;
  vec4 a = texelFetch(gbuffer, at, 0);
  float light = min(gain * dot(texelFetch(picture, at, 0).rgb, vec3(0.2627, 0.678, 0.0593)), 2.0);
  bool edge = differ(a, light, at + ivec2(1, 0)) || differ(a, light, at - ivec2(1, 0)) || differ(a, light, at + ivec2(0, 1)) || differ(a, light, at - ivec2(0, 1));
  color = vec4(edge ? 1.0 : 0.0);
}
`;

// The column at which two paints meet; of one paint the width.
const borderOf = (weights, width) => (weights.left ? Math.round(weights.at * width) : width);

class Stage {
  // Throws a sentence where the browser cannot draw the page.
  constructor(canvas, data, engine) {
    const gl = canvas.getContext("webgl2", { antialias: false, alpha: false, depth: false, preserveDrawingBuffer: true });
    if (!gl) throw new Error(words("This browser has no WebGL 2, with which the picture is drawn."));
    if (!gl.getExtension("EXT_color_buffer_float"))
      throw new Error(words("The graphics of this computer cannot draw float pictures, which the page needs."));
    Object.assign(this, { gl, canvas, data, engine });
    this.takeScreen();
    this.floatLinear = gl.getExtension("OES_texture_float_linear") !== null;
    this.sumKind = gl.getExtension("EXT_float_blend") !== null ? gl.RGBA32F : gl.RGBA16F;
    this.mesh = unpackedMesh(data.mesh);
    this.columns = data.finishes.columns;
    if (this.columns > gl.getParameter(gl.MAX_TEXTURE_SIZE))
      throw new Error(words("The graphics of this computer cannot hold the weights of this basis."));
    this.finishes = numbersOf(data.finishes.texels, Float32Array).slice();  // the first row is that of the second paint
    this.rows = 1 + data.finishes.rows;
    this.gbufferProgram = this.program(data.programs.gbuffer_vertex, data.programs.gbuffer_fragment);
    this.displayProgram = this.program(data.programs.shading_vertex, data.programs.display_fragment);
    this.noVertices = gl.createVertexArray();
    this.environments = data.environments.map(() => null);
    this.gbuffers = new Map();
    this.targets = new Map();
    this.sparkling = false;  // whether single flakes are drawn
    this.ground = true;  // whether the environment lies on the ground
    this.versions = 0;
    this.edgeRows = Infinity;  // that one step of smoothing draws
    this.turn = 0;     // of the environment about +Y, in degrees, as the camera's azimuth counts
    this.lamp = null;  // {direction, white}: where it stands beside the mesh, and what a white surface facing it shows
    this.partsVersion = 0;  // of what the parts wear
    this.gathered = new GatheredLight(this);
    this.occlusion = new Occlusion(this);
    this.uploadMesh();
    gl.frontFace(gl.CW);  // counter-clockwise, seen with y down
  }

  // Pictures and colors of the page are those of Display P3 where the screen and the browser show them, else of sRGB.
  get screen() { return this.engine.screen; }
  takeScreen() {
    const isWide = matchMedia("(color-gamut: p3)").matches && CSS.supports("color", "color(display-p3 1 0 0)");
    this.engine.screen = isWide && "drawingBufferColorSpace" in this.gl && "colorSpace" in ImageData.prototype ? "display-p3" : "srgb";
    if ("drawingBufferColorSpace" in this.gl) this.gl.drawingBufferColorSpace = this.screen;
  }

  program(vertex, fragment) {
    const gl = this.gl, program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    const places = new Map();
    return { program, at: (name) => {
      if (!places.has(name)) places.set(name, gl.getUniformLocation(program, name));
      return places.get(name);
    } };
  }

  // A program that is drawn in tiles, and that which draws what is beside the mesh.
  tileProgram(fragment) {
    return { ...this.program(tileVertex, fragment), beside: this.program(this.data.programs.shading_vertex, fragment.replace(startOfMesh, "  discard;\n" + startOfMesh)) };
  }
  // Draws the program that is in use in the tiles of a picture that have marks: a G-buffer marks its mesh.
  drawTiles(program, { width, height }, marks, unit, { tile = meshTile, pick = [0, 0, 0, 1], stride = 1 } = {}) {
    const gl = this.gl, tiles = [Math.ceil(width / tile), Math.ceil(height / tile)];
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, marks);
    gl.uniform1i(program.at("marks"), unit);
    gl.uniform4fv(program.at("pick"), pick);
    gl.uniform2iv(program.at("tiles"), tiles);
    gl.uniform1i(program.at("tile"), tile);
    gl.uniform1i(program.at("mark_stride"), stride);
    gl.viewport(0, 0, tile * tiles[0], tile * tiles[1]);  // so that the middle of each tile is inside
    gl.drawArrays(gl.POINTS, 0, tiles[0] * tiles[1]);
  }

  uploadMesh() {
    const gl = this.gl;
    this.meshVertices = this.vertices(this.mesh.positions, this.mesh.normals);
    this.normalBuffer = gl.getParameter(gl.ARRAY_BUFFER_BINDING);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, this.mesh.corners, gl.STATIC_DRAW);
  }
  // An array of vertices of three numbers each, which is then bound.
  vertices(...attributes) {
    const gl = this.gl, made = gl.createVertexArray();
    gl.bindVertexArray(made);
    attributes.forEach((values, index) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
      gl.vertexAttribPointer(index, 3, gl.FLOAT, false, 0, 0);
      gl.enableVertexAttribArray(index);
    });
    return made;
  }

  // Turns the environment. Normals and rays are turned against it instead, so that the maps stay as they are.
  turnTo(degrees) {
    if (this.turn === degrees) return;
    this.turn = degrees;
    const gl = this.gl, from = this.mesh.normals, turned = new Float32Array(from.length);
    const c = Math.cos((degrees * Math.PI) / 180), s = Math.sin((degrees * Math.PI) / 180);
    for (let i = 0; i < from.length; i += 3) {
      turned[i] = c * from[i] - s * from[i + 2];
      turned[i + 1] = from[i + 1];
      turned[i + 2] = s * from[i] + c * from[i + 2];
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, this.normalBuffer);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, turned);
  }

  floatTexture(columns, rows, values, kind = this.gl.RGBA32F) {
    const gl = this.gl, texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, kind, columns, rows, 0, gl.RGBA, gl.FLOAT, values);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
      gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
    return texture;
  }

  // The weights of the paint that the engine fitted last, for the programs: {texture, tilts, values, tiltValues, version}, in the place of
  // `made` where that is given. The texture has its weights, which are `values`, and those of the finishes below. `tilts` is null where it
  // is not brushed. No two paints have the same version.
  weights(engine, made = null) {
    const gl = this.gl, tilts = engine.list("tilts"), values = engine.list("weights");
    if (made === null) {
      const all = new Float32Array(4 * this.columns * this.rows);
      all.set(this.finishes, 4 * this.columns);
      made = { texture: this.floatTexture(this.columns, this.rows, all), tilts: null };
    }
    gl.bindTexture(gl.TEXTURE_2D, made.texture);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, this.columns, 1, gl.RGBA, gl.FLOAT, values);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 1, this.columns, 1, gl.RGBA, gl.FLOAT, this.finishes.subarray(0, 4 * this.columns));
    if (made.tilts) gl.deleteTexture(made.tilts);
    const brushed = tilts.length > 4;
    made.tilts = brushed ? this.tiltTexture(tilts) : null;
    return Object.assign(made, { values, tiltValues: brushed ? tilts : null, version: ++this.versions, meshColor: this.reflectance(values) });
  }
  // The part of even light that a surface of these weights reflects, over all views.
  reflectance(values) {
    const { layers, segments, numbersAt } = this.gathered, slots = layers.list.filter(({ lamps }) => !lamps).map(({ slot }) => slot), sum = [0, 0, 0];
    for (let segment = 0; segment < segments; ++segment) {
      const root = (segment + 0.5) / segments, share = segments > 1 ? (4 * root ** 3) / segments : 1, t = segments > 1 ? 0.5 : 2 / 3;  // 2 c dc, where c = root^2
      for (const slot of slots)
        for (const c of [0, 1, 2]) sum[c] += share * (values[numbersAt(slot, segment) + c] + t * values[numbersAt(slot, segment) + 4 + c]);
    }
    return sum;
  }
  // The tilts of a brushed paint; finishes have their own normal alone.
  tiltTexture(tilts) {
    const columns = tilts.length / 4, all = new Float32Array(tilts.length * this.rows);
    all.set(tilts);
    for (let row = 1; row < this.rows; ++row) all.set([0, 0, 1, 1], row * tilts.length);
    return this.floatTexture(columns, this.rows, all);
  }

  cube(packed) {
    const gl = this.gl, texture = gl.createTexture(), halves = smoothNumbersOf(packed.texels);
    const most = 3 * packed.size * packed.size;
    // Maps brighter than halves can be are floats, where those can be interpolated; else the brightest of halves.
    let values = halves, kind = gl.RGB16F, type = gl.HALF_FLOAT;
    if (packed.scale !== 1) {
      values = Float32Array.from(halves, (half) => numberOfHalf(half) * packed.scale);
      type = gl.FLOAT;
      if (this.floatLinear) kind = gl.RGB32F;
      else values = values.map((value) => Math.min(value, 65504));
    }
    gl.bindTexture(gl.TEXTURE_CUBE_MAP, texture);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 2);  // rows of an odd number of halves
    for (let face = 0; face < 6; ++face)
      gl.texImage2D(gl.TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, kind, packed.size, packed.size, 0, gl.RGB, type,
                    values.subarray(face * most, (face + 1) * most));
    gl.texParameteri(gl.TEXTURE_CUBE_MAP, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_CUBE_MAP, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    return { sampler: packed.sampler, texture };
  }

  // The part of its light that the ground keeps beside the mesh, between the two turns of the environment for which it is known.
  groundLight(number, { size, turns, steps, texels }) {
    const gl = this.gl, made = this.environment(number), at = ((((this.turn % 360) + 360) % 360) / 360) * turns, first = Math.floor(at) % turns, share = at - Math.floor(at);
    if (made.groundTurn === this.turn) return made.ground;
    const all = (made.groundTexels ??= smoothNumbersOf(texels, 4)), length = 4 * size * size, one = all.subarray(first * length, (first + 1) * length), next = ((first + 1) % turns) * length;
    const mixed = Float32Array.from(one, (value, i) => ((1 - share) * value + share * all[next + i]) / steps);
    made.ground ??= gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, made.ground);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA16F, size, size, 0, gl.RGBA, gl.FLOAT, mixed);
    for (const [what, how] of [[gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR], [gl.TEXTURE_MAG_FILTER, gl.LINEAR], [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]]) gl.texParameteri(gl.TEXTURE_2D, what, how);
    gl.generateMipmap(gl.TEXTURE_2D);
    made.groundTurn = this.turn;
    return made.ground;
  }
  // The shadow on the ground: its texture, null where it is not known, and 1 over its reach. In a light that was not the last one it is
  // drawn first: whoever shades asks for it before a target is bound.
  groundShade(environment) {
    const packed = this.data.environments[environment].ground_light;
    const shade = packed ? { ...packed, texture: this.groundLight(environment, packed) } : this.occlusion.ground ? this.occlusion.groundLight(environment) : null;
    return { texture: shade?.texture ?? null, scale: shade ? 1 / shade.reach : 0 };
  }
  // The program and the textures of an environment, made when it is first shown.
  environment(number) {
    if (this.environments[number]) return this.environments[number];
    const packed = this.data.environments[number];
    const made = { cubes: packed.cubes.map((cube) => this.cube(cube)), white: packed.white };
    this.environments[number] = made;
    return made;
  }

  // How an environment is shaded, or its light gathered: its program, lamps and their discs. With the lamp of the page, and
  // for brushed paints, these are others, which are made when they are first needed.
  shading(number, brushed, work = "shading") {
    const made = this.environment(number), packed = this.data.environments[number], lamp = this.data.lamp;
    const discsOf = () => (packed.discs ? numbersOf(packed.discs.texels, Float32Array) : null);
    const name = (brushed ? "brushed_" : "") + work, kind = (this.lamp ? "lamp " : "") + name;
    if (this.lamp === null) return (made[kind] ??= this.shadingOf(name, packed.programs[name], packed.lamps, discsOf()));
    if (!made[kind]) {
      const first = numbersOf(lamp.discs, Float32Array), others = discsOf() ?? new Float32Array(0);
      const discs = new Float32Array(first.length + others.length);
      discs.set(first);
      discs.set(others, first.length);
      made[kind] = this.shadingOf(name, packed.lamp_programs[name], [{ disc: lamp.disc }, ...packed.lamps], discs);
    }
    const direction = turnedAgainst(this.lamp.direction, this.turn);
    Object.assign(made[kind].lamps[0], { direction, white: this.lamp.white });
    return made[kind];
  }
  shadingOf(name, program, lamps, discs) {
    const { columns } = this.data.lamp, own = name === "sparkle" ? this.program(this.data.programs.sparkle_vertex, program) : this.tileProgram(program), made = { ...own, lamps: [...lamps] };
    if (discs) made.discs = this.floatTexture(columns, discs.length / (4 * columns), discs);
    return made;
  }

  // A texture to draw into, with a second one of halves where that is wanted, kept by its name and made anew where the size changes.
  target(name, width, height, kind, withDepth, withSecond = false) {
    const gl = this.gl, known = this.targets.get(name);
    if (known && known.width === width && known.height === height) return known;
    if (known) this.forget(known);
    const made = { width, height, framebuffer: gl.createFramebuffer(), key: "" };
    gl.bindFramebuffer(gl.FRAMEBUFFER, made.framebuffer);
    const attached = (at, what) => {
      const texture = gl.createTexture();
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texStorage2D(gl.TEXTURE_2D, 1, what, width, height);
      for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
      gl.framebufferTexture2D(gl.FRAMEBUFFER, at, gl.TEXTURE_2D, texture, 0);
      return texture;
    };
    made.texture = attached(gl.COLOR_ATTACHMENT0, kind);
    made.depth = withDepth ? attached(gl.DEPTH_ATTACHMENT, gl.DEPTH_COMPONENT32F) : null;
    made.second = withSecond ? attached(gl.COLOR_ATTACHMENT1, gl.RGBA16F) : null;
    if (withSecond) gl.drawBuffers([gl.COLOR_ATTACHMENT0, gl.COLOR_ATTACHMENT1]);
    this.targets.set(name, made);
    return made;
  }

  forget({ texture, depth, second, framebuffer }) {
    for (const one of [texture, depth, second]) this.gl.deleteTexture(one);
    this.gl.deleteFramebuffer(framebuffer);
  }
  // Frees what takes the most memory, before another stage takes the place of this one.
  drop() {
    this.gathered.drop();
    for (const target of this.targets.values()) this.forget(target);
    for (const made of this.environments) for (const { texture } of made?.cubes ?? []) this.gl.deleteTexture(texture);
  }

  // The visible points of every pixel at one sample, and the light that they lose in an environment, unless that is null. They are drawn
  // again only where the view or the light changed.
  gbuffer(name, camera, width, height, shift, environment) {
    const light = environment === null ? "none" : this.occlusion.takeLoss(environment), gl = this.gl, target = this.target("gbuffer " + name, width, height, gl.RGBA32F, true, true);
    const key = JSON.stringify([camera, shift, this.turn, this.partsVersion, light]);
    if (target.key === key) return target;
    const view = projected(camera, width, height, this.mesh, shift), program = this.gbufferProgram;
    for (const name of ["corner", "right", "down"]) view[name] = turnedAgainst(view[name], this.turn);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.framebuffer);
    gl.viewport(0, 0, width, height);
    gl.enable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    for (const buffer of [0, 1]) gl.clearBufferfv(gl.COLOR, buffer, [0, 0, 0, 0]);
    gl.clearBufferfv(gl.DEPTH, 0, [1]);
    gl.useProgram(program.program);
    const { moments, columns } = this.occlusion;
    for (const unit of [3, 2, 1, 0]) {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, moments?.textures[unit] ?? null);
      gl.uniform1i(program.at(`moments_${unit}`), unit);
    }
    gl.uniform1i(program.at("moment_columns"), light === "none" ? 0 : columns);
    gl.uniform2fv(program.at("turn"), this.turnVector);
    gl.uniformMatrix4fv(program.at("clip"), false, view.clip);
    for (const name of ["corner", "right", "down"]) gl.uniform3fv(program.at(name), view[name]);
    gl.uniform1f(program.at("reach"), light === "none" ? 0 : view.reach);
    gl.bindVertexArray(this.meshVertices);
    for (const part of this.shownParts) {
      gl.uniform1i(program.at("part"), part.row);
      gl.drawElements(gl.TRIANGLES, 3 * part.count, gl.UNSIGNED_INT, 12 * part.first);
    }
    gl.disable(gl.DEPTH_TEST);
    target.key = key;
    target.view = { ...view, eye: camera.eye };
    return target;
  }

  // Shades rows of a G-buffer into the sum of that name. `weights` are those of one paint, or {left, right, at}: of two, which
  // meet at that part of the width.
  shade(name, gbuffer, weights, environment, begin = 0, end = gbuffer.height) {
    const target = this.target("sum " + name, gbuffer.width, gbuffer.height, this.sumKind, false);
    this.cast(target, gbuffer, weights, environment, begin, end);
    return Object.assign(target, { stride: 1, samples: 1 });
  }
  // Draws what shade() does into a target: the whole picture, or the tiles that have edges.
  cast({ framebuffer }, gbuffer, weights, environment, begin, end, edges = null) {
    const gl = this.gl, border = borderOf(weights, gbuffer.width);
    this.groundShade(environment);  // before a target is bound
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.disable(gl.BLEND);
    gl.bindVertexArray(this.noVertices);
    gl.enable(gl.SCISSOR_TEST);
    for (const [paint, from, to] of [[weights.left ?? weights, 0, border], [weights.right, border, gbuffer.width]]) {
      if (to === from) continue;
      gl.scissor(from, begin, to - from, end - begin);
      this.castOne(gbuffer, paint, environment, this.shading(environment, paint.tilts !== null), edges);
    }
    gl.disable(gl.SCISSOR_TEST);
    gl.activeTexture(gl.TEXTURE0);
  }
  // One program of shading(), whose own uniforms `set` sets.
  castOne(gbuffer, paint, environment, program, edges = null, set = () => {}) {
    const gl = this.gl;
    if (!edges) {
      gl.viewport(0, 0, gbuffer.width, gbuffer.height);
      this.useShading(gbuffer, paint, environment, { ...program.beside, lamps: [] });
      set(program.beside);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    }
    const unit = this.useShading(gbuffer, paint, environment, program);
    set(program);
    this.drawTiles(program, gbuffer, (edges ?? gbuffer).texture, unit, edges ? { tile: edgeTile, pick: [1, 0, 0, 0] } : {});
  }

  // The steps by which pixels of a sum become the mean of many samples, where they differ from those beside them.
  // Samples that the sum has stay in it.
  *smooth(name, sum, camera, weights, environment, stops, samples, budget_ms = stepBudget_ms) {
    if (sum.samples >= samples) return;
    const gl = this.gl, { width, height } = sum, kept = samples * 28 * width * height <= mostSampleBytes;
    const gbufferOf = (k) => this.gbuffer(kept ? `${name} ${k}` : `${name} sample`, camera, width, height, sampleShifts[k], environment);
    const gain = 2 ** stops / (this.environment(environment).white || 1), edges = this.markEdges(this.gbuffer(name, camera, width, height, [0, 0], environment), sum, gain);
    const [sample, mean] = ["edge sample", "edge mean"].map((one) => this.target(one, width, height, this.sumKind, false));
    this.addSample(mean, sum, edges, mostCounted / gain, sum.samples / samples, false);
    for (let k = sum.samples; k < samples; ++k) {
      const gbuffer = gbufferOf(k);
      for (let begin = 0, rows; begin < height; begin += rows) {
        rows = Math.min(height, this.edgeRows);
        this.cast(sample, gbuffer, weights, environment, begin, Math.min(height, begin + rows), edges);
        const took_ms = yield;
        if (took_ms > 0) this.edgeRows = clamped(Math.floor((rows * budget_ms) / took_ms), 8, height);
      }
      this.addSample(mean, sample, edges, mostCounted / gain, 1 / samples, true);
    }
    this.addSample(sum, mean, edges, 1e30, 1, false);
    sum.samples = samples;
  }
  // Puts a share of a picture, of which no value counts more than `most`, into the tiles of another one that have edges, or adds it.
  addSample(target, picture, edges, most, share, add) {
    const gl = this.gl, program = (this.sampleProgram ??= this.program(tileVertex, sampleFragment));
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.framebuffer);
    if (add) gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE);
    gl.useProgram(program.program);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, picture.texture);
    gl.uniform1i(program.at("picture"), 0);
    gl.uniform1f(program.at("most"), most);
    gl.uniform1f(program.at("share"), share);
    gl.bindVertexArray(this.noVertices);
    this.drawTiles(program, target, edges.texture, 1, { tile: edgeTile, pick: [1, 0, 0, 0] });
    gl.activeTexture(gl.TEXTURE0);
    gl.disable(gl.BLEND);
  }
  // Marks the pixels of the mesh and at its outline that differ from those beside them.
  markEdges(gbuffer, sum, gain) {
    const gl = this.gl, program = (this.edgeProgram ??= this.program(this.data.programs.shading_vertex, edgeFragment));
    const edges = this.target("edges", sum.width, sum.height, gl.R8, false);
    gl.bindFramebuffer(gl.FRAMEBUFFER, edges.framebuffer);
    gl.viewport(0, 0, edges.width, edges.height);
    gl.disable(gl.BLEND);
    gl.useProgram(program.program);
    gl.uniform1f(program.at("gain"), gain);
    [["gbuffer", gbuffer], ["picture", sum]].forEach(([name, { texture }], unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.uniform1i(program.at(name), unit);
    });
    gl.activeTexture(gl.TEXTURE0);
    gl.bindVertexArray(this.noVertices);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    return edges;
  }
  // Chooses a program of shading(), with all that it reads, and returns the first unit that it leaves free.
  useShading(gbuffer, { texture, tilts, meshColor }, environment, program) {
    const gl = this.gl, made = this.environment(environment);
    gl.useProgram(program.program);
    let unit = 0;
    const bind = (sampler, kind, what) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(kind, what);
      gl.uniform1i(program.at(sampler), unit++);
    };
    bind("gbuffer", gl.TEXTURE_2D, gbuffer.texture);
    bind("occlusion", gl.TEXTURE_2D, gbuffer.second);
    bind("weights", gl.TEXTURE_2D, texture);
    if (tilts) bind("tilts", gl.TEXTURE_2D, tilts);
    if (program.discs) bind("discs", gl.TEXTURE_2D, program.discs);
    for (const cube of made.cubes) bind(cube.sampler, gl.TEXTURE_CUBE_MAP, cube.texture);
    for (const name of ["corner", "right", "down"]) gl.uniform3fv(program.at(name), gbuffer.view[name]);
    const { seen_from, drop } = this.data.mesh.ground, shade = this.groundShade(environment);
    gl.uniform3fv(program.at("ground_eye"), turnedAgainst(added(gbuffer.view.eye, seen_from, -1), this.turn));
    gl.uniform1f(program.at("ground_drop"), this.ground ? drop : 0);
    gl.uniform1f(program.at("reach"), gbuffer.view.reach);
    gl.uniform1i(program.at("own_lamps"), this.lamp ? 1 : 0);
    bind("ground_light", gl.TEXTURE_2D, shade.texture ?? gbuffer.texture);
    gl.uniform1f(program.at("ground_scale"), shade.scale);
    gl.uniform3fv(program.at("mesh_color"), meshColor);
    gl.uniform2fv(program.at("ground_turn"), this.turnVector);
    for (const [uniform, member] of [["light_direction", "direction"], ["light_white", "white"], ["light_disc", "disc"]])
      if (program.lamps.length > 0) gl.uniform3fv(program.at(uniform + "[0]"), program.lamps.flatMap((lamp) => lamp[member]));
    return unit;
  }

  // Covers a framebuffer, or the screen where it is null, by what a program makes of a target. `set` sets its other uniforms.
  cover(framebuffer, program, sampler, source, set) {
    const gl = this.gl;
    const { width, height } = framebuffer === null ? this.canvas : source;
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.viewport(0, 0, width, height);
    gl.useProgram(program.program);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, source.texture);
    gl.uniform1i(program.at(sampler), 0);
    gl.uniform1i(program.at("rows"), height);
    set(program);
    gl.bindVertexArray(this.noVertices);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  // Brings a sum to the screen, or into a framebuffer.
  show(sum, environment, stops, framebuffer = null) {
    this.display(sum, this.environment(environment).white, stops, framebuffer);
  }
  // The steps that draw the mesh in several paints, in cells that stand in so many columns, with so many samples a pixel.
  *showCells(camera, width, height, columns, weights, environment, stops, samples) {
    const gl = this.gl, rows = weights.length / columns, target = this.target("cell screen", width, height, gl.RGBA8, false);
    this.resize(columns * width, rows * height);
    for (const [i, own] of weights.entries()) {
      const sum = this.shade("cell", this.gbuffer("cell", camera, width, height, [0, 0], environment), own, environment);
      if (samples > 1) yield* this.smooth("cell", sum, camera, own, environment, stops, samples);
      this.show(sum, environment, stops, target.framebuffer);
      const left = (i % columns) * width, bottom = (rows - 1 - Math.floor(i / columns)) * height;
      gl.bindFramebuffer(gl.READ_FRAMEBUFFER, target.framebuffer);
      gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
      gl.blitFramebuffer(0, 0, width, height, left, bottom, left + width, bottom + height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
      gl.bindFramebuffer(gl.FRAMEBUFFER, null);
      if (samples > 1) yield;
    }
  }
  // `white` is the luminance that exposure 0 brings to 1.
  display(picture, white, stops, framebuffer) {
    this.cover(framebuffer, this.displayProgram, "picture", picture, (program) => {
      this.gl.uniform1i(program.at("stride"), picture.stride ?? 1);
      this.gl.uniformMatrix3fv(program.at("to_screen"), false, this.data.screens[this.screen]);
      this.gl.uniform1f(program.at("gain"), 2 ** stops / (white || 1));
    });
  }
  // Brings one picture to the screen, or two that meet at the column `border`.
  showSides(pictures, border, white, stops) {
    const gl = this.gl, { width, height } = this.canvas;
    gl.enable(gl.SCISSOR_TEST);
    for (const [picture, begin, end] of [[pictures[0], 0, border], [pictures[1], border, width]]) {
      if (end === begin) continue;
      gl.scissor(begin, 0, end - begin, height);
      this.display(picture, white, stops, null);
    }
    gl.disable(gl.SCISSOR_TEST);
  }
  // Radiance as a texture, in the place of `made` where that is given.
  pictureTexture(width, height, values, made = null) {
    if (made === null) return this.floatTexture(width, height, values);
    const gl = this.gl;
    gl.bindTexture(gl.TEXTURE_2D, made);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, height, 0, gl.RGBA, gl.FLOAT, values);
    return made;
  }
  resize(width, height) {
    if (this.canvas.width === width && this.canvas.height === height) return;
    this.canvas.width = width;
    this.canvas.height = height;
  }

  // Draws a picture by the pixel centers alone, into the targets of that name. `overlay` is null, or what the program of that name draws over it.
  draw(name, camera, width, height, weights, environment, stops, overlay = null) {
    this.resize(width, height);  // which waits for all that is still to be drawn
    const gbuffer = this.gbuffer(name, camera, width, height, [0, 0], environment);
    this.showWhole(gbuffer, this.shade(name, gbuffer, weights, environment), weights, environment, stops, overlay);
  }
  // Shows a sum that has both sides, where there are two.
  showWhole(gbuffer, sum, weights, environment, stops, overlay) {
    this.showOver(gbuffer, weights.left ? [sum, sum] : [sum], borderOf(weights, sum.width), weights, environment, stops, overlay);
  }
  // Shows one sum, or two that meet at a column, and the overlay.
  showOver(gbuffer, sums, border, weights, environment, stops, overlay, shown = this.sparkling ? this.sparkled(gbuffer, sums, border, weights, environment) : sums) {
    this.shown = { gbuffer, sums, border };
    this.resize(gbuffer.width, gbuffer.height);
    this.showSides(shown, border, this.environment(environment).white, stops);
    if (overlay) this.drawOver(gbuffer, overlay);
  }
  // The steps that draw rows, which take about budget_ms each; a step is told what the one before took. The time of all rows is returned.
  *inRows(height, budget_ms, draw) {
    let took = 0, rows = Math.ceil(height / 8), begin = 0;
    yield;
    while (begin < height) {
      const end = Math.min(height, begin + rows);
      draw(begin, end);
      const ms = yield;
      took += Math.max(0.5, ms - 4);  // a step is seen to have ended up to 4 ms late
      rows = clamped(Math.floor(((end - begin) * budget_ms) / ms), 8, 4 * rows);
      begin = end;
    }
    return took;
  }
  // The steps of a picture by the pixel centers, and their time.
  *drawSteps(name, camera, width, height, weights, environment, stops, budget_ms, overlay) {
    const gbuffer = this.gbuffer(name, camera, width, height, [0, 0], environment);
    const took = yield* this.inRows(height, budget_ms, (begin, end) => this.shade(name, gbuffer, weights, environment, begin, end));
    this.showWhole(gbuffer, this.targets.get("sum " + name), weights, environment, stops, overlay);
    return took;
  }
  // The steps that smooth the picture which was shown last, by the G-buffer of that name, and show it; then, with `sparkles`, those of flakes.
  *smoothSteps(name, camera, weights, environment, stops, samples, overlay, sparkles, budget_ms) {
    const { gbuffer, sums, border } = this.shown, apart = [...new Set(sums)];  // one, where it has both sides
    for (const [i, sum] of apart.entries()) yield* this.smooth(name, sum, camera, apart.length > 1 ? [weights.left, weights.right][i] : weights, environment, stops, samples, budget_ms);
    this.showOver(gbuffer, sums, border, weights, environment, stops, overlay);
    if (!sparkles || this.sparkling || !this.sees(gbuffer, weights, environment)) return;
    let flaky = sums;
    yield* this.inRows(gbuffer.height, budget_ms, (begin, end) => { flaky = this.sparkled(gbuffer, sums, border, weights, environment, begin, end); });
    this.showOver(gbuffer, sums, border, weights, environment, stops, overlay, flaky);
  }

  // The flakes of a paint under the lamps of an environment: {texture, per_m2, most}; null where single ones are not seen.
  flakesOf(weights, gbuffer, environment) {
    const { engine, mesh, data } = this, { eye, right } = gbuffer.view, packed = data.environments[environment];
    if (weights.tilts || !weights.paint?.flakes || !(this.lamp ? packed.lamp_programs : packed.programs).sparkle) return null;
    const radii = [...(this.lamp ? [data.lamp] : []), ...packed.lamps].map(({ disc }) => Math.asin(disc[0])), key = `${weights.version} ${radii}`;
    if (weights.flakes?.key !== key) {
      const { per_m2, most } = engine.ask({ do: "flakes", paint: weights.paint, lamps: radii }), values = engine.list("flakes");
      if (weights.flakes) this.gl.deleteTexture(weights.flakes.texture);
      weights.flakes = { key, per_m2, most, texture: per_m2 > 0 ? this.floatTexture(values.length / (4 * radii.length), radii.length, values) : null };
    }
    const { per_m2, most } = weights.flakes, apart = Math.hypot(...eye.map((at, i) => Math.max(mesh.low[i] - at, 0, at - mesh.high[i])));
    const flakes = per_m2 * (apart * Math.hypot(...right) * data.mesh.unit_m) ** 2;  // of a pixel of the nearest surface
    return most.some((part) => leastSparkle ** 2 * flakes * part < 1) ? weights.flakes : null;
  }
  sees(gbuffer, weights, environment) { return [weights.left ?? weights, weights.right].some((one) => one && this.flakesOf(one, gbuffer, environment)); }
  // The sums with the light of single flakes in some rows; sums stay where no eye sees those.
  sparkled(gbuffer, sums, border, weights, environment, begin = 0, end = gbuffer.height) {
    return sums.map((sum, i) => {
      const own = weights.left ? [weights.left, weights.right][i] : weights, flakes = sum.width === gbuffer.width ? this.flakesOf(own, gbuffer, environment) : null;
      return flakes ? this.sparkle(gbuffer, sum, own, flakes, environment, [i * border, begin, i > 0 ? sum.width - border : border, end - begin]) : sum;
    });
  }
  // Draws the mesh once more, so that its program knows the place of each pixel, and adds to a copy of the sum.
  sparkle(gbuffer, sum, weights, { texture, per_m2 }, environment, [x, y, width, height]) {
    const gl = this.gl, target = this.target(`sparkle ${x > 0}`, sum.width, sum.height, this.sumKind, false), program = this.shading(environment, false, "sparkle");
    this.groundShade(environment);  // before a target is bound
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, sum.framebuffer);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, target.framebuffer);
    gl.blitFramebuffer(x, y, x + width, y + height, x, y, x + width, y + height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.framebuffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, gbuffer.depth, 0);
    gl.viewport(0, 0, sum.width, sum.height);
    const unit = this.useShading(gbuffer, weights, environment, program), kinds = [gl.DEPTH_TEST, gl.BLEND, gl.SCISSOR_TEST];
    [["flakes", texture], ["picture", sum.texture]].forEach(([sampler, of], k) => {
      gl.activeTexture(gl.TEXTURE0 + unit + k);
      gl.bindTexture(gl.TEXTURE_2D, of);
      gl.uniform1i(program.at(sampler), unit + k);
    });
    gl.activeTexture(gl.TEXTURE0);
    for (const [name, value] of [["per_m2", per_m2], ["unit_m", this.data.mesh.unit_m], ["least", leastSparkle]]) gl.uniform1f(program.at(name), value);
    gl.uniform2fv(program.at("turn"), this.turnVector);
    gl.uniformMatrix4fv(program.at("clip"), false, gbuffer.view.clip);
    for (const kind of kinds) gl.enable(kind);
    gl.scissor(x, y, width, height);
    gl.depthMask(false);
    gl.depthFunc(gl.EQUAL);
    gl.blendFunc(gl.ONE, gl.ONE);
    gl.bindVertexArray(this.meshVertices);
    for (const part of this.shownParts.filter(({ row }) => row === 0)) gl.drawElements(gl.TRIANGLES, 3 * part.count, gl.UNSIGNED_INT, 12 * part.first);
    for (const kind of kinds) gl.disable(kind);
    gl.depthMask(true);
    gl.depthFunc(gl.LESS);
    return target;
  }

  // The picture from gathered light, where that is kept for this view and this light; else it draws nothing. Of `stride` pixels along both
  // sides it draws one, and those pictures need not look exactly where the lobes of the paint do. Returns whether it drew.
  drawGathered(name, camera, width, height, weights, environment, stops, overlay = null, stride = 1) {
    const { gathered } = this, own = weights.left ?? weights, key = gathered.keyOf(camera, width, height, environment);
    if (gathered.held && gathered.held.key !== key) gathered.drop();
    if (!gathered.serves(key, own, environment, stride)) return false;
    const gbuffer = this.gbuffer(name, camera, width, height, [0, 0], environment), sums = [gathered.shade("gathered " + stride, gbuffer, own, environment, stride)];
    if (weights.left) sums.push(this.otherSide(key, gbuffer, weights.right, environment));
    this.showOver(gbuffer, sums, borderOf(weights, width), weights, environment, stops, overlay);
    return true;
  }
  // The paint beside the design, which stays while the design changes.
  otherSide(key, gbuffer, weights, environment) {
    const known = this.targets.get("sum other side"), own = key + weights.version;
    if (known && known.key === own) return known;
    const target = this.shade("other side", gbuffer, weights, environment);
    target.key = own;
    return target;
  }
  // Gathers some of the light of a view, in so many rows, and returns whether there is more to be gathered.
  gather(name, camera, width, height, weights, environment, others = true, rows = height) {
    const key = this.gathered.keyOf(camera, width, height, environment);
    return this.gathered.gather(key, this.gbuffer(name, camera, width, height, [0, 0], environment), weights.left ?? weights, environment, others, rows);
  }

  // Rings and the highlight of the light from `toward`, as the environment sees it, over what the canvas shows.
  drawOver(gbuffer, { toward, travel, edge }) {
    const gl = this.gl;
    this.overlayProgram ??= this.program(this.data.programs.shading_vertex, this.data.programs.overlay_fragment);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    this.cover(null, this.overlayProgram, "gbuffer", gbuffer, (program) => {
      for (const name of ["corner", "right", "down"]) gl.uniform3fv(program.at(name), gbuffer.view[name]);
      gl.uniform3fv(program.at("toward"), toward);
      gl.uniform1f(program.at("travel"), travel);
      gl.uniform1f(program.at("edge"), edge);
    });
    gl.disable(gl.BLEND);
  }

  // The surface at a place of the picture, 0..1 from its upper left corner: the normal and the direction to the viewer, as the environment
  // sees them, and whether it wears the paint; null beside the mesh. The buffer that tells it is kept while the view stays.
  surfaceAt(camera, aspect, x, y) {
    const gl = this.gl, width = 640, height = Math.round(width / aspect), known = this.surface;
    const gbuffer = this.gbuffer("surface", camera, width, height, [0, 0], null);
    if (!known || known.key !== gbuffer.key || known.height !== height) {
      const values = new Float32Array(4 * width * height);
      gl.bindFramebuffer(gl.FRAMEBUFFER, gbuffer.framebuffer);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, values);
      this.surface = { key: gbuffer.key, height, values };
    }
    const column = Math.floor(clamped(x, 0, 1) * width), row = Math.floor(clamped(y, 0, 1) * height);
    const at = 4 * (clamped(row, 0, height - 1) * width + clamped(column, 0, width - 1)), values = this.surface.values;
    if (values[at + 3] === 0) return null;
    const { corner, right, down } = gbuffer.view;
    const ray = added(added(corner, right, column + 0.5), down, row + 0.5);
    return { normal: [...values.subarray(at, at + 3)], wo: scaled(unit(ray), -1), painted: (Math.abs(values[at + 3]) & 7) === 1 };
  }

  // The parts wear other rows than before. `second` has the weights of the second paint, where there is one.
  partsChanged(second) {
    if (second) this.finishes.set(second);
    ++this.partsVersion;
    this.gathered.drop();
  }
  get shownParts() { return this.mesh.parts.filter(({ row }) => row !== hiddenRow); }
  get turnVector() { return [Math.cos((this.turn * Math.PI) / 180), Math.sin((this.turn * Math.PI) / 180)]; }
  // Where another paint is worn beside the design, layers of light that suit the one need not suit the other.
  get hasSecond() { return this.mesh.parts.some(({ row }) => row === 1); }

  // {point, part} of the mesh that is seen at a place of the picture, as surfaceAt() has it; null beside the mesh.
  pointUnder(camera, aspect, x, y) {
    const height = 720, width = Math.round(height * aspect), { corner, right, down } = projected(camera, width, height, this.mesh, [0, 0]);
    const { positions, corners } = this.mesh, ray = added(added(corner, right, x * width), down, y * height), at = (i) => positions.subarray(3 * corners[i], 3 * corners[i] + 3);
    let nearest = Infinity, met = 0;
    const shown = this.shownParts;
    for (const { first, count } of shown)
      for (let i = 3 * first; i < 3 * (first + count); i += 3) {  // u and v are barycentric
        const a = at(i), ab = added([...at(i + 1)], a, -1), ac = added([...at(i + 2)], a, -1), p = crossed(ray, ac), determinant = dotted(ab, p);
        const from = added(camera.eye, a, -1), u = dotted(from, p) / determinant, q = crossed(from, ab), v = dotted(ray, q) / determinant;
        if (!(u >= 0 && v >= 0 && u + v <= 1)) continue;
        const distance = dotted(ac, q) / determinant;
        if (distance > 0 && distance < nearest) [nearest, met] = [distance, i];
      }
    if (nearest === Infinity) return null;
    return { point: added(camera.eye, ray, nearest), part: shown.find(({ first, count }) => met >= 3 * first && met < 3 * (first + count)) };
  }

  // Shows nothing.
  blank() {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.clearColor(0.46, 0.46, 0.46, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
  }

  // A promise that is kept when everything is drawn.
  drawn() {
    const gl = this.gl, fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    return new Promise((resolve) => {
      const look = () => {
        if (!gl.isContextLost() && gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED) return setTimeout(look, 1);
        gl.deleteSync(fence);
        return resolve();
      };
      look();
    });
  }

  // A small picture for a tile, as pixels of a canvas.
  tile(camera, width, height, weights, environment, stops) {
    const gbuffer = this.gbuffer("tile", camera, width, height, [0, 0], environment);
    return this.pixels(this.shade("tile", gbuffer, weights, environment), this.environment(environment).white, stops);
  }
  // The pixels of a canvas by which the screen shows a picture.
  async pixels(radiance, white, stops) {
    const gl = this.gl, { width, height } = radiance, target = this.target("tile screen", width, height, gl.RGBA8, false);
    this.display(radiance, white, stops, target.framebuffer);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.framebuffer);
    const pixels = new Uint8ClampedArray(4 * width * height), picture = new ImageData(width, height, { colorSpace: this.screen }), buffer = gl.createBuffer();
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, buffer);
    gl.bufferData(gl.PIXEL_PACK_BUFFER, pixels.length, gl.STREAM_READ);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, 0);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
    await this.drawn();
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, buffer);
    gl.getBufferSubData(gl.PIXEL_PACK_BUFFER, 0, pixels);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
    gl.deleteBuffer(buffer);
    for (let y = 0; y < height; ++y)  // rows come from below
      picture.data.set(pixels.subarray(4 * width * (height - 1 - y), 4 * width * (height - y)), 4 * width * y);
    return picture;
  }

  // The radiance of every pixel center, as floats from the upper left corner.
  radiance(camera, width, height, weights, environment) {
    const gbuffer = this.gbuffer("radiance", camera, width, height, [0, 0], environment);
    return this.valuesOf(this.shade("radiance", gbuffer, weights, environment));
  }
  // The radiance from gathered light, which is gathered for it.
  gatheredRadiance(camera, width, height, weights, environment) {
    const gbuffer = this.gbuffer("radiance", camera, width, height, [0, 0], environment);
    const key = this.gathered.keyOf(camera, width, height, environment);
    while (this.gathered.gather(key, gbuffer, weights, environment, false));
    if (!this.gathered.serves(key, weights, environment)) throw new Error(words("There is no room for the layers of this picture."));
    return this.valuesOf(this.gathered.shade("radiance", gbuffer, weights, environment));
  }
  valuesOf(sum) {
    const gl = this.gl, { width, height } = sum;
    const values = new Float32Array(4 * width * height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, sum.framebuffer);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, values);
    return values;
  }
}
