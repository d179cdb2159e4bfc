/** A stock Firefox, driven by WebDriver BiDi. */
import { accessSync, constants, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import puppeteer from 'puppeteer-core';
import { Player } from './browser.js';
import { Program } from './programs.js';

const executable = process.env.FIREFOX || '/usr/bin/firefox-esr';

/** Why there is none here; false if there is one: to be given as a test's `skip`. */
export function firefoxMissing() {
  try {
    accessSync(executable, constants.X_OK);
    accessSync('/usr/bin/Xvfb', constants.X_OK);
    return false;
  } catch (error) {
    // A snap lives in a world of its own, without our namespaces and files.
    return `${error.message}: install firefox-esr and xvfb, or name a Firefox that is no snap with FIREFOX=/path/to/it`;
  }
}

/** A screen that nobody sees: WebGL wants one. @returns {Promise<string>} its name */
async function screen(t) {
  const xvfb = new Program(t, 'Xvfb', 'Xvfb', ['-displayfd', '1', '-nolisten', 'tcp', '-screen', '0', '1280x800x24']);
  await xvfb.says('\n');
  return `:${xvfb.stdout.trim()}`;
}

/**
 * One page in a Firefox that ends with the test. It runs in the test's own network, where Puppeteer finds it; that one
 * has to have an address and a default route, as Firefox never offers loopback to its peers.
 */
export async function openInFirefox(t, url) {
  // Its profile is made by Puppeteer; caches and the like go here instead of into somebody's home.
  const home = mkdtempSync(join(tmpdir(), 'lichtveld-e2e-firefox-'));
  const DISPLAY = await screen(t);
  const browser = await puppeteer.launch({
    browser: 'firefox',
    executablePath: executable,
    headless: false,
    env: { ...process.env, DISPLAY, HOME: home, LIBGL_ALWAYS_SOFTWARE: '1' },
  });
  t.after(async () => {
    await browser.close();
    rmSync(home, { recursive: true, force: true });
  });
  const page = await browser.newPage();
  const player = new Player(page);
  await page.goto(url);
  return { player, version: await browser.version() };
}
