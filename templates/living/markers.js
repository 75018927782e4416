// Markers that run along the diagrams of a sheet with the crank, or with the cam.

let pointers = [];

const senseOfTurn = () => record.motion?.sense ?? 1;
const wholeTurn = () => record.motion?.period ?? 2 * Math.PI;
const angleTurned = () => mod(senseOfTurn() * (machine.phi - (record.motion?.start ?? 0)), wholeTurn());
const turnTo = (turned) => turn((record.motion?.start ?? 0) + senseOfTurn() * turned);

// What each marker of a sheet needs: the points of its curve and how far along each is passed.
function markersOf(sheet) {
  return (sheet.markers ?? []).map((marker) => {
    const g = sheet.marks.find((mark) => mark.id === marker.mark).geometry, points = g.polyline ?? g.line;
    if (marker.passes) return { ...marker, points, at: marker.passes.map(([angle]) => angle) };
    const heights = points.map((z) => plainCross(marker.along, sub(z, marker.from))), low = Math.min(...heights), high = Math.max(...heights);
    const base = low > high - low || -high > high - low ? low : 0; // of a graph whose axis is far below it
    return { ...marker, base, points, at: points.map((z) => plainDot(sub(z, marker.from), marker.along) * marker.mu) };
  });
}

function drawMarkers(sheet) {
  pointers = markersOf(sheet);
  $("sheet").insertAdjacentHTML("beforeend", `<g id="pointers">${'<g><line class="pointer"/><circle class="pointer dot" r="1.4"/></g>'.repeat(pointers.length)}</g>`);
  $("turner").hidden = !pointers.length;
  drawPointers();
}

// Place on a curve at an angle; null where the curve is not.
function placeOnCurve({ points, at, passes }, angle) {
  if (!(angle >= at[0] - 1e-6 && angle <= at.at(-1) + 1e-6)) return null;
  const i = clip(upTo(at, angle) - 1, 0, at.length - 2), share = clip((angle - at[i]) / (at[i + 1] - at[i] || 1), 0, 1);
  if (!passes) return step(points[i], share, sub(points[i + 1], points[i]));
  const exact = passes[i][1] + share * (passes[i + 1][1] - passes[i][1]), n = Math.min(Math.floor(exact), points.length - 2);
  return step(points[n], exact - n, sub(points[n + 1], points[n]));
}

function drawPointers() {
  const turned = angleTurned();
  pointers.forEach((marker, n) => {
    const angle = marker.of === "cam" ? mod(turned, 2 * Math.PI) : turned, z = placeOnCurve(marker, angle), element = $("pointers").children[n], [leg, dot] = element.children;
    element.toggleAttribute("hidden", !z);
    if (!z) return;
    const [x, y] = [fixed(z[0]), fixed(leaf.height - z[1])], foot = marker.passes ? z : add(marker.from, mul([angle / marker.mu, marker.base], marker.along));
    setAll(dot, { cx: x, cy: y });
    setAll(leg, { x1: fixed(foot[0]), y1: fixed(leaf.height - foot[1]), x2: x, y2: y });
  });
}

// Sliders of the crank angle, and where it is told beside them.
const angleSlider = () => range("", "crank angle", { class: "scrub angle", min: 0, max: wholeTurn() * 180 / Math.PI, step: 0.1 }, (degrees) => { spin(false); turnTo(degrees * Math.PI / 180); });

function showAngle() {
  for (const one of /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll(".angle"))) {
    if (one.matches("output")) { one.textContent = momentOf(machine.phi); continue; }
    if (machine.reach?.given !== machine.given) one.style.removeProperty("--reach"); // of other numbers
    Object.assign(one, { value: angleTurned() * 180 / Math.PI, ariaValueText: `${Math.round(angleTurned() * 180 / Math.PI)}°` });
  }
}

const spinner = (sign, key) => control("", sign, key, () => spin(!stage.playing), { class: "play spin", "data-sign": sign, "data-key": key });
