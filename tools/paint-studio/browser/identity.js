// Compares the arithmetic of the page with that of the tools on random paints and edits: paint-edit, fit-paint, paint-stats
// and colorsnap must be in $PATH. Prints one line for each.
//
//   node identity.js studio.wasm b7.basis.xml [PAINTS [SEED]]
"use strict";
const { spawnSync } = require("node:child_process");
const fs = require("node:fs");
const os = require("node:os");
const path = require("node:path");
const { makeEngine } = require("../page/engine.js");
const { optionsOf } = require("../page/handoff.js");

// Numbers from 0 to 1, the same for the same seed.
function randomNumbers(seed) {
  let state = seed >>> 0 || 1;
  return () => {
    state ^= state << 13;
    state >>>= 0;
    state ^= state >>> 17;
    state ^= state << 5;
    state >>>= 0;
    return state / 4294967296;
  };
}

const two = (value) => Number(value.toFixed(2));

// A paint that is measured at five angles, or designed; one in eight has no gloss.
function randomPaint(random, number) {
  const between = (low, high) => two(low + (high - low) * random());
  const lab = (light) => [between(0.3 * light, light), between(-60, 60), between(-60, 60)];
  const face = lab(100), flop = lab(face[0]), paint = { name: "p" + number, class: random() < 0.5 ? "metallic" : "pearl" };
  if (random() < 0.3) {
    paint.appearance = { face, flop, travel: between(25, 120) };
  } else {
    paint.measurement = { illuminant: "D65", observer: 10, rows: [15, 25, 45, 75, 110].map((angle) => {
      const share = ((110 - angle) / 95) ** (1 + 2 * random());
      return { geometry: "45as" + angle, lab: flop.map((from, i) => two(from + share * (face[i] - from) + (random() - 0.5))) };
    }) };
    for (const row of paint.measurement.rows) row.lab[0] = Math.max(0.5, row.lab[0]);
  }
  if (random() < 0.875) paint.gloss = [[60, between(5, 98)]];
  return paint;
}

// One edit of every kind, with random numbers.
function randomEdits(random) {
  const between = (low, high) => two(low + (high - low) * random());
  const lab = () => [between(5, 100), between(-60, 60), between(-60, 60)], shift = () => [between(-8, 8), between(-8, 8), between(-8, 8)];
  return [
    { face: lab() }, { flop: lab() }, { travel: between(20, 170) }, { gloss: between(0, 100) }, { "face-shift": shift() },
    { "flop-shift": shift() }, { "travel-shift": between(-10, 30) }, { "gloss-shift": between(-20, 20) },
    { hue: between(0, 360) }, { chroma: between(0, 80) }, { lightness: between(5, 95) }, { "hue-shift": between(-180, 180) },
    { "chroma-factor": between(0, 2), "lightness-shift": between(-5, 5) },
    { at: between(15, 110), "lightness-shift": between(-6, 6), "hue-shift": between(-20, 20) },
    { anisotropy: [between(0.01, 1), between(0.01, 1)] }, { flakes: [between(5, 100), between(0.01, 1), between(0, 2)] }, { face: lab(), "keep-residual": true }, { set: [{ geometry: "45as45", lab: lab() }] },
  ];
}

const xmlOf = (paints) => paints.join("");
const elements = (xml) => xml.match(/ {2}<paint [\s\S]*?<\/paint>\n/g) ?? [];
const numbers = (text) => (text.match(/"[-+0-9.e]+"|>[-+0-9.e]+</g) ?? []).map((word) => Number(word.slice(1, -1)));

// How two texts of paints differ: whether they are the same, and by how much their numbers differ at most, relative to
// the larger of the number and `floor`; Infinity where anything else differs.
function difference(a, b, floor) {
  if (a === b) return 0;
  const x = numbers(a), y = numbers(b), bare = (text) => text.replace(/"[-+0-9.e]+"|>[-+0-9.e]+</g, "");
  if (bare(a) !== bare(b) || x.length !== y.length) return Infinity;
  return Math.max(...x.map((value, i) => Math.abs(value - y[i]) / Math.max(Math.abs(value), floor)));
}

class Tally {
  constructor(what) { Object.assign(this, { what, same: 0, count: 0, worst: 0, other: 0 }); }
  add(by) {
    ++this.count;
    if (by === 0) ++this.same;
    else if (by === Infinity) ++this.other;
    else this.worst = Math.max(this.worst, by);
  }
  print() {
    console.log(`${this.what}: ${this.same} of ${this.count} identical to the last bit, ${this.other} of another form, ` +
                `the others within ${this.worst.toExponential(1)}`);
  }
}

async function main() {
  const [module, basisFile, count = "160", seed = "1"] = process.argv.slice(2);
  const engine = await makeEngine(new WebAssembly.Module(fs.readFileSync(module))), random = randomNumbers(Number(seed));
  const text = fs.readFileSync(basisFile, "utf8");
  const basis = { name: text.match(/<basis [^>]*name="([^"]*)"/)[1], mirror: text.includes("<mirror/>"),
                  exponents: [...text.matchAll(/<exponent>([^<]*)</g)].map((match) => Number(match[1])) };
  const edits = randomEdits(random), each = Math.ceil(Number(count) / edits.length);
  const paints = Array.from({ length: each * edits.length }, (_, i) => randomPaint(random, i));
  engine.ask({ do: "load", basis, paints });
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "identity-")), at = (name) => path.join(folder, name);
  const head = '<?xml version="1.0" encoding="UTF-8"?>\n<paints xmlns="urn:goniochrome:paint:1" version="1">\n';
  const write = (name, list) => fs.writeFileSync(at(name), head + xmlOf(list.map((paint) => elements(engine.ask(
    { do: "write", paint, as: "xml" }).text)[0])) + "</paints>\n");
  // Status 1 is a verdict: paints without gloss have none that could be shifted, and some designs are far from all others.
  const run = (tool, options) => {
    const { status, stdout, stderr } = spawnSync(tool, options, { maxBuffer: 1 << 28 });
    if (status !== 0 && status !== 1) throw new Error(`${tool} ${options.join(" ")}: ${stderr}`);
    return stdout.toString();
  };
  const tallies = { edit: new Tally("edits"), fit: new Tally("fits"), stats: new Tally("metrics"), near: new Tally("nearest paints") };
  try {
    write("library.xml", paints);
    const edited = [];
    edits.forEach((edit, kind) => {
      const some = paints.slice(kind * each, (kind + 1) * each);
      write("some.xml", some);
      const options = optionsOf(edit).map((word) => word.replaceAll("'", ""));
      const theirs = elements(run("paint-edit", ["--quiet", ...options, at("some.xml")]));
      some.forEach((paint, i) => {
        const ours = engine.ask({ do: "edit", paint, edit }).paint;
        const difference_ = difference(elements(engine.ask({ do: "write", paint: ours, as: "xml" }).text)[0], theirs[i] ?? "", 1);
        tallies.edit.add(difference_);
        if (difference_ > 1e-6 && process.env.SHOW) console.log(JSON.stringify(edit), elements(engine.ask({ do: "write", paint: ours, as: "xml" }).text)[0], theirs[i]);
        edited.push(ours);
      });
    });
    write("edited.xml", edited);
    const fitted = elements(run("fit-paint", ["--quiet", "--basis", basisFile, at("edited.xml")]));
    edited.forEach((paint, i) => {
      const ours = elements(engine.ask({ do: "write", paint, as: "xml", lobes: true }).text)[0];
      const by = difference(ours, fitted[i] ?? "", 0.01);
      tallies.fit.add(by);
      if (by > 1e-6 && process.env.SHOW) console.log(ours, fitted[i]);
    });
    run("paint-stats", ["--quiet", "--report", at("stats.json"), "-o", "/dev/null", at("edited.xml")]);
    const stats = JSON.parse(fs.readFileSync(at("stats.json"), "utf8")).results.paints;
    edited.forEach((paint, i) => {
      const { flags, ...ours } = engine.ask({ do: "describe", paint }).metrics, names = Object.keys(ours), theirs = stats[i];
      const form = JSON.stringify(flags) !== JSON.stringify(theirs.flags) || names.some((name) => (ours[name] === null) !== (theirs[name] === null));
      tallies.stats.add(form ? Infinity : Math.max(...names.map((name) => Math.abs(ours[name] - theirs[name]) / Math.max(1, Math.abs(ours[name])))));
    });
    run("colorsnap", ["--quiet", "--library", at("library.xml"), "--report", at("near.json"), "-o", "/dev/null", at("edited.xml")]);
    const queries = JSON.parse(fs.readFileSync(at("near.json"), "utf8")).results.queries;
    edited.forEach((paint, i) => {
      const ours = engine.ask({ do: "nearest", paint, metric: "de76", count: 5 }).list, theirs = queries[i].matches;
      const same = ours.map((match) => match.name).join() === theirs.map((match) => match.name).join();
      tallies.near.add(!same ? Infinity : Math.max(...ours.map((match, k) => Math.abs(match.distance - theirs[k].distance))));
    });
  } finally {
    fs.rmSync(folder, { recursive: true });
  }
  for (const tally of Object.values(tallies)) tally.print();
}

main().catch((error) => {
  console.error(error.stack);
  process.exit(1);
});
