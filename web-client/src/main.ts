import { Controls } from './controls';
import { exposeForDebugging } from './debug';
import { decodeMap } from './light_map';
import { Receiver, type Place } from './protocol';
import { Room } from './room';
import { fetchScene } from './scene_file';
import { Session, type State } from './session';
import type { Role, SceneOffer } from './signaling';
import { MapStatistics } from './statistics';
import { View } from './view';

/** Milliseconds that a frame counts for at most: what a page that was stopped has missed is not made up for. */
const longestFrameMs = 100;
/** Milliseconds that the first frame after a pause counts for. */
const usualFrameMs = 20;

const view = new View();
const statistics = new MapStatistics();

/** What the page knows of the session; read by `window.lichtveld`. */
export interface Knowledge {
  state: State;
  error: string;
  role: Role | undefined;
  places: readonly Place[];
}
const known: Knowledge = { state: 'connecting', error: '', role: undefined, places: [] };

function start(room: Room): void {
  let receiver = new Receiver();
  let decoding = false;
  let next: Blob | undefined;

  const refuse = (reason: string) => {
    statistics.refused += 1;
    known.error = reason;
  };

  const takeNext = (): Blob | undefined => {
    const map = next;
    next = undefined;
    return map;
  };
  /** Decodes one map at a time; of those that come meanwhile only the newest counts. */
  const showMap = async (png: Blob): Promise<void> => {
    next = png;
    if (decoding) return;
    decoding = true;
    for (let map = takeNext(); map; map = takeNext()) {
      try {
        const picture = await decodeMap(map);
        room.setMap(picture);
        statistics.count(map.size, picture.width, picture.height, performance.now());
      } catch {
        refuse('a map that cannot be decoded');
      }
    }
    decoding = false;
  };

  const scene = fetchScene('/scene.glb', room.surfaces, (reason, pause) => {
    known.error = reason;
    view.missScene({ reason, retryAt: performance.now() + pause });
  });
  void scene.then((file) => {
    view.missScene(undefined);
    room.show(file);
  });

  const session = new Session({
    async hasScene(offer: SceneOffer) {
      const file = await scene;
      return offer.sha256 === undefined || offer.sha256 === file.sha256;
    },
    onState(state, detail) {
      if (state === 'live') {
        receiver = new Receiver();
        statistics.restart();
        room.settle();
      }
      known.state = state;
      if (detail.reason) known.error = detail.reason;
      view.stand(state, detail);
    },
    onRole({ cube, players, watchers }) {
      const role = { cube, players, watchers };
      const changed = role.cube !== known.role?.cube;
      known.role = role;
      view.showRole(role, changed);
      if (changed) room.mark(role.cube);
    },
    onData(data) {
      const received = receiver.take(data);
      if (received?.kind === 'map') void showMap(received.png);
      else if (received?.kind === 'refused') refuse(received.reason);
      else if (received?.kind === 'places') room.setPlaces((known.places = received.places));
    },
  });

  const controls = new Controls(
    view.canvas,
    room,
    { onStep: (direction) => session.send(direction), onUse: () => view.hintUsed() },
    view.arrowButtons,
  );
  addEventListener('resize', () => room.resize());
  addEventListener('pagehide', () => session.leave());
  // Out of the back/forward cache the page goes on where it was, without having been loaded.
  addEventListener('pageshow', ({ persisted }) => persisted && session.comeBack());
  setInterval(() => view.showFacts(statistics), 250);

  // Frames are asked for only while there is something new to draw.
  let last = 0;
  let asked = false;
  const frame = (now: number): void => {
    asked = false;
    const ms = Math.min(Math.max(0, now - last), longestFrameMs);
    last = now;
    controls.advance(ms);
    if (room.draw(ms)) view.placeLabel(room.ownLabelPlace());
  };
  room.onInvalid = () => {
    if (asked) return;
    asked = true;
    last = Math.max(last, performance.now() - usualFrameMs);
    requestAnimationFrame(frame);
  };
  room.invalidate();
  exposeForDebugging(known, statistics, room);
}

const unsupported = (reason: string): void => {
  known.state = 'unsupported';
  known.error = reason;
  view.stand('unsupported', { reason });
};

if (typeof RTCPeerConnection === 'undefined') {
  unsupported('WebRTC is missing or switched off, and the light comes over it');
} else {
  let room: Room | undefined;
  try {
    room = new Room(view.canvas);
  } catch {
    unsupported('WebGL 2 is missing or switched off; look whether hardware acceleration is on in the settings');
  }
  if (room) start(room);
}
