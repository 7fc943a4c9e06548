// The history of the designer's edits. A state holds the paint that it began with, the edits since then, and the paint that they made. The
// first is the number `start` of a paint of the library, whose name is `of`, or `own`, {file, paint}, of a file that was opened. Undo and
// redo go from state to state, without limit.

const saidState = ({ start, of, own, steps, name, code }) => ({ ...(own ? { own } : { start, of }), steps, ...(name !== undefined && { name }), ...(code !== undefined && { code }) });

// The members of a state whose paint has a name of its own, and a code where one is given, which is "" for none.
function labeled({ code: known, ...paint }, name, code) {
  if (typeof name !== "string" || !["string", "undefined"].includes(typeof code)) throw new Error(words("This file is no session of a page with this library."));
  const own = code ?? known;
  return { name, ...(code !== undefined && { code }), paint: { ...paint, name, ...(own && { code: own }) } };
}

class EditHistory {
  constructor(states = [], at = states.length - 1) {
    this.states = states;
    this.at = at;
  }
  get now() { return this.states[this.at]; }
  get canUndo() { return this.at > 0; }
  get canRedo() { return this.at < this.states.length - 1; }
  // Goes on from here: what was undone before is forgotten.
  push(state) {
    this.states.length = this.at + 1;
    this.states.push(state);
    this.at = this.states.length - 1;
  }
  undo() { if (this.canUndo) --this.at; }
  redo() { if (this.canRedo) ++this.at; }
  // The history as it is saved: a state that goes on from the one before it is its last edit alone.
  saved() {
    return { at: this.at, states: this.states.map((state) => (state.goesOn ? { edit: state.steps.at(-1), name: state.name, code: state.code } : saidState(state))) };
  }
}
