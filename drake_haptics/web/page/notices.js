// What people must know now, in the middle of the top: one notice for each matter.

import {find} from "./find.js";

const shown = new Map();

/** Shows a notice, or takes it away where the text is empty. buttons: of {label, act}. */
export function notify(matter, text, {kind = "", buttons = []} = {}) {
  const before = shown.get(matter);
  if (!text) {
    before?.element.remove();
    shown.delete(matter);
    return;
  }
  if (before) {
    if (before.text !== text) before.element.querySelector("p").textContent = text;
    before.text = text;
    return;
  }
  const element = document.createElement("div");
  element.className = "notice " + kind;
  element.id = "notice-" + matter;
  const words = document.createElement("p");
  words.textContent = text;
  element.append(words);
  for (const button of buttons) {
    const press = document.createElement("button");
    [press.type, press.textContent] = ["button", button.label];
    press.addEventListener("click", button.act);
    element.append(press);
  }
  find("notices").append(element);
  shown.set(matter, {element, text});
}
