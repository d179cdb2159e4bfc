import { createSocket } from 'node:dgram';

/** Numbers in [0, 1) that are the same in every run (mulberry32). */
function randomNumbers(seed) {
  let state = seed;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

/**
 * A UDP path to a server that delays and loses packets, both ways: whoever writes to `from` reaches `to`. A stand-in for
 * netem, which not every kernel has.
 * @param {{from: {address: string, port: number}, to: {address: string, port: number}, delayMs: number, loss: number}} path
 *   delayMs of each way, loss as a share
 */
export async function startSlowLine(t, { from, to, delayMs, loss }) {
  const random = randomNumbers(1);
  const sockets = [];
  const open = async (port) => {
    const socket = createSocket('udp4');
    sockets.push(socket);
    await new Promise((bound) => socket.bind(port, from.address, () => bound(undefined)));
    return socket;
  };
  t.after(() => sockets.forEach((socket) => socket.close()));
  const later = (send) => {
    if (random() >= loss) setTimeout(() => send(), delayMs);
  };
  const front = await open(from.port);
  /** Each client has a socket of its own towards the server, as behind a NAT. */
  const backs = new Map();
  front.on('message', (packet, client) => {
    const key = `${client.address}:${client.port}`;
    let back = backs.get(key);
    if (!back) {
      back = open(0).then((socket) => {
        socket.on('message', (answer) => later(() => front.send(answer, client.port, client.address)));
        return socket;
      });
      backs.set(key, back);
    }
    later(() => back.then((socket) => socket.send(packet, to.port, to.address)));
  });
}
