/** How long it takes from a move until the light that shows it is here: there, computing, and back. */
import { setTimeout as sleep } from 'node:timers/promises';

/** Once around a rectangle of 4 x 6 steps: no place comes twice in a lap, so a map's places tell which move it shows. */
const lap = ['Up', 'Right', 'Down', 'Left'].flatMap((side, n) => Array(n % 2 ? 4 : 6).fill(`Arrow${side}`));
/** Milliseconds from step to step. A lap, 1.2 s, is the longest lag that can be told. */
const paceMs = 60;
const directions = { up: [0, 1], down: [0, -1], left: [-1, 0], right: [1, 0] };

/**
 * Runs in the page before its own scripts: writes down in `window.diary` when each move was sent, and when each map had
 * come in whole and with which places. Places that come between two parts of a map are still those of the map before it.
 */
export function keepDiary() {
  window.diary = { moves: [], maps: [] };
  window.RTCPeerConnection = class extends RTCPeerConnection {
    createDataChannel(...options) {
      const channel = super.createDataChannel(...options);
      let told, shown;
      channel.addEventListener('message', ({ data }) => {
        if (typeof data !== 'string') shown ??= told;
        else if (!data.endsWith('_TRANSFER_COMPLETE')) told = data;
        else {
          window.diary.maps.push({ at: performance.now(), places: shown });
          shown = undefined;
        }
      });
      const send = channel.send.bind(channel);
      channel.send = (direction) => {
        window.diary.moves.push({ at: performance.now(), direction });
        send(direction);
      };
      return channel;
    }
  };
}

/**
 * Walks the first cube around for a while.
 * @param {import('./browser.js').Player} player  of cube 1, its page with `keepDiary`
 * @returns {Promise<{intervals: number[], lags: number[]}>}  milliseconds between maps; and of each map, since the newest
 *   move that it shows was sent
 */
export async function walk(player, durationMs) {
  const home = (await player.knows()).places[0];
  await player.page.evaluate(() => (window.diary.moves.length = window.diary.maps.length = 0));
  const end = Date.now() + durationMs;
  for (let i = 0; Date.now() < end; ++i) {
    const next = Date.now() + paceMs;
    await player.page.keyboard.press(lap[i % lap.length]);
    await sleep(Math.max(0, next - Date.now()));
  }
  await sleep(2 * lap.length * paceMs);
  const { moves, maps } = await player.page.evaluate(() => window.diary);

  const [x, y] = [0, 1];
  let at = [0, 0];
  const places = moves.map(({ direction }) =>
    (at = at.map((v, axis) => v + directions[direction][axis])).join(),
  );
  const told = maps.map((map) => map.places.split('/')[0].split('!').map(Number));
  const step = Math.min(
    ...told.map((place) => Math.abs(place[y] - home.y)).filter((distance) => distance > 1e-3),
  );
  const inSteps = (place) =>
    [place[x] - home.x, place[y] - home.y].map((v) => Math.round(v / step) + 0).join();
  const lags = maps.flatMap((map, n) => {
    const move = places.findLastIndex((place, m) => place === inSteps(told[n]) && moves[m].at < map.at);
    return move < 0 ? [] : [map.at - moves[move].at];
  });
  return { intervals: maps.slice(1).map((map, n) => map.at - maps[n].at), lags };
}
