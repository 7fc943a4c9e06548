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

const lists = ["weights", "filtered", "cloud", "cloudColors", "cloudPaints", "tilts", "picture", "numbers", "flakes"];
const kindOfList = { weights: Float32Array, cloud: Float32Array, tilts: Float32Array, picture: Float32Array, numbers: Uint8Array, flakes: Float32Array };  // others: Uint32Array

// The engine of a compiled module. ask() sends a request and returns the answer; it throws what the answer calls an
// error. Colors are those of its `screen`. `progress` hears the part of a long request that is done.
async function makeEngine(module, progress = () => {}) {
  let memory = null, library = null;
  const encoder = new TextEncoder(), decoder = new TextDecoder();
  // XML is parsed by the browser; a text that is no UTF-8 is told as an event.
  const xml_events = (at, length) => {
    let events;
    try {
      const bytes = new Uint8Array(memory.buffer, at, length), kind = bytes[0] === 0xff ? "utf-16le" : bytes[0] === 0xfe ? "utf-16be" : "utf-8";
      events = xmlEvents(new TextDecoder(kind, { fatal: true }).decode(bytes));
    } catch (error) {
      events = ["!", "1", error instanceof RangeError ? "elements are nested too deep: flatten them" : "a character is not valid UTF-8: save the file as UTF-8, without control characters"];
    }
    const text = encoder.encode(events.join("\0") + "\0"), place = library.studio_events(text.length);
    new Uint8Array(memory.buffer, place, text.length).set(text);
  };
  const instance = await WebAssembly.instantiate(module, { wasi_snapshot_preview1: wasiImports(() => memory), page: { xml_events, progress } });
  library = instance.exports;
  memory = library.memory;
  library._initialize();
  const request = (words) => {
    const text = encoder.encode(words), at = library.studio_request(text.length);
    new Uint8Array(memory.buffer, at, text.length).set(text);
  };
  return {
    screen: "srgb",
    ask(asked) {
      request(JSON.stringify({ screen: this.screen, ...asked }));
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
    // Makes bytes a file, which requests can read by its name; without a name all files go.
    give(name, bytes = new Uint8Array(0)) {
      this.attach(bytes.length).set(bytes);
      request(name);
      library.studio_give();
    },
    // A list that an answer filled, copied: weights or tilts of the paint that was fitted last, filtered, cloud,
    // cloudColors, cloudPaints, the picture of a view, or the bytes of numbers.
    list(name) {
      const number = lists.indexOf(name), Kind = kindOfList[name] ?? Uint32Array;
      return new Kind(memory.buffer, library.studio_list(number), library.studio_list_bytes(number) / Kind.BYTES_PER_ELEMENT).slice();
    },
    bytes: () => memory.buffer.byteLength,
  };
}

if (typeof module !== "undefined") module.exports = { makeEngine };
