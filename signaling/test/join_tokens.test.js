import assert from 'node:assert/strict';
import { createHmac } from 'node:crypto';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { SignJWT } from 'jose';
import { createJoinTokens } from '../join_tokens.js';
import { defaultLimits } from '../limits.js';
import { Peer, makeSite, metric, start } from './harness.js';
import { run } from './process.js';

const secret = 'b5'.repeat(32);
const link = fileURLToPath(new URL('../link.js', import.meta.url));
const tokens = createJoinTokens(secret, defaultLimits);

const jwt = (payload, { audience = 'lichtveld', key = secret, exp = '1h', alg = 'HS256' } = {}) => {
  const token = new SignJWT(payload).setProtectedHeader({ alg }).setAudience(audience);
  return (exp ? token.setExpirationTime(exp) : token).sign(Buffer.from(key));
};

/** As a browser shows it. */
const withToken = (signaling, token) =>
  new Peer(`${signaling.ws}/client`, {}, ['lichtveld.signaling', `lichtveld.join.${token}`]);

/** With what is to be found in no line of a log. */
async function startLogging(t) {
  const lines = [];
  const signaling = await start(t, { joinSecret: secret, log: (line) => lines.push(line) });
  return { signaling, lines };
}

const unsigned = () => {
  const part = (value) => Buffer.from(JSON.stringify(value)).toString('base64url');
  return `${part({ alg: 'none' })}.${part({ aud: 'lichtveld', role: 'player', exp: 9e9 })}.`;
};

test('without a good token nobody joins, and everybody is told why', async (t) => {
  const { signaling, lines } = await startLogging(t);
  const player = { role: 'player' };
  const [header, payload] = (await jwt(player)).split('.');
  const forged = createHmac('sha256', 'guess').update(`${header}.${payload}`).digest('base64url');
  const cases = {
    stale: [await jwt(player, { exp: '-1s' }), /has expired/],
    'by another secret': [await jwt(player, { key: 'c6'.repeat(32) }), /not for this room/],
    'forged signature': [`${header}.${payload}.${forged}`, /not for this room/],
    'no signature': [unsigned(), /not for this room/],
    'another algorithm': [await jwt(player, { alg: 'HS512' }), /not for this room/],
    'of another program': [await jwt(player, { audience: 'elsewhere' }), /not for this room/],
    'for ever': [await jwt(player, { exp: '' }), /not for this room/],
    'no role': [await jwt({}), /not for this room/],
    'unknown role': [await jwt({ role: 'admin' }), /not for this room/],
    'role of Object': [await jwt({ role: 'constructor' }), /not for this room/],
    'name too long': [await jwt({ ...player, name: 'x'.repeat(41) }), /not for this room/],
    'name of two lines': [await jwt({ ...player, name: 'a\nb' }), /not for this room/],
    'name that is none': [await jwt({ ...player, name: 7 }), /not for this room/],
    'too long': [await jwt({ ...player, padding: 'x'.repeat(2000) }), /not for this room/],
    garbage: ['garbage', /not for this room/],
  };
  for (const [name, [token, reason]] of Object.entries(cases)) {
    const closed = await withToken(signaling, token).closed;
    assert.equal(closed.code, 4401, name);
    assert.match(closed.reason, reason, name);
  }
  for (const none of [Peer.client(signaling.ws), withToken(signaling, '')]) {
    const { code, reason } = await none.closed;
    assert.equal(code, 4401);
    assert.match(reason, /no token/);
  }
  const refused = Object.keys(cases).length + 2;
  assert.equal(await metric(signaling, 'refused_connections_total{reason="join_token"}'), refused);
  assert.equal(await metric(signaling, 'clients'), 0);
  for (const [token] of Object.values(cases))
    for (const line of lines)
      assert.ok(!line.includes(String(token).slice(0, 20)) && !line.includes(secret), line);
});

test('a good token is shown by sub-protocol or header, and says who one is', async (t) => {
  const { signaling, lines } = await startLogging(t);
  const server = Peer.server(signaling.ws);
  const serverId = (await server.next()).id;
  const watcher = await tokens.sign({ role: 'watcher', name: 'Anna 🙂' }, 1);
  const player = await tokens.sign({ role: 'player' }, 1);

  const browser = withToken(signaling, watcher);
  const { seat, name, id } = await browser.next();
  assert.deepEqual([seat, name, browser.socket.protocol], ['watcher', 'Anna 🙂', 'lichtveld.signaling']);
  const program = Peer.client(signaling.ws, { headers: { Authorization: `Bearer ${player}` } });
  const welcome = await program.next();
  assert.ok(!('seat' in welcome) && !('name' in welcome));

  // What they say of themselves does not pass.
  browser.send({ id: serverId, type: 'offer', description: 'v=0', seat: 'player', name: 'Eve' });
  assert.deepEqual(await server.next(), {
    id,
    type: 'offer',
    description: 'v=0',
    seat: 'watcher',
    name: 'Anna 🙂',
  });
  program.send({ id: serverId, type: 'offer', description: 'v=0', seat: 'watcher', name: 'Eve' });
  assert.deepEqual(await server.next(), { id: welcome.id, type: 'offer', description: 'v=0' });
  browser.send({ id: serverId, type: 'candidate', candidate: 'c', mid: '0' });
  assert.deepEqual(await server.next(), { id, type: 'candidate', candidate: 'c', mid: '0' });

  for (const line of lines) assert.ok(!line.includes(watcher.slice(0, 30)) && !line.includes('Bearer'), line);
});

test('the scene is behind the token, the page is not', async (t) => {
  const { signaling, lines } = await startLogging(t);
  const scene = (token) =>
    fetch(`${signaling.http}/scene.glb`, { headers: token ? { Authorization: `Bearer ${token}` } : {} });
  const token = await tokens.sign({ role: 'watcher' }, 1);
  assert.equal((await fetch(signaling.http)).status, 200);
  const refused = await scene();
  assert.deepEqual([refused.status, refused.headers.get('www-authenticate')], [401, 'Bearer']);
  assert.match((await refused.json()).error, /no token/);
  assert.equal((await scene(await jwt({ role: 'player' }, { exp: '-1s' }))).status, 401);
  const response = await scene(token);
  assert.equal(response.status, 200);
  assert.match(response.headers.get('cache-control') ?? '', /private/);
  assert.equal(await metric(signaling, 'refused_requests_total{reason="join_token"}'), 2);
  for (const line of lines) assert.doesNotMatch(line, /eyJ|Bearer/);
});

test('a room without a secret is open, to those with a token too', async (t) => {
  const signaling = await start(t);
  const { seat, type } = await withToken(signaling, await tokens.sign({ role: 'watcher' }, 1)).next();
  assert.deepEqual([type, seat], ['welcome', undefined]);
});

test('link.js prints a link that lets in', async (t) => {
  const { root } = makeSite(t);
  const file = join(root, 'join-secret');
  writeFileSync(file, `${secret}\n`);
  const { signaling } = await startLogging(t);
  const args = ['--join-secret-file', file, '--url', 'https://room.example.org'];
  const { code, out } = await run(t, [...args, '--role', 'watcher', '--name', 'Bo'], { file: link }).exited;
  assert.equal(code, 0);
  const [, token] = out.match(/^https:\/\/room\.example\.org\/#join=([\w.-]+)\n$/) ?? [];
  const { seat, name } = await withToken(signaling, token).next();
  assert.deepEqual([seat, name], ['watcher', 'Bo']);
});

test('link.js names what is wrong, and never the secret', async (t) => {
  const { root } = makeSite(t);
  const file = join(root, 'join-secret');
  writeFileSync(file, secret);
  const short = join(root, 'short');
  writeFileSync(short, 'hunter2');
  const good = ['--join-secret-file', file, '--url', 'https://room.example.org'];
  const cases = [
    [[], /--join-secret-file is missing/],
    [['--join-secret-file', file], /--url is missing/],
    [['--join-secret-file', join(root, 'none'), '--url', 'https://a'], /none: ENOENT/],
    [['--join-secret-file', short, '--url', 'https://a'], /short has 7 characters.*openssl rand -hex 32/],
    [[...good, '--url', 'room.example.org'], /--url wants.*not 'room\.example\.org'/],
    [[...good, '--url', 'ftp://a'], /--url wants/],
    [[...good, '--role', 'admin'], /--role is player or watcher, not 'admin'/],
    [[...good, '--name', 'x'.repeat(41)], /--name has 1 to 40/],
    [[...good, '--hours', '0'], /--hours wants/],
    [[...good, '--hours', '9000'], /--hours wants.*8760/],
    [[...good, '--nonsense'], /nonsense/],
  ];
  const runs = cases.map(async ([args, message]) => {
    const { code, out, err } = await run(t, args, { file: link }).exited;
    assert.equal(code, 2, args.join(' '));
    assert.match(err, message);
    assert.ok(!`${out}${err}`.includes('hunter2') && !err.includes(secret));
  });
  await Promise.all(runs);
});
