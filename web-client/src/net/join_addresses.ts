// Asks the server at which addresses other devices of its network reach it.
import { kNetTexts } from "./net_texts";

/** Returns the addresses of the pad, the likeliest first; empty if only this machine reaches the server. Throws an Error with a line for people. */
export async function askJoinAddresses(token: string): Promise<string[]> {
  const answer = await fetch("api/v1/join", { headers: token ? { Authorization: `Bearer ${token}` } : {} });
  if (!answer.ok) throw new Error(kNetTexts.noJoin(answer.status));
  const { urls }: { urls?: unknown } = await answer.json();
  return Array.isArray(urls) ? urls.map(String) : [];
}
