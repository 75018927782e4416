// The linkage in motion: its views drawn for any crank angle from what their marks hang on.

const stage = { cards: [], playing: false, seconds: 6, moving: 0, vanes: false };

// One view of each plan, at the highlighted position where there is one; of groups and their forces every view.
function liveViews() {
  const all = record.sheets.flatMap((sheet) => (sheet.live ?? []).map((live) => ({ ...live, sheet }))), main = all.find((v) => v.plan === "positions");
  const loaded = (view) => view.marks.some((m) => m.role === "vector" && m.kind !== "text" && m.along.length === 1), kept = new Map();
  for (const one of [...all.filter((v) => v.position === main?.position), ...all]) {
    const key = one.plan.startsWith("positions") || loaded(one) ? one.view : one.plan;
    if (!kept.has(key)) kept.set(key, one);
  }
  const first = (v) => (v === main ? 0 : 1 + ["velocities", "accelerations", v.plan].indexOf(v.plan));
  return [...kept.values()].sort((a, b) => first(a) - first(b));
}

// A difference of a plan's points on the sheet, mm.
function turnedBy(frame, [x, y], shrunk = 1) {
  const w = [x / frame.mu[0] / shrunk, (frame.mirror ? -1 : 1) * y / frame.mu[1] / shrunk];
  return frame.turn ? mul(cis(frame.turn), w) : w;
}

// Anchors of a mark and its direction on the sheet, mm, y upwards; distances are so many times smaller than there.
function placer(values, shrunk = 1, shifts = null) {
  const number = (id) => taken(record.motion.all.results[id], values);
  const direction = (mark) => {
    if (!mark.along.length) return [1, 0];
    const ends = mark.along.map(number);
    return straight(turnedBy(mark, ends.length > 1 ? sub(ends[1], ends[0]) : ends[0]));
  };
  const known = new Map(); // many marks hang on one point
  const point = (mark, id) => {
    if (!known.has(id)) known.set(id, add(mark.origin, turnedBy(mark, number(id), shrunk)));
    return known.get(id);
  };
  const at = (mark, [id, x, y, other, share, dx = 0, dy = 0], u) => {
    const a = point(mark, id);
    if (other === true) return add(a, mul([x / shrunk, y / shrunk], u)); // a length of the mechanism
    return add(add(other ? step(a, share, sub(point(mark, other), a)) : a, mul([x, y], u)), [dx, dy]);
  };
  return { direction, point, at, shrunk, shifts };
}

function geometryOf(mark, placed) {
  const u = placed.direction(mark), shift = placed.shifts?.get(mark.lettering), points = mark.at.map((one) => (shift ? add(placed.at(mark, one, u), shift) : placed.at(mark, one, u)));
  if (mark.kind === "text") return { text: { ...mark, at: points[0], angle: 0 } };
  const round = { centre: points[0], radius: mark.reach ? size(sub(placed.point(mark, mark.reach[1]), placed.point(mark, mark.reach[0]))) : mark.radius };
  if (mark.kind === "circle") return { circle: round };
  if (mark.kind === "arc") { const t = Math.atan2(u[1], u[0]); return { arc: { ...round, from: mark.from + t, to: mark.to + t } }; }
  return { [mark.kind]: points, closed: mark.closed };
}

const defined = (g) => pointsOf(g).every((z) => Number.isFinite(z[0]) && Number.isFinite(z[1]));

function makeCard(live, pick = ask) {
  // What is said of the position that it is drawn for on the sheet does not hold in motion.
  const svg = svgNode("svg", { role: "group", tabindex: 0, "aria-label": live.view }), paths = live.marks.filter((m) => m.kind === "path");
  const marks = live.marks.filter((m) => m.kind !== "path").map((m) => (m.string ? { ...m, string: m.string.replace(`(${live.position})`, "") } : m));
  svg.innerHTML = `<g class="paths"></g><g class="marks">${marks.map((mark) => markSvg(mark.style, { [mark.kind]: mark })).join("")}</g><g class="over"></g>`;
  const position = say("position {label}", { label: live.position }), from = live.view.toLowerCase().indexOf(position.toLowerCase());
  const name = from < 0 ? live.view : live.view.slice(0, from).replace(/[\s,(]+$/, "");
  const caption = node("figcaption", {}, name), card = { live, name, svg, marks, paths, caption, shifts: new Map(), left: new Set(), letterings: letteringsOf(marks), hidden: marks.map(() => false), drawn: marks.map(() => ""), seen: false, figure: node("figure", { class: "card" }, caption, svg) };
  card.ends = [...new Map(marks.filter((m) => m.kind !== "text" && m.role !== "text").flatMap((m) => m.at.map(([id]) => [id, m])))].map(([id, m]) => [m, id]);
  const elements = [...svg.querySelectorAll(".marks > *")], sources = marks.map((mark) => live.sheet.marks.find((m) => m.id === mark.id));
  Object.assign(card, { elements, sources, over: svg.querySelector(".over") });
  byKeys(svg, card.elements, card.sources.map((one) => one && { ...one, position: "" }), (mark) => pick(mark.step));
  svg.addEventListener("click", (event) => {
    if (event.target.closest(".handle")) return;
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse()), placed = placer(parts(machine.phi), card.shrunk, card.shifts);
    const there = marks.map((mark, n) => ({ ...mark, step: card.sources[n]?.step, geometry: geometryOf(mark, placed) }));
    const shown = outlines(there).filter(({ n }) => defined(there[n].geometry) && !card.elements[n].matches("[hidden], .undrawn"));
    const n = nearest(shown, there, [x, -y], HIT / svg.getScreenCTM().a);
    if (n >= 0) pick(card.sources[n].step);
  });
  return card;
}

// Places that a card has room for: the ends of what is shown, and so much around a step that its guess may go there.
function heldBy(card, placed) {
  const ends = card.ends.filter(([, id]) => card.shows?.(id) ?? true).map(([mark, id]) => placed.point(mark, id)), { id, reach } = card.around ?? {};
  return id ? [...ends, ...[-1, 1].map((sign) => add(placed.point(card.marks[0], id), scale(sign * reach / card.marks[0].mu[0] / placed.shrunk, [1, 1])))] : ends;
}

// A polygon of forces or a group keeps to the middle of its card; a plan with a pole keeps its pole.
function centre(card, placed) {
  const [x0, y0, x1, y1] = extentOf(heldBy(card, placed)), head = card.room ? 6 : 0, [w, h] = add(roomOf(card), [30, 24 + head]); // for its caption
  if (x0 <= x1) lookAt(card.svg, [(x0 + x1 - w) / 2, -(y0 + y1 + h + head) / 2, w, h]);
}

function scaleWords(mu, plan) {
  const unit = unitOf(planOf(plan).unit);
  return `μ = ${digits(Number(mu.toPrecision(3)))} ${/[/·]/.test(unit) ? `(${unit})` : unit}/${UNITS().mm}`;
}

// Angles of the whole turn, world, rad.
const round = (many) => Array.from({ length: many }, (_, i) => record.motion.start + record.motion.sense * record.motion.period * i / many);

// A card's room for what moves, mm: its own, or the same for all of the stage.
const roomOf = (card) => card.room ?? [120, card === stage.cards[0] ? 145 : 66];

// By how much a view is to be smaller than on the sheet to have room in its card.
function shrinking(card, all) {
  const [x0, y0, x1, y1] = extentOf(all.flatMap((values) => heldBy(card, placer(values))));
  const [w, h] = roomOf(card);
  return x0 <= x1 ? Math.max((x1 - x0) / w, (y1 - y0) / h) : 0;
}

// What all views are in the course of a turn; taken anew when a given number is another, for the cards that are seen.
function takeTurn() {
  const many = Math.round(48 * Math.max(record.motion.period / (2 * Math.PI), 1));
  stage.turn = round(many).map((phi) => parts(phi));
  stage.fine = stage.cards.some((card) => card.paths.length) ? round(3 * many).map((phi) => parts(phi)) : [];
  for (const card of stage.cards) card.framed = false;
}

const COMMON = 1.5, REST_MS = 160;

// The scale of a card, that of its common angles; the room of everything that moves in it then, paths of points.
function frameCard(card, turn = stage.turn) {
  const sizes = turn.map((one) => shrinking(card, [one])), common = COMMON * [...sizes].sort((a, b) => a - b)[turn.length >> 1] || Infinity, usual = turn.filter((_, n) => sizes[n] <= common);
  card.framed = true;
  card.centred = card.room || card.live.plan !== "positions" && planOf(card.live.plan).pole === undefined;
  card.usual = card.shrunk = (card.centred ? Math.min(Math.max(...sizes), common) : shrinking(card, usual)) || 1;
  if (card.room) return;
  chooseLetters(card, turn);
  const moving = card.marks.filter((mark) => mark.role !== "construction" && mark.role !== "text"), placers = (card.centred ? [] : usual).map((values) => placer(values, card.shrunk));
  card.box = boundsOf(placers.flatMap((placed) => moving.map((mark) => ({ geometry: geometryOf(mark, placed) }))).filter(({ geometry }) => defined(geometry)));
  card.svg.querySelector(".paths").innerHTML = card.paths.map((path) => {
    const points = stage.fine.map((one) => placer(one, card.shrunk).point(path, path.of)), there = points.filter((z) => Number.isFinite(z[0]));
    const closed = there.length === points.length && record.motion.period > 6;
    return there.length ? `<path class="mark ${path.role}" ${look(path.style)} d="${polyPath(there, 0, closed)}"/>` : "";
  }).join("");
}

// At an angle at which a plan has no room in its common scale it is as small as it must be, which is told.
function keepInSight(card, values) {
  const [x0, y0, x1, y1] = card.box, scaled = (shrunk) => scaleWords(card.marks[0].mu[0] * shrunk, card.live.plan);
  card.off = x0 < x1 && heldBy(card, placer(values, card.usual)).some(([x, y]) => x < x0 - 1 || y < y0 - 1 || x > x1 + 1 || y > y1 + 1);
  card.shrunk = card.centred || card.off ? Math.max(card.usual, shrinking(card, [values])) : card.usual;
  const told = [`${card.name}, ${scaled(card.usual)}`, card.shrunk > card.usual ? `; ${say("here {mu}", { mu: scaled(card.shrunk) })}` : ""];
  if (String(card.told) !== String(told)) card.caption.replaceChildren(told[0], node("b", {}, told[1]));
  card.told = told;
  if (x0 < x1 && !card.off) lookAt(card.svg, [x0 - 11, -y1 - 9, x1 - x0 + 22, y1 - y0 + 18]);
}

// Draw the marks of a card; those that have no place are hidden.
function drawCard(card, values) {
  if (!card.framed) frameCard(card);
  if (!card.room) keepInSight(card, values);
  const placed = placer(values, card.shrunk, card.shifts);
  if (card.centred || card.off) centre(card, placed);
  if (card.room) placeLetters(card, placed, values);
  card.marks.forEach((mark, n) => {
    if (card.left.has(n)) return;
    const g = geometryOf(mark, placed), element = card.elements[n], there = defined(g);
    if (card.hidden[n] === there) { element.setAttribute("visibility", there ? "visible" : "hidden"); card.hidden[n] = !there; }
    if (!there) return;
    // A letter is moved, which costs less than setting it anew; what stays is not written again.
    const [name, drawn] = placeOf(g, 0);
    if (card.drawn[n] !== drawn) element.setAttribute(name, card.drawn[n] = drawn);
  });
}

function drawStage() {
  if ($("stage").hidden || !stage.cards.length) return;
  const values = parts(machine.phi), lost = notThere(values);
  for (const card of stage.cards) if (card.seen || card === stage.cards[0]) drawCard(card, values);
  for (const card of stage.cards) card.figure.classList.toggle("lost", Boolean(lost));
  if ($("lost")) Object.assign($("lost"), { hidden: !lost, innerHTML: lost ? lostWords(lost, values) : "" });
  const first = placer(values, stage.cards[0].shrunk);
  stage.grip(first);
  drawVanes(first, values);
  tellNow();
}

const VANE = 0.45; // length of a velocity on the mechanism beside that in its plan

// Velocities as arrows on the mechanism: a point B and the end b of its vector in the plan.
function drawVanes(placed, values) {
  const first = stage.cards[0], scaled = stage.cards.find((card) => card.live.plan === "velocities"), mark = first.marks[0];
  first.over.replaceChildren();
  if (!stage.vanes || !scaled) return;
  for (const [id, place] of Object.entries(record.motion.all.results)) {
    const point = id.startsWith("velocities/") && place[1] === 2 && pointOf(id);
    if (!point || stepOf(point).name.toLowerCase() !== stepOf(id).name) continue;
    const a = placed.point(mark, point), v = scale(VANE / scaled.marks[0].mu[0] / scaled.shrunk, taken(place, values));
    if (size(v) > 3) arrow(first, "vane", a, add(a, v));
  }
}

// The point of the mechanism that an end of a vector is the velocity, or acceleration, of.
function pointOf(id) {
  const name = stepOf(id).name, found = [name, name.replace(/(?<=.)\d+$/, "")].map((one) => `positions/${one[0].toUpperCase()}${one.slice(1)}`);
  return found.find((one) => one in record.motion.all.results && stepOf(one).kind === "point");
}

const stroke = (card, kind, points, closed = false) => card.over.append(svgNode("path", { class: kind, d: polyPath(points, 0, closed) }));

function arrow(card, kind, a, b) {
  const u = straight(sub(b, a));
  stroke(card, kind, [a, b]);
  if (Number.isFinite(u[0])) stroke(card, `${kind} solid`, [b, add(b, mul(u, [-3.4, 0.75])), add(b, mul(u, [-3.4, -0.75]))], true);
}

const LEAST = 23, SHAPE = 19 / 23; // width of a card at least, rem, and the height of its drawing beside that

// Cards as large as all of them have room on the screen with; where they have none they are scrolled.
function fitCards() {
  const place = $("stage"), rem = parseFloat(getComputedStyle(document.documentElement).fontSize), gap = 0.8 * rem, width = place.clientWidth - gap;
  const wide = Array.from({ length: Math.max(Math.floor(width / (LEAST * rem + gap)), 1) }, (_, n) => {
    const rows = Math.ceil((stage.cards.length + 1) / (n + 1)), room = (place.clientHeight - gap) / rows - 2 * rem - gap;
    return Math.min(width / (n + 1) - gap, room / SHAPE);
  });
  const best = Math.max(...wide), fits = best >= LEAST * rem;
  place.style.setProperty("--columns", fits ? `repeat(${wide.indexOf(best) + 1}, 1fr)` : "");
  place.style.setProperty("--high", fits ? `${best * SHAPE}px` : "");
  for (const card of stage.cards) card.svg.pixel = 0;
  drawStage();
}

function openStage() {
  if (!stage.cards.length) {
    stage.cards = liveViews().map((live) => makeCard(live));
    stage.cards[0]?.figure.classList.add("first");
    $("stage").append(...stage.cards.map((card) => card.figure));
    const watch = new IntersectionObserver((all) => {
      for (const { target, isIntersecting } of all) stage.cards.find((card) => card.figure === target).seen = isIntersecting;
      drawStage();
    }, { root: $("stage") });
    for (const card of stage.cards) {
      watch.observe(card.figure);
      card.figure.append(control("", "⤢", "this card large", () => { card.figure.classList.toggle("large"); card.figure.scrollIntoView(); fitCards(); }, { class: "enlarge" }));
    }
    new ResizeObserver(fitCards).observe($("stage"));
    const grip = makeGrip(stage.cards[0]), points = makePoints(stage.cards[0]);
    stage.grip = (placed) => { grip(placed); points(placed); };
  }
  takeTurn();
  drawStage();
}

function stageBar() {
  const vanes = node("button", { type: "button", "aria-pressed": String(stage.vanes), onclick: () => { stage.vanes = !stage.vanes; $("stage").classList.toggle("vanes", stage.vanes); vanes.setAttribute("aria-pressed", String(stage.vanes)); drawStage(); } }, say("velocities"));
  return [spinner("▶", "play"), angleSlider(), node("output", { class: "count angle" }), vanes,
    choice("speed", [12, 6, 3].map((s) => [s, say("a turn in {s} s", { s })]), stage.seconds, (s) => { stage.seconds = Number(s); spin(stage.playing); })];
}

const showRunning = (one, on) => { one.textContent = on ? "❚❚" : one.dataset.sign; one.setAttribute("aria-label", say(on ? "pause" : one.dataset.key)); };

function spin(on) {
  stage.playing = on;
  for (const one of document.querySelectorAll(".spin")) showRunning(one, on);
  cancelAnimationFrame(stage.moving);
  const from = machine.phi;
  if (on) animate(stage, stage.seconds * 1000, (t) => turn(from + senseOfTurn() * 2 * Math.PI * t), () => spin(true));
}
