// The lesson of a polygon: the mechanism, the plan beside it, above them the vector equation that fills in as vectors are drawn.
// Each vector is born at the mechanism: the link whose direction is taken glows, turns, slides to its place in the plan.

const lesson = { told: null, at: -1, asks: false, mode: "show", cards: [], grip: /** @type {(placed: object) => void} */ (() => {}) };

const stopNow = () => lesson.told.stops[lesson.at];
const here = (id) => valueOf(id, machine.phi);
const apart = (a, b) => size(sub(here(b), here(a)));
const rounded = (x, many) => String(Number(x.toPrecision(many))).replace(".", decimal()).replace("-", "−");
const inMm = (value) => (value / lessonScale()).toFixed(1).replace(".", decimal());
const unitOf = (id) => { const unit = stepOf(id)?.unit ?? id; return UNITS()[unit] ?? unit; };

// Indices below and signs above of names such as b3, ω3 or a^τ.
const indexed = (text) => lettered(text.replace(/\^(?!\{)(.)/gu, "^{$1}").replace(/(?<![_{\d])(\p{L}′?)(\d+)/gu, "$1_{$2}"));
const calledHere = (id) => indexed(stepOf(id).symbol ?? stepOf(id).name);

// What a millimetre stands for: as on the sheet, or the next standard scale with which the plan stays below a sheet's width.
function lessonScale() {
  const mu = lesson.cards[1].marks[0].mu[0], widest = Math.max(...lesson.told.stops.filter((stop) => stop.ends).map((stop) => apart(...stop.ends)).filter(Number.isFinite), 0) / mu;
  for (let ten = 1; ; ten *= 10) for (const times of [1, 2, 2.5, 4, 5]) if (widest / (times * ten) <= 320 || ten > 1e9) return mu * times * ten;
}

const vanishes = ([a, b]) => apart(a, b) / lessonScale() < 0.05;
const isNothing = (stop) => stop.ends && stop.kind !== "rate" && vanishes(stop.ends);
// Segments that are measured when a stop is drawn, by their ends.
const measuredAt = (stop) => (stop.kind === "meet" ? stop.of.map((tail) => [tail, stop.step]) : stop.ends ? [stop.ends] : []);
const segmentName = (a, b) => `|${calledHere(a)}${/^\d/.test(stepOf(a).name) ? "–" : ""}${calledHere(b)}|`;

const joined = (factors) => factors.map(([text, power], n) => `${n ? (power < 0 ? " : " : "·") : ""}${text}${power === 2 ? "²" : ""}`).join("");

// A product with so many digits of its factors that what is printed gives what is printed.
function product(factors, value) {
  for (let many = 4; many <= 7; many++) {
    const printed = factors.reduce((all, [x, power]) => all * Number(x.toPrecision(many)) ** power, 1);
    if (rounded(printed, 4) === rounded(value, 4) || many === 7) return `${joined(factors.map(([x, power]) => [rounded(x, many), power]))} = ${rounded(value, 4)}`;
  }
}

const sized = (value) => `${rounded(value, 4)} : ${rounded(lessonScale(), 4)} = <b>${inMm(value)} ${UNITS().mm}</b>`;

// What the size of a vector, or of a rate of turning, is a product of: names, numbers, units, powers.
function factorsOf(stop) {
  const unit = unitOf(planOf(lesson.told.plan).unit), { m, mm } = UNITS(), mu = lessonScale(), length = () => [`l<sub>${indexed(stop.name)}</sub>`, apart(...stop.along), m];
  if (stop.kind === "rate") return [[stepOf(stop.step).unit.endsWith("2") ? "a<sup>τ</sup>" : "V", here(stop.step) * apart(...stop.along), unit, 1], [...length(), -1]];
  if (stop.twice) return [["2", 2, "", 1], [calledHere(stop.rate), here(stop.rate), unitOf(stop.rate), 1], [`V<sub>${indexed(stop.name)}</sub>`, apart(...stop.along), unitOf(stop.along[0]), 1]];
  if (stop.rate) return [[calledHere(stop.rate), here(stop.rate), unitOf(stop.rate), stop.power], [...length(), 1]];
  if (stop.force) return [[calledHere(stop.force), apart(...stop.ends), unit, 1]];
  if (stop.kind === "similar") {
    const [q, b, d] = stop.places, [, , nq, nb, nd] = stop.names.map(indexed);
    return [[segmentName(stop.tail, stop.to), apart(stop.tail, stop.to) / mu, mm, 1], [nq + nd, apart(q, d), m, 1], [nq + nb, apart(q, b), m, -1]];
  }
  return [];
}

// The symbol of a vector by its ends, without its bar: of a term, or of what an equation gives.
function sizeSymbol(tail, head) {
  const symbol = lesson.terms.get(`${tail} ${head}`)?.symbol ?? (tail === lesson.told.pole && lesson.told.equations.find((one) => one.end === head)?.head);
  return symbol ? `${symbolMarkup(symbol.replace("̅", ""))} = ` : "";
}

// The formula of a stop in letters, in numbers, in millimetres: lines of markup.
function formulaOf(stop) {
  if (stop.kind === "line") return [`${stop.across ? "⟂" : "∥"} ${indexed(stop.name)}`];
  const measured = ({ meet: 1, close: 1 })[stop.kind] ? measuredAt(stop).filter((ends) => !vanishes(ends)) : [], mu = lessonScale();
  if (measured.length) return measured.map(([a, b]) => `${sizeSymbol(a, b)}${segmentName(a, b)}·μ = ${product([[apart(a, b) / mu, 1], [mu, 1]], apart(a, b))} ${unitOf(planOf(lesson.told.plan).unit)}`);
  const factors = factorsOf(stop), rate = stop.kind === "rate", value = rate ? Math.abs(here(stop.step)) : Math.abs(factors.reduce((all, [, x, , power]) => all * x ** power, 1));
  if (!factors.length) return [];
  const unit = rate ? unitOf(stop.step) : stop.kind === "similar" ? UNITS().mm : unitOf(planOf(lesson.told.plan).unit), letters = joined(factors.map(([name, , , power]) => [name, power]));
  if (stop.force) return [`${letters} = ${rounded(value, 4)} ${unit}`, sized(value)];
  const numbers = `${product(factors.map(([, x, , power]) => [Math.abs(x), power]), value)} ${unit}`;
  const left = rate ? `|${calledHere(stop.step)}|` : stop.rate ? stop.letter && symbolMarkup(stop.letter.replace("̅", "")) : segmentName(...stop.ends);
  return [`${left && `${left} = `}${letters}`, `= ${numbers}`, ...(stop.rate ? [sized(value)] : [])];
}

// --- what is told ---------------------------------------------------------------------------------------------------------

function sentencesOf(stop) {
  const value = stop.say.includes("{value}") ? shown(here(stop.step), ["number", "angle"].includes(stepOf(stop.step).kind) ? "" : stepOf(stop.step).unit) : "";
  const force = Array.isArray(here(stop.step)) && value ? `${rounded(size(here(stop.step)), 5)} ${unitOf(stop.step)}` : value;
  const found = [indexed(stop.say.replace("{value}", force)), ...(stop.kind === "rate" && here(stop.step) ? [`(${say(here(stop.step) < 0 ? "clockwise" : "counter-clockwise")})`] : [])];
  return [...found, ...(["rate", "close"].includes(stop.kind) ? [] : measuredAt(stop)).map(([a, b]) => (vanishes([a, b]) ? say("the same point", { name: calledHere(b), other: calledHere(a) }) : say("segment", { name: segmentName(a, b).slice(1, -1), mm: inMm(apart(a, b)) })))];
}

function tellLesson() {
  const stop = stopNow(), all = lesson.told.stops.length, changes = changed().length ? `, ${say("with other numbers")}` : "";
  Object.assign($("lessonScrub"), { max: all, value: lesson.at + 1, ariaValueText: stop ? `${lesson.at + 1}. ${stop.title}` : "0" });
  $("lessonPlan").value = lesson.told.plan;
  $("lessonBack").disabled = lesson.at < 0;
  $("lessonNext").disabled = lesson.at === all - 1 && !lesson.asks;
  const head = node("h2", { ".innerHTML": stop ? `<span class="count">${plain(say("step {n} of {all}", { n: lesson.at + 1, all }))}</span> ${plain(stop.title)}${plain(changes)}` : plain(planOf(lesson.told.plan).title + changes) });
  if (lesson.asks) $("told").replaceChildren(head, ...askGuess(stop));
  else if (!stop) $("told").replaceChildren(head, node("p", {}, say("begin")), node("p", { class: "hint", ".innerHTML": wordsOfSymbols().join(" ") }));
  else $("told").replaceChildren(head, node("p", { ".innerHTML": sentencesOf(stop).join(" ") }), ...(stop.why ? [node("p", { class: "hint" }, stop.why, ...elsewhere(stop))] : []), ...verdict());
}

// What the symbols of the equations stand for, and a millimetre of the plan.
const wordsOfSymbols = () => [...lesson.told.symbols.map(([symbol, words]) => `${symbolMarkup(symbol)} ${plain(words)}.`),
  say("a millimetre", { value: `${rounded(lessonScale(), 4)} ${unitOf(planOf(lesson.told.plan).unit)}` })].map((line) => `<span class="word">${line}</span>`);

// The lessons of other plans that gave numbers of a formula, to be opened there.
function elsewhere(stop) {
  const given = [stop.rate, ...(stop.twice ? stop.along : [])].filter((id) => id && stepOf(id)?.plan !== lesson.told.plan);
  return record.lessons.filter(({ plan, stops }) => given.some((id) => stepOf(id).plan === plan) && stops.some(({ step }) => step === stop.rate)).map(({ plan, stops }) => {
    const names = [stop.rate, ...(stop.twice ? [""] : [])].map((id) => (id ? calledHere(id) : `V<sub>${indexed(stop.name)}</sub>`)).join(", ");
    return node("button", { type: "button", class: "chip", ".innerHTML": `${names} ← ${plain(planOf(plan).title)}`, onclick: () => openTab("lesson", plan, stops.findIndex(({ step }) => step === stop.rate)) });
  });
}

// --- the equation ---------------------------------------------------------------------------------------------------------

// A letter with a bar, its index and its sign above.
function symbolMarkup(symbol) {
  const [, base, below = "", above = ""] = /^([^_^]+)(?:_(\{[^}]*\}|[^_^]+))?(?:\^(\{[^}]*\}|.+))?$/u.exec(symbol) ?? [null, symbol];
  const bare = (text) => indexed(text.replace(/[{}]/g, ""));
  return `<span class="q"><i class="${base.includes("̅") ? "bar" : ""}">${plain(base.replace("̅", ""))}</i><span class="ss"><sup>${bare(above)}</sup><sub>${bare(below)}</sub></span></span>`;
}

function drawEquation(seen) {
  const one = lesson.told.equations[stopNow()?.equation ?? 0], op = (sign) => node("span", { class: "op" }, sign);
  const filled = (symbol, bars, below) => `${symbolMarkup(symbol)}${[0, 1].map((n) => `<u class="${bars > n ? "on" : ""}"></u>`).join("")}<small>${below}</small>`;
  const term = ({ symbol, tail, head, times, drawn, line }) => {
    const bars = times === 2 ? (seen >= drawn ? 2 : 0) : seen >= Math.min(drawn, line < 0 ? drawn : line) ? 1 : 0;
    const below = seen >= drawn ? inMm(apart(tail, head)) : bars && line >= 0 ? formulaOf(lesson.told.stops[line])[0] : "";
    return button("", () => goStop(line >= 0 && lesson.at < line ? line : drawn), { ".innerHTML": filled(symbol, bars, below),
      class: `term c${lesson.terms.get(`${tail} ${head}`).colour}${bars ? "" : " out"}${lesson.at >= 0 && [drawn, line].includes(lesson.at) ? " cur" : ""}` });
  };
  const head = one && one.head !== "0" && node("span", { class: `term head${seen >= one.drawn ? "" : " out"}`, ".innerHTML": filled(one.head, 0, seen >= one.drawn ? inMm(apart(lesson.told.pole, one.end)) : "") });
  const sum = (side) => side.flatMap((each, n) => (n ? [op("+"), term(each)] : [term(each)]));
  const sides = one?.sides.flatMap((side, n) => (n || head ? [op("="), ...sum(side)] : sum(side))) ?? [];
  $("equation").replaceChildren(...(head ? [head] : []), ...sides, ...(one && !head ? [op("= 0")] : []));
}

// --- the two drawings -----------------------------------------------------------------------------------------------------

// The mechanism as it is for this plan: a group with the forces that its polygon is made of, else the whole.
function besideOf(told, views) {
  const forces = new Set(told.stops.map((stop) => stop.force).filter(Boolean));
  const many = (view) => view.marks.filter((mark) => forces.has(view.sheet.marks.find((m) => m.id === mark.id)?.step)).length;
  return views.filter((view) => view.plan.startsWith("positions")).reduce((best, view) => (many(view) > many(best) ? view : best), views[0]);
}

function takeLesson(plan, at = -1) {
  const told = record.lessons.find((one) => one.plan === plan) ?? record.lessons[0], views = liveViews();
  const order = new Map(told.stops.flatMap((stop, n) => (stop.kind === "line" ? [] : [[stop.step, n]])).reverse()); // when each step is drawn
  const terms = new Map(); // colour of a vector and of its term, and when it is drawn, by its ends
  for (const { sides } of told.equations) sides.flat().forEach(({ tail, head, drawn, symbol }, n) => { if (!terms.has(`${tail} ${head}`)) terms.set(`${tail} ${head}`, { colour: n % 6 + 1, drawn, symbol }); });
  Object.assign(lesson, { told, order, terms, at: clip(at, -1, told.stops.length - 1) });
  lesson.cards = [besideOf(told, views), views.find((view) => view.plan === told.plan)].map((view) => makeCard(view, (id) => {
    const n = told.stops.findIndex((stop) => stop.step === id && stop.kind !== "line");
    if (n >= 0) goStop(n);
  }));
  $("pair").replaceChildren(...lesson.cards.map((card) => card.figure), $("fly"), $("tag"));
  lesson.cards[0].caption.textContent = say("mechanism");
  lesson.grip = makeGrip(lesson.cards[0]);
  makeGuess(lesson.cards[1]);
}

// The plan is fitted once for each angle, with letters as large as the page's own.
function fitLesson() {
  const rem = parseFloat(getComputedStyle(document.documentElement).fontSize), values = parts(machine.phi);
  for (const card of lesson.cards) {
    const { clientWidth: wide, clientHeight: high } = card.svg, mm = clip(high / 75, rem * 0.19, rem * 0.3);
    card.room = [Math.max(wide / mm - 30, 20), Math.max(high / mm - 30, 20)];
    card.svg.pixel = 0;
    Object.assign(card, card === lesson.cards[1] && lesson.asks && lesson.mode === "guess" ? roomToGuess() : { shows: null, around: null });
    frameCard(card, [values]);
  }
}

const placersNow = () => lesson.cards.map((card) => placer(parts(machine.phi), card.shrunk, card.shifts));

function drawLesson(t = 1) {
  if ($("lesson").hidden || !lesson.told) return;
  const values = parts(machine.phi), unknown = isStale() && lesson.told.stops.some(({ step }) => Number.isNaN([here(step)].flat()[0])), lost = notThere(values) ?? (unknown ? [] : undefined);
  $("lesson").classList.toggle("missing", Boolean(lost));
  $("fly").replaceChildren();
  $("tag").hidden = true;
  fitLesson();
  if (lost) { drawMissing(lost, values); return; }
  const seen = seenNow(t), drawnAt = (id) => lesson.order.get(id) ?? -1;
  lesson.cards.forEach((card, side) => {
    drawCard(card, values);
    card.over.replaceChildren();
    if (!side) return;
    card.marks.forEach((mark, n) => {
      const term = lesson.terms.get(mark.along.join(" ")), ends = mark.at.flatMap(([id, , , other]) => [drawnAt(id), drawnAt(other)]), list = card.elements[n].classList;
      const when = term?.drawn ?? Math.max(drawnAt(card.sources[n]?.step), ...ends);
      list.toggle("undrawn", when > seen);
      list.toggle("cur", when === lesson.at);
      for (const name of [...list].filter((one) => /^c\d$/.test(one))) list.remove(name);
      const vector = mark.role === "vector" && mark.kind !== "text";
      list.toggle("shaft", vector && mark.kind === "line");
      if (vector && term) list.add(`c${term.colour}`);
    });
  });
  lesson.cards[1].caption.textContent = `${planOf(lesson.told.plan).title}, ${scaleWords(lessonScale(), lesson.told.plan)}`;
  drawOver(t);
  drawEquation(lesson.asks ? seen : lesson.at);
  lesson.grip(placersNow()[0]);
  drawGuess();
}

// The last stop of which everything is drawn.
const seenNow = (t = 1) => (lesson.asks || t < 1 ? lesson.at - 1 : lesson.at);

// Direction of a stop in the plan: of its line, or of its vector.
function directionNow(stop, placed) {
  const mark = lesson.cards[1].marks[0];
  if (stop.kind === "line") return placed.direction({ ...mark, along: [stop.direction] });
  const [a, b] = stop.ends.map((id) => placed.point(mark, id));
  return straight(sub(b, a));
}

// Where the direction of a stop is at the mechanism: two places, mm of its card; nothing where it comes from nowhere there.
function sourceOf(stop, /** @type {any[]} */ [mechanism, plan]) {
  const mark = lesson.cards[0].marks[0], at = (id) => mechanism.point(mark, id);
  if (stop.kind === "similar") return [stop.places[0], stop.places[2]].map(at);
  if (stop.twice) {
    const from = pointOf(stop.along[1]) ?? pointOf(stop.along[0]);
    return from && [at(from), add(at(from), scale(18, straight(sub(here(stop.along[1]), here(stop.along[0])))))];
  }
  if (stop.along?.length) return (stop.kind === "lay" && !stop.across ? [stop.along[1], stop.along[0]] : stop.along).map(at);
  const through = stop.kind === "line" && pointOf(stop.step), u = through && scale(16, directionNow(stop, plan));
  return through && !stop.across ? [sub(at(through), u), add(at(through), u)] : null;
}

// What lies over the drawings: lines whose length is not known yet, the glowing link, the vector on its way, its formula.
function drawOver(t) {
  const placers = placersNow(), stop = stopNow(), mark = lesson.cards[1].marks[0], place = (id) => placers[1].point(mark, id);
  const seen = seenNow(t);
  lesson.told.stops.forEach((line, n) => {
    if (line.kind !== "line" || n > seen || lesson.at > line.until) return;
    const u = directionNow(line, placers[1]), a = place(line.tail), c = (lesson.terms.get(`${line.tail} ${line.step}`) ?? lesson.terms.get(`${line.step} ${line.tail}`))?.colour ?? 0;
    stroke(lesson.cards[1], `direction c${c}`, [sub(a, scale(400, u)), add(a, scale(400, u))]);
  });
  if (!stop || lesson.asks) return;
  const source = isNothing(stop) ? null : sourceOf(stop, placers);
  if (source) stroke(lesson.cards[0], "glow", source);
  const rate = stop.kind === "rate" ? t === 1 && stop.step : stop.rate, sense = rate ? Math.sign(here(rate)) : 0, card = lesson.cards[0];
  const gives = record.lessons.flatMap((one) => one.stops).find((one) => one.kind === "rate" && one.step === rate), about = gives?.along[0] ?? (stop.twice ? null : stop.along?.[0]); // hinge of its link
  if (sense && about) {
    const centre = placers[0].point(card.marks[0], about), from = sense > 0 ? -0.6 : Math.PI + 0.6, points = spread(from, from + sense * 2.4, 17).map((angle) => step(centre, 8, cis(angle)));
    stroke(card, "turning", points);
    arrow(card, "turning", points[15], points[16]);
    letter(card, placesAround(centre, [24, 22]), called(stepOf(rate)), placers[0]);
  }
  if (sense && stop.kind === "rate") arrow(card, "turning", source[1], step(source[1], 16 * sense, across(straight(sub(source[1], source[0])))));
  if (source && stop.twice) {
    arrow(card, "turning", ...source);
    letter(card, placesAround(source[1], NAMED), "V", placers[0]);
  }
  if (t < 1 && source) fly(stop, source, placers[1], t);
  if (t === 1) tagAt(stop, placers[1]);
}

// A letter with its index over a card, at the place of some that covers least.
function letter(card, places, name, placed) {
  const [x, y] = sub(leastCovered(places, NAMED, obstaclesOf(card, placed)), scale(0.4, NAMED)), text = svgNode("text", { class: "named", x: fixed(x), y: fixed(-y) });
  text.textContent = name.replace(/\d/g, (digit) => "₀₁₂₃₄₅₆₇₈₉"[digit]);
  card.over.append(text);
}

// A place of a card on the page, pixels of the overlay.
function onPage(side, [x, y]) {
  const p = new DOMPoint(x, -y).matrixTransform(lesson.cards[side].svg.getScreenCTM()), box = $("fly").getBoundingClientRect();
  return [p.x - box.left, p.y - box.top];
}

// The direction on its way from the mechanism to the plan: it turns where it is, then it slides over and takes its length.
function fly(stop, source, plan, t) {
  const [a, b] = source.map((z) => onPage(0, z)), mark = lesson.cards[1].marks[0];
  const u = directionNow(stop, plan), tail = plan.point(mark, stop.tail);
  const ends = stop.kind === "line" ? [sub(tail, scale(30, u)), add(tail, scale(30, u))] : stop.ends.map((id) => plan.point(mark, id));
  const [c, d] = ends.map((z) => onPage(1, z)), angle = (p, q) => Math.atan2(q[1] - p[1], q[0] - p[0]);
  const from = angle(a, b), whole = stop.kind === "line" ? Math.PI : 2 * Math.PI, by = mod(angle(c, d) - from + whole / 2, whole) - whole / 2;
  const ease = (x) => { const y = clip(x, 0, 1); return y * y * (3 - 2 * y); }, turnedBy = ease((t - 0.2) / 0.3), slid = ease((t - 0.5) / 0.45);
  const [back, forth] = stop.kind === "rate" ? [1 - slid, 1 - turnedBy] : [slid, turnedBy];
  const middle = step(scale(0.5, add(a, b)), back, sub(scale(0.5, add(c, d)), scale(0.5, add(a, b))));
  const half = (size(sub(b, a)) * (1 - back) + size(sub(d, c)) * back) / 2, v = scale(half, cis(from + by * forth));
  const p = sub(middle, v), q = add(middle, v), w = scale(1 / (half || 1), v), head = stop.kind === "line" ? "" : `M${add(q, mul(w, [-14, 4]))}L${q}L${add(q, mul(w, [-14, -4]))}`;
  $("fly").append(svgNode("path", { class: "flying", d: `M${p}L${q}${head}` }));
}

// The formula beside its vector, where it covers least.
function tagAt(stop, plan) {
  const tag = $("tag"), lines = formulaOf(stop), mark = lesson.cards[1].marks[0];
  Object.assign(tag, { hidden: !lines.length || isNothing(stop), innerHTML: lines.map((line) => `<span>${line}</span>`).join("") });
  if (tag.hidden) return;
  const card = lesson.cards[1], pixel = pixelOf(card.svg), wide = [tag.offsetWidth * pixel, tag.offsetHeight * pixel];
  const own = stop.ends ?? [stop.tail ?? stop.of?.[0], stop.kind === "meet" ? stop.step : stop.tail], [a, b] = own.map((id) => plan.point(mark, id)), middle = scale(0.5, add(a, b));
  const known = obstaclesOf(card, plan), along = (axis) => spread(known.view[axis] + wide[axis] / 2 + 1, known.view[axis + 2] - wide[axis] / 2 - 1, 17);
  const places = along(0).flatMap((x) => along(1).map((y) => [[x, y], size(sub([x, y], middle)) / 16])); // the nearest that is free
  const [x, y] = leastCovered(places, wide, known), [left, top] = onPage(1, [x - wide[0] / 2, y + wide[1] / 2]);
  tag.style.transform = `translate(${left}px, ${top}px)`;
}

// --- going on -------------------------------------------------------------------------------------------------------------

function showStop(quick = false) {
  const stop = stopNow(), drawn = stop && !lesson.asks && !quick && !still() && !isNothing(stop);
  tellLesson();
  animate(lesson, drawn ? DRAWN_MS : 0, drawLesson);
  writeAddress();
}

// Another stop, drawn before one's eyes, at once if `quick`; what the mode asks for is asked first.
function goStop(n, quick = false, asks = !quick) {
  lesson.at = clip(n, -1, lesson.told.stops.length - 1);
  lesson.asks = asks && lesson.mode !== "show" && stopNow()?.kind in ASKED;
  forgetGuess();
  showStop(quick);
}

function nextStop() {
  if (lesson.asks) giveUp(); else if (lesson.at < lesson.told.stops.length - 1) goStop(lesson.at + 1);
}

const STOP_MS = 4000, DRAWN_MS = 1500; // a stop is drawn and read

// Stops one after another, up to the last.
function playLesson(on) {
  const next = () => { if (lesson.at < lesson.told.stops.length - 1) goStop(lesson.at + 1, false, false); else playLesson(false); };
  clearInterval(lesson.plays);
  lesson.plays = on ? setInterval(next, STOP_MS) : 0;
  if ($("lessonPlay")) showRunning($("lessonPlay"), on);
  if (on) next();
}

// "lecture" or "guess", or out of it again.
function lessonMode(mode) {
  const was = lesson.mode;
  lesson.mode = was === mode ? "show" : mode;
  for (const one of ["lecture", "guess"]) $(one).setAttribute("aria-pressed", String(lesson.mode === one));
  document.body.classList.toggle("lecture", lesson.mode === "lecture");
  if (lesson.mode === "lecture") document.documentElement.requestFullscreen?.().catch(() => {}); else if (document.fullscreenElement) document.exitFullscreen();
  goStop(lesson.mode === "guess" ? Math.max(lesson.at, 0) : lesson.at, true, lesson.mode === "guess");
}

function lessonBar() {
  const mode = (name) => node("button", { type: "button", id: name, "aria-pressed": String(lesson.mode === name), onclick: () => lessonMode(name) }, say(name));
  return [
    control("lessonBack", "‹", "step back", () => goStop(lesson.at - 1, true)), range("lessonScrub", "steps", { min: 0, value: 0 }, (at) => goStop(at - 1, true)),
    control("lessonNext", "›", "step", nextStop), control("lessonPlay", "▶", "play", () => playLesson(!lesson.plays), { class: "wide", "data-sign": "▶", "data-key": "play" }), node("output", { class: "count angle" }), angleSlider(),
    choice("which plan", record.lessons.map((one) => [one.plan, planOf(one.plan).title]), "", (plan) => { takeLesson(plan); goStop(-1, true); }, { id: "lessonPlan" }),
    mode("guess"), mode("lecture"), node("button", { type: "button", id: "link", class: "wide", onclick: copyLink }, say("copy link")),
    button(say("film"), recordLesson, { class: "wide", disabled: !window.VideoEncoder, title: say(window.VideoEncoder ? "film of the plan" : "no film here") }),
  ];
}

function lessonKeys() {
  const back = () => goStop(lesson.at - 1, true), lecture = () => lessonMode("lecture"), guesses = () => lessonMode("guess"), dark = () => document.body.classList.toggle("dark");
  return { " ": nextStop, ArrowRight: nextStop, PageDown: nextStop, ArrowLeft: back, PageUp: back, Home: () => goStop(-1, true), End: () => goStop(Infinity, true),
    f: lecture, а: lecture, g: guesses, п: guesses, r: () => showStop(), к: () => showStop(), b: dark, и: dark, q: copyLink, й: copyLink, Enter: () => lesson.asks && checkGuess(),
    Escape: () => { if (lesson.mode !== "show") lessonMode(lesson.mode); } };
}

// The lesson on paper: a step a line, its picture beside.
function handOut() {
  const { at, asks } = lesson;
  const lines = lesson.told.stops.map((stop, n) => {
    goStop(n, true);
    const [equation, told] = ["equation", "told"].map((id) => node("div", { class: id, ".innerHTML": $(id).innerHTML }));
    return node("article", {}, lesson.cards[1].svg.cloneNode(true), node("div", {}, equation, told, node("p", { class: "formula", ".innerHTML": formulaOf(stop).join(" ") })));
  });
  $("handout").replaceChildren(node("h1", {}, `${planOf(lesson.told.plan).title}, ${momentOf(machine.phi)}`), lesson.cards[0].svg.cloneNode(true), ...lines);
  goStop(at, true, asks);
}

function openLesson(plan, at = -1) {
  if (lesson.told?.plan !== plan || !lesson.cards.length) takeLesson(plan, at); else lesson.at = at;
  goStop(lesson.at, true);
}

// --- what does not assemble -----------------------------------------------------------------------------------------------

// Two arcs that miss each other, or an arc and a line: drawn where the mechanism would stand, with the gap between them.
function drawMissing([id], values) {
  $("told").innerHTML = `<h2 class="bad">${id ? lostWords([id], values) : say("by the flywheel")}</h2>`;
  const [card] = lesson.cards, placed = placer(values, card.shrunk), mark = card.marks[0], s = stepOf(id), rounds = s?.rule.startsWith("arc cuts arc");
  drawCard(card, values);
  card.over.replaceChildren();
  lesson.grip(placed);
  if (!rounds && !s?.rule.startsWith("arc cuts line")) return;
  const args = argumentsNow(id, values), mm = (x) => x / mark.mu[0] / card.shrunk, [centre, other] = [0, 2].map((n) => placed.point(mark, s.args[n].step));
  const [radius, second, gap] = /** @type {any[]} */ ([args[1], args[3], gapOf(id, values)].map((x) => (Array.isArray(x) ? x : mm(x))));
  // From the centre of the first arc to where the other one, or the line, is nearest to it.
  const inside = rounds && size(sub(other, centre)) < Math.abs(radius - second), foot = mul([0, Math.sign(plainCross(args[3], sub(args[2], args[0]))) || 1], args[3]);
  const way = scale(inside && radius < second ? -1 : 1, straight(rounds ? sub(other, centre) : foot));
  const near = step(centre, radius, way), there = step(near, inside && radius > second ? -gap : gap, way);
  const arc = ([x, y], r, [u, v]) => card.over.append(svgNode("path", { class: "missing", d: arcPath([x, -y], r, Math.atan2(v, u) - 0.7, Math.atan2(v, u) + 0.7) }));
  arc(centre, radius, way);
  if (rounds) arc(other, second, sub(there, other)); else stroke(card, "missing", [step(there, 40, across(way)), step(there, -40, across(way))]);
  stroke(card, "gap", [near, there]);
  const { x, y, width, height } = card.svg.viewBox.baseVal, [x0, y0, x1, y1] = extentOf([[x, -y], [x + width, -y - height], ...[near, there].flatMap((z) => [sub(z, [9, 9]), add(z, [9, 9])])]);
  lookAt(card.svg, [x0, -y1, x1 - x0, y1 - y0]);
}
