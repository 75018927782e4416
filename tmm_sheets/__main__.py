"""Entry of the command line: exit status and messages; ``tmm-sheets`` and ``python -m tmm_sheets``."""

from __future__ import annotations

import gc
import os
import signal
import sys
from typing import NoReturn

from tmm_sheets import terminal

DONE, CANNOT_BUILD, BAD_INPUT = 0, 1, 2
BY_SIGNAL, BROKEN_PIPE = 128, 141
"""As a shell reports programs ended by a signal, whose number is added to the first, and by SIGPIPE."""


def main() -> NoReturn:
    """Run the command line and leave with its exit status."""
    # The arrays here are short: threads of the linear algebra library would only cost start-up time and memory.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    os.environ.setdefault("OPENCV_IO_MAX_IMAGE_PIXELS", "400000000")  # of formats whose size nobody else can tell beforehand
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")  # or it looks for some in every package that is installed
    terminal.settle()
    for name in ("SIGTERM", "SIGHUP"):  # what is half-written is cleaned up, as after Ctrl-C; nohup stays nohup
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) == signal.SIG_DFL:
            signal.signal(number, _stop)
    # Nearly all that is made here lives to the end: searching it for garbage every 700 objects costs a tenth of the time.
    gc.set_threshold(200_000)
    sys.exit(_flushed(run(sys.argv[1:])))


def _stop(number: int, _: object) -> None:
    from tmm_sheets.errors import Stopped

    raise Stopped(number)


def _flushed(status: int) -> int:
    """Exit status after the last output has left; a reader that went away or a full disk shows only here."""
    try:
        sys.stdout.flush()
        return status
    except BrokenPipeError:
        status = BROKEN_PIPE
    except OSError as e:
        from tmm_sheets.errors import reason_of
        from tmm_sheets.words import tell

        status = _say(tell("output cannot be written: {why}").format(why=reason_of(e)), BAD_INPUT)
    terminal.drop(sys.stdout)
    return status


def run(arguments: list[str]) -> int:
    """Run the commands with these arguments; messages go to stderr, the exit status comes back."""
    from contextvars import copy_context

    return copy_context().run(_run, arguments)  # the languages it sets are its own


def _run(arguments: list[str]) -> int:
    from tmm_sheets import cli

    with cli.chosen(arguments):
        return _carried_out(arguments)


def _carried_out(arguments: list[str]) -> int:
    import click

    from tmm_sheets.errors import BadInput, CannotBuild, Stopped, reason_of
    from tmm_sheets.words import tell

    asked = os.environ.get("_TMM_SHEETS_COMPLETE")
    if asked:  # by a shell, see completion.py
        from tmm_sheets import completion
        from tmm_sheets.cli import commands

        return completion.answer(commands, asked)
    try:
        _invoke(arguments)
        return DONE
    except click.exceptions.Exit as e:
        return e.exit_code
    except click.ClickException as e:
        e.show(file=sys.stderr)
        return BAD_INPUT
    except BadInput as e:
        return _say(str(e), BAD_INPUT)
    except CannotBuild as e:
        return _say(str(e), CANNOT_BUILD)
    except (KeyboardInterrupt, click.Abort) as e:
        return BY_SIGNAL + int(e.number if isinstance(e, Stopped) else signal.SIGINT)
    except BrokenPipeError:
        return BROKEN_PIPE  # main() quiets the buffer
    except OSError as e:
        why = reason_of(e)
        if e.filename:
            return _say(f"{e.filename}: {why}", BAD_INPUT)
        terminal.drop(sys.stdout)  # or the last flush would say it again
        return _say(tell("output cannot be written: {why}").format(why=why), BAD_INPUT)
    except MemoryError:
        return _say(tell("not enough memory; ask for fewer positions"), CANNOT_BUILD)
    except Exception as e:
        from pathlib import Path

        from tmm_sheets import defects

        given = next(filter(os.path.isfile, arguments), None)
        said = defects.told(e, arguments, None if given is None else Path(given),
                            lambda path: _invoke([str(path) if word == given else word for word in arguments]))
        hint = tell("this is a defect of the program; TMM_SHEETS_TRACEBACK=1 shows where it happened")
        return _say(f"{said}\n    {hint}", CANNOT_BUILD)


def _invoke(arguments: list[str]) -> None:
    from tmm_sheets.cli import commands

    # Not commands.main(): that ends the program by itself and with other statuses on Ctrl-C and closed pipes.
    with commands.make_context("tmm-sheets", [*arguments]) as context:
        commands.invoke(context)


def _say(message: str, status: int) -> int:
    print(message, file=sys.stderr)
    return status


if __name__ == "__main__":
    main()
