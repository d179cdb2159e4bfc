// `./dev play --public` on a machine that the internet reaches.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { test } from 'node:test';
import { launch } from './browser.js';
import { internet, makeInternet } from './networks.js';
import { freePort, startPlay } from './programs.js';

test('players by links, also from where only TCP gets out; strangers stay out', async (t) => {
  const net = makeInternet(t);
  const [home, strict] = [net.home('symmetric'), net.home('symmetric')];
  const port = await freePort();
  const room = startPlay(t, { port, options: ['--public'] });
  await room.says(`ready http://${internet}:${port}\n`);
  await room.says('  watcher  node ');
  const [, command] = /^ {2}player {2}node (.*)$/m.exec(room.output) ?? [];
  const link = execFileSync(process.execPath, command.split(' '), { encoding: 'utf8' }).trim();
  assert.match(link, new RegExp(`^http://203\\.0\\.113\\.1:${port}/#join=`));

  const browser = await launch(t, home.prefix);
  const stranger = await browser.open(`http://${internet}:${port}`);
  await stranger.until('barred', ({ state }) => state === 'barred');
  const first = await browser.open(link);
  assert.equal((await first.lit(40_000)).role.cube, 1);

  strict.block('meta l4proto udp');
  const second = await (await launch(t, strict.prefix)).open(link);
  const { role, places } = await second.lit(40_000);
  assert.equal(role.cube, 2);
  await second.press('ArrowUp', (known) => known.places[1].y > places[1].y);
  await first.until('it sees the move', (known) => known.places[1].y > places[1].y);
  assert.equal(room.stdout, `ready http://${internet}:${port}\n`);
  assert.doesNotMatch(room.output, /#join=/, 'no token in what may be a log');
});

test('behind a 1:1 NAT it asks for the address that others see', async (t) => {
  const net = makeInternet(t);
  const home = net.home('oneToOne');
  const room = startPlay(t, { port: await freePort(), options: ['--public'], prefix: home.prefix });
  assert.deepEqual(await room.exited, [2, null]);
  assert.match(room.output, /own addresses \(10\.0\.1\.2\) are private.*--public-ip/);
});
