// The data of the page: base64 to numbers, and the mesh as WebGL takes it.

function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

const numbersOf = (base64, Kind) => new Kind(bytesOf(base64).buffer);

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
