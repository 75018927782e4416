"""The protocol in three languages: the same steps and numbers, whole sentences, each in its own letters."""

import json
import re
from pathlib import Path

import pytest

from tests.catalogues import read
from tmm_sheets import catalogue, protocols, results, words
from tmm_sheets.compare.measured import collecting
from tmm_sheets.construction.protocol import letter_of, sentence
from tmm_sheets.construction.rules import ALONG, GIVEN, GIVEN_DIRECTION, LINE_LINE
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.scale import times
from tmm_sheets.project import Project
from tmm_sheets.record import recording

PROJECTS = ("lugansk/shaper", "lugansk/engine", "press", "lugansk/cam_flat", "lugansk/cam_rocker", "sixbar/4:2",
            "transport/crusher@12-СДМ-1908")
CYRILLIC = re.compile("[\u0400-\u04ff]+")
RUSSIAN_ONLY = re.compile("[ыэъё]", re.IGNORECASE)
NUMBER = re.compile(r"\d+(?:[.,]\d+)?")


def told(name):
    """Lines of the protocol in each language, without the scale factors behind the titles: those are words of the sheets."""
    found = {}
    for language in words.LANGUAGES:
        with words.on_paper(language):
            found[language] = [line.split("; μ_")[0] for line in protocols.lines(Project(catalogue.read(name)), None)]
    return found


@pytest.fixture(scope="module", params=PROJECTS)
def protocol(request):
    return told(request.param)


def own_names(name="transport/crusher@12-СДМ-1908"):
    """Letters that project files give to forces."""
    return {f.name for n in (*PROJECTS, name) for f in Project(catalogue.read(n)).variant.forces}


def test_every_language_tells_the_same_steps(protocol):
    steps = {language: [re.match(r" *\d+\.|", line)[0] for line in lines] for language, lines in protocol.items()}
    assert steps["en"] == steps["uk"] == steps["ru"]


def test_every_language_has_the_same_numbers(protocol):
    """The order of words is a language's own, its numbers are not; only the decimal sign differs."""

    def numbers(line):
        return sorted(NUMBER.findall(line.replace(",", ".")))

    differing = [(ru, line) for language in ("en", "uk") for ru, line in zip(protocol["ru"], protocol[language], strict=True)
                 if numbers(ru) != numbers(line)]
    assert differing == []


def test_english_has_no_cyrillic_but_names_of_forces(protocol):
    left = {word for line in protocol["en"] for word in CYRILLIC.findall(line)}
    assert left <= {word for name in own_names() for word in CYRILLIC.findall(name)}
