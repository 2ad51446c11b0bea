// Keys, and the dialog that lists them.

import {find} from "./find.js";
import {toggleColumn} from "./folds.js";
import {PILOT_KEYS} from "./pilot.js";
import {aim} from "./stage.js";

const showHelp = () => find("help-dialog").showModal();

const ACTS = {
  ...PILOT_KEYS,
  1: () => aim("fit"), 2: () => aim("front"), 3: () => aim("side"), 4: () => aim("top"),
  "[": () => toggleColumn("left"), "]": () => toggleColumn("right"), "?": showHelp,
};

addEventListener("keydown", event => {
  if (event.ctrlKey || event.metaKey || event.altKey || event.repeat) return;
  if (document.querySelector("dialog[open]")) return;
  // Whoever types a number, or walks through choices, means that.
  if (event.target.matches?.(".number, select")) {
    if (event.key === "Escape") event.target.blur();
    return;
  }
  ACTS[event.key.toLowerCase()]?.();
});

find("help").addEventListener("click", showHelp);

// Whoever clicks into the scene still means this page's keys, but for Meshcat's sliders.
addEventListener("blur", () => setTimeout(() => {
  if (document.activeElement === find("view") && !document.body.classList.contains("sliders")) {
    find("view").blur();
    focus();
  }
}));
