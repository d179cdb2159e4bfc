import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { fileURLToPath } from 'node:url';

const program = process.env.LICHTVELD_SIGNALING_MAIN || fileURLToPath(new URL('../main.js', import.meta.url));

/** A signaling process that ends with the test. */
export function run(t, args, { file = program, nodeOptions = /** @type {string[]} */ ([]) } = {}) {
  const child = spawn(process.execPath, [...nodeOptions, file, ...args], {
    stdio: ['ignore', 'pipe', 'pipe'],
  });
  t.after(() => child.kill('SIGKILL'));
  const output = { out: '', err: '' };
  child.stdout.on('data', (chunk) => (output.out += chunk));
  child.stderr.on('data', (chunk) => (output.err += chunk));
  const exited = once(child, 'close').then(([code]) => ({ code, ...output }));
  return {
    child,
    exited,
    output,
    /** The one that it listens on. */
    async port() {
      while (!output.out.includes('listens on')) await once(child.stdout, 'data');
      return Number(output.out.match(/:(\d+)\n/)?.[1]);
    },
  };
}

export const argsOf = (site, port = 0) => [
  '--port',
  String(port),
  '--token-file',
  site.token,
  '--client',
  site.client,
  '--scene',
  site.scene,
];
