import nodeDataChannel from 'node-datachannel';
import { WebSocket } from 'ws';

/** Milliseconds after which it offers anew, as pages do: seldom a handshake hangs between the two WebRTC libraries. */
const patienceMs = 3000;

/** A client of protocol v1 that is no browser, written from docs/protocol.md: joins, and joins again when it has to. */
export class CrowdMember {
  /** The newest role message. */
  role;
  /** Called for each light map that has come whole. */
  onMap = () => {};
  /** Called when the relay does not let it in. */
  onRefused = () => {};
  #socket;
  #connection;
  #channel;
  #patience;
  /** Candidates that have overtaken the answer. */
  #early = [];
  #server;

  /** @param {string} url  of the page  @param {() => void} onRole */
  constructor(url, onRole = () => {}) {
    this.onRole = onRole;
    this.#socket = new WebSocket(`${url.replace('http', 'ws')}/client`);
    this.#socket.on('error', () => this.onRefused());
    this.#socket.on('message', (data) => this.#take(JSON.parse(String(data))));
  }

  /** Ends everything, as a closed page does. */
  leave() {
    this.#socket.removeAllListeners('message');
    this.#socket.close();
    this.#dropConnection();
  }

  #send(message) {
    this.#socket.send(JSON.stringify({ id: this.#server, ...message }));
  }

  #take(message) {
    if (message.type === 'welcome' && message.server) {
      this.#server = message.server;
      this.#join();
    } else if (message.type === 'waiting') {
      this.role = undefined;
      this.#dropConnection();
    } else if (message.type === 'answer') {
      this.#connection?.setRemoteDescription(message.description, 'answer');
      for (const early of this.#early.splice(0)) this.#addCandidate(early);
    } else if (message.type === 'candidate') {
      if (this.#connection?.remoteDescription()) this.#addCandidate(message);
      else this.#early.push(message);
    } else if (message.type === 'role') {
      this.role = message;
      this.onRole();
    }
  }

  #addCandidate({ candidate, mid }) {
    try {
      this.#connection?.addRemoteCandidate(candidate, mid);
    } catch {
      // The connection has just ended, or needs no more of them.
    }
  }

  #join() {
    this.#dropConnection();
    this.#early = [];
    const connection = new nodeDataChannel.PeerConnection('member', {
      iceServers: [],
      bindAddress: '127.0.0.1',
    });
    this.#connection = connection;
    this.#patience = setTimeout(() => this.role || this.#join(), patienceMs);
    connection.onLocalDescription((description) => this.#send({ type: 'offer', description }));
    connection.onLocalCandidate((candidate, mid) => this.#send({ type: 'candidate', candidate, mid }));
    // Messages that nobody takes would fill the library's queue, and then block its threads.
    this.#channel = connection.createDataChannel('lichtveld');
    this.#channel.onMessage((message) => message === 'PNG_TRANSFER_COMPLETE' && this.onMap());
  }

  /** @param {'left' | 'right' | 'up' | 'down'} direction  of its cube */
  move(direction) {
    this.#channel.sendMessage(direction);
  }

  #dropConnection() {
    clearTimeout(this.#patience);
    this.#connection?.close();
    this.#connection = undefined;
  }
}
