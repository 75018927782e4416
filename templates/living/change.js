// Given numbers as sliders; what does not assemble is told; undo, the project's own numbers again, a project file.

const edits = { done: [], undone: [] };
const SHOWN = { m: ["mm", 1 / 1000], rad: ["°", Math.PI / 180] };

const told = (value, unit, as = SHOWN[unit] ?? [unit, 1]) => { const [u, by] = as; return `${digits(value / by)} ${UNITS()[u] ?? u}`.replace(" °", "°"); };

// Work that may wait, one after another, a piece at a time while the page is idle; `act` is given what it finds.
let leisure = Promise.resolve();

function atLeisure(work, act) {
  const some = (done) => (window.requestIdleCallback ?? setTimeout)((idle) => {
    let piece;
    do piece = work.next(); while (!piece.done && idle?.timeRemaining?.() > 4);
    if (piece.done) { act(piece.value); done(); } else some(done);
  });
  leisure = leisure.then(() => new Promise(some));
}

const isLoad = (g) => /^(force|moment)\[/.test(g.name), isTable = (g) => /\.tables?(\[\d+\])?$/.test(g.name);

const LOOKS = 180, PARTS = 4, HALVES = 5, TIMES = 3;

// Whether all points have a place at some angles of the turn, a few angles a piece.
function* assembles(given) {
  const now = { given, start: record.motion.start, courses: coursesOf(given), loads: [] }, { all } = record.motion;
  if (now.courses.some(({ places }) => places.some(([x]) => Number.isNaN(x)))) return false;
  for (const phi of round(LOOKS)) {
    if (notThere(run(all, phi, now))) return false;
    yield;
  }
  return true;
}

// The first place of the mechanism that there is none of, if there is one.
function notThere(values) {
  machine.places ??= Object.entries(record.motion.all.results).filter(([id]) => /^positions\/\S+$/.test(id) && record.steps?.[id]?.kind !== "direction");
  return machine.places.find(([, [place]]) => Number.isNaN(values[place]));
}

// From a slider's own number to an end of it: as far as the mechanism goes round all the way there, to a part of it.
function* reachOf(own, far, put) {
  let near = own, by = (far - own) / PARTS, lost = false;
  for (let n = 0; n < PARTS && !lost; n++) if (yield* assembles(put(near + by))) near += by; else lost = true;
  for (let n = 0; n < HALVES && lost; n++) { by /= 2; if (yield* assembles(put(near + by))) near += by; }
  return lost ? near : far;
}

// Where a slider ends: at limits of the schema, and of what assembles with the project's other numbers.
function limitsOf(g, i) {
  const own = i === null ? g.value : g.value[i], moves = g.unit === "m" || g.unit === "rad";
  const longest = Math.max(...record.motion.givens.filter(({ unit }) => unit === "m").flatMap(({ value }) => [value].flat().map(Math.abs)), 0.01);
  const wide = g.unit === "rad" ? Math.PI / 2 : i !== null || own === 0 ? longest / 2 : Math.abs(own) * (TIMES - 1);
  const low = Math.max(own - wide, g.low ?? (moves ? -Infinity : 0)), high = Math.min(own + wide, g.high ?? Infinity);
  const put = (x) => ({ ...machine.made, [g.name]: i === null ? x : g.value.map((v, k) => (k === i ? x : v)) });
  const ends = function* () { return moves && (yield* assembles(machine.made)) ? [yield* reachOf(own, low, put), yield* reachOf(own, high, put)] : [low, high]; };
  g.limits ??= [];
  return (g.limits[i ?? 0] ??= { low, high, ends });
}

// A number of a slider as one would write it, in the unit of the file.
function handy(x, step2, g) {
  const by = (g.shown ?? SHOWN[g.unit] ?? ["", 1])[1], digit = 10 ** Math.floor(Math.log10(step2 / by));
  return Number((Math.round(x / by / digit) * digit).toPrecision(12)) * by;
}

// One slider for a number, two for a point, called by their heading and letter.
function slidersOf(g, heading) {
  const parts2 = Array.isArray(g.value) ? [0, 1] : [null];
  return parts2.map((i) => {
    const own = i === null ? g.value : g.value[i], now = () => (i === null ? machine.given[g.name] : machine.given[g.name][i]), limits = limitsOf(g, i);
    const letter = g.symbol ? lettered(g.symbol) : plain(g.name), name = `${letter}${i === null ? "" : `<sub>${"xy"[i]}</sub>`}`;
    const out = node("output"), spoken = `${heading}: ${called(g)}${i === null ? "" : ` ${"xy"[i]}`}`, input = node("input", { type: "range", "aria-label": spoken });
    const range = ([low, high]) => { Object.assign(input, { min: low, max: high, step: (high - low) / 400 }); input.value = now(); };
    range([limits.low, limits.high]);
    if (limits.ends) atLeisure(limits.ends(), ([low, high]) => { Object.assign(limits, { low, high, ends: null }); range([low, high]); });
    const row = node("label", { class: "slide", title: spoken }, node("span", { ".innerHTML": name }), out, input);
    const refresh = () => { out.textContent = isTable(g) ? `×${digits(now())}` : told(now(), g.unit, g.shown); row.classList.toggle("changed", now() !== own); input.value = now(); };
    const put = (x) => setGiven(g.name, i === null ? x : machine.given[g.name].map((v, k) => (k === i ? x : v)), true);
    let before = null;
    input.addEventListener("pointerdown", () => { before = machine.given; });
    input.addEventListener("input", () => { before ??= machine.given; put(handy(Number(input.value), Number(input.step), g)); });
    input.addEventListener("change", () => { if (before) edited(before); before = null; });
    machine.watchers.push(refresh);
    refresh();
    return row;
  });
}

function put(given) {
  machine.given = given;
  for (const watcher of machine.watchers) watcher("all");
  showEdits();
}

// A change that is done with can be undone.
function edited(before) {
  edits.done.push(before);
  edits.undone = [];
  showEdits();
}

function undo() { if (edits.done.length) { edits.undone.push(machine.given); put(edits.done.pop()); } }
function redo() { if (edits.undone.length) { edits.done.push(machine.given); put(edits.undone.pop()); } }
function reset() { edited(machine.given); put({ ...machine.made }); }

const changed = () => record.motion.givens.filter((g) => String(machine.given[g.name]) !== String(g.value));

// Whether the numbers are others than those for which the flywheel gave how the crank runs.
const isStale = () => changed().length > 0 && record.motion.all.inputs.some((input) => "found" in input);

function showEdits() {
  if (!$("undo")) return;
  $("stale").hidden = !isStale();
  const some = { undo: edits.done.length, redo: edits.undone.length, reset: changed().length, save: changed().length };
  for (const [id, many] of Object.entries(some)) $(id).disabled = !many;
  if (parent !== window) parent.postMessage({ file: projectFile() }, "*");  // of a page that shows this one beside the project file
}

// The project file with the changed numbers in their places; those of a load's table are multiplied.
function projectFile() {
  const signs = [...record.file], puts = changed().flatMap((g) => (g.places ?? []).map(([from, to], n) => {
    const [unit, by] = g.shown ?? [g.unit.replaceAll("*", "·"), 1], of = (x) => Number(x.toPrecision(12)), number = of([machine.given[g.name]].flat()[n] / by);
    const times = (x) => String(of(Number(x.replace(",", ".")) * machine.given[g.name])), old = signs.slice(from, to).join("");
    return { from, to, text: isTable(g) ? old.replace(/[-+]?\d[\d.,]*(?:[eE][-+]?\d+)?/, times) : unit ? `"${number} ${unit}"` : String(number) };
  }));
  for (const { from, to, text } of puts.sort((a, b) => b.from - a.from)) signs.splice(from, to - from, text);
  return signs.join("");
}

const save = () => download(record.filename, projectFile(), "application/toml");

// Crank angles at which the mechanism is, as runs of parts of the turn; looked for once for the same numbers.
function reached() {
  if (machine.reach?.given === machine.given) return machine.reach.runs;
  const runs = [], there = round(LOOKS).map((phi) => !notThere(run(record.motion.all, phi, found())));
  there.forEach((is, n) => { if (is && n && there[n - 1]) runs.at(-1)[1] = n; else if (is) runs.push([n, n]); });
  machine.reach = { given: machine.given, runs };
  return runs;
}

// Where the mechanism does not assemble: which place there is not, by how much it is missed, at which angles it is, also on their slider.
function lostWords([id], values) {
  const gap = gapOf(id, values), runs = reached(), turns = round(LOOKS), degrees = (n) => Math.round(mod(turns[n] * 180 / Math.PI, 360)), part = (n) => `${(100 * n / LOOKS).toFixed(1)}%`;
  const ranges = runs.map((ends) => [...ends].sort((a, b) => senseOfTurn() * (a - b)).map(degrees).join("–") + "°").join(", ");
  for (const one of /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll("input.angle"))) one.style.setProperty("--reach", `linear-gradient(90deg, ${runs.map(([a, b]) => `transparent ${part(a)}, var(--after) ${part(a)} ${part(b)}, transparent ${part(b)}`).join(", ") || "transparent, transparent"})`);
  return `${plain(say("does not assemble at this angle"))}: ${indexed(stepOf(id).name)}${gap ? `, ${plain(say("gap"))} ${told(gap, "m")}` : ""}${ranges && `. ${plain(say("reachable", { ranges }))}`}`;
}

// Arguments of a step at the present numbers.
const argumentsNow = (id, values) => stepOf(id).args.map((arg) => {
  const place = record.motion.all.results[arg.step];
  return arg.step === undefined ? machine.given[arg.name] ?? arg.given : place ? taken(place, values) : stepOf(arg.step).value;
});

// By how much two arcs, or an arc and a line, miss each other, m; nothing of other constructions.
function gapOf(id, values) {
  const { rule } = stepOf(id), args = argumentsNow(id, values);
  if (rule.startsWith("arc cuts arc")) { const d = size(sub(args[2], args[0])); return Math.max(d - args[1] - args[3], Math.abs(args[1] - args[3]) - d); }
  if (rule.startsWith("arc cuts line")) return Math.abs(cross(args[3], sub(args[2], args[0]))) - args[1];
  return 0;
}

// Which given numbers stand under which heading.
const GROUPS = { lengths: (g) => g.unit === "m", angles: (g) => g.unit === "rad", speeds: (g) => ["rad/s", "m/s"].includes(g.unit), loads: isLoad, masses: (g) => ["kg", "kg*m2"].includes(g.unit) };

function changePanel() {
  const wanted = record.motion.givens.filter((g) => g.places && (isLoad(g) ? isTable(g) || g.name.endsWith(".value") : g.symbol)), chipOf = (id, key, act) => button(say(key), act, { id, class: "chip" });
  const group = (title, test) => { const own = wanted.filter(test); return own.length ? [node("h3", {}, say(title)), ...own.flatMap((g) => slidersOf(g, say(title)))] : []; };
  return [node("h2", {}, say("in motion")), node("p", { class: "bad", id: "lost", role: "alert", hidden: true }), node("p", { class: "hint" }, say("drag the crank pin or a slider")),
    node("div", { class: "chips" }, chipOf("undo", "undo", undo), chipOf("redo", "redo", redo), chipOf("reset", "reset", reset), chipOf("save", "save as project file", save)),
    node("p", { class: "hint", id: "stale", hidden: true }, say("by the flywheel")),
    ...Object.entries(GROUPS).flatMap(([title, test]) => group(title, (g) => test(g) && (test === isLoad || !isLoad(g)) && !Array.isArray(g.value))),
    ...group("fixed points", (g) => Array.isArray(g.value) && g.unit === "m" && !isLoad(g))];
}
