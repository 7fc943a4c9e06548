// The shadow of the mesh on itself: the light that each vertex loses, as the moments that the program of the G-buffer
// reads; and its shadow on the ground, in lights for which the tool has not found it. Depths of the mesh are drawn from
// directions all around, in tiles of one picture. Each vertex and each place of the ground is a texel that keeps one bit for each
// direction, from which the light of any environment is taken. goniochrome-transport(7), "Shadows of a page".

const tile = 512, tilesAcross = 8, tilesDown = 4, atOnce = 32, aroundCount = 128, vertexColumns = 1024, groundSize = 192;
const lightExponent = 60;   // a lobe about as wide as the part of the sphere that one of the directions stands for
const fineExponent = 1000;  // that lobe, where it looks at ground near by, as the eye of the environment saw it

// Directions that lie evenly on the sphere, or on its part above `low`, in a spiral.
const evenly = (low) => Array.from({ length: aroundCount }, (_, i) => {
  const y = 1 - ((1 - low) * (2 * i + 1)) / (2 * aroundCount), ring = Math.sqrt(1 - y * y), angle = Math.PI * (3 - Math.sqrt(5)) * i;
  return [ring * Math.cos(angle), y, ring * Math.sin(angle)];
});
const around = evenly(-1), above = evenly(0);

const occlusionHead = `#version 300 es
precision highp float;
precision highp sampler2D;
precision highp usampler2D;
precision highp samplerCube;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform ivec2 size;  // of the picture of points
uniform vec4 ball;  // around the mesh: middle, 1/radius
vec3 in_tile(vec3 p, vec3 d) {  // x, y and depth from 0 to 1, as seen from direction d
  vec3 x = normalize(cross(abs(d.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0), d)), at = (p - ball.xyz) * ball.w;
  return 0.5 + 0.5 * vec3(dot(at, x), dot(at, cross(d, x)), -dot(at, d));
}
`;
const inTexel = `
  ivec2 texel = ivec2(gl_VertexID % size.x, gl_VertexID / size.x);
  gl_Position = vec4((2.0 * vec2(texel) + 1.0) / vec2(size) - 1.0, 0.0, 1.0);
  gl_PointSize = 1.0;
`;
const depthVertex = `${occlusionHead}
uniform vec3 toward;
void main() { gl_Position = vec4(2.0 * in_tile(position, toward) - 1.0, 1.0); }
`;
const depthFragment = `#version 300 es
precision highp float;
uniform float painted;
layout(location = 0) out vec4 color;
void main() { color = vec4(painted); }
`;
const inTiles = `
uniform sampler2D depths, paints;  // paints: 1 where the part is painted
vec2 place;
bool is_hidden(vec3 p, vec3 d, int i) {
  vec3 at = in_tile(p, d);
  place = (clamp(at.xy, 0.001, 0.999) + vec2(i % ${tilesAcross}, i / ${tilesAcross})) / vec2(${tilesAcross}, ${tilesDown});
  return textureLod(depths, place, 0.0).x < min(at.z, 0.999);
}
`;
const bitsVertex = `${occlusionHead}${inTiles}
uniform vec3 toward[${atOnce}];
flat out uint bits, painted;
void main() {
  bits = painted = 0u;
  for (int i = 0; i < ${atOnce}; ++i) {
    vec3 p = position + (dot(toward[i], normal) < 0.0 ? -4.0 : 4.0) / (${tile}.0 * ball.w) * normal;
    if (!is_hidden(p, toward[i], i)) continue;
    bits |= 1u << i;
    if (textureLod(paints, place, 0.0).x > 0.5) painted |= 1u << i;
  }
${inTexel}}
`;
const bitsFragment = `#version 300 es
precision highp float;
flat in uint bits, painted;
layout(location = 0) out uvec4 hidden;
layout(location = 1) out uvec4 by_paint;
void main() { hidden = uvec4(bits), by_paint = uvec4(painted); }
`;
const ofLight = `
const vec3 luminance = vec3(0.2627, 0.678, 0.0593);  // of Rec.2020
uniform vec3 around[${aroundCount}];
uniform usampler2D seen, by_paint;
uniform samplerCube light, fine;  // of lobes of lightExponent and fineExponent
uniform vec2 turn;
vec3 of_map(samplerCube map, vec3 d) {
  return textureLod(map, vec3(turn.x * d.x - turn.y * d.z, d.y, turn.y * d.x + turn.x * d.z), 0.0).rgb;
}
vec3 shine(vec3 d) { return of_map(light, d); }
`;
const ofLamps = `
uniform int lamps;
uniform vec3 lamp_toward[${atOnce}], lamp_white[${atOnce}];
uniform samplerCube diffuse;
vec3 white(vec3 n) {
  vec3 sum = of_map(diffuse, n);
  for (int i = 0; i < lamps; ++i) sum += max(dot(lamp_toward[i], n), 0.0) * lamp_white[i];
  return sum;
}
`;
const lossVertex = `${occlusionHead}${inTiles}${ofLight}${ofLamps}
uniform sampler2D ground_light;
uniform vec3 seen_from;
uniform float ground_height, ground_scale, fine_part;  // 1 over the logarithm of how much sharper the fine one is
flat out vec4 first, second;
flat out vec3 third;
flat out vec4 sent;
void main() {
${inTexel}
  first = second = sent = vec4(0.0);
  third = vec3(0.0);
  vec4 of_mesh = vec4(0.0);
  vec2 open = vec2(0.0);
  uvec4 all = texelFetch(seen, texel, 0), painted = texelFetch(by_paint, texel, 0);
  for (int i = 0; i < ${aroundCount}; ++i) {
    vec3 d = around[i];
    float cosine = dot(d, normal), lost = 0.0, given = 0.0;
    bool hidden = (all[i >> 5] >> (i & 31) & 1u) != 0u;
    if (hidden) {
      lost = dot(luminance, shine(d));
      if ((painted[i >> 5] >> (i & 31) & 1u) != 0u) given = dot(luminance, white(-d));
    } else if (d.y < 0.0) {
      vec3 met = position - max(position.y - ground_height, 0.0) / d.y * d;
      vec2 p = clamp(ground_scale * (met - seen_from).xz, -1e3, 1e3);
      vec3 at = met - seen_from;
      vec4 kept = ground_scale > 0.0 ? texture(ground_light, 0.5 + 0.5 * p * inversesqrt(1.0 + p * p)) : vec4(1.0, 1.0, 1.0, 0.0);
      float nearer = length(at) / max(distance(met, position), 1e-5), sharper = nearer * nearer * nearer * (ground_height - position.y) / at.y;
      vec3 shown = mix(shine(at), of_map(fine, at), clamp(log(max(sharper, 1e-9)) * fine_part, 0.0, 1.0));
      lost = dot(luminance, shine(d) - kept.rgb * shown);
      given = kept.a * dot(luminance, shown);
    }
    // On a back the diffuse part stands for all lobes.
    if (cosine <= 0.0) {
      third.y -= 2.0 * cosine * lost / ${aroundCount}.0;
      continue;
    }
    vec3 other = d - 2.0 * cosine * normal;
    lost *= cosine / ${aroundCount}.0;
    given *= cosine / ${aroundCount}.0;
    open += cosine * vec2(hidden ? 0.0 : 1.0, 1.0);
    vec4 given_from = given * vec4(d + other, 2.0);
    if (hidden) of_mesh += given_from;
    else sent += given_from;
    first += lost * vec4(d + other, d.x * d.x + other.x * other.x);
    second += lost * vec4(d.yz * d.yz + other.yz * other.yz, d.x * d.y + other.x * other.y, d.y * d.z + other.y * other.z);
    third.x += lost * (d.z * d.x + other.z * other.x);
  }
  open.x /= max(open.y, 1e-6);
  sent += open.x * open.x * of_mesh;
  vec3 p = position + 1.5 / (${tile}.0 * ball.w) * normal;
  float whole = 0.0;
  for (int i = 0; i < lamps; ++i) {
    float given = max(dot(lamp_toward[i], normal), 0.0) * dot(luminance, lamp_white[i]);
    whole += given;
    if (lamp_toward[i].y < 0.0 || is_hidden(p, lamp_toward[i], i)) third.z += given;
  }
  third.z /= max(whole, 1e-9);
}
`;
const lossFragment = `#version 300 es
precision highp float;
flat in vec4 first, second;
flat in vec3 third;
flat in vec4 sent;
layout(location = 0) out vec4 moments_0;
layout(location = 1) out vec4 moments_1;
layout(location = 2) out vec4 moments_2;
layout(location = 3) out vec4 moments_3;
void main() { moments_0 = first, moments_1 = second, moments_2 = vec4(third, 0), moments_3 = sent; }
`;
// The part of its light that a place of the ground keeps, and the light from a white matt mesh, which faces the place and is as open
// as that. Neighbors smooth the few directions; lamps are looked up by themselves.
const groundVertex = `${occlusionHead}${inTiles}${ofLight}${ofLamps}
flat out vec4 kept;
void main() {
${inTexel}
  vec3 all = vec3(0.0);
  kept = vec4(0.0);
  for (int i = 0; i < ${aroundCount}; ++i) {
    vec3 whole = 2.0 / ${aroundCount}.0 * around[i].y * shine(around[i]);
    float hidden = 0.0;
    for (int k = 0; k < 9; ++k) {
      ivec2 at = clamp(texel + 2 * ivec2(k % 3 - 1, k / 3 - 1), ivec2(0), size - 1);
      hidden += float(texelFetch(seen, at, 0)[i >> 5] >> (i & 31) & 1u) / 9.0;
    }
    all += whole;
    kept.rgb += (1.0 - hidden) * whole;
    kept.a += hidden * 2.0 / ${aroundCount}.0 * around[i].y * dot(luminance, white(-around[i]));
  }
  for (int i = 0; i < lamps; ++i) {
    vec3 whole = max(lamp_toward[i].y, 0.0) * lamp_white[i];
    all += whole;
    for (int k = 0; k < 9; ++k) {
      vec3 p = position + vec3(k % 3 - 1, 0, k / 3 - 1) / (${tile}.0 * ball.w);
      if (!is_hidden(p, lamp_toward[i], i)) kept.rgb += whole / 9.0;
    }
  }
  kept /= max(vec4(all, dot(luminance, all)), vec4(1e-9));
  kept.a *= dot(luminance, kept.rgb);
}
`;
const groundFragment = `#version 300 es
precision highp float;
flat in vec4 kept;
layout(location = 0) out vec4 color;
void main() { color = kept; }
`;

class Occlusion {
  constructor(stage) {
    this.stage = stage;
    this.columns = 0;  // of the pictures of moments; 0 until they are known
    this.busy = false;
    this.held = false;  // whether the light that was taken stays, as while it is turned
    this.keys = { mesh: [], ground: [] };  // environment and turn of the light that is taken
    const { exponents } = stage.data.basis, nearest = (wanted) => [...exponents].sort((a, b) => Math.abs(Math.log(a / wanted)) - Math.abs(Math.log(b / wanted)))[0];
    const [light, fine] = [lightExponent, fineExponent].map(nearest), sampler = (exponent) => `lobe_${exponents.indexOf(exponent)}`;
    Object.assign(this, { sampler: sampler(light), fine: sampler(fine), finePart: fine > light ? 1 / Math.log(fine / light) : 0 });
  }

  // A picture of points, of so many textures.
  picture({ columns, rows }, kind, count) {
    const { gl } = this.stage, framebuffer = gl.createFramebuffer(), places = [...Array(count).keys()].map((i) => gl.COLOR_ATTACHMENT0 + i);
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    const filter = kind === gl.RGBA8 ? gl.LINEAR : gl.NEAREST;
    const textures = places.map((place) => {
      const texture = gl.createTexture();
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texStorage2D(gl.TEXTURE_2D, 1, kind, columns, rows);
      for (const [what, how] of [[gl.TEXTURE_MIN_FILTER, filter], [gl.TEXTURE_MAG_FILTER, filter], [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]]) gl.texParameteri(gl.TEXTURE_2D, what, how);
      gl.framebufferTexture2D(gl.FRAMEBUFFER, place, gl.TEXTURE_2D, texture, 0);
      return texture;
    });
    gl.drawBuffers(places);
    return { framebuffer, textures };
  }
  points(columns, positions, normals) {
    const count = positions.length / 3, size = { columns, rows: Math.ceil(count / columns) };
    return { ...size, count, vertices: this.stage.vertices(positions, normals), bits: this.picture(size, this.stage.gl.RGBA32UI, 2) };
  }
  // Draws points into a picture of them by a program, which reads textures [name, kind, texture]; `set` sets its other uniforms.
  draw(program, { vertices, count, columns, rows }, picture, textures, set) {
    const { gl } = this.stage;
    gl.bindFramebuffer(gl.FRAMEBUFFER, picture.framebuffer);
    gl.viewport(0, 0, columns, rows);
    gl.useProgram(program.program);
    textures.forEach(([name, kind, texture], unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(kind, texture);
      gl.uniform1i(program.at(name), unit);
    });
    gl.activeTexture(gl.TEXTURE0);
    gl.uniform4fv(program.at("ball"), this.ball);
    gl.uniform2i(program.at("size"), columns, rows);
    set(program);
    gl.disable(gl.BLEND);
    gl.bindVertexArray(vertices);
    gl.drawArrays(gl.POINTS, 0, count);
  }

  // Begins to find what is in the way of light.
  begin() {
    this.work = this.steps();
    this.busy = true;
  }
  // Goes on with it, and returns whether there is more to be done.
  step() {
    this.busy = false;  // where a step fails
    return (this.busy = !this.work.next().done);
  }
  *steps() {
    const { stage } = this, { low, high, positions, normals } = stage.mesh, size = added(high, low, -1);
    this.ball = [...scaled(added(low, high), 0.5), 2 / (1.02 * Math.hypot(...size) || 1)];
    this.mesh ??= this.points(vertexColumns, positions, normals);  // not turned with the light
    const shown = stage.shownParts.map(({ first, row }) => `${first} ${row < 2}`).join();
    if (this.shown !== shown) {
      this.shown = null;  // until all bits are of these parts
      yield* this.look(this.mesh, around);
      [this.shown, this.columns, this.ground] = [shown, vertexColumns, null];
      this.changed();
    }
    if (this.ground || stage.data.environments.every((one) => one.ground_light)) return;
    const ground = (this.places ??= this.groundPlaces(size));
    yield* this.look(ground, above);
    this.ground = ground;
    this.changed();
  }
  // Places of the ground, which stay while its shadow is sought again.
  groundPlaces(size) {
    const { low, high } = this.stage.mesh, reach = 0.6 * Math.max(size[0], size[2]) + 2 * size[1], places = new Float32Array(3 * groundSize ** 2);
    const line = (i) => { const u = (2 * i + 1) / groundSize - 1; return (reach * u) / Math.sqrt(1 - u * u); };  // as the tool lays its texels
    for (let i = 0; i < places.length; i += 3)
      places.set([(low[0] + high[0]) / 2 + line((i / 3) % groundSize), low[1], (low[2] + high[2]) / 2 + line(Math.floor(i / 3 / groundSize))], i);
    const ground = this.points(groundSize, places, places.map((_, i) => (i % 3 === 1 ? 1 : 0)));
    return { ...ground, reach, shade: this.picture(ground, this.stage.gl.RGBA8, 1) };
  }
  changed() {
    this.keys = { mesh: [], ground: [] };
    ++this.stage.partsVersion;
    this.stage.gathered.drop();
  }
  get depths() { return this.stage.target("depths", tilesAcross * tile, tilesDown * tile, this.stage.gl.R8, true); }
  *look(points, directions) {
    const { gl } = this.stage, program = (this.bitsProgram ??= this.stage.program(bitsVertex, bitsFragment));
    for (let begin = 0; begin < aroundCount; begin += atOnce) {
      const list = directions.slice(begin, begin + atOnce);
      do {
        this.lampsDrawn = false;  // over these depths, by a picture between two steps
        for (let i = 0; i < atOnce; ++i) {
          this.drawDepth(list[i], i);
          if (i % 2 === 1) yield;
        }
      } while (this.lampsDrawn);
      gl.colorMask(...[0, 1, 2, 3].map((channel) => channel === begin / atOnce));
      this.draw(program, points, points.bits, [["depths", gl.TEXTURE_2D, this.depths.depth], ["paints", gl.TEXTURE_2D, this.depths.texture]], () => gl.uniform3fv(program.at("toward[0]"), list.flat()));
      gl.colorMask(true, true, true, true);
    }
  }
  // The depths of the mesh in a tile, as seen from far away in a direction.
  drawDepth(toward, number) {
    const { stage, depths } = this, { gl } = stage, program = (this.depthProgram ??= stage.program(depthVertex, depthFragment)), place = [tile * (number % tilesAcross), tile * Math.floor(number / tilesAcross), tile, tile];
    gl.bindFramebuffer(gl.FRAMEBUFFER, depths.framebuffer);
    gl.useProgram(program.program);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(...place);
    gl.viewport(...place);
    gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 0]);
    gl.clearBufferfv(gl.DEPTH, 0, [1]);
    gl.disable(gl.SCISSOR_TEST);
    gl.uniform4fv(program.at("ball"), this.ball);
    gl.uniform3fv(program.at("toward"), toward);
    gl.bindVertexArray(stage.meshVertices);
    for (const { first, count, row } of stage.shownParts) {
      gl.uniform1f(program.at("painted"), row < 2 ? 1 : 0);
      gl.drawElements(gl.TRIANGLES, 3 * count, gl.UNSIGNED_INT, 12 * first);
    }
    gl.disable(gl.DEPTH_TEST);
  }

  // True if the light of an environment is taken, or that of another turn of it is held.
  has(what, environment) {
    const [of, turn] = this.keys[what];
    return of === environment && (turn === this.stage.turn || this.held);
  }
  // Takes the light of an environment for points, unless it is there; returns the name of its state.
  take(what, environment, program, points, picture, directions, textures, set) {
    const { stage } = this, { gl } = stage;
    if (this.has(what, environment)) return this.keys[what].join();
    const cubes = [["light", this.sampler], ["fine", this.fine], ["diffuse", "diffuse"]].map(([name, of]) => [name, gl.TEXTURE_CUBE_MAP, stage.environment(environment).cubes.find(({ sampler }) => sampler === of).texture]);
    this.draw(program, points, picture, [["seen", gl.TEXTURE_2D, points.bits.textures[0]], ["by_paint", gl.TEXTURE_2D, points.bits.textures[1]], ...cubes, ...textures], () => {
      gl.uniform3fv(program.at("around[0]"), directions.flat());
      gl.uniform2fv(program.at("turn"), stage.turnVector);
      set();
    });
    this.keys[what] = [environment, stage.turn];
    return this.keys[what].join();
  }
  // Draws the depths of the mesh as lamps see it, where their light is to be taken; returns what sets them in a program.
  lamps(what, environment, program) {
    const { stage } = this, { gl } = stage, lamps = stage.data.environments[environment].lamps.slice(0, atOnce), toward = lamps.map(({ direction }) => turnedAgainst(direction, -stage.turn));
    if (!this.has(what, environment) && toward.length > 0) {
      this.lampsDrawn = true;
      toward.forEach((direction, i) => this.drawDepth(direction, i));
    }
    return () => {
      gl.uniform1i(program.at("lamps"), lamps.length);
      if (lamps.length > 0) gl.uniform3fv(program.at("lamp_toward[0]"), toward.flat());
      if (lamps.length > 0) gl.uniform3fv(program.at("lamp_white[0]"), lamps.flatMap(({ white }) => white));
    };
  }
  // The moments of the light that is lost in an environment; returns the name of their state.
  takeLoss(environment) {
    const { stage } = this, { gl } = stage;
    if (this.columns === 0 || !stage.ground || !stage.data.environments[environment].cubes.some(({ sampler }) => sampler === this.sampler)) return "none";
    const { texture, scale } = stage.groundShade(environment), program = (this.lossProgram ??= stage.program(lossVertex, lossFragment));
    this.moments ??= this.picture(this.mesh, gl.RGBA16F, 4);
    const setLamps = this.lamps("mesh", environment, program);
    return this.take("mesh", environment, program, this.mesh, this.moments, around, [["ground_light", gl.TEXTURE_2D, texture ?? this.depths.texture], ["depths", gl.TEXTURE_2D, this.depths.depth]], () => {
      setLamps();
      gl.uniform1f(program.at("ground_scale"), scale);
      gl.uniform1f(program.at("fine_part"), this.finePart);
      gl.uniform3fv(program.at("seen_from"), stage.data.mesh.ground.seen_from);
      gl.uniform1f(program.at("ground_height"), stage.mesh.low[1]);
    });
  }
  // The shadow on the ground, which is known: {texture, reach}.
  groundLight(environment) {
    const { stage, ground } = this, { gl } = stage, program = (this.groundProgram ??= stage.program(groundVertex, groundFragment));
    this.take("ground", environment, program, ground, ground.shade, above, [["depths", gl.TEXTURE_2D, this.depths.depth]], this.lamps("ground", environment, program));
    return { texture: ground.shade.textures[0], reach: ground.reach };
  }
}
