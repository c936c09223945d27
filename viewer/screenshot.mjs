// A picture of a report page, by a headless Chromium: node screenshot.mjs PAGE.html[#POSE] OUT.png [WIDTH,HEIGHT [SCALE]]
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { PNG } from 'pngjs';

// Colours are kept to so many steps of each channel: points with smooth rims make large files otherwise.
const STEP = 8;

const [page, out, size = '1280,800', scale = '1'] = process.argv.slice(2);
if (!out) {
  console.error('usage: node screenshot.mjs PAGE.html[#POSE] OUT.png [WIDTH,HEIGHT [SCALE]]');
  process.exit(2);
}
const [file, pose] = page.split('#');
const address = pathToFileURL(resolve(file));
address.hash = pose ?? '';
const profile = mkdtempSync(join(tmpdir(), 'cloudtouch-'));
const { error, status, stderr } = spawnSync(process.env.CHROMIUM ?? 'chromium', [
  '--headless', '--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--hide-scrollbars',
  `--window-size=${size}`, `--force-device-scale-factor=${scale}`, '--virtual-time-budget=5000',
  `--user-data-dir=${profile}`, `--screenshot=${resolve(out)}`, address.href,
], { encoding: 'utf8', timeout: 120000 });
rmSync(profile, { recursive: true, force: true });
if (error || status !== 0) {
  console.error(error?.message ?? stderr);
  process.exit(1);
}
const picture = PNG.sync.read(readFileSync(out));
picture.data.forEach((value, i) => {
  picture.data[i] = Math.min(Math.round(value / STEP) * STEP, 255);
});
writeFileSync(out, PNG.sync.write(picture, { colorType: 2, filterType: 0, deflateLevel: 9, deflateStrategy: 0 }));
