// Which pages may show this one in a frame: the server says so in its Content-Security-Policy, which browsers keep.

const kDirective = "frame-ancestors";
const kOrigin = /^https?:\/\/[^/*]+$/;

/** Returns the origins in the directive frame-ancestors of a Content-Security-Policy. Several policies, joined by commas as headers are, have
 *  to name an origin each; without any, or with patterns, no origin counts. */
export function parentsOf(policies: string | null): string[] {
  const lists = (policies ?? "")
    .split(",")
    .flatMap((policy) => policy.split(";"))
    .map((directive) => directive.trim().toLowerCase().split(/\s+/))
    .filter(([name]) => name === kDirective)
    .map(([, ...sources]) => sources.filter((source) => kOrigin.test(source)));
  return (lists[0] ?? []).filter((origin) => lists.every((list) => list.includes(origin)));
}

/** Asks the server for the policy of the page at this address. */
export async function askParents(address: string): Promise<string[]> {
  const answer = await fetch(address, { method: "HEAD", cache: "no-store" });
  return parentsOf(answer.headers.get("content-security-policy"));
}
