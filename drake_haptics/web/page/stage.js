// The scene stands in the middle of what the panels leave free.

import {find} from "./find.js";
import {say} from "./link.js";

const SMALL = matchMedia("(max-width: 760px)");
const LABELS = {fit: "Fit", front: "Front", side: "Side", top: "Top"};
// Of what is free, so that nothing touches a panel.
const MARGIN = 0.96;
let names = [];

/** What is free of the window: left, right, top and bottom, px. */
function findFree() {
  const box = id => find(id).getBoundingClientRect();
  return {
    left: box("left").width ? box("left").right : 0,
    right: box("right").width ? box("right").left : innerWidth,
    top: box("bar").bottom,
    bottom: box("tools").top,
  };
}

/** Puts the picture's middle at the middle of what is free; the picture fills the window. */
export function layOut() {
  const style = find("stage").style;
  document.documentElement.style.setProperty("--tools", find("tools").offsetHeight + 12 + "px");
  if (SMALL.matches) {
    style.inset = "";
    return;
  }
  const free = findFree();
  if (document.body.classList.contains("sliders")) {
    // Meshcat's own controls, in its upper right corner, are to be reached.
    style.inset = `${free.top}px ${innerWidth - free.right}px 0 ${free.left}px`;
    return;
  }
  const grow = (low, high, end) => {
    const middle = (low + high) / 2;
    return middle - Math.max(middle, end - middle);
  };
  const [left, top] = [grow(free.left, free.right, innerWidth), grow(free.top, free.bottom, innerHeight)];
  const over = (low, high, end, first) => end - ((low + high) - first);
  style.inset = `${top}px ${over(free.left, free.right, innerWidth, left)}px`
    + ` ${over(free.top, free.bottom, innerHeight, top)}px ${left}px`;
}

/** Asks for a view of the camera that fits into what is free. */
export function aim(name) {
  if (!names.includes(name)) return;
  layOut();
  const {clientWidth: width, clientHeight: height} = find("stage");
  let share = Math.min(width / height, 1);
  if (!SMALL.matches) {
    const free = findFree();
    share = Math.min(free.right - free.left, free.bottom - free.top) / height;
  }
  const within = Number(Math.min(Math.max(MARGIN * share, 0.1), 1).toFixed(3));
  say({do: "camera", to: name, within});
}

export function makeCameras(offered) {
  names = offered;
  find("cameras").hidden = names.length === 0;
  find("cameras").replaceChildren(...names.map((name, i) => {
    const button = document.createElement("button");
    [button.type, button.id] = ["button", "camera-" + name];
    button.innerHTML = LABELS[name] + " <kbd>" + (i + 1) + "</kbd>";
    button.addEventListener("click", () => aim(name));
    return button;
  }));
}

addEventListener("resize", layOut);
new ResizeObserver(layOut).observe(find("tools"));
