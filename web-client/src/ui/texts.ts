// Texts of the page for people: the English ones of what is loaded at first. texts_de.ts has the German ones, which have to have the same
// keys. Parts that are loaded later have tables of their own, *_texts.ts; messages of the connection are in net/net_texts.ts. What the
// server says by itself (parameters, refusals) is English.
import type { LevelName } from "../../client/codec/layers";
import type { FidelityName } from "../../client/codec/fidelity";
import type { LessonTool } from "../../client/codec/lesson";
import type { RoleName, TeamName } from "../../client/codec/people";
import type { TierName } from "../scene/drawing/quality";
import type { FloaterKindName } from "../../client/codec/floaters";
import type { PresetName } from "../scene/light/daylight";
import type { LookName } from "../scene/looks/looks";
import { translation } from "../net/translation";
import { fixed, length, plain } from "./numbers";
import type { PictureSide, SideWhat, SideWhere } from "./side_names";
import type { ToolName } from "./tools";

/** A row of the panel: its label, and what it does, as a tooltip. */
export interface Row {
  label: string;
  help: string;
}

/** A scene's title and line in this language; the server's own where a scene is not listed. */
type SceneTexts = Record<string, { title: string; description: string }>;

const kOrdinals = new Intl.PluralRules("en", { type: "ordinal" });
const kOrdinalEndings: Partial<Record<Intl.LDMLPluralRule, string>> = { one: "st", two: "nd", few: "rd" };
const ordinal = (place: number): string => `${place}${kOrdinalEndings[kOrdinals.select(place)] ?? "th"}`;

const kWhere: Record<PictureSide, string> = { left: "on the left", middle: "in the middle", right: "on the right" };
const kSides: Record<SideWhat, string> = { beach: "beach", sea: "open sea", rocks: "rocky shore", quay: "quay", wall: "wall", end: "open end" };
const kTeams: Record<TeamName, string> = { red: "Red", blue: "Blue" };

const kEnglish = {
  // Languages
  languages: { en: "English", de: "Deutsch" },
  language: { label: "Language", help: "Language of this page. The browser keeps the choice; the page is loaded again." } as Row,
  unknownLanguage: (wanted: string, known: string) => `lang=${wanted}: this page has no such language; it has ${known}.`,
  scenes: {} as SceneTexts,

  // index.html, by its attributes data-text, data-label and data-tip
  page: {
    water: "The water. Click or tap it to splash; drag to draw in it. The arrow keys move a cursor, Enter uses the tool there, and the question mark shows all keys.",
    connecting: "connecting", retry: "Try now", otherRooms: "Rooms of this server", lookKey: "Colours of the water",
    sound: "Sound", soundTip: "Sound of the water (key M)", panel: "Controls", effects: "In the water",
    splash: "Splash", wave: "Wave", spawn: "New boat",
    view: "View", camera: "Camera", start: "Start", startTip: "The view that one begins with", side: "Side", sideTip: "View from the side",
    overview: "Overview", overviewTip: "Overview of the whole scene", below: "Below", belowTip: "View from below the surface", boat: "Boat", boatTip: "View from behind my boat",
    boats: "Boats", helm: "Helm of my boat", remove: "Remove my boat", tools: "Tools", effectsBox: "Splash and wave", soundBox: "Sound and vibration",
    people: "People", peopleList: "People in the room", room: "Room, for everybody", pause: "Pause", step: "Step", restart: "Restart",
    more: "More", keys: "Keys …", parameters: "Parameters", numbers: "Numbers",
    simTime: "Simulation time", rtf: "Real-time factor", netFps: "Network frames/s", displayFps: "Display frames/s", latency: "Latency", delay: "Playout delay",
    detail: "Detail", particles: "Particles", breaking: "Breaking surface", volumeError: "Volume error", exchanged: "Water into spray / back",
    substeps: "Substeps per tick", stepMs: "Step", health: "Watchdog", device: "Device", lastAck: "Last acknowledged", passes: "Time per pass",
    toolBar: "Tools for the water", kinds: "Objects to drop", bin: "Take out", binTip: "Takes the object out of the water: drop it here, or press Delete.",
  },

  // The card
  paused: "paused",
  states: {
    connecting: "connecting", live: "live", opening: (room: string) => `opening the room ${room}`,
    retrying: (inS: number) => `retrying in ${inS < 1 ? fixed(inS, 1) : Math.round(inS)} s`, refused: (why: string) => `refused: ${why}`,
  },
  roomsHere: "Rooms of this server:",

  // What others did, as a line over the water
  somebody: "Somebody",
  pausedBy: (name: string) => `${name} paused the water.`,
  resumedBy: (name: string) => `${name} lets the water run again.`,
  speedBy: (name: string, speed: number) => `${name} set the speed to ${plain(speed)} ×.`,
  startedAgainBy: (name: string) => `${name} started the scene again.`,
  otherScene: (title: string) => `The scene is now ${title}.`,

  // What the server does by itself
  restarts: "The server restarts; this page connects again by itself.",
  moves: "The water moves to another server; this page follows by itself.",

  // What failed
  notNow: "The lesson does not allow this at present.",
  failed: (what: string, why: string) => `${what}: ${why}`,
  noWebGl: "This page needs WebGL 2 with floating-point targets, and this browser offers none. Turn on hardware acceleration, or try a current Firefox, Chrome, Edge or Safari.",
  contextLost: "The graphics context was lost. The picture returns when the browser restores it.",
  noConnection: (state: string) => `No connection to the water: ${state}`,
  parentCannotAct: (why: string) => `The page around this one cannot act: ${why}`,
  noEffects: "this water takes no splashes and waves",
  shareFailed: "The card could not be loaded: try again when the server can be reached.",
  soundFailed: (why: string) => `Sound could not be loaded (${why}); try again.`,

  // Commands, in lines about a refusal
  commands: {
    numbered: (id: number) => `Command ${id}`, request: (kind: string) => `Request "${kind}"`, splash: "Splash", wave: "Wave", paddle: "Paddle", stone: "Stone", object: "Object",
    removeObject: "Remove object", stroke: "Stroke", hold: "Hold", helm: "Helm", boat: "Boat", newBoat: "New boat", takeBoat: (id: number) => `Take boat ${id}`,
    removeBoat: (id: number) => `Remove boat ${id}`, parameter: "Parameter", pause: "Pause", resume: "Resume", step: "Step", reset: "Reset", speed: "Speed",
    scene: (name: string) => `Scene ${name}`, fidelity: (level: string) => `Fidelity ${level}`, lesson: "Lesson", team: "Team", mute: "Mute",
    race: "Race", ball: "Ball game", endGame: "End of the game", removeObjects: "Remove all objects", gauge: "Gauge", removeGauge: "Remove gauge",
  },

  gaugesNotLoaded: "The gauges' names and chart could not be loaded; reload the page.",

  // The hint of the first visit
  movesObjectsByMouse: "Drag an object to move it; the wheel turns it.",
  movesObjectsByTouch: "Drag an object to move it; a second finger turns it.",
  turnsByMouse: "The right button turns the view.",
  turnsByTouch: "Two fingers turn the view.",

  // Picture, film, fullscreen
  actions: "Picture, sound and link",
  share: "Share a link to what you see, also as a QR code",
  fullscreen: "Fullscreen",
  leaveFullscreen: "Leave fullscreen",
  picture: "Save a picture",
  film: (longestS: number) => `Film the water (at most ${longestS} s)`,
  endFilm: "End the film and save it",
  fullscreenFailed: (why: string) => `Fullscreen was refused by the browser (${why}).`,
  pictureFailed: (why: string) => `The picture was not saved (${why}); try again.`,
  pixels: (width: number, height: number) => `${width} x ${height} pixels`,
  filmNeedsHttps: "Browsers encode films only on pages opened by https:// or from this machine.",
  filmHasNoCodec: "This browser encodes neither H.264, VP9 nor VP8; try a current Chrome, Edge, Firefox or Safari.",
  filmFailed: (why: string) => `The film was not saved (${why}); try again.`,

  // Sides of the water
  /** `where`: as seen from the first view; undefined for the only side of its kind. */
  side: (what: SideWhat, where: SideWhere | undefined) => (where ? `${where} side: ${kSides[what]}` : kSides[what]),
  openSide: "the open side",
  direction: "a direction",

  // The panel
  hideControls: "Hide controls",
  showControls: "Show controls",
  automatic: "automatic",
  on: "on",
  off: "off",
  none: "none",
  light: { label: "Light", help: "Light on this page. Automatic: the scene's hour, darker and grey in a storm of the room." } as Row,
  lights: { automatic: "automatic", noon: "noon", "golden hour": "golden hour", dusk: "dusk", moon: "moon", storm: "storm" } as Record<PresetName, string>,
  byHour: "by hour",
  hour: { label: "Hour", help: "Hour of the day on this page." } as Row,
  look: { label: "Look", help: "What the water shows, on this page only: its natural look, or data in colours." } as Row,
  /** `title`: of the colour bar. */
  looks: {
    natural: { label: "natural", help: "Water as light shows it.", title: "" },
    height: { label: "height", help: "Elevation of the surface over the still water.", title: "Surface height" },
    velocity: { label: "velocity", help: "Vertical velocity of the surface: the derivative by time of the streamed elevations. Positive where it rises.", title: "Vertical surface velocity" },
    breaking: {
      label: "breaking criterion",
      help: "Rate of rise of the surface, as a mean over 3 × 3 streamed samples, over √(g d) with the still depth d. The server lets the wave break above 0.65; once it breaks there, it continues down to a threshold that falls to 0.15 (Kennedy et al. 2000). How long it has been breaking is not streamed: between 0.15 and 0.65 the colour does not tell whether it breaks.",
      title: "Rate of rise / √(g d)",
    },
    foam: { label: "foam", help: "Streamed foam on the surface: the share of white.", title: "Foam on the surface" },
    speed: { label: "particle speed", help: "Magnitude of each particle's streamed velocity. The wave's surface is drawn plain, below the particles that it carries.", title: "Particle speed" },
    density: {
      label: "particle density",
      help: "Streamed density of each particle over the density at rest, from 0.5 to 1.1; values beyond are shown as these. Pressure is not streamed, and the 256 steps of the density are too coarse to compute it from.",
      title: "Density / rest density",
    },
    thesis: { label: "plain (thesis)", help: "As in the thesis: particles as spheres, whiter where their density is low, and the surface with Phong's lighting. The surface lies below the particles that it carries.", title: "" },
  } as Record<LookName, Row & { title: string }>,
  rangeFollows: "The range follows the values.",
  rangeFixed: "The range is fixed.",
  valueAt: (title: string, value: string, place: string) => `${title}: ${value} at ${place}`,

  boat: {
    mine: { label: "My boat", help: "The boat that you steer and that the boat view follows." } as Row,
    length: { label: "Boat length", help: "Length of the next boat." } as Row,
    throttle: { label: "Throttle", help: "Engine: ahead to the right, astern to the left. Keys W and S or up and down in the boat view." } as Row,
    rudder: { label: "Rudder", help: "Rudder. Keys A and D or left and right in the boat view." } as Row,
    keys: "In the boat view: arrow keys or WASD.",
    noneFree: "no free boat",
    choice: (id: number, lengthM: number, isFree: boolean) => `Boat ${id} (${fixed(lengthM, 1)} m)${isFree ? ", free" : ""}`,
  },

  toolSize: { label: "Tool size", help: "Size of the chosen tool; 100 % suits this water." } as Row,
  toolStrength: { label: "Tool strength", help: "Strength of the chosen tool." } as Row,
  /** `does`: said before it is used. */
  tools: {
    finger: { label: "Finger", does: "Drag to draw in the water; tap for a splash." },
    splash: { label: "Splash", does: "Tap for a splash; hold for a larger one." },
    paddle: { label: "Paddle", does: "Drag to send a wave that way; a longer drag makes it higher." },
    rain: { label: "Rain", does: "Drag to move the rain; tap for a cloud of 8 seconds." },
    calm: { label: "Calm", does: "Drag to smooth the water; tap to calm a place for 4 seconds." },
    float: { label: "Float", does: "Tap to drop an object; drag one to move it, the wheel or a second finger turns it; hold one still to take it out." },
    throw: { label: "Throw", does: "Flick to throw a stone that way, faster the quicker the flick; tap to toss one there." },
  } as Record<ToolName, { label: string; does: string }>,
  toolKey: (does: string, key: number) => `${does} (key ${key})`,
  drag: { label: "Drag", help: "What a drag on the water does. The right button, or two fingers, turn the view where a drag draws." } as Row,
  drags: { draw: "uses the tool", turn: "turns the view" },
  objects: "Objects",
  kinds: { crate: "Crate", ball: "Ball", barrel: "Barrel", plank: "Plank", duck: "Duck", buoy: "Buoy", raft: "Raft", stone: "Stone" } as Record<FloaterKindName, string>,
  kindTip: "What a tap drops (keys , and .)",
  removeObjects: "Remove all objects",
  removeObjectsTip: "Takes all objects out of the water, for everybody.",
  density: { label: "Density", help: "Density of the next objects over that of the water: balsa 0.15, oak 0.7, ice 0.92, stone 2.6. At 0 each kind has its own." } as Row,
  densityAs: (ratio: number, like: string) => `${fixed(ratio, 2)}, as ${like}`,
  densities: { own: "what suits its kind", balsa: "balsa", oak: "oak", ice: "ice", stone: "stone" },

  splashRadius: { label: "Splash radius", help: "Radius of the disc that a splash pushes down." } as Row,
  splashDepth: { label: "Splash depth", help: "Distance that a splash pushes the surface down." } as Row,
  waveHeight: { label: "Wave height", help: "Height of the crest at the start." } as Row,
  waveLength: { label: "Wave length", help: "Width of the crest at the start." } as Row,
  waveDirection: { label: "Direction", help: "Direction in which the wave travels: 0 is +x, 90 is +z." } as Row,
  waveFrom: { label: "Wave from", help: "Side at which the wave starts. The open side is the one with the deepest water." } as Row,
  waveShape: { label: "Wave shape", help: "Breaking: a steep front. Swell: a symmetric crest." } as Row,
  shapes: { breaking: "breaking", swell: "swell" },

  volume: { label: "Volume", help: "Volume of the sound on this page." } as Row,
  tone: { label: "Wave tone", help: "The elevation of the water at one place as a note." } as Row,
  toneRange: { label: "Its range", help: "The elevation that raises the note by an octave." } as Row,
  toneMiddle: "middle of the view",
  toneGauge: (name: string) => `gauge ${name}`,
  octave: (octaveM: number) => `±${octaveM < 1 ? `${Math.round(100 * octaveM)} cm` : `${plain(octaveM)} m`} = ±1 octave`,
  toneRest: "The water's rest level is A (440 Hz).",
  soundWaits: "The browser lets the page sound after the next click or key.",
  vibration: { label: "Vibration", help: "Splashes, objects and your boat are felt on phones and gamepads that can." } as Row,

  roles: { viewer: "viewer", player: "player", operator: "operator" } as Record<RoleName, string>,
  myName: "My name",
  token: { label: "Token", help: "A token gives a role: viewer, player or operator. Without a token you are a guest." } as Row,
  join: "Join with this name",
  people: (count: number) => (count > 1 ? `People (${count})` : "People"),
  you: "you",
  away: "away",
  boatsOf: (ids: readonly number[]) => `boat ${ids.join(", ")}`,
  moreWatching: (count: number) => `and ${count} more watching`,

  oneTick: "One tick",
  pauseFirst: "Pause first",
  speed: { label: "Speed", help: "Simulated seconds per second, for everybody in the room." } as Row,
  scene: { label: "Scene", help: "Changes the scene for everybody in the room." } as Row,
  building: (scene: string) => `Building the water of ${scene}: until then this one continues.`,
  runsSlow: (percent: number) => `Time runs at ${percent} % of the wanted speed: the server's machine cannot keep up.`,
  coarserCostsLess: "A coarser fidelity costs less.",
  fidelity: { label: "Fidelity", help: "How finely the water is simulated, for everybody in the room. The water continues." } as Row,
  fidelities: { draft: "draft", balanced: "balanced", fine: "fine", reference: "reference" } as Record<FidelityName, string>,
  buildingLevel: (wanted: string, now: string) => `Building the water at ${wanted}: until then it continues at ${now}.`,
  levelCosts: "What each level costs",
  levelCost: (level: string, cost: string) => `At ${level}, a simulated second takes this server ${cost}. The error was not measured for this scene.`,
  levelCostAndError: (level: string, cost: string, error: string, measuredOn: string) => `At ${level}, a simulated second takes this server ${cost}; the height of the water is ${error} off (measured on ${measuredOn}).`,
  levelHead: ["level", "time per second, predicted", "error"],
  detail: { label: "Detail", help: "Level of detail that this page gets. Automatic: the finest that the link and this device can carry." } as Row,
  levels: { coarse: "coarse", medium: "medium", fine: "fine", full: "full" } as Record<LevelName, string>,
  levelLimits: { none: "", choice: "", link: " (slow link)", device: " (busy device)" },
  quality: { label: "Quality", help: "Quality of the drawing, on this page only. Automatic: the best with which pictures come fast enough." } as Row,
  qualities: { minimal: "minimal", low: "low", medium: "medium", high: "high", highest: "highest" } as Record<TierName, string>,
  automaticNow: (tier: string) => `automatic: ${tier}`,
  drawsInSoftware: "This browser draws without graphics hardware.",
  resolutionLowered: (percent: number) => `Resolution lowered to ${percent} %, to keep up.`,
  volumeUnits: (count: bigint) => `${count} units`,
  healthy: "healthy",
  nonfinite: (count: bigint) => `${count} non-finite values`,
  escaped: (count: bigint) => `${count} escaped particles`,
  recovered: (count: bigint) => `${count} recoveries`,
  commandAt: (id: number, tick: number) => `command ${id} at tick ${tick}`,

  // The state of the water, for screen readers
  words: {
    connected: "Connected to the water.", paused: "The water is paused.", runs: "The water runs.", calm: "The water is calm.",
    waves: (heightM: number) => `Waves of about ${length(heightM)} from trough to crest.`,
    storms: { none: "The storm is over.", some: "A storm blows.", strong: "A strong storm blows." },
    own: (side: PictureSide) => `Your hand is in the water ${kWhere[side]}.`,
    draws: (name: string, side: PictureSide) => `${name} draws in the water ${kWhere[side]}.`,
  },

  // Games and lessons
  teams: kTeams,
  teamOf: (team: TeamName) => `Team ${team}`,
  goalOf: (team: TeamName) => `${kTeams[team]} goal`,
  score: (red: number, blue: number) => `Red ${red} : ${blue} Blue`,
  ordinal,
  left: "left",
  lapOf: (lap: number, count: number) => `lap ${lap} of ${count}`,
  go: "Go!",
  race: (laps: number) => `Race: ${laps} ${laps === 1 ? "lap" : "laps"}`,
  ballTo: (goals: number) => `Ball into the other goal: first to ${goals}`,
  ballTask: (team: TeamName, goal: TeamName) => `Team ${team}: push the ball into the ${goal} goal`,
  buoyTask: (buoy: number) => `Steer to buoy ${buoy}, the yellow one`,
  goalFor: (team: TeamName) => `Goal for ${team}!`,
  teamWins: (team: TeamName, more: number, fewer: number) => `${kTeams[team]} wins ${more} : ${fewer}`,
  drawn: "The game has ended in a draw",
  raceEnded: "The race has ended",
  winnerLeft: "The winner has left",
  wins: (name: string, team: TeamName | undefined, time: string | undefined) => `${name} wins${team ? ` for ${team}` : ""}${time ? ` in ${time}` : ""}`,
  finished: (place: number, count: number, time: string) => `Finished ${ordinal(place)} of ${count}, ${time}`,
  standing: (place: number, count: number, progress: string) => `${ordinal(place)} of ${count}, ${progress}`,
  lessonTools: { finger: "Finger", splash: "Splash", wave: "Wave", rain: "Rain", float: "Objects", throw: "Throw", boat: "Boat" } as Record<LessonTool, string>,
  teacherPaused: "The teacher has paused the pads.",
  teacherMuted: "The teacher has muted you for now.",
  notHandedOut: (tool: string) => `${tool}: not handed out in this lesson.`,
};

export type Texts = typeof kEnglish;

/** In the language that was loaded before. */
export const kTexts: Texts = { ...kEnglish, ...translation.page };
