// What can go wrong, by what a program would do about it. All are SpindriftError.
import type { RejectReason } from "../gen/spindrift/v1/wire_pb";

/** Any error of this package. */
export class SpindriftError extends Error {
  override name = "SpindriftError";
}

/** The server does not want this client: another major version, an unknown token, a room that does not exist or was closed. Connecting again
 *  does not help. */
export class Refused extends SpindriftError {
  override name = "Refused";
  constructor(
    message: string,
    /** The rooms that there are, if the wanted one does not exist. */
    readonly rooms: readonly string[] = [],
  ) {
    super(message);
  }
}

/** The connection broke, or was never made. Of a command: `wasSent` says whether it may have been carried out. */
export class ConnectionLost extends SpindriftError {
  override name = "ConnectionLost";
  constructor(
    message: string,
    readonly wasSent = false,
  ) {
    super(message);
  }
}

/** No answer came in time. A command may still be carried out. */
export class NoAnswer extends SpindriftError {
  override name = "NoAnswer";
}

/** As in wire.proto; OTHER: one that this client does not know. */
export type RejectReasonName = keyof typeof RejectReason | "OTHER";

/** The smallest and largest value that a field takes, in `unit` (empty: none). */
export interface Bound {
  min: number;
  max: number;
  unit: string;
}

/** The server did not carry out a command. The message is for people, with value, bound and unit. */
export class Rejected extends SpindriftError {
  override name = "Rejected";
  constructor(
    message: string,
    readonly reason: RejectReasonName,
    /** The field by its name on the wire, "splash.radius_m"; empty if it was not about one. */
    readonly field: string,
    /** What was sent in this field; undefined without one. */
    readonly value: unknown,
    /** What the wire allows in this field, or in the parameter; undefined without bounds. */
    readonly bound: Bound | undefined,
  ) {
    super(message);
  }
}
