// One script for the report, which has no server to fetch modules from: the page's modules and three.js together.
import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import { build } from "esbuild";

const names = ["colours", "curves", "fleet", "frames", "ground", "names", "paint", "playback", "scene", "timeline", "trails", "three"];
const path = (name) => `../static/${name}.js`;
const hash = createHash("sha256");
for (const name of names) hash.update(readFileSync(path(name)));

await build({
  entryPoints: [path("playback")],
  bundle: true,
  minify: true,
  format: "iife",
  outfile: "../static/report.js",
  legalComments: "inline",
  banner: { js: `/* made by make three from sources ${hash.digest("hex")} */` },
  alias: Object.fromEntries(names.map((name) => [name, new URL(path(name), import.meta.url).pathname])),
});
