"""Data of cams for the tests, and the formulas of the translating roller follower that share nothing with the constructions."""

from math import pi, radians
from types import SimpleNamespace

import numpy as np

from tmm_sheets.result_files import plain_numbers


def cam_data(**changes):
    """Example 1 of manual 000, section 7, with changes; angles in degrees, lengths in mm, speed in rpm."""
    d = {"follower": "translating roller", "law": "sine", "fall_law": None, "rise": 100, "upper_dwell": 35, "fall": 70,
         "parts": 8, "stroke": 10, "eccentricity": None, "arm": None, "swing": None, "rotation": "same", "pressure_angle": 30,
         "limit": "rise", "centre": "vertex", "curvature_share": None, "base_radius": None, "sense": "clockwise", "roller": 3.5,
         "closure": "force",
         "speed": None, "follower_mass": None, "follower_inertia": None, "spring_factor": 1.75, "preload": 0.3,
         "table": None, "fall_table": None, "centre_distance": None} | changes
    for name in ("rise", "upper_dwell", "fall", "pressure_angle", "swing"):
        d[name] = None if d[name] is None else radians(d[name])
    for name in ("stroke", "roller", "eccentricity", "arm", "base_radius"):
        d[name] = None if d[name] is None else d[name] / 1e3
    d["speed"] = None if d["speed"] is None else d["speed"] * pi / 30
    data = SimpleNamespace(**d)
    data.diagram = lambda key: tuple(map(list, zip(*getattr(data, key), strict=True)))
    data.place = lambda key: key
    return data


def rocker_data(**changes):
    """Example 2 of manual 000, section 7, with changes."""
    return cam_data(**{"follower": "oscillating roller", "law": "cosine", "rise": 80, "upper_dwell": 20, "fall": 110, "swing": 30,
                       "arm": 90, "stroke": None, "pressure_angle": 45, "roller": 7} | changes)


def flat_data(**changes):
    """Example 3 of manual 000, section 7, with changes."""
    return cam_data(**{"follower": "flat", "law": "constant", "rise": 140, "upper_dwell": 20, "fall": 120, "stroke": 55,
                       "pressure_angle": None, "roller": None, "base_radius": 30} | changes)


def told(cam, *phi):
    """The results of a cam as numbers."""
    return plain_numbers(cam.results(*phi))


def sine_motion(data, phi):
    """S, S', S'' of the sine law at cam angles 0 .. 2 pi, written out phase by phase."""
    h = data.stroke
    down = data.rise + data.upper_dwell
    s, ds, dds = np.zeros_like(phi), np.zeros_like(phi), np.zeros_like(phi)
    s[(phi >= data.rise) & (phi <= down)] = h
    for start, angle, sign, first in ((0.0, data.rise, 1, 0.0), (down, data.fall, -1, h)):
        on = (phi >= start) & (phi <= start + angle)
        t = 2 * np.pi * (phi[on] - start) / angle
        s[on] = first + sign * h * (t - np.sin(t)) / (2 * np.pi)
        ds[on] = sign * h / angle * (1 - np.cos(t))
        dds[on] = sign * h * 2 * np.pi / angle**2 * np.sin(t)
    return s, ds, dds


def centre_profile(phi, s, s0, e, right=1.0):
    """Centre profile of an offset follower in the frame of the cam, in closed form."""
    return (-right * e + 1j * (s0 + s)) * np.exp(1j * right * phi)


def at_positions(law, function):
    """A function of the phases, such as ``Phase.dds``, at the numbered positions of a law, shape (2 parts + 2,)."""
    return np.concatenate((function(law.rise, law.shares), function(law.fall, law.shares)))
