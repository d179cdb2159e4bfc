import { exposeForDebugging } from './debug';
import { nothingKnown } from './knowledge';
import { Player } from './player';
import { Room } from './room';
import { MapStatistics } from './statistics';
import { View } from './view';

const view = new View();
const known = nothingKnown();

const unsupported = (reason: string): void => {
  known.state = 'unsupported';
  known.error = reason;
  view.stand('unsupported', { reason });
};

function makeRoom(): Room | undefined {
  if (typeof RTCPeerConnection === 'undefined') {
    unsupported('WebRTC is missing or switched off, and the light comes over it');
    return undefined;
  }
  try {
    return new Room(view.canvas);
  } catch {
    unsupported('WebGL 2 is missing or switched off; look whether hardware acceleration is on in the settings');
    return undefined;
  }
}

const room = makeRoom();
if (room) {
  const statistics = new MapStatistics();
  new Player(room, view, statistics, known);
  exposeForDebugging(known, statistics, room);
}
