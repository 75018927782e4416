// Taking: formats, note, tiles, names in the title block; one file or a zip file.

import { $, bytesOf, button, download, node, say } from "./dom.js";
import { aborted, ask, latest } from "./door.js";
import { project } from "./project.js";

const work = latest();
const GROUPS = [
  ["sheets to print and to work with", [["pdf", "PDF"], ["one-file", "one PDF"], ["dxf", "DXF"], ["svg", "SVG"], ["png", "PNG"], ["hpgl", "HPGL"]]],
  ["pages to glue together", [["a4", "A4"], ["a3", "A3"]]],
  ["note", [["note-pdf", "PDF"], ["note-docx", "DOCX"]]],
  ["and also", [["page", "living sheet"], ["table", "table to measure"], ["record", "record"]]],
];
const NAMES = ["student", "group", "supervisor", "institution", "designation"];

export function startTake() {
  const kept = JSON.parse(localStorage.getItem("names") ?? "{}"), said = node("div", { role: "status" });
  const box = ([value, label]) => node("label", { class: "tick" }, node("input", { type: "checkbox", name: "wanted", value, checked: value === "pdf" }), say(label));
  const form = node("form", { class: "take" },
    node("div", { class: "columns" },
      node("div", {}, ...GROUPS.map(([title, some]) => node("fieldset", {}, node("legend", {}, say(title)), ...some.map(box)))),
      node("fieldset", { class: "names" }, node("legend", {}, say("title block")), ...NAMES.map((key) => node("label", {}, say(key), node("input", { type: "text", name: key, value: kept[key] ?? "", maxlength: 200 }))))),
    node("div", { class: "bar" }, node("button", { type: "submit", class: "main" }, say("make")), button(say("project file alone"), () => download(`${project.name || "project"}.toml`, project.text, "application/toml"), { class: "chip" })), said);
  form.onsubmit = async (event) => {
    event.preventDefault();
    const data = new FormData(form), names = Object.fromEntries(NAMES.map((key) => [key, data.get(key).trim()]));
    localStorage.setItem("names", JSON.stringify(names));
    await working(said, work, async (how) => {
      const made = await ask("take", { text: project.text, name: project.name, wanted: data.getAll("wanted").join(","), ...names }, how);
      const bytes = bytesOf(made.data), again = () => download(made.name, bytes);
      again();
      said.replaceChildren(node("p", { class: "good" }, say("made {n} files", { n: made.files.length }), " ", button(made.name, again, { class: "chip" })),
        ...made.problems.map((line) => node("p", { class: "bad" }, line)), node("ul", { class: "files" }, ...made.files.map((file) => node("li", {}, file))));
    });
  };
  $("take").replaceChildren(form);
}

// Work of which is told while it is done; it can be stopped; what went wrong is told in its place.
export async function working(place, running, act) {
  const signal = running.begin(), now = node("span", { class: "now" });
  const heard = ({ say: text }) => {
    now.textContent = text;
    if (!now.isConnected) place.replaceChildren(node("p", { class: "progress" }, now, button(say("stop"), () => running.stop(), { class: "chip" })));
  };
  heard({ say: say("begins") });
  try { await act({ signal, heard }); } catch (error) { place.replaceChildren(node("p", { class: aborted(error) ? "hint" : "bad" }, aborted(error) ? say("stopped") : error.message)); }
}
