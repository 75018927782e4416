// The crank pin as a grip: it is dragged round, the plans follow.

const grip = { element: null, mark: null };

function makeGrip() {
  const card = stage.cards[0];
  grip.mark = card?.marks.find((mark) => mark.role === "link");
  if (!grip.mark) return;
  grip.element = svgNode("circle", { class: "grip", r: 6, tabindex: 0, role: "slider", "aria-label": say("crank pin: drag it round"), "aria-valuemin": 0, "aria-valuemax": 360 });
  card.svg.setAttribute("role", "group"); // an image holds nothing that is taken hold of
  card.svg.querySelector(".over").append(grip.element);
  grip.element.addEventListener("pointerdown", (event) => { spin(false); grip.element.setPointerCapture(event.pointerId); event.preventDefault(); });
  grip.element.addEventListener("pointermove", (event) => {
    if (!grip.element.hasPointerCapture(event.pointerId)) return;
    const p = new DOMPoint(event.clientX, event.clientY).matrixTransform(card.svg.getScreenCTM().inverse());
    const centre = placer(parts(machine.phi), card.shrunk).point(grip.mark, record.motion.crank[0]), phi = Math.atan2(-p.y - centre[1], p.x - centre[0]);
    const lead = pinAngle() - machine.phi;
    turn(machine.phi + mod(phi - lead - machine.phi + Math.PI, 2 * Math.PI) - Math.PI);
  });
  grip.element.addEventListener("keydown", (event) => {
    const by = { ArrowRight: -1, ArrowUp: 1, ArrowLeft: 1, ArrowDown: -1 }[event.key];
    if (by) { event.preventDefault(); event.stopPropagation(); turn(machine.phi + by * Math.PI / 180); }
  });
}

function pinAngle() {
  const [pivot, pin] = record.motion.crank.map((id) => valueOf(id, machine.phi)), d = sub(pin, pivot);
  return Math.atan2(d[1], d[0]);
}

function placeGrip(placed) {
  if (!grip.element) return;
  const [x, y] = placed.point(grip.mark, record.motion.crank[1]);
  grip.element.setAttribute("cx", fixed(x));
  grip.element.setAttribute("cy", fixed(-y));
  grip.element.setAttribute("aria-valuenow", Math.round(mod(machine.phi * 180 / Math.PI, 360)));
}
