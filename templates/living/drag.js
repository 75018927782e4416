// What is dragged, or moved by the arrow keys: the pin of the crank, a guess.

const FINGER = 22, GRIP = 9; // radius that a finger hits, and what is seen, pixels

// A grip over a card, its place told in mm of the card; `nudged` is given by how much it turns, degrees, and lengthens.
function makeHandle({ svg }, key, dragged, nudged) {
  const handle = svgNode("g", { class: "handle", tabindex: 0, role: "slider", "aria-label": say(key), "aria-valuemin": 0, "aria-valuemax": 360 });
  handle.append(svgNode("circle", { class: "touch" }), svgNode("circle", { class: "grip" }));
  svg.setAttribute("role", "group"); // an image holds nothing that is taken hold of
  svg.append(handle);
  handle.addEventListener("pointerdown", (event) => { spin(false); handle.setPointerCapture(event.pointerId); event.preventDefault(); });
  handle.addEventListener("pointermove", (event) => {
    if (!handle.hasPointerCapture(event.pointerId)) return;
    const p = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    dragged([p.x, -p.y]);
  });
  handle.addEventListener("keydown", (event) => {
    const by = { ArrowRight: [-1, 0], ArrowLeft: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (by) { event.preventDefault(); event.stopPropagation(); nudged(...by); }
  });
  return handle;
}

function placeHandle(handle, [x, y], degrees, text = `${Math.round(degrees)}°`) {
  const pixel = 1 / handle.getScreenCTM().a;
  handle.setAttribute("transform", `translate(${fixed(x)} ${fixed(-y)})`);
  [FINGER, GRIP].forEach((r, n) => handle.children[n].setAttribute("r", fixed(r * pixel)));
  setAll(handle, { "aria-valuenow": Math.round(mod(degrees, 360)), "aria-valuetext": text });
}

const degreesOf = ([x, y]) => Math.atan2(y, x) * 180 / Math.PI;

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
