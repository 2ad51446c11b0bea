// The force as an arrow in the picture, and both as numbers along the world's axes.

import {find, write} from "./find.js";
import {norm, signed} from "./format.js";

const RADIUS = 45;
const cells = [...document.querySelectorAll("#components tbody tr")].map(row => row.querySelectorAll("td"));

export function showDirection({f, f_W, tau_W}, limit) {
  const force = norm(f);
  const share = limit > 0 ? Math.min(force / limit, 1) : 0;
  showDial(f.map(part => force > 0 ? RADIUS * share * part / force : 0));
  cells.forEach(([forceCell, torqueCell], i) => {
    write(forceCell, signed(f_W[i], 2));
    write(torqueCell, signed(1e3 * tau_W[i], 0));
  });
}

function showDial([right, up, near]) {
  const length = Math.hypot(right, up), x = right, y = -up;
  let path = "";
  if (length > 1) {
    const [a, b] = [x / length, y / length], head = Math.min(9, 0.5 * length);
    const side = s => "M" + x + " " + y + "L" + (x - head * (a + s * b)) + " " + (y - head * (b - s * a));
    path = "M0 0L" + x + " " + y + side(0.7) + side(-0.7);
  }
  find("dial-arrow").setAttribute("d", path);
  find("dial-depth").setAttribute("r", Math.abs(near));
  find("dial-depth").classList.toggle("away", near < 0);
}
