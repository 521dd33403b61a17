// The German texts of the page. Pads say "du" to children; the page addresses nobody where that reads well. Loaded where German is chosen.
import type { TeamName } from "../../client/codec/people";
import { kGermanNetTexts } from "../net/net_texts_de";
import type { translation } from "../net/translation";
import type { ClassTexts } from "./class_texts";
import type { FrontTexts } from "./front_texts";
import type { GaugeTexts } from "./gauge_texts";
import type { KeysTexts } from "./keys_texts";
import type { KioskTexts } from "./kiosk_texts";
import { fixed, length, plain } from "./numbers";
import type { PadTexts } from "./pad_texts";
import { kGermanScenes } from "./scene_texts_de";
import type { ShareTexts } from "./share_texts";
import type { PictureSide, SideWhat, SideWhere } from "./side_names";
import type { Texts } from "./texts";

const kSides: Record<SideWhat, string> = { beach: "Strand", sea: "offenes Meer", rocks: "felsiges Ufer", quay: "Kai", wall: "Wand", end: "offenes Ende" };
const kPictureSides: Record<PictureSide, string> = { left: "links", middle: "in der Mitte", right: "rechts" };
const kWhere: Record<SideWhere, string> = { left: "links", right: "rechts", near: "vorn", far: "hinten" };
const kTeams: Record<TeamName, string> = { red: "Rot", blue: "Blau" };
/** In front of "Tor" and after "das", "ins". */
const kTeamAdjectives: Record<TeamName, string> = { red: "rote", blue: "blaue" };

export const kGerman: Texts = {
  languages: { en: "English", de: "Deutsch" },
  language: { label: "Sprache", help: "Sprache dieser Seite. Der Browser merkt sich die Wahl; die Seite wird neu geladen." },
  unknownLanguage: (wanted, known) => `lang=${wanted}: Diese Sprache hat die Seite nicht; es gibt ${known}.`,
  scenes: kGermanScenes,

  page: {
    water: "Das Wasser. Klicken oder Tippen macht einen Platscher; Ziehen zeichnet hinein. Die Pfeiltasten bewegen eine Marke, die Eingabetaste benutzt dort das Werkzeug, und das Fragezeichen zeigt alle Tasten.",
    connecting: "verbindet", retry: "Jetzt versuchen", otherRooms: "Räume dieses Servers", lookKey: "Farben des Wassers",
    sound: "Ton", soundTip: "Ton des Wassers (Taste M)", panel: "Bedienung", effects: "Im Wasser",
    splash: "Platscher", wave: "Welle", spawn: "Neues Boot",
    view: "Ansicht", camera: "Kamera", start: "Anfang", startTip: "Die Ansicht vom Anfang", side: "Seite", sideTip: "Ansicht von der Seite",
    overview: "Übersicht", overviewTip: "Übersicht über die ganze Szene", below: "Unten", belowTip: "Ansicht unter der Oberfläche", boat: "Boot", boatTip: "Ansicht hinter dem eigenen Boot",
    boats: "Boote", helm: "Steuer des eigenen Boots", remove: "Eigenes Boot entfernen", tools: "Werkzeuge", effectsBox: "Platscher und Welle", soundBox: "Ton und Vibration",
    people: "Leute", peopleList: "Leute im Raum", room: "Raum, für alle", pause: "Pause", step: "Schritt", restart: "Neustart",
    more: "Mehr", keys: "Tasten …", parameters: "Parameter", numbers: "Messwerte",
    simTime: "Simulierte Zeit", rtf: "Echtzeitfaktor", netFps: "Bilder/s im Netz", displayFps: "Bilder/s im Fenster", latency: "Latenz", delay: "Abspielverzögerung",
    detail: "Detail", particles: "Partikel", breaking: "Brechende Oberfläche", volumeError: "Volumenfehler", exchanged: "Wasser in Gischt / zurück",
    substeps: "Teilschritte je Tick", stepMs: "Rechenschritt", health: "Überwachung", device: "Gerät", lastAck: "Zuletzt bestätigt", passes: "Zeit je Durchgang",
    toolBar: "Werkzeuge für das Wasser", kinds: "Gegenstände zum Hineinwerfen", bin: "Herausnehmen", binTip: "Nimmt den Gegenstand aus dem Wasser: hierher ziehen oder Entf drücken.",
  },

  paused: "angehalten",
  states: {
    connecting: "verbindet", live: "verbunden", opening: (room) => `öffnet den Raum ${room}`,
    retrying: (inS) => `neuer Versuch in ${inS < 1 ? fixed(inS, 1) : Math.round(inS)} s`, refused: (why) => `abgelehnt: ${why}`,
  },
  roomsHere: "Räume dieses Servers:",

  somebody: "Jemand",
  pausedBy: (name) => `${name} hat das Wasser angehalten.`,
  resumedBy: (name) => `${name} lässt das Wasser weiterlaufen.`,
  speedBy: (name, speed) => `${name} hat die Geschwindigkeit auf ${plain(speed)} × gestellt.`,
  startedAgainBy: (name) => `${name} hat die Szene neu gestartet.`,
  otherScene: (title) => `Die Szene ist jetzt „${title}“.`,

  restarts: "Der Server startet neu; die Seite verbindet sich von selbst wieder.",
  moves: "Das Wasser zieht auf einen anderen Server um; die Seite folgt von selbst.",

  notNow: "Der Unterricht erlaubt das gerade nicht.",
  failed: (what, why) => `${what}: ${why}`,
  noWebGl: "Diese Seite braucht WebGL 2 mit Gleitkomma-Zielen, und dieser Browser bietet das nicht. Bitte die Hardwarebeschleunigung einschalten oder einen aktuellen Firefox, Chrome, Edge oder Safari nehmen.",
  contextLost: "Der Browser hat die Grafik verloren. Das Bild kommt wieder, sobald er sie wiederherstellt.",
  noConnection: (state) => `Keine Verbindung zum Wasser: ${state}`,
  parentCannotAct: (why) => `Die umgebende Seite kann hier nichts tun: ${why}`,
  noEffects: "dieses Wasser nimmt keine Platscher und Wellen an",
  shareFailed: "Die Karte ließ sich nicht laden: bitte noch einmal versuchen, wenn der Server erreichbar ist.",
  soundFailed: (why) => `Der Ton ließ sich nicht laden (${why}); bitte noch einmal versuchen.`,

  commands: {
    numbered: (id) => `Befehl ${id}`, request: (kind) => `Anfrage „${kind}“`, splash: "Platscher", wave: "Welle", paddle: "Paddel", stone: "Stein", object: "Gegenstand",
    removeObject: "Gegenstand herausnehmen", stroke: "Strich", hold: "Festhalten", helm: "Steuer", boat: "Boot", newBoat: "Neues Boot", takeBoat: (id) => `Boot ${id} nehmen`,
    removeBoat: (id) => `Boot ${id} entfernen`, parameter: "Parameter", pause: "Pause", resume: "Weiter", step: "Schritt", reset: "Neustart", speed: "Geschwindigkeit",
    scene: (name) => `Szene ${name}`, fidelity: (level) => `Genauigkeit ${level}`, lesson: "Unterricht", team: "Team", mute: "Stumm schalten",
    race: "Rennen", ball: "Ballspiel", endGame: "Ende des Spiels", removeObjects: "Alle Gegenstände entfernen", gauge: "Pegel", removeGauge: "Pegel entfernen",
  },

  gaugesNotLoaded: "Namen und Diagramm der Pegel ließen sich nicht laden; bitte die Seite neu laden.",

  movesObjectsByMouse: "Gegenstände lassen sich ziehen; das Mausrad dreht sie.",
  movesObjectsByTouch: "Gegenstände lassen sich ziehen; ein zweiter Finger dreht sie.",
  turnsByMouse: "Die rechte Maustaste dreht die Ansicht.",
  turnsByTouch: "Zwei Finger drehen die Ansicht.",

  actions: "Bild, Ton und Link",
  share: "Link zu diesem Bild weitergeben, auch als QR-Code",
  fullscreen: "Vollbild",
  leaveFullscreen: "Vollbild beenden",
  picture: "Bild speichern",
  film: (longestS) => `Das Wasser filmen (höchstens ${longestS} s)`,
  endFilm: "Film beenden und speichern",
  fullscreenFailed: (why) => `Der Browser hat das Vollbild abgelehnt (${why}).`,
  pictureFailed: (why) => `Das Bild wurde nicht gespeichert (${why}); bitte noch einmal versuchen.`,
  pixels: (width, height) => `${width} x ${height} Bildpunkte`,
  filmNeedsHttps: "Browser nehmen Filme nur auf Seiten auf, die über https:// oder auf diesem Rechner geöffnet sind.",
  filmHasNoCodec: "Dieser Browser kann weder H.264 noch VP9 oder VP8 aufnehmen; ein aktueller Chrome, Edge, Firefox oder Safari kann es.",
  filmFailed: (why) => `Der Film wurde nicht gespeichert (${why}); bitte noch einmal versuchen.`,

  side: (what, where) => (where ? `${kSides[what]} ${kWhere[where]}` : kSides[what]),
  openSide: "die offene Seite",
  direction: "eine Richtung",

  hideControls: "Bedienung ausblenden",
  showControls: "Bedienung einblenden",
  automatic: "automatisch",
  on: "an",
  off: "aus",
  none: "keins",
  light: { label: "Licht", help: "Licht auf dieser Seite. Automatisch: die Stunde der Szene, bei Sturm im Raum dunkler und grau." },
  lights: { automatic: "automatisch", noon: "Mittag", "golden hour": "goldene Stunde", dusk: "Dämmerung", moon: "Mond", storm: "Sturm" },
  byHour: "nach Uhrzeit",
  hour: { label: "Uhrzeit", help: "Tageszeit auf dieser Seite." },
  look: { label: "Aussehen", help: "Was das Wasser zeigt, nur auf dieser Seite: sein natürliches Aussehen oder Daten in Farben." },
  looks: {
    natural: { label: "natürlich", help: "Wasser, wie das Licht es zeigt.", title: "" },
    height: { label: "Höhe", help: "Auslenkung der Oberfläche über dem ruhenden Wasser.", title: "Höhe der Oberfläche" },
    velocity: { label: "Geschwindigkeit", help: "Senkrechte Geschwindigkeit der Oberfläche: die zeitliche Ableitung der übertragenen Auslenkungen. Positiv, wo sie steigt.", title: "Senkrechte Geschwindigkeit der Oberfläche" },
    breaking: {
      label: "Brechkriterium",
      help: "Anstiegsgeschwindigkeit der Oberfläche, gemittelt über 3 × 3 übertragene Stützstellen, durch √(g d) mit der Ruhetiefe d. Der Server lässt die Welle über 0,65 brechen; wo sie bricht, tut sie es weiter bis zu einer Schwelle, die auf 0,15 fällt (Kennedy et al. 2000). Wie lange sie schon bricht, wird nicht übertragen: zwischen 0,15 und 0,65 sagt die Farbe nicht, ob sie bricht.",
      title: "Anstieg / √(g d)",
    },
    foam: { label: "Schaum", help: "Übertragener Schaum auf der Oberfläche: der Anteil an Weiß.", title: "Schaum auf der Oberfläche" },
    speed: { label: "Tempo der Partikel", help: "Betrag der übertragenen Geschwindigkeit jedes Partikels. Die Oberfläche der Welle ist schlicht gezeichnet, unter den Partikeln, die sie trägt.", title: "Tempo der Partikel" },
    density: {
      label: "Dichte der Partikel",
      help: "Übertragene Dichte jedes Partikels durch die Ruhedichte, von 0,5 bis 1,1; Werte darüber und darunter erscheinen wie diese. Der Druck wird nicht übertragen, und die 256 Stufen der Dichte sind zu grob, um ihn daraus zu berechnen.",
      title: "Dichte / Ruhedichte",
    },
    thesis: { label: "schlicht (Abschlussarbeit)", help: "Wie in der Abschlussarbeit: Partikel als Kugeln, weißer bei kleiner Dichte, und die Oberfläche mit Phong-Beleuchtung. Die Oberfläche liegt unter den Partikeln, die sie trägt.", title: "" },
  },
  rangeFollows: "Der Bereich folgt den Werten.",
  rangeFixed: "Der Bereich ist fest.",
  valueAt: (title, value, place) => `${title}: ${value} bei ${place}`,

  boat: {
    mine: { label: "Mein Boot", help: "Das Boot, das diese Seite steuert und dem die Bootsansicht folgt." },
    length: { label: "Bootslänge", help: "Länge des nächsten Boots." },
    throttle: { label: "Gas", help: "Motor: nach rechts voraus, nach links zurück. In der Bootsansicht die Tasten W und S oder auf und ab." },
    rudder: { label: "Ruder", help: "Ruder. In der Bootsansicht die Tasten A und D oder links und rechts." },
    keys: "In der Bootsansicht: Pfeiltasten oder WASD.",
    noneFree: "kein freies Boot",
    choice: (id, lengthM, isFree) => `Boot ${id} (${fixed(lengthM, 1)} m)${isFree ? ", frei" : ""}`,
  },

  toolSize: { label: "Größe des Werkzeugs", help: "Größe des gewählten Werkzeugs; 100 % passen zu diesem Wasser." },
  toolStrength: { label: "Stärke des Werkzeugs", help: "Stärke des gewählten Werkzeugs." },
  tools: {
    finger: { label: "Finger", does: "Ziehen zeichnet ins Wasser; Tippen macht einen Platscher." },
    splash: { label: "Platscher", does: "Tippen macht einen Platscher; Halten macht ihn größer." },
    paddle: { label: "Paddel", does: "Ziehen schickt eine Welle in diese Richtung; je weiter, desto höher." },
    rain: { label: "Regen", does: "Ziehen bewegt den Regen; Tippen macht eine Wolke für 8 Sekunden." },
    calm: { label: "Glätten", does: "Ziehen glättet das Wasser; Tippen beruhigt eine Stelle für 4 Sekunden." },
    float: { label: "Gegenstand", does: "Tippen setzt einen Gegenstand ins Wasser; Ziehen bewegt einen, Mausrad oder zweiter Finger drehen ihn; Stillhalten nimmt ihn heraus." },
    throw: { label: "Werfen", does: "Wischen wirft einen Stein in diese Richtung, je schneller, desto weiter; Tippen wirft ihn dorthin." },
  },
  toolKey: (does, key) => `${does} (Taste ${key})`,
  drag: { label: "Ziehen", help: "Was Ziehen auf dem Wasser tut. Die rechte Maustaste oder zwei Finger drehen die Ansicht, wenn Ziehen zeichnet." },
  drags: { draw: "mit Werkzeug", turn: "dreht Ansicht" },
  objects: "Gegenstände",
  kinds: { crate: "Kiste", ball: "Ball", barrel: "Fass", plank: "Brett", duck: "Ente", buoy: "Boje", raft: "Floß", stone: "Stein" },
  kindTip: "Was beim Tippen ins Wasser kommt (Tasten , und .)",
  removeObjects: "Alle Gegenstände entfernen",
  removeObjectsTip: "Nimmt alle Gegenstände aus dem Wasser, für alle.",
  density: { label: "Dichte", help: "Dichte der nächsten Gegenstände im Verhältnis zum Wasser: Balsa 0,15, Eiche 0,7, Eis 0,92, Stein 2,6. Bei 0 hat jede Art ihre eigene." },
  densityAs: (ratio, like) => `${fixed(ratio, 2)}, wie ${like}`,
  densities: { own: "wie es zur Art passt", balsa: "Balsaholz", oak: "Eiche", ice: "Eis", stone: "Stein" },

  splashRadius: { label: "Radius des Platschers", help: "Radius der Scheibe, die ein Platscher hinunterdrückt." },
  splashDepth: { label: "Tiefe des Platschers", help: "So weit drückt ein Platscher die Oberfläche hinunter." },
  waveHeight: { label: "Wellenhöhe", help: "Höhe des Wellenkamms am Anfang." },
  waveLength: { label: "Wellenlänge", help: "Breite des Wellenkamms am Anfang." },
  waveDirection: { label: "Richtung", help: "Richtung, in die die Welle läuft: 0 ist +x, 90 ist +z." },
  waveFrom: { label: "Welle von", help: "Seite, an der die Welle beginnt. Die offene Seite ist die mit dem tiefsten Wasser." },
  waveShape: { label: "Wellenform", help: "Brechend: eine steile Front. Dünung: ein symmetrischer Kamm." },
  shapes: { breaking: "brechend", swell: "Dünung" },

  volume: { label: "Lautstärke", help: "Lautstärke des Tons auf dieser Seite." },
  tone: { label: "Wellenton", help: "Die Auslenkung des Wassers an einer Stelle als Ton." },
  toneRange: { label: "Tonumfang", help: "Die Auslenkung, die den Ton um eine Oktave hebt." },
  toneMiddle: "Mitte der Ansicht",
  toneGauge: (name) => `Pegel ${name}`,
  octave: (octaveM) => `±${octaveM < 1 ? `${Math.round(100 * octaveM)} cm` : `${plain(octaveM)} m`} = ±1 Oktave`,
  toneRest: "Die Ruhelage des Wassers ist das A (440 Hz).",
  soundWaits: "Der Browser lässt die Seite nach dem nächsten Klick oder Tastendruck klingen.",
  vibration: { label: "Vibration", help: "Platscher, Gegenstände und das eigene Boot sind auf Telefonen und Gamepads zu spüren, die das können." },

  roles: { viewer: "schaut zu", player: "spielt mit", operator: "leitet" },
  myName: "Mein Name",
  token: { label: "Token", help: "Ein Token gibt eine Rolle: zuschauen, mitspielen oder leiten. Ohne Token ist man Gast." },
  join: "Mit diesem Namen mitmachen",
  people: (count) => (count > 1 ? `Leute (${count})` : "Leute"),
  you: "diese Seite",
  away: "abwesend",
  boatsOf: (ids) => `Boot ${ids.join(", ")}`,
  moreWatching: (count) => `und ${count} weitere schauen zu`,

  oneTick: "Ein Tick",
  pauseFirst: "Erst anhalten",
  speed: { label: "Geschwindigkeit", help: "Simulierte Sekunden pro Sekunde, für alle im Raum." },
  scene: { label: "Szene", help: "Wechselt die Szene für alle im Raum." },
  building: (scene) => `Das Wasser von „${scene}“ entsteht; bis dahin läuft dieses weiter.`,
  runsSlow: (percent) => `Die Zeit läuft mit ${percent} % der gewünschten Geschwindigkeit: der Rechner des Servers kommt nicht nach.`,
  coarserCostsLess: "Eine gröbere Genauigkeit kostet weniger.",
  fidelity: { label: "Genauigkeit", help: "Wie fein das Wasser simuliert wird, für alle im Raum. Das Wasser läuft weiter." },
  fidelities: { draft: "Entwurf", balanced: "ausgewogen", fine: "fein", reference: "Referenz" },
  buildingLevel: (wanted, now) => `Das Wasser entsteht mit „${wanted}“; bis dahin läuft es mit „${now}“ weiter.`,
  levelCosts: "Was jede Stufe kostet",
  levelCost: (level, cost) => `Bei „${level}“ braucht dieser Server für eine simulierte Sekunde ${cost}. Der Fehler wurde für diese Szene nicht gemessen.`,
  levelCostAndError: (level, cost, error, measuredOn) => `Bei „${level}“ braucht dieser Server für eine simulierte Sekunde ${cost}; die Höhe des Wassers weicht um ${error} ab (gemessen: ${measuredOn}).`,
  levelHead: ["Stufe", "Zeit pro Sekunde, vorhergesagt", "Fehler"],
  detail: { label: "Detail", help: "Detailstufe, die diese Seite bekommt. Automatisch: die feinste, die Leitung und Gerät schaffen." },
  levels: { coarse: "grob", medium: "mittel", fine: "fein", full: "voll" },
  levelLimits: { none: "", choice: "", link: " (langsame Leitung)", device: " (ausgelastetes Gerät)" },
  quality: { label: "Qualität", help: "Qualität der Zeichnung, nur auf dieser Seite. Automatisch: die beste, bei der die Bilder schnell genug kommen." },
  qualities: { minimal: "minimal", low: "niedrig", medium: "mittel", high: "hoch", highest: "höchste" },
  automaticNow: (tier) => `automatisch: ${tier}`,
  drawsInSoftware: "Dieser Browser zeichnet ohne Grafikkarte.",
  resolutionLowered: (percent) => `Die Auflösung ist auf ${percent} % gesenkt, um mitzukommen.`,
  volumeUnits: (count) => `${count} Einheiten`,
  healthy: "in Ordnung",
  nonfinite: (count) => `${count} nicht endliche Werte`,
  escaped: (count) => `${count} entwichene Partikel`,
  recovered: (count) => `${count} Wiederherstellungen`,
  commandAt: (id, tick) => `Befehl ${id} bei Tick ${tick}`,

  words: {
    connected: "Mit dem Wasser verbunden.", paused: "Das Wasser ist angehalten.", runs: "Das Wasser läuft.", calm: "Das Wasser ist ruhig.",
    waves: (heightM) => `Wellen von etwa ${length(heightM)} vom Tal zum Kamm.`,
    storms: { none: "Der Sturm ist vorbei.", some: "Es stürmt.", strong: "Es stürmt heftig." },
    own: (side) => `Die eigene Hand ist ${kPictureSides[side]} im Wasser.`,
    draws: (name, side) => `${name} zeichnet ${kPictureSides[side]} ins Wasser.`,
  },

  teams: kTeams,
  teamOf: (team) => `Team ${kTeams[team]}`,
  goalOf: (team) => `Tor ${kTeams[team]}`,
  score: (red, blue) => `Rot ${red} : ${blue} Blau`,
  ordinal: (place) => `${place}.`,
  left: "gegangen",
  lapOf: (lap, count) => `Runde ${lap} von ${count}`,
  go: "Los!",
  race: (laps) => `Rennen: ${laps} ${laps === 1 ? "Runde" : "Runden"}`,
  ballTo: (goals) => `Ball ins andere Tor: wer zuerst ${goals} ${goals === 1 ? "Tor" : "Tore"} hat`,
  ballTask: (team, goal) => `Team ${kTeams[team]}: schiebt den Ball ins ${kTeamAdjectives[goal]} Tor`,
  buoyTask: (buoy) => `Steuere zur Boje ${buoy}, der gelben`,
  goalFor: (team) => `Tor für ${kTeams[team]}!`,
  teamWins: (team, more, fewer) => `${kTeams[team]} gewinnt ${more} : ${fewer}`,
  drawn: "Das Spiel ist unentschieden ausgegangen",
  raceEnded: "Das Rennen ist zu Ende",
  winnerLeft: "Wer gewonnen hat, ist schon gegangen",
  wins: (name, team, time) => `${name} gewinnt${team ? ` für ${kTeams[team]}` : ""}${time ? ` in ${time}` : ""}`,
  finished: (place, count, time) => `Im Ziel als ${place}. von ${count}, ${time}`,
  standing: (place, count, progress) => `${place}. von ${count}, ${progress}`,
  lessonTools: { finger: "Finger", splash: "Platscher", wave: "Welle", rain: "Regen", float: "Dinge", throw: "Werfen", boat: "Boot" },
  teacherPaused: "Gerade ist Pause. Gleich geht es weiter.",
  teacherMuted: "Deine Lehrkraft hat dich gerade stumm geschaltet.",
  notHandedOut: (tool) => `${tool}: ist in dieser Stunde nicht dabei.`,
};

const kGermanGauge: GaugeTexts = {
  gauges: "Pegel",
  open: "Was die Pegel im Wasser messen, als Diagramm",
  elevation: "Höhe", velocityX: "Geschwindigkeit längs x", velocityZ: "Geschwindigkeit längs z",
  shows: { label: "Zeigt", help: "Höhe über dem ruhenden Wasser, oder die über die Tiefe gemittelte Geschwindigkeit der Strömung." },
  span: { label: "Die letzten", help: "Die Zeit, die das Diagramm zeigt. Die Seite behält höchstens die letzten 4.800 Messwerte." },
  pause: "Anhalten",
  pauseHelp: "Hält das Diagramm an; das Wasser läuft weiter.",
  resume: "Weiter",
  csv: "CSV", csvHelp: "Speichert die Messwerte der gewählten Pegel als Tabelle.", picture: "PNG", pictureHelp: "Speichert das Diagramm als Bild.",
  close: "Schließen",
  at: (timeS) => `bei ${fixed(timeS, 2)} s`,
  newest: "jetzt",
  time: "Zeit seit dem Anfang [s]",
  noReadings: "Noch keine Messwerte.",
  none: "Unten einen Pegel wählen.",
  empty: "In diesem Wasser steht noch kein Pegel.",
  place: "Pegel setzen",
  placeHelp: "Setzt beim nächsten Tippen auf das Wasser dort einen eigenen Pegel, den alle sehen; höchstens 4.",
  placing: "Abbrechen",
  placeByTouch: "Auf das Wasser tippen, wo der Pegel stehen soll.",
  placeByMouse: "Auf das Wasser klicken, wo der Pegel stehen soll, oder die Stelle mit den Pfeiltasten wählen und die Eingabetaste drücken. Escape bricht ab.",
  remove: (gauge) => `Den Pegel ${gauge} entfernen`,
  ownGauge: "Selbst gesetzt", gaugeOf: (person) => `Gesetzt von ${person}`,
  notLoaded: "Das Diagramm ließ sich nicht laden: bitte noch einmal versuchen, wenn der Server erreichbar ist.",
  noHistory: (gauge, why) => `Der Verlauf des Pegels ${gauge} ließ sich nicht lesen: ${why}`,
  noPicture: "die Zeichenfläche gibt keines",
  pictureFailed: (why) => `Das Bild des Diagramms wurde nicht gespeichert (${why}); bitte noch einmal versuchen.`,
};

const kGermanFront: FrontTexts = {
  lead: "Ein Wasser wählen.",
  rooms: "Räume dieses Servers",
  noSuchRoom: (name) => `Den Raum ${name} gibt es nicht. Dies sind die Räume dieses Servers.`,
  refusedRoom: (why) => `${why[0]!.toUpperCase()}${why.slice(1)}.`,
  listFailed: (why) => `Die Liste der Räume ist nicht auf dem neuesten Stand (${why}). Sie wird alle paar Sekunden neu erfragt.`,
  noRooms: "Dieser Server hat keinen Raum, den man betreten darf. Jederzeit kann einer geöffnet werden; dann erscheint er hier.",
  open: "Öffnen",
  openRoom: "Einen Raum öffnen",
  openRoomWhy: "Ein Raum mit dieser Szene; alle mit seinem Link kommen in denselben.",
  openScene: { label: "Szene", help: "Die Szene des Raums, der geöffnet wird." },
  sceneOfRoom: (scene, room) => (scene === room ? scene : `${scene} · Raum ${room}`),
  peopleCount: (count) => (count === 0 ? "niemand da" : count === 1 ? "1 Person" : `${count} Personen`),
  roomState: { running: "läuft", paused: "angehalten", asleep: "schläft, bis jemand kommt" },
};

const kGermanKiosk: KioskTexts = {
  invite: "Das Wasser berühren",
  countdown: (leftS) => `Zurück zum Anfang in ${leftS} s – berühren, um weiterzumachen`,
  boat: "Zu meinem Boot",
  whole: "Das ganze Wasser",
  putAway: "Aufräumen",
};

const kGermanClass: ClassTexts = {
  title: "Klasse", pausePads: "Pads anhalten", resumePads: "Pads weiter", teams: "Teams", clear: "Alle Gegenstände herausnehmen", endGame: "Spiel beenden",
  noGames: "Diese Szene hat keine Rennstrecke oder keine Tore; die Szene „Regatta“ hat beides.", whoPlays: "Wer mitspielt", nobody: "Noch spielt niemand mit.",
  force: { label: "Kraft", help: "Anteil dessen, was das Werkzeug eines Kindes mit dem Wasser macht." },
  laps: { label: "Runden", help: "Runden eines Rennens." },
  goals: { label: "Tore zum Sieg", help: "So viele Tore gewinnen." },
  startRace: "Rennen starten", startBall: "Ballspiel starten", reset: "Szene neu starten", really: "Wirklich? Noch einmal drücken",
  toolsGroup: "Ausgeteilte Werkzeuge", gameGroup: "Spiel", waterGroup: "Wasser", peopleGroup: "Leute",
  teamOf: (name, team) => `Team von ${name}: ${team ? kTeams[team] : "keins"}`,
  mute: "Stumm", unmute: "Wieder laut", muteName: (name) => `${name} stumm schalten`, unmuteName: (name) => `${name} wieder laut schalten`,

  padsPaused: "Die Pads haben Pause",
  andMore: (count) => `und ${count} weitere`,
  phonesCannotJoin: "Telefone erreichen diesen Server nicht: er ist nur auf diesem Rechner zu erreichen oder hat kein Netz. Er braucht --class oder mit --public-url seine Adresse",
  joinTip: "Größer oder kleiner; bei mehreren Adressen die nächste",
  padQr: "QR-Code der Adresse des Pads",
  scanOrOpen: "Scannen oder öffnen:",
  addressOf: (number, count) => `Adresse ${number} von ${count}`,
};

const kGermanPad: PadTexts = {
  water: "Das Wasser von oben. Berühre es mit dem gewählten Werkzeug; mit Tasten bewegen die Pfeile eine Marke, und die Eingabetaste benutzt das Werkzeug.",
  speed: "Tempo", heading: "Kurs", launch: "Mein Boot ins Wasser", takeOut: "Herausnehmen",
  takeOutLabel: "Mein Boot aus dem Wasser nehmen", tools: "Werkzeuge", useName: "Diesen Namen nehmen",
  stick: "Steuer: nach oben voraus, nach unten zurück, zur Seite lenken; die Pfeiltasten tun dasselbe",
  lost: "Die Verbindung ist weg. Das Pad kommt von selbst wieder.", connecting: "Das Pad verbindet sich mit dem Wasser …", restarts: "Der Server startet neu; das Pad kommt von selbst wieder.",
  mayWatch: "Hier darfst du zuschauen. Frag deine Lehrkraft nach einem Link zum Mitspielen.",
  does: {
    finger: "Zeichne mit den Fingern ins Wasser.", splash: "Tippe für einen Platscher; halte für einen größeren.", wave: "Ziehe, um eine Welle in diese Richtung zu schicken.", rain: "Ziehe eine Regenwolke; tippe, um eine dazulassen.",
    float: "Tippe, um etwas ins Wasser zu werfen; ziehe etwas, um es zu bewegen.", throw: "Wische, um einen Stein zu werfen; tippe für einen kleinen Wurf.", boat: "Schieb den Hebel nach vorn und steuere.",
  },
  // Masculine, so that the ending fits.
  nameKinds: ["Froher", "Mutiger", "Flinker", "Sonniger", "Kluger", "Schlauer", "Kühner", "Sanfter", "Wendiger", "Lustiger", "Ruhiger", "Heiterer"],
  nameAnimals: ["Otter", "Seehund", "Reiher", "Krebs", "Delfin", "Pinguin", "Pelikan", "Orca", "Marlin", "Kalmar", "Lachs", "Hecht", "Wal", "Hai", "Schwan", "Frosch"],
};

const kGermanShare: ShareTexts = {
  title: "Diese Ansicht teilen", qr: "QR-Code des Links", link: "Link", copy: "Kopieren", send: "Senden …", close: "Schließen", openRoom: "Raum öffnen",
  target: { label: "Führt in", help: "Wohin der Link führt." },
  targets: { room: "diesen Raum, zu allen anderen", copy: "einen eigenen Raum wie diesen", roles: "einen neuen Raum, nach Rollen", embed: "eine eigene Seite, als Code" },
  notes: {
    room: "",
    copy: "Alle mit diesem Link kommen in einen gemeinsamen Raum, getrennt von diesem. Wer den Server leitet, muss ihn zuerst öffnen.",
    roles: "Wer den Link hat, hat die Rolle, solange es den Raum gibt. Die Links sind zu sehen, bis diese Seite geschlossen wird.",
    embed: "Der Server zeigt sein Wasser nur in Seiten, die er kennt: mit --embed und dem Ursprung der Seite starten, zum Beispiel https://school.example.",
  },
  role: { label: "Für", help: "Die Rolle derer, die den Link öffnen." },
  roles: { operator: "die Leitung", player: "Mitspielende", viewer: "Zuschauende", kiosk: "einen Kiosk" },
  kioskNote: "Auf dem Bildschirm öffnen, an dem das Publikum spielt: Es spielt mit, und nichts führt aus der Seite hinaus.",
  onlyHere: "Nur dieser Rechner kann den Link öffnen: für Telefone und andere Rechner den Server mit --address 0.0.0.0 starten.",
  opening: "Der Raum wird geöffnet: das dauert einige Sekunden.",
  notOpened: (why) => `Der Raum ließ sich nicht öffnen: ${why}`,
  tooLong: "Der Link ist zu lang für einen QR-Code.",
  copied: "Kopiert.",
  notCopied: "Der Browser erlaubt das Kopieren nicht: bitte den Text markieren und von Hand kopieren.",
  notSent: "Der Browser kann den Link nicht senden: bitte kopieren.",
};

const kGermanKeys: KeysTexts = {
  title: "Tasten", close: "Schließen",
  rows: [
    ["Tab", "zum nächsten Bedienelement; ins Wasser und wieder hinaus"],
    ["← → ↑ ↓", "auf dem Wasser: die Marke bewegen; in der Bootsansicht: steuern"],
    ["Eingabe", "auf dem Wasser: das Werkzeug an der Maus oder der Marke benutzen; gehalten, mit Pfeilen: zeichnen, werfen, einen Gegenstand bewegen"],
    ["1 … 7", "Werkzeug wählen"],
    ["Q, E", "den gehaltenen Gegenstand drehen"],
    ["Entf", "den Gegenstand herausnehmen, der gehalten wird oder unter der Marke ist"],
    [", .", "wählen, was das Werkzeug Gegenstand ins Wasser setzt"],
    ["Umschalt + ← → ↑ ↓", "die Ansicht drehen"],
    ["+ −", "näher, weiter weg"],
    ["V", "nächste Ansicht"],
    ["B", "neues Boot"],
    ["P", "Pause und weiter (Leitung)"],
    ["N", "ein Schritt in der Pause (Leitung)"],
    ["M", "Ton an und aus"],
    ["C", "Bedienung ein- und ausblenden"],
    ["?", "diese Liste"],
  ],
};

export const kGermanTranslation: typeof translation = {
  locale: "de", page: kGerman, net: kGermanNetTexts, gauge: kGermanGauge, front: kGermanFront, kiosk: kGermanKiosk, class: kGermanClass, pad: kGermanPad, share: kGermanShare, keys: kGermanKeys,
};
