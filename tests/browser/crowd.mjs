// Pads without a page: clients that steer boats in a game or draw in the water ten times per second, as a class does. Made from the npm
// packages `ws` and `protobufjs` of tests/wire and the files in proto/.
import { createRequire } from "node:module";

import { repository } from "./server.mjs";

const require = createRequire(`${repository}/tests/wire/`);
const WebSocket = require("ws");
const protobuf = require("protobufjs");

const kEveryMs = 100;
/** Values of GameKind and Team. */
const kRace = 1;
const kTeamRed = 1;
/** What a pad asks for: coarse frames at a low rate (web-client/src/pad/pad_page.ts). */
const kPadFrames = { maxRateHz: 10, packing: 1, level: "LEVEL_COARSE" };
/** The crowd's own eyes: boats and objects, plain. */
const kEyes = { maxRateHz: 20, packing: 0 };
/** bodies_fixed_28 and floaters_fixed_28 both begin with an id and a position [mm]. */
const kItemBytes = 28;
/** A boat pushes the ball from so far behind it. */
const kBehindM = 2.5;
const kNames = ["Ada", "Bo", "Chidi", "Dana", "Emil", "Farah", "Goro", "Hana", "Ines", "Jun", "Kofi", "Lena", "Milo", "Nora", "Omar", "Pia"];

function wireTypes() {
  const root = new protobuf.Root();
  root.resolvePath = (_, target) => (target.startsWith("google/") ? `${repository}/tests/wire/node_modules/protobufjs/${target}` : `${repository}/proto/${target.replace(/^.*proto\/(?=spindrift)/, "")}`);
  root.loadSync("spindrift/v1/wire.proto");
  return { client: root.lookupType("spindrift.v1.ClientMessage"), server: root.lookupType("spindrift.v1.ServerMessage") };
}

function placesIn(payload) {
  const places = new Map();
  // protobufjs gives a plain array where there are no bytes.
  if (payload.length === 0) return places;
  const view = new DataView(payload.buffer, payload.byteOffset, payload.byteLength);
  for (let at = 0; at + kItemBytes <= view.byteLength; at += kItemBytes)
    places.set(view.getUint32(at, true), { xM: view.getInt32(at + 4, true) / 1000, zM: view.getInt32(at + 12, true) / 1000, headingRad: (view.getInt16(at + 16, true) / 32767) * Math.PI });
  return places;
}

const away = (a, b) => Math.hypot(a.xM - b.xM, a.zM - b.zM);

class Pad {
  commandId = 0;
  personId = 0;
  boatId = 0;
  framesCount = 0;
  rejections = [];

  constructor(crowd, n, port) {
    this.crowd = crowd;
    this.n = n;
    this.socket = new WebSocket(`ws://127.0.0.1:${port}/ws`, "spindrift.v1");
    this.left = new Promise((done) => this.socket.on("close", (code, reason) => done(`${code} ${reason}`)));
    this.entered = new Promise((done, failed) => {
      this.socket.on("error", failed);
      this.socket.on("message", (data) => {
        const { welcome } = this.take(crowd.types.server.decode(data));
        if (welcome) done(this);
      });
    });
    this.socket.on("open", () => this.send({ hello: { version: { major: 1, minor: 7 }, client: "crowd", name: n < kNames.length ? kNames[n] : `Pad ${n + 1}` } }));
  }

  send(message) {
    this.socket.send(this.crowd.types.client.encode(this.crowd.types.client.fromObject(message)).finish());
  }

  command(action) {
    this.send({ command: { commandId: ++this.commandId, ...action } });
  }

  take(message) {
    const { crowd } = this;
    if (message.welcome) this.personId = message.welcome.personId;
    if (message.ack?.boatId) this.boatId = message.ack.boatId;
    if (message.reject) this.rejections.push(message.reject.message || message.reject.reason);
    if (message.frame) ++this.framesCount;
    // The first pad sees for all.
    if (this.n === 0) crowd.see(message);
    return message;
  }
}

export class Crowd {
  types = wireTypes();
  pads = [];
  /** Newest time of the simulation. */
  simTimeS = 0;
  #boats = new Map();
  #floaters = new Map();
  #course;
  #game;
  #teams = new Map();
  #timer;
  #turn = 0;

  /**
   * Lets pads enter a class.
   * @param {{port: number, boats: number, drawers: number, watches?: boolean}} what `boats` steer and `drawers` draw; `watches`: all also
   *   take the frames of a pad's page, as real ones do
   */
  static async open({ port, boats, drawers, watches = false }) {
    const crowd = new Crowd();
    // One after the other, so that the persons are in the order of the pads.
    for (let n = 0; n < boats + drawers; ++n) crowd.pads.push(await new Pad(crowd, n, port).entered);
    crowd.boatsCount = boats;
    crowd.pads[0].send({ subscribe: { layer: "LAYER_BODIES", ...kEyes } });
    crowd.pads[0].send({ subscribe: { layer: "LAYER_FLOATERS", ...kEyes } });
    if (watches) for (const pad of crowd.pads.slice(1)) for (const layer of ["LAYER_SURFACE", "LAYER_BODIES", "LAYER_FLOATERS"]) pad.send({ subscribe: { layer, ...kPadFrames } });
    return crowd;
  }

  see({ greeting, people, frame, game }) {
    if (greeting) this.#course = greeting.scene.course;
    if (people) this.#teams = new Map(people.people.map(({ personId, team }) => [personId, team]));
    if (game) this.#game = game.kind ? game : undefined;
    if (frame) this.simTimeS = frame.timeS;
    if (frame?.bodiesFixed28) this.#boats = placesIn(frame.payload);
    if (frame?.floatersFixed28) this.#floaters = placesIn(frame.payload);
  }

  /** Puts the boats on the grid. */
  launch() {
    for (const pad of this.pads.slice(0, this.boatsCount)) pad.command({ spawnBoat: { boat: {} } });
  }

  /** Plays from now on. */
  start() {
    this.#timer = setInterval(() => this.play(), kEveryMs);
  }

  /** One command of every pad. */
  play() {
    ++this.#turn;
    for (const pad of this.pads) pad.n < this.boatsCount ? this.#steer(pad) : this.#draw(pad);
  }

  async close() {
    clearInterval(this.#timer);
    for (const { socket } of this.pads) socket.close();
    await Promise.all(this.pads.map(({ left }) => left));
  }

  #steer(pad) {
    const boat = this.#boats.get(pad.boatId);
    const goal = boat && this.#goalOf(pad, boat);
    if (!goal) return;
    const turn = Math.atan2(goal.zM - boat.zM, goal.xM - boat.xM) - boat.headingRad;
    const errorRad = Math.atan2(Math.sin(turn), Math.cos(turn));
    pad.command({ controlBoat: { boatId: pad.boatId, throttleRatio: Math.abs(errorRad) > 1.2 ? 0.5 : 1 - 0.02 * (pad.n % 12), rudderRatio: Math.max(-1, Math.min(1, 1.6 * errorRad)) } });
  }

  /** The next mark; a position behind the ball, or the ball; undefined without a game. */
  #goalOf(pad, boat) {
    const game = this.#game;
    if (!game || !this.#course) return undefined;
    if (game.kind === kRace) {
      const racer = game.racers.find(({ personId }) => personId === pad.personId);
      const mark = this.#course.marks[racer?.nextMark ?? 0];
      return { xM: mark.xM + 0.6 * Math.sin(pad.n), zM: mark.zM + 0.6 * Math.cos(pad.n) };
    }
    const ball = this.#floaters.get(game.ballFloaterId);
    const { xM, zM } = this.#teams.get(pad.personId) === kTeamRed ? this.#course.blueGoal : this.#course.redGoal;
    if (!ball) return undefined;
    const toGoalM = Math.max(away({ xM, zM }, ball), 1e-3);
    const behind = { xM: ball.xM - (kBehindM * (xM - ball.xM)) / toGoalM, zM: ball.zM - (kBehindM * (zM - ball.zM)) / toGoalM };
    return away(boat, behind) > kBehindM ? behind : ball;
  }

  /** A circle of its own for each, drawn in strokes of ten points. */
  #draw(pad) {
    const turn = this.#turn;
    const angleRad = 0.25 * turn + pad.n;
    const [middleX, middleZ] = [-24 + ((pad.n * 11) % 49), -16 + ((pad.n * 7) % 33)];
    pad.command({ stroke: { strokeId: 1 + Math.floor(turn / 10), points: [{ timeS: (turn % 10) / 10, xM: middleX + 3 * Math.cos(angleRad), zM: middleZ + 3 * Math.sin(angleRad) }], ends: turn % 10 === 9 } });
  }
}
