"""Rectangles, of the paper in millimetres or of a plan in its own unit."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Points = npt.NDArray[np.complex128]


class Box(NamedTuple):
    """An axis-parallel rectangle."""

    x0: float
    y0: float
    x1: float
    y1: float

    @classmethod
    def around(cls, z: Points, margin: float = 0.0) -> Box:
        """Bounding rectangle of points with a margin."""
        import numpy as np

        x, y, least, most = z.real, z.imag, np.minimum.reduce, np.maximum.reduce
        return cls(float(least(x)) - margin, float(least(y)) - margin, float(most(x)) + margin, float(most(y)) + margin)

    @property
    def corners(self) -> Points:
        """Corners, counter-clockwise from the lower left one."""
        import numpy as np

        x0, y0, x1, y1 = self
        return np.array([complex(x0, y0), complex(x1, y0), complex(x1, y1), complex(x0, y1)])

    @property
    def width(self) -> float:
        """Extent in x."""
        return self.x1 - self.x0

    @property
    def height(self) -> float:
        """Extent in y."""
        return self.y1 - self.y0

    @property
    def centre(self) -> complex:
        """Middle point."""
        return complex((self.x0 + self.x1) / 2, (self.y0 + self.y1) / 2)

    def inset(self, left: float, bottom: float | None = None, right: float | None = None, top: float | None = None) -> Box:
        """The rectangle made smaller on each side; one number means all four sides."""
        b = left if bottom is None else bottom
        r = left if right is None else right
        return Box(self.x0 + left, self.y0 + b, self.x1 - r, self.y1 - (left if top is None else top))

    def moved(self, by: complex) -> Box:
        """The rectangle moved."""
        return Box(self.x0 + by.real, self.y0 + by.imag, self.x1 + by.real, self.y1 + by.imag)

    def within(self, other: Box) -> Box:
        """What of the rectangle lies in another one."""
        return Box(max(self.x0, other.x0), max(self.y0, other.y0), min(self.x1, other.x1), min(self.y1, other.y1))

    def contains(self, p: complex, slack: float = 0.0) -> bool:
        """True when the point lies inside or at most ``slack`` outside."""
        return self.x0 - slack <= p.real <= self.x1 + slack and self.y0 - slack <= p.imag <= self.y1 + slack

    def nearest(self, p: complex) -> complex:
        """The point of the rectangle nearest to a point."""
        return complex(min(max(p.real, self.x0), self.x1), min(max(p.imag, self.y0), self.y1))
