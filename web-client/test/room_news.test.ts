import { describe, expect, it } from "vitest";

import { RoomNews } from "../src/ui/room_news";

const kOwn = 3;
const kPool = { room: "main", sceneName: "pool", title: "Pool", paused: false, speed: 1, repeats: false };

function news(isChanging = false) {
  const said: string[] = [];
  const made = new RoomNews({
    say: (text) => said.push(text),
    nameOf: (personId) => ({ 3: "Ada", 4: "Ben" })[personId],
    ownId: () => kOwn,
    isChanging: () => isChanging,
  });
  made.enter(kPool);
  return { made, said };
}

describe("news of the room", () => {
  it("names the person who paused the water, and not oneself", () => {
    const { made, said } = news();
    made.state({ paused: true, speed: 1, personId: 4 });
    made.state({ paused: false, speed: 1, personId: kOwn });
    made.state({ paused: true, speed: 1, personId: 0 });
    expect(said).toEqual(["Ben paused the water.", "Somebody paused the water."]);
  });

  it("says nothing of a state that is as before", () => {
    const { made, said } = news();
    made.state({ paused: false, speed: 1, personId: 4 });
    expect(said).toEqual([]);
    made.state({ paused: false, speed: 0.5, personId: 4 });
    expect(said).toEqual(["Ben set the speed to 0.5 ×."]);
  });

  it("tells that others started the scene again, except where it does so by itself", () => {
    const { made, said } = news();
    const reset = { event: "reset", message: "again", personId: 4 } as const;
    made.event(reset);
    made.enter({ ...kPool, repeats: true });
    made.event({ ...reset, personId: 0 });
    expect(said).toEqual(["Ben started the scene again."]);
  });

  it("tells of another scene and fidelity, unless this page asked for it", () => {
    const others = news();
    const own = news(true);
    for (const { made } of [others, own]) {
      made.enter({ ...kPool, sceneName: "harbor", title: "Harbor" });
      made.event({ event: "fidelity", message: "The water continues at draft.", personId: 0 });
      made.event({ event: "recovered", message: "put back", personId: 0 });
    }
    expect(others.said).toEqual(["The scene is now Harbor.", "The water continues at draft.", "put back"]);
    expect(own.said).toEqual(["put back"]);
  });

  it("says nothing where the visitor goes to another room", () => {
    const { made, said } = news();
    made.enter({ ...kPool, room: "tank", sceneName: "tank" });
    expect(said).toEqual([]);
  });
});
