// The bar over the scene: what the loop does and whether it keeps up.

import {find, write} from "./find.js";
import {known, micros, millimetres, seconds} from "./format.js";

const GATES = {active: "active", idle: "idle", fault: "fault", simulated: "simulated"};

export function showGate(gate) {
  find("gate").className = "chip " + gate;
  write(find("gate"), GATES[gate] || gate);
}

export function showFigures(frame, period_s) {
  write(find("time"), seconds(frame.time_s));
  write(find("rate"), known(frame.rate_hz, hz => hz.toFixed(0) + " Hz · " + frame.real_time.toFixed(2) + "×"));
  write(find("late"), known(frame.late_us, late => micros(late.p50) + " / " + micros(late.p99)));
  find("late").parentElement.title = "How late ticks begin: half of them, and 99 of 100, are less late than this."
    + (frame.late_us ? " Latest: " + micros(frame.late_us.max) + "." : "")
    + (frame.skipped ? " Ticks left out: " + frame.skipped + "." : "");
  if (frame.tick_us) showTick(frame.tick_us, 1e6 * period_s, frame.shed);
  write(find("contacts"), known(frame.contacts, n => n + " → " + frame.clusters));
  const deep = frame.depth_m > 0;
  write(find("depth-name"), deep ? "Depth" : "Gap");
  write(find("depth"), known(deep ? frame.depth_m : frame.near_m, millimetres));
}

function showTick(tick_us, period_us, shed) {
  write(find("tick"), micros(tick_us.median) + " of " + micros(period_us));
  const share = us => 100 * Math.min(us / period_us, 1) + "%";
  find("tick-bar").style.width = share(tick_us.median);
  find("tick-mark").style.left = `min(${share(tick_us.p99)}, 100% - 2px)`;
  const gauge = find("tick-bar").parentElement;
  gauge.classList.toggle("over", tick_us.p99 > period_us || shed.length > 0);
  gauge.parentElement.parentElement.title = "What a tick takes, against the period: median " + micros(tick_us.median)
    + ", 99 of 100 within " + micros(tick_us.p99) + " (the mark), longest " + micros(tick_us.max) + "."
    + (shed.length ? " Left out to keep up: " + shed.join(", ") + "." : "");
}
