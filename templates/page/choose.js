// Choosing: tasks by manual and machine with a small picture, a cipher, a file, what was open lately.

import { $, button, dropZone, node, picture, say } from "./dom.js";
import { ask, latest, told } from "./door.js";
import { change, recent, textOf } from "./project.js";

const pictures = new Map();

export async function showChoice(open) {
  const manuals = await told("tasks"), said = node("p", { class: "bad", role: "alert" }), opened = recent();
  const take = async (name, corrected = "") => {
    said.textContent = "";
    try {
      const found = await ask("project", { project: name, corrected });
      change(found.text, "file", found.name);
      open({ warnings: found.warnings, corrected: () => take(name, "1") });
    } catch (error) { said.textContent = error.message; said.scrollIntoView({ block: "nearest" }); }
  };
  const own = async ([file]) => { change(await textOf(file), "file", file.name.replace(/\.toml$/i, "")); open({}); };
  const cards = node("div", {}, ...manuals.map((manual) => node("section", { class: "manual" }, node("h2", {}, manual.title),
    node("div", { class: "cards" }, ...manual.tasks.map((task) => card(task, take))))));
  const find = node("input", { type: "search", placeholder: say("find a task"), "aria-label": say("find a task"), oninput: () => {
    const wanted = find.value.toLowerCase();
    for (const one of cards.querySelectorAll(".card")) one.hidden = !one.dataset.words.includes(wanted);
    for (const manual of cards.children) manual.hidden = !manual.querySelector(".card:not([hidden])");
  } });
  $("choose").replaceChildren(
    node("div", { class: "bar" }, find, dropZone(say("drop a project file"), ".toml", own)),
    said,
    ...(opened.length ? [node("section", { class: "manual" }, node("h2", {}, say("recent")), node("div", { class: "chips" }, ...opened.map((one) => button(one.name, () => { change(one.text, "file", one.name); open({}); }, { class: "chip" }))))] : []),
    cards);
}

function card(task, take) {
  const img = node("img", { alt: "", loading: "lazy" });
  img.dataset.name = task.scheme;
  if (pictures.has(task.scheme)) picture(img, pictures.get(task.scheme)); else sight.observe(img);
  const many = task.variants.length > 1;
  const names = task.variants.map((v) => button(many ? v.said.replace(/^.*?(\d+)$/, "$1") : v.said, () => take(v.name), { class: "chip", title: v.said, "aria-label": `${task.title}, ${v.said}` }));
  const cipher = node("input", { type: "text", placeholder: say("your cipher"), "aria-label": `${task.title}: ${say("your cipher")}`, maxlength: 40 });
  const typed = task.machine && node("form", { class: "cipher", onsubmit: (event) => { event.preventDefault(); if (cipher.value.trim()) take(`${task.machine}@${cipher.value.trim()}`); } }, cipher, node("button", { type: "submit" }, say("open")));
  return node("article", { class: "card", "data-words": [task.title, ...task.variants.flatMap((v) => [v.name, v.said])].join(" ").toLowerCase() },
    node("button", { type: "button", class: "scheme", tabindex: -1, "aria-hidden": "true", onclick: () => take(task.variants[0].name) }, img), node("h3", {}, task.title),
    many && node("p", { class: "hint" }, task.variants[0].said.replace(/[, ]*\S+ *\d+$/, ""), `: ${say("variants")}`), node("div", { class: "chips" }, ...names), typed);
}

// Pictures are made when they come into sight, one after another, until something is opened.
const work = latest();
let queue = Promise.resolve();
const sight = new IntersectionObserver((all) => {
  for (const { target, isIntersecting } of all) if (isIntersecting) { sight.unobserve(target); queue = queue.then(() => draw(target)); }
}, { rootMargin: "100px" });

export const leaveChoice = () => work.stop();

async function draw(img) {
  const { name } = img.dataset;
  if ($("choose").hidden || !img.isConnected) return;
  try {
    pictures.set(name, (await ask("scheme", { project: name }, { signal: work.begin() })).svg);
    picture(img, pictures.get(name));
  } catch { /* a card without a picture */ }
}
