// What was changed, as the keys of a scene file.

import {find, write} from "./find.js";
import {say} from "./link.js";

let text = "";

export function setYaml(yaml) {
  text = yaml;
  write(find("yaml"), yaml || "# Nothing was changed.");
}

async function copyIt() {
  try {
    await navigator.clipboard.writeText(find("yaml").textContent);
    write(find("copied"), "Copied.");
  } catch {
    getSelection().selectAllChildren(find("yaml"));
    write(find("copied"), "Selected: press Ctrl+C.");
  }
}

find("copy").addEventListener("click", () => {
  write(find("copied"), "");
  find("yaml-dialog").showModal();
  if (text) copyIt();
});
find("copy-again").addEventListener("click", copyIt);
find("reset").addEventListener("click", () => say({do: "reset"}));
find("restart").addEventListener("click", () => say({do: "restart"}));
