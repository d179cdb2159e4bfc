/**
 * One who means harm, as a process of its own: node attacker.js ATTACK PORT ADDRESS. It goes on until it is killed, and
 * comes again as soon as it is thrown out. Stopped (SIGSTOP), it keeps whatever it has got hold of.
 */
import { connect } from 'node:net';
import { setImmediate as soon } from 'node:timers/promises';

const [, , attack, port, localAddress] = process.argv;
const head = (path) => `GET ${path} HTTP/1.1\r\nHost: 127.0.0.1\r\n`;

const join =
  `${head('/client')}Connection: Upgrade\r\nUpgrade: websocket\r\n` +
  'Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n';

const attacks = {
  /** Very many requests at once on each of a few connections. */
  pipelined: { connections: 5, sends: `${head('/')}\r\n`.repeat(5000) },
  /** Large answers that are never read. */
  unread: { connections: 1100, sends: `${head('/scene.glb')}\r\n`, deaf: true },
  /** Headers that never end. */
  'half-sent': { connections: 1100, sends: `${head('/')}X-Slow: ` },
  /** Joining, whatever the answer, and again. */
  rejoining: {
    connections: 50,
    sends: join,
    leaves: true,
  },
  /** Joining, and messages and pings without end. */
  flooding: { connections: 32, sends: join, floods: true },
};

/** A message and a ping, masked by zeros. */
const frames = Buffer.concat([
  Buffer.from([0x81, 0x82, 0, 0, 0, 0, 0x7b, 0x7d]),
  Buffer.from([0x89, 0x80, 0, 0, 0, 0]),
]);
const flood = Buffer.alloc(1024 * 1024, frames);

const { connections, sends, deaf = false, leaves = false, floods = false } = attacks[attack];

async function again() {
  for (;;) {
    await new Promise((gone) => {
      const socket = connect({ host: '127.0.0.1', port: Number(port), localAddress });
      socket.on('error', () => {});
      socket.on('close', gone);
      socket.on('connect', () => socket.write(sends));
      const pump = () => {
        while (!socket.destroyed && socket.write(flood));
      };
      if (floods) socket.on('connect', pump).on('drain', pump);
      if (deaf) {
        socket.pause();
        // Who does not read does not hear that it was thrown out, but is told when it writes.
        const probe = setInterval(() => socket.write('\r\n'), 300);
        socket.on('close', () => clearInterval(probe));
      } else {
        // As soon as there is an answer it has what it wanted, a refusal or a place, and goes for the next.
        socket.on('data', () => leaves && socket.destroy());
      }
    });
    await soon();
  }
}

for (let i = 0; i < connections; ++i) again();
console.log('attacking');
