// How a design leaves the page: as the command line that makes the same paint, as files, and as a session.

// A word as a shell takes it.
function quoted(word) {
  return /^[A-Za-z0-9_.,:=/@%+-]+$/.test(word) ? word : "'" + word.replaceAll("'", "'\\''") + "'";
}

// The options of paint-edit for an edit.
function optionsOf(edit) {
  return Object.entries(edit).flatMap(([name, value]) => {
    if (name === "set") return value.map((reading) => quoted(`--set=${reading.geometry}=${reading.lab.join(",")}`));
    if (value === true) return [`--${name}`];
    return [quoted(`--${name}=${Array.isArray(value) ? value.join(",") : value}`)];
  });
}

// The commands that make the paint of a state, without the fit. A paint of a gradient needs a line before it, which writes
// the gradient; `lines` gets it.
function editsOf(library, state, lines) {
  const { file, paint, gradient, board } = state.own ?? library.at(state.start), source = quoted(`${file}#${paint.name}`);
  if (file === "") {
    // A paint of the page itself is in no file but in the one that the page saves, with its edits.
    const name = state.name ?? paint.name, saved = `${fileName(name)}.paints.xml`;
    lines.push(`# Here "Save paint XML" has saved ${saved}.`);
    return [quoted(`${saved}#${name}`)];
  }
  if (board) lines.push(`paint-pick --board ${quoted(board)} -o ${quoted(file)}`);
  if (gradient) {
    // An end that was edited is written first, as a file of its own.
    const [from, to] = gradient.ends.map((end, i) => {
      const edits = editsOf(library, end, lines);
      if (edits.length === 1 && !edits[0].startsWith("paint-edit")) return edits[0];
      const ending = quoted(file.replace(/\.paints\.xml$/, "") + `.${["from", "to"][i]}.paints.xml`);
      lines.push(`${edits.join(" | ")} -o ${ending}`);
      return ending;
    });
    lines.push(`paint-edit ${from} ${to} --gradient ${gradient.count} -o ${quoted(file)}`);
  }
  const label = [...(state.name !== undefined && state.name !== paint.name ? [quoted(`--rename=${state.name}`)] : []), ...(state.code ? [quoted(`--code=${state.code}`)] : state.code === "" && paint.code ? ["--no-code"] : [])];
  const edits = state.steps.map(optionsOf);
  if (label.length > 0) edits.push([...(edits.pop() ?? []), ...label]);
  if (edits.length === 0) return [source];
  return edits.map((options, i) => `paint-edit ${i === 0 ? source + " " : ""}${options.join(" ")}`);
}

// The commands that make the paint of a state from its library, and fit it to the basis of the page.
function commandOf(data, library, state, output = "design.paints.xml") {
  const lines = [], edits = editsOf(library, state, lines);
  const fit = data.basis_file ? `fit-paint --basis ${quoted(data.basis_file)}` : "fit-paint";
  if (!edits[0].startsWith("paint-edit")) lines.push(`${fit} ${edits[0]} -o ${quoted(output)}`);
  else lines.push([...edits, `${fit} -o ${quoted(output)}`].join(" |\n  "));
  return lines.join("\n");
}

function save(name, content, type) {
  const link = made("a", { download: name, href: URL.createObjectURL(new Blob([content], { type })) });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// A text as an address holds it, compressed, and back.
async function piped(bytes, through) { return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(through)).arrayBuffer()); }
async function packedText(text) {
  const bytes = await piped(new TextEncoder().encode(text), new CompressionStream("deflate-raw"));
  return btoa(String.fromCharCode(...bytes)).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}
async function unpackedText(packed) {
  return new TextDecoder().decode(await piped(bytesOf(packed.replaceAll("-", "+").replaceAll("_", "/")), new DecompressionStream("deflate-raw")));
}

// A name that every file system takes.
const fileName = (name) => name.replace(/[^A-Za-z0-9_.-]+/g, "_") || "paint";

// Paint XML with notes, as a comment before the first paint, in which two hyphens may not meet; and the notes of such a text.
const withNotes = (xml, notes) => (notes ? xml.replace(/^ *<paint /m, (start) => `  <!-- Notes: ${notes.replace(/[\0-\x08\v\f\x0e-\x1f]/g, " ").replaceAll("--", "&#45;&#45;")} -->\n${start}`) : xml);
const notesOf = (xml) => /<!-- Notes: ([^]*?) -->/.exec(xml)?.[1].replaceAll("&#45;", "-");

class Handoff {
  constructor(app) {
    this.app = app;
    const press = (id, action) => document.getElementById(id).addEventListener("click", () => app.attempt(action));
    press("save-xml", () => this.write("xml", false, ".paints.xml", "application/xml"));
    press("save-fitted", () => this.write("xml", true, ".fitted.paints.xml", "application/xml"));
    press("save-csv", () => this.write("csv", false, ".csv", "text/csv"));
    press("save-cxf", () => this.writeCxf());
    press("save-session", () => save(fileName(app.paint.name) + ".session.json", app.savedSession(), "application/json"));
    press("copy", () => this.copy(document.getElementById("command").textContent, words("The commands")));
    press("copy-link", () => packedText(app.linked()).then((text) => this.copy(`${location.href.split("#")[0]}#p=${text}`, words("The link"))));
  }

  // The design as CxF, under the code of the nearest paint of the library.
  writeCxf() {
    const { app } = this, paint = { ...app.paint }, metric = document.getElementById("metric").value;
    const nearest = app.attempt(() => app.engine.ask({ do: "nearest", paint, metric, count: 1 }).list[0]);
    if (nearest?.code) paint.code = nearest.code;
    this.write("cxf", false, ".cxf", "application/xml", paint, { created: new Date().toISOString().slice(0, 19) + "Z" });
    app.say(nearest?.code ? told`The file has the code ${nearest.code} of the nearest paint, ${nearest.name}.` : words("The nearest paint has no code, so that the file has none of it."));
  }

  write(as, lobes, ending, type, paint = this.app.paint, more = {}) {
    const { data, library, history } = this.app, isOwn = this.app.origin(history.now).file === "";
    const command = isOwn ? data.command : commandOf(data, library, history.now).replaceAll(/^#.*\n/gm, "").replaceAll(/ \|\n {2}/g, " | ").replaceAll("\n", "; ");
    const { text } = this.app.engine.ask({ do: "write", paint, as, lobes, command, ...more,
                                           version: this.app.data.version });
    save(fileName(this.app.paint.name) + ending, as === "xml" ? withNotes(text, this.app.card.notes.value) : text, type);
  }

  // `what` is copied: a plural or singular with its article.
  copy(text, what) {
    const fallback = () => {
      const field = made("textarea", { "aria-label": what });
      field.value = text;
      document.body.append(field);
      field.select();
      const copied = document.execCommand("copy");
      field.remove();
      this.app.say(copied ? told`${what}: copied.` : told`This browser refuses to copy. ${what}: ${text}`);
    };
    if (navigator.clipboard) navigator.clipboard.writeText(text).then(() => this.app.say(told`${what}: copied.`), fallback);
    else fallback();
  }

  show() { document.getElementById("command").textContent = commandOf(this.app.data, this.app.library, this.app.history.now); }
}

if (typeof module !== "undefined") module.exports = { commandOf, optionsOf };
