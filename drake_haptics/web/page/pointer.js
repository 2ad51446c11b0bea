// What the pointer asks of the handle, sent once a picture: shares of the view's height.

import {find} from "./find.js";
import {say} from "./link.js";

const layer = find("layer");
const asked = {move: [0, 0, 0], turn: [0, 0, 0]};
const pointers = new Map();
let isAsked = false;

function ask(verb, right, up, third) {
  [right, up, third].forEach((x, i) => { asked[verb][i] += x; });
  if (isAsked) return;
  isAsked = true;
  requestAnimationFrame(send);
}

function send() {
  isAsked = false;
  for (const verb of ["move", "turn"]) {
    if (asked[verb].some(x => x !== 0)) {
      say({do: verb, by: asked[verb].map(x => Math.max(-1, Math.min(1, x)))});
      asked[verb] = [0, 0, 0];
    }
  }
}

/** Puts the ring where the handle is: right and up of the middle, in heights of the view. */
export function showHandle(handle) {
  const ring = find("ring");
  ring.style.visibility = handle ? "visible" : "hidden";
  if (!handle) return;
  ring.setAttribute("cx", layer.clientWidth / 2 + handle[0] * layer.clientHeight);
  ring.setAttribute("cy", layer.clientHeight / 2 - handle[1] * layer.clientHeight);
}

layer.addEventListener("pointerdown", event => {
  layer.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, [event.clientX, event.clientY]);
  layer.classList.add("held");
});

layer.addEventListener("pointermove", event => {
  const before = pointers.get(event.pointerId);
  if (!before) return;
  const now = [event.clientX, event.clientY], height = layer.clientHeight;
  pointers.set(event.pointerId, now);
  const right = (now[0] - before[0]) / height, up = (before[1] - now[1]) / height;
  const other = [...pointers].find(([id]) => id !== event.pointerId);
  if (other) {
    // Each of two fingers makes half of the motion; spreading them pulls near.
    const gap = p => Math.hypot(p[0] - other[1][0], p[1] - other[1][1]);
    ask("turn", right / 2, up / 2, 0);
    ask("move", 0, 0, (gap(before) - gap(now)) / height);
  } else if (event.shiftKey || event.buttons & 2) {
    ask("turn", right, up, 0);
  } else {
    ask("move", right, up, 0);
  }
});

for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) {
  layer.addEventListener(end, event => {
    pointers.delete(event.pointerId);
    layer.classList.toggle("held", pointers.size > 0);
  });
}
layer.addEventListener("contextmenu", event => event.preventDefault());

layer.addEventListener("wheel", event => {
  event.preventDefault();
  // With Shift, browsers say that the wheel goes sideways.
  const lines = (event.deltaY || event.deltaX) / (event.deltaMode === 0 ? 100 : 3);
  if (event.shiftKey) ask("turn", 0, 0, 0.03 * lines);
  else ask("move", 0, 0, -0.03 * lines);
}, {passive: false});
