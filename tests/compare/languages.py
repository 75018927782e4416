"""A command in each language of the reader, as in a process of its own."""

from contextlib import contextmanager, redirect_stderr, redirect_stdout
from contextvars import copy_context
from io import StringIO

import pytest

from tmm_sheets import words
from tmm_sheets.__main__ import run


@contextmanager
def to_reader(language):
    """The reader's language meanwhile."""
    before = words.reader()
    words.set_reader(language)
    try:
        yield
    finally:
        words.set_reader(before)


def told(language, *arguments):
    """Status, output and messages of a command for somebody whose locale is of this language."""
    out, err = StringIO(), StringIO()
    with pytest.MonkeyPatch.context() as environment, redirect_stdout(out), redirect_stderr(err):
        environment.setenv("LANGUAGE", language)
        status = copy_context().run(run, [str(a) for a in arguments])
    return status, out.getvalue(), err.getvalue()
