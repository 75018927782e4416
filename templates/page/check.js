// Checking: a drawing over ours with a slider between, the first wrong step, places to zoom to; a group as a table.

import { $, bytesOf, button, download, dropZone, node, picture, say } from "./dom.js";
import { ask, latest } from "./door.js";
import { project } from "./project.js";
import { working } from "./take.js";
import { framed } from "./zoom.js";

const work = latest();

export function startCheck() {
  const which = node("select", { id: "which", "aria-label": say("which sheet") });
  const found = node("div", { id: "found" });
  const run = (door, files, show) => working(found, work, async (how) => show(found, await ask(door, { text: project.text, name: project.name, sheet: which.value }, { ...how, files })));
  $("check").replaceChildren(node("div", { class: "bar" }, which, dropZone(say("drop a drawing"), ".jpg,.jpeg,.png,.pdf,.dxf,.csv", ([file]) => run("compare", [file], showFound)),
    dropZone(say("drop a folder"), "", (files) => run("group", files, showGroup), true)), found);
}

export function offerSheets(titles) {
  $("which")?.replaceChildren(...titles.map((title, n) => node("option", { value: n + 1 }, say("sheet {n}", { n: n + 1 }))));
}

function showFound(place, found) {
  if (found.refused) {
    const img = picture(node("img", { alt: "", class: "refused" }), bytesOf(found.theirs.data), found.theirs.type);
    place.replaceChildren(node("p", { class: "bad lines" }, found.refused), img);
    return;
  }
  const start = new Set(found.start), rows = [...found.findings].sort((a, b) => start.has(b.id) - start.has(a.id) || (a.verdict !== "red") - (b.verdict !== "red"));
  const numbers = new Map(rows.filter((one) => one.at_mm).map((one, n) => [one, n + 1]));
  const over = found.theirs ? overlay(found, numbers) : null;
  const row = (one) => {
    const n = over && one.at_mm ? `${numbers.get(one)}. ` : "", text = [n, node("b", {}, [one.name ?? one.quantity, one.position && `(${one.position})`].filter(Boolean).join(" ")), " ", one.said];
    return node("li", { class: one.verdict }, over && one.at_mm ? button(text, () => over.to(...one.at_mm), { class: "line" }) : node("p", {}, ...text), one.view && node("small", {}, one.view));
  };
  const first = rows.filter((one) => start.has(one.id)), rest = rows.filter((one) => !start.has(one.id));
  const { green, amber, red } = found.summary;
  place.replaceChildren(node("div", { class: over ? "compared" : "compared alone" }, over?.box,
    node("div", { class: "findings" },
      node("p", { class: "counts" }, say("{green} right, {amber} to look at, {red} wrong", { green, amber, red })),
      ...found.notes.map((note) => node("p", { class: "hint" }, note)),
      first.length && node("div", { class: "first" }, node("h3", {}, say("it begins here")), node("ol", {}, ...first.map(row))),
      rest.length && node("ol", {}, ...rest.map(row)),
      node("details", {}, node("summary", {}, say("whole report")), node("pre", {}, found.text)))));
  over?.fit();
}

// Theirs below, ours above as far as the slider is.
function overlay(found, numbers) {
  const layer = (one, kind) => picture(node("img", { alt: "", draggable: "false", class: `layer ${kind}` }), bytesOf(one.data), one.type);
  const theirs = layer(found.theirs, "theirs"), ours = layer(found.ours, "ours"), edge = node("div", { class: "edge" });
  const leaf = node("div", { class: "leaf" }, theirs, ours, edge, ...[...numbers].map(([one, n]) => button(String(n), () => zoom.to(...one.at_mm), {
    class: `flag ${one.verdict}`, "aria-label": one.said, "data-x": one.at_mm[0], "data-y": one.at_mm[1] })));
  for (const flag of leaf.querySelectorAll(".flag")) Object.assign(flag.style, { left: `${flag.dataset.x}px`, top: `${594 - flag.dataset.y}px` });
  const zoom = framed(leaf);
  const slide = node("input", { type: "range", min: 0, max: 100, step: 0.2, value: 50, "aria-label": say("between theirs and ours"), oninput: () => show() });
  const show = () => { ours.style.clipPath = `inset(0 0 0 ${slide.value}%)`; theirs.style.clipPath = `inset(0 ${100 - slide.value}% 0 0)`; edge.style.left = `${slide.value}%`; };
  const both = node("input", { type: "checkbox", onchange: () => leaf.classList.toggle("both", both.checked) });
  show();
  return { box: node("div", { class: "over" }, node("div", { class: "bar" }, node("span", {}, say("theirs")), slide, node("span", {}, say("ours")), node("label", { class: "tick" }, both, say("one upon the other"))), zoom.frame), to: zoom.to, fit: zoom.fit };
}

function showGroup(place, found) {
  const students = found.group.students, kinds = Object.keys(found.kinds);
  const head = [say("student"), say("handed in"), ...Object.values(found.kinds), say("mistakes")].map((text) => node("th", { scope: "col" }, text));
  place.replaceChildren(node("div", {}, node("div", { class: "bar" }, button(say("all reports"), () => download(found.name, bytesOf(found.data)), { class: "main" })),
    node("div", { class: "wide" }, node("table", {}, node("thead", {}, node("tr", {}, ...head)), node("tbody", {}, ...students.map((one) => node("tr", {},
      node("th", { scope: "row" }, one.student), node("td", {}, one.handed_in), ...kinds.map((kind) => node("td", { class: "number" }, String(one.faults[kind]))),
      node("td", {}, ...one.mistakes.map((m) => node("p", {}, m)), ...one.files.filter((f) => f.refused).map((f) => node("p", { class: "bad" }, `${f.file}: ${f.refused}`)))))))),
    found.group.most_made.length && node("div", {}, node("h3", {}, say("most made")), node("ol", {}, ...found.group.most_made.map((one) => node("li", {}, `${one.students} × ${one.mistake}`))))));
}
