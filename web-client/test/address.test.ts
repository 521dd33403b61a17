import { describe, expect, it } from "vitest";

import { takeLinkToken } from "../src/app/address";
import { IdentityStore } from "../src/net/identity_store";

/** Returns the token of a link and the address afterwards. */
function opened(href: string): { token: string | undefined; address: string } {
  let address = href;
  const token = takeLinkToken({ href }, { replaceState: (_data: unknown, _title: string, url?: string | URL | null) => void (address = String(url)) });
  return { token, address };
}

describe("the token of a link", () => {
  it("is returned and removed from the address, and the rest of the address stays", () => {
    expect(opened("http://host:8080/?room=lab#token=ab-c_1")).toEqual({ token: "ab-c_1", address: "http://host:8080/?room=lab" });
    expect(opened("http://host/water/#look=height&token=abc&x=1")).toEqual({ token: "abc", address: "http://host/water/#look=height&x=1" });
  });

  it("keeps the characters of tokens, escaped or not", () => {
    expect(opened("http://host/#token=a+b/c==").token).toBe("a+b/c==");
    expect(opened("http://host/#token=a%2Bb%2Fc%3D%3D").token).toBe("a+b/c==");
    expect(opened("http://host/#token=a%b").token).toBe("a%b");
  });

  it("is undefined without a token, and the address stays as it is", () => {
    for (const href of ["http://host/", "http://host/#", "http://host/#token=", "http://host/#mytoken=abc", "http://host/?token=abc"])
      expect(opened(href)).toEqual({ token: undefined, address: href });
  });

  it("replaces a stored token and is kept for a reload", () => {
    const map = new Map<string, string>();
    const storage = { getItem: (key: string) => map.get(key) ?? null, setItem: (key: string, value: string) => void map.set(key, value) };
    new IdentityStore(storage, "u").leave({ name: "Ada", token: "old", resumeKey: "key" });
    expect(new IdentityStore(storage, "u").load("new")).toEqual({ name: "Ada", token: "new", resumeKey: "key" });
    expect(new IdentityStore(storage, "u").load()).toEqual({ name: "Ada", token: "new", resumeKey: "" });
  });
});
