// What is dragged, or moved by the arrow keys: the pin of the crank, a guess.

const FINGER = 22, GRIP = 9; // radius that a finger hits, and what is seen, pixels

// A grip over a card, its place told in mm of the card; `nudged` is given by how much it turns, degrees, and lengthens.
function makeHandle({ svg }, key, dragged, nudged) {
  const handle = svgNode("g", { class: "handle", tabindex: 0, role: "slider", "aria-label": say(key), "aria-valuemin": 0, "aria-valuemax": 360 });
  handle.append(svgNode("circle", { class: "touch" }), svgNode("circle", { class: "grip" }));
  svg.append(handle);
  handle.addEventListener("pointerdown", (event) => { spin(false); handle.setPointerCapture(event.pointerId); event.preventDefault(); });
  handle.addEventListener("pointermove", (event) => {
    if (!handle.hasPointerCapture(event.pointerId)) return;
    const card = svg.getBoundingClientRect(), within = (x, least, most) => Math.min(Math.max(x, least + GRIP), most - GRIP); // beyond it nobody takes hold of it again
    const p = new DOMPoint(within(event.clientX, card.left, card.right), within(event.clientY, card.top, card.bottom)).matrixTransform(svg.getScreenCTM().inverse());
    dragged([p.x, -p.y]);
  });
  handle.addEventListener("keydown", (event) => {
    const by = { ArrowRight: [-1, 0], ArrowLeft: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (by) { event.preventDefault(); event.stopPropagation(); nudged(...by); }
  });
  return handle;
}

// How long a pixel is in a drawing, mm, until it shows another part or has another size: to ask for it anew costs a layout.
const pixelOf = (svg) => (svg.pixel ||= 1 / svg.getScreenCTM().a);

function lookAt(svg, box) {
  if (svg.box === String(box)) return;
  Object.assign(svg, { box: String(box), pixel: 0 });
  svg.setAttribute("viewBox", svg.box);
}

function placeHandle(handle, [x, y], degrees, text = `${Math.round(mod(degrees, 360))}°`) {
  const pixel = pixelOf(handle.ownerSVGElement);
  handle.setAttribute("transform", `translate(${fixed(x)} ${fixed(-y)})`);
  [FINGER, handle.seen ?? GRIP].forEach((r, n) => handle.children[n].setAttribute("r", fixed(r * pixel)));
  setAll(handle, { "aria-valuenow": Math.round(mod(degrees, 360)), "aria-valuetext": text });
}

const degreesOf = (/** @type {any[]} */ [x, y]) => Math.atan2(y, x) * 180 / Math.PI;

// The pin of the crank of a card; gives what puts it to its place.
function makeGrip(card) {
  const mark = card?.live.plan === "positions" && card.marks.find((one) => one.role === "link"), [pivot, pin] = record.motion.crank;
  if (!mark) return () => {};
  const handle = makeHandle(card, "crank pin: drag it round", (p) => {
    const there = degreesOf(sub(p, placer(parts(machine.phi), card.shrunk).point(mark, pivot))), lead = degreesOf(sub(valueOf(pin, machine.phi), valueOf(pivot, machine.phi)));
    turn(machine.phi + (mod(there - lead + 180, 360) - 180) * Math.PI / 180);
  }, (by, more) => turn(machine.phi + (by + more) * Math.PI / 180));
  return (placed) => placeHandle(handle, placed.point(mark, pin), machine.phi * 180 / Math.PI);
}

// Fixed points of the mechanism are dragged as well, to a millimetre: the given number follows.
function makePoints(card) {
  const mark = card.live.plan === "positions" && card.marks.find((one) => one.role === "link");
  const given = (id) => id.startsWith("positions/") && stepOf(id).args.length === 1 && record.motion.givens.find((g) => g.places && Array.isArray(g.value) && g.name === stepOf(id).args[0].name);
  const handles = Object.keys(mark ? record.steps : {}).filter(given).map((id) => {
    const { name } = given(id), move = (by) => setGiven(name, add(machine.given[name], by).map((x) => Math.round(x * 1000) / 1000), true);
    const handle = makeHandle(card, "fixed points", (p) => {
      const [x, y] = mul(cis(-mark.turn), sub(p, placer(parts(machine.phi), card.shrunk).point(mark, id)));
      move(scale(card.shrunk, [x * mark.mu[0], (mark.mirror ? -1 : 1) * y * mark.mu[1]]));
    }, (turned, more) => { edited(machine.given); move([-turned / 1000, more / 1000]); });
    Object.assign(handle, { ariaLabel: `${say("fixed points")}: ${called(stepOf(id))}`, seen: 6 }); // its letter is near
    handle.addEventListener("gotpointercapture", () => { const before = machine.given; handle.onlostpointercapture = () => edited(before); });
    return [handle, id];
  });
  return (placed) => handles.forEach(([handle, id]) => placeHandle(handle, placed.point(mark, id), 0, shown(valueOf(id, machine.phi), "m")));
}
