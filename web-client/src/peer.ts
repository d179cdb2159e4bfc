import { channelLabel } from './protocol';
import { Routes } from './routes';
import type { Incoming, Outgoing } from './signaling';

export interface PeerEvents {
  onSignal(message: Outgoing): void;
  onOpen(): void;
  onData(data: string | ArrayBuffer): void;
  /** Once, when the connection cannot be made or has ended. */
  onClose(): void;
}

export interface PeerOptions {
  /** The render server's id at the relay. */
  readonly server: string;
  readonly iceServers: RTCIceServer[];
  /** The secret of an earlier stay, to get back what we had. */
  readonly session: string | undefined;
}

/** One WebRTC connection to one render server: we make the channel and offer, the server answers. */
export class Peer {
  /** The render server's id at the relay; another one after the relay or the server's line to it was new. */
  server: string;
  readonly routes: Routes;
  readonly madeAt = performance.now();
  readonly #connection: RTCPeerConnection;
  readonly #channel: RTCDataChannel;
  /** Candidates may overtake the answer; they are of no use before it. */
  readonly #early: RTCIceCandidateInit[] = [];
  #ended = false;
  #foundWayAt: number | undefined;

  constructor(
    { server, iceServers, session }: PeerOptions,
    private readonly events: PeerEvents,
  ) {
    this.server = server;
    this.routes = new Routes(
      iceServers.some(({ urls }) => [urls].flat().some((url) => /^turns?:/i.test(url))),
    );
    this.#connection = new RTCPeerConnection({ iceServers });
    this.#channel = this.#connection.createDataChannel(channelLabel);
    this.#channel.binaryType = 'arraybuffer';
    this.#channel.onopen = () => events.onOpen();
    this.#channel.onmessage = ({ data }) => events.onData(data as string | ArrayBuffer);
    this.#channel.onclose = () => this.#end();
    this.#connection.onconnectionstatechange = () => {
      if (this.#connection.connectionState === 'failed') this.#end();
    };
    this.#connection.oniceconnectionstatechange = () => {
      if (['connected', 'completed'].includes(this.#connection.iceConnectionState))
        this.#foundWayAt ??= performance.now();
    };
    this.#connection.onicecandidate = ({ candidate }) => {
      if (!candidate?.candidate) return;
      this.routes.addOwn(candidate.candidate);
      events.onSignal({
        id: server,
        type: 'candidate',
        candidate: candidate.candidate,
        mid: candidate.sdpMid ?? '0',
      });
    };
    this.#offer(session).catch(() => this.#end());
  }

  /** When a way to the server was found, by performance.now(); the channel still has to open. */
  get foundWayAt(): number | undefined {
    return this.#foundWayAt;
  }

  /** Takes an answer or a candidate of the server. */
  async take(message: Incoming): Promise<void> {
    if (this.#ended) return;
    try {
      if (message.type === 'answer') {
        this.routes.addTheirs(message.description);
        await this.#connection.setRemoteDescription({ type: 'answer', sdp: message.description });
        for (const candidate of this.#early.splice(0)) await this.#connection.addIceCandidate(candidate);
      } else if (message.type === 'candidate') {
        this.routes.addTheirs(message.candidate);
        const candidate = { candidate: message.candidate, sdpMid: message.mid };
        if (this.#connection.remoteDescription) await this.#connection.addIceCandidate(candidate);
        else if (this.#early.length < 64) this.#early.push(candidate);
      }
    } catch (error) {
      // One bad candidate does not spoil the others; a bad answer ends in a time-out of the session.
      console.warn('lichtveld: a signaling message was of no use:', error);
    }
  }

  send(text: string): void {
    if (this.#channel.readyState === 'open') this.#channel.send(text);
  }

  close(): void {
    this.#ended = true;
    this.#connection.close();
  }

  async #offer(session: string | undefined): Promise<void> {
    const offer = await this.#connection.createOffer();
    await this.#connection.setLocalDescription(offer);
    const description = offer.sdp ?? '';
    this.events.onSignal({ id: this.server, type: 'offer', description, ...(session && { session }) });
  }

  #end(): void {
    if (this.#ended) return;
    this.close();
    this.events.onClose();
  }
}
