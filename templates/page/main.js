// The page: its tabs, its language, and what follows from another text.

import { leaveChoice, showChoice } from "./choose.js";
import { offerSheets, startCheck } from "./check.js";
import { $, button, choice, node, say, speak } from "./dom.js";
import { aborted, ask, languages, latest, told } from "./door.js";
import { showText, startEditor, tell, tellWaiting } from "./edit.js";
import { change, project } from "./project.js";
import { drawSheets, startSheets, stopSheets } from "./sheets.js";
import { startTake } from "./take.js";

const TABS = ["choose", "sheets", "turn", "file", "take", "check"];
const page = { tab: "choose", sound: false, living: null, warnings: [], corrected: null, followed: false, at: "" };
const checking = latest();

// A tab is a place of the browser's history: its back button leads to the one before.
function openTab(name, remembered = false) {
  if (name !== "choose" && !project.text) return;
  if (!remembered && page.tab !== name) history.pushState(name, "");
  page.tab = name;
  for (const one of TABS) $(one).hidden = one !== name && !(one === "file" && ["sheets", "turn"].includes(name));
  document.body.dataset.tab = name;
  for (const one of $("tabs").children) one.setAttribute("aria-selected", String(one.dataset.tab === name));
  $("tabs").querySelector("[aria-selected=true]")?.scrollIntoView({ inline: "nearest", block: "nearest" });
  if (name === "turn") showLiving();
  if (name === "choose") showChoice(opened); else leaveChoice();
}

function showTabs() {
  $("tabs").replaceChildren(...TABS.map((name) => button(say(`tab ${name}`), () => openTab(name), { role: "tab", "data-tab": name, "aria-selected": String(name === page.tab), disabled: name !== "choose" && !project.text })));
}

function opened({ warnings = [], corrected = null }) {
  Object.assign(page, { warnings, corrected, living: null, at: "" });
  tell([], [], warnings, corrected);
  showTabs();
  openTab("sheets");
}

// Another text: its mistakes, then its sheets as they come, and the living page where it is looked at.
async function follow(from) {
  showTabs();
  if (from !== "editor") showText();
  if (from === "living") page.living = project.text;
  if (from === "file") Object.assign(page, { warnings: [], corrected: null });
  const signal = checking.begin(), text = project.text;
  page.sound = false;
  tellWaiting(say("checking"));
  try {
    const found = await ask("check", { text, name: project.name }, { signal });
    if (found.mistakes) {
      stopSheets();
      tell(found.mistakes);
      return;
    }
    page.sound = true;
    $("title").textContent = found.title || project.name;
    offerSheets(found.sheets);
    drawSheets(found.sheets);
    if (page.tab === "turn") showLiving();
    const { sound, remarks } = await ask("remarks", { text, name: project.name }, { signal });
    tell(sound ? [] : [{ message: remarks.join("\n") }], sound ? remarks : [], page.warnings, page.corrected);
  } catch (error) {
    if (!aborted(error)) tell([{ message: error.message }]);
  }
}

// The living page is asked for by a form: it has no origin, and may carry out nothing but its own scripts.
function showLiving() {
  if (!page.sound || page.living === project.text) return;
  page.living = project.text;
  const fields = { text: project.text, name: project.name, lang: languages.chosen };
  const form = node("form", { action: `living${page.at}`, method: "post", target: "living", enctype: "multipart/form-data", hidden: true }, ...Object.entries(fields).map(([name, value]) => node("textarea", { name }, value)));
  const frame = $("living"), fresh = frame.cloneNode(); // another one: what it showed is no place of the browser's history
  fresh.onload = () => { $("waits").hidden = true; };
  frame.replaceWith(fresh);
  $("waits").textContent = say("drawing");
  $("waits").hidden = false;
  document.body.append(form);
  form.submit();
  form.remove();
}

async function startWords() {
  speak(await told("words"));
  document.documentElement.lang = say("language");
  $("lang").replaceWith(choice("tab language", [["", say("language of the task")], ["ru", "Русский"], ["uk", "Українська"], ["en", "English"]], languages.chosen,
    (lang) => { localStorage.setItem("lang", lang); location.reload(); }, { id: "lang" }));
  $("living").title = say("tab turn");
}

async function start() {
  await startWords();
  await startEditor();
  startSheets();
  startTake();
  startCheck();
  project.watchers.push(follow);
  addEventListener("popstate", ({ state }) => openTab(TABS.includes(state) ? state : "choose", true));
  addEventListener("message", ({ source, data }) => {
    if (source !== $("living").contentWindow) return;
    if (/^#[\w=&.%+-]{1,300}$/.test(data?.at)) page.at = data.at;
    if (typeof data?.file === "string" && data.file.length < 2e6 && data.file !== project.text) change(data.file, "living");
  });
  for (const kind of ["dragover", "drop"]) addEventListener(kind, (event) => event.preventDefault());
  showTabs();
  const shown = await told("opened"), left = JSON.parse(sessionStorage.getItem("open") ?? "null");
  page.followed = shown.followed;
  project.watchers.push(() => sessionStorage.setItem("open", JSON.stringify({ name: project.name, text: project.text, from: shown.text })));
  if (shown.followed) {
    new EventSource("saved").onmessage = ({ data }) => { const now = JSON.parse(data); page.living = null; change(now.text, "saved", now.name); };
  }
  const first = left && !shown.followed && left.from === shown.text ? left : shown;
  if (first.text) { change(first.text, "file", first.name); opened({}); } else openTab("choose");
  document.documentElement.dataset.ready = "";
}

start();
