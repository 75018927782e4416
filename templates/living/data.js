// The record: unpacked once, asked by everything else.

const $ = (id) => document.getElementById(id);

async function unpacked(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return JSON.parse(await new Response(stream).text());
}

let record;
let children = new Map();

const say = (key, values = {}) => (record.words[key] ?? key).replace(/\{(\w+)\}/g, (all, name) => values[name] ?? all);
const stepOf = (id) => record.steps[id];
const planOf = (id) => record.plans.find((plan) => plan.id === id);

function takeRecord(found) {
  record = found;
  for (const [id, step] of Object.entries(record.steps)) {
    for (const arg of step.args) {
      if (arg.step === undefined) continue;
      if (!children.has(arg.step)) children.set(arg.step, []);
      children.get(arg.step).push(id);
    }
  }
}

// What is told at a position, or of all of them together.
function at(told, label) {
  if (!told) return undefined;
  return told[label] ?? told[""] ?? Object.values(told)[0];
}

// A step's value in a numbered position, by its label, or at a crank angle of the linkage as it is now, rad.
function valueOf(id, when) {
  const one = stepOf(id);
  if (typeof when === "number") {
    const place = record.motion.all.results[id];
    return place ? taken(place, parts(when)) : one.over === "none" && isMade(machine.given) ? one.value : undefined;
  }
  return one.over === "positions" ? one.value?.[Math.max(planOf(one.plan).positions.indexOf(when), 0)] : one.value;
}

const decimal = () => (record.lang === "en" ? "." : ",");

function digits(x) {
  if (x === null || x === undefined || Number.isNaN(x)) return "–";
  if (typeof x !== "number") return String(x);
  if (x !== 0 && (Math.abs(x) < 1e-4 || Math.abs(x) >= 1e7)) {
    const [m, p] = x.toExponential(3).split("e");
    return `${m.replace(".", decimal())}·10^${Number(p)}`.replace("-", "−");
  }
  return String(Number(x.toPrecision(5))).replace(".", decimal()).replace("-", "−");
}

const calledView = (view) => record.words.views[view] ?? view;

const UNITS = () => record.words.units ?? {};

function shown(value, unit) {
  const u = unit ? ` ${UNITS()[unit] ?? unit}` : "";
  if (Array.isArray(value)) return value.length === 2 && typeof value[0] !== "object" ? `(${digits(value[0])}; ${digits(value[1])})${u}` : "…";
  return typeof value === "object" && value !== null ? "…" : digits(value) + u;
}

// All that a step is made of, itself among them, arguments first.
function chain(id, seen = new Set()) {
  const found = [], pending = [[id, false]];
  while (pending.length) {
    const [one, ready] = pending.pop();
    if (ready) { found.push(one); continue; }
    if (seen.has(one) || !stepOf(one)) continue;
    seen.add(one);
    pending.push([one, true]);
    for (const arg of [...stepOf(one).args].reverse()) if (arg.step !== undefined) pending.push([arg.step, false]);
  }
  return found;
}

function node(name, attributes = {}, ...inside) {
  const found = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) found.addEventListener(key.slice(2), value);
    else if (key === "html") found.innerHTML = value;
    else if (value !== false && value !== undefined) found.setAttribute(key, value === true ? "" : value);
  }
  found.append(...inside);
  return found;
}

const still = () => matchMedia("(prefers-reduced-motion: reduce)").matches;
