import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { createSecretKey } from 'node:crypto';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { SignJWT } from 'jose';
import { JoinTokens } from '../join_tokens.js';
import { Peer, makeSite, metric, start, token } from './harness.js';

const secret = 'a'.repeat(40);
const tokens = new JoinTokens(secret);

/** A token of our own making, by a secret and claims that may be wrong. */
const forge = (claims, { key = secret, audience = 'lichtveld', expires = '1h', alg = 'HS256' } = {}) =>
  new SignJWT(claims)
    .setProtectedHeader({ alg })
    .setAudience(audience)
    .setExpirationTime(expires)
    .sign(createSecretKey(Buffer.from(key)));

const unsigned = (claims) =>
  `${[{ alg: 'none' }, claims].map((part) => Buffer.from(JSON.stringify(part)).toString('base64url')).join('.')}.`;

/** As the page joins: the token in its sub-protocols. */
const joinAsPage = (ws, joinToken, options) => {
  const protocols = joinToken === undefined ? [] : ['lichtveld.signaling', `lichtveld.join.${joinToken}`];
  return new Peer(`${ws}/client`, options, protocols);
};

test('a link lets in: as player or watcher, by a name, in a page or a program', async (t) => {
  const signaling = await start(t, { joinSecret: secret });
  const server = Peer.server(signaling.ws);
  const serverId = (await server.next()).id;
  const page = joinAsPage(signaling.ws, await tokens.sign({ role: 'watcher', name: 'Ada', hours: 1 }));
  const welcome = await page.next();
  assert.deepEqual([welcome.type, welcome.seat, welcome.name], ['welcome', 'watcher', 'Ada']);
  assert.equal(page.socket.protocol, 'lichtveld.signaling');
  // Whatever a client says of itself goes no further.
  page.send({ id: serverId, type: 'offer', description: 'v=0', seat: 'player', name: 'Eve' });
  const offer = await server.next();
  assert.deepEqual([offer.seat, offer.name, offer.id], ['watcher', 'Ada', welcome.id]);

  const bearer = { headers: { Authorization: `Bearer ${await tokens.sign({ role: 'player', hours: 1 })}` } };
  const program = Peer.client(signaling.ws, bearer);
  assert.deepEqual(Object.keys(await program.next()).sort(), ['id', 'scene', 'server', 'type']);
  program.send({
    id: serverId,
    type: 'offer',
    description: 'v=0',
    seat: 'watcher',
    session: 'an-earlier-stay',
  });
  const second = await server.next();
  assert.deepEqual([second.seat, second.name, second.session], [undefined, undefined, 'an-earlier-stay']);
});

test('no token, a stale one, a forged one: closed with 4401 in words, and counted', async (t) => {
  const signaling = await start(t, { joinSecret: secret });
  const player = { role: 'player' };
  const cases = [
    [undefined, /those with a link/, 'no_token'],
    [await forge(player, { expires: '-1m' }), /expired/, 'stale_token'],
    [await forge(player, { key: 'b'.repeat(40) }), /not for this room/, 'bad_token'],
    [await forge(player, { audience: 'another' }), /not for this room/, 'bad_token'],
    [await forge(player, { alg: 'HS384' }), /not for this room/, 'bad_token'],
    [await forge({ role: 'owner' }), /not for this room/, 'bad_token'],
    [await forge({}), /not for this room/, 'bad_token'],
    [await forge({ ...player, name: '<b>' }), /not for this room/, 'bad_token'],
    [unsigned({ ...player, aud: 'lichtveld', exp: 4e9 }), /not for this room/, 'bad_token'],
    ['x'.repeat(3000), /not for this room/, 'bad_token'],
  ];
  for (const [joinToken, words, reason] of cases) {
    const before = await metric(signaling, `refused_connections_total{reason="${reason}"}`);
    const { code, reason: said } = await joinAsPage(signaling.ws, joinToken).closed;
    assert.equal(code, 4401, String(joinToken));
    assert.match(said, words);
    assert.equal(await metric(signaling, `refused_connections_total{reason="${reason}"}`), before + 1);
  }
});

test('the scene is for those with a link, the page for everybody', async (t) => {
  const signaling = await start(t, { joinSecret: secret });
  const scene = (headers) => fetch(`${signaling.http}/scene.glb`, { headers });
  assert.equal((await scene({})).status, 401);
  assert.equal(
    (await scene({ Authorization: `Bearer ${await forge({ role: 'player' }, { expires: '-1m' })}` })).status,
    401,
  );
  const good = await tokens.sign({ role: 'watcher', hours: 1 });
  assert.equal((await scene({ Authorization: `Bearer ${good}` })).status, 200);
  assert.equal((await fetch(signaling.http)).status, 200);
});

test('neither tokens nor secrets are logged', async (t) => {
  const lines = [];
  const signaling = await start(t, {
    joinSecret: secret,
    turnSecret: 'the-turn-secret',
    log: (line) => lines.push(line),
  });
  const good = await tokens.sign({ role: 'player', name: 'Ada', hours: 1 });
  const bad = await forge({ role: 'player' }, { expires: '-1m' });
  await joinAsPage(signaling.ws, good).next();
  await joinAsPage(signaling.ws, bad).closed;
  await Peer.server(signaling.ws, { headers: { Authorization: 'Bearer a-wrong-one' } }).refused;
  await Peer.server(signaling.ws).next();
  const log = lines.join('\n');
  assert.match(log, /\(Ada\) joined/);
  for (const hidden of [good, bad, secret, token, 'a-wrong-one', 'the-turn-secret'])
    assert.equal(log.includes(hidden), false, `the log holds ${hidden}:\n${log}`);
});

test('link.js makes links that let in, and says what is wrong with its options', async (t) => {
  const site = makeSite(t);
  const file = join(site.root, 'join-secret');
  writeFileSync(file, `${secret}\n`);
  const program = fileURLToPath(new URL('../link.js', import.meta.url));
  const run = (...args) => spawnSync(process.execPath, [program, ...args], { encoding: 'utf8' });
  const url = 'https://room.example.org';
  const made = run(
    '--join-secret-file',
    file,
    '--url',
    url,
    '--role',
    'watcher',
    '--name',
    "Ada O'Neil",
    '--hours',
    '0.5',
  );
  assert.equal(made.status, 0, made.stderr);
  const [, joinToken] = made.stdout.match(/^https:\/\/room\.example\.org\/#join=([\w.-]+)\n$/) ?? [];
  assert.deepEqual(await tokens.verify(joinToken), { ticket: { seat: 'watcher', name: "Ada O'Neil" } });

  const short = join(site.root, 'short');
  writeFileSync(short, 'guess-me');
  for (const [args, words] of [
    [[], /--join-secret-file is missing/],
    [['--join-secret-file', file], /--url is missing/],
    [['--join-secret-file', short, '--url', url], /shorter than 32.*openssl rand/],
    [['--join-secret-file', file, '--url', 'room'], /--url room is no address/],
    [['--join-secret-file', file, '--url', url, '--role', 'owner'], /--role.*owner/],
    [['--join-secret-file', file, '--url', url, '--name', '<b>'], /--name/],
    [['--join-secret-file', file, '--url', url, '--hours', '0'], /--hours/],
  ]) {
    const { status, stderr } = run(...args);
    assert.equal(status, 2, stderr);
    assert.match(stderr, words);
  }
  assert.equal(readFileSync(file, 'utf8'), `${secret}\n`);
  execFileSync(process.execPath, [program, '--help']);
});
