// Ways of assembly of a triangle on three legs, followed round the turn as mechanism/groups/three_legs.py does.

const NODES = 720, FINEST = 7, SHRINKING = 0.25, SCAN = 1440;
const SURELY_NEAR = Math.PI / 4, ALIKE_POSES = Math.PI / 18000;

// First corners of triangles of a direction whose legs i and j hold: two, or one.
function placesOn(u, i, j, legs) {
  const [[roundOne, p, v, r], [roundTwo, q, w, s]] = [i, j].map((n) => {
    const [does, at, d, length, corner] = legs.slice(5 * n, 5 * n + 5);
    return [does === CIRCLE, sub(at, mul(corner, u)), does === SLOT ? mul(u, cis(length)) : d, length];
  });
  if (roundOne && roundTwo) {
    const e = sub(q, p), d = size(e), along = (d * d + (r - s) * (r + s)) / (2 * d), across = Math.sqrt((r - along) * (r + along));
    return [1, -1].map((side) => add(p, mul([along / d, side * across / d], e)));
  }
  if (roundOne || roundTwo) {
    const [centre, radius, through, way] = roundOne ? [p, r, q, w] : [q, s, p, v];
    const foot = step(through, plainDot(way, sub(centre, through)), way), half = Math.sqrt(radius ** 2 - size(sub(foot, centre)) ** 2);
    return [1, -1].map((side) => step(foot, side * half, way));
  }
  return [step(p, plainCross(sub(q, p), w) / plainCross(v, w), v)];
}

// Every way of assembly on some legs, by the direction's angle.
function modesOn(legs) {
  const whole = extent(legs), found = [];
  const directions = Array.from({ length: SCAN + 1 }, (_, i) => cis(TURN / SCAN * (i + 0.371)));
  for (let third = 0; third < 3; third++) {
    const [i, j] = [0, 1, 2].filter((n) => n !== third), places = directions.map((u) => placesOn(u, i, j, legs));
    for (let branch = 0; branch < places[0].length; branch++) {
      const f = directions.map((u, n) => conditions(places[n][branch], u, legs)[third].f), starts = new Set();
      for (let n = 0; n < SCAN; n++) {
        if (Math.sign(f[n]) * Math.sign(f[n + 1]) < 0 || Number.isNaN(f[n]) !== Number.isNaN(f[n + 1])) starts.add(n).add(n + 1);
        const here = Math.abs(f[n]);
        if (n && here < Math.abs(f[n - 1]) && here < Math.abs(f[n + 1]) && here < 0.05 * whole) starts.add(n);
      }
      for (const n of [...starts].sort((a, b) => a - b)) if (!Number.isNaN(f[n])) found.push(solved(places[n][branch], directions[n], legs));
    }
  }
  const unique = [];
  for (const [k, u] of found) if (!Number.isNaN(k[0]) && unique.every(([a, b]) => size(sub(k, a)) + whole * size(sub(u, b)) > 1e-7 * whole)) unique.push([k, u]);
  return unique.sort((a, b) => mod(Math.atan2(a[1][1], a[1][0]), TURN) - mod(Math.atan2(b[1][1], b[1][0]), TURN));
}

// The triangle on other legs, if Newton's corrections shrink at once; else null.
function stepped([k, u], legs) {
  const whole = extent(legs), sign = Math.sign(determinantOf(coefficients(k, conditions(k, u, legs))));
  let last = Infinity;
  for (let i = 0; i < 12; i++) {
    const [dk, turned] = correction(k, u, legs);
    k = add(k, dk);
    u = mul(u, cis(turned));
    const moved = size(dk) + Math.abs(turned) * whole;
    if (moved < 1e-13 * whole) break;
    if (!(moved < 0.2 * whole) || (i && moved > SHRINKING * last && SHRINKING * last > 1e-11 * whole)) return null;
    last = moved;
  }
  const all = conditions(k, u, legs);
  if (!(Math.max(...all.map((c) => Math.abs(c.f))) < 1e-10 * whole) || Math.sign(determinantOf(coefficients(k, all))) !== sign) return null;
  return [k, straight(u)];
}

// The way from one angle to another in eight steps, each divided again where it is too long; null last where it ends.
function divided(legsAt, pose, from, to, deep) {
  const found = [];
  let last = from;
  for (const angle of spread(from, to, 9).slice(1)) {
    const next = stepped(pose, legsAt(angle));
    if (next || !deep) found.push([angle, next]);
    else found.push(...divided(legsAt, pose, last, angle, deep - 1));
    const here = found.at(-1)[1];
    if (!here) return found;
    [pose, last] = [here, angle];
  }
  return found;
}

function follow(legsAt, grid, pose) {
  const found = [];
  let here = pose;
  for (const angle of grid) {
    let to = here && stepped(here, legsAt(angle));
    if (!to && here && found.length) {
      const parts2 = divided(legsAt, here, found.at(-1)[0], angle, FINEST);
      to = parts2.at(-1)[1];
      found.push(...(parts2.at(-1)[0] === angle ? parts2.slice(0, -1) : parts2));
    }
    found.push([angle, to]);
    here = to;
  }
  return found;
}

const NO_COURSE = { angles: [0, TURN], places: [NOWHERE, NOWHERE], directions: [NOWHERE, NOWHERE] };

// Where a triangle stands all round the turn, in the way of assembly whose direction is nearest to the one told at an angle.
function courseOf(legsAt, at, near) {
  const found = modesOn(legsAt(at)), away = (/** @type {any[]} */ [, u]) => { const z = mul(u, cis(-near)); return Math.abs(Math.atan2(z[1], z[0])); };
  if (!found.length) return NO_COURSE;
  const taken = found.reduce((a, b) => (away(b) < away(a) ? b : a));
  const apart = (u) => { const z = mul(u, conj(taken[1])); return Math.abs(Math.atan2(z[1], z[0])); };
  if (away(taken) > SURELY_NEAR || found.some((one) => one !== taken && apart(one[1]) < ALIKE_POSES)) return NO_COURSE;
  const grid = [...spread(0, NODES - 1, NODES).map((i) => at + TURN / NODES * i), at + TURN];
  let way = follow(legsAt, grid, taken);
  const end = way.findIndex(([, pose]) => !pose);
  if (end >= 0) {
    const others = follow(legsAt, [...grid].reverse(), taken), stop = others.findIndex(([, pose]) => !pose);
    const first = way.slice(0, end + 1), rest = others.slice(0, stop + 1).filter(([angle]) => angle > way[end][0]);
    way = [...first, ...rest.reverse()];
  } else {
    const [k, u] = way.at(-1)[1], [k0, u0] = way[0][1];
    if (!(size(sub(k, k0)) < 1e-6 * extent(legsAt(at)) && size(sub(u, u0)) < 1e-6)) return NO_COURSE;
  }
  return { angles: way.map(([angle]) => angle), places: way.map(([, pose]) => pose?.[0] ?? NOWHERE), directions: way.map(([, pose]) => pose?.[1] ?? NOWHERE) };
}
