// Sliders with a number beside them: what a key of the scene is now, and was in its file.

import {copy, find} from "./find.js";
import {rounded} from "./format.js";
import {ask, isBefore} from "./link.js";
import {warn} from "./warning.js";

const STEPS = 1000;
const rows = new Map();

/** Units that people read in place of those of the keys, and how many make one. */
const SHOWN = {m: {unit: "mm", scale: 1e3}};

/** Makes a slider for each key, in the panel of its group. */
export function makeSliders(keys) {
  rows.clear();
  for (const group of ["coupling", "contact", "effects"]) {
    find(group).querySelectorAll(".slider").forEach(row => row.remove());
  }
  for (const key of keys) {
    const row = new Slider(key);
    rows.set(key.key, row);
    if (key.group === "effects") placeBelowSwitch(row.element, key.key.split(".")[1]);
    else find(key.group).append(row.element);
  }
}

/** Puts a slider of an effect below its switch and the sliders that are there. */
function placeBelowSwitch(element, effect) {
  let above = find("effect-" + effect).closest(".switch");
  while (above.nextElementSibling?.classList.contains("slider")) above = above.nextElementSibling;
  above.after(element);
}

export function showValues({values = {}, answered}) {
  for (const [key, value] of Object.entries(values)) rows.get(key)?.show(value, answered);
}

/** A refusal has been read when something else is asked for. */
function forgetRefusals() {
  for (const row of rows.values()) row.refuse("");
}
// Before whoever is asked, who may refuse that, too.
find("right").addEventListener("change", forgetRefusals, true);
find("actions").addEventListener("click", forgetRefusals, true);

/** Puts warnings, {key, words, why}, at the sliders that they are about. */
export function placeWarnings(warnings) {
  for (const [key, row] of rows) {
    const found = warnings.filter(warning => warning.key === key);
    const join = part => found.map(warning => warning[part]).join(" ");
    warn(row.note, join("words"), join("why"));
  }
}

class Slider {
  constructor(key) {
    this.key = key;
    const {unit, scale} = SHOWN[key.unit] ?? {unit: key.unit, scale: 1};
    [this.unit, this.scale] = [unit, scale];
    const [low, high, file] = [key.low, key.high, key.file].map(value => this._text(value));
    this.element = copy("slider-row");
    const part = selector => this.element.querySelector(selector);
    [this.number, this.range] = [part(".number"), part("input[type=range]")];
    [this.undo, this.note, this.refusal] = [part(".undo"), part(".warning"), part(".refusal")];
    const label = part("label");
    [this.number.id, this.note.id] = [key.key, key.key + ".warning"];
    label.htmlFor = key.key;
    label.textContent = key.label;
    part(".unit").textContent = unit;
    this.bounds = `${low} to ${high} ${unit}`.trim();
    const help = key.unit ? key.help.replace(", " + key.unit, "") : key.help;
    label.title = help;
    this.range.setAttribute("aria-label", key.label + ", slider");
    for (const input of [this.number, this.range]) {
      input.title = `${help} It goes from ${this.bounds}; the scene file has ${file}.`;
    }
    // The thumb's middle goes from 8 px to 8 px before the end.
    part(".mark").style.left = `calc(8px + ${this._share(key.file)} * (100% - 16px))`;
    this.isAsked = false;
    this.asked = 0;
    this.range.addEventListener("input", () => this._ask(rounded(this._value(this.range.value / STEPS))));
    this.number.addEventListener("change", () => this._take());
    this.number.addEventListener("input", () => this.refuse(""));
    this.number.addEventListener("keydown", event => { if (event.key === "Escape") this._forget(); });
    this.range.addEventListener("dblclick", () => this._reset());
    this.undo.addEventListener("click", () => this._reset());
  }

  show(value, answered) {
    // What a hand is on stays as it is: the answer to an older wish is on its way. A page that no longer drives is
    // not answered.
    if (this.isAsked || (!this.number.matches(":disabled") && isBefore(answered, this.asked))) return;
    this.element.classList.remove("waiting");
    this._write(value);
  }

  _write(value) {
    this.shown = value;
    if (document.activeElement !== this.number) this.number.value = this._text(value);
    this.range.value = Math.round(STEPS * this._share(value));
    this.range.style.setProperty("--share", `calc(8px + ${this._share(value)} * (100% - 16px))`);
    this.range.setAttribute("aria-valuetext", this._text(value) + " " + this.unit);
    const changed = Math.abs(value - this.key.file) > 1e-9 * Math.abs(this.key.file);
    this.element.classList.toggle("changed", changed);
    this.undo.hidden = !changed;
  }

  /** Sends what was asked for last, once a picture. */
  _ask(value) {
    this.refuse("");
    this.wanted = Math.min(Math.max(value, this.key.low), this.key.high);
    this._write(this.wanted);
    if (this.isAsked) return;
    this.isAsked = true;
    this.element.classList.add("waiting");
    requestAnimationFrame(() => {
      this.isAsked = false;
      this.asked = ask({do: "set", key: this.key.key, to: this.wanted});
    });
  }

  /** Takes the number that was typed. A number out of range changes nothing: a hand may hold the handle. */
  _take() {
    const typed = this.number.value.trim();
    if (typed === String(this._text(this.shown))) return;
    const value = typed === "" ? NaN : Number(typed) / this.scale;
    const [low, high] = [this.key.low, this.key.high].map(bound => this._text(bound));
    if (!Number.isFinite(value)) {
      this.refuse(typed && `“${typed}” is not a number` + (typed.includes(",") ? ": write a point for the comma." : "."));
    } else if (Number(typed) < low || Number(typed) > high) {
      this.refuse(`${typed} is out of range: ${this.bounds}.`);
    } else {
      this._ask(value);
    }
    this.number.value = this._text(this.shown);
  }

  /** Takes back what was typed and not sent. */
  _forget() {
    this.number.value = this._text(this.shown);
    this.refuse("");
  }

  /** Says why a number was not taken; an empty text takes that back. */
  refuse(why) {
    this.refusal.textContent = why;
    this.refusal.hidden = !why;
  }

  _reset() {
    this._ask(this.key.file);
    this.number.value = this._text(this.key.file);
    if (document.activeElement === this.undo) this.range.focus();
  }

  _text(value) {
    return Number((this.scale * value).toPrecision(6));
  }

  _share(value) {
    const {low, high, log} = this.key;
    const share = log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
    return Math.min(Math.max(share, 0), 1);
  }

  _value(share) {
    const {low, high, log} = this.key;
    return log ? low * (high / low) ** share : low + share * (high - low);
  }
}
