// Markers that run along the diagrams of a sheet with the crank, or with the cam.

const pointers = { all: [], dots: [], legs: [] };

const senseOfTurn = () => record.motion?.sense ?? 1;
const wholeTurn = () => record.motion?.period ?? 2 * Math.PI;
const angleTurned = () => mod(senseOfTurn() * (machine.phi - (record.motion?.start ?? 0)), wholeTurn());
const turnTo = (turned) => turn((record.motion?.start ?? 0) + senseOfTurn() * turned);

// What each marker of a sheet needs: the points of its curve and how far along each is passed.
function takeMarkers(sheet) {
  pointers.all = (sheet.markers ?? []).map((marker) => {
    const g = sheet.marks.find((mark) => mark.id === marker.mark).geometry, points = g.polyline ?? g.line;
    if (marker.passes) return { ...marker, points, at: marker.passes.map(([angle]) => angle) };
    const heights = points.map((z) => plainCross(marker.along, sub(z, marker.from))), low = Math.min(...heights), high = Math.max(...heights);
    const base = low > high - low || -high > high - low ? low : 0; // of a graph whose axis is far below it
    return { ...marker, base, points, at: points.map((z) => plainDot(sub(z, marker.from), marker.along) * marker.mu) };
  });
}

function drawMarkers(sheet) {
  takeMarkers(sheet);
  const group = svgNode("g", { id: "pointers" });
  $("sheet").append(group);
  [pointers.legs, pointers.dots] = ["line", "circle"].map((kind) => pointers.all.map((marker) => {
    const element = svgNode(kind, { class: kind === "line" ? "pointer" : "pointer dot", r: 1.4, visibility: "hidden" });
    if (kind === "circle" || !marker.passes) group.append(element);
    return element;
  }));
  $("turner").hidden = !pointers.all.length;
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
  pointers.all.forEach((marker, n) => {
    const angle = marker.of === "cam" ? mod(turned, 2 * Math.PI) : turned, z = placeOnCurve(marker, angle);
    for (const element of [pointers.dots[n], pointers.legs[n]]) element.setAttribute("visibility", z ? "visible" : "hidden");
    if (!z) return;
    pointers.dots[n].setAttribute("cx", fixed(z[0]));
    pointers.dots[n].setAttribute("cy", fixed(leaf.height - z[1]));
    if (marker.passes) return;
    const foot = add(marker.from, mul([angle / marker.mu, marker.base], marker.along));
    for (const [key, value] of [["x1", foot[0]], ["y1", leaf.height - foot[1]], ["x2", z[0]], ["y2", leaf.height - z[1]]]) {
      pointers.legs[n].setAttribute(key, fixed(value));
    }
  });
  if (!$("turned")) return;
  $("turned").value = turned * 180 / Math.PI;
  $("turned").setAttribute("aria-valuetext", `${Math.round(turned * 180 / Math.PI)}°`);
}

function makeTurner() {
  const slider = node("input", { type: "range", id: "turned", min: 0, max: wholeTurn() * 180 / Math.PI, step: 0.1, "aria-label": say("crank angle"),
    oninput: (event) => { spin(false); turnTo(Number(event.target.value) * Math.PI / 180); } });
  $("turner").append(node("button", { type: "button", class: "play spin", "aria-label": say("turn the crank on the sheet"), title: say("turn the crank on the sheet"),
    onclick: () => spin(!stage.playing) }, "⟳"), slider);
}
