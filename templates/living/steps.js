// What is told of a step beside the drawing: its sentence, its formula, what it is made of and what follows from it.

const titled = (id) => { const s = stepOf(id); return lettered(s.symbol ?? s.name); };

function chip(id, label) {
  const s = stepOf(id);
  return node("button", { type: "button", class: "chip", onclick: () => ask(id, label),
    html: `${titled(id)} <small>${plain(shown(valueAt(id, label), s.unit))}</small>` });
}

function argumentChip(arg, label) {
  if (arg.step !== undefined) return chip(arg.step, label);
  const value = arg.over === "positions" && Array.isArray(arg.given) ? arg.given[0] : arg.given;
  const name = arg.symbol ? lettered(arg.symbol) : plain(arg.name === "constant" ? "" : arg.name);
  return node("span", { class: "chip given", title: arg.source ?? arg.name, html: `${name} <small>${plain(shown(value, arg.unit))}</small>` });
}

function tellStep(id, label) {
  const s = stepOf(id), plan = planOf(s.plan), formula = s.formula;
  const where = [plan.title, label ? say("position {label}", { label }) : ""].filter(Boolean).join(", ");
  const found = [node("h2", { html: `${titled(id)} <small>${plain(shown(valueAt(id, label), s.unit))}</small>` }), node("p", { class: "where" }, where),
    node("p", { class: "sentence", html: lettered(at(s.sentence, label) ?? "") })];
  if (formula) {
    const numbers = at(formula.numbers, label);
    found.push(node("div", { class: "formula", html: mathml(formula.symbols) + (numbers ? mathml(`= ${numbers}`) : "") }));
  }
  const args = s.args.filter((a) => a.name !== "constant" || a.step !== undefined);
  if (args.length) found.push(node("h3", {}, say("made of")), node("div", { class: "chips" }, ...args.map((a) => argumentChip(a, label))));
  const next = [...new Set(children.get(id) ?? [])];
  if (next.length) {
    found.push(node("h3", {}, say("from it follow")), node("div", { class: "chips" }, ...next.slice(0, 12).map((one) => chip(one, label))));
    if (next.length > 12) found.push(node("p", { class: "hint" }, say("and {n} more", { n: next.length - 12 })));
  }
  return found;
}

// The whole way from the given numbers to a step.
function tellWhy(id, label) {
  const list = node("ol", { class: "why" }), told = new Set();
  for (const one of chain(id)) {
    for (const arg of stepOf(one).args) {
      if (arg.step === undefined && arg.name !== "constant" && !told.has(arg.name)) {
        told.add(arg.name);
        list.append(node("li", {}, argumentChip(arg, label), ` ${arg.source ?? say("given")}`));
      }
    }
    list.append(node("li", {}, chip(one, label), node("span", { html: ` ${lettered(at(stepOf(one).sentence, label) ?? "")}` })));
  }
  return node("details", {}, node("summary", {}, say("why: back to the givens")), list);
}
