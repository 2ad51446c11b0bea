// Whether the pointer moves the handle or the camera, and who holds the handle.

import {find} from "./find.js";
import {say} from "./link.js";
import {layOut} from "./stage.js";

let holder = "";
let isCamera = false;

/** Whether what the pointer does is meant for the handle. */
export const isHandleOfPointer = () => holder === "mouse" && !isCamera;

export function setHandle(name, offered) {
  const others = offered.filter(handle => handle.name !== "mouse").map(handle => handle.name);
  // Where there is no choice the pointer is the handle: nobody is asked.
  holder = name;
  find("pointer").hidden = find("home").hidden = name !== "mouse";
  find("take-handle").hidden = name === "mouse" || !offered.some(handle => handle.name === "mouse");
  giveBackTo = others.includes("hand") ? "hand" : others[0] ?? "";
  document.body.classList.toggle("sliders", name === "sliders");
  layOut();
}
let giveBackTo = "";

/** Takes the handle, or gives it back to who held it. */
export function toggleHolder() {
  if (find("take-handle").disabled) return;
  if (!find("take-handle").hidden) say({do: "handle", to: "mouse"});
  else if (holder === "mouse" && giveBackTo) say({do: "handle", to: giveBackTo});
}

export function giveToCamera(is) {
  isCamera = is;
  find("to-camera").setAttribute("aria-pressed", is);
  find("to-handle").setAttribute("aria-pressed", !is);
  document.body.classList.toggle("piloting", isHandleOfPointer() && !find("home").disabled);
}

export const toggleCamera = () => { if (holder === "mouse") giveToCamera(!isCamera); };
export const goHome = () => { if (holder === "mouse" && !find("home").disabled) say({do: "home"}); };

find("to-camera").addEventListener("click", () => giveToCamera(true));
find("to-handle").addEventListener("click", () => giveToCamera(false));
find("home").addEventListener("click", goHome);
find("take-handle").addEventListener("click", toggleHolder);
