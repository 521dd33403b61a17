// What is wrong with a page's layout, as lines of text: a page wider than the window, controls that are cut off or covered, and texts on top
// of one another or of controls.

/** Looks at the open dialog alone if there is one. Scrolls to each control as a user would; names on the water move, and are left out. */
export function layoutFaults(page) {
  return page.evaluate(async () => {
    // What follows the size of another part does so a picture later.
    for (let k = 0; k < 3; ++k) await new Promise((drawn) => requestAnimationFrame(drawn));
    const kMovingTexts = ".boat-tags, .finger-tags, .course-tags, .unseen";
    const faults = [];
    const nameOf = (element) => `${element.tagName.toLowerCase()}${element.id ? `#${element.id}` : ""}${element.dataset.testid ? `[${element.dataset.testid}]` : ""} "${(element.textContent || element.title || element.ariaLabel || "").trim().slice(0, 40)}"`;
    const isSeen = (element) => element.checkVisibility({ visibilityProperty: true, opacityProperty: true });
    const root = document.scrollingElement;
    if (root.scrollWidth > innerWidth) faults.push(`the page is ${root.scrollWidth} px wide in a window of ${innerWidth}`);
    const top = [...document.querySelectorAll("dialog[open]")].at(-1) ?? document.body;

    /** The part of the window in which what is in `element` can be seen. */
    const clipOf = (element) => {
      const clip = { left: 0, top: 0, right: innerWidth, bottom: innerHeight };
      for (let holder = element.parentElement; holder && holder !== document.body; holder = holder.parentElement) {
        const { overflowX, overflowY, position } = getComputedStyle(holder);
        const box = holder.getBoundingClientRect();
        if (overflowX !== "visible") [clip.left, clip.right] = [Math.max(clip.left, box.left), Math.min(clip.right, box.right)];
        if (overflowY !== "visible") [clip.top, clip.bottom] = [Math.max(clip.top, box.top), Math.min(clip.bottom, box.bottom)];
        if (position === "fixed") break;
      }
      return clip;
    };

    // Texts as they are before anything is scrolled: each line's box, without what is scrolled out of sight.
    const lines = [];
    const walker = document.createTreeWalker(top, NodeFilter.SHOW_TEXT);
    for (let node = walker.nextNode(); node; node = walker.nextNode()) {
      const element = node.parentElement;
      if (node.textContent.trim() === "" || !isSeen(element) || element.closest(`${kMovingTexts}, option, script, style`)) continue;
      const clip = clipOf(node);
      const range = document.createRange();
      range.selectNodeContents(node);
      for (const line of range.getClientRects()) {
        const box = { left: Math.max(line.left, clip.left), right: Math.min(line.right, clip.right), top: Math.max(line.top, clip.top), bottom: Math.min(line.bottom, clip.bottom) };
        if (box.right - box.left > 3 && box.bottom - box.top > 3) lines.push({ element, box });
      }
    }
    lines.forEach((one, k) => {
      for (const other of lines.slice(k + 1)) {
        if (one.element === other.element) continue;
        const wide = Math.min(one.box.right, other.box.right) - Math.max(one.box.left, other.box.left);
        const high = Math.min(one.box.bottom, other.box.bottom) - Math.max(one.box.top, other.box.top);
        // Boxes of lines have room above and below their letters.
        if (wide > 2 && high > 4) faults.push(`${nameOf(one.element)} and ${nameOf(other.element)} overlap by ${Math.round(wide)} x ${Math.round(high)} px`);
      }
    });

    const controls = [...top.querySelectorAll("button, input, select, summary, a[href]")].filter((each) => isSeen(each) && !each.closest(`[aria-hidden=true], ${kMovingTexts}`));
    for (const { element, box } of lines)
      for (const control of controls) {
        if (control.contains(element)) continue;
        const [at, clip] = [control.getBoundingClientRect(), clipOf(control)];
        const wide = Math.min(box.right, at.right, clip.right) - Math.max(box.left, at.left, clip.left);
        const high = Math.min(box.bottom, at.bottom, clip.bottom) - Math.max(box.top, at.top, clip.top);
        if (wide > 2 && high > 4) faults.push(`${nameOf(element)} is ${Math.round(wide)} x ${Math.round(high)} px on ${nameOf(control)}`);
      }

    for (const control of controls) {
      control.scrollIntoView({ block: "center", inline: "nearest", behavior: "instant" });
      const box = control.getBoundingClientRect();
      const clip = clipOf(control);
      // What is higher than the window is seen by scrolling.
      const isHigher = box.bottom - box.top > clip.bottom - clip.top;
      const over = Math.max(clip.left - box.left, box.right - clip.right, ...(isHigher ? [] : [clip.top - box.top, box.bottom - clip.bottom]));
      if (over > 1) faults.push(`${nameOf(control)} is cut off by ${Math.round(over)} px`);
      if (/^(BUTTON|SUMMARY)$/.test(control.tagName) && control.scrollWidth > control.clientWidth + 1) faults.push(`${nameOf(control)} has ${control.clientWidth} px for ${control.scrollWidth} px of text`);
      const at = document.elementFromPoint((box.left + box.right) / 2, (box.top + box.bottom) / 2);
      if (!control.contains(at) && !at?.closest("label")?.contains(control)) faults.push(`${nameOf(control)} is covered by ${at ? nameOf(at) : "nothing"}`);
    }
    return faults;
  });
}
