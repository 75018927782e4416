// What is told of a step beside the drawing: its sentence, its formula, what it is made of and what follows from it.

const titled = (id) => { const s = stepOf(id); return lettered(s.symbol ?? s.name); };

const momentOf = (when) => (typeof when === "number" ? `φ = ${mod(when * 180 / Math.PI, 360).toFixed(1).replace(".", decimal())}°` : when && say("position {label}", { label: when }));
const valued = (id, when) => `${titled(id)} <small data-step="${plain(id)}">${plain(shown(valueOf(id, when), stepOf(id).unit))}</small>`;
const chip = (id, when) => node("button", { type: "button", class: "chip", onclick: () => ask(id, when), ".innerHTML": valued(id, when) });

// What is told of a step in a position; in motion what is told of all alike, as long as the numbers are the project's.
function toldIn(told, when) {
  if (typeof when !== "number") return at(told, when) ?? "";
  const all = new Set(Object.values(told ?? {}));
  return all.size === 1 && isMade(machine.given) ? [...all][0] : "";
}

// Values in the panel follow the crank.
function tellNow() {
  for (const one of /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll("#panel [data-step]"))) one.textContent = shown(valueOf(one.dataset.step, machine.phi), stepOf(one.dataset.step).unit);
  for (const one of document.querySelectorAll("#panel [data-moment]")) one.textContent = momentOf(machine.phi);
}

function argumentChip(arg, when, plan) {
  if (arg.step !== undefined) return chip(arg.step, when);
  const angle = typeof when === "number", now = angle && arg.over === "none" ? machine.given[arg.name] : undefined;
  const given = arg.over !== "positions" ? now ?? arg.given : angle ? undefined : arg.given?.[Math.max(plan.positions.indexOf(when), 0)];
  const text = arg.name === "crank angles" && angle ? `<small data-moment>${momentOf(when)}</small>` : `<small>${plain(shown(given, arg.unit))}</small>`;
  const name = arg.symbol ? lettered(arg.symbol) : plain(arg.name === "constant" ? "" : arg.name);
  return node("span", { class: "chip given", title: arg.source ?? arg.name, ".innerHTML": `${name} ${text}` });
}

// Buttons under a heading, nothing where there are none.
const chips = (title, some) => (some.length ? [node("h3", {}, say(title)), node("div", { class: "chips" }, ...some)] : []);

const FOLLOW = 12; // so many of the steps that follow are named

function tellStep(id, when) {
  const s = stepOf(id), plan = planOf(s.plan), moment = momentOf(when), numbers = toldIn(s.formula?.numbers, when), next = [...new Set(children.get(id) ?? [])];
  return [node("h2", { ".innerHTML": valued(id, when) }), node("p", { class: "where" }, plan.title, ...(moment ? [", ", node("span", { "data-moment": true }, moment)] : [])),
    node("p", { class: "sentence", ".innerHTML": lettered(toldIn(s.sentence, when)) }),
    ...(s.formula ? [node("div", { class: "formula", ".innerHTML": mathml(s.formula.symbols) + (numbers ? mathml(`= ${numbers}`) : "") })] : []),
    ...chips("made of", s.args.filter((a) => a.name !== "constant" || a.step !== undefined).map((a) => argumentChip(a, when, plan))),
    ...chips("from it follow", next.slice(0, FOLLOW).map((one) => chip(one, when))),
    ...(next.length > FOLLOW ? [node("p", { class: "hint" }, say("and {n} more", { n: next.length - FOLLOW }))] : [])];
}

// The whole way from the given numbers to a step.
function tellWhy(id, when) {
  const told = new Set(), given = (one) => stepOf(one).args.filter((arg) => arg.step === undefined && arg.name !== "constant" && !told.has(arg.name) && told.add(arg.name));
  return node("details", {}, node("summary", {}, say("why: back to the givens")), node("ol", { class: "why" }, ...chain(id).flatMap((one) => [
    ...given(one).map((arg) => node("li", {}, argumentChip(arg, when, planOf(stepOf(one).plan)), ` ${arg.source ?? say("given")}`)),
    node("li", {}, chip(one, when), node("span", { ".innerHTML": ` ${lettered(toldIn(stepOf(one).sentence, when))}` }))])));
}
