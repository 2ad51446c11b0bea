// The last ten seconds, in memory that never grows.

export const SPAN_S = 10;
const CAPACITY = 16384;

export class History {
  constructor() {
    this.time = new Float64Array(CAPACITY);
    this.felt = new Uint8Array(CAPACITY);
    this.values = {force: new Float32Array(CAPACITY), torque: new Float32Array(CAPACITY)};
    this.clear();
  }

  clear() {
    this.head = 0;
    this.count = 0;
    this.end = -Infinity;
  }

  /** Takes a frame's trace, whose last sample is of the frame's time. */
  append(time_s, {dt_s, force_N, torque_Nm}, felt) {
    // The scene begins again.
    if (time_s < this.end) this.clear();
    for (let i = 0; i < force_N.length; i++) {
      this.time[this.head] = time_s - dt_s * (force_N.length - 1 - i);
      this.felt[this.head] = felt;
      this.values.force[this.head] = force_N[i];
      this.values.torque[this.head] = torque_Nm[i];
      this.head = (this.head + 1) % CAPACITY;
      this.count = Math.min(this.count + 1, CAPACITY);
    }
    this.end = time_s;
  }

  /** Calls with (seconds before now, value, whether it is felt) of what is not too old, oldest first. */
  forEach(name, call) {
    const values = this.values[name];
    for (let n = this.count; n > 0; n--) {
      const i = (this.head - n + CAPACITY) % CAPACITY;
      const age = this.end - this.time[i];
      if (age <= SPAN_S) call(age, values[i], this.felt[i] === 1);
    }
  }

  /** The sample nearest to an age, as {age, force, torque}; null without a sample. */
  at(age) {
    let best = null, least = 0.1;
    for (let n = this.count; n > 0; n--) {
      const i = (this.head - n + CAPACITY) % CAPACITY;
      const off = Math.abs(this.end - this.time[i] - age);
      if (off < least) [best, least] = [i, off];
    }
    if (best === null) return null;
    return {age: this.end - this.time[best], force: this.values.force[best], torque: this.values.torque[best]};
  }
}
