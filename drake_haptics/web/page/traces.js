// Both traces: drawn once for each picture in which something is new.

import {isFelt} from "./device.js";
import {find, write} from "./find.js";
import {History} from "./history.js";
import {millinewtonmeters, newtons, norm} from "./format.js";
import {Trace} from "./trace.js";

const history = new History();
const traces = [
  new Trace(find("force-trace"), history, {name: "force", scale: 1, unit: "N", digits: 2, least: 0.5}),
  new Trace(find("torque-trace"), history, {name: "torque", scale: 1e3, unit: "mN·m", digits: 0, least: 10}),
];
let hovered = null;
let quiet_s = 0;
let isAsked = false;

function redraw() {
  if (isAsked) return;
  isAsked = true;
  requestAnimationFrame(() => {
    isAsked = false;
    for (const trace of traces) trace.draw(hovered, quiet_s);
  });
}

export function setLimits({force_N, torque_Nm}) {
  [traces[0].limit, traces[1].limit] = [force_N, torque_Nm];
  redraw();
}

export function showTrace(frame) {
  const felt = isFelt(frame.gate);
  quiet_s = 0;
  history.append(frame.time_s, frame.trace, felt);
  // The loop still asks for what the hand does not feel.
  const end = felt ? "" : ", not shown";
  write(find("force"), newtons(norm(frame.f_W)) + end);
  write(find("torque"), millinewtonmeters(norm(frame.tau_W)) + end);
  redraw();
}

/** Says at the end of the axis how long ago that was. */
export function showQuietTrace(for_s) {
  quiet_s = for_s;
  redraw();
}

for (const trace of traces) {
  trace.canvas.addEventListener("pointermove", event => { hovered = trace.ageAt(event.clientX); redraw(); });
  trace.canvas.addEventListener("pointerleave", () => { hovered = null; redraw(); });
  // Folded away it has no size, and gets none without being drawn.
  new ResizeObserver(redraw).observe(trace.canvas);
}
