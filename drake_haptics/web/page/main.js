// Joins the run and the page's parts.

import {showCompass} from "./compass.js";
import {showFigures, showGate, showQuiet} from "./bar.js";
import {showDevice} from "./device.js";
import {showDirection} from "./dial.js";
import {find, write} from "./find.js";
import {openWhatFits} from "./folds.js";
import {connect, say} from "./link.js";
import {notify} from "./notices.js";
import {showHandle} from "./pointer.js";
import {setDriving, setHandle} from "./pilot.js";
import {makeSliders, placeWarnings, showValues} from "./sliders.js";
import "./shortcuts.js";
import {aim, layOut, makeCameras} from "./stage.js";
import {makeChoices, makeHandles, makeSwitches, showSwitches} from "./switches.js";
import {setLimits, showQuietTrace, showTrace} from "./traces.js";
import {setYaml} from "./yaml.js";

// What a page is told may leave out what does not apply: the pointer of somebody's own program
// has no scene to be changed.
const QUIET = "Nothing is heard of the run: it stands still. What you change acts when it goes on.";
const DEEP = "The tool is deep in an object: a stiffer contact holds it further out.";
// Contacts push from the tolerance on: one that is soft on purpose gives way by about as much again.
const DEEP_TOLERANCES = 2;
const MAKERS = {
  // Sliders of effects are below their switches, which are there before.
  effects: list => makeSwitches("effect", list), keys: makeSliders, choices: makeChoices, handles: makeHandles,
  cameras: makeCameras, legend: makeLegend, views: list => makeSwitches("view", list),
};
const made = {};
let settings = {limits: {force_N: 0, torque_Nm: 0}, period_s: 1e-3};
let tolerance_m = Infinity;
let isFramed = false;
let relief = "";
let start = "";
let dismissed = "";

const on = {
  hello(hello) {
    const isFirst = !find("view").src;
    // Another run at this page's port: this page may frame no other Meshcat than the first one's.
    if (find("view").src && new URL(find("view").src).origin !== new URL(hello.meshcat).origin) location.reload();
    settings = hello;
    document.body.classList.remove("over");
    for (const matter of ["link", "over"]) notify(matter, "");
    if (find("view").src !== hello.meshcat) find("view").src = hello.meshcat;
    write(find("scene"), hello.scene);
    write(find("description"), hello.description);
    find("title").title = hello.description;
    document.title = hello.scene + " – haptic cockpit";
    setLimits(hello.limits);
    for (const [name, make] of Object.entries(MAKERS)) makeAnew(name, hello[name] ?? [], make);
    showPanels(hello);
    write(find("locked"), hello.locked ?? "");
    find("locked").hidden = !hello.locked;
    if (isFirst) openWhatFits();
    layOut();
  },

  frame(frame) {
    notify("watching", frame.drives ? "" : "Another page drives. This one watches.",
           {buttons: [{label: "Drive from here", act: () => say({do: "take"})}]});
    setQuiet(false);
    showDevice(frame);
    notify("shed", frame.shed.length ? `Ticks take too long. Left out: ${frame.shed.join(", ")}. ${relief}` : "", {kind: "warn"});
    notify("deep", frame.gap_m < -DEEP_TOLERANCES * tolerance_m ? DEEP : "", {kind: "warn"});
    showGate(frame.gate, frame.fault);
    enable(frame.drives);
    // A loop that stands still has no new tick to tell of.
    if (frame.f_W) {
      showFigures(frame, settings.period_s);
      showTrace(frame);
      showDirection(frame, settings.limits.force_N);
    }
    showHandle(frame.handle);
    // The camera that the run knows is that of the page that drives.
    showCompass(frame.drives ? frame : {});
    if (frame.drives && !isFramed) {
      isFramed = true;
      aim("fit");
    }
  },

  quiet({for_s}) {
    setQuiet(true);
    showQuiet(for_s);
    showQuietTrace(for_s);
  },

  state(state) {
    showValues(state);
    tolerance_m = state.values?.["contact.tolerance_m"] ?? Infinity;
    showSwitches(state);
    placeWarnings(state.warnings ?? []);
    setHandle(state.handle, settings.handles ?? []);
    setYaml(state.yaml ?? "");
    notify("error", state.error ?? "", {kind: "fault", buttons: [makeDismiss("error")]});
    relief = state.relief ?? "";
    start = state.start;
    const restart = {label: "Restart", act: () => say({do: "restart"})};
    notify("start", start !== dismissed ? start : "", {kind: "warn", buttons: [
      // A simulated hand would begin there again.
      ...(state.handle === "device" && !settings.locked ? [restart] : []),
      makeDismiss("start", () => { dismissed = start; }),
    ]});
  },

  over({why}) {
    end("ended");
    document.body.classList.add("over");
    notify("link", "");
    notify("over", (why || "The run has ended.") + " What it left is still to be read.");
  },

  lost() {
    // A run that has said its last word stays so.
    if (find("notice-over")) return;
    end("connecting");
    notify("link", "Cannot reach the run: it has ended, or has not begun. Trying again.");
  },
};

/** Nothing that is shown is of now while nothing is heard of the run. */
function setQuiet(is) {
  document.body.classList.toggle("quiet", is);
  notify("quiet", is ? QUIET : "", {kind: "warn"});
}

/** Nothing can be changed any more; traces and figures stay. */
function end(gate) {
  setQuiet(false);
  showGate(gate);
  enable(false);
  showHandle(null);
  showCompass({});
  // What Meshcat says at its upper edge is said here: the bar is over that edge again.
  document.body.classList.remove("sliders");
  layOut();
  for (const matter of ["watching", "silent", "fault", "waiting", "start", "shed", "deep", "error"]) notify(matter, "");
}

/** A button that takes a notice away. */
function makeDismiss(matter, act = () => {}) {
  return {label: "Dismiss", act: () => { act(); notify(matter, ""); }};
}

function enable(drives) {
  for (const part of document.querySelectorAll(".change")) part.disabled = !drives || Boolean(settings.locked);
  for (const part of document.querySelectorAll(".view, #cameras button")) part.disabled = !drives;
  setDriving(drives && !settings.locked);
}

/** Makes controls only where they are others: whoever is at one stays there. */
function makeAnew(name, list, make) {
  const text = JSON.stringify(list);
  if (made[name] !== text) make(list);
  made[name] = text;
}

function makeLegend(legend) {
  find("legend").replaceChildren(...legend.map(({color, label}) => {
    const [item, patch] = [document.createElement("li"), document.createElement("i")];
    patch.style.background = color;
    item.append(patch, label);
    return item;
  }));
}

/** Hides what would be empty. */
function showPanels({keys = [], choices = [], effects = [], handles = [], views = [], legend = []}) {
  const has = group => keys.some(key => key.group === group);
  const filled = {
    coupling: has("coupling"), contact: has("contact") || choices.length, effects: effects.length,
    handles: handles.length > 1, views: views.length, legend: legend.length,
  };
  for (const [name, is] of Object.entries(filled)) find("panel-" + name).hidden = !is;
  find("actions").hidden = !(keys.length || effects.length);
  // A program that only lends its handle to the pointer has nothing to be changed.
  find("right").hidden = find("fold-right").hidden = !document.querySelector("#right > .panel:not([hidden])");
}

notify("link", "Connecting to the run.");
connect(on);
