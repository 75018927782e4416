"""What the functions of constructions take and give, by name: quantities of one position, or of many at once.

The plane is that of the complex numbers, lengths are metres and angles radians unless a function says otherwise. Each of these is a
number, or an array with one at each position, shape (positions,), or of any other shapes that NumPy broadcasts: a function gives
what its arguments broadcast to, and NaN where its construction does not exist. For the type checker they are anything: a step's
function is also traced with symbols, see :mod:`~tmm_sheets.construction.expression`.
"""

from __future__ import annotations

from typing import Any, TypeAlias

Points: TypeAlias = Any
"""Points x + iy, m."""
Vectors: TypeAlias = Any
"""Plane vectors x + iy: forces, N, velocities, m/s ..."""
Directions: TypeAlias = Any
"""Vectors of length 1 without unit."""
Reals: TypeAlias = Any
"""Lengths, m, angles, rad, and other real numbers."""
Signs: TypeAlias = Any
"""+1 or -1: one or the other of two solutions, as the function says."""
