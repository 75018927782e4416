// "Where will it go?": before a vector is drawn the student drags his guess; what is wrong with it is told as the judge tells it.

const guess = { way: [0, 0], long: 0, verdict: null, tries: 0, right: 0, all: 0, group: null, handle: null };

const BY_EYE = { vector: 6, short: 10, line: 5, share: 0.1, mm: 4 }; // off by so much is right; a direction of less than SHORT mm is hard to meet
const SHORT = 25, NOTHING = 3, POINT = 8, TOWARDS = 14, DISTINCT = 20, SAME_SIZE = 0.07, OTHER_SIZE = 0.12, BESIDE_TIP = 1.7;

const between = (u, v) => Math.abs(degreesOf(mul(u, conj(v))));
const betweenLines = (u, v) => Math.min(between(u, v), 180 - between(u, v));
const across = (u) => mul(u, [0, 1]);

// What is asked before a stop of a kind is drawn: where a vector goes, a line passes, which way a link turns.
const ASKED = { lay: "vector", similar: "vector", line: "line", rate: "sense" };

// --- the judge ------------------------------------------------------------------------------------------------------------

// Millimetres of the card that a millimetre of the plan is, and a vector of the plan in these.
function planNow() {
  const card = lesson.cards[1], [, placed] = placersNow(), mark = card.marks[0], k = lessonScale() / mark.mu[0] / card.shrunk;
  return { k, placed, point: (id) => placed.point(mark, id), vector: ([a, b]) => scale(1 / k, sub(placed.point(mark, b), placed.point(mark, a))) };
}

// The link, guide or vector that a stop takes its direction from, as it lies in the plan.
function wayOfStop(stop, placed) {
  if (stop.direction) return stop.across ? mul([0, -1], directionNow(stop, placed)) : directionNow(stop, placed);
  return stop.along?.length === 2 ? placed.direction({ ...lesson.cards[1].marks[0], along: stop.along }) : [NaN, NaN];
}

// What a guess is: whether it is right, the answer to it, and what the answer names.
function judged(stop, asked) {
  const others = lesson.told.stops.filter((one) => one.name && one.name !== stop.name && one.kind !== "rate");
  if (ASKED[stop.kind] === "sense") {
    const right = !(asked.sense * here(stop.step) < 0);
    return { right, key: right ? "right sense" : "sense wrong", values: { vector: segmentName(...stop.ends).slice(1, -1), point: calledHere(stop.along[1]) } };
  }
  return ASKED[stop.kind] === "line" ? judgedLine(stop, asked.way, others) : judgedVector(stop, asked, others);
}

function otherLink(way, right, others, placed) {
  const meant = (u) => betweenLines(way, u) <= TOWARDS - 4 && betweenLines(u, right) > TOWARDS;
  return others.find((one) => meant(wayOfStop(one, placed)) || meant(across(wayOfStop(one, placed))));
}

function judgedLine(stop, way, others) {
  const { placed } = planNow(), right = directionNow(stop, placed), off = betweenLines(way, right), line = indexed(stop.name);
  if (off <= BY_EYE.line) return { right: true, key: "right line", values: { deg: off.toFixed(0) } };
  const crossing = others.find((one) => one.step === stop.step && one.direction && betweenLines(way, directionNow(one, placed)) <= TOWARDS);
  const turned = !crossing && betweenLines(way, across(right)) <= TOWARDS, other = crossing ?? otherLink(way, right, others, placed), unit = planOf(lesson.told.plan).unit;
  const key = !turned ? (other ? "other link" : "off") : unit === "N" ? (stop.across ? "force along" : "force across")
    : !stop.across ? "slide across" : unit === "m/s" ? "rotation along" : "tangent along";
  return { right: false, key, values: { line, other: other && indexed(other.name), deg: off.toFixed(0) } };
}

function judgedVector(stop, { way, long }, others) {
  const { placed, vector } = planNow(), exact = vector(stop.ends), whole = size(exact), off = whole > NOTHING ? between(way, exact) : 0, deg = off.toFixed(0);
  const found = (key, values = {}) => ({ right: key === "right", key, values: { deg, rate: stop.rate && calledHere(stop.rate), line: stop.name && indexed(stop.name), ...values } });
  if (whole <= NOTHING) return long < POINT ? found("right", { mm: Math.abs(long - whole).toFixed(0) }) : found("zero", { why: `${calledHere(stop.rate ?? stop.force ?? stop.step)} = 0${stop.twice ? ` / V<sub>${indexed(stop.name)}</sub> = 0` : ""}` });
  if (off <= (long < SHORT ? BY_EYE.short : BY_EYE.vector)) {
    const mm = Math.abs(long - whole);
    return mm <= Math.max(BY_EYE.mm, BY_EYE.share * whole) ? found("right", { mm: mm.toFixed(0) }) : found(...wrongSize(stop, long, whole, others));
  }
  const back = between(way, scale(-1, exact)) <= TOWARDS, other = otherLink(way, exact, others, placed);
  if (stop.force) return found(back ? "force against" : "off force");
  if (stop.kind === "similar") return found(...wrongPlace(stop, back));
  if (back) return stop.power === 2 ? found("normal out", { centre: calledHere(stop.along[0]) }) : found("against", { sense: say(here(stop.rate) < 0 ? "clockwise" : "counter-clockwise") });
  if (stop.power === 2) {
    const centre = calledHere(stop.along[0]), elsewhere = others.find((one) => one.power === 2 && between(way, scale(-1, wayOfStop(one, placed))) <= TOWARDS - 4);
    if (elsewhere && between(exact, scale(-1, wayOfStop(elsewhere, placed))) > DISTINCT) return found("wrong centre", { point: calledHere(stop.along[1]), centre, other: calledHere(elsewhere.along[0]) });
    const tangential = lesson.told.stops.some((one) => one.across && one.name === stop.name);
    if (betweenLines(way, across(exact)) <= TOWARDS) return found(tangential ? "normal across" : "nothing across", { centre });
  } else if (betweenLines(way, wayOfStop(stop, placed)) <= TOWARDS) return found(stop.twice ? "not turned" : "rotation along");
  return other ? found("other link", { other: indexed(other.name) }) : found("off");
}

// A vector of the right direction: which of the numbers that it is made of was another one.
function wrongSize(stop, long, whole, others) {
  const is = (mm) => Math.abs(long - mm) < SAME_SIZE * mm && Math.abs(mm - whole) > OTHER_SIZE * whole;
  if (stop.rate) {
    const rate = Math.abs(here(stop.rate)), length = apart(...stop.along), bare = rate * length / lessonScale();
    if (is(bare)) return [stop.twice ? "no two" : "not squared"];
    const turning = others.find((one) => one.rate && one.rate !== stop.rate && is(whole * (Math.abs(here(one.rate)) / rate) ** stop.power));
    if (turning) return ["other rate", { other: calledHere(turning.rate) }];
    const links = lesson.told.stops.flatMap((one) => (one.kind === "similar" ? [[one.names[2] + one.names[4], one.places[0], one.places[2]]] : one.along?.length === 2 && !one.twice ? [[one.name, ...one.along]] : []));
    const link = links.find(([, a, b]) => !stop.twice && is(whole * apart(a, b) / length));
    if (link) return ["other length", { other: indexed(link[0]) }];
  }
  if (stop.kind === "similar") {
    const [q, b, d] = stop.places, [, , nq, nb, nd] = stop.names.map(indexed);
    if (is(whole * (apart(q, b) / apart(q, d)) ** 2)) return ["ratio inverse", { ends: segmentName(...stop.ends).slice(1, -1), to: segmentName(stop.tail, stop.to).slice(1, -1), names: `${nq}${nd} : ${nq}${nb}` }];
  }
  const times = long > whole ? long / whole : whole / long;
  return [long > whole ? "too long" : "too short", { n: rounded(times, 2) }];
}

// A point that is not where similarity puts it.
function wrongPlace(stop, back) {
  const [q, b, d] = stop.places.map(here), [tail, to, ...names] = stop.names.map(indexed), ends = [tail, to, calledHere(stop.step)].join(", ");
  const straightOn = Math.abs(plainCross(sub(b, q), sub(d, q))) < 1e-9 * size(sub(b, q)) * size(sub(d, q));
  return straightOn ? [back ? "other side" : "not on ray", { names: names.join(", "), ends }] : ["similar figures"];
}

// --- what is asked --------------------------------------------------------------------------------------------------------

// Numbers that the size of a vector is made of.
const knownFor = (stop) => [...factorsOf(stop).filter(([, , unit]) => unit).map(([name, value, unit]) => `${name} = ${unit === UNITS().mm ? inMm(value * lessonScale()) : rounded(value, 4)} ${unit}`), ...(stop.kind === "similar" ? [] : [scaleWords(lessonScale(), lesson.told.plan)])];

function askGuess(stop) {
  const question = say(`ask ${stop.kind}`, { point: stop.tail && calledHere(stop.tail), head: calledHere(stop.step), rate: calledHere(stop.step) });
  const asked = node("p", { ".innerHTML": `${question} <span class="hint">${stop.ends && stop.kind !== "rate" ? knownFor(stop).join(", ") : ""}</span>` });
  if (lesson.mode !== "guess") return [node("p", { ".innerHTML": question.replace(/\?.*/u, "?") })]; // in a lecture the hall is asked
  const check = ASKED[stop.kind] === "sense" ? [[1, "counter-clockwise"], [-1, "clockwise"]].map(([sense, key]) => button(say(key), () => checkGuess(sense), { class: "chip" })) : [button(say("check"), () => checkGuess(), { class: "chip main" })];
  return [asked, node("div", { class: "chips" }, ...check, button(say("show it"), giveUp, { class: "chip" }), node("output", { id: "guessed", class: "count" }), node("span", { class: "count score", id: "score" }, score())), node("div", { id: "verdict", role: "status" }, ...verdict())];
}

const score = () => say("score", { r: guess.right, n: guess.all });

function verdict() {
  if (!guess.verdict) return [];
  const { right, key, values } = guess.verdict, sized = ["not squared", "no two", "other rate", "other length", "ratio inverse", "too long", "too short"].includes(key);
  return [node("p", { class: right ? "verdict good" : "verdict", role: right ? "status" : false, ".innerHTML": `${right ? `<span class="count score">${score()}</span>` : ""}${sized ? `${say("direction right")} ` : ""}${say(key, values)}` })];
}

function checkGuess(sense) {
  guess.verdict = judged(stopNow(), { way: guess.way, long: guess.long, sense });
  if (!guess.tries++) { guess.all += 1; guess.right += guess.verdict.right; }
  if (!guess.verdict.right) { $("verdict").replaceChildren(...verdict()); $("score").textContent = score(); return; }
  lesson.asks = false;
  showStop();
  $("lessonNext").focus();
}

// The stop is drawn without a right guess.
function giveUp() {
  if (lesson.mode === "guess" && !guess.tries) guess.all += 1;
  lesson.asks = false;
  forgetGuess();
  showStop();
}

const forgetGuess = () => Object.assign(guess, { way: cis(0.6), long: 0, verdict: null, tries: 0 });

// --- the guess on the plan ------------------------------------------------------------------------------------------------

// Room for any vector of the plan around the place where one is asked for; what is not drawn gets none, which would tell where it goes.
function roomToGuess() {
  if (ASKED[stopNow().kind] === "sense") return { shows: null, around: null };
  const longest = lesson.told.stops.filter((stop) => stop.ends).map((stop) => apart(...stop.ends)).filter(Number.isFinite);
  return { shows: (id) => !(lesson.order.get(id) >= lesson.at), around: { id: stopNow().tail, reach: Math.max(...longest, 0) } };
}

function makeGuess(card) {
  guess.group = svgNode("g", {});
  card.svg.append(guess.group);
  const set = (way, long) => {
    Object.assign(guess, { way, long });
    if (guess.verdict) { guess.verdict = null; $("verdict").replaceChildren(); }
    drawGuess();
  };
  guess.handle = makeHandle(card, "grip of the guess", (p) => {
    const { k, point } = planNow(), away = sub(p, point(stopNow().tail)), far = size(away);
    if (far > 0) set(straight(away), ASKED[stopNow().kind] === "line" ? guess.long : Math.max(far - besideTip(), 0) / k);
  }, (turned, more) => set(mul(guess.way, cis(turned * Math.PI / 180)), Math.max(guess.long + more, 0)));
}

// A finger does not cover the tip.
const besideTip = () => BESIDE_TIP * parseFloat(getComputedStyle(document.documentElement).fontSize) * pixelOf(guess.handle.ownerSVGElement);

function drawGuess() {
  const stop = stopNow(), there = lesson.asks && lesson.mode === "guess" && ASKED[stop.kind] !== "sense";
  guess.handle.toggleAttribute("hidden", !there);
  guess.group.replaceChildren();
  if (!there) return;
  const { k, point } = planNow(), tail = point(stop.tail);
  guess.long ||= guess.tries ? 0 : roomToGuess().around.reach / lessonScale() / 3;
  const tip = step(tail, guess.long * k, guess.way), line = ASKED[stop.kind] === "line", over = { over: guess.group };
  if (line) stroke(over, "guess", [step(tail, -400, guess.way), step(tail, 400, guess.way)]); else arrow(over, "guess", tail, tip);
  const degrees = mod(degreesOf(guess.way), line ? 180 : 360), told = line ? say("your line", { deg: degrees.toFixed(0) }) : say("your vector", { mm: guess.long.toFixed(0) });
  placeHandle(guess.handle, step(tip, besideTip(), guess.way), degrees, told);
  $("guessed").textContent = told;
}
