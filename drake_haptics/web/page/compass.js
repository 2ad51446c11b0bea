// Where the world's axes point in the picture, and how long something is at the handle.

import {find, write} from "./find.js";

const LENGTH = 26;
// A round length is chosen that takes at most so many pixels.
const WIDEST = 110;
const arms = new Map([...document.querySelectorAll("#triad g")].map(arm => [arm.dataset.axis, arm]));

/** axes: right, up and near of each; height_m: of the picture, at the handle. */
export function showCompass({axes, height_m}) {
  find("compass").hidden = !axes;
  if (!axes) return;
  // What is nearer is drawn over what is farther.
  const order = Object.entries(axes).sort(([, a], [, b]) => a[2] - b[2]);
  for (const [name, [right, up]] of order) {
    const arm = arms.get(name), [x, y] = [LENGTH * right, -LENGTH * up];
    arm.querySelector("path").setAttribute("d", `M0 0L${x} ${y}`);
    arm.querySelector("text").setAttribute("transform", `translate(${1.35 * x} ${1.35 * y})`);
    if (arm.parentElement.lastElementChild !== arm) arm.parentElement.append(arm);
  }
  find("scale").hidden = !height_m;
  if (height_m) showScale(1e3 * height_m / find("stage").clientHeight);
}

function showScale(mm_per_px) {
  const most = WIDEST * mm_per_px, power = 10 ** Math.floor(Math.log10(most));
  const length = power * [5, 2, 1].find(step => step * power <= most);
  find("scale").style.width = length / mm_per_px + "px";
  write(find("scale"), (length < 1000 ? length : length / 1000) + (length < 1000 ? " mm" : " m"));
}
