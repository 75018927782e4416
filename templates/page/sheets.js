// The sheets: each as it comes, the one that is looked at first.

import { $, button, node, picture, say } from "./dom.js";
import { aborted, ask, latest } from "./door.js";
import { project } from "./project.js";
import { framed } from "./zoom.js";

const work = latest();
const view = { titles: [], at: 0, pictures: [], state: [], zoom: null, img: null };

export function startSheets() {
  view.img = node("img", { alt: "", draggable: "false", class: "leaf" });
  view.zoom = framed(view.img);
  $("sheets").replaceChildren(node("div", { class: "bar", id: "leaves" }), view.zoom.frame,
    node("div", { class: "tools" }, ...view.zoom.tools));
}

// Nothing more is drawn: what is shown is older than the text.
export function stopSheets() {
  work.stop();
  view.state = view.state.map(() => "old");
  showLeaves();
}

export async function drawSheets(titles) {
  const signal = work.begin(), text = project.text, name = project.name;
  if (titles.length !== view.titles.length) { view.pictures = []; view.at = Math.min(view.at, titles.length - 1); }
  Object.assign(view, { titles, state: titles.map(() => "drawing") });
  showLeaves();
  const order = [view.at, ...titles.keys()].filter((n, k, all) => all.indexOf(n) === k);
  await Promise.all(order.map(async (n) => {
    try {
      view.pictures[n] = (await ask("sheet", { text, name, sheet: n + 1, behind: n === view.at ? "" : "1" }, { signal })).svg;
      view.state[n] = "";
    } catch (error) {
      if (aborted(error)) return;
      view.state[n] = error.message;
      view.pictures[n] = null;
    }
    showLeaves();
  }));
}

function showLeaves() {
  const state = view.state[view.at], shown = view.pictures[view.at];
  $("leaves").replaceChildren(node("div", { role: "tablist" }, ...view.titles.map((title, n) => button(say("sheet {n}", { n: n + 1 }), () => { view.at = n; showLeaves(); },
    { role: "tab", "aria-selected": String(n === view.at), class: { "": false, drawing: "drawing", old: false }[view.state[n]] ?? "failed" }))),
  node("span", { class: "hint", role: "status" }, state === "drawing" ? say("drawing") : ""));
  view.zoom.frame.classList.toggle("old", ["drawing", "old"].includes(state));
  if (shown && view.img.shown !== shown) { picture(view.img, shown); view.img.shown = shown; view.img.alt = say("sheet {n}", { n: view.at + 1 }); }
  view.img.hidden = !shown;
  view.zoom.frame.querySelector(".bad")?.remove();
  if (state && !["drawing", "old"].includes(state)) view.zoom.frame.append(node("p", { class: "bad over" }, state));
}
