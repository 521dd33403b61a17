// The page's panel in tests.

/** Opens the folded parts of the panel around a control, as a visitor would, and returns the control. */
export async function unfolded(control) {
  await control.evaluate((element) => {
    for (let box = element.closest("details"); box; box = box.parentElement.closest("details")) box.open = true;
  });
  return control;
}
