"""The reader of printed formulas finds what does not come out, and reads indices, units, powers and borders of sentences."""

import pytest

from tests.note.printed_formulas import equalities
from tests.sheets.equations import read


@pytest.mark.parametrize(("line", "holds"), [
    ("n_{H} = n_{1}/u_{1H} = 2970/8,604 = 345,17 об/мин", [False]),
    ("n_{H} = n_{1}/u_{1H} = 2970/8,604 = 345,2 об/мин", [True]),
    ("r_0 = |OB|·μ_S = 79,20·0,001 = 79,197·10^{−3} м", [False]),
    ("i_{1,2} = −|0–1|/|0–2| = −83,3/65,5 = −1,272;  n_{1}/n_{2} = −1,273", [True]),
    ("M_{f} = ρ·F = 0,003·3155,6 = 9,467 N·m;  F = |−5,5·2 + 1| = 10 N", [True, True]),
    ("5 (z = 12) и 6 (z = 18)", []),
    ("Сборка: (15·15 + 29·59)/(4·НОД(29; 15)) = 484", [True]),
])  # fmt: skip
def test_formula_is_worked_out_from_its_lettering(line, holds):
    found = [equalities(part) for part in read(line)]
    assert [e.holds for equal, _ in found for e in equal] == holds
    assert not any(unread for _, unread in found)
