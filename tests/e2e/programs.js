import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:net';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

export const root = fileURLToPath(new URL('../..', import.meta.url));
export const scenePath = join(root, 'assets/cornell.glb');
export const roomPath = join(root, 'assets/room.glb');
export const executable = resolve(process.env.LICHTVELD || join(root, 'build/release/lichtveld'));

/** Small, for speed: what is tested is the way of the light, not its beauty. Fewer PSFs show no shadow on the floor. */
const quick = ['--size', '128', '--psf', '96', '--bounces', '1'];

export async function freePort() {
  const probe = createServer().listen(0, '127.0.0.1');
  await once(probe, 'listening');
  const { port } = /** @type {import('node:net').AddressInfo} */ (probe.address());
  probe.close();
  await once(probe, 'close');
  return port;
}

/** A program whose output is kept for the report of a failure, and which ends with the test. */
export class Program {
  /** Standard output and error together, and the former alone. */
  output = '';
  stdout = '';

  constructor(t, name, command, args, env = {}) {
    this.child = spawn(command, args, {
      cwd: root,
      stdio: ['ignore', 'pipe', 'pipe'],
      env: { ...process.env, ...env },
    });
    this.exited = once(this.child, 'close');
    for (const stream of [this.child.stdout, this.child.stderr])
      stream.on('data', (data) => (this.output += data));
    this.child.stdout.on('data', (data) => (this.stdout += data));
    t.after(async () => {
      this.child.kill('SIGTERM');
      await this.exited;
      t.diagnostic(`${name} said:\n${this.output}`);
    });
  }

  /** Waits until its output holds this text. */
  async says(text, timeoutMs = 60_000) {
    const timeout = AbortSignal.timeout(timeoutMs);
    while (!this.output.includes(text)) {
      if (timeout.aborted || this.child.exitCode !== null || this.child.signalCode !== null)
        throw new Error(`waited in vain for '${text}'; it said:\n${this.output}`);
      await new Promise((proceed) => setTimeout(proceed, 50));
    }
  }
}

/**
 * The room's programs as `./dev play` runs them, from the moment of their start.
 * @param {{port: number, options?: string[], serveOptions?: string[], scene?: string, env?: object, prefix?: string[]}} more
 *   options of play itself; prefix: words before its command
 */
export function startPlay(
  t,
  { port, options = [], serveOptions = quick, scene = scenePath, env = {}, prefix = [] },
) {
  const args = ['--port', String(port), '--scene', scene, ...options, '--', ...serveOptions];
  const [command, ...words] = [...prefix, process.execPath, join(root, 'tools/play.mjs')];
  return new Program(t, 'play', command, [...words, ...args], env);
}

/** The whole room, ready to be joined. */
export async function play(t, serveOptions = quick, scene = scenePath) {
  const port = await freePort();
  await startPlay(t, { port, serveOptions, scene }).says(`ready http://127.0.0.1:${port}\n`);
  return { url: `http://127.0.0.1:${port}` };
}

/**
 * Signaling alone; `serve` starts a render server for it.
 * @param {{scene?: string, options?: string[], host?: string, servePrefix?: string[]}} [more]  another scene file for the
 *   pages, more arguments, the address to listen on, words before the render server's command
 */
export async function signaling(
  t,
  { scene = scenePath, options = [], host = '127.0.0.1', servePrefix = [] } = {},
) {
  const port = await freePort();
  const folder = mkdtempSync(join(tmpdir(), 'lichtveld-e2e-'));
  const token = join(folder, 'token');
  writeFileSync(token, 'a-secret-for-tests\n', { mode: 0o600 });
  const client = join(root, 'web-client/dist');
  const files = ['--token-file', token, '--client', client, '--scene', scene, ...options];
  const args = [join(root, 'signaling/main.js'), '--host', host, '--port', String(port), ...files];
  const secure = options.includes('--tls-cert') ? 's' : '';
  const relay = async () => {
    const program = new Program(t, 'signaling', process.execPath, args);
    await program.says('signaling listens on');
    return program;
  };
  const first = await relay();
  t.after(() => rmSync(folder, { recursive: true }));
  const serveArgs = [
    'serve',
    '--scene',
    scenePath,
    '--signaling',
    `ws${secure}://${host}:${port}/server`,
    '--token-file',
    token,
  ];
  return {
    url: `http${secure}://${host}:${port}`,
    /** The arguments that name signaling's files. */
    files,
    /** The running relay, and a way to start another in its place. */
    first,
    relay,
    serve: (...more) => {
      const bind = host === '127.0.0.1' ? ['--bind', host] : [];
      const [command, ...words] = [...servePrefix, executable];
      return new Program(t, 'server', command, [...words, ...serveArgs, ...bind, ...quick, ...more]);
    },
  };
}
