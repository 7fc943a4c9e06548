// Prints what the KTX2 loader of three.js makes of a file: its levels as the bits of half floats.
import { readFileSync } from "fs";
import { HalfFloatType, LinearSRGBColorSpace } from "three";
import { KTX2Loader } from "three/examples/jsm/loaders/KTX2Loader.js";
import { read } from "three/examples/jsm/libs/ktx-parse.module.js";

const file = readFileSync(process.argv[2]);
const bytes = file.buffer.slice(file.byteOffset, file.byteOffset + file.length);
const loader = new KTX2Loader();
loader.workerConfig = {}; // What the graphics card can do concerns compressed textures alone.
const exponents = read(new Uint8Array(bytes.slice())).keyValue["goniochrome:exponents"];
loader.parse(
  bytes,
  (texture) =>
    console.log(
      JSON.stringify({
        halves: texture.type === HalfFloatType,
        linear: texture.colorSpace === LinearSRGBColorSpace,
        exponents: new TextDecoder().decode(exponents).replace("\0", ""),
        levels: texture.mipmaps.map(({ width, height, data }) => ({ width, height, bits: Array.from(data) })),
      }),
    ),
  (fault) => {
    console.error(String(fault));
    process.exit(1);
  },
);
