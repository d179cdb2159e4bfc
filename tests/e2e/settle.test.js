import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { launch } from './browser.js';
import { play, scenePath } from './programs.js';
import { SceneFile } from './scene.js';

/** Light that goes back and forth for hundreds of bounces. */
const albedo = 0.98;
/** A step's own map, and three in which light settles. */
const mostMaps = 4;
/** Milliseconds after which /metrics knows of all that has been done. */
const reportMs = 2500;

/** How many light maps the server has computed. */
async function mapsComputed({ page }, url) {
  await page.waitForTimeout(reportMs);
  const text = await (await fetch(`${url}/metrics`)).text();
  return Number(/^lichtveld_server_stage_runs_total\{stage="update"\} (.+)$/m.exec(text)?.[1]);
}

test('in a bright room, too, light settles within three maps of the last step', async (t) => {
  const folder = mkdtempSync(join(tmpdir(), 'lichtveld-e2e-'));
  t.after(() => rmSync(folder, { recursive: true }));
  const scene = join(folder, 'bright.glb');
  new SceneFile(scenePath).writeWithAlbedo(scene, albedo);
  const { url } = await play(t, ['--size', '64', '--psf', '96', '--adapt', '0,0'], scene);
  const player = await (await launch(t)).open(url);
  await player.lit();
  await player.settledMap();
  const [before, { places }] = [await mapsComputed(player, url), await player.knows()];
  await player.page.keyboard.press('ArrowLeft');
  await player.until('moved', (known) => known.places[0].x < places[0].x);
  await player.settledMap();
  const maps = (await mapsComputed(player, url)) - before;
  t.diagnostic(`${maps} maps after a step`);
  assert.ok(maps > 1 && maps <= mostMaps, `${maps} maps`);
  await player.page.waitForTimeout(reportMs);
  assert.equal(
    (await mapsComputed(player, url)) - before,
    maps,
    'nothing is computed once light has settled',
  );
});
