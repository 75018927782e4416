"""Velocities of sliding, Coriolis accelerations, and the points that couples refer to.

Truth: how one link moves in the frame of the other, differentiated from the positions alone; the moments of a slider about its pin.
"""


import numpy as np
import pytest

from tests.project_files import known
from tmm_sheets.methods.linkage.positions import position_plan

STENCIL = ((1, 4 / 5), (2, -1 / 5), (3, 4 / 105), (4, -1 / 280))


@pytest.fixture(scope="module", params=["lugansk/shaper", "loom", "sieve.toml", "planer.toml", "conveyor.toml", "feeder.toml"])
def project(request):
    return known(request.param)


def rate(project, of):
    """Derivative over time of what ``of`` makes of a position plan, by a central difference of order 8."""
    m, phi, h = project.mechanism, project.study.positions.phi, 5e-3

    def at(n):
        return of(position_plan(m, phi + n * h))

    return sum(w * (at(n) - at(-n)) for n, w in STENCIL) / h * m.crank.omega


def fixed_point(m, link):
    """A hinge of a link; none of the frame, and of a block between two sliding pairs."""
    return next((p.name for p in m.pairs if link in p.links and p.motion == "rotation"), None)


def test_velocities_are_those_of_one_link_in_the_frame_of_the_other(project):
    m, study = project.mechanism, project.study
    assert set(study.sliding.velocities) == set(study.sliding.coriolis)
    assert len(study.sliding.velocities) == sum(p.motion == "translation" for p in m.pairs)
    compared = 0
    for index, step in study.sliding.velocities.items():
        j, k = index.split(",") if "," in index else index
        on, under = fixed_point(m, j), fixed_point(m, k)
        if on is None or (under is None and k != "0"):
            continue

        def turned(pos, k=k):
            return 1.0 if k == "0" else pos.directions[k].value

        def seen(pos, on=on, under=under, k=k):
            base = 0.0 if k == "0" else pos.points[under].value
            return (pos.points[on].value - base) * np.conj(turned(pos))

        v = rate(project, seen) * turned(study.positions)
        w = (rate(project, turned) * np.conj(turned(study.positions))).imag if k != "0" else 0.0
        size = m.crank.speed * m.crank.length
        assert np.abs(step.value - v).max() < 1e-8 * size
        assert np.abs(study.sliding.coriolis[index].value - 2j * w * v).max() < 1e-7 * size * m.crank.speed
        compared += 1
    assert compared


def test_couples_are_about_the_points_told(project):
    """Weights, inertia forces and reactions of a block alone make no other moment there than its inertia couple and that couple."""
    forces, pos = project.study.forces, project.study.positions
    k = project.force_index
    if not forces.couples:
        return
    assert set(forces.couple_points) == set(forces.couples)
    for name, at in forces.couple_points.items():
        j = name[1:].split(",")[0] if "," in name else name[1]
        about = complex(np.ravel(pos.points[at].value)[k if np.ndim(pos.points[at].value) else 0])
        total = float(np.real(forces.couples[name].at(k)))
        for load in forces.loads[j]:
            at_load = complex(load.at.at(k))
            total += (np.conj(at_load - about) * complex(load.vector.at(k))).imag
            total += 0.0 if load.couple is None else float(np.real(load.couple.at(k)))
        total += sum(float(np.real(c.at(k))) for c in forces.link_couples.get(j, ()))
        assert abs(total) < 1e-12 * max(forces.moment_size(k), 1.0)
