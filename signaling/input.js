import { readFileSync } from 'node:fs';

/** What the caller gave is wrong: the message alone tells what, and what to try. Programs end with 2. */
export class InputError extends Error {}

/** @type {(text: string, name: string, max: number) => number} */
export function toNumber(text, name, max) {
  if (/^\d{1,9}$/.test(text) && Number(text) <= max) return Number(text);
  throw new InputError(`${name} wants a whole number from 0 to ${max}, not '${text}'`);
}

/** @template T @param {string} what  the option @param {string} path @param {() => T} read @returns {T} */
export function reading(what, path, read) {
  try {
    return read();
  } catch (error) {
    throw new InputError(
      `cannot read the ${what} ${path}: ${error.code ?? error.message}; give another with --${what}`,
    );
  }
}

/**
 * The only word of a file, by the render server's idea of white space. It is a secret: no message shows any of it.
 * @param {string} what  the option
 * @param {string} path
 * @param {number} [minLength]
 */
export function readSecret(what, path, minLength = 1) {
  const make = `make one with: openssl rand -hex 32 > ${path}`;
  const text = reading(what, path, () => readFileSync(path, 'utf8'));
  const words = text.split(/[ \t\n\v\f\r]+/).filter((word) => word !== '');
  if (words.length === 0) throw new InputError(`the ${what} ${path} is empty; ${make}`);
  if (words.length > 1)
    throw new InputError(
      `the ${what} ${path} has white space within: it holds one long random word; ${make}`,
    );
  if (words[0].length < minLength)
    throw new InputError(
      `the ${what} ${path} has ${words[0].length} characters, fewer than the ${minLength} that keep it from being guessed; ${make}`,
    );
  return words[0];
}
