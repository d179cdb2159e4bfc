// A full room, and many who come and go: tests/e2e/run.sh tests/e2e/crowd.test.js. Not in CTest: now and then the clients' own
// WebRTC library hangs in closing a connection, and the test with it. stream.RoomTest.WhenManyGoAtOnce... is there.
import assert from 'node:assert/strict';
import { fork } from 'node:child_process';
import { once } from 'node:events';
import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { CrowdMember } from './crowd_member.js';
import { root, signaling } from './programs.js';

const pause = (ms) => new Promise((proceed) => setTimeout(proceed, ms));

/** So many clients in a process of their own, all of them in the room. */
async function crowd(t, url, count) {
  const child = fork(join(root, 'tests/e2e/crowd.js'), [url, String(count)]);
  t.after(() => child.kill('SIGKILL'));
  assert.deepEqual((await once(child, 'message'))[0], 'joined');
  return {
    child,
    async roles() {
      const answer = once(child, 'message');
      child.send('roles');
      return (await answer)[0];
    },
  };
}

/** Waits until a question has the answer that is wanted; milliseconds that it took. */
async function until(what, limitMs, ask) {
  const begin = performance.now();
  while (!(await ask())) {
    assert.ok(performance.now() - begin < limitMs, `${what}: not within ${limitMs} ms`);
    await pause(20);
  }
  return performance.now() - begin;
}

const manyFromHere = { options: ['--max-per-address', '64'] };

const clientsAt = async (url) => (await (await fetch(`${url}/healthz`)).json()).clients;

test('half of a full room dies, both players among them, and then the rest', async (t) => {
  const { url, serve } = await signaling(t, manyFromHere);
  await serve().says('connected');
  const dying = await crowd(t, url, 32);
  const staying = await crowd(t, url, 32);
  assert.deepEqual((await dying.roles()).map(({ cube }) => cube).slice(0, 3), [1, 2, 0]);

  dying.child.kill('SIGKILL');
  const told = await until('the rest is told', 2000, async () =>
    (await staying.roles()).every(({ players, watchers }) => players === 2 && watchers === 30),
  );
  const cubes = (await staying.roles()).map(({ cube }) => cube).filter((cube) => cube > 0);
  assert.deepEqual(cubes.sort(), [1, 2]);
  t.diagnostic(`everybody was told within ${told.toFixed(0)} ms`);
  assert.equal(await clientsAt(url), 32);

  staying.child.kill('SIGKILL');
  await until('all are gone', 2000, async () => (await clientsAt(url)) === 0);
  const late = new CrowdMember(url);
  t.after(() => late.leave());
  await until('a newcomer plays', 5000, () => late.role);
  assert.deepEqual([late.role.cube, late.role.players, late.role.watchers], [1, 1, 0]);
  const metrics = await (await fetch(`${url}/metrics`)).text();
  assert.match(metrics, /connections_total\{role="server"\} 1\n/, 'the line to signaling was kept');
});

test("60 clients are back within ten seconds of a killed server's return", async (t) => {
  const { url, serve } = await signaling(t, manyFromHere);
  const first = serve();
  await first.says('connected');
  const { roles } = await crowd(t, url, 60);
  first.child.kill('SIGKILL');
  await first.exited;
  await until('the loss is told', 2000, async () =>
    (await roles()).every((role) => role === undefined || role === null),
  );
  await serve().says('connected');
  const back = await until('all are back', 10_000, async () =>
    (await roles()).every((role) => role && role.players + role.watchers === 60),
  );
  t.diagnostic(`all were back after ${back.toFixed(0)} ms`);
});

test('a thousand joins and leaves: nothing grows', async (t) => {
  const { url, serve, first } = await signaling(t, manyFromHere);
  const server = serve();
  await server.says('connected');
  /** Joins and leaves; false when it was refused, as too many have come in a second. */
  const visit = () =>
    new Promise((settle) => {
      const end = (joined) => {
        clearTimeout(patience);
        member.leave();
        settle(joined);
      };
      const member = new CrowdMember(url, () => end(true));
      member.onRefused = () => setTimeout(() => end(false), 100);
      const patience = setTimeout(() => end(false), 1500);
    });
  const programs = [server.child.pid, first.child.pid];
  /** MiB of memory, open files and threads of each program. */
  const measure = () =>
    programs.map((pid) => {
      const status = readFileSync(`/proc/${pid}/status`, 'utf8');
      const number = (name) => Number(new RegExp(`${name}:\\s+(\\d+)`).exec(status)?.[1]);
      return {
        memory: number('VmRSS') / 1024,
        files: readdirSync(`/proc/${pid}/fd`).length,
        threads: number('Threads'),
      };
    });
  const visits = async (count) => {
    let left = count;
    const one = async () => {
      while (left > 0) if (await visit()) left -= 1;
    };
    await Promise.all(Array.from({ length: 3 }, one));
    await until('all have left', 5000, async () => (await clientsAt(url)) === 0);
    await pause(1000);
  };
  await visits(200);
  const before = measure();
  await visits(800);
  for (const [i, after] of measure().entries()) {
    t.diagnostic(
      `${['server', 'signaling'][i]}: ${JSON.stringify(before[i])} after 200, ${JSON.stringify(after)} after 1000`,
    );
    assert.ok(after.memory < before[i].memory + 24, 'memory grows');
    assert.ok(after.files <= before[i].files + 2, 'files stay open');
    assert.ok(after.threads <= before[i].threads, 'threads stay');
  }
});
