// The linkage in motion: its views drawn for any crank angle from what their marks hang on.

const stage = { cards: [], playing: false, seconds: 6, last: 0, lost: null, vanes: false };

// One view of each plan, at the highlighted position where there is one.
function liveViews() {
  const all = record.sheets.flatMap((sheet) => (sheet.live ?? []).map((live) => ({ ...live, sheet }))), main = all.find((v) => v.plan === "positions");
  const kept = new Map();
  for (const one of all) {
    const key = one.plan.startsWith("positions") || one.marks.some((m) => m.kind !== "text" && m.along.length === 1 && m.role === "vector") ? one.view : one.plan;
    const known = kept.get(key);
    if (!known || (known.position !== main?.position && one.position === main?.position)) kept.set(key, one);
  }
  const first = (v) => (v === main ? 0 : v === kept.get("velocities") ? 1 : v === kept.get("accelerations") ? 2 : 3);
  return [...kept.values()].sort((a, b) => first(a) - first(b));
}

// Anchors of a mark and its direction on the sheet, mm, y upwards; distances are so many times smaller than there.
function placer(values, shrunk = 1) {
  const number = (id) => taken(record.motion.all.results[id], values);
  const turnedBy = (mark, [x, y]) => {
    const w = [x / mark.mu[0] / shrunk, (mark.mirror ? -1 : 1) * y / mark.mu[1] / shrunk];
    return mark.turn ? mul(cis(mark.turn), w) : w;
  };
  const direction = (mark) => {
    if (!mark.along.length) return [1, 0];
    const ends = mark.along.map(number);
    return straight(turnedBy(mark, ends.length > 1 ? sub(ends[1], ends[0]) : ends[0]));
  };
  const known = new Map(); // many marks hang on one point
  const point = (mark, id) => {
    if (!known.has(id)) known.set(id, add(mark.origin, turnedBy(mark, number(id))));
    return known.get(id);
  };
  const place = (mark, id, other, share) => {
    const a = point(mark, id);
    return other ? step(a, share, sub(point(mark, other), a)) : a;
  };
  const at = (mark, [id, x, y, other, share, dx = 0, dy = 0], u) => (other === true // a length of the mechanism
    ? add(point(mark, id), mul([x / shrunk, y / shrunk], u)) : add(add(place(mark, id, other, share), mul([x, y], u)), [dx, dy]));
  return { direction, point, at };
}

function geometryOf(mark, placed) {
  const u = placed.direction(mark), points = mark.at.map((one) => placed.at(mark, one, u));
  if (mark.kind === "text") return { text: { ...mark, at: points[0], angle: 0 } };
  const round = { centre: points[0], radius: mark.reach ? size(sub(placed.point(mark, mark.reach[1]), placed.point(mark, mark.reach[0]))) : mark.radius };
  if (mark.kind === "circle") return { circle: round };
  if (mark.kind === "arc") { const t = Math.atan2(u[1], u[0]); return { arc: { ...round, from: mark.from + t, to: mark.to + t } }; }
  return { [mark.kind]: points, closed: mark.closed };
}

const defined = (g) => pointsOf(g).every((z) => Number.isFinite(z[0]) && Number.isFinite(z[1]));

function makeCard(live, pick = ask) {
  const svg = svgNode("svg", { role: "img", "aria-label": live.view }), marks = live.marks.filter((m) => m.kind !== "path"), paths = live.marks.filter((m) => m.kind === "path");
  svg.innerHTML = '<g class="paths"></g><g class="marks"></g><g class="over"></g>';
  // What is said of the position that it is drawn for on the sheet does not hold in motion.
  const position = say("position {label}", { label: live.position }), from = live.view.toLowerCase().indexOf(position.toLowerCase());
  const name = from < 0 ? live.view : live.view.slice(0, from).replace(/[\s,(]+$/, "");
  const caption = node("figcaption", {}, name), card = { live, name, svg, marks, paths, caption, hidden: marks.map(() => false), drawn: marks.map(() => ""), seen: false, figure: node("figure", { class: "card" }, caption, svg) };
  card.ends = [...new Map(marks.filter((m) => m.kind !== "text" && m.role !== "text").flatMap((m) => m.at.map(([id]) => [id, m])))].map(([id, m]) => [m, id]);
  card.elements = marks.map((mark) => {
    const element = svgNode(mark.kind === "text" ? "text" : "path", { class: mark.kind === "fill" ? "mark fill" : "mark" });
    if (mark.kind === "text") { element.setAttribute("font-size", mark.height / CAPITAL); element.textContent = mark.string.replace(`(${live.position})`, ""); }
    else if (mark.kind !== "fill") { const s = record.styles[mark.style]; element.setAttribute("stroke-width", s.width); if (s.pattern.length) element.setAttribute("stroke-dasharray", s.pattern.join(" ")); }
    element.addEventListener("click", () => { const id = live.sheet.marks.find((m) => m.id === mark.id)?.step; if (id) pick(id); });
    svg.querySelector(".marks").append(element);
    return element;
  });
  return card;
}

// A polygon of forces or a group keeps to the middle of its card; a plan with a pole keeps its pole.
function centre(card, placed) {
  const [x0, y0, x1, y1] = extentOf(card.ends.map(([mark, id]) => placed.point(mark, id))), [w, h] = add(roomOf(card), [30, 24]);
  if (x0 <= x1) card.svg.setAttribute("viewBox", `${(x0 + x1 - w) / 2} ${-(y0 + y1 + h) / 2} ${w} ${h}`);
}

// What a millimetre of the card stands for, at its size of the sheet.
function tellScale(card) {
  const plan = planOf(card.live.plan), mu = card.marks[0].mu[0] * card.shrunk, unit = plan.unit;
  const written = UNITS()[unit] ?? unit, text = `${card.name}, μ = ${digits(Number(mu.toPrecision(3)))} ${/[/·]/.test(written) ? `(${written})` : written}/${UNITS().mm ?? "mm"}`;
  if (card.told !== text) card.caption.textContent = card.told = text;
}

// Angles of the whole turn, world, rad.
const round = (many) => Array.from({ length: many }, (_, i) => record.motion.start + record.motion.sense * record.motion.period * i / many);

// A card's room for what moves, mm: its own, or the same for all of the stage.
const roomOf = (card) => card.room ?? [120, card === stage.cards[0] ? 145 : 66];

// By how much a view is to be smaller than on the sheet to have room in its card.
function shrinking(card, all) {
  const [x0, y0, x1, y1] = extentOf(all.flatMap((values) => {
    const placed = placer(values);
    return card.ends.map(([mark, id]) => placed.point(mark, id));
  }));
  const [w, h] = roomOf(card);
  return x0 <= x1 ? Math.max((x1 - x0) / w, (y1 - y0) / h) : 0;
}

// A polygon or a group of links keeps to the middle of its card, a plan with a pole keeps its pole.
const isCentred = (card) => card.room || card.live.plan !== "positions" && planOf(card.live.plan).pole === undefined;

// What all views are in the course of a turn; taken anew when a given number is another, for the cards that are seen.
function takeTurn() {
  const many = Math.round(48 * Math.max(record.motion.period / (2 * Math.PI), 1));
  stage.turn = round(many).map((phi) => parts(phi));
  stage.fine = stage.cards.some((card) => card.paths.length) ? round(3 * many).map((phi) => parts(phi)) : [];
  for (const card of stage.cards) card.framed = false;
}

// Letters of a plan that would lie on others for much of the turn are left out, each with all of its signs.
function chooseLetters(card, turn) {
  const letterings = new Map();
  card.marks.forEach((mark, n) => {
    if (mark.role !== "text" || !mark.at) return;
    if (!letterings.has(mark.lettering)) letterings.set(mark.lettering, []);
    letterings.get(mark.lettering).push(n);
  });
  const many = Math.min(turn.length, MOMENTS), moments = Array.from({ length: many }, (_, i) => placer(turn[Math.floor(i * turn.length / many)], card.shrunk));
  const all = [...letterings.values()].map((signs) => ({ signs, boxes: moments.map((placed) => extentOf(signs.flatMap((n) => {
    const mark = card.marks[n], g = geometryOf(mark, placed);
    if (g.text) { const [x, y] = g.text.at; return [[x, y], [x + 0.55 * mark.height * mark.string.length, y + mark.height]]; }
    return pointsOf(g);
  }))) }));
  const apart = (a, b) => a[0] > b[2] || b[0] > a[2] || a[1] > b[3] || b[1] > a[3], kept = [];
  card.left = new Set();
  for (const one of all.sort((a, b) => a.signs.length - b.signs.length)) { // short ones are those of points
    const covered = one.boxes.filter((box, i) => kept.some((other) => !apart(box, other.boxes[i]))).length;
    if (covered > CROWDED * many) one.signs.forEach((n) => card.left.add(n)); else kept.push(one);
  }
  card.elements.forEach((element, n) => element.toggleAttribute("hidden", card.left.has(n)));
}

const MOMENTS = 24, CROWDED = 0.2;

// The scale of a card, the same for the whole turn; the room of everything that moves in it, paths of points.
function frameCard(card, turn = stage.turn) {
  card.framed = true;
  card.centred = isCentred(card);
  card.shrunk = (card.centred ? Math.max(...turn.map((one) => shrinking(card, [one]))) : shrinking(card, turn)) || 1;
  chooseLetters(card, turn);
  if (card.room) return;
  const moving = card.marks.filter((mark) => mark.role !== "construction" && mark.role !== "text"), placers = (card.centred ? [] : turn).map((values) => placer(values, card.shrunk));
  const [x0, y0, x1, y1] = boundsOf(placers.flatMap((placed) => moving.map((mark) => ({ geometry: geometryOf(mark, placed) }))).filter(({ geometry }) => defined(geometry)));
  if (x0 < x1) card.svg.setAttribute("viewBox", `${x0 - 11} ${-y1 - 9} ${x1 - x0 + 22} ${y1 - y0 + 18}`);
  card.svg.querySelector(".paths").innerHTML = card.paths.map((path) => {
    const points = stage.fine.map((one) => placer(one, card.shrunk).point(path, path.of)), there = points.filter((z) => Number.isFinite(z[0]));
    const closed = there.length === points.length && record.motion.period > 6;
    return there.length ? `<path class="mark" ${look(path.style)} d="${polyPath(there, 0, closed)}"/>` : "";
  }).join("");
}

// Draw the marks of a card; those that have no place are hidden.
function drawCard(card, values) {
  if (!card.framed) frameCard(card);
  const placed = placer(values, card.shrunk);
  if (!card.room) tellScale(card);
  if (card.centred) centre(card, placed);
  card.marks.forEach((mark, n) => {
    if (card.left.has(n)) return;
    const g = geometryOf(mark, placed), element = card.elements[n], there = defined(g);
    if (card.hidden[n] === there) { element.setAttribute("visibility", there ? "visible" : "hidden"); card.hidden[n] = !there; }
    if (!there) return;
    // A letter is moved, which costs less than setting it anew; what stays is not written again.
    const drawn = mark.kind === "text" ? `translate(${fixed(g.text.at[0])} ${fixed(-g.text.at[1])})` : pathOf(g, 0);
    if (card.drawn[n] !== drawn) element.setAttribute(mark.kind === "text" ? "transform" : "d", card.drawn[n] = drawn);
  });
}

function drawStage() {
  if ($("stage").hidden || !stage.cards.length) return;
  const values = parts(machine.phi), lost = notThere(values);
  for (const card of stage.cards) if (card.seen || card === stage.cards[0]) drawCard(card, values);
  if (stage.lost !== lost) for (const card of stage.cards) card.figure.classList.toggle("lost", Boolean(lost));
  stage.lost = lost;
  tellLost(lost, values);
  const first = placer(values, stage.cards[0].shrunk);
  placeGrip(first);
  drawVanes(first, values);
  $("angle").value = mod(record.motion.sense * (machine.phi - record.motion.start), record.motion.period) * 180 / Math.PI;
  $("degrees").textContent = momentOf(machine.phi);
  tellNow();
}

const VANE = 0.45; // length of a velocity on the mechanism beside that in its plan

// Velocities as arrows on the mechanism: a point B and the end b of its vector in the plan.
function drawVanes(placed, values) {
  const first = stage.cards[0], over = first.svg.querySelector(".over");
  if (stage.vanes || stage.vaned) for (const old of over.querySelectorAll(".vane, .vanehead")) old.remove();
  stage.vaned = stage.vanes;
  const scaled = stage.cards.find((card) => card.live.plan === "velocities");
  if (!stage.vanes || !scaled) return;
  const mark = first.marks[0], mu = scaled.marks[0].mu[0];
  for (const id of Object.keys(record.motion.all.results)) {
    if (!id.startsWith("velocities/") || record.motion.all.results[id][1] !== 2) continue;
    const point = `positions/${id.slice(11, 12).toUpperCase()}${id.slice(12)}`;
    if (!(point in record.motion.all.results) || !["point", "vector"].includes(stepOf(id).kind)) continue;
    const a = placed.point(mark, point), v = scale(VANE / mu / scaled.shrunk, taken(record.motion.all.results[id], values)), long = size(v), b = add(a, v), u = straight(v);
    if (!(long > 3)) continue;
    over.append(svgNode("path", { class: "vane", d: polyPath([a, b], 0) }),
      svgNode("path", { class: "vanehead", d: polyPath([b, add(b, mul(u, [-4, 1])), add(b, mul(u, [-4, -1]))], 0, true) }));
  }
}

const LEAST = 23, SHAPE = 19 / 23; // width of a card at least, rem, and the height of its drawing beside that

// Cards as large as all of them have room on the screen with; where they have none they are scrolled.
function fitCards() {
  const place = $("stage"), rem = parseFloat(getComputedStyle(document.documentElement).fontSize), gap = 0.8 * rem, above = 2 * rem;
  const width = place.clientWidth - gap, most = Math.max(Math.floor(width / (LEAST * rem + gap)), 1);
  let best = null;
  for (let columns = 1; columns <= most; columns++) {
    const rows = Math.ceil((stage.cards.length + 1) / columns), room = (place.clientHeight - gap) / rows - above - gap;
    const wide = Math.min(width / columns - gap, room / SHAPE);
    if (wide >= LEAST * rem && !(best?.wide >= wide)) best = { columns, wide };
  }
  for (const [name, value] of [["--columns", `repeat(${best?.columns}, 1fr)`], ["--high", `${best?.wide * SHAPE}px`]]) {
    if (best) place.style.setProperty(name, value); else place.style.removeProperty(name);
  }
}

function openStage() {
  if (!stage.cards.length) {
    stage.cards = liveViews().map(makeCard);
    stage.cards[0]?.figure.classList.add("first");
    $("stage").append(...stage.cards.map((card) => card.figure));
    const watch = new IntersectionObserver((all) => {
      for (const { target, isIntersecting } of all) stage.cards.find((card) => card.figure === target).seen = isIntersecting;
      drawStage();
    }, { root: $("stage") });
    for (const card of stage.cards) watch.observe(card.figure);
    new ResizeObserver(fitCards).observe($("stage"));
    addEventListener("beforeprint", () => { if (!$("stage").hidden) for (const card of stage.cards) drawCard(card, parts(machine.phi)); });
    makeGrip();
  }
  takeTurn();
  drawStage();
}

function stageBar() {
  const degrees = record.motion.period * 180 / Math.PI;
  return [
    node("button", { type: "button", class: "play spin", id: "spin", "aria-label": say("play"), onclick: () => spin(!stage.playing) }, "▶"),
    node("input", { type: "range", class: "scrub", id: "angle", min: 0, max: degrees, step: 0.1, "aria-label": say("crank angle"),
      oninput: (event) => { spin(false); turn(record.motion.start + record.motion.sense * Number(event.target.value) * Math.PI / 180); } }),
    node("output", { class: "count", id: "degrees" }),
    node("button", { type: "button", "aria-pressed": "false", onclick: (event) => {
      stage.vanes = !stage.vanes;
      event.target.setAttribute("aria-pressed", String(stage.vanes));
      drawStage();
    } }, say("velocities")),
    node("select", { "aria-label": say("speed"), onchange: (event) => { stage.seconds = Number(event.target.value); } },
      ...[12, 6, 3].map((s) => node("option", { value: s, selected: s === 6 }, say("a turn in {s} s", { s })))),
  ];
}

function spin(on) {
  stage.playing = on;
  for (const button of document.querySelectorAll(".spin")) {
    button.textContent = on ? "❚❚" : button.id ? "▶" : "⟳";
    button.setAttribute("aria-label", say(on ? "pause" : button.id ? "play" : "turn the crank on the sheet"));
  }
  if (!on) return;
  stage.last = performance.now();
  const frame = (now) => {
    if (!stage.playing) return;
    turn(machine.phi + senseOfTurn() * 2 * Math.PI * (now - stage.last) / 1000 / stage.seconds);
    stage.last = now;
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
}
