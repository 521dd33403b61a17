import { describe, expect, it } from "vitest";

import { takeLinkToken } from "../src/app/address";
import { viewOf } from "../src/app/view_address";
import { IdentityStore } from "../src/net/identity_store";
import { lightOf } from "../src/ui/light_rows";
import { addressAt, linkWith } from "../src/ui/share_link";

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

describe("the view of an address", () => {
  it("is a view that there is, or a camera of six numbers", () => {
    expect(viewOf("?view=side&quality=low")).toEqual({ view: "side" });
    expect(viewOf("?camera=1,2.5,-3,0,0,0")).toEqual({ eyeM: [1, 2.5, -3], targetM: [0, 0, 0] });
    for (const search of ["", "?view=", "?view=boat", "?view=toString", "?camera=1,2,3", "?camera=1,2,3,1,2,3", "?camera=a,2,3,0,0,0", "?camera=1e9,2,3,0,0,0", "?camera=Infinity,0,0,0,0,0"])
      expect(viewOf(search), search).toBeUndefined();
  });

  it("has a light by name or by hour; anything else is automatic", () => {
    expect(lightOf("?light=golden-hour")).toBe("golden hour");
    expect(lightOf("?light=17.5")).toBe(17.5);
    for (const search of ["", "?light=", "?light=25", "?light=-1", "?light=NaN", "?light=toString"]) expect(lightOf(search), search).toBe("automatic");
  });
});

describe("a shared link", () => {
  it("has the address in the network and keeps what was chosen, without a fragment", () => {
    expect(addressAt("http://192.168.1.20:8080/pad", "http://localhost:8080/?room=lab&light=17.5#x")).toBe("http://192.168.1.20:8080/?room=lab&light=17.5");
    expect(addressAt("https://water.example/sea/pad", "http://127.0.0.1/")).toBe("https://water.example/sea/");
  });

  it("leads to this room, to one like it, or to a new one with a token, which is in the fragment", () => {
    const page = "http://h/?room=lab&light=17.5&set=a.b:1#x";
    expect(linkWith(page, {}, "")).toBe("http://h/?room=lab&light=17.5&set=a.b:1");
    expect(linkWith(page, { room: undefined, scene: "pool", set: "a.b:2,c.d:3" }, "")).toBe("http://h/?light=17.5&set=a.b:2,c.d:3&scene=pool");
    expect(linkWith(page, { room: "pool-1", scene: undefined, set: undefined }, "t+/=")).toBe("http://h/?room=pool-1&light=17.5#token=t%2B%2F%3D");
  });
});
