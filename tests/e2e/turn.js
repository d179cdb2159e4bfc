import { createServer } from 'node:net';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { Program } from './programs.js';

const turnSecret = 'a-turn-secret-for-tests';

/**
 * A coturn on this machine, STUN and TURN.
 * @param {string} address  to listen on and to relay from
 * @param {string[]} [others]  to listen on, too: kinds of NATs are told apart by two (RFC 5780)
 */
export async function startTurn(t, address, others = []) {
  const folder = mkdtempSync(join(tmpdir(), 'lichtveld-turn-'));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  const configuration = join(folder, 'turnserver.conf');
  const lines = [
    ...[address, ...others].map((listening) => `listening-ip=${listening}`),
    `relay-ip=${address}`,
    'listening-port=3478',
    'realm=lichtveld',
    'use-auth-secret',
    `static-auth-secret=${turnSecret}`,
    'no-tls',
    'no-dtls',
    'no-cli',
    'log-file=stdout',
    'simple-log',
    `pidfile=${join(folder, 'pid')}`,
    `userdb=${join(folder, 'users')}`,
  ];
  writeFileSync(configuration, `${lines.join('\n')}\n`);
  const secretFile = join(folder, 'secret');
  writeFileSync(secretFile, `${turnSecret}\n`);
  const program = new Program(t, 'coturn', 'turnserver', ['-c', configuration]);
  await untilTaken(address, 3478);
  return { program, secretFile, stun: `stun:${address}:3478`, turn: `turn:${address}:3478` };
}

/** Waits until somebody listens on this TCP port. */
async function untilTaken(address, port) {
  for (let i = 0; i < 100; ++i) {
    const free = await new Promise((settle) => {
      const probe = createServer()
        .once('error', () => settle(false))
        .listen(port, address, () => probe.close(() => settle(true)));
    });
    if (!free) return;
    await new Promise((proceed) => setTimeout(proceed, 100));
  }
  throw new Error(`coturn does not listen on ${address}:${port}`);
}
