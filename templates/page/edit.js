// The project file: its text with colours, mistakes at their lines, and what the key under the cursor means.

import { $, button, node, say } from "./dom.js";
import { told } from "./door.js";
import { change, project } from "./project.js";

let keys = {}, mistakes = [], later;

export async function startEditor() {
  keys = await told("keys");
  const text = $("text");
  text.setAttribute("aria-label", say("project file"));
  text.oninput = () => { draw(); clearTimeout(later); later = setTimeout(() => change(text.value, "editor"), 350); };
  text.onscroll = () => { $("ink").style.transform = `translate(${-text.scrollLeft}px, ${-text.scrollTop}px)`; $("gutter").style.transform = `translateY(${-text.scrollTop}px)`; };
  text.onkeydown = (event) => {
    if (event.key === "s" && (event.ctrlKey || event.metaKey)) { event.preventDefault(); clearTimeout(later); change(text.value, "editor"); }
  };
  document.onselectionchange = () => { if (document.activeElement === text) tellKey(); };
}

export function showText() {
  const text = $("text"), top = text.scrollTop, caret = text.selectionStart;
  if (text.value !== project.text) { text.value = project.text; text.setSelectionRange(caret, caret); text.scrollTop = top; }
  draw();
  tellKey();
}

// What is wrong or remarkable: `found` mistakes with their lines, remarks as they are told.
export function tell(found, remarks = [], warnings = [], corrected = null) {
  mistakes = found;
  draw();
  const place = (one) => (one.line ? `${one.line}: ` : "") + (one.field ? `${one.field}: ` : "") + one.message;
  const list = (title, some, open) => some.length && node("details", { open }, node("summary", {}, `${title} (${some.length})`), node("ul", {}, ...some.map((one) => node("li", {}, one))));
  $("told").replaceChildren(...[
    found.length && node("ul", { class: "mistakes" }, ...found.map((one) => node("li", {}, button(place(one), () => goTo(one.line), { class: "line" }), one.hint && node("small", {}, one.hint)))),
    warnings.length && node("div", {}, list(say("doubtful numbers"), warnings, true), button(say("take the suggested values"), corrected, { class: "chip" })),
    list(say("remarks"), remarks, false),
    !found.length && !remarks.length && !warnings.length && node("p", { class: "hint good" }, say("nothing is wrong")),
  ].filter(Boolean));
}

export const tellWaiting = (text) => { $("told").replaceChildren(node("p", { class: "hint" }, text)); };

function goTo(line) {
  if (!line) return;
  const text = $("text"), before = text.value.split("\n").slice(0, line - 1).join("\n").length + (line > 1);
  text.focus();
  text.setSelectionRange(before, before + (text.value.split("\n")[line - 1] ?? "").length);
  text.scrollTop = Math.max(0, (line - 6) * parseFloat(getComputedStyle(text).lineHeight));
}

// The text once more under the one that is typed, in colours.
function draw() {
  const lines = $("text").value.split("\n"), wrong = new Set(mistakes.map((one) => one.line));
  $("gutter").replaceChildren(...lines.map((line, n) => node("span", { class: wrong.has(n + 1) ? "wrong" : false }, String(n + 1))));
  $("ink").replaceChildren(...lines.map((line, n) => node("span", { class: wrong.has(n + 1) ? "wrong" : false }, ...coloured(line), "\n")));
}

function coloured(line) {
  if (/^\s*\[/.test(line)) return [node("b", {}, line)];
  const [, head, rest] = /^(\s*[\w.-]+\s*)?((?:=.*)?.*)$/.exec(line), found = head && rest.startsWith("=") ? [node("i", {}, head)] : [head ?? ""];
  for (const [part] of rest.matchAll(/"(?:\\.|[^"\\])*"?|'[^']*'?|#.*|[^"'#]+/g)) found.push(/^["']/.test(part) ? node("q", {}, part) : part[0] === "#" ? node("s", {}, part) : part);
  return found;
}

// The table and the key that the cursor stands in, and what else the table may have.
function tellKey() {
  const { value, selectionStart } = $("text"), lines = value.split("\n"), n = value.slice(0, selectionStart).split("\n").length - 1;
  const tableOf = (line) => /^\s*\[\[?\s*([\w."-]+)\s*\]\]?/.exec(line)?.[1], keyOf = (line) => /^\s*([\w-]+)\s*=/.exec(line)?.[1];
  const from = lines.findLastIndex((line, k) => k <= n && tableOf(line)), next = lines.findIndex((line, k) => k > from && /^\s*\[/.test(line));
  const own = lines.slice(Math.max(from, 0), next < 0 ? lines.length : next), table = tableOf(lines[from] ?? "") ?? "", rows = keys[table] ?? [], row = rows.find((one) => one.name === keyOf(lines[n]));
  if (!rows.length) { $("key").replaceChildren(); return; }
  const there = new Set(own.map(keyOf)), end = Math.max(from, 0) + own.findLastIndex((line, k) => !k || line.trim()) + 1;
  const insert = (one) => {
    lines.splice(end, 0, `${one.name} = `);
    $("text").value = lines.join("\n");
    const at = lines.slice(0, end + 1).join("\n").length;
    $("text").focus();
    $("text").setSelectionRange(at, at);
    $("text").dispatchEvent(new Event("input"));
  };
  const others = rows.filter((one) => !there.has(one.name) && !(one.name in keys));
  $("key").replaceChildren(
    ...(row ? [node("h3", {}, table ? `${table}.${row.name}` : row.name), node("p", {}, plain(row.takes), row.units.length ? ` · ${row.units.join(", ")}` : ""), node("p", { class: "hint" }, plain(row.means))] : [table && node("h3", {}, `[${table}]`)].filter(Boolean)),
    ...(others.length && table ? [node("details", { open: !row }, node("summary", {}, say("keys that may be added")), node("div", { class: "chips" }, ...others.map((one) => button(one.name, () => insert(one), { class: "chip", title: `${plain(one.takes)}; ${plain(one.means)}` }))))] : []));
}

const plain = (text) => text.replaceAll("`", "");
