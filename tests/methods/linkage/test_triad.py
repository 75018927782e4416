"""Groups of class III: positions, velocities, accelerations, forces, ways of assembly, limits.

Truth: Newton's method on the equations of the legs in 50 digits and its derivatives, the sextic of all ways of assembly, the power
of all forces, a scan of the locus by compasses. None of them shares anything with the false positions and special points on trial.
"""

from dataclasses import replace
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest

from tests.methods.linkage.mechanisms import mechanism
from tests.project_files import known
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.lab.stress.draw import chain
from tmm_sheets.mechanism.groups import TRIAD, decompose, three_legs
from tmm_sheets.mechanism.groups.triad import TriadGroup
from tmm_sheets.mechanism.model import Crank, Leg
from tmm_sheets.methods.linkage.checks import check_turn
from tmm_sheets.methods.linkage.positions import position_plan
from tmm_sheets.task import variant


@pytest.fixture(scope="module", params=["screen", "loom", "sieve.toml"])
def project(request):
    return known(request.param)


def cis(x):
    return mp.mpc(mp.cos(x), mp.sin(x))


def exactly(m, phi):
    """Points of a mechanism of groups of kinds 1, 2 and 6 at a crank angle, each group by its equations alone, in mpmath."""
    z = {name: mp.mpc(at) for name, at in m.fixed.items()}
    start = position_plan(m, np.array([float(phi)]))
    near = {name: complex(np.ravel(step.value)[0]) for name, step in start.points.items()}
    z[m.crank.pin] = z[m.crank.pivot] + m.crank.length * cis(phi)

    def solve(equations, names):
        first = [x for name in names for x in (near[name].real, near[name].imag)]
        found = mp.findroot(lambda *x: equations({**z, **{n: mp.mpc(x[2 * i], x[2 * i + 1]) for i, n in enumerate(names)}}), first)
        for i, name in enumerate(names):
            z[name] = mp.mpc(found[2 * i], found[2 * i + 1])

    for g in m.groups:
        if g.kind.number == 1:
            rods = tuple(zip(g.outer, g.lengths, strict=True))
            solve(lambda p, g=g, rods=rods: [abs(p[g.inner] - p[q]) ** 2 - mp.mpf(length) ** 2 for q, length in rods], [g.inner])
        elif g.kind.number == 2:
            guide = m.guides[g.guides[0]]
            solve(lambda p, g=g, guide=guide: [abs(p[g.inner] - p[g.outer[0]]) ** 2 - mp.mpf(g.lengths[0]) ** 2,
                                               ((p[g.inner] - guide.through) * cis(-guide.direction)).imag], [g.inner])
        else:
            solve(lambda p, g=g: triangle(m, g, p), [leg.corner for leg in g.legs])
        for p in m.points:
            if p.name not in z and p.start in z and p.towards in z:
                u = z[p.towards] - z[p.start]
                z[p.name] = z[p.start] + p.distance * u / abs(u) * cis(p.angle)
    return z


def triangle(m, g, p):
    """Six equations of three corners: two sides, the angle between them (as a cross product), and the legs."""
    first, second, third = (p[leg.corner] for leg in g.legs)
    one, two = (mp.mpf(side) for side in g.sides)
    shape = (third - first) * one - (second - first) * two * cis(g.angle)
    found = [abs(second - first) ** 2 - one**2, shape.real, shape.imag]
    for leg in g.legs:
        if leg.guide:
            guide = m.guides[leg.guide]
            found.append(((p[leg.corner] - guide.through) * cis(-guide.direction)).imag)
        elif leg.slot is None:
            found.append(abs(p[leg.corner] - p[leg.outer]) ** 2 - mp.mpf(leg.length) ** 2)
        else:
            found.append(((p[leg.outer] - p[leg.corner]) * mp.conj((second - first) * cis(leg.slot))).imag)
    return found


def test_positions_velocities_and_accelerations_are_the_exact_ones(project):
    m, study = project.mechanism, project.study
    size = max(abs(z) for z in m.fixed.values())
    with mp.workdps(50):
        for k in (0, 4, 9):
            phi, w = mp.mpf(float(study.positions.phi[k])), mp.mpf(m.crank.omega)
            h = mp.mpf("1e-12")
            before, here, after = (exactly(m, phi + x) for x in (-h, 0, h))
            for name in set(here) - set(m.fixed):
                v = (after[name] - before[name]) / (2 * h) * w
                a = (after[name] - 2 * here[name] + before[name]) / h**2 * w**2
                assert abs(study.positions.points[name].at(k) - complex(here[name])) < 2e-15 * size
                assert abs(study.velocities.points[name].at(k) - complex(v)) < 1e-13 * m.crank.speed * size
                assert abs(study.accelerations.points[name].at(k) - complex(a)) < 1e-12 * m.crank.speed**2 * size


def test_balancing_moment_makes_up_for_the_power_of_all_forces(project):
    """With velocities and accelerations from the exact positions, and the same by the lever."""
    m, study, forces = project.mechanism, project.study, project.study.forces
    k = project.force_index
    phi, w, h = mp.mpf(float(study.positions.phi[k])), mp.mpf(m.crank.omega), mp.mpf("1e-10")
    with mp.workdps(40):
        z = [exactly(m, phi + x) for x in (-h, 0, h)]
        power = powers(project, k, z, h, w)
    assert forces.balancing.at(k) * m.crank.omega == pytest.approx(-power, rel=1e-9)
    assert study.lever.balancing.at(k) == pytest.approx(forces.balancing.at(k), rel=1e-12)


def powers(project, k, z, h, w):
    """Power of weights, inertia and applied forces from points at three crank angles ``h`` apart, W."""
    m, study = project.mechanism, project.study

    def rates(values):
        return complex((values[2] - values[0]) / (2 * h) * w), complex((values[2] - 2 * values[1] + values[0]) / h**2 * w**2)

    def turning(link):
        """Angular velocity and acceleration from two points of a link; a slider block turns with its slot."""
        pairs = [p.name.rstrip("′") for p in m.pairs if link in p.links and p.motion == "rotation"]
        names = dict.fromkeys([*pairs, *(p.name for p in m.points if p.link == link)])
        if len(names) < 2:
            link = next(p.links[1] for p in m.pairs if p.links[0] == link and p.motion == "translation")
            return turning(link)
        a, b = list(names)[:2]
        v, acc = rates([mp.log((at[b] - at[a]) / abs(at[b] - at[a])) for at in z])
        return v.imag, acc.imag

    power = 0.0
    for link in m.links.values():
        if link.mass:
            v, a = rates([at[link.centre] for at in z])
            power += (-link.mass * (a + 9.81j) * np.conj(v)).real
        if link.inertia:
            omega, epsilon = turning(link.name)
            power -= link.inertia * omega * epsilon
    for f in project.applied:
        step = next(step for step in study.loads[2] if step.name == f.name)
        power += (float(np.real(step.at(k))) * turning(f.link)[0] if f.point is None
                  else (complex(step.at(k)) * np.conj(rates([at[f.point] for at in z])[0])).real)
    return power


def sextic(g, p):
    """Directions, rad, of all ways of assembly of a triangle on three rods about points ``p``: roots of a polynomial of e^{iθ}."""
    l1, l2, l3 = (leg.length for leg in g.legs)
    corners = (0j, complex(g.sides[0]), g.sides[1] * np.exp(1j * g.angle))
    n = 32
    u = np.exp(2j * np.pi * np.arange(n) / n)
    e = [c * u - q + p[0] for c, q in zip(corners[1:], p[1:], strict=True)]  # K1 is r from p[0]: |r| = l1, |r + e| = l
    r2 = [(length**2 - l1**2 - np.abs(x) ** 2) / 2 for length, x in zip((l2, l3), e, strict=True)]
    det = (np.conj(e[0]) * e[1]).imag
    top = 1j * (e[0] * r2[1] - e[1] * r2[0])
    values = np.abs(top) ** 2 - l1**2 * det**2
    c = np.fft.fft(values) / n
    c = np.concatenate((c[-6:], c[:7]))
    roots = np.roots(c[::-1])
    return np.sort(np.mod(np.angle(roots[np.abs(np.abs(roots) - 1) < 1e-7]), 2 * np.pi))


def test_all_ways_of_assembly_are_told_apart():
    rng = np.random.default_rng(5)
    counts = []
    while len(counts) < 12:
        m, phi = chain(rng, kinds=(6,))
        g = m.groups[0]
        if any(leg.form != "RR" for leg in g.legs):
            continue
        pos = position_plan(m, np.array([phi]))
        p = [complex(np.ravel(pos.points[leg.outer].value)[0]) for leg in g.legs]
        found = np.sort(np.mod([np.angle(u) for _, u in pos.course(g).found], 2 * np.pi))
        expected = sextic(g, p)
        assert len(found) == len(expected)
        assert np.abs(np.exp(1j * found) - np.exp(1j * expected)).max() < 1e-6
        counts.append(len(found))
    assert {2, 4} <= set(counts)


def test_either_way_of_assembly_is_built():
    """The loom's plate the other way round: its own corners, the same legs."""
    m = known("loom").mechanism
    triad, rest = m.groups
    way = position_plan(m, np.array([0.0])).course(triad)
    other = next(u for n, (_, u) in enumerate(way.found) if n != way.taken)
    m = replace(m, groups=(replace(triad, near=float(np.angle(other))),), points=())
    pos = position_plan(m, np.array([0.0]))
    assert complex(pos.directions["3"].value[0]) == pytest.approx(other, abs=1e-12)
    assert abs(pos.points["F"].value[0] - m.fixed["G"]) == pytest.approx(triad.legs[2].length, rel=1e-14)
    assert rest.name == "6–7"


def shorter(length):
    m = known("screen").mechanism
    (g,) = m.groups
    return replace(m, groups=(replace(g, legs=(*g.legs[:2], replace(g.legs[2], length=length))),))


def test_where_the_locus_does_not_reach():
    """A rocker 5 that is too short on a part of the turn, and one that is too short all round: where, and by how much."""
    with pytest.raises(CannotBuild, match=(
            r"group 3-2-4-5 does not assemble at crank angles 164\.7\.\.216\.8 deg: the locus of F does not come to the circle of "
            r"leg 5"
            r": 4\.188 mm are missing at worst \(crank angle 191\.0 deg\); reachable crank angles: -143\.2\.\.164\.7 deg")):
        check_turn(shorter(0.30))
    assert missed(shorter(0.30), np.radians(191.0), 0.30) == pytest.approx(4.188e-3, abs=1e-6)
    # The ends: there the compasses just reach.
    assert missed(shorter(0.30), np.radians(164.6), 0.30) == 0
    assert missed(shorter(0.30), np.radians(164.8), 0.30) > 0
    with pytest.raises(CannotBuild, match=r"does not assemble at any position: .*\n.*no way of assembly at crank angle 0 deg"):
        check_turn(shorter(0.15))
    check_turn(shorter(0.40))


def missed(m, phi, length):
    """By how much a dense locus of F, struck with compasses, misses the circle of leg 5, m; 0 where it cuts it."""
    (g,) = m.groups
    b, e, p3 = m.crank.length * np.exp(1j * phi), m.fixed["E"], m.fixed["G"]
    gaps = []
    for side in (1, -1):
        c = b + g.legs[0].length * np.exp(1j * np.linspace(0, 2 * np.pi, 200_001))
        d = e - c
        along = (np.abs(d) ** 2 + g.sides[0] ** 2 - g.legs[1].length ** 2) / (2 * np.abs(d))
        with np.errstate(invalid="ignore"):
            u = (along + side * 1j * np.sqrt(g.sides[0] ** 2 - along**2)) / g.sides[0] * d / np.abs(d)
        f = c + g.sides[1] * u * np.exp(1j * g.angle)
        gaps.append(np.abs(f - p3) - length)
    gaps = np.concatenate(gaps)
    gaps = gaps[~np.isnan(gaps)]
    return 0.0 if gaps.min() < 0 < gaps.max() else float(np.abs(gaps).min())


def test_a_direction_of_no_way_of_assembly_is_refused():
    m = known("screen").mechanism
    m = replace(m, groups=(replace(m.groups[0], near=2.8),))
    with pytest.raises(CannotBuild, match=r"no way of assembly at crank angle 0 deg has CD near 160\.4.* deg"):
        check_turn(m)


def test_structure(project):
    m = project.mechanism
    assert m.mobility == 1
    assert m.grade == 3
    assert [(set(g.links), g.kind.number) for g in decompose(m)] == [(set(g.links), g.kind.number) for g in reversed(m.groups)]


def test_false_positions_lie_on_the_locus(project):
    """The first two legs keep their lengths or guides, each corner the triangle's sides; the third leg's corner is elsewhere."""
    pos, m = project.study.positions, project.mechanism
    g = next(g for g in m.groups if g.kind.number == 6)
    plan = pos.false[g.name]
    a, b, c = g.legs
    for n in (-3, -1, 1, 3):
        first, third = (plan[f"{leg.corner}({n:+d})"].value for leg in (a, c))
        assert np.abs(np.abs(first - pos.points[a.outer].value) - a.length).max() < 1e-13
        assert np.abs(np.abs(third - first) - g.sides[1]).max() < 1e-13
        u = (third - first) / (g.sides[1] * np.exp(1j * g.angle))
        second = first + g.sides[0] * u
        held = (second, pos.points[b.outer].value) if b.outer else (second, pos.guide_points[b.guide].value)
        if b.guide:
            missed = ((held[0] - held[1]) * np.conj(pos.guide_directions[b.guide].value)).imag
        elif b.slot is None:
            missed = np.abs(held[0] - held[1]) - b.length
        else:
            missed = ((held[0] - held[1]) * np.conj(u * np.exp(1j * b.slot))).imag
        assert np.abs(missed).max() < 1e-13
        assert np.abs(third - pos.points[c.corner].value).min() > 1e-3


def test_a_turn_may_end_in_another_way_of_assembly():
    """Found by the trial of random groups: refused, the mechanism would repeat after two turns only."""
    found = three_legs.Course(np.zeros(2), np.zeros(2), np.zeros(2), np.zeros((3, 2)), False, ((0j, 1 + 0j), (0j, 1j)), 0)
    m = known("screen").mechanism
    m = replace(m, groups=(replace(m.groups[0], near=0.0),))
    m.courses[m.groups[0].name] = found
    with pytest.raises(CannotBuild, match="after a turn of the crank it stands in another way of assembly"):
        position_plan(m, np.array([0.0]))


def test_two_ways_in_one_direction_are_refused():
    """Two rockers of a parallelogram: the body may stand over them or hang below, level both times."""
    legs = (Leg("2", "C", "B", length=0.30), Leg("4", "D", "E", length=0.28), Leg("5", "F", "G", length=0.28))
    g = TriadGroup(TRIAD, ("3", "2", "4", "5"), ("B", "E", "G"), legs=legs, sides=(0.2, 0.6), angle=0.0)
    m = mechanism(g, fixed={"E": 0.45 - 0.42j, "G": 0.85 - 0.42j}, crank=Crank("1", "A", "B", 0.06, 10.0, 1))
    with pytest.raises(CannotBuild, match="two ways of assembly have CD in the same direction at crank angle 0 deg"):
        position_plan(m, np.array([0.0]))


SCREEN = Path(__file__).parents[3] / "variants" / "screen.toml"


@pytest.mark.parametrize(("old", "new", "said"), [
    ('links = ["3", "2", "4", "5"]', 'links = ["3", "2"]', "expected 4 links for a group of kind 6"),
    ('length = "0.42 m"', 'slot = "10 deg"\nlength = "0.42 m"',
     "expected a leg with outer and length, with guide, or with outer and slot"),
    ('length = "0.45 m"\n\n[[group.leg]]                   # rocker 4', 'slot = "0 deg"\n\n[[group.leg]]',
     "only the second leg may be a slider block in a slot"),
    ('direction = "-25 deg"', "", 'a group of kind 6 needs "direction"'),
    ('corner = "F"', 'corner = "D"', 'the point "D" is there already'),
    ('name = "S3"', 'name = "W3"', 'the point "W3" is there already'),
    ('outer = "E"', 'outer = "Q"', 'unknown point "Q"'),
    ('kind = 6', 'kind = 1', "expected 2 links for a group of kind 1"),
])
def test_what_a_file_may_say_wrong(tmp_path, old, new, said):
    text = SCREEN.read_text(encoding="utf-8")
    assert old in text
    path = tmp_path / "screen.toml"
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(BadInput) as failed:
        variant.read(path)
    assert said in str(failed.value)
