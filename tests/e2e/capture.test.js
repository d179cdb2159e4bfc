import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readdirSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { launch } from './browser.js';
import { root, signaling } from './programs.js';

const python = (...args) => spawnSync('/usr/bin/python3', args, { encoding: 'utf8' });

test('the render server captures its second map, and goes on', async (t) => {
  if (python('-c', 'import renderdoc').status !== 0) return t.skip('needs python3-renderdoc');
  const folder = mkdtempSync(join(tmpdir(), 'lichtveld-capture-'));
  t.after(() => rmSync(folder, { recursive: true }));
  const file = join(folder, 'map.rdc');
  const { url, serve } = await signaling(t);
  const server = serve('--capture', file, '--capture-after', '1');
  await server.says('serving');
  assert.deepEqual(readdirSync(folder), [], 'nobody has moved: there is one map');

  const browser = await launch(t);
  const player = await browser.open(url);
  await player.lit(60_000);
  await player.press('ArrowRight', () => server.output.includes(`${file}: captured`));
  assert.deepEqual(readdirSync(folder), ['map.rdc']);
  const listed = python(join(root, 'tools/capture_passes.py'), file);
  assert.equal(listed.status, 0, listed.stderr);
  assert.match(listed.stdout, /^links\n {2}place\n[^]*\n {2}present\n[^]*tone_map/);

  const { mapsReceived } = await player.knows();
  await player.press('ArrowLeft', (now) => now.mapsReceived > mapsReceived);
});
