import { readFileSync } from "node:fs";

import { fromBinary, toBinary } from "@bufbuild/protobuf";
import { base64Decode, base64Encode } from "@bufbuild/protobuf/wire";
import { FileDescriptorProtoSchema, type DescriptorProto } from "@bufbuild/protobuf/wkt";
import { defineConfig } from "vitest/config";

import { programVersion } from "./scripts/program_version.mjs";

const server = "http://127.0.0.1:8080";

/** As TypeScript writes an enum. */
const kEnum = /^export var (\w+);\n\(function \(\1\) \{(.*?)^\}\)\(\1 \|\| \(\1 = \{\}\)\);$/gms;

/** Around these no language of shaders needs space. Two signs in a row, as in `a - -b`, do. */
const kSpaceAround = /[ \t]*([=*/,;(){}<>?:|&])[ \t]*|(?<=[\w)\]]) ([+-]) (?=[\w(.])/g;

/** A line break between two lines that are not of the preprocessor. */
const kNeedlessBreak = /(?<=^[^#].*[;{},(]|^[{}])\n(?=[^#\n])/gm;

/** As in 0.5. */
const kLeadingZero = /(?<!\w)0(?=\.\d)/g;

/** Returns the descriptor of a file without the options of its fields, in base64. */
function withoutFieldOptions(descriptor: string): string {
  const file = fromBinary(FileDescriptorProtoSchema, base64Decode(descriptor));
  const strip = ({ field, nestedType }: DescriptorProto): void => {
    for (const each of field) each.options = undefined;
    nestedType.forEach(strip);
  };
  file.messageType.forEach(strip);
  return base64Encode(toBinary(FileDescriptorProtoSchema, file));
}

/** Leaves out text that no browser needs: comments, indentation and space of the page's shaders, the shaders of three's own materials, which
 *  the page does not use (a tenth of the page), labels and bounds in the descriptors of messages, which the page reads from gen/ranges.ts and
 *  the greeting, and enums of Protobuf's descriptors, which bundlers keep unless they are called pure. */
function withoutUnusedText() {
  return {
    name: "without-unused-text",
    apply: "build" as const,
    enforce: "pre" as const,
    transform(code: string, id: string) {
      if (/\.(frag|vert|glsl)\?raw$/.test(id)) {
        const source = readFileSync(id.replace(/\?raw$/, ""), "utf8").replace(/\/\/.*$/gm, "").replace(/^\s+/gm, "");
        const packed = source.replace(/^[^#].*$/gm, (line) => line.replace(kSpaceAround, "$1$2").replace(kLeadingZero, ""));
        return `export default ${JSON.stringify(packed.replace(kNeedlessBreak, ""))};`;
      }
      if (/\/gen\/spindrift\/v1\/\w+_pb\.ts$/.test(id)) return code.replace(/(?<=fileDesc\(")[^"]+/, withoutFieldOptions);
      if (id.endsWith("/wkt/gen/google/protobuf/descriptor_pb.js")) return code.replace(kEnum, "export var $1 = /* @__PURE__ */ (function ($1) {$2return $1;\n})({});");
      if (!id.endsWith("three.module.js")) return undefined;
      const chunks = /^(?:var|const) ([\w$]+) = "(?:[^"\\\n]|\\.)*";$/gm;
      const count = code.match(chunks)?.length ?? 0;
      if (count < 100) throw new Error(`${id}: expected over 100 shader chunks of three's own materials, found ${count}; look at withoutUnusedText()`);
      return code.replace(chunks, 'var $1 = "";');
    },
  };
}

export default defineConfig({
  plugins: [withoutUnusedText()],
  define: { __PROGRAM_VERSION__: JSON.stringify(programVersion()) },
  // Behind a proxy the page may be at any path.
  base: "./",
  // The server's Content-Security-Policy allows only files of its own: nothing is inlined as data or script.
  build: { target: "es2022", assetsInlineLimit: 0, modulePreload: { polyfill: false }, chunkSizeWarningLimit: 900 },
  worker: { format: "es", plugins: () => [withoutUnusedText()] },
  server: {
    host: "127.0.0.1",
    proxy: { "/ws": { target: server, ws: true }, "/api": server },
  },
  // A limit for tests that hang, not a measure of a busy machine.
  test: { include: ["test/**/*.test.ts"], environment: "node", testTimeout: 120_000 },
});
