import { execFileSync } from 'node:child_process';
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
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

/** A browser that ends with the test. Its pages come from `open`, each with a fresh profile. */
export async function launch(t) {
  const browser = await chromium.launch({
    executablePath: findBrowser(),
    args: [
      '--no-sandbox',
      '--disable-quic',
      '--no-first-run',
      '--disable-background-networking',
      '--disable-component-update',
      '--disable-sync',
      // Loopback is left out of WebRTC's addresses, and local ones are hidden behind names, unless asked otherwise.
      '--allow-loopback-in-peer-connection',
      '--disable-features=WebRtcHideLocalIpsWithMdns',
    ],
  });
  t.after(() => browser.close());
  return { open: (url, options) => Player.open(browser, url, options) };
}

/** One page in the room. */
export class Player {
  errors = [];

  static async open(browser, url, options = { viewport: { width: 960, height: 640 } }) {
    const context = await browser.newContext(options);
    const player = new Player(await context.newPage());
    await player.page.goto(url);
    return player;
  }

  constructor(page) {
    this.page = page;
    page.on('pageerror', (error) => this.errors.push(error));
    page.on('console', (message) => message.type() === 'error' && this.errors.push(new Error(message.text())));
  }

  /** What the page knows: state, role, places, mapsReceived, error. */
  knows() {
    return this.page.evaluate(() => {
      const { state, role, places, mapsReceived, mapsRefused, error } = window.lichtveld;
      return { state, role, places, mapsReceived, mapsRefused, error };
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
      await this.page.waitForTimeout(50);
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

  /** The light map once it has not changed for a second. */
  async settledMap() {
    let last = await this.map();
    for (let quiet = 0, tries = 0; quiet < 5; ++tries) {
      if (tries > 100) throw new Error('the light map does not come to rest');
      await this.page.waitForTimeout(200);
      const map = await this.map();
      quiet = Buffer.compare(map.data, last.data) === 0 ? quiet + 1 : 0;
      last = map;
    }
    return last;
  }

  /** Presses a key again and again until `done(knows())`. */
  async press(key, done) {
    for (let i = 0; i < 200; ++i) {
      await this.page.keyboard.press(key);
      await this.page.waitForTimeout(60);
      if (done(await this.knows())) return;
    }
    throw new Error(`pressing ${key} leads nowhere; the page knows ${JSON.stringify(await this.knows())}`);
  }

  /** Saves what the page looks like as build/e2e/NAME.png and answers with its pixels. */
  async screenshot(name) {
    mkdirSync(shots, { recursive: true });
    return PNG.sync.read(await this.page.screenshot({ path: join(shots, `${name}.png`) }));
  }
}
