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

// The commands that make the paint of a state from its library, and fit it to the basis of the page.
function commandOf(data, state, output = "design.paints.xml") {
  const { file, paint } = data.paints[state.start];
  const source = quoted(`${file}#${paint.name}`);
  const fit = `fit-paint --basis ${quoted(data.basis_file)}`;
  if (state.steps.length === 0) return `${fit} ${source} -o ${quoted(output)}`;
  const edits = state.steps.map((edit, i) => `paint-edit ${i === 0 ? source + " " : ""}${optionsOf(edit).join(" ")}`);
  return [...edits, `${fit} -o ${quoted(output)}`].join(" |\n  ");
}

function save(name, text, type) {
  const link = made("a", { download: name, href: URL.createObjectURL(new Blob([text], { type })) });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// A name that every file system takes.
const fileName = (name) => name.replace(/[^A-Za-z0-9_.-]+/g, "_") || "paint";

class Handoff {
  constructor(app) {
    this.app = app;
    const press = (id, action) => document.getElementById(id).addEventListener("click", () => app.attempt(action));
    press("save-xml", () => this.write("xml", false, ".paints.xml", "application/xml"));
    press("save-fitted", () => this.write("xml", true, ".fitted.paints.xml", "application/xml"));
    press("save-csv", () => this.write("csv", false, ".csv", "text/csv"));
    press("save-session", () => save(fileName(app.paint.name) + ".session.json", app.savedSession(), "application/json"));
    press("copy", () => this.copy());
    const open = document.getElementById("open-session");
    open.addEventListener("change", () => {
      const file = open.files[0];
      open.value = "";
      if (file) file.text().then((text) => app.attempt(() => app.openSession(text)));
    });
  }

  write(as, lobes, ending, type) {
    const command = commandOf(this.app.data, this.app.history.now).replaceAll(/ \|\n {2}/g, " | ");
    const { text } = this.app.engine.ask({ do: "write", paint: this.app.paint, as, lobes, command,
                                           version: this.app.data.version });
    save(fileName(this.app.paint.name) + ending, text, type);
  }

  copy() {
    const text = document.getElementById("command").textContent;
    const fallback = () => {
      const range = document.createRange();
      range.selectNodeContents(document.getElementById("command"));
      getSelection().removeAllRanges();
      getSelection().addRange(range);
      this.app.say(document.execCommand("copy") ? "The commands are copied." : "The commands are selected: copy them by Ctrl+C.");
    };
    if (navigator.clipboard)
      navigator.clipboard.writeText(text).then(() => this.app.say("The commands are copied."), fallback);
    else fallback();
  }

  show() { document.getElementById("command").textContent = commandOf(this.app.data, this.app.history.now); }
}

if (typeof module !== "undefined") module.exports = { commandOf, optionsOf };
