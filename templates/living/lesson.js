// The lesson of a polygon: the mechanism, the plan beside it, above them the vector equation that fills in as vectors are drawn.
// Each vector is born at the mechanism: the link whose direction is taken glows, turns, slides to its place in the plan.

const lesson = { told: null, at: -1, mode: "show", cards: [], moving: 0 };

const stopNow = () => lesson.told.stops[lesson.at];
const here = (id) => valueOf(id, machine.phi);
const apart = (a, b) => size(sub(here(b), here(a)));
const rounded = (x, many) => String(Number(x.toPrecision(many))).replace(".", decimal());
const inMm = (value) => (value / lessonScale()).toFixed(1).replace(".", decimal());
const unitOf = (id) => { const unit = stepOf(id)?.unit ?? id; return UNITS()[unit] ?? unit; };

// Indices below and signs above of names such as b3, ω3 or a^τ.
const indexed = (text) => lettered(text.replace(/\^(?!\{)(.)/gu, "^{$1}").replace(/(?<![_{\d])(\p{L}′?)(\d+)/gu, "$1_{$2}"));
const calledHere = (id) => indexed(stepOf(id).symbol ?? stepOf(id).name);

// What a millimetre stands for: as on the sheet, or the next standard scale with which the plan stays below a sheet's width.
function lessonScale() {
  const mu = lesson.cards[1].marks[0].mu[0], widest = Math.max(...lesson.told.stops.map(endsOf).filter(Boolean).map(([a, b]) => apart(a, b)).filter(Number.isFinite), 0) / mu;
  for (let ten = 1; ; ten *= 10) for (const times of [1, 2, 2.5, 4, 5]) if (widest / (times * ten) <= 320 || ten > 1e9) return mu * times * ten;
}

// Ends of the vector of a stop, ids of points of the plan.
function endsOf(stop) {
  if (stop.kind === "lay" || stop.kind === "similar") return [stop.tail, stop.step];
  if (stop.kind === "rate" || stop.kind === "close") return [stop.tail, stop.head];
  return null;
}

const isNothing = (stop) => { const ends = endsOf(stop); return ends && stop.kind !== "rate" && apart(...ends) / lessonScale() < 0.05; };
const segmentName = (a, b) => `|${calledHere(a)}${/^\d/.test(stepOf(a).name) ? "–" : ""}${calledHere(b)}|`;

// A product with so many digits of its factors that what is printed gives what is printed.
function product(factors, value, sign) {
  for (let many = 4; many <= 7; many++) {
    const printed = factors.reduce((all, [x, power]) => all * Number(x.toPrecision(many)) ** power, 1);
    if (rounded(printed, 4) === rounded(value, 4) || many === 7) return `${factors.map(([x, power], n) => `${n ? (power < 0 ? " : " : "·") : ""}${rounded(x, many)}${power === 2 ? "²" : ""}`).join("")} ${sign} ${rounded(value, 4)}`;
  }
}

const sized = (value) => `${rounded(value, 4)} : ${rounded(lessonScale(), 4)} = <b>${inMm(value)} ${UNITS().mm}</b>`;

// The formula of a stop in letters, in numbers, in millimetres: lines of markup.
function formulaOf(stop) {
  const unit = unitOf(planOf(lesson.told.plan).unit), mu = lessonScale();
  if (stop.kind === "line") return [`${stop.across ? "⟂" : "∥"} ${indexed(stop.name)}`];
  if (stop.rate) {
    const w = Math.abs(here(stop.rate)), l = apart(...stop.along), value = apart(...endsOf(stop)), of = stop.twice ? `V<sub>${indexed(stop.name)}</sub>` : `l<sub>${indexed(stop.name)}</sub>`;
    return [`${stop.letter && `${symbolMarkup(stop.letter.replace("̅", ""))} = `}${stop.twice ? "2·" : ""}${calledHere(stop.rate)}${stop.power === 2 ? "²" : ""}·${of}`,
      `= ${product([...(stop.twice ? [[2, 1]] : []), [w, stop.power], [l, 1]], value, "=")} ${unit}`, sized(value)];
  }
  if (stop.force) return [`${calledHere(stop.force)} = ${rounded(apart(...endsOf(stop)), 4)} ${unit}`, sized(apart(...endsOf(stop)))];
  if (stop.kind === "similar") {
    const [q, b, d] = stop.places, [nq, nb, nd] = [stop.names[2], stop.names[3], stop.names[4]].map(indexed), mm = apart(...endsOf(stop)) / mu;
    return [`${segmentName(...endsOf(stop))} = ${segmentName(stop.tail, stop.to)}·${nq}${nd} : ${nq}${nb}`,
      `= ${product([[apart(stop.tail, stop.to) / mu, 1], [apart(q, d), 1], [apart(q, b), -1]], mm, "=")} ${UNITS().mm}`];
  }
  if (stop.kind === "rate") {
    const l = apart(...stop.along), value = Math.abs(here(stop.step));
    return [`|${calledHere(stop.step)}| = ${stepOf(stop.step).unit.endsWith("2") ? "a<sup>τ</sup>" : "V"} : l<sub>${indexed(stop.name)}</sub>`, `= ${product([[value * l, 1], [l, -1]], value, "=")} ${unitOf(stop.step)}`];
  }
  if (stop.kind === "meet" && !stop.of.length) return [];
  const [a, b] = stop.kind === "close" ? endsOf(stop) : stop.kind === "meet" ? [stop.of[0], stop.step] : [];
  return a ? [`${segmentName(a, b)}·μ = ${product([[apart(a, b) / mu, 1], [mu, 1]], apart(a, b), "=")} ${unit}`] : [];
}

// --- what is told ---------------------------------------------------------------------------------------------------------

function sentencesOf(stop) {
  const value = stop.say.includes("{value}") ? shown(here(stop.step), ["number", "angle"].includes(stepOf(stop.step).kind) ? "" : stepOf(stop.step).unit) : "";
  const force = Array.isArray(here(stop.step)) && value ? `${rounded(size(here(stop.step)), 5)} ${unitOf(stop.step)}` : value;
  const found = [indexed(stop.say.replace("{value}", force))];
  if (stop.kind === "line" || stop.kind === "rate" || stop.kind === "close") return found;
  const pairs = stop.kind === "meet" ? stop.of.map((tail) => [tail, stop.step]) : [endsOf(stop)].filter(Boolean);
  for (const [a, b] of pairs) {
    if (apart(a, b) / lessonScale() < 0.05) found.push(say("the same point", { name: calledHere(b), other: calledHere(a) }));
    else found.push(say("segment", { name: segmentName(a, b).slice(1, -1), mm: inMm(apart(a, b)) }));
  }
  return found;
}

function tellLesson() {
  const stop = stopNow(), words = $("told"), all = lesson.told.stops.length;
  $("lessonScrub").value = lesson.at + 1;
  $("lessonScrub").setAttribute("aria-valuetext", stop ? `${lesson.at + 1}. ${stop.title}` : "0");
  $("lessonBack").disabled = lesson.at < 0;
  $("lessonNext").disabled = lesson.at === all - 1;
  const moment = momentOf(machine.phi), changes = record.motion && changed().length ? `, ${say("with other numbers")}` : "";
  $("lessonPhi").textContent = moment;
  if (!stop) { words.innerHTML = `<h2>${plain(planOf(lesson.told.plan).title)}${plain(changes)}</h2><p>${plain(say("begin"))}</p>`; return; }
  const head = `<h2><span class="count">${plain(say("step {n} of {all}", { n: lesson.at + 1, all }))}</span> ${plain(stop.title)}${plain(changes)}</h2>`;
  words.innerHTML = `${head}<p>${sentencesOf(stop).join(" ")}</p>${stop.why ? `<p class="hint">${plain(stop.why)}</p>` : ""}`;
}

// --- the equation ---------------------------------------------------------------------------------------------------------

// When a term is drawn, and when its line of unknown length is: numbers of stops.
function termStops(term) {
  const all = lesson.told.stops, of = (id) => all.findIndex((stop) => stop.kind !== "line" && stop.step === id);
  const closes = all.findIndex((stop) => stop.kind === "close" && stop.tail === term.tail && stop.head === term.head);
  const line = all.findIndex((stop) => stop.kind === "line" && [term.tail, term.head].includes(stop.tail) && [term.tail, term.head].includes(stop.step));
  return { drawn: closes >= 0 ? closes : Math.max(of(term.tail), of(term.head)), line };
}

// The equation that is filled in: the last of which something is drawn beyond what those before it were made of.
function equationNow() {
  let now = lesson.told.equations[0], met = -1;
  for (const one of lesson.told.equations) {
    const begins = one.sides.flat().flatMap((term) => Object.values(termStops(term))).filter((n) => n > met);
    if (Math.min(...begins) <= lesson.at) now = one;
    met = lesson.told.stops.findIndex((stop) => stop.kind === "meet" && stop.step === one.end);
  }
  return now;
}

// Colours of vectors by their ends: a term and its vector have one.
function colours() {
  const found = new Map();
  for (const { sides } of lesson.told.equations) sides.flat().forEach((term, n) => { if (!found.has(`${term.tail} ${term.head}`)) found.set(`${term.tail} ${term.head}`, n % 6 + 1); });
  return found;
}

// A letter with a bar, its index and its sign above.
function symbolMarkup(symbol) {
  const [, base, below = "", above = ""] = /^([^_^]+)(?:_(\{[^}]*\}|[^_^]+))?(?:\^(\{[^}]*\}|.+))?$/u.exec(symbol) ?? [null, symbol];
  const bare = (text) => indexed(text.replace(/[{}]/g, ""));
  return `<span class="q"><i class="${base.includes("̅") ? "bar" : ""}">${plain(base.replace("̅", ""))}</i><span class="ss"><sup>${bare(above)}</sup><sub>${bare(below)}</sub></span></span>`;
}

function drawEquation() {
  const place = $("equation"), one = equationNow(), found = [], colour = colours();
  place.replaceChildren();
  if (!one) return;
  one.sides.forEach((side, n) => {
    if (n || one.head !== "0") found.push(node("span", { class: "op" }, n ? "=" : ""));
    side.forEach((term, i) => {
      if (i) found.push(node("span", { class: "op" }, "+"));
      const { drawn, line } = termStops(term), known = term.times === 2, on = lesson.at, bars = known ? (on >= drawn ? 2 : 0) : on >= Math.min(drawn, line < 0 ? drawn : line) ? 1 : 0;
      const below = on >= drawn ? inMm(apart(term.tail, term.head)) : bars && line >= 0 ? formulaOf(lesson.told.stops[line])[0] : "";
      found.push(node("button", { type: "button", class: `term c${colour.get(`${term.tail} ${term.head}`)}${bars ? "" : " out"}${[drawn, line].includes(lesson.at) ? " cur" : ""}`, onclick: () => goStop(line >= 0 && lesson.at < line ? line : drawn),
        html: `${symbolMarkup(term.symbol)}<u class="${bars ? "on" : ""}"></u><u class="${bars > 1 ? "on" : ""}"></u><small>${below}</small>` }));
    });
  });
  if (one.head === "0") found.push(node("span", { class: "op" }, "= 0"));
  else {
    const end = termStops({ tail: lesson.told.pole, head: one.end }).drawn;
    found.unshift(node("span", { class: `term head${lesson.at >= end ? "" : " out"}`, html: `${symbolMarkup(one.head)}<u></u><u></u><small>${lesson.at >= end ? inMm(apart(lesson.told.pole, one.end)) : ""}</small>` }));
    found[1].textContent = "=";
  }
  place.append(...found);
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
  Object.assign(lesson, { told, at: clip(at, -1, told.stops.length - 1) });
  lesson.cards = [besideOf(told, views), views.find((view) => view.plan === told.plan)].map((view) => makeCard(view, (id) => {
    const n = told.stops.findIndex((stop) => stop.step === id && stop.kind !== "line");
    if (n >= 0) goStop(n);
  }));
  $("pair").replaceChildren(...lesson.cards.map((card) => card.figure), $("fly"), $("tag"));
  lesson.steps = lesson.cards.map((card) => card.marks.map((mark) => card.live.sheet.marks.find((m) => m.id === mark.id)));
  $("lessonScrub").max = told.stops.length;
  $("lessonPlan").value = told.plan;
}

// The plan is fitted once for each angle, with letters as large as the page's own.
function fitLesson() {
  const rem = parseFloat(getComputedStyle(document.documentElement).fontSize), values = parts(machine.phi);
  for (const card of lesson.cards) {
    const { clientWidth: wide, clientHeight: high } = card.svg, mm = rem * 0.3;
    card.room = [Math.max(wide / mm - 30, 20), Math.max(high / mm - 24, 20)];
    frameCard(card, [values]);
  }
}

const placersNow = () => lesson.cards.map((card) => placer(parts(machine.phi), card.shrunk));

function drawLesson(t = 1) {
  if ($("lesson").hidden || !lesson.told) return;
  const values = parts(machine.phi), lost = notThere(values), order = new Map();
  $("lesson").classList.toggle("missing", Boolean(lost));
  if (lost) { drawMissing(lost, values); return; }
  fitLesson();
  lesson.told.stops.forEach((stop, n) => { if (stop.kind !== "line" && !order.has(stop.step)) order.set(stop.step, n); });
  const seen = t < 1 ? lesson.at - 1 : lesson.at, colour = colours(), named = new Map([...colour].map(([ends, n]) => [ends.split(" ").map((id) => stepOf(id).name).join("–"), n]));
  lesson.cards.forEach((card, side) => {
    drawCard(card, values);
    card.svg.querySelector(".over").replaceChildren();
    if (!side) return;
    card.marks.forEach((mark, n) => {
      const of = lesson.steps[side][n], when = order.get(of?.step) ?? -1, list = card.elements[n].classList;
      list.toggle("undrawn", when > seen);
      list.toggle("cur", when === lesson.at);
      for (const name of [...list].filter((one) => /^c\d$/.test(one))) list.remove(name);
      const vector = mark.role === "vector" && mark.kind !== "text";
      list.toggle("shaft", vector && mark.kind === "line");
      if (vector && named.has(of?.name)) list.add(`c${named.get(of.name)}`);
    });
  });
  lesson.cards[0].caption.textContent = say("mechanism");
  const unit = unitOf(planOf(lesson.told.plan).unit);
  lesson.cards[1].caption.textContent = `${planOf(lesson.told.plan).title}, μ = ${digits(Number(lessonScale().toPrecision(3)))} ${/[/·]/.test(unit) ? `(${unit})` : unit}/${UNITS().mm}`;
  drawOver(t);
  drawEquation();
}

const overOf = (side) => lesson.cards[side].svg.querySelector(".over");
const stroke = (side, kind, points, closed = false) => overOf(side).append(svgNode("path", { class: kind, d: polyPath(points, 0, closed) }));

function arrow(side, kind, a, b) {
  const u = straight(sub(b, a));
  stroke(side, kind, [a, b]);
  if (Number.isFinite(u[0])) stroke(side, `${kind} solid`, [b, add(b, mul(u, [-3.4, 0.75])), add(b, mul(u, [-3.4, -0.75]))], true);
}

// Direction of a stop in the plan: of its line, or of its vector.
function directionNow(stop, placed) {
  const mark = lesson.cards[1].marks[0];
  if (stop.kind === "line") return placed.direction({ ...mark, along: [stop.direction] });
  const [a, b] = endsOf(stop).map((id) => placed.point(mark, id));
  return straight(sub(b, a));
}

// The point of the mechanism that an end of a vector is the velocity, or acceleration, of.
function pointOf(id) {
  const name = stepOf(id).name, found = [name, name.replace(/\d+$/, "")].map((one) => `positions/${one[0].toUpperCase()}${one.slice(1)}`);
  return found.find((one) => one in record.motion.all.results && stepOf(one).kind === "point");
}

// Where the direction of a stop is at the mechanism: two places, mm of its card; nothing where it comes from nowhere there.
function sourceOf(stop, [mechanism, plan]) {
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

function turningArrow(centre, sense, kind) {
  const r = 8, from = sense > 0 ? -0.6 : Math.PI + 0.6, points = Array.from({ length: 17 }, (_, i) => add(centre, scale(r, cis(from + sense * i * 0.15))));
  stroke(0, kind, points);
  arrow(0, kind, points[15], points[16]);
}

// What lies over the drawings: lines whose length is not known yet, the glowing link, the vector on its way, its formula.
function drawOver(t) {
  const placers = placersNow(), stop = stopNow(), colour = colours(), mark = lesson.cards[1].marks[0], place = (id) => placers[1].point(mark, id);
  const seen = t < 1 ? lesson.at - 1 : lesson.at;
  lesson.told.stops.forEach((line, n) => {
    const meets = lesson.told.stops.findIndex((one) => one.kind === "meet" && one.step === line.step);
    if (line.kind !== "line" || n > seen || lesson.at > meets) return;
    const u = directionNow(line, placers[1]), a = place(line.tail), c = colour.get(`${line.tail} ${line.step}`) ?? colour.get(`${line.step} ${line.tail}`) ?? 0;
    stroke(1, `direction c${c}`, [sub(a, scale(400, u)), add(a, scale(400, u))]);
  });
  $("fly").replaceChildren();
  $("tag").hidden = true;
  if (!stop) return;
  const source = isNothing(stop) ? null : sourceOf(stop, placers);
  if (source && stop.kind !== "rate") stroke(0, "glow", source);
  if (stop.kind === "rate") {
    const sense = Math.sign(here(stop.step)), centre = placers[0].point(lesson.cards[0].marks[0], stop.along[0]);
    if (source) stroke(0, "glow", source);
    if (sense && t === 1) turningArrow(centre, sense, "turning");
    if (t === 1 && sense) { const b = source[1], u = scale(16 * sense, mul([0, 1], straight(sub(b, source[0])))); arrow(0, "turning", b, add(b, u)); }
  }
  if (t < 1 && source) fly(stop, source, placers[1], t);
  if (t === 1) tagAt(stop, placers[1]);
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
  const ends = stop.kind === "line" ? [sub(tail, scale(30, u)), add(tail, scale(30, u))] : endsOf(stop).map((id) => plan.point(mark, id));
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
  tag.hidden = !lines.length || isNothing(stop);
  if (tag.hidden) return;
  tag.innerHTML = lines.map((line) => `<span>${line}</span>`).join("");
  const box = $("fly").getBoundingClientRect(), frame = lesson.cards[1].svg.getBoundingClientRect(), w = tag.offsetWidth, h = tag.offsetHeight;
  const ids = [...new Set(lesson.told.stops.slice(0, lesson.at + 1).flatMap((one) => endsOf(one) ?? (one.kind === "meet" ? one.of.map((a) => [a, one.step]) : []).flat()))];
  const dots = ids.map((id) => onPage(1, plan.point(mark, id)));
  const lines2 = lesson.told.stops.slice(0, lesson.at + 1).flatMap((one) => (one.kind === "meet" ? one.of.map((a) => [a, one.step]) : [endsOf(one)].filter(Boolean))).filter((pair) => pair.every((id) => ids.includes(id)))
    .map((pair) => pair.map((id) => onPage(1, plan.point(mark, id)))).filter((pair) => pair.flat().every(Number.isFinite));
  const own = endsOf(stop) ?? [stop.tail ?? stop.of?.[0], stop.kind === "meet" ? stop.step : stop.tail], [a, b] = own.map((id) => onPage(1, plan.point(mark, id))), middle = scale(0.5, add(a, b));
  const x0 = frame.left - box.left + 6, y0 = frame.top - box.top + 6, x1 = frame.right - box.left - w - 6, y1 = frame.bottom - box.top - h - 6;
  let best = null;
  for (let i = 0; i < 24; i++) for (const r of [1, 1.6, 2.4, 3.4]) {
    const x = clip(middle[0] + r * (w / 2 + 14) * Math.cos(i * Math.PI / 12) - w / 2, x0, Math.max(x0, x1)), y = clip(middle[1] + r * (h / 2 + 22) * Math.sin(i * Math.PI / 12) - h / 2, y0, Math.max(y0, y1));
    const inside = ([px, py]) => px > x - 8 && px < x + w + 8 && py > y - 14 && py < y + h + 14;
    let cost = r + size(sub([x + w / 2, y + h / 2], middle)) / 150 + 6 * dots.filter(inside).length;
    for (const [p, q] of lines2) for (let n = 0; n <= 20; n++) if (inside(step(p, n / 20, sub(q, p)))) cost += 1;
    if (!best || cost < best.cost) best = { cost, x, y };
  }
  tag.style.transform = `translate(${best.x}px, ${best.y}px)`;
}

// --- going on -------------------------------------------------------------------------------------------------------------

function showStop(then = () => {}) {
  cancelAnimationFrame(lesson.moving);
  tellLesson();
  if (still() || !stopNow() || isNothing(stopNow())) { drawLesson(); then(); return; }
  const start = performance.now(), frame = (now) => {
    const t = clip((now - start) / 1500, 0, 1);
    drawLesson(t);
    if (t < 1) lesson.moving = requestAnimationFrame(frame); else then();
  };
  frame(start);
}

function goStop(n, quick = false) {
  lesson.at = clip(n, -1, lesson.told.stops.length - 1);
  if (quick) { cancelAnimationFrame(lesson.moving); tellLesson(); drawLesson(); } else showStop();
  writeAddress();
}

function nextStop() {
  if (lesson.at < lesson.told.stops.length - 1) goStop(lesson.at + 1);
}

function lessonMode(mode) {
  lesson.mode = lesson.mode === mode ? "show" : mode;
  document.body.classList.toggle("lecture", lesson.mode === "lecture");
  $("lecturing").setAttribute("aria-pressed", String(lesson.mode === "lecture"));
  if (lesson.mode === "lecture") document.documentElement.requestFullscreen?.().catch(() => {}); else if (document.fullscreenElement) document.exitFullscreen();
  goStop(lesson.at, true);
}

function lessonBar() {
  const button = (id, text, key, act, more = {}) => node("button", { type: "button", id, "aria-label": say(key), title: say(key), onclick: act, ...more }, text);
  const range = (id, key, more, act) => node("input", { type: "range", id, class: "scrub", "aria-label": say(key), ...more, oninput: act });
  const period = record.motion.period * 180 / Math.PI;
  return [
    button("lessonBack", "‹", "step back", () => goStop(lesson.at - 1, true)),
    range("lessonScrub", "steps", { min: 0, value: 0 }, () => goStop(Number($("lessonScrub").value) - 1, true)),
    button("lessonNext", "›", "step", nextStop), button("lessonAgain", "↻", "play", () => showStop(), { class: "wide" }),
    node("output", { class: "count", id: "lessonPhi" }),
    range("lessonTurn", "crank angle", { min: 0, max: period, step: 0.1, value: angleTurned() * 180 / Math.PI }, () => turnTo(Number($("lessonTurn").value) * Math.PI / 180)),
    node("select", { id: "lessonPlan", "aria-label": say("which plan"), onchange: (event) => { takeLesson(event.target.value); goStop(-1, true); } },
      ...record.lessons.map((one) => node("option", { value: one.plan }, planOf(one.plan).title))),
    button("lecturing", say("lecture"), "lecture", () => lessonMode("lecture"), { "aria-pressed": "false" }),
    button("link", say("copy link"), "copy link", copyLink, { class: "wide" }),
  ];
}

function lessonTurned() {
  cancelAnimationFrame(lesson.moving);
  tellLesson();
  drawLesson();
  $("lessonTurn").value = angleTurned() * 180 / Math.PI;
  writeAddress();
}

const lessonKeys = () => ({ " ": nextStop, ArrowRight: nextStop, PageDown: nextStop, ArrowLeft: () => goStop(lesson.at - 1, true), PageUp: () => goStop(lesson.at - 1, true),
  Home: () => goStop(-1, true), End: () => goStop(Infinity, true), f: () => lessonMode("lecture"), а: () => lessonMode("lecture"),
  r: () => showStop(), к: () => showStop(), b: () => document.body.classList.toggle("dark"), и: () => document.body.classList.toggle("dark"), Escape: () => { if (lesson.mode !== "show") lessonMode(lesson.mode); } });

function openLesson(plan, at = -1) {
  if (lesson.told?.plan !== plan || !lesson.cards.length) takeLesson(plan, at); else lesson.at = at;
  if (!lesson.watched) {
    lesson.watched = true;
    new ResizeObserver(() => { if (!$("lesson").hidden) drawLesson(); }).observe($("pair"));
    document.addEventListener("fullscreenchange", () => { if (!document.fullscreenElement && lesson.mode === "lecture") lessonMode("lecture"); });
  }
  goStop(lesson.at, true);
}

// --- what does not assemble -----------------------------------------------------------------------------------------------

// Two arcs that miss each other, or an arc and a line: drawn where the mechanism would stand, with the gap between them.
function drawMissing([id], values) {
  $("fly").replaceChildren();
  $("tag").hidden = true;
  const s = stepOf(id), gap = gapOf(id, values), given = (arg) => (arg.step !== undefined ? taken(record.motion.all.results[arg.step] ?? [0, 1], values) : machine.given[arg.name] ?? arg.given);
  $("told").innerHTML = `<h2 class="bad">${plain(say("does not assemble at this angle"))}: ${indexed(s.name)}${gap ? `, ${plain(say("gap"))} ${told(gap, "m")}` : ""}</h2>`;
  fitLesson();
  const card = lesson.cards[0], placed = placer(values, card.shrunk), mark = card.marks[0], over = overOf(0);
  drawCard(card, values);
  over.replaceChildren();
  if (!/^arc cuts/.test(s.rule)) return;
  const args = s.args.map(given), mm = (x) => x / mark.mu[0] / card.shrunk, where = (n) => placed.point(mark, s.args[n].step);
  const [c1, c2] = [where(0), where(2)], r1 = mm(args[1]), u = s.rule.startsWith("arc cuts arc") ? straight(sub(c2, c1)) : mul([0, Math.sign(plainCross(args[3], sub(args[2], args[0]))) || 1], straight(args[3]));
  const towards = Math.atan2(u[1], u[0]), arc = (c, r, t) => over.append(svgNode("path", { class: "missing", d: arcPath([c[0], -c[1]], r, t - 0.7, t + 0.7) }));
  arc(c1, r1, towards);
  const near = add(c1, scale(r1, u));
  let other = add(near, scale(mm(gap), u));
  if (s.rule.startsWith("arc cuts arc")) {
    const r2 = mm(args[3]), d = size(sub(c2, c1)), inside = d < Math.abs(r1 - r2), back = inside && r1 < r2 ? towards : towards + Math.PI;
    arc(c2, r2, inside && r1 > r2 ? towards : back);
    other = add(c2, scale(r2, cis(inside && r1 > r2 ? towards : back)));
  } else stroke(0, "missing", [sub(other, scale(40, mul([0, 1], u))), add(other, scale(40, mul([0, 1], u)))]);
  stroke(0, "gap", [near, other]);
}
