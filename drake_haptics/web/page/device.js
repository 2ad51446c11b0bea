// What the page says of a device that shows no force: why, and what to do.

import {say} from "./link.js";
import {notify} from "./notices.js";

const FAULTS = {
  stale: "commands came too late",
  "not finite": "it was sent something that is not a number",
  overspeed: "the handle was too fast",
  clock: "its clock went back",
  device: "its driver finds it at fault",
};
// Seconds of silence, in steps: a text that changes each second would be read out each second.
const SILENCES_S = [1, 5, 10, 30, 60, 300];
// Who takes a device in the open waits for less, and need not be told.
const PATIENCE_MS = 600;
let waitsFrom = null;

/** Whether what is asked for is felt, or is that of a simulated hand. */
export const isFelt = gate => gate === "active" || gate === "simulated";

export function showDevice({gate, fault, silent_s}) {
  document.body.classList.toggle("unfelt", !isFelt(gate));
  const isFault = gate === "fault", silence = SILENCES_S.filter(s => s <= silent_s).pop();
  notify("silent", isFault && silence ? `The device's driver has been silent for ${silence} s or more: is it running?`
    + " No force is shown." : "", {kind: "fault"});
  notify("fault", isFault && !silence ? `The device shows no force: ${FAULTS[fault] ?? "it is at fault"}. Mend that,`
    + " hold it, and enable it again." : "",
    {kind: "fault", buttons: [{label: "Take it up again", act: () => say({do: "resume"})}]});
  waitsFrom = gate === "waiting" ? waitsFrom ?? performance.now() : null;
  const isLong = waitsFrom !== null && performance.now() - waitsFrom > PATIENCE_MS;
  notify("waiting", isLong ? "No force is shown yet: it would set in with a kick. Lead the device's handle to where"
    + " the tool can follow, or let it set in as it is." : "",
    {kind: "warn", buttons: [{label: "Show it now", act: () => say({do: "resume"})}]});
}
