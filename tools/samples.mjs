#!/usr/bin/env node
/**
 * A table of scenes that somebody has downloaded: for each .glb and .gltf below a folder how long an atlas and its light
 * take, and how far off that is. A file without light gets a sky. Light maps as players see them go to build/samples.
 *
 *   node tools/samples.mjs FOLDER [TABLE.md]      without a table's name it is printed
 *
 * The error is that of `--method reference`'s with its noise taken off: of two references A and B that know nothing of each
 * other, (E - A)(E - B) has the mean of the squared error alone. LICHTVELD names another executable than
 * build/release/lichtveld.
 */
import { spawnSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, extname, join, relative, resolve } from 'node:path';
import { executable, root } from '../tests/e2e/programs.js';
import { readExr } from './exr.mjs';

/** Texels a side; twice as many where an atlas needs that. */
const size = 128;
const sky = ['--sky', '1,1,1'];
const spp = 256;
/** Milliseconds after which a command is given up. */
const patience = 600_000;

/** Runs a command of lichtveld's; what it said, and how long it took [s]. Throws its error's line. */
function lichtveld(...args) {
  const start = performance.now();
  const ran = spawnSync(executable, args.map(String), { encoding: 'utf8', timeout: patience });
  const seconds = (performance.now() - start) / 1000;
  if (ran.error?.code === 'ETIMEDOUT')
    throw new Error(`${args[0]} takes more than ${patience / 60_000} minutes`);
  if (ran.error) throw ran.error;
  if (ran.status !== 0)
    throw new Error(ran.stderr.match(/^error: (.*)$/m)?.[1] ?? `${args[0]} ends with status ${ran.status}`);
  return { said: ran.stderr + ran.stdout, seconds };
}

/** How far E is from the truth, as shares of its mean: root mean square and bias. */
function compare(e, a, b) {
  let [count, square, off, mean] = [0, 0, 0, 0];
  for (let i = 0; i < e.data.length; ++i) {
    if (e.data[i | 3] !== 1 || (i & 3) === 3) continue;
    ++count;
    square += (e.data[i] - a.data[i]) * (e.data[i] - b.data[i]);
    off += e.data[i] - (a.data[i] + b.data[i]) / 2;
    mean += (a.data[i] + b.data[i]) / 2;
  }
  return { rms: Math.sqrt(Math.max(square * count, 0)) / mean, bias: off / mean };
}

function measure(file, picture, work) {
  const [plain, report] = [join(work, 'plain.glb'), join(work, 'r.json')];
  const exr = (name) => join(work, `${name}.exr`);
  const unwrapped = lichtveld('unwrap', file, '--out', plain, '--size', size);
  const [, side = size] = unwrapped.said.match(/% of (\d+) x/) ?? [];
  const bake = (...options) => lichtveld('bake', file, '--size', side, ...options);
  const usual = ['--out', exr('E'), '--report', report, '--png', picture];
  let baked = bake(...usual);
  const light = baked.said.includes('nothing emits light') ? sky : [];
  if (light.length > 0) baked = bake(...usual, ...light);
  const { bounces_used: bounces, method, time_ms } = JSON.parse(readFileSync(report, 'utf8'));
  for (const [seed, name] of ['A', 'B'].entries()) {
    const paths = ['--method', 'reference', '--spp', spp, '--seed', seed + 1, '--bounces', bounces];
    bake('--out', exr(name), ...paths, ...light);
  }
  const { rms, bias } = compare(readExr(exr('E')), readExr(exr('A')), readExr(exr('B')));
  const [, triangles] = lichtveld('info', plain).said.match(/triangles\s+(\d+)/) ?? [];
  return {
    triangles,
    side,
    unwrap: unwrapped.seconds,
    bake: time_ms.total / 1000,
    method,
    light: light.length > 0 ? 'sky' : 'its own',
    rms,
    bias,
  };
}

function rowOf(name, measured) {
  const share = (x) => `${(100 * x).toFixed(1)} %`;
  const { triangles, side, unwrap, bake, light, rms, bias } = measured;
  const cells = [name, triangles, side, light, unwrap.toFixed(1), bake.toFixed(1), share(rms), share(bias)];
  return `| ${cells.join(' | ')} |`;
}

const [folder, table] = process.argv.slice(2);
if (!folder) throw new Error('usage: node tools/samples.mjs FOLDER [TABLE.md]');
const pictures = join(root, 'build/samples');
mkdirSync(pictures, { recursive: true });
const files = readdirSync(folder, { recursive: true })
  .map((file) => join(folder, String(file)))
  .filter((file) => ['.glb', '.gltf'].includes(extname(file)))
  .sort();
if (files.length === 0) throw new Error(`there is no .glb and no .gltf below ${resolve(folder)}`);
const rows = [
  '| file | triangles | texels a side | light | unwrap s | bake s | rel_rmse | bias |',
  '|---|---|---|---|---|---|---|---|',
];
const work = mkdtempSync(join(tmpdir(), 'lichtveld-samples-'));
try {
  for (const file of files) {
    const name = relative(folder, file);
    const picture = join(pictures, `${basename(file, extname(file))}.png`);
    let row;
    try {
      row = rowOf(name, measure(file, picture, work));
    } catch (error) {
      row = `| ${name} | ${error.message.replaceAll('|', '/')} | | | | | | |`;
    }
    rows.push(row);
    console.error(row);
  }
} finally {
  rmSync(work, { recursive: true });
}
if (table) writeFileSync(table, `${rows.join('\n')}\n`);
else console.log(rows.join('\n'));
