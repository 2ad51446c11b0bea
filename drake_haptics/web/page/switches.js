// What is on or off, one of several, or held by somebody.

import {copy, find} from "./find.js";
import {ask, isBefore, say} from "./link.js";

const choices = new Map();
const switches = {effect: new Map(), view: new Map()};
const handles = new Map();

export function makeChoices(list) {
  find("contact").querySelectorAll(".choice").forEach(row => row.remove());
  choices.clear();
  for (const {key, label, options, help, file} of list) {
    const row = copy("choice-row"), select = row.querySelector("select");
    [select.id, row.title] = [key, help];
    row.querySelector("label").htmlFor = key;
    row.querySelector("label").textContent = label;
    select.append(...options.map(option => new Option(option, option)));
    select.addEventListener("change", () => say({do: "choose", key, to: select.value}));
    choices.set(key, {select, file});
    find("contact").prepend(row);
  }
}

/** kind is "effect" or "view": what is told to the run. */
export function makeSwitches(kind, list) {
  const folder = find(kind + "s"), made = switches[kind];
  folder.querySelectorAll(".switch").forEach(row => row.remove());
  made.clear();
  for (const {name, label, help, file} of list) {
    const row = copy("switch-row"), input = row.querySelector("input"), words = row.querySelector("small");
    input.id = kind + "-" + name;
    row.querySelector(".name").textContent = label;
    input.setAttribute("aria-label", label);
    if (help) {
      [words.id, words.textContent, words.hidden] = [input.id + ".help", help, false];
      input.setAttribute("aria-describedby", words.id);
    }
    input.addEventListener("change", () => {
      row.classList.add("waiting");
      row.dataset.asked = ask({do: kind, name, on: input.checked});
    });
    made.set(name, {input, file});
    folder.append(row);
  }
}

export function makeHandles(list) {
  find("handles").querySelectorAll(".handle").forEach(row => row.remove());
  handles.clear();
  for (const {name, label} of list) {
    const row = copy("handle-row"), input = row.querySelector("input");
    [input.value, input.id] = [name, "handle-" + name];
    row.querySelector(".name").textContent = label;
    input.addEventListener("change", () => say({do: "handle", to: name}));
    handles.set(name, input);
    find("handles").append(row);
  }
}

export function showSwitches(state) {
  for (const [key, option] of Object.entries(state.choices ?? {})) {
    const choice = choices.get(key);
    if (!choice) continue;
    choice.select.value = option;
    choice.select.parentElement.classList.toggle("changed", option !== choice.file);
  }
  for (const [kind, values] of [["effect", state.effects ?? {}], ["view", state.views ?? {}]]) {
    for (const [name, {input, file}] of switches[kind]) {
      const row = input.parentElement;
      // A page that no longer drives is not answered.
      if (row.classList.contains("waiting") && !input.matches(":disabled")
        && isBefore(state.answered, Number(row.dataset.asked))) continue;
      input.checked = Boolean(values[name]);
      row.classList.remove("waiting");
      // Views are no matter of a scene file.
      row.classList.toggle("changed", file !== undefined && input.checked !== file);
    }
  }
  for (const [name, input] of handles) input.checked = name === state.handle;
}
