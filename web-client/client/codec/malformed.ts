// The result of reading bytes that cannot be trusted.
export interface Malformed {
  kind: "malformed";
  reason: string;
}

export function malformed(reason: string): Malformed {
  return { kind: "malformed", reason };
}

export function isMalformed(read: object): read is Malformed {
  return "kind" in read && read.kind === "malformed";
}
