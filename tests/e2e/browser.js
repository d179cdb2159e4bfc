import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { chromium } from 'playwright-core';
import { PNG } from 'pngjs';
import { root } from './programs.js';

const shots = join(root, 'build/e2e');

function findBrowser() {
  if (process.env.CHROMIUM) return process.env.CHROMIUM;
  for (const name of ['chromium', 'google-chrome', 'chromium-browser']) {
    try {
      return execFileSync('sh', ['-c', `command -v ${name}`], { encoding: 'utf8' }).trim();
    } catch {
      // Not this one.
    }
  }
  throw new Error('no browser found: install chromium, or name one with CHROMIUM=/path/to/it');
}

const quiet = [
  '--no-sandbox',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
];
/** Loopback is left out of WebRTC's addresses, and local ones are hidden behind names, unless asked otherwise. */
const onOneMachine = ['--allow-loopback-in-peer-connection', '--disable-features=WebRtcHideLocalIpsWithMdns'];

/**
 * A browser that WebRTC on this machine alone works in, or as people have it in a network of its own.
 * @param {string[]} [prefix]  words before its command: in which network it runs
 */
export async function launchBrowser(prefix = []) {
  if (prefix.length === 0)
    return chromium.launch({ executablePath: findBrowser(), args: [...quiet, ...onOneMachine] });
  // Playwright starts one file, and speaks with it through pipes that pass through.
  const folder = mkdtempSync(join(tmpdir(), 'lichtveld-browser-'));
  const executablePath = join(folder, 'browser');
  const command = [...prefix, findBrowser()].map((word) => `'${word}'`).join(' ');
  writeFileSync(executablePath, `#!/bin/sh\nexec ${command} "$@"\n`, { mode: 0o755 });
  try {
    return await chromium.launch({ executablePath, args: quiet });
  } finally {
    rmSync(folder, { recursive: true });
  }
}

/**
 * A browser that ends with the test. Its pages come from `open`, each with a fresh profile; none may ever throw.
 */
export async function launch(t, prefix = []) {
  const browser = await launchBrowser(prefix);
  const players = [];
  t.after(async () => {
    await browser.close();
    assert.deepEqual(
      players.flatMap(({ thrown }) => thrown),
      [],
      'a page threw',
    );
  });
  return {
    /** @param {import('playwright-core').BrowserContextOptions & {init?: () => void}} [options]  see Player.open */
    async open(url, options) {
      const player = await Player.open(browser, url, options);
      players.push(player);
      return player;
    },
  };
}

/** One page in the room, Playwright's or Puppeteer's. */
export class Player {
  /** What the page's scripts threw and nobody caught, and what its console reports as errors. */
  thrown = [];
  errors = [];

  /** `init` runs in the page before its own scripts. */
  static async open(browser, url, { init, ...options } = {}) {
    const context = await browser.newContext({ viewport: { width: 960, height: 640 }, ...options });
    if (init) await context.addInitScript(init);
    const player = new Player(await context.newPage());
    await player.page.goto(url);
    return player;
  }

  constructor(page) {
    this.page = page;
    page.on('pageerror', (error) => this.thrown.push(error));
    page.on('console', (message) => message.type() === 'error' && this.errors.push(message.text()));
  }

  /** What the page knows: state, role, places, lights, mapsReceived, error. */
  knows() {
    return this.page.evaluate(() => {
      const { state, role, places, lights, mapsReceived, mapsRefused, error } = window.lichtveld;
      return { state, role, places, lights, mapsReceived, mapsRefused, error };
    });
  }

  /** Waits until `accepts(knows())`. */
  async until(what, accepts, timeoutMs = 20_000) {
    const end = Date.now() + timeoutMs;
    for (;;) {
      const known = await this.knows();
      if (accepts(known)) return known;
      if (Date.now() > end)
        throw new Error(`waited in vain until ${what}; the page knows ${JSON.stringify(known)}`);
      await sleep(50);
    }
  }

  /** In the room, lit, and told its role. */
  lit(timeoutMs = 20_000) {
    return this.until(
      'lit',
      ({ state, mapsReceived, role }) => state === 'live' && mapsReceived > 0 && role,
      timeoutMs,
    );
  }

  /** The newest light map: {width, height, data (RGBA)}, row 0 where v is 0. */
  async map() {
    const { width, height, data } = await this.page.evaluate(() => {
      const map = window.lichtveld.map();
      return { width: map.width, height: map.height, data: Array.from(map.data) };
    });
    return { width, height, data: Uint8Array.from(data) };
  }

  /** Waits until `accepts(map())`. */
  async untilMap(what, accepts, timeoutMs = 20_000) {
    const end = Date.now() + timeoutMs;
    for (;;) {
      const map = await this.map();
      if (accepts(map)) return map;
      if (Date.now() > end) throw new Error(`waited in vain for a light map in which ${what}`);
      await sleep(200);
    }
  }

  /** The light map once it has not changed for some time. */
  async settledMap(quietMs = 1000) {
    let last = await this.map();
    let since = Date.now();
    const end = since + 20 * quietMs;
    while (Date.now() - since < quietMs) {
      if (Date.now() > end) throw new Error('the light map does not come to rest');
      await sleep(200);
      const map = await this.map();
      if (Buffer.compare(map.data, last.data) !== 0) since = Date.now();
      last = map;
    }
    return last;
  }

  /** Presses a key again and again until `done(knows())`. */
  async press(key, done) {
    for (let i = 0; i < 200; ++i) {
      await this.page.keyboard.press(key);
      await sleep(60);
      if (done(await this.knows())) return;
    }
    throw new Error(`pressing ${key} leads nowhere; the page knows ${JSON.stringify(await this.knows())}`);
  }

  /** Ends the page's process, so that it can say no good-bye. */
  async crash() {
    const crashed = this.page.waitForEvent('crash');
    const session = await this.page.context().newCDPSession(this.page);
    session.send('Page.crash').catch(() => {});
    await crashed;
  }

  /** Saves what the page looks like as build/e2e/NAME.png and answers with its pixels. */
  async screenshot(name) {
    mkdirSync(shots, { recursive: true });
    return PNG.sync.read(await this.page.screenshot({ path: join(shots, `${name}.png`) }));
  }
}
