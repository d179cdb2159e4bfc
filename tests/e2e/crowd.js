#!/usr/bin/env node
/**
 * Many clients in one process, which can be killed. Started by fork(); answers each message with the members' roles.
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
process.on('message', () => process.send?.(members.map(({ role }) => role)));
process.send?.('joined');
