// Parts of the page by name.

export const find = id => document.getElementById(id);

/** A copy of a template's only element. */
export const copy = id => find(id).content.firstElementChild.cloneNode(true);

/** Writes a text only where it changed, so that nothing is laid out for nothing. */
export function write(element, text) {
  if (element.textContent !== text) element.textContent = text;
}
