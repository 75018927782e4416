"""The manuals' printed tables compared as if a student had measured them: are their known slips found, and is nothing else accused?

Every cell that has an entry in the template is filled in, with the manual's own scale factors. A slip counts as found when its
number is not green; a clean number that is red is a false alarm. Slips smaller than what a pencil does cannot be seen from the
numbers alone: they are told with their size in tolerances. Run: python -m tests.compare.manual_tables

The false alarms are no slips of the pen but drawings of the manual that are off by more than a careful pencil: arms of forces up to
4.5 mm, the closing side F30 of the engine 3.6 mm, and what was computed from them.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from tests import project_files as files
from tests.compare.students import measured
from tests.manuals.test_engine_tables import ERRATA as ENGINE_ERRATA
from tests.manuals.test_shaper_tables import ERRATA as SHAPER_ERRATA
from tmm_sheets import catalogue
from tmm_sheets.compare.measured.chain import judge
from tmm_sheets.compare.measured.evidence import JudgedValue
from tmm_sheets.compare.measured.measurable import Measurables
from tmm_sheets.compare.measured.measured_file import FilledTable, read
from tmm_sheets.project import Project

MANUALS = Path(__file__).parents[1] / "manuals"


@dataclass
class Cell:
    """A printed number: table, row and column, the entry it belongs to, and whether it is known to be wrong."""

    place: str
    entry: str
    printed: str
    slip: str = ""


@dataclass
class Table:
    """Cells of one table with the scale factors it was drawn with; what one entry has twice goes into several tables."""

    name: str
    project: str
    scales: dict[str, float]
    cells: list[Cell] = field(default_factory=list)


@dataclass
class Outcome:
    """A cell with its judgement."""

    cell: Cell
    judged: JudgedValue


def rows(name: str) -> list[dict[str, str]]:
    """Rows of a CSV file of the manuals, without its remarks."""
    with (MANUALS / f"{name}.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


# --- shaper, manual 000, example 1 --------------------------------------------------------------------------------------------

SHAPER = {
    "positions": 0.006, "velocities": 0.02, "accelerations": 0.05, "force-5": 40.0, "force-4": 40.0, "force-2": 100.0,
    "force-3": 100.0, "force-1": 200.0, "scheme-4-5": 0.006, "scheme-2-3": 0.006, "scheme-crank": 0.006, "lever": 0.02 / 1.5,
    "moment": 12.5, "work": 17.45, "energy": 8.725, "inertia": 0.0875,
}
SHAPER_TABLES = {
    "shaper_table_3_2": {"pb3_mm": "velocities/{}/pb3", "CB_mm": "positions/{}/CB", "cd_mm": "velocities/{}/pd"},
    "shaper_table_3_3": {
        "pb3_mm": "velocities/{}/pb3", "VB3_m_s": "results/{}/V_B3", "bb3_mm": "velocities/{}/bb3", "VB3B_m_s": "results/{}/V_B3B",
        "pd_mm": "velocities/{}/pd", "VD_VS4_m_s": "results/{}/V_D", "pd5_mm": "velocities/{}/pd5",
        "VD5_VS5_m_s": "results/{}/V_D5",
        "pS3_mm": "velocities/{}/ps3", "VS3_m_s": "results/{}/V_S3", "omega2_omega3_rad_s": "results/{}/omega3",
    },
    "flywheel_table_5_1": {"VD5_m_s": "results/{}/V_D5", "Mc_reduced_N_m": "results/{}/M_red"},
    "flywheel_table_5_2": {
        "VS2_m_s": "results/{}/V_B", "m2VS2sq_kg_m2_s2": "results/{}/m2V_B^2", "omega3_rad_s": "results/{}/omega3",
        "JS3w3sq_kg_m2_s2": "results/{}/J_S3omega3^2", "VS3_m_s": "results/{}/V_S3", "m3VS3sq_kg_m2_s2": "results/{}/m3V_S3^2",
        "VS4_m_s": "results/{}/V_D", "m4VS4sq_kg_m2_s2": "results/{}/m4V_D^2", "VS5_m_s": "results/{}/V_S5",
        "m5VS5sq_kg_m2_s2": "results/{}/m5V_S5^2", "J_reduced_kg_m2": "results/{}/J_red",
    },
}
SHAPER_SCALARS = {
    "sh.mm.AB": "positions/2/AB", "sh.mm.CD": "positions/2/CD", "sh.mm.CS3": "positions/2/CS3", "sh.VB": "results/2/V_B",
    "sh.v.cd_mm": "velocities/2/pd", "sh.v.cS3_mm": "velocities/2/ps3", "sh.VB3": "results/2/V_B3", "sh.VB3B": "results/2/V_B3B",
    "sh.VD": "results/2/V_D", "sh.VD5": "results/2/V_D5", "sh.VS3": "results/2/V_S3", "sh.w3": "results/2/omega3",
    "sh.aB": "results/2/a_B", "sh.acor": "results/2/a_B3B^k", "sh.an": "results/2/a_B3C^n", "sh.bk_mm": "accelerations/2/bk",
    "sh.cn_mm": "accelerations/2/pin", "sh.a.cd_mm": "accelerations/2/pid", "sh.a.cS3_mm": "accelerations/2/pis3",
    "sh.aB3": "results/2/a_B3", "sh.at": "results/2/a_B3C^t", "sh.aD": "results/2/a_D", "sh.a5": "results/2/a_D5",
    "sh.aD5D": "results/2/a_D5D^r", "sh.aS3": "results/2/a_S3", "sh.e3": "results/2/epsilon3", "sh.G4": "results/2/G4",
    "sh.G5": "results/2/G5", "sh.Fi4": "results/2/Fi4", "sh.Fi5": "results/2/Fi5", "sh.F54": "results/2/F54",
    "sh.F50": "results/2/F50", "sh.F43": "results/2/F43", "sh.h5_mm": "arms/2/h_F5(D)", "sh.h50": "results/2/h50",
    "sh.G2": "results/2/G2", "sh.G3": "results/2/G3", "sh.Fi2": "results/2/Fi2", "sh.Fi3": "results/2/Fi3",
    "sh.Mi3": "results/2/Mi3",
    "sh.arm.G2": "arms/2/h_G2(C)", "sh.arm.Fi2": "arms/2/h_Fi2(C)", "sh.arm.Fi3": "arms/2/h_Fi3(C)", "sh.arm.G3": "arms/2/h_G3(C)",
    "sh.arm.F34": "arms/2/h_F34(C)", "sh.BC_mm": "positions/2/CB", "sh.F21t": "results/2/F21t", "sh.F21": "results/2/F21",
    "sh.F23": "results/2/F23", "sh.F30": "results/2/F30", "sh.arm.h12": "arms/2/h_F12(A)", "sh.F1k": "results/2/F1",
    "sh.G1": "results/2/G1", "sh.F10": "results/2/F10", "sh.lev.pd5": "lever/2/hF5", "sh.lev.Fi4": "lever/2/hFi4",
    "sh.lev.G4": "lever/2/hG4", "sh.lev.Fi3": "lever/2/hFi3", "sh.lev.G3": "lever/2/hG3", "sh.lev.G2": "lever/2/hG2",
    "sh.lev.pd": "lever/2/hFMi3", "sh.lev.h1": "lever/2/hF1", "sh.F1l": "results/2/F1-lever",
}
SHAPER_FLYWHEEL = {
    "sh.psimax": "energy-mass/psi_max", "sh.psimin": "energy-mass/psi_min", "sh.ab": "energy-mass/ab",
    "sh.Jm": "results/J_flywheel",
    "sh.D": "results/D", "sh.Brim": "results/B", "sh.Hrim": "results/H", "sh.mfly": "results/m", "sh.w1": "results/2/omega1",
}


def shaper() -> list[Table]:
    """Tables 3.2, 3.3, 5.1 and 5.2 and the numbers of the text."""
    tables = []
    for name, columns in SHAPER_TABLES.items():
        table = Table(name, "lugansk/shaper", SHAPER)
        tables.append(table)
        for row in rows(name):
            wrong = set((row.get("errata") or "").split())
            for column, entry in columns.items():
                short = name.removeprefix("shaper_table_")
                slip = SHAPER_ERRATA.get((short, row["position"], column), {}).get("why", "")
                slip = slip or ("inherited" if column in wrong else "")
                if row["position"] != "10":  # position 10 is position 0 again
                    table.cells.append(Cell(f"{row['position']} {column}", entry.format(row["position"]), row[column], slip))
    text = Table("shaper_scalars", "lugansk/shaper", SHAPER)
    printed = {r["id"]: r["value"] for r in rows("shaper_scalars")}
    for key, entry in SHAPER_SCALARS.items():
        text.cells.append(Cell(key, entry, printed[key], SHAPER_ERRATA.get(("scalars", key, "value"), {}).get("why", "")))
    # The first side of the plan of link 2 was divided by 200 N/mm, the announced factor is 100 N/mm.
    text.cells.append(Cell("|2-3| of link 2", "force-2/2/2-3", "25.4", "drawn at half the scale"))
    wheel = Table("flywheel_scalars", "lugansk/shaper", SHAPER)
    printed = {r["id"]: r["value"] for r in rows("flywheel_scalars")}
    wheel.cells += [Cell(key, entry, printed[key]) for key, entry in SHAPER_FLYWHEEL.items()]
    return [*tables, text, wheel]


# --- engine, manual 000, example 2 --------------------------------------------------------------------------------------------

ENGINE = {
    "positions": 0.0024, "velocities": 0.5, "accelerations": 100.0, "force-4–5": 50.0, "force-2–3": 200.0, "force-1": 600.0,
    "scheme-4-5": 0.0024, "scheme-2-3": 0.0024, "scheme-crank": 0.002, "lever": 13.572 / 40.5, "moment": 25.0, "work": 47.1,
    "energy": 23.55, "inertia": 0.00015,
}
_RODS = {
    "VS2_m_s": "results/{}/V_S2", "VS4_m_s": "results/{}/V_S4", "omega2_rad_s": "results/{}/omega2",
    "omega4_rad_s": "results/{}/omega4",
}
ENGINE_TABLES = {
    "3_4": {"bc_mm": "velocities/{}/bc", "bS2_mm": "velocities/{}/bs2", "de_mm": "velocities/{}/de", "dS4_mm": "velocities/{}/ds4"},
    "3_5": {
        "pc_mm": "velocities/{}/pc", "VC_VS3_m_s": "results/{}/V_C", "cb_mm": "velocities/{}/bc", "VCB_m_s": "results/{}/V_CB",
        "pe_mm": "velocities/{}/pe", "VE_VS5_m_s": "results/{}/V_E", "ed_mm": "velocities/{}/de", "VED_m_s": "results/{}/V_ED",
        "pS2_mm": "velocities/{}/ps2", "pS4_mm": "velocities/{}/ps4", **_RODS,
    },
    "5_3": {"VC_m_s": "results/{}/V_C", "VE_m_s": "results/{}/V_E", "M3_N_m": "results/{}/M_F3", "M5_N_m": "results/{}/M_F5",
    "Md_N_m": "results/{}/M_red"},
    "5_4": {
        "m2VS2sq_kg_m2_s2": "results/{}/m2V_S2^2", "JS2w2sq_kg_m2_s2": "results/{}/J_S2omega2^2", "VS3_m_s": "results/{}/V_C",
        "m3VS3sq_kg_m2_s2": "results/{}/m3V_C^2", "m4VS4sq_kg_m2_s2": "results/{}/m4V_S4^2", "VS5_m_s": "results/{}/V_E",
        "JS4w4sq_kg_m2_s2": "results/{}/J_S4omega4^2", "m5VS5sq_kg_m2_s2": "results/{}/m5V_E^2",
        "J_reduced_1e-2_kg_m2": "results/{}/J_red", **_RODS,
    },
}
ENGINE_SCALARS = {
    "en.mm.AB": "positions/1/AB", "en.mm.BC": "positions/1/BC", "en.mm.BS": "positions/1/BS2", "en.VB": "results/1/V_B",
    "en.v.bS2_mm": "velocities/1/bs2", "en.VC": "results/1/V_C", "en.VCB": "results/1/V_CB", "en.VE": "results/1/V_E",
    "en.VED": "results/1/V_ED", "en.VS2": "results/1/V_S2", "en.VS4": "results/1/V_S4", "en.w2": "results/1/omega2",
    "en.w1": "results/1/omega1", "en.aB": "results/1/a_B", "en.an": "results/1/a_CB^n", "en.bn_mm": "accelerations/1/bn",
    "en.bS2a_mm": "accelerations/1/bs2", "en.aC": "results/1/a_C", "en.at2": "results/1/a_CB^t", "en.aE": "results/1/a_E",
    "en.at4": "results/1/a_ED^t", "en.aS2": "results/1/a_S2", "en.aS4": "results/1/a_S4", "en.e2": "results/1/epsilon2",
    "en.G4": "results/1/G4", "en.G5": "results/1/G5", "en.Fi4": "results/1/Fi4", "en.Fi5": "results/1/Fi5",
    "en.Mi4": "results/1/Mi4",
    "en.arm.G4": "arms/1/h_G4(E)", "en.arm.Fi4": "arms/1/h_Fi4(E)", "en.F41t": "results/1/F41t", "en.F41": "results/1/F41",
    "en.F50": "results/1/F50", "en.F45": "results/1/F45", "en.Fi2": "results/1/Fi2", "en.Fi3": "results/1/Fi3",
    "en.Mi2": "results/1/Mi2", "en.arm.G2": "arms/1/h_G2(C)", "en.arm.Fi2": "arms/1/h_Fi2(C)", "en.F21t": "results/1/F21t",
    "en.F21": "results/1/F21", "en.F30": "results/1/F30", "en.F23": "results/1/F23", "en.arm.h14": "arms/1/h_F14(A)",
    "en.arm.h12": "arms/1/h_F12(A)", "en.M1k": "results/1/M1", "en.F10": "results/1/F10", "en.lev.Fi2": "lever/1/hFi2",
    "en.lev.G2": "lever/1/hG2", "en.lev.Mi2b": "lever/1/hFMi2'", "en.lev.Mi2c": "lever/1/hFMi2", "en.lev.pc": "lever/1/hF3",
    "en.lev.G4": "lever/1/hG4", "en.lev.Fi4": "lever/1/hFi4", "en.lev.Mi4e": "lever/1/hFMi4", "en.lev.Mi4d": "lever/1/hFMi4'",
    "en.lev.pe": "lever/1/hFi5", "en.lev.h": "lever/1/hFMup", "en.M1l": "results/1/M1-lever", "en.psimax": "energy-mass/psi_max",
    "en.psimin": "energy-mass/psi_min", "en.ab": "energy-mass/ab", "en.Jm": "results/J_flywheel", "en.D": "results/D",
    "en.B": "results/B", "en.mfly": "results/m",
}


def engine() -> list[Table]:
    """Tables 3.4, 3.5, 5.3 and 5.4 and the numbers of the text."""
    tables = []
    for name, columns in ENGINE_TABLES.items():
        table = Table(f"engine_table_{name}", "lugansk/engine", ENGINE)
        tables.append(table)
        for row in rows(table.name):
            for column, entry in columns.items():
                slip = ENGINE_ERRATA.get((name, row["position"], column), {}).get("why", "")
                printed = str(float(row[column]) / 100) if column.startswith("J_reduced") else row[column]
                label = row["position"].split(",")[0]
                if label != "16":
                    table.cells.append(Cell(f"{row['position']} {column}", entry.format(label), printed, slip))
    text = Table("engine_scalars", "lugansk/engine", ENGINE)
    printed = {r["id"]: r["value"] for r in rows("engine_scalars")}
    for key, entry in ENGINE_SCALARS.items():
        text.cells.append(Cell(key, entry, printed[key], ENGINE_ERRATA.get(("scalars", key, "value"), {}).get("why", "")))
    # The figure announces 0.0024 m/mm and was drawn and used with 0.002.
    announced = Table("fig. 4.7 as announced", "lugansk/engine", {**ENGINE, "scheme-crank": 0.0024})
    for key in ("en.arm.h12", "en.arm.h14"):
        announced.cells.append(Cell(key, ENGINE_SCALARS[key], printed[key], "scale factor 0.0024 announced, 0.002 used"))
    return [*tables, text, announced]


# --- gear and cam of manual 000, press of manual 002 ----------------------------------------------------------------------------

GEAR_SLIPS = {("4", "theta1"): "(37 - 19)/37 = 0.49", ("4", "theta2"): "(19 - 37)/19 = -0.95", ("6",
    "theta1"): "(62.5 - 6.5)/62.5 = 0.90"}
GEAR_VALUES = {"r1": "r1", "r2": "r2", "rb1": "rb1", "rb2": "rb2", "rw1": "rw1", "rw2": "rw2", "ra1": "ra1", "ra2": "ra2",
    "rf1": "rf1",
               "rf2": "rf2", "s1": "s1", "s2": "s2", "alpha_w": "alpha_w", "s_chord1": "s_chord1"}


def gear() -> list[Table]:
    """Table 6.1 and the geometry of the example."""
    table = Table("gear_sliding_printed", "lugansk/shaper", {})
    for row in rows("gear_sliding_printed"):
        for column, name in (("yV1_mm", "yV1"), ("yV2_mm", "yV2"), ("theta1", "theta1"), ("theta2", "theta2")):
            if not row[column].startswith("-inf"):
                entry = f"gear-sliding/{row['position']}/{name}"
                table.cells.append(Cell(f"{row['position']} {name}", entry, row[column], GEAR_SLIPS.get((row["position"], name),
                "")))
    geometry = Table("gear_values", "lugansk/shaper", {})
    for row in rows("gear_values"):
        if row["symbol"] in GEAR_VALUES:
            slip = row["note"] if not row["tolerance"] else ""
            geometry.cells.append(Cell(row["symbol"], f"results/{GEAR_VALUES[row['symbol']]}", row["printed"], slip))
    return [table, geometry]


CAM_VALUES = {"e": "e", "S0": "s0", "r0": "r0", "rho_min": "rho_min", "r_p": "r_roller"}


def cams() -> list[Table]:
    """Results of example 1 of the cams."""
    table = Table("cam_example_1", "lugansk/shaper", {})
    for row in rows("cam_example_1"):
        if row["symbol"] in CAM_VALUES:
            slip = row["note"] if not row["tolerance"] else ""
            table.cells.append(Cell(row["symbol"], f"results/{CAM_VALUES[row['symbol']]}", row["printed"], slip))
    return [table]


PRESS_OMEGA = 5 * 3.14159265358979
PRESS = {"velocities": 1.8849 / 70, "positions": 0.0034, "energy": 199.4063 / 180, "work": 56.59}
PRESS_COLUMNS = {
    "pb_mm": ("velocities/{}/pb", 1.0), "ps2_mm": ("velocities/{}/ps2", 1.0), "ab_mm": ("velocities/{}/ab", 1.0),
    "M_F_N_m": ("results/{}/M_Fpc", 1.0), "M_G2_N_m": ("results/{}/M_G2", 1.0),
    "I2_transl_kg_m2": ("results/{}/m2V_S2^2", PRESS_OMEGA**2), "I2_rot_kg_m2": ("results/{}/J_S2omega2^2", PRESS_OMEGA**2),
    "I3_kg_m2": ("results/{}/m3V_B^2", PRESS_OMEGA**2), "I_II_kg_m2": ("results/{}/J_red", 1.0),
    "T_II_J": ("first-energy/{}/y_T2", 180 / 199.4063),
}


def press() -> list[Table]:
    """Tables 1.4 to 1.7 and 1.9 to 1.11 and the flywheel."""
    table = Table("press_positions", "press", PRESS)
    for row in rows("press_positions"):
        wrong = row["errata"].split()
        for column, (entry, times) in PRESS_COLUMNS.items():
            if row["position"] != "k":
                slip = "formula misused" if column in wrong else ""
                printed = row[column] if times == 1 else f"{float(row[column]) * times:.6f}"
                table.cells.append(Cell(f"{row['position']} {column}", entry.format(row["position"]), printed, slip))
    speed = Table("press_omega", "press", PRESS)
    for row in rows("press_omega"):
        slip = "ordinate without its sign" if row["position"] in ("1", "2", "3", "9", "10", "11", "12") else ""
        speed.cells.append(Cell(row["position"], f"results/{row['position']}/omega_I", row["omega_rad_s"], slip))
    scalars = {r["id"]: r for r in rows("press_scalars")}
    for key, entry in (("pr.Md", "results/M_const"), ("pr.ab", "first-energy/ab")):
        speed.cells.append(Cell(key, entry, scalars[key]["value"], scalars[key]["errata"]))
    speed.scales = {**PRESS, "energy": PRESS["work"]}
    return [table, speed]


# --- comparing ------------------------------------------------------------------------------------------------------------------


@cache
def opened(project: str) -> Measurables:
    """Entries of a shipped project; the manual divides the shaper's strokes by its nominal coefficient."""
    nominal = {"cycle.division": "nominal"} if project == "lugansk/shaper" else {}
    return measured(files.project(files.from_file(project), nominal))


def compared(table: Table, folder: Path) -> tuple[list[Outcome], list[Cell]]:
    """Judged cells, and those that have no entry (a force that does not act has no moment)."""
    found = opened(table.project)
    cells = {c.entry: c for c in table.cells if c.entry in found.entries and c.printed not in ("", "-")}
    lines = ["id;измерено", *(f"mu/{key};{mu!r}" for key, mu in table.scales.items())]
    lines += [f"{entry};{cell.printed}" for entry, cell in cells.items()]
    path = folder / "table.csv"
    path.write_text("\n".join(lines), encoding="utf-8")
    filled: FilledTable = read(path, Project(catalogue.read(table.project)), found)
    judged = {j.entry.id: j for j in judge(filled, found, 0.25, 0.5)}
    return [Outcome(cell, judged[entry]) for entry, cell in cells.items()], [c for c in table.cells if c.entry not in found.entries]


def tables() -> list[Table]:
    """All of them."""
    return [*shaper(), *engine(), *gear(), *cams(), *press()]


def is_right(o: Outcome) -> bool:
    """True for a slip that leaves the number right to three digits: the formula gives the same there, or rounding mends it."""
    return abs(o.judged.deviation) <= max(0.005 * abs(o.judged.exact), 1e-9) or abs(o.judged.deviation) < 0.02 * o.judged.tolerance


def main() -> None:
    """Print the counts and every false alarm and miss."""
    from tempfile import TemporaryDirectory

    every: list[Outcome] = []
    with TemporaryDirectory() as folder:
        for table in tables():
            outcomes, without = compared(table, Path(folder))
            every += outcomes
            print(f"{table.name}: {count(outcomes)}; {len(without)} cells without an entry")
            for o in outcomes:
                j, slip = o.judged, o.cell.slip
                if (j.verdict == "green") == bool(slip):
                    title = "missed" if slip else j.verdict
                    said = "; ".join(filter(None, ("follows" if j.follows else "", slip, j.remark)))
                    print(f"  {title}: {o.cell.place}: {j.line.value:g} for {j.exact:.5g} {j.entry.unit}, {j.deviation:+.3g} is "
                          f"{abs(j.deviation) / j.tolerance:.2f} tolerances; {said}")
    print(f"together: {count(every)}")


def count(outcomes: list[Outcome]) -> dict[str, int]:
    """Numbers of clean cells by verdict, of slips found, missed as within a pencil's reach, and missed as right all the same."""
    clean = [o.judged for o in outcomes if not o.cell.slip]
    slips = [o for o in outcomes if o.cell.slip]
    missed = [o for o in slips if o.judged.verdict == "green"]
    return {
        "clean": len(clean), "amber": sum(j.verdict == "amber" for j in clean), "red": sum(j.verdict == "red" for j in clean),
        "of these following": sum(j.verdict == "red" and j.follows is not None for j in clean), "slips": len(slips),
        "found": len(slips) - len(missed), "within reach": sum(not is_right(o) for o in missed),
        "right": sum(map(is_right, missed)),
    }


if __name__ == "__main__":
    main()
