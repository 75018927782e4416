"""What the page says, by the keys under which its modules ask for it, in the language of the sheets."""

from __future__ import annotations

from tmm_sheets.words import tr


def page_words() -> dict[str, str]:
    """Texts by their keys."""
    return {
        "a turn in {s} s": tr("a turn in {s} s"),
        "and {n} more": tr("and {n} more"),
        "angles": tr("Angles"),
        "back": tr("← Back"),
        "by the flywheel": tr("How unevenly the crank runs comes from the flywheel, which this page does not compute: with other "
                              "numbers there are no accelerations and forces here. Save the file and solve it."),
        "click a line": tr("Click a line, a point or a letter: the step that made it, what it is made of, why."),
        "crank angle": tr("Crank angle"),
        "crank pin: drag it round": tr("Crank pin: drag it round"),
        "does not assemble at this angle": tr("The mechanism does not assemble at this angle"),
        "drag the crank pin or a slider": tr("Drag the crank pin round, or a slider: all plans follow."),
        "fixed points": tr("Fixed points"),
        "find": tr("Find a step or a result"),
        "from it follow": tr("From it follow"),
        "gap": tr("gap"),
        "given": tr("given"),
        "how to": tr("How the sheet was drawn"),
        "in motion": tr("In motion"),
        "keys": tr("Keys"),
        "lengths": tr("Lengths"),
        "list of keys": tr("Space: play or pause\n← →: a step, or a degree\nHome, End: beginning, end\n"
                           "+ −: zoom, 0: the whole sheet\nEsc: leave a step\nCtrl+Z: undo"),
        "loads": tr("Loads"),
        "made of": tr("Made of"),
        "masses": tr("Masses and moments of inertia"),
        "pause": tr("Pause"),
        "play": tr("Play"),
        "play it": tr("Press ▶ to see each line drawn as a hand draws it."),
        "position {label}": tr("position {label}"),
        "redo": tr("Redo"),
        "reset": tr("Reset"),
        "save as project file": tr("Save as project file"),
        "sheet {n}": tr("Sheet {n}"),
        "speed": tr("Speed"),
        "speeds": tr("Speeds"),
        "step": tr("Next step"),
        "step back": tr("Step back"),
        "steps": tr("Steps"),
        "the whole sheet": tr("The whole sheet"),
        "turn the crank": tr("In motion: turn the crank, change lengths and masses; the plans follow."),
        "turn the crank on the sheet": tr("Turn the crank: markers follow on the diagrams"),
        "undo": tr("Undo"),
        "velocities": tr("Velocities"),
        "views of this sheet": tr("Views of this sheet"),
        "what is played": tr("What is played"),
        "whole sheet": tr("Whole sheet"),
        "why: back to the givens": tr("Why: back to the givens"),
        "zoom in": tr("Zoom in"),
        "zoom out": tr("Zoom out"),
    }
