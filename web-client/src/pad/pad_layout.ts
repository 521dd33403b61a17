// The pad's elements: a bar with one's name, the map with its messages, the helm, and the tools.
import { kLessonToolNames, type LessonTool } from "../../client/codec/lesson";
import { make } from "../ui/dom";
import { toolIcon } from "./icons";
import { kPadTexts } from "../ui/pad_texts";
import { kTexts } from "../ui/texts";

export interface PadElements {
  me: HTMLButtonElement;
  myName: HTMLElement;
  standing: HTMLElement;
  state: HTMLElement;
  retry: HTMLButtonElement;
  map: HTMLElement;
  canvas: HTMLCanvasElement;
  headline: HTMLElement;
  /** Large, in the middle: a countdown. */
  count: HTMLElement;
  /** Why nothing can be done now. */
  veil: HTMLElement;
  hint: HTMLElement;
  helm: HTMLElement;
  speed: HTMLElement;
  heading: HTMLElement;
  launch: HTMLButtonElement;
  remove: HTMLButtonElement;
  tools: HTMLElement;
  buttons: ReadonlyMap<LessonTool, HTMLButtonElement>;
  dialog: HTMLDialogElement;
  form: HTMLFormElement;
  name: HTMLInputElement;
}

/** The server cuts longer names. */
const kNameMaxLength = 24;

/** Replaces the page's body. */
export function makePadLayout(): PadElements {
  const myName = make("b", { "data-testid": "pad-name" });
  const me = make("button", { type: "button", class: "pad-me", "data-testid": "pad-me" }, [make("span", { class: "pad-swatch", "aria-hidden": "true" }), myName]);
  const standing = make("span", { class: "pad-standing", "data-testid": "pad-standing", role: "status" });
  const state = make("span", { class: "pad-state", "data-testid": "pad-state", role: "status" });
  const retry = make("button", { type: "button", hidden: "" }, [kTexts.page.retry]);
  const canvas = make("canvas", { class: "pad-canvas", "data-testid": "pad-canvas", tabindex: "0", role: "application", "aria-label": kPadTexts.water });
  const headline = make("p", { class: "pad-headline", "data-testid": "pad-headline", role: "status", hidden: "" });
  const count = make("p", { class: "pad-count", "data-testid": "pad-count", "aria-hidden": "true" });
  const veil = make("p", { class: "pad-veil", "data-testid": "pad-veil", role: "status", hidden: "" });
  const hint = make("p", { class: "pad-hint", "data-testid": "pad-hint", role: "status", hidden: "" });
  const speed = make("b", { "data-testid": "pad-speed" });
  const heading = make("b", { "data-testid": "pad-heading" });
  const launch = make("button", { type: "button", class: "primary pad-launch", "data-testid": "pad-launch" }, [kPadTexts.launch]);
  const remove = make("button", { type: "button", "data-testid": "pad-remove", "aria-label": kPadTexts.takeOutLabel }, [kPadTexts.takeOut]);
  const readouts = make("dl", { class: "pad-readouts" }, [make("div", {}, [make("dt", {}, [kPadTexts.speed]), make("dd", {}, [speed])]), make("div", {}, [make("dt", {}, [kPadTexts.heading]), make("dd", {}, [heading])]), remove]);
  const helm = make("div", { class: "pad-helm", hidden: "" }, [readouts, launch]);
  const buttons = new Map(
    kLessonToolNames.map((tool): [LessonTool, HTMLButtonElement] => {
      const button = make("button", { type: "button", "data-testid": `pad-tool-${tool}`, "aria-pressed": "false" }, [make("span", {}, [kTexts.lessonTools[tool]])]);
      button.prepend(toolIcon(tool));
      return [tool, button];
    }),
  );
  const tools = make("nav", { class: "pad-tools", "aria-label": kPadTexts.tools }, [...buttons.values()]);
  const name = make("input", { id: "pad-my-name", "data-testid": "pad-my-name", maxlength: String(kNameMaxLength), autocomplete: "nickname", enterkeyhint: "done" });
  const form = make("form", { method: "dialog" }, [make("label", { for: "pad-my-name" }, [kTexts.myName]), name, make("button", { type: "submit", class: "primary", "data-testid": "pad-save-name" }, [kPadTexts.useName])]);
  const dialog = make("dialog", { class: "pad-dialog glass" }, [form]);
  const map = make("main", { class: "pad-map" }, [canvas, headline, count, hint, helm, veil]);
  document.body.className = "pad-page";
  document.body.replaceChildren(make("header", { class: "pad-bar" }, [me, standing, state, retry]), map, tools, dialog);
  return { me, myName, standing, state, retry, map, canvas, headline, count, veil, hint, helm, speed, heading, launch, remove, tools, buttons, dialog, form, name };
}
