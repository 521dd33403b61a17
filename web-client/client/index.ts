/** Client of the Spindrift water server, for browsers and their workers, and for Node.
 *
 *     const water = await connect("http://localhost:8080");
 *     console.log(Math.max(...(await water.surface()).heightsM));
 *     water.close();
 *
 * docs/javascript.md of the project has examples. */
import { requestRooms, requestScenes, openRoomWithTokens, type ParameterValue, type RoomSummary, type RoomWithTokens } from "./rest/rooms";
import { parseAddress, restBase } from "./water/address";

export type { BodyPose } from "./codec/bodies";
export type { FloaterKindName, FloaterPose } from "./codec/floaters";
export type { GameInfo } from "./codec/game";
export { kWireMajor, kWireMinor, type BoatDetail, type GreetingInfo, type ParameterInfo } from "./codec/greeting";
export type { GroundGrid } from "./codec/ground";
export type { LayerName, LevelName } from "./codec/layers";
export type { HullForceInfo, HullForcesInfo, WrenchInfo } from "./codec/hulls";
export type { LessonInfo } from "./codec/lesson";
export type { DrainingInfo } from "./codec/parse";
export type { PersonInfo, RoleName, WelcomeInfo } from "./codec/people";
export type { GaugeInfo } from "./codec/scene_info";
export { Fidelity, FloaterKind, Side } from "./gen/spindrift/v1/scene_pb";
export { GameKind, StrokeTool, Team, Tool } from "./gen/spindrift/v1/wire_pb";
export type { ParameterValue, RoomSummary, RoomWithTokens } from "./rest/rooms";
export type { LinkStats } from "./session/events";
export { kSessionTexts } from "./session/texts";
export type { Clock, StepAck } from "./water/clock";
export type { Ack, Commands } from "./water/commands";
export { connect, type ConnectOptions, type WebSocketClass } from "./water/connect";
export { ConnectionLost, NoAnswer, Refused, Rejected, SpindriftError, type Bound, type RejectReasonName } from "./water/errors";
export type { WaterEvents } from "./water/events";
export type { FrameStream } from "./water/frame_stream";
export type { Boats, Diagnostics, Floaters, Foam, Frames, Particles, Surface } from "./water/frames";
export type { Answer, Pairs, QueryStreamOptions } from "./water/queries";
export type { GaugeRecord, LayerOptions } from "./water/options";
export type { Water } from "./water/water";

/** The rooms that this client may know of. Addresses as `connect` takes them. Throws an Error with the server's reason. */
export function listRooms(url: string | URL, { token = "" } = {}): Promise<RoomSummary[]> {
  const address = parseAddress(String(url), "", token);
  return requestRooms(address.token, restBase(address.socket));
}

/** The names of the scenes that a room can be opened with. Throws an Error with the server's reason. */
export function listScenes(url: string | URL, { token = "" } = {}): Promise<string[]> {
  const address = parseAddress(String(url), "", token);
  return requestScenes(address.token, restBase(address.socket));
}

/** Opens a room, for operators. Its tokens, one for each role, are told once. Throws an Error with the server's reason. */
export function openRoom(url: string | URL, room: string, scene: string, { token = "", parameters = [] as ParameterValue[] } = {}): Promise<RoomWithTokens> {
  const address = parseAddress(String(url), "", token);
  return openRoomWithTokens(room, { scene, parameters }, address.token, restBase(address.socket));
}
