// Panels and columns fold, and stay so when the page is opened again. Some open by
// themselves only where their column has room for them.

import {find} from "./find.js";

const KEY = "drake_haptics.cockpit.";
const SMALL = matchMedia("(max-width: 760px)");

function read(name) {
  try {
    return localStorage.getItem(KEY + name);
  } catch {
    return null; // A browser that keeps nothing for pages.
  }
}

function keep(name, value) {
  try {
    localStorage.setItem(KEY + name, value);
  } catch {
    // It is folded all the same.
  }
}

for (const panel of document.querySelectorAll("details.panel")) {
  const kept = read(panel.id);
  if (kept !== null) panel.open = kept === "open";
  else if (SMALL.matches) panel.open = panel.id === "panel-force";
  panel.querySelector("summary").addEventListener("click", () => keep(panel.id, panel.open ? "folded" : "open"));
}

/** Opens the panels that nobody has folded and that their column has room for. */
export function openWhatFits() {
  if (SMALL.matches) return;
  for (const panel of document.querySelectorAll("details[data-if-room]")) {
    if (read(panel.id) !== null) continue;
    panel.open = true;
    panel.open = panel.parentElement.scrollHeight <= panel.parentElement.clientHeight;
  }
}

/** Folds a column, "left" or "right", or unfolds it. */
export function toggleColumn(side) {
  setColumn(side, !document.body.classList.contains("fold-" + side));
}

function setColumn(side, folded) {
  document.body.classList.toggle("fold-" + side, folded);
  find("fold-" + side).setAttribute("aria-expanded", !folded);
  keep(side, folded ? "folded" : "open");
  dispatchEvent(new Event("resize"));
}

for (const side of ["left", "right"]) {
  if (read(side) === "folded") setColumn(side, true);
  find("fold-" + side).addEventListener("click", () => toggleColumn(side));
}
