// Numbers as people read them.

export const newtons = f => f.toFixed(2) + " N";
export const millinewtonmeters = t => (1e3 * t).toFixed(0) + " mN·m";
export const norm = v => Math.hypot(...v);

/** A number with its sign as a minus, and none where it rounds to zero. */
export function signed(x, digits) {
  const text = Math.abs(x).toFixed(digits);
  return (x < 0 && Number(text) !== 0 ? "−" : "") + text;
}

/** A time in µs, ms above a thousand of them. */
export function micros(us) {
  if (us < 10) return us.toFixed(1) + " µs";
  if (us < 1000) return us.toFixed(0) + " µs";
  return Number((us / 1000).toFixed(us < 10000 ? 1 : 0)) + " ms";
}

/** A length with its sign, in mm. */
export const millimeters = m => signed(1e3 * m, 3) + " mm";

export function seconds(s) {
  if (s < 60) return s.toFixed(1) + " s";
  return Math.floor(s / 60) + " min " + String(Math.floor(s % 60)).padStart(2, "0") + " s";
}

/** How long nothing was heard: in whole seconds from one on. */
export const silence = s => s < 1 ? s.toFixed(1) + " s" : seconds(Math.floor(s)).replace(".0", "");

/** Three significant digits, without an exponent where people would write none. */
export const rounded = x => Number(x.toPrecision(3));
