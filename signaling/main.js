#!/usr/bin/env node
import { createHash } from 'node:crypto';
import { InputError } from './input.js';
import { readOptions, usage } from './options.js';
import { startSignaling } from './server.js';

/** What to try when listening fails; these are the caller's input, not our fault. */
const listenErrors = {
  EADDRINUSE: 'is taken: end what listens there, or choose another with --port',
  EADDRNOTAVAIL: 'is not an address of this machine: choose another with --host',
  EACCES: 'needs privileges: choose a port above 1023 with --port',
  ENOTFOUND: 'is no known host: choose another with --host',
};

async function main() {
  const options = readOptions(process.argv.slice(2));
  if (!options) return console.log(usage);
  const log = (line) => console.error(`signaling: ${line}`);
  const signaling = await startSignaling({ ...options, log }).catch((error) => {
    const hint = listenErrors[error.code];
    throw hint ? new InputError(`port ${options.port} on ${options.host} ${hint}`) : error;
  });
  for (const signal of ['SIGINT', 'SIGTERM'])
    process.once(signal, () => signaling.close().then(() => process.exit(0)));
  const address = options.host.includes(':') ? `[${options.host}]` : options.host;
  log(`scene sha256 ${createHash('sha256').update(options.scene).digest('hex')}`);
  console.log(`signaling listens on ${options.tls ? 'https' : 'http'}://${address}:${signaling.port}`);
}

main().catch((error) => {
  console.error(`signaling: ${error instanceof InputError ? error.message : (error.stack ?? error)}`);
  process.exit(error instanceof InputError ? 2 : 1);
});
