import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { launch } from './browser.js';
import { scenePath, signaling } from './programs.js';

/** What the card in the middle of the page says; empty when there is none. */
const trouble = async (player) =>
  (await player.page.locator('#trouble').isVisible()) ? player.page.locator('#trouble').innerText() : '';

/** Has the canvas anything but the page's dark background on it? */
function draws({ data }) {
  let bright = 0;
  for (let at = 0; at < data.length; at += 4)
    if (Math.max(data[at], data[at + 1], data[at + 2]) > 40) bright += 1;
  return bright > 0;
}

test('another scene than the one that is lit: the page says so and draws nothing', async (t) => {
  const folder = mkdtempSync(join(tmpdir(), 'lichtveld-e2e-'));
  t.after(() => rmSync(folder, { recursive: true }));
  const bytes = readFileSync(scenePath);
  bytes.write('tall_BLOCK', bytes.indexOf('tall_block'));
  const scene = join(folder, 'other.glb');
  writeFileSync(scene, bytes);

  const { url, serve } = await signaling(t, { scene });
  serve();
  const player = await (await launch(t)).open(url);
  await player.until('told', ({ state }) => state === 'mismatch');
  assert.match(await trouble(player), /lights another scene.*reload/is);
  await player.page.waitForTimeout(1000);
  const { state, mapsReceived, role } = await player.knows();
  assert.deepEqual([state, mapsReceived, role], ['mismatch', 0, undefined]);
  await player.screenshot('another-scene');
  await player.page.locator('header, #trouble').evaluateAll((all) => {
    for (const one of all) one.style.visibility = 'hidden';
  });
  assert.equal(draws(await player.screenshot('another-scene-canvas')), false);
});

test('a scene that cannot be drawn: the page says why, and goes on when it can be had', async (t) => {
  const folder = mkdtempSync(join(tmpdir(), 'lichtveld-e2e-'));
  t.after(() => rmSync(folder, { recursive: true }));
  const scene = join(folder, 'cut.glb');
  writeFileSync(scene, readFileSync(scenePath).subarray(0, 5000));
  const { url } = await signaling(t, { scene });
  const player = await (await launch(t)).open(url);
  const card = player.page.locator('#trouble');
  await card.getByText('The room cannot be loaded').waitFor();
  assert.match(await trouble(player), /the scene file cannot be drawn \(.+\).*trying again in \d+ s/is);
  assert.equal(await player.page.locator('#state').innerText(), 'No scene');
  await player.screenshot('no-scene');
  await player.page.route('**/scene.glb', (route) => route.fulfill({ path: scenePath }));
  await card.getByText('No render server there').waitFor();
});

test('a full room says so, and lets the page in by itself when somebody leaves', async (t) => {
  const { url } = await signaling(t, { options: ['--max-clients', '1'] });
  const browser = await launch(t);
  const first = await browser.open(url);
  await first.until('in', ({ state }) => state === 'waiting');
  const second = await browser.open(url);
  await second.until('refused', ({ state }) => state === 'full');
  assert.match(await trouble(second), /the room is full.*trying again in \d+ s/is);
  await second.screenshot('room-full');
  await first.page.close();
  await second.until('in', ({ state }) => state === 'waiting');
});

test('a browser without WebRTC or WebGL says what is missing', async (t) => {
  const { url } = await signaling(t);
  const browser = await launch(t);
  for (const [name, init] of /** @type {[string, () => void][]} */ ([
    ['WebRTC', () => delete (/** @type {any} */ (window).RTCPeerConnection)],
    ['WebGL 2', () => (HTMLCanvasElement.prototype.getContext = () => null)],
  ])) {
    const player = await browser.open(url, { init });
    await player.page.locator('body[data-state=unsupported]').waitFor();
    assert.match(await trouble(player), new RegExp(`cannot show the room.*${name} is missing`, 'is'));
    assert.equal(await player.page.locator('#state').innerText(), 'Not supported');
    await player.screenshot(`without-${name.replace(' ', '')}`);
  }
});

test('a handshake that hangs on a way that was found: the page tries again soon, and says why', async (t) => {
  const { url, serve } = await signaling(t);
  await serve().says('connected');
  // We speak to a port that the server's end of the line does not have, and nobody answers.
  const player = await (
    await launch(t)
  ).open(url, {
    init: () => {
      let first = true;
      const take = RTCPeerConnection.prototype.setRemoteDescription;
      RTCPeerConnection.prototype.setRemoteDescription = function (answer) {
        const hang = first;
        first = false;
        return take.call(this, {
          type: answer.type,
          sdp: hang ? answer.sdp.replace('sctp-port:5000', 'sctp-port:5001') : answer.sdp,
        });
      };
    },
  });
  await player.page.getByText(/a way to the render server was found/i).waitFor({ timeout: 8000 });
  await player.until('live', ({ state }) => state === 'live');
});
