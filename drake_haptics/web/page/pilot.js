// Whether the pointer moves the handle or the camera, and who holds the handle.

import {find, write} from "./find.js";
import {say} from "./link.js";
import {layOut} from "./stage.js";

let holder = "";
let giveBackTo = "";
let heldBefore = "";
let isOffered = false;
let drives = false;
let isCamera = false;

/** Gives the pointer to the handle where it is meant for it. */
function update() {
  document.body.classList.toggle("piloting", drives && holder === "mouse" && !isCamera);
}

export function setDriving(is) {
  drives = is;
  update();
}

export function setHandle(name, offered) {
  const names = offered.map(handle => handle.name);
  const others = names.filter(other => other !== "mouse");
  if (name !== "mouse") heldBefore = name;
  // A page that is opened later does not know, but whoever names a device means that.
  giveBackTo = [heldBefore, "device", "hand"].find(other => others.includes(other)) ?? others[0] ?? "";
  // Meshcat's sliders have keys of their own, which its page hears.
  if (name === "sliders" && holder !== name) find("view").focus();
  holder = name;
  find("pointer").hidden = find("home").hidden = name !== "mouse";
  isOffered = names.includes("mouse");
  const isHeld = name === "mouse";
  find("take-handle").hidden = !isOffered || (isHeld && !giveBackTo);
  find("take-handle").classList.toggle("primary", !isHeld);
  write(find("take-words"), isHeld ? "Give it back" : "Hold it yourself");
  document.body.classList.toggle("sliders", name === "sliders");
  update();
  layOut();
}

/** Takes the handle, or gives it back to who held it. */
function toggleHolder() {
  if (!drives) return;
  const to = holder === "mouse" ? giveBackTo : isOffered && "mouse";
  if (to) say({do: "handle", to});
}

function giveToCamera(is) {
  isCamera = is;
  find("to-camera").setAttribute("aria-pressed", is);
  find("to-handle").setAttribute("aria-pressed", !is);
  update();
}

const toggleCamera = () => { if (holder === "mouse") giveToCamera(!isCamera); };
const goHome = () => { if (holder === "mouse" && drives) say({do: "home"}); };

/** What keys do. */
export const PILOT_KEYS = {g: toggleHolder, c: toggleCamera, h: goHome};

find("to-camera").addEventListener("click", () => giveToCamera(true));
find("to-handle").addEventListener("click", () => giveToCamera(false));
find("home").addEventListener("click", goHome);
find("take-handle").addEventListener("click", toggleHolder);
