"""The list of planted faults is that of the code as it is."""

from tests.mutations import FAULTS, ROOT


def test_every_fault_can_be_planted():
    out_of_date = [f"{f.file}: {f.old}" for f in FAULTS if (ROOT / "tmm_sheets" / f.file).read_text("utf-8").count(f.old) != 1]
    assert not out_of_date, out_of_date
    assert all((ROOT / room).exists() for f in FAULTS for room in f.rooms)
