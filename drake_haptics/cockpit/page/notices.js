// What people must know now, in the middle of the top: one notice for each matter.

import {find} from "./find.js";

const shown = new Map();

/** Shows a notice, or takes it away where the text is empty. button: {label, act}. */
export function notify(matter, text, {kind = "", button = null} = {}) {
  const before = shown.get(matter);
  if (!text) {
    before?.element.remove();
    shown.delete(matter);
    return;
  }
  if (before?.text === text) return;
  before?.element.remove();
  const element = document.createElement("div");
  element.className = "notice " + kind;
  element.id = "notice-" + matter;
  const words = document.createElement("p");
  words.textContent = text;
  element.append(words);
  if (button) {
    const press = document.createElement("button");
    [press.type, press.textContent] = ["button", button.label];
    press.addEventListener("click", button.act);
    element.append(press);
  }
  find("notices").append(element);
  shown.set(matter, {element, text});
}
