// One live trace on a canvas: its own axis, the device's limit, the largest value.

import {silence} from "./format.js";
import {SPAN_S} from "./history.js";

const MARGIN = {left: 38, right: 12, top: 16, bottom: 17};
const STEPS = [1, 2, 5, 10];
// The axis ends at so many parts of a step: at whole ones a third of it may stay empty.
const PARTS = 5;
// Of what was asked for and not shown.
const UNFELT = "#8b939f";

/** The step of an axis that reaches a value in two to five steps. */
function niceStep(top) {
  const power = 10 ** Math.floor(Math.log10(top / 2.5));
  return power * STEPS.find(s => s * power >= top / 4);
}

export class Trace {
  /** name: of the history's values; scale and unit: how they are written; least: of an axis. */
  constructor(canvas, history, {name, scale, unit, digits, least}) {
    Object.assign(this, {canvas, history, name, scale, unit, digits, least});
    this.limit = 0;
    this.peak = 0;
    this.color = getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
    this.size = [0, 0];
  }

  /** Draws; with the value at an age, if the pointer is there; its end may be some seconds ago. */
  draw(age = null, quiet_s = 0) {
    const context = this._fit();
    if (!context) return;
    const [width, height] = this.size, {left, right, top, bottom} = MARGIN;
    this.peak = 0;
    this.history.forEach(this.name, (_, v) => { if (v > this.peak) this.peak = v; });
    const reach = Math.max(1.08 * this.scale * this.peak, this.least), step = niceStep(reach);
    const most = step * Math.ceil(PARTS * reach / step) / PARTS;
    const x = a => width - right - (a / SPAN_S) * (width - left - right);
    const y = v => height - bottom - (this.scale * v / most) * (height - top - bottom);
    this._drawAxes(context, x, step, most, quiet_s);
    this._drawLimit(context, y, most);
    this._drawLine(context, x, y);
    if (age !== null) this._drawReading(context, x, y, age);
  }

  /** The age under a pixel of the window. */
  ageAt(clientX) {
    const {left, right} = MARGIN, box = this.canvas.getBoundingClientRect();
    const share = (box.right - right - clientX) / (box.width - left - right);
    return SPAN_S * Math.min(Math.max(share, 0), 1);
  }

  /** Makes the canvas as sharp as the screen, and empty; null while it is folded away. */
  _fit() {
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
    if (!width || !height) return null;
    const ratio = devicePixelRatio || 1;
    const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (this.canvas.width !== w || this.canvas.height !== h) [this.canvas.width, this.canvas.height] = [w, h];
    this.size = [width, height];
    const context = this.canvas.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    context.font = "11px system-ui, sans-serif";
    return context;
  }

  _drawAxes(context, x, step, most, quiet_s) {
    const [width, height] = this.size, {left, right, top, bottom} = MARGIN;
    const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    context.strokeStyle = "rgb(20 30 50 / 0.10)";
    context.fillStyle = "#5a626e";
    context.lineWidth = 1;
    context.textAlign = "right";
    context.textBaseline = "middle";
    context.beginPath();
    for (let v = 0; v < most + step / 2; v += step) {
      const row = Math.round(height - bottom - (v / most) * (height - top - bottom)) + 0.5;
      context.moveTo(left, row);
      context.lineTo(width - right, row);
      context.fillText(v.toFixed(digits), left - 5, row);
    }
    context.stroke();
    context.textBaseline = "alphabetic";
    context.textAlign = "center";
    for (let age = 8; age > 0; age -= 2) context.fillText("−" + age + (age === 8 ? " s" : ""), x(age), height - 4);
    context.textAlign = "right";
    context.fillText(quiet_s ? silence(quiet_s) + " ago" : "now", width - right, height - 4);
  }

  /** The device's limit: a line where the axis reaches it, else how far it is. */
  _drawLimit(context, y, most) {
    if (!this.limit) return;
    const [width] = this.size, {left, right} = MARGIN;
    const shown = this.scale * this.limit <= most;
    const text = "limit " + (this.scale * this.limit).toFixed(this.digits);
    context.fillStyle = context.strokeStyle = "rgb(190 40 40 / 0.85)";
    context.textAlign = "left";
    context.fillText(shown ? text : "↑ " + text, left + 3, 11);
    context.fillStyle = this.color;
    context.textAlign = "right";
    const peak = (this.scale * this.peak).toFixed(this.digits);
    context.fillText("largest " + peak, width - right, 11);
    if (!shown) return;
    context.setLineDash([5, 4]);
    context.beginPath();
    context.moveTo(left, y(this.limit));
    context.lineTo(width - right, y(this.limit));
    context.stroke();
    context.setLineDash([]);
  }

  _drawLine(context, x, y) {
    let before = null, first = 0;
    const end = () => {
      if (before === null) return;
      context.strokeStyle = context.fillStyle = before.felt ? this.color : UNFELT;
      context.stroke();
      context.lineTo(x(before.age), y(0));
      context.lineTo(x(first), y(0));
      context.globalAlpha = 0.09;
      context.fill();
      context.globalAlpha = 1;
    };
    context.lineWidth = 1.6;
    context.lineJoin = "round";
    this.history.forEach(this.name, (age, v, felt) => {
      if (before?.felt !== felt) {
        end();
        context.beginPath();
        context.moveTo(x(age), y(v));
        first = age;
      } else context.lineTo(x(age), y(v));
      before = {age, felt};
    });
    end();
  }

  _drawReading(context, x, y, age) {
    const sample = this.history.at(age);
    if (!sample) return;
    const [column, row] = [x(sample.age), y(sample[this.name])], [width] = this.size;
    context.strokeStyle = "rgb(20 30 50 / 0.35)";
    context.lineWidth = 1;
    context.beginPath();
    context.moveTo(Math.round(column) + 0.5, MARGIN.top);
    context.lineTo(Math.round(column) + 0.5, this.size[1] - MARGIN.bottom);
    context.stroke();
    context.fillStyle = this.color;
    context.beginPath();
    context.arc(column, row, 3.2, 0, 7);
    context.fill();
    const value = (this.scale * sample[this.name]).toFixed(this.digits + 1);
    const text = value + " " + this.unit + " at −" + sample.age.toFixed(2) + " s";
    const wide = context.measureText(text).width + 12;
    const at = Math.min(Math.max(column - wide / 2, 2), width - wide - 2);
    const under = row < MARGIN.top + 30 ? row + 10 : row - 28;
    context.fillStyle = "rgb(32 36 43 / 0.92)";
    context.beginPath();
    context.roundRect(at, under, wide, 18, 5);
    context.fill();
    context.fillStyle = "white";
    context.textAlign = "left";
    context.fillText(text, at + 6, under + 13);
  }
}
