// The page's address holds what was chosen by hand, so that a reload and a copied address keep it.

/** `value` undefined: the default, which the address leaves out. */
export function setAddressParameter(name: string, value: string | undefined): void {
  const url = new URL(location.href);
  if (value === undefined) url.searchParams.delete(name);
  else url.searchParams.set(name, value);
  history.replaceState(null, "", url);
}
