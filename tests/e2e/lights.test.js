// Lights that players switch, in the furnished room.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { launch } from './browser.js';
import { play, roomPath } from './programs.js';

const small = ['--size', '64', '--psf', '24', '--bounces', '2', '--adapt', '0,0'];
const isOn = ({ scale }) => Math.max(...scale) > 0;
const light = (name, { lights }) => lights.find((one) => one.name === name);
const mean = ({ data }) => data.reduce((sum, value) => sum + value, 0) / data.length;

test('the key L switches the nearest lamp, the panel any light, for all who are there', async (t) => {
  const { url } = await play(t, small, roomPath);
  const browser = await launch(t);
  // One after another: the first two get the cubes.
  const pages = [];
  for (let i = 0; i < 3; ++i) {
    pages.push(await browser.open(url));
    await pages[i].lit(60_000);
  }
  const [player, other, watcher] = pages;
  const { lights } = await player.until('told of lights', ({ lights }) => lights.length > 0);
  assert.deepEqual(
    lights.map(({ name }) => name),
    ['pendant', 'floor lamp', 'table lamp', 'sun', 'sky'],
  );
  const before = await watcher.settledMap();

  await player.page.keyboard.press('l');
  for (const page of pages)
    await page.until('the table lamp is off', (known) => !isOn(light('table lamp', known)));
  await watcher.untilMap('its light is missed', (map) => Math.abs(mean(map) - mean(before)) > 0.5);

  await watcher.page.keyboard.press('l');
  await player.page.keyboard.press('l');
  await watcher.until('it is on again, by the player', (known) => isOn(light('table lamp', known)));
  await watcher.untilMap('it is as it was', ({ data }) => Buffer.compare(data, before.data) === 0);

  await player.page.click('#lights summary');
  const row = (n) => player.page.locator('#light-list li').nth(n);
  await row(4).locator('button').click();
  await other.until('the sky is dark', (known) => !isOn(light('sky', known)));
  await row(0)
    .locator('input[type=range]')
    .evaluate((input) => {
      input.value = '0.25';
      input.dispatchEvent(new Event('input'));
    });
  await other.until('the pendant is dimmed', (known) => light('pendant', known).scale[0] === 0.25);
  assert.equal(await watcher.page.evaluate(() => window.lichtveld.error), '');
});

test('a tap on a lamp switches it', async (t) => {
  const { url } = await play(t, small, roomPath);
  const browser = await launch(t);
  const player = await browser.open(url, { viewport: { width: 960, height: 640 } });
  await player.lit(60_000);
  await player.until('told of lights', ({ lights }) => lights.length > 0);
  // The floor lamp's shade.
  const { x, y } = await player.page.evaluate(() => window.lichtveld.project(0.32, 1.48, -1.8));
  await player.page.mouse.click(x, y);
  const known = await player.until('it is off', (now) => !isOn(light('floor lamp', now)));
  assert.ok(
    known.lights.every((one) => one.name === 'floor lamp' || isOn(one)),
    'and it alone',
  );
});
