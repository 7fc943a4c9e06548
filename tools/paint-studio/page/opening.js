// Files that are opened by the button, dropped or pasted anywhere. The project's own readers read them; the browser unpacks
// archives and parses XML for them.

const mostOpened = 100;  // paints of one file that the palette takes

// The events of an XML text, as platform_xml.cpp takes them. A line is that where a tag or a text ends.
function xmlEvents(text) {
  const root = new DOMParser().parseFromString(text, "application/xml"), problem = root.querySelector("parsererror")?.textContent;
  if (problem) return ["!", /line (?:number )?(\d+)/i.exec(problem)?.[1] ?? "1", `not well-formed XML (${problem.replace(/^.*?error[^:]*:/s, "").trim().split("\n")[0]})`];
  if (root.doctype) return ["!", "1", "<!DOCTYPE is not accepted, nor are the entities it declares: remove it"];
  const events = [], tags = text.matchAll(/<!--[^]*?-->|<!\[CDATA\[[^]*?\]\]>|<\?[^]*?\?>|<\/[^>]*>|<[^/!?](?:"[^"]*"|'[^']*'|[^"'>])*>/g);
  const linesIn = (part) => part.split("\n").length - 1;
  let line = 1, at = 0, ended = 1;  // where the last tag ended, and what was told last
  const nextTag = () => {
    for (;;) {
      const { value: [tag], value: { index } } = tags.next(), begin = line + linesIn(text.slice(at, index));
      line = begin + linesIn(tag);
      at = index + tag.length;
      if (!/^<[/!?]/.test(tag)) return { tag, begin };
    }
  };
  const add = (...fields) => events.push(...fields.map((field) => String(field ?? "")));
  const walk = (element) => {
    const { tag, begin } = nextTag(), all = [...element.attributes], isSpace = (one) => one.namespaceURI === "http://www.w3.org/2000/xmlns/";
    ended = line;
    const spaces = all.filter(isSpace), others = all.filter((one) => !isSpace(one));
    const lineOf = ({ name }) => begin + (begin === line ? 0 : linesIn(tag.slice(0, tag.search(new RegExp(`\\s${name}\\s*=`)) + 1)));
    add("<", line, element.localName, element.prefix, element.namespaceURI, spaces.length, ...spaces.flatMap((one) => [one.prefix ? one.localName : "", one.value]));
    add(others.length, ...others.flatMap((one) => [one.localName, one.prefix, one.namespaceURI, one.value, lineOf(one)]));
    for (const child of element.childNodes)
      if (child.nodeType === Node.ELEMENT_NODE) walk(child);
      else {
        ended += linesIn(child.data);
        if (child.nodeType === Node.TEXT_NODE || child.nodeType === Node.CDATA_SECTION_NODE) add("t", ended, child.data);
      }
    add("/", ended);
  };
  walk(root.documentElement);
  return events;
}

// The parts of a ZIP archive that are XML, unpacked: pairs of name and bytes. [APPNOTE 4.3.12, 4.3.16]
async function unzipped(bytes) {
  const view = new DataView(bytes.buffer), parts = [];
  let end = bytes.length - 22;
  while (end >= 0 && view.getUint32(end, true) !== 0x06054b50) --end;
  if (end < 0) return parts;
  for (let count = view.getUint16(end + 10, true), at = view.getUint32(end + 16, true); count > 0; --count) {
    const length = view.getUint16(at + 28, true), name = new TextDecoder().decode(bytes.subarray(at + 46, at + 46 + length));
    const begin = view.getUint32(at + 42, true), data = begin + 30 + view.getUint16(begin + 26, true) + view.getUint16(begin + 28, true);
    const packed = bytes.subarray(data, data + view.getUint32(at + 20, true));
    if (/\.(xml|rels)$/.test(name)) parts.push([name, view.getUint16(at + 10, true) === 8 ? await piped(packed, new DecompressionStream("deflate-raw")) : packed]);
    at += 46 + length + view.getUint16(at + 30, true) + view.getUint16(at + 32, true);
  }
  return parts;
}

// The scan lines of an OpenEXR file, one after the other and unpacked; null where they are damaged, or not such as
// platform_exr.cpp reads, which says why. "OpenEXR File Layout", openexr.com
async function scanLines(bytes) {
  const view = new DataView(bytes.buffer), places = {}, blockLines = [1, 1, 1, 16];
  let at = 8;
  const word = () => {
    const end = bytes.indexOf(0, at), text = String.fromCharCode(...bytes.subarray(at, end));
    at = end + 1;
    return text;
  };
  try {
    for (let name = word(); name !== ""; name = word()) {
      word();  // the type
      places[name] = at + 4;
      at += 4 + view.getUint32(at, true);
    }
    const [left, top, right, bottom] = [0, 4, 8, 12].map((i) => view.getInt32(places.dataWindow + i, true)), height = bottom - top + 1, table = at;
    const packing = bytes[places.compression], lines = blockLines[packing], all = [];
    let lineBytes = 0;
    for (at = places.channels; word() !== ""; at += 16) lineBytes += (right - left + 1) * (view.getInt32(at, true) === 1 ? 2 : 4);
    for (let line = 0; line < height; line += lines) {
      const place = Number(view.getBigUint64(table + (8 * line) / lines, true)), room = new Uint8Array(lineBytes * Math.min(lines, height - line));
      const packed = bytes.subarray(place + 8, place + 8 + view.getUint32(place + 4, true));
      if (view.getInt32(place, true) !== top + line) return null;
      all.push(room);
      // A block that packing does not make smaller is stored as it is. Else its bytes at even places come before the others, each as what
      // it adds to the one before, and 128.
      if (packed.length === room.length) room.set(packed);
      else {
        const steps = new Uint8Array(room.length), odd = (room.length + 1) >> 1;
        if (packing === 1) unpackRuns(packed, steps);
        else await inflatedInto(steps, new Blob([packed]), "deflate");
        for (let i = 1; i < steps.length; ++i) steps[i] += steps[i - 1] - 128;
        for (let i = 0; i < steps.length; ++i) room[i] = steps[(i & 1 ? odd : 0) + (i >> 1)];
      }
    }
    return new Uint8Array(await new Blob(all).arrayBuffer());
  } catch {
    return null;
  }
}
// A count n below 0 comes before -n bytes, and another before one byte that stands n + 1 times.
function unpackRuns(packed, target) {
  let to = 0;
  for (let at = 0; at < packed.length;) {
    const count = (packed[at++] << 24) >> 24;
    if (count < 0) target.set(packed.subarray(at, at - count), to);
    else target.fill(packed[at], to, to + count + 1);
    at += count < 0 ? -count : 1;
    to += count < 0 ? -count : count + 1;
  }
  if (to !== target.length) throw new RangeError("packed bytes are missing");
}

class Opening {
  constructor(app, module, code) {
    Object.assign(this, { app, module, code, opened: Promise.resolve() });
    const input = document.getElementById("open-files");
    input.addEventListener("change", () => {
      this.open([...input.files]);
      input.value = "";
    });
    document.addEventListener("dragover", (event) => {
      if (![...event.dataTransfer.types].includes("Files")) return;
      event.preventDefault();
      document.body.classList.add("dropping");
    });
    for (const kind of ["dragleave", "drop"]) document.addEventListener(kind, () => document.body.classList.remove("dropping"));
    document.addEventListener("drop", (event) => {
      const files = [...event.dataTransfer.files];
      if (files.length === 0) return;
      event.preventDefault();
      this.open(files);
    });
    document.addEventListener("paste", (event) => this.open([...event.clipboardData.files]));
  }

  // Opens files after those before.
  open(files) {
    if (files.length === 0) return this.opened;
    return (this.opened = this.opened.then(() => this.openTogether(files)).catch((error) => this.app.say(error.message)));
  }
  // Some files name others of them.
  async openTogether(files) {
    const { app } = this, pictures = files.filter(({ name, type }) => type.startsWith("image/") && !/\.(hdr|exr|pic)$/i.test(name));
    if (pictures.length > 0) await app.pictures.add(pictures);
    const others = [], said = [];
    for (const file of files.filter((one) => !pictures.includes(one)))
      try {
        others.push([file.name, new Uint8Array(await file.arrayBuffer())]);
      } catch {
        said.push(told`${file.name} cannot be read: it is a folder, or too large.`);
      }
    try {
      for (const [name, bytes] of others) {
        app.engine.give(name, bytes);
        if (bytes[0] === 0x50 && bytes[1] === 0x4b) for (const [part, content] of await unzipped(bytes).catch(() => [])) app.engine.give(`${name}/${part}`, content);
      }
      for (const [name, bytes] of others.filter(([one]) => others.length === 1 || !/\.(bin|mtl)$/i.test(one)))
        try {
          said.push(await this.take(name, bytes));
        } catch (error) {
          said.push(error.message);
        }
    } catch (error) {
      said.push(error.message);
    } finally {
      app.engine.give("");
    }
    if (said.length > 0) app.say(said.join(" "));
  }

  // Opens one file, and returns what is to be said of it.
  async take(name, bytes) {
    const { app } = this;
    if (/^\s*\{[^]{0,99}"paint-studio session"/.test(new TextDecoder().decode(bytes.subarray(0, 200)))) {
      app.openSession(new TextDecoder().decode(bytes));
      return told`${name}: the session is open.`;
    }
    app.say(told`${name} is being read ...`);
    const answer = app.engine.ask({ do: "open", name }), remarks = (answer.remarks ?? []).map((one) => ` ${one}.`).join("");
    if (answer.kind === "paints") {
      app.card.notes.value = notesOf(new TextDecoder().decode(bytes)) ?? app.card.notes.value;
      return this.takePaints(name, answer) + remarks;
    }
    if (answer.kind === "mesh") {
      app.stageView.takeMesh(answer.mesh, app.engine.list("numbers"));
      return told`${name}: ${answer.triangles} triangles.` + ` ${app.parts.summary}${remarks}`;
    }
    if (answer.kind === "basis") return this.sayBasis(name, answer.basis);
    const { environment, remarks: ofLight, numbers, seconds } = await this.filtered(name, bytes);
    app.stageView.takeLight(environment, numbers);
    return told`${name}: the light was filtered in ${seconds.toFixed(1)} s.` + ofLight.map((one) => ` ${one}.`).join("");
  }
  takePaints(name, { list, format }) {
    const { app } = this;
    app.openPaints(name, list.slice(0, mostOpened));
    const { de00_mean, de00_max } = app.fit, count = Math.min(list.length, mostOpened), shown = (value) => value?.toFixed(2) ?? "-";
    const more = list.length > 1 ? " " + told`${count} of its ${list.length} paints are in the palette.` : "";
    return told`${name} is opened as ${format}.` + more + " " + told`The lobes miss the readings of ${app.paint.name} by ${shown(de00_mean)} on average, ${shown(de00_max)} at most (CIEDE2000).`;
  }
  sayBasis(name, { exponents, mirror }) {
    const own = this.app.data.basis, same = JSON.stringify([exponents, mirror]) === JSON.stringify([own.exponents, own.mirror]);
    return same ? told`${name} is the basis of this page.` : told`${name}: the lights of this page are filtered for the lobes of the basis ${own.name}. Make a page of the other one by paint-studio --basis.`;
  }

  // The light of a picture, filtered in a worker, so that the page goes on.
  filtered(name, bytes) {
    const { app } = this, address = URL.createObjectURL(new Blob([this.code], { type: "text/javascript" })), worker = new Worker(address), begin = performance.now();
    return new Promise((resolve, reject) => {
      worker.onmessage = ({ data: { part, error, ...made } }) => {
        if (part !== undefined) return app.say(told`${name} is being filtered: ${Math.round(100 * part)} %`);
        return error === undefined ? resolve({ ...made, seconds: (performance.now() - begin) / 1000 }) : reject(new Error(error));
      };
      worker.onerror = (event) => reject(new Error(told`${name}: the filter stopped: ${event.message}`));
      worker.postMessage({ module: this.module, basis: app.data.basis, name, bytes });
    }).finally(() => {
      worker.terminate();
      URL.revokeObjectURL(address);
    });
  }
}

// The worker's side of filtered().
function serveLight() {
  self.onmessage = async ({ data: { module, basis, name, bytes } }) => {
    try {
      const engine = await makeEngine(module, (part) => self.postMessage({ part }));
      engine.give(name, bytes);
      const lines = bytes[0] === 0x76 ? await scanLines(bytes) : null;
      if (lines) engine.give(`${name}/lines`, lines);
      const answer = engine.ask({ do: "light", name, basis }), numbers = engine.list("numbers");
      self.postMessage({ ...answer, numbers }, [numbers.buffer]);
    } catch (error) {
      self.postMessage({ error: error.message });
    }
  };
}
