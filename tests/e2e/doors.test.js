// Who gets in, and how: by links, over TLS, through a proxy.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { WebSocket } from 'ws';
import { makeAuthority } from './certificates.js';
import { launch } from './browser.js';
import { Program, freePort, root, signaling } from './programs.js';

function temporaryFolder(t) {
  const folder = mkdtempSync(join(tmpdir(), 'lichtveld-doors-'));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  return folder;
}

test('only links let in: a player, a watcher by name; without one, or a stale one, the page says so', async (t) => {
  const secret = join(temporaryFolder(t), 'join-secret');
  writeFileSync(secret, 'a-secret-of-more-than-32-characters-for-tests\n');
  const { url, serve, first } = await signaling(t, { options: ['--join-secret-file', secret] });
  const server = serve();
  const link = (...more) =>
    execFileSync(
      process.execPath,
      [join(root, 'signaling/link.js'), '--join-secret-file', secret, '--url', url, ...more],
      { encoding: 'utf8' },
    ).trim();
  const browser = await launch(t);
  const barred = await browser.open(url);
  await barred.until('barred', ({ state }) => state === 'barred');
  const card = barred.page.locator('#trouble');
  assert.match(await card.innerText(), /for those with a link[^]*link/i);
  await barred.screenshot('not-admitted');

  const watcher = await browser.open(link('--role', 'watcher', '--name', 'Ada'));
  assert.equal((await watcher.lit(60_000)).role.cube, 0, 'a watcher gets no cube, though both are free');
  const player = await browser.open(link('--role', 'player', '--name', 'Bob'));
  assert.equal((await player.lit()).role.cube, 1);
  assert.equal(await player.page.locator('#own-label').innerText(), 'Bob');

  const stale = link('--hours', '0.0001');
  await new Promise((proceed) => setTimeout(proceed, 1500));
  const late = await browser.open(stale);
  await late.until('barred', ({ state }) => state === 'barred');
  assert.match(await late.page.locator('#trouble').innerText(), /link has expired: ask whoever runs/i);
  // The other link in the same page, which loads itself anew.
  await Promise.all([late.page.waitForEvent('load'), late.page.goto(link('--role', 'watcher'))]);
  await late.lit();
  for (const { output } of [first, server])
    for (const hidden of [stale.split('=')[1], 'a-secret-of-more'])
      assert.equal(output.includes(hidden), false, 'the log holds a token or secret');
});

test("after a reload the cube is one's own again", async (t) => {
  const { url, serve } = await signaling(t);
  serve();
  const browser = await launch(t);
  const player = await browser.open(url);
  assert.equal((await player.lit(60_000)).role.cube, 1);
  const [other, watcher] = [await browser.open(url), await browser.open(url)];
  await other.lit();
  await watcher.until('it watches', ({ role }) => role?.cube === 0);
  await player.page.reload();
  assert.equal((await player.lit()).role.cube, 1);
  const { role } = await watcher.until(
    'it watches again',
    (known) => known.role.cube === 0 && known.role.watchers === 1,
  );
  assert.deepEqual([role.players, role.watchers], [2, 1]);
  assert.match(
    (await watcher.page.locator('#hint-role').textContent()) ?? '',
    /has come back\. You are watching/,
  );
});

test('TLS from end to end: the page by https, signaling by wss, both by a test authority', async (t) => {
  const folder = temporaryFolder(t);
  const authority = makeAuthority(folder);
  const { cert, key } = authority.issue('good');
  const room = await signaling(t, { options: ['--tls-cert', cert, '--tls-key', key] });
  const server = room.serve('--ca-file', authority.ca);
  await server.says(`wss://127.0.0.1:${new URL(room.url).port}/server connected`);
  const player = await (await launch(t)).open(room.url, { ignoreHTTPSErrors: true });
  await player.lit(60_000);

  const expired = authority.issue('expired', { days: '-1' });
  const refused = new Program(t, 'signaling', process.execPath, [
    ...[join(root, 'signaling/main.js'), '--port', '0', ...room.files],
    ...['--tls-cert', expired.cert, '--tls-key', expired.key],
  ]);
  assert.deepEqual(await refused.exited, [2, null]);
  assert.match(refused.output, /the certificate .*expired\.pem expired on .*: renew it/);
});

test('behind the proxy of docs/hosting: the page comes by https, and limits count the real address', async (t) => {
  const folder = temporaryFolder(t);
  const { cert, key } = makeAuthority(folder).issue('proxy');
  const options = ['--trust-proxy', 'loopback', '--name', 'localhost', '--max-per-address', '1'];
  const room = await signaling(t, { options });
  room.serve();
  const port = await freePort();
  const address = `https://localhost:${port}`;
  const site = readFileSync(join(root, 'docs/hosting/Caddyfile'), 'utf8')
    .replace(/^room\.example\.org \{/m, `${address} {\n\ttls ${cert} ${key}`)
    .replace('127.0.0.1:8080', new URL(room.url).host);
  assert.match(site, new RegExp(`tls ${cert}`));
  const configuration = join(folder, 'Caddyfile');
  writeFileSync(configuration, `{\n\tadmin off\n\tauto_https disable_redirects\n}\n${site}`);
  const env = { XDG_DATA_HOME: folder, XDG_CONFIG_HOME: folder };
  const proxy = new Program(
    t,
    'caddy',
    'caddy',
    ['run', '--config', configuration, '--adapter', 'caddyfile'],
    env,
  );
  await proxy.says('serving initial configuration');

  const player = await (await launch(t)).open(address, { ignoreHTTPSErrors: true });
  await player.lit(60_000);
  const visit = (localAddress) =>
    new Promise((settle) => {
      const socket = new WebSocket(`wss://127.0.0.1:${port}/client`, {
        localAddress,
        rejectUnauthorized: false,
        servername: 'localhost',
        headers: { Host: `localhost:${port}` },
      });
      t.after(() => socket.terminate());
      socket.on('message', () => settle('in'));
      socket.on('close', (code) => settle(code));
      socket.on('error', () => {});
    });
  assert.equal(await visit('127.0.0.2'), 'in', "another address than the player's");
  assert.equal(await visit('127.0.0.2'), 1013, 'the same again');
  assert.equal(await visit('127.0.0.3'), 'in');
  const response = await player.page.request.get(`${address}/metrics`);
  assert.equal(response.status(), 403);
});
