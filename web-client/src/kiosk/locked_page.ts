// Takes from the browser what leads visitors out of the page: menus, zoom, selection, dragging, links, and keys that the water does not use.

/** Keys that act on the water or move the focus. */
const kKeys = /^(Arrow(Up|Down|Left|Right)|Enter|Space|Tab|Digit[1-7]|Numpad(Add|Subtract)|Equal|Minus|Comma|Period|Key[QEWASD])$/;

/** `isOffered`: the button with this number in the row of tools is there for visitors. */
export function lockPage(isOffered: (digit: number) => boolean): void {
  const prevent = (event: Event): void => event.preventDefault();
  for (const type of ["contextmenu", "dragstart", "selectstart", "gesturestart"]) window.addEventListener(type, prevent, { capture: true });
  window.addEventListener("wheel", (event) => event.ctrlKey && event.preventDefault(), { capture: true, passive: false });
  window.addEventListener("click", (event) => event.target instanceof Element && event.target.closest("a[href]") && event.preventDefault(), { capture: true });
  window.addEventListener("keydown", (event) => {
    const digit = /^Digit(\d)$/.exec(event.code)?.[1];
    const isTaken = kKeys.test(event.code) && !event.ctrlKey && !event.altKey && !event.metaKey && (digit === undefined || isOffered(Number(digit)));
    if (isTaken) return;
    event.preventDefault();
    event.stopImmediatePropagation();
  }, { capture: true });
  document.querySelector("meta[name=viewport]")?.setAttribute("content", "width=device-width, initial-scale=1, maximum-scale=1, user-scalable=no, viewport-fit=cover");
}
