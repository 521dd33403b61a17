// What cannot be trusted, with the reason: the result of reading it.
export interface Malformed {
  kind: "malformed";
  reason: string;
}

export function malformed(reason: string): Malformed {
  return { kind: "malformed", reason };
}
