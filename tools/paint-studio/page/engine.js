// The project's own C++, compiled to WebAssembly: every color and every number of this page comes from there.
"use strict";

// The functions that the compiled library imports of WASI. It reads the clock for the time of a fit; there are no files.
function wasiImports(memoryOf) {
  const view = () => new DataView(memoryOf().buffer);
  return {
    environ_get: () => 0,
    environ_sizes_get: (count, bytes) => {
      view().setUint32(count, 0, true);
      view().setUint32(bytes, 0, true);
      return 0;
    },
    clock_time_get: (_id, _precision, at) => {
      view().setBigUint64(at, BigInt(Math.round(performance.now() * 1e6)), true);
      return 0;
    },
    fd_close: () => 0,
    fd_seek: () => 8,   // EBADF
    fd_write: () => 8,
    proc_exit: (status) => {
      throw new Error("the compiled library stopped with status " + status);
    },
  };
}

const lists = ["weights", "filtered", "cloud", "cloudColors", "cloudPaints", "tilts", "picture"];
const ofFloats = ["weights", "cloud", "tilts", "picture"];

// The engine of a compiled module. ask() sends a request and returns the answer; it throws what the answer calls an
// error.
async function makeEngine(bytes) {
  let memory = null;
  const { instance } = await WebAssembly.instantiate(bytes, {
    wasi_snapshot_preview1: wasiImports(() => memory),
  });
  const library = instance.exports;
  memory = library.memory;
  library._initialize();
  const encoder = new TextEncoder(), decoder = new TextDecoder();
  return {
    ask(request) {
      const text = encoder.encode(JSON.stringify(request));
      const at = library.studio_request(text.length);
      new Uint8Array(memory.buffer, at, text.length).set(text);
      const length = library.studio_call();
      const answer = JSON.parse(decoder.decode(new Uint8Array(memory.buffer, library.studio_answer(), length)));
      if (answer.error !== undefined) throw new Error(answer.error);
      return answer;
    },
    // Memory of the library for bytes that the next request "load" or "view" takes.
    attach(length) {
      const at = library.studio_attach(length);  // before its memory is looked at, which may move
      return new Uint8Array(memory.buffer, at, length);
    },
    // A list that an answer filled, copied: weights or tilts of the paint that was fitted last, filtered, cloud,
    // cloudColors, cloudPaints, or the picture of a view.
    list(name) {
      const number = lists.indexOf(name), Kind = ofFloats.includes(name) ? Float32Array : Uint32Array;
      return new Kind(memory.buffer, library.studio_list(number), library.studio_list_bytes(number) / 4).slice();
    },
    bytes: () => memory.buffer.byteLength,
  };
}

if (typeof module !== "undefined") module.exports = { makeEngine };
