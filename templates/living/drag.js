// The crank pin as a grip: it is dragged round, the plans follow.

const grip = { element: null, mark: null, pivot: "", pin: "" };

function makeGrip() {
  const card = stage.cards[0], m = record.motion, ends = card?.marks.find((mark) => mark.role === "link" && mark.along.length === 2 && crankEnds(mark.along));
  if (!ends) return;
  [grip.pivot, grip.pin] = crankEnds(ends.along);
  grip.mark = ends;
  grip.element = svgNode("circle", { class: "grip", r: 6, tabindex: 0, role: "slider", "aria-label": say("crank pin: drag it round"), "aria-valuemin": 0, "aria-valuemax": 360 });
  card.svg.querySelector(".over").append(grip.element);
  grip.element.addEventListener("pointerdown", (event) => { spin(false); grip.element.setPointerCapture(event.pointerId); event.preventDefault(); });
  grip.element.addEventListener("pointermove", (event) => {
    if (!grip.element.hasPointerCapture(event.pointerId)) return;
    const p = new DOMPoint(event.clientX, event.clientY).matrixTransform(card.svg.getScreenCTM().inverse());
    const centre = placer(parts(machine.phi), card.shrunk).point(grip.mark, grip.pivot), phi = Math.atan2(-p.y - centre[1], p.x - centre[0]);
    const lead = pinAngle() - machine.phi;
    turn(machine.phi + mod(phi - lead - machine.phi + Math.PI, 2 * Math.PI) - Math.PI);
  });
  grip.element.addEventListener("keydown", (event) => {
    const by = { ArrowRight: -1, ArrowUp: 1, ArrowLeft: 1, ArrowDown: -1 }[event.key];
    if (by) { event.preventDefault(); event.stopPropagation(); turn(machine.phi + by * Math.PI / 180); }
  });
  void m;
}

// The ends of a link when one is the crank's pivot: the one that never moves, and the other's distance from it is that of the pin.
function crankEnds([a, b]) {
  const where = (id, phi) => valuesAt(phi)[id], s = record.motion.start;
  const moves = (id) => size(sub(where(id, s), where(id, s + 1))) > 1e-12;
  const turns = (p, q) => {
    const angle = (phi) => { const d = sub(where(q, phi), where(p, phi)); return Math.atan2(d[1], d[0]); };
    return Math.abs(mod(angle(s + 0.4) - angle(s) - 0.4 + 1, 2 * Math.PI) - 1) < 1e-9;
  };
  if (!moves(a) && moves(b) && turns(a, b)) return [a, b];
  return !moves(b) && moves(a) && turns(b, a) ? [b, a] : null;
}

function pinAngle() {
  const values = valuesAt(machine.phi), d = sub(values[grip.pin], values[grip.pivot]);
  return Math.atan2(d[1], d[0]);
}

function placeGrip(placed) {
  if (!grip.element) return;
  const [x, y] = placed.point(grip.mark, grip.pin);
  grip.element.setAttribute("cx", fixed(x));
  grip.element.setAttribute("cy", fixed(-y));
  grip.element.setAttribute("aria-valuenow", Math.round(mod(machine.phi * 180 / Math.PI, 360)));
}
