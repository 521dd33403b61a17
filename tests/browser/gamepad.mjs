/**
 * Puts a gamepad of the standard mapping into a page: `window.pad`, to change its axes, and `window.effects`, what its motors played.
 * @param {import("playwright-core").Page} page
 * @returns {Promise<(button: number) => Promise<void>>} presses a button for as many pictures as the page needs to see it: a press of a
 * fixed time is a long one where pictures are slow.
 */
export async function plugGamepad(page) {
  await page.evaluate(() => {
    window.effects = [];
    const vibrationActuator = { playEffect: async (kind, effect) => window.effects.push(effect) };
    window.pad = { mapping: "standard", axes: [0, 0, 0, 0], buttons: Array.from({ length: 17 }, () => ({ pressed: false })), vibrationActuator };
    navigator.getGamepads = () => [window.pad];
  });
  return (button) =>
    page.evaluate(async (k) => {
      const picture = () => new Promise((done) => requestAnimationFrame(done));
      for (const pressed of [true, false]) {
        window.pad.buttons[k].pressed = pressed;
        await picture();
        await picture();
      }
    }, button);
}
