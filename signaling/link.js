#!/usr/bin/env node
/** Makes a link by which somebody may join a room that was started with the same --join-secret-file. */
import { parseArgs } from 'node:util';
import { JoinTokens, isName } from './join_tokens.js';
import { InputError, parsing, readJoinSecret } from './options.js';

const usage = `node signaling/link.js --join-secret-file FILE --url https://HOST[:PORT] [options]
  --join-secret-file FILE   the secret that signaling was started with
  --url URL                 where the page is
  --role player|watcher     player: gets a cube when one is free; watcher: never does (player)
  --name NAME               what the page and the log call him
  --hours NUMBER            for which the link lets in; who is in may stay (24)
Prints the link. Whoever has it may join: send it as you would a password.
Exit codes: 0 fine, 2 bad usage or input.`;

/** @type {(url: string) => boolean} */
function isPage(url) {
  try {
    return /^https?:$/.test(new URL(url).protocol);
  } catch {
    return false;
  }
}

function readOptions() {
  const { values } = parsing(
    () =>
      parseArgs({
        options: {
          'join-secret-file': { type: 'string' },
          url: { type: 'string' },
          role: { type: 'string', default: 'player' },
          name: { type: 'string' },
          hours: { type: 'string', default: '24' },
          help: { type: 'boolean', short: 'h' },
        },
      }),
    usage,
  );
  if (values.help) {
    console.log(usage);
    process.exit(0);
  }
  const { 'join-secret-file': secretFile, url, role, name } = values;
  if (!secretFile || !url)
    throw new InputError(`--${secretFile ? 'url' : 'join-secret-file'} is missing\n${usage}`);
  if (!isPage(url))
    throw new InputError(`--url ${url} is no address of a page: it looks like https://room.example.org`);
  if (role !== 'player' && role !== 'watcher')
    throw new InputError(`--role is player or watcher, not '${role}'`);
  if (name !== undefined && !isName(name))
    throw new InputError(`--name has 1 to 40 letters, digits, spaces and any of . _ ' -; '${name}' has not`);
  const hours = Number(values.hours);
  if (!(hours > 0 && hours <= 24 * 365))
    throw new InputError(`--hours wants a number up to ${24 * 365}, not '${values.hours}'`);
  return { secret: readJoinSecret(secretFile), url, ticket: /** @type {const} */ ({ role, name, hours }) };
}

try {
  const { secret, url, ticket } = readOptions();
  const link = new URL('/', url);
  link.hash = `join=${await new JoinTokens(secret).sign(ticket)}`;
  console.log(link.href);
} catch (error) {
  console.error(`link: ${error instanceof InputError ? error.message : (error.stack ?? error)}`);
  process.exit(error instanceof InputError ? 2 : 1);
}
