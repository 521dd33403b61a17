// The people in the room, as plain data that survives postMessage.
import { Role, Team, type People, type Welcome } from "../gen/spindrift/v1/wire_pb";

/** Each role includes the permissions of the ones before. */
export type RoleName = "viewer" | "player" | "operator";

export type TeamName = "red" | "blue";

export interface PersonInfo {
  personId: number;
  name: string;
  /** A CSS color. */
  color: string;
  role: RoleName;
  /** Boats that this person owns; only the owner steers them. */
  boatIds: number[];
  /** The connection was lost; the person may come back within the server's grace time. */
  away: boolean;
  team: TeamName | undefined;
  /** The server takes no commands from this person. */
  muted: boolean;
}

export interface WelcomeInfo {
  role: RoleName;
  personId: number;
  /** Secret. A later connection that sends it is the same person. */
  resumeKey: string;
  resumed: boolean;
}

function roleName(role: Role): RoleName {
  if (role === Role.OPERATOR) return "operator";
  return role === Role.PLAYER ? "player" : "viewer";
}

export function teamName(team: Team): TeamName | undefined {
  return team === Team.RED ? "red" : team === Team.BLUE ? "blue" : undefined;
}

export function wireTeam(name: TeamName | undefined): Team {
  return name === "red" ? Team.RED : name === "blue" ? Team.BLUE : Team.UNSPECIFIED;
}

export function readPeople({ people }: People): PersonInfo[] {
  return people.map(({ personId, name, colorRgb, role, boatIds, away, team, muted }) => ({
    personId,
    name,
    color: `#${(colorRgb & 0xffffff).toString(16).padStart(6, "0")}`,
    role: roleName(role),
    boatIds: [...boatIds],
    away,
    team: teamName(team),
    muted,
  }));
}

export function readWelcome({ role, personId, resumeKey, resumed }: Welcome): WelcomeInfo {
  return { role: roleName(role), personId, resumeKey, resumed };
}
