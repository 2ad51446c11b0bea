// A warning in two lines, and whole when it is pressed.

/** Makes of a paragraph a warning; without a text it is hidden. */
export function warn(element, text) {
  element.hidden = text === "";
  if (element.textContent === text) return;
  element.textContent = element.title = text;
  element.classList.remove("whole");
  element.tabIndex = 0;
  element.onclick = () => element.classList.toggle("whole");
  element.onkeydown = event => { if (event.key === "Enter") element.onclick(); };
}
