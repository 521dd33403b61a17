// The people in the room with colour, role and boats, and the user's own name and token.
import type { PersonInfo, WelcomeInfo } from "../../client/codec/people";
import type { Identity } from "../../client/session/events";
import { byId, make } from "./dom";
import { kTexts } from "./texts";

/** The server cuts longer names. */
const kNameMaxLength = 32;

export class PeoplePanel {
  private me: WelcomeInfo | undefined;
  private people: readonly PersonInfo[] = [];
  private unlistedCount = 0;
  private readonly list = byId("people");
  private readonly summary = byId("people-summary");
  private readonly name = make("input", { id: "my-name", "data-testid": "my-name", maxlength: String(kNameMaxLength), autocomplete: "nickname" });
  private readonly token = make("input", { id: "my-token", "data-testid": "my-token", type: "password", autocomplete: "off" });

  constructor(identity: Identity, introduce: (name: string, token: string) => void) {
    this.name.value = identity.name;
    this.token.value = identity.token;
    const form = make("form", { class: "me" }, [
      make("label", { for: "my-name" }, [kTexts.myName]),
      this.name,
      make("label", { for: "my-token", title: kTexts.token.help }, [kTexts.token.label]),
      this.token,
      make("button", { type: "submit", "data-testid": "introduce" }, [kTexts.join]),
    ]);
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      introduce(this.name.value.trim(), this.token.value.trim());
    });
    byId("people-box").append(form);
  }

  welcomed(me: WelcomeInfo): void {
    this.me = me;
    this.show();
  }

  /** `unlistedCount`: people who only watch and are not in the list. */
  setPeople(people: readonly PersonInfo[], unlistedCount: number): void {
    this.people = people;
    this.unlistedCount = unlistedCount;
    const mine = people.find(({ personId }) => personId === this.me?.personId);
    this.name.placeholder = mine?.name ?? "";
    this.show();
  }

  private show(): void {
    const count = this.people.length + this.unlistedCount;
    this.summary.textContent = kTexts.people(count);
    this.list.replaceChildren(
      ...this.people.map((person) => {
        const swatch = make("span", { class: "swatch", "aria-hidden": "true" });
        swatch.style.background = person.color;
        const isMe = person.personId === this.me?.personId;
        const facts = [isMe ? kTexts.you : "", kTexts.roles[person.role], person.boatIds.length ? kTexts.boatsOf(person.boatIds) : "", person.away ? kTexts.away : ""];
        return make("li", person.away ? { class: "away" } : {}, [swatch, make("b", {}, [person.name]), ` ${facts.filter(Boolean).join(", ")}`]);
      }),
      ...(this.unlistedCount > 0 ? [make("li", { class: "unlisted" }, [kTexts.moreWatching(this.unlistedCount)])] : []),
    );
  }
}
