// A warning, and when it is pressed the law behind it.

import {write} from "./find.js";

/** Makes of a details element a warning: a text, and why it is so. Without a text it is hidden. */
export function warn(element, text, why) {
  element.hidden = text === "";
  write(element.querySelector("summary"), text);
  write(element.querySelector("p"), why);
}
