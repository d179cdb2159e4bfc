#!/usr/bin/env node
/** Prints one link into a room that wants tokens. */
import { parseArgs } from 'node:util';
import { InputError, readSecret } from './input.js';
import { createJoinTokens, isName, maxNameLength, minSecretLength, seats } from './join_tokens.js';
import { defaultLimits } from './limits.js';

/** A year: a link that outlives its room cannot be taken back, but by another secret. */
const maxHours = 8760;

const usage = `node signaling/link.js --join-secret-file FILE --url https://room.example.org [options]
  --join-secret-file FILE  the secret that signaling is started with
  --url URL                the page
  --role player|watcher    what its bearer may be (player)
  --name NAME              shown to the others, 1 to ${maxNameLength} characters
  --hours NUMBER           that it is good for (24), up to ${maxHours}
Exit codes: 0 printed, 2 bad usage or input.`;

async function main() {
  let values;
  try {
    ({ values } = parseArgs({
      options: {
        'join-secret-file': { type: 'string' },
        url: { type: 'string' },
        role: { type: 'string', default: 'player' },
        name: { type: 'string' },
        hours: { type: 'string', default: '24' },
        help: { type: 'boolean', short: 'h' },
      },
    }));
  } catch (error) {
    throw new InputError(`${error.message}\n${usage}`);
  }
  if (values.help) return usage;
  const { url: address, role, name, hours } = values;
  const file = values['join-secret-file'];
  if (!file) throw new InputError(`--join-secret-file is missing\n${usage}`);
  if (!address) throw new InputError(`--url is missing\n${usage}`);
  if (!seats.includes(role)) throw new InputError(`--role is player or watcher, not '${role}'`);
  if (name !== undefined && !isName(name))
    throw new InputError(`--name has 1 to ${maxNameLength} characters on one line, not '${name}'`);
  if (!/^\d{1,4}(\.\d+)?$/.test(hours) || Number(hours) <= 0 || Number(hours) > maxHours)
    throw new InputError(`--hours wants a number above 0 and up to ${maxHours}, not '${hours}'`);

  const url = toUrl(address);
  const tokens = createJoinTokens(readSecret('join-secret-file', file, minSecretLength), defaultLimits);
  // A fragment: a browser keeps it to itself, so it gets into no server's or proxy's log.
  url.hash = `join=${await tokens.sign({ role, name }, Number(hours))}`;
  return url.href;
}

/** @type {(text: string) => URL} */
function toUrl(text) {
  let url;
  try {
    url = new URL(text);
  } catch {
    url = undefined;
  }
  if (!url || !['http:', 'https:'].includes(url.protocol) || url.username || url.password)
    throw new InputError(`--url wants the page's address, such as https://room.example.org, not '${text}'`);
  return url;
}

main().then(console.log, (error) => {
  console.error(`link: ${error instanceof InputError ? error.message : (error.stack ?? error)}`);
  process.exit(error instanceof InputError ? 2 : 1);
});
