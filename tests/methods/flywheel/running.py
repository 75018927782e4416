"""The angular velocity of a machine with its flywheel by the law of energy, from its integrals alone."""

import numpy as np

from tmm_sheets.methods.integration import Quadrature


def speed(moment, inertia, borders, flywheel, fastest, phi):
    """Angular velocity over the angle with that flywheel, from the energy integral, rad/s.

    ``fastest`` is an angle and the angular velocity there; the constant moment balances the cycle.
    """
    work = Quadrature(moment, borders, 8)
    mean = work.total / (borders[-1] - borders[0])
    at = np.concatenate(([fastest[0]], np.asarray(phi, dtype=float)))
    excess = work(at) - mean * (at - borders[0])
    mass = flywheel + np.asarray(inertia(at))
    energy = mass[0] * fastest[1] ** 2 / 2 + excess[1:] - excess[0]
    return np.sqrt(2 * energy / mass[1:])


def speed_of(fw, phi, inertia=None):
    """Angular velocity of the crank with the exact flywheel of a project (or another, kg m2), rad/s.

    The motion is the steady one that reaches omega (1 + delta/2) at the upper contact.
    """
    fastest = fw.reduced.omega1 * (1 + (fw.limit.delta if fw.given else fw.unevenness) / 2)
    j = fw.limit.inertia if inertia is None else inertia
    return speed(fw.reduced.moment, fw.reduced.inertia, fw.edges, j, (fw.limit.phi_max, fastest), phi)
