from math import pi

import numpy as np
import pytest

from tests.backends.geometry import area, drawn
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import BAR
from tmm_sheets.drawing.marks import Drawing
from tmm_sheets.drawing.styles import line_types


@pytest.fixture(scope="session")
def drawing() -> Drawing:
    """One mark of every kind in every line type, lettering in every size, straight and turned."""
    canvas = Canvas(of="sample")
    for i, style in enumerate(line_types()):
        y = 40 + 12 * i
        canvas.line(complex(30, y), complex(130, y), style)
        canvas.circle(complex(180, y), 5 + 3 * i, style)
        canvas.arc(complex(260, y), 20, 0.3, 4, style)
        x = np.linspace(0, 100, 51)
        canvas.polyline(320 + x + 1j * (y + 5 * np.sin(x / 9)), style)
        canvas.polyline([450 + 1j * y, 480 + 1j * y, 470 + 1j * (y + 9)], style, closed=True)
        canvas.arrow(complex(520, y), complex(560, y + 5), style)
    canvas.dot(600 + 100j, 2.0)
    canvas.fill([600 + 120j, 620 + 120j, 625 + 130j, 605 + 130j])
    canvas.text(100 + 400j, f"F{BAR}_{{21}}^τ = μ_l·V_B3", 5.0)
    canvas.text(100 + 380j, "План скоростей, 0,0025 м/мм (№ 3) \\\\ φ₁°".replace("₁", "_1"), 3.5)
    canvas.text(100 + 360j, "Сжатие, Ξ ≤ 30°", 7.0, angle=pi / 2)
    canvas.text(100 + 340j, "ТММ.КП.01", 2.5, angle=pi)
    return Drawing(841.0, 594.0, "Лист 1. Строгальный станок", tuple(canvas.marks), "Иванов И. И.")


@pytest.fixture(scope="session")
def wanted(drawing):
    """The area that it covers with ink."""
    return area(drawn(drawing))
