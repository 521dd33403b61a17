// What an agent can do with a server of water, as tools of the Model Context Protocol.
import { McpServer, type CallToolResult } from "@modelcontextprotocol/server";
import { encode } from "fast-png";
import { z } from "zod";

import { listRooms, listScenes, openRoom } from "../index";
import { Rejected, SpindriftError } from "../water/errors";
import type { Water } from "../water/water";
import { describeCommands, fieldsOf, kCommands } from "./command_texts";
import { drawParticles, drawSurface } from "./picture";
import type { Rooms } from "./rooms";

/** Values of a series that are sent at most. */
const kSeriesMaxCount = 512;
const kPictureMaxPx = 1024;
const kPointsMaxCount = 256;
const kInstructions =
  "Water that people share: rooms with a simulated surface, particles, boats and objects. Lengths are in metres, x to the right and z down in pictures, " +
  "y up from the water at rest, headings from +x toward +z. What you may do depends on the token: viewers look, players act, operators change everything. " +
  "Look with `room` and `picture`, act with `command` (`commands` lists all with their fields and bounds), and look again: the water keeps moving unless it is paused.";

const room = z.string().max(64).optional().describe("Name of the room; the server's first one if left out.");

/** Makes the server. `version`: of the program. */
export function waterTools(rooms: Rooms, version: string): McpServer {
  const server = new McpServer({ name: "spindrift", version }, { instructions: kInstructions });
  const { url, token } = rooms;
  const looks = { readOnlyHint: true };

  server.registerTool("list_rooms", { description: "The rooms of the server.", annotations: looks }, () => answer(async () => text(await listRooms(url, { token }))));
  server.registerTool("list_scenes", { description: "The scenes that a room can be opened with, or changed to.", annotations: looks }, () => answer(async () => text(await listScenes(url, { token }))));
  server.registerTool(
    "open_room",
    { description: "Opens a room, for operators. It closes when nobody has been in it for a while.", inputSchema: z.object({ room: z.string().max(32), scene: z.string().max(64) }) },
    ({ room, scene }) => answer(async () => text({ room: (await openRoom(url, room, scene, { token })).room, scene })),
  );
  server.registerTool("room", { description: "What a room is and who is in it: scene, size, layers, role of this client, people, boats, gauges.", inputSchema: z.object({ room }), annotations: looks }, ({ room }) =>
    answer(async () => text(await aboutRoom(await rooms.water(room)))),
  );
  server.registerTool("commands", { description: "All commands with their fields, units and bounds.", annotations: looks }, () => answer(async () => ({ content: [{ type: "text", text: describeCommands() }] })));
  server.registerTool(
    "command",
    {
      description: "Sends a command and waits until the server has carried it out; answers with the tick that shows it. A refusal says reason, field, value and bound.",
      inputSchema: z.object({ room, command: z.enum(kCommands), fields: z.record(z.string(), z.unknown()).default({}).describe("As `commands` lists them: { \"xM\": 1, \"depthM\": 0.2 }.") }),
    },
    ({ room, command, fields }) => answer(async () => text(await (await rooms.water(room)).command(command as "splash", fieldsOf(command, fields)))),
  );
  server.registerTool(
    "parameters",
    { description: "What setParameter takes in this room: path, label, unit, bounds and present value.", inputSchema: z.object({ room, contains: z.string().max(64).default("").describe("Only paths that contain this.") }), annotations: looks },
    ({ room, contains }) => answer(async () => text([...(await rooms.water(room)).parameters.values()].filter(({ path }) => path.includes(contains)))),
  );
  server.registerTool(
    "gauge",
    {
      description: "What a gauge measured: elevation over the water at rest and velocity of the flow, per tick, oldest first. placeGauge places one.",
      inputSchema: z.object({ room, gauge: z.string().max(64), count: z.number().int().min(1).max(kSeriesMaxCount).default(120).describe("The newest so many ticks.") }),
      annotations: looks,
    },
    ({ room, gauge, count }) =>
      answer(async () => text(rounded(Object.fromEntries(Object.entries(await (await rooms.water(room)).gauge(gauge)).map(([name, values]: [string, Float64Array]) => [name, values.slice(-count)]))))),
  );
  server.registerTool(
    "query",
    {
      description: "The water at points now: elevation over the water at rest, its vertical speed, velocity of the flow, slope, depth, share of wet ground and of foam. outside: 1 where there is no water.",
      inputSchema: z.object({ room, points: z.array(z.tuple([z.number(), z.number()])).min(1).max(kPointsMaxCount).describe("[[xM, zM], ...]") }),
      annotations: looks,
    },
    ({ room, points }) => answer(async () => text(rounded(await (await rooms.water(room)).query(points)))),
  );
  server.registerTool(
    "picture",
    {
      description: "The water from above as it is now, as PNG: dark is low, bright is high; boats are red, objects yellow. The text says what the colours mean.",
      inputSchema: z.object({ room, widthPx: z.number().int().min(32).max(kPictureMaxPx).default(384) }),
      annotations: looks,
    },
    ({ room, widthPx }) => answer(async () => pictureOf(await rooms.water(room), widthPx)),
  );
  return server;
}

/** Arrays as lists of numbers with six digits. */
function rounded(values: object): object {
  const list = (value: unknown): unknown => (ArrayBuffer.isView(value) ? Array.from(value as unknown as ArrayLike<number>, (each) => Number(each.toPrecision(6))) : value);
  return Object.fromEntries(Object.entries(values).map(([name, value]) => [name, list(value)]));
}

async function aboutRoom(water: Water): Promise<object> {
  const { room, sceneName, title, description, sideM, widthM, layers, hasBoats, hasFloaters } = water.greeting;
  const { timeS, tick, realTimeFactor, gauges } = await water.next("diagnostics");
  const people = water.people.map(({ personId, name, role, boatIds, away }) => ({ personId, name, role, boatIds, away }));
  const bodies = layers.includes("bodies") ? (await water.next("bodies")).boats : [];
  return {
    room, scene: sceneName, title, description, lengthM: sideM, widthM, layers, hasBoats, hasFloaters, isPaused: water.isPaused, speed: water.speed, tick, timeS, realTimeFactor,
    role: water.role, personId: water.personId, people, boats: bodies, gauges,
  };
}

async function pictureOf(water: Water, widthPx: number): Promise<CallToolResult> {
  const { layers, sideM, widthM } = water.greeting;
  const bodies = layers.includes("bodies") && water.boats.length > 0 ? await water.next("bodies") : undefined;
  const floaters = layers.includes("floaters") && water.greeting.hasFloaters ? await water.next("floaters") : undefined;
  const frame = layers.includes("surface") ? await water.surface() : await water.next("particles");
  const { picture, lowestM, highestM, rangeM } = frame.layer === "surface" ? drawSurface(frame, widthPx, bodies, floaters) : drawParticles(frame, sideM, widthM, widthPx);
  const png = encode({ ...picture, channels: 3, depth: 8 });
  const about = { tick: frame.tick, timeS: frame.timeS, lengthM: sideM, widthM, metresPerPixel: sideM / picture.width, lowestM, highestM, darkestM: rangeM[0], brightestM: rangeM[1] };
  return { content: [{ type: "image", data: Buffer.from(png).toString("base64"), mimeType: "image/png" }, ...text(about).content] };
}

function text(value: object): CallToolResult {
  return { content: [{ type: "text", text: JSON.stringify(value, (_, each: unknown) => (typeof each === "bigint" ? String(each) : each)) }] };
}

/** What goes wrong is an answer, from which an agent can learn what to do. */
async function answer(act: () => Promise<CallToolResult>): Promise<CallToolResult> {
  try {
    return await act();
  } catch (error) {
    if (!(error instanceof Error)) throw error;
    const about = error instanceof Rejected ? { reason: error.reason, field: error.field, value: String(error.value), bound: error.bound } : {};
    const kind = error instanceof SpindriftError || error instanceof TypeError ? error.name : "Error";
    return { isError: true, ...text({ error: kind, message: error.message, ...about }) };
  }
}
