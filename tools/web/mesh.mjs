// node mesh.mjs MODULE.wasm DRAWING FORMAT: writes the mesh that the WebAssembly module makes to standard output.
import { readFileSync } from "node:fs";

const [module, drawing, format] = process.argv.slice(2);
const { instance } = await WebAssembly.instantiate(readFileSync(module), {});
const { memory, input, mesh, output } = instance.exports;
const parts = [Buffer.from(drawing), Buffer.from(format), readFileSync(drawing)];
const bytes = Buffer.concat(parts);
const at = input(bytes.length);
new Uint8Array(memory.buffer, at, bytes.length).set(bytes);
const length = mesh(parts[0].length, parts[1].length);
const out = Buffer.from(new Uint8Array(memory.buffer, output(), Math.abs(length)));
if (length < 0) {
  console.error(out.toString());
  process.exit(1);
}
process.stdout.write(out);
