// Bundles src/ and three.js into one script: node build.mjs [OUT.js]
import { copyFile } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2] ?? join(here, '../crates/page/viewer/viewer.js');
await build({
  absWorkingDir: here,
  entryPoints: ['src/main.js'],
  outfile: out,
  bundle: true,
  minify: true,
  format: 'iife',
  target: 'es2020',
  charset: 'ascii',
  legalComments: 'eof',
});
await copyFile(join(here, 'node_modules/three/LICENSE'), join(dirname(out), 'LICENSE-three.txt'));
