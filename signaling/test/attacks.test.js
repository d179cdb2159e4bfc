import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { mkdirSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { setTimeout as sleep } from 'node:timers/promises';
import { fileURLToPath } from 'node:url';
import { GoodClient } from './good_client.js';
import { makeSite, populate } from './harness.js';
import { argsOf, run } from './process.js';

const attacker = fileURLToPath(new URL('./attacker.js', import.meta.url));
const collectGarbage = fileURLToPath(new URL('./collect_garbage.cjs', import.meta.url));
const attacks = ['pipelined', 'unread', 'half-sent', 'rejoining', 'flooding'];
const MiB = 1024 * 1024;

/** A signaling process with a page and a scene of real sizes, somebody who plays there, and what the process takes. */
async function begin(t) {
  const site = makeSite(t);
  mkdirSync(join(site.client, 'assets'));
  writeFileSync(join(site.client, 'assets', 'app.js'), 'x'.repeat(MiB));
  writeFileSync(site.scene, Buffer.concat([Buffer.from('glTF'), Buffer.alloc(16 * MiB)]));
  const program = run(t, argsOf(site), { nodeOptions: ['--expose-gc', '--require', collectGarbage] });
  const port = await program.port();
  const signaling = { http: `http://127.0.0.1:${port}`, ws: `ws://127.0.0.1:${port}`, port };
  const { server, serverId, clients } = await populate(signaling, 1);
  const player = { ...clients[0], serverId };
  const good = new GoodClient(signaling, { server, player, address: '127.0.0.1' });
  const { pid } = program.child;
  /** Without garbage, which V8 lets lie until it needs the room. */
  const taken = async () => {
    process.kill(/** @type {number} */ (pid), 'SIGUSR2');
    await sleep(150);
    return takenNow();
  };
  const takenNow = () => ({
    rss: (Number(readFileSync(`/proc/${pid}/statm`, 'utf8').split(' ')[1]) * 4096) / MiB,
    files: readdirSync(`/proc/${pid}/fd`).length,
  });
  return { ...program, signaling, good, taken };
}

async function attack(t, name, port, address) {
  const child = spawn(process.execPath, [attacker, name, String(port), address], {
    stdio: ['ignore', 'pipe', 'inherit'],
  });
  t.after(() => child.kill('SIGKILL'));
  await once(child.stdout, 'data');
  return child;
}

/** Until it holds; fails with what was seen last. */
async function within(milliseconds, look) {
  const end = performance.now() + milliseconds;
  for (;;) {
    const { done, seen } = await look();
    if (done) return;
    assert.ok(performance.now() < end, `still ${seen} after ${milliseconds} ms`);
    await sleep(100);
  }
}

for (const name of attacks)
  test(`${name}: others do not notice, and nothing of it stays`, async (t) => {
    const { good, signaling, taken, child, output } = await begin(t);
    await good.goesOn(500); // until V8 has warmed up
    const before = { ...(await good.goesOn(800)), ...(await taken()) };
    const villain = await attack(t, name, signaling.port, '127.0.0.2');
    // At first it has all that its address may have at once; it is bounded from then on.
    const onset = await good.goesOn(700);
    const during = { ...(await good.goesOn(1500)), ...(await taken()) };
    villain.kill('SIGKILL');

    t.diagnostic(`${name}: a page in its first moments: ${onset.page.toFixed(1)} ms`);
    const of = (key) => `${key} ${before[key].toFixed(1)} -> ${during[key].toFixed(1)}`;
    t.diagnostic(
      `${name}: ms: ${['page', 'join', 'relay'].map(of).join(', ')}; MiB: ${of('rss')}; ${of('files')}`,
    );
    assert.deepEqual(before.errors, []);
    assert.deepEqual([...onset.errors, ...during.errors], []);
    // Two cores are shared with the attacker and whatever else runs here: a wide bound, and the figures above.
    for (const key of ['page', 'join', 'relay']) assert.ok(during[key] < 4 * before[key] + 1000, of(key));
    assert.equal(child.exitCode, null);
    let after = await taken();
    await within(10_000, async () => {
      after = await taken();
      const done = after.files <= before.files + 4 && after.rss < before.rss + 64;
      return { done, seen: JSON.stringify(after) };
    });
    t.diagnostic(`${name}: afterwards ${after.rss.toFixed(1)} MiB, ${after.files} files`);
    const lines = output.err.split('\n').filter((line) => !/ (joined|left);/.test(line));
    assert.ok(lines.length < 40, `${lines.length} lines:\n${lines.slice(0, 50).join('\n')}`);
  });

// Each in a room of its own, so that they can go on at the same time.
test("from one's own address: it is good again within 15 s", { concurrency: true }, (t) =>
  Promise.all(attacks.map((name) => t.test(name, (one) => recovers(one, name)))),
);

async function recovers(t, name) {
  const { good, signaling } = await begin(t);
  const villain = await attack(t, name, signaling.port, '127.0.0.1');
  await sleep(1500);
  // It does nothing more, and lets nothing go.
  villain.kill('SIGSTOP');
  const stopped = performance.now();
  await within(15_000, async () => {
    const { errors } = await good.goesOn(1);
    return { done: errors.length === 0, seen: errors };
  });
  t.diagnostic(`${name}: good after ${((performance.now() - stopped) / 1000).toFixed(1)} s`);
}
