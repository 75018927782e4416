// The record: unpacked once, asked by everything else.

async function unpacked(text) {
  const stream = new Blob([bytesOf(text)]).stream().pipeThrough(new DecompressionStream("deflate"));
  return JSON.parse(await new Response(stream).text());
}

let record;
let children = new Map();

const stepOf = (id) => record.steps[id];
const planOf = (id) => record.plans.find((plan) => plan.id === id);

function takeRecord(found) {
  record = found;
  speak(record.words);
  for (const [id, step] of Object.entries(record.steps)) {
    for (const { step: of } of step.args) if (of !== undefined) children.set(of, [...(children.get(of) ?? []), id]);
  }
}

// What is told at a position, or of all of them together.
const at = (told, label) => told?.[label] ?? told?.[""] ?? Object.values(told ?? {})[0];

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

const called = ({ symbol, name }) => (symbol || name).replace(/[_^]\{([^}]*)\}|[_^]/g, "$1"); // without its markup
const calledView = (view) => record.words.views[view] ?? view;

const UNITS = () => record.words.units ?? {};

function shown(value, unit) {
  const u = unit ? ` ${UNITS()[unit] ?? unit}` : "";
  const near = (x) => digits(Math.abs(x) < 1e-12 * size(value) ? 0 : x); // what rounding leaves of a zero is none
  if (Array.isArray(value)) return value.length === 2 && typeof value[0] !== "object" ? `(${near(value[0])}; ${near(value[1])})${u}` : "…";
  return typeof value === "object" && value !== null ? "…" : digits(value) + u;
}

// All that a step is made of, itself among them, arguments first.
function chain(id, seen = new Set(), found = []) {
  if (seen.has(id) || !stepOf(id)) return found;
  seen.add(id);
  for (const arg of stepOf(id).args) chain(arg.step, seen, found);
  found.push(id);
  return found;
}

// A button, a slider that is called by a word.
const control = (id, sign, key, act, more = {}) => button(sign, act, { id: id || false, "aria-label": say(key), title: say(key), ...more });
const range = (id, key, more, act) => node("input", { type: "range", id: id || false, class: "scrub", "aria-label": say(key), ...more, oninput: (event) => act(Number(event.target.value)) });
