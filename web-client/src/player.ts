import { Controls } from './controls';
import { Frames } from './frames';
import type { Knowledge } from './knowledge';
import { MapDecoder } from './map_decoder';
import { LightPanel } from './light_panel';
import { Lights } from './lights';
import { Receiver, followLights, type Lighting } from './protocol';
import type { Room } from './room';
import { fetchScene, type SceneFile } from './scene_file';
import { Session, type SessionEvents, type State } from './session';
import type { Role, SceneOffer } from './signaling';
import type { MapStatistics } from './statistics';
import { joinToken } from './ticket';
import type { View } from './view';

/** Somebody in the room, player or watcher: brings what comes from the server into the room and onto the page. */
export class Player {
  readonly #scene: Promise<SceneFile>;
  readonly #session: Session;
  #receiver = new Receiver();
  readonly #lights: Lights;
  readonly #lightPanel: LightPanel;
  /** The next role is the first one after a connection was made. */
  #joinedAnew = false;
  readonly #maps = new MapDecoder({
    onPicture: (picture, map) => {
      this.room.setMap(picture);
      this.statistics.count(map.bytes.size, picture.width, picture.height, performance.now());
    },
    onBroken: () => this.#refuse('a map that cannot be decoded'),
  });

  constructor(
    private readonly room: Room,
    private readonly view: View,
    private readonly statistics: MapStatistics,
    private readonly known: Knowledge,
  ) {
    this.#lights = new Lights(room, (text) => this.#session.send(text));
    this.#lightPanel = new LightPanel(this.#lights);
    this.#scene = this.#fetchScene();
    this.#session = new Session(this.#sessionEvents());
    this.#listenToThePage();
    this.#drawOnDemand();
  }

  #fetchScene(): Promise<SceneFile> {
    const source = { url: '/scene.glb', token: joinToken(location.hash) };
    const scene = fetchScene(source, this.room.surfaces, (reason, pause) => {
      this.known.error = reason;
      this.view.missScene({ reason, retryAt: performance.now() + pause });
    });
    void scene.then((file) => {
      this.view.missScene(undefined);
      this.room.show(file);
    });
    return scene;
  }

  #sessionEvents(): SessionEvents {
    return {
      hasScene: async (offer: SceneOffer) => {
        const file = await this.#scene;
        return offer.sha256 === undefined || offer.sha256 === file.sha256;
      },
      onState: (state, detail) => this.#stand(state, detail),
      onRelay: (there) => this.view.missRelay(!there),
      onGreeting: ({ name }) => {
        this.known.name = name;
        this.view.call(name);
      },
      onRole: (role) => this.#play(role),
      onData: (data) => this.#take(data),
    };
  }

  #stand(state: State, detail: { reason: string; retryAt?: number }): void {
    if (state === 'live' && this.known.state !== 'silent') {
      this.#joinedAnew = true;
      this.#receiver = new Receiver();
      this.statistics.restart();
      this.room.settle();
      this.#session.send(followLights);
    }
    this.known.state = state;
    if (detail.reason) this.known.error = detail.reason;
    this.view.stand(state, detail);
  }

  #play({ cube, players, watchers }: Role): void {
    const before = this.known.role?.cube;
    const changed = cube !== before;
    const lost = before && !cube ? (this.#joinedAnew ? 'away' : 'returned') : undefined;
    this.#joinedAnew = false;
    this.known.role = { cube, players, watchers };
    this.view.showRole(this.known.role, changed, lost);
    if (changed) this.room.mark(cube);
  }

  #take(data: string | ArrayBuffer): void {
    const received = this.#receiver.take(data);
    if (received?.kind === 'map') void this.#maps.take(received);
    else if (received?.kind === 'refused') this.#refuse(received.reason);
    else if (received?.kind === 'lights') this.#takeLights(received);
    else if (received?.kind === 'places') this.room.setPlaces((this.known.places = received.places));
  }

  #takeLights({ lights, sky }: Lighting): void {
    this.room.setSky(sky);
    this.known.lights = lights;
    this.#lights.take(lights);
    this.#lightPanel.show(lights);
  }

  /** True if there is one to switch. */
  #switch(light: number | undefined): boolean {
    if (light === undefined || !this.known.role?.cube) return false;
    this.#lights.toggle(light);
    return true;
  }

  #refuse(reason: string): void {
    this.statistics.refused += 1;
    this.known.error = reason;
  }

  #listenToThePage(): void {
    addEventListener('resize', () => this.room.resize());
    // Another link for the same page: it may lead to another seat.
    addEventListener('hashchange', () => location.reload());
    addEventListener('pagehide', () => this.#session.leave());
    // Out of the back/forward cache the page goes on where it was, without having been loaded.
    addEventListener('pageshow', ({ persisted }) => persisted && this.#session.comeBack());
    setInterval(() => this.view.showFacts(this.statistics), 250);
  }

  #drawOnDemand(): void {
    const controls = new Controls(
      this.view.canvas,
      this.room,
      {
        onStep: (direction) => this.#session.send(direction),
        onSwitch: () => this.#switch(this.#lights.nearest(this.room.ownPlace())),
        onTap: (x, y) => this.#switch(this.#lights.at(x, y)),
        onUse: () => this.view.hintUsed(),
      },
      this.view.arrowButtons,
    );
    const frames = new Frames((ms) => {
      controls.advance(ms);
      if (this.room.draw(ms)) this.view.placeLabel(this.room.ownLabelPlace());
    });
    this.room.onInvalid = () => frames.ask();
    this.room.invalidate();
  }
}
