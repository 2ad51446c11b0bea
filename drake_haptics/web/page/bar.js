// The bar over the scene: what the loop does and whether it keeps up.

import {find, write} from "./find.js";
import {micros, millimeters, seconds, silence} from "./format.js";

const GATES = {
  simulated: "Hand and arm are simulated: there is no device.",
  active: "What holds the handle is shown force.",
  idle: "What holds the handle is shown no force.",
  fault: "The device is at fault and shows no force.",
  waiting: "The device shows no force until that sets in gently.",
};

export function showGate(gate, fault = "") {
  find("gate").className = "chip " + gate;
  find("gate").ariaLive = "polite";
  find("gate").title = GATES[gate] ?? "";
  write(find("gate"), gate + (fault ? ` (${fault})` : ""));
}

/** Of a loop of which nothing is heard no figure of its pace holds. */
export function showQuiet(for_s) {
  find("gate").className = "chip";
  // A text that changes each second would be read out each second.
  find("gate").ariaLive = "off";
  find("gate").title = "The loop stands still, or its process does.";
  write(find("gate"), "no news for " + silence(for_s));
  write(find("rate"), "0 Hz · 0.00×");
  write(find("late"), "–");
}

export function showFigures(frame, period_s) {
  write(find("time"), seconds(frame.time_s));
  show("rate", frame.rate_hz, hz => hz.toFixed(0) + " Hz · " + frame.real_time.toFixed(2) + "×");
  show("late", frame.late_us, late => micros(late.p50) + " / " + micros(late.p99));
  find("late").parentElement.title = "How late ticks begin: half of them, and 99 of 100, are less late than this."
    + (frame.late_us ? " Latest: " + micros(frame.late_us.max) + "." : "")
    + (frame.skipped ? " Ticks left out: " + frame.skipped + "." : "");
  show("tick", frame.tick_us, tick => micros(tick.median) + " of " + micros(1e6 * period_s));
  if (frame.tick_us) showTick(frame.tick_us, 1e6 * period_s, frame.shed);
  show("contacts", frame.contacts, n => n + " → " + frame.clusters);
  // Without a contact there is no distance, but where there could be one its place stays.
  show("gap", frame.contacts, () => frame.gap_m === null ? "–" : millimeters(frame.gap_m));
}

/** Writes a figure; one of which nothing is known is not there. */
function show(name, value, spell) {
  const isKnown = value !== null && value !== undefined;
  find(name).closest("#figures > div").hidden = !isKnown;
  if (isKnown) write(find(name), spell(value));
}

function showTick(tick_us, period_us, shed) {
  const share = us => 100 * Math.min(us / period_us, 1) + "%";
  find("tick-bar").style.width = share(tick_us.median);
  find("tick-mark").style.left = `min(${share(tick_us.p99)}, 100% - 2px)`;
  const gauge = find("tick-bar").parentElement;
  gauge.classList.toggle("over", tick_us.p99 > period_us || shed.length > 0);
  gauge.parentElement.parentElement.title = "What a tick takes, against the period: median " + micros(tick_us.median)
    + ", 99 of 100 within " + micros(tick_us.p99) + " (the mark), longest " + micros(tick_us.max) + "."
    + (shed.length ? " Left out to keep up: " + shed.join(", ") + "." : "");
}
