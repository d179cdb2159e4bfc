import assert from 'node:assert/strict';
import { once } from 'node:events';
import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { freePort, scenePath, startPlay } from './programs.js';

/** The processes that were started by this one. */
const childrenOf = (pid) =>
  readFileSync(`/proc/${pid}/task/${pid}/children`, 'utf8').trim().split(' ').filter(Boolean);

test('it says ready once, and leaves neither processes nor files when it is ended', async (t) => {
  const folder = mkdtempSync(join(tmpdir(), 'lichtveld-e2e-'));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  const port = await freePort();
  const program = startPlay(t, { port, env: { TMPDIR: folder } });
  await program.says(`ready http://127.0.0.1:${port}\n`);
  assert.equal(program.stdout, `ready http://127.0.0.1:${port}\n`);
  const children = childrenOf(program.child.pid);
  assert.equal(children.length, 2);
  assert.notDeepEqual(readdirSync(folder), []);

  program.child.kill('SIGTERM');
  assert.deepEqual(await program.exited, [0, null]);
  for (const pid of children)
    assert.equal(existsSync(`/proc/${pid}`), false, `process ${pid} is still there`);
  assert.deepEqual(readdirSync(folder), []);
});

test('a busy port ends it with 2, and it says which port', async (t) => {
  const blocker = createServer().listen(0, '127.0.0.1');
  await once(blocker, 'listening');
  t.after(() => blocker.close());
  const { port } = /** @type {import('node:net').AddressInfo} */ (blocker.address());
  const program = startPlay(t, { port });
  assert.deepEqual(await program.exited, [2, null]);
  assert.match(program.output, new RegExp(`port ${port} .* is taken`));
  assert.equal(program.stdout, '');
});

test('when the render server gives up, so does the rest, with its exit code and its name', async (t) => {
  const program = startPlay(t, { port: await freePort(), serveOptions: ['--psf', '25'] });
  assert.deepEqual(await program.exited, [2, null]);
  assert.match(program.output, /play: server ended with exit code 2/);
  assert.equal(program.stdout, '');
});

test('a program that is killed is started again, and says so', async (t) => {
  const port = await freePort();
  const program = startPlay(t, { port });
  await program.says(`ready http://127.0.0.1:${port}\n`);
  const health = async () => (await fetch(`http://127.0.0.1:${port}/healthz`).catch(() => undefined))?.json();
  for (const name of ['server', 'signaling']) {
    const pid = childrenOf(program.child.pid).find((child) =>
      readFileSync(`/proc/${child}/cmdline`, 'utf8').includes(
        name === 'server' ? '\0serve\0' : 'signaling/main.js',
      ),
    );
    process.kill(Number(pid), 'SIGKILL');
    await program.says(`play: ${name} was ended by SIGKILL; starting it again in 0.5 s (1 of 5)`);
    const end = Date.now() + 20_000;
    while (!(await health())?.server) {
      assert.ok(Date.now() < end, `the ${name} does not come back`);
      await new Promise((proceed) => setTimeout(proceed, 100));
    }
  }
  assert.equal(program.stdout, `ready http://127.0.0.1:${port}\n`, 'it says ready once');
});

test('a program that ends again and again is given up with its reason', async (t) => {
  const folder = mkdtempSync(join(tmpdir(), 'lichtveld-e2e-'));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  const broken = join(folder, 'lichtveld');
  // It gives out the scene as it is, and serves nobody.
  writeFileSync(broken, '#!/bin/sh\n[ "$1" = unwrap ] || exit 1\nexec cp "$2" "$4"\n', { mode: 0o755 });
  const program = startPlay(t, { port: await freePort(), env: { LICHTVELD: broken } });
  assert.deepEqual(await program.exited, [1, null]);
  assert.match(
    program.output,
    /starting it again in 8 s \(5 of 5\)[^]*exit code 1, for the 6th time in a row; ending/,
  );
  assert.equal(program.stdout, '');
});

test('a scene that cannot be used ends it with 2 and its reason', async (t) => {
  const folder = mkdtempSync(join(tmpdir(), 'lichtveld-e2e-'));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  const scene = join(folder, 'cut.glb');
  writeFileSync(scene, readFileSync(scenePath).subarray(0, 500));
  const program = startPlay(t, { port: await freePort(), scene });
  assert.deepEqual(await program.exited, [2, null]);
  assert.match(program.output, /cut\.glb: truncated/);
  assert.equal(program.stdout, '');
});

test('bad usage ends it with 2 and names the culprit', async (t) => {
  for (const [port, message] of [
    ['99999', /--port.*99999/],
    ['none', /--port.*none/],
  ]) {
    const program = startPlay(t, { port });
    assert.deepEqual(await program.exited, [2, null]);
    assert.match(program.output, message);
  }
});
