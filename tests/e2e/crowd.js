#!/usr/bin/env node
/**
 * Many clients in one process, which can be killed. Started by fork(); says "joined" when COUNT of them have, answers
 * "roles" with the members' roles, {play: MILLISECONDS} with what lies between the light maps of the first one, who moves
 * so long, and {visits: N} when so many more have joined and left.
 *   node crowd.js URL COUNT
 */
import { CrowdMember } from './crowd_member.js';

const [url, count] = process.argv.slice(2);
const members = [];
const join = async () => {
  const member = new CrowdMember(url);
  members.push(member);
  while (!member.role) await new Promise((proceed) => setTimeout(proceed, 10));
};
// One by one at first, so that the players are the first members; then some at a time.
while (members.length < Number(count)) {
  const together = members.length < 2 ? 1 : Math.min(10, Number(count) - members.length);
  await Promise.all(Array.from({ length: together }, join));
}

/** Joins and leaves; false when it was refused, as too many have come in a second. */
const visit = () =>
  new Promise((settle) => {
    const end = (joined) => {
      clearTimeout(patience);
      member.leave();
      settle(joined);
    };
    const member = new CrowdMember(url, () => end(true));
    member.onRefused = () => setTimeout(() => end(false), 100);
    const patience = setTimeout(() => end(false), 1500);
  });
async function visits(count) {
  let left = count;
  const one = async () => {
    while (left > 0) if (await visit()) left -= 1;
  };
  await Promise.all(Array.from({ length: 3 }, one));
}

/** The first member moves to and fro for so many milliseconds; those between one light map and the next. */
async function mapIntervals(duration) {
  const times = [];
  const [player] = members;
  player.onMap = () => times.push(performance.now());
  const end = performance.now() + duration;
  for (let step = 0; performance.now() < end; step += 1) {
    player.move(step % 2 ? 'left' : 'right');
    await new Promise((proceed) => setTimeout(proceed, 30));
  }
  player.onMap = () => {};
  return times.slice(1).map((time, i) => time - times[i]);
}

process.on('message', async (question) => {
  if (question === 'roles') return process.send?.(members.map(({ role }) => role));
  if (question.play) return process.send?.(await mapIntervals(question.play));
  await visits(question.visits);
  process.send?.('left');
});
process.send?.('joined');
