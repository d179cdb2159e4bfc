#!/usr/bin/env node
/**
 * How many light maps a second reach two players who share this machine with the render server, and where its time
 * goes. Starts a room as `./dev play` does and two browsers, each a program of its own with one player; both hold arrow
 * keys, then nobody does. Prints a table of what each browser got, of the processor time of every program (100 % = one
 * core), and of the render server's stages. Needs the built render server and web client and a Chromium; `./dev
 * bench-room` sees to that and to a network in which they meet.
 *
 *   tests/e2e/own_network.sh node tools/bench_room.mjs [--seconds 10] [--players 2] [--scene assets/room.glb] [-- SERVE OPTIONS]
 */
import { readFileSync, readdirSync } from 'node:fs';
import { setTimeout as sleep } from 'node:timers/promises';
import { parseArgs } from 'node:util';
import { launch } from '../tests/e2e/browser.js';
import { play, roomPath } from '../tests/e2e/programs.js';

const split = process.argv.indexOf('--');
const serveOptions = split < 0 ? [] : process.argv.slice(split + 1);
const { values } = parseArgs({
  args: process.argv.slice(2, split < 0 ? undefined : split),
  options: {
    seconds: { type: 'string', default: '10' },
    players: { type: 'string', default: '2' },
    scene: { type: 'string', default: roomPath },
  },
});
const seconds = Number(values.seconds);
const count = Number(values.players);
if (!(seconds > 0) || !(Number.isInteger(count) && count > 0)) {
  console.error('bench-room: --seconds wants a number above 0, --players a whole one');
  process.exit(2);
}
/** Milliseconds after which a player turns round: before the cube is stopped by a wall. */
const turnMs = 400;
/** Processor time is counted in these [s]; Linux's USER_HZ, the same everywhere. */
const tick = 0.01;

/** Seconds of processor time so far of every process, by what it does. */
function processorTimes() {
  const times = {};
  for (const pid of readdirSync('/proc').filter((name) => /^\d+$/.test(name))) {
    try {
      const line = readFileSync(`/proc/${pid}/cmdline`, 'utf8');
      const words = line.split('\0');
      const stat = readFileSync(`/proc/${pid}/stat`, 'utf8').split(') ')[1].split(' ');
      const type = /--type=([\w-]+)/.exec(line)?.[1];
      const name = words[0].includes('chrom')
        ? `browsers: ${type ?? 'main'}`
        : words[1] === 'serve'
          ? 'render server'
          : words[1]?.endsWith('signaling/main.js')
            ? 'signaling'
            : undefined;
      if (name) times[name] = (times[name] ?? 0) + (Number(stat[11]) + Number(stat[12])) * tick;
    } catch {
      // It has just ended.
    }
  }
  return times;
}

/** Of each stage of a map: how often it has run so far, and for how many seconds. */
async function stages(url) {
  const text = await (await fetch(`${url}/metrics`)).text();
  const of = {};
  for (const [, what, name, value] of text.matchAll(
    /^lichtveld_server_stage_(\w+)_total\{stage="(\w+)"\} (.+)$/gm,
  ))
    (of[name] ??= { runs: 0, seconds: 0 })[what] = Number(value);
  return of;
}

const received = (players) => Promise.all(players.map(async (player) => (await player.knows()).mapsReceived));

async function measure(what, { url, players }, act) {
  const [work, maps] = [await stages(url), await received(players)];
  const [processors, start] = [processorTimes(), performance.now()];
  await act();
  const [after, mapsAfter, took] = [
    processorTimes(),
    await received(players),
    (performance.now() - start) / 1000,
  ];
  console.log(`${what}, ${took.toFixed(1)} s`);
  for (const [n, now] of mapsAfter.entries())
    console.log(`  player ${n + 1}: ${((now - maps[n]) / took).toFixed(1)} maps a second`);
  for (const [name, time] of Object.entries(after)) {
    const percent = (100 * (time - (processors[name] ?? 0))) / took;
    if (percent > 0.05) console.log(`  ${name}: ${percent.toFixed(1)} %`);
  }
  for (const [name, { runs, seconds }] of Object.entries(await stages(url))) {
    const before = work[name] ?? { runs: 0, seconds: 0 };
    const [times, ms] = [runs - before.runs, 1000 * (seconds - before.seconds)];
    if (times > 0) console.log(`  stage ${name}: ${times} times, ${(ms / times).toFixed(1)} ms each`);
  }
}

/** Holds an arrow key, and turns round before a wall comes. */
async function hold(player, end) {
  const { keyboard } = player.page;
  for (
    let key = 'ArrowLeft';
    performance.now() < end;
    key = key === 'ArrowLeft' ? 'ArrowRight' : 'ArrowLeft'
  ) {
    await keyboard.down(key);
    await sleep(turnMs);
    await keyboard.up(key);
  }
}

const afterwards = [];
const t = {
  after: (task) => afterwards.push(task),
  diagnostic: (text) => process.env.VERBOSE && console.error(text),
};
try {
  const { url } = await play(t, serveOptions, values.scene);
  const players = [];
  for (let n = 0; n < count; ++n) {
    const browser = await launch(t);
    players.push(await browser.open(url));
    await players[n].lit(60_000);
  }
  await sleep(2000);
  const room = { url, players };
  const endTime = () => performance.now() + 1000 * seconds;
  await measure('player 1 holds arrow keys', room, () => hold(players[0], endTime()));
  await measure('all players do', room, () => Promise.all(players.map((player) => hold(player, endTime()))));
  await sleep(3000);
  await measure('nobody does', room, () => sleep(1000 * seconds));
} finally {
  for (const task of afterwards.reverse()) await task();
}
