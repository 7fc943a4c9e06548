// The data of the page: what stands in it compressed, its numbers, and the mesh as WebGL takes it.

function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

// The contents of an element of the page, which is then no longer kept.
function taken(id) {
  const element = document.getElementById(id), text = element.textContent;
  element.remove();
  return text;
}

// The bytes that an element holds as base64 of a gzip member, whose last word is the size of what it holds. They are put
// where bytesFor(size) says.
async function inflated(id, bytesFor = (size) => new Uint8Array(size)) {
  const text = taken(id), pieces = [], piece = 1 << 20;
  for (let at = 0; at < text.length; at += piece) pieces.push(bytesOf(text.slice(at, at + piece)));
  const packed = new Blob(pieces), last = new DataView(await packed.slice(-4).arrayBuffer());
  return inflatedInto(bytesFor(last.getUint32(0, true)), packed, "gzip");
}

// Fills bytes with what is packed. Throws where that is too much or too little.
async function inflatedInto(target, packed, format) {
  const reader = packed.stream().pipeThrough(new DecompressionStream(format)).getReader();
  for (let at = 0;;) {
    const { done, value } = await reader.read();
    if (done && at < target.length) throw new RangeError("packed bytes are missing");
    if (done) return target;
    target.set(value, at);
    at += value.length;
  }
}

let pageNumbers = null;  // the bytes of all of them

// Numbers at a place, [first byte, count], of the page or, as the third of the place, of what was opened.
const numbersOf = ([at, count, bytes = pageNumbers], Kind) => new Kind(bytes.buffer, at, count);

// The texels of a smooth map of 16 bits and so many channels: each number is told by its difference from that of the texel before,
// and the low bytes of all stand before the high bytes.
function smoothNumbersOf([at, count, of], channels = 3) {
  const bytes = numbersOf([at, 2 * count, of], Uint8Array), values = new Uint16Array(count);
  for (let i = 0; i < count; ++i) values[i] = (i >= channels ? values[i - channels] : 0) + bytes[i] + (bytes[count + i] << 8);
  return values;
}

// A half float as a number.
function numberOfHalf(half) {
  const sign = half & 0x8000 ? -1 : 1, exponent = (half >> 10) & 31, fraction = half & 1023;
  if (exponent === 0) return sign * fraction * 2 ** -24;
  return sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
}

// Positions and normals as floats, from 16 bits an axis.
function unpackedMesh(packed) {
  const quantized = numbersOf(packed.positions, Uint16Array), positions = new Float32Array(quantized.length);
  for (let i = 0; i < quantized.length; ++i) {
    const axis = i % 3;
    positions[i] = packed.low[axis] + (quantized[i] / 65535) * (packed.high[axis] - packed.low[axis]);
  }
  const normals = Float32Array.from(numbersOf(packed.normals, Int16Array), (value) => value / 32767);
  return { positions, normals, corners: numbersOf(packed.corners, Uint32Array), parts: packed.parts,
           low: packed.low, high: packed.high };
}
