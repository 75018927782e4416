"""How fast the page is: ``python -m tests.page.load [--people 20] [--seconds 60] [--project lugansk/shaper] [--pause 10]``.

First one person changes a length, several times: when are the mistakes, the first sheet and the last one there? Then many people
work for a while: each drags a slider, which costs the server nothing, and lets it go; then the file is checked and the sheet that
is looked at is drawn; the others and the remarks come behind it as far as they can until the next change, which drops them; some
take a PDF. An answer is a request from its first byte to its last; those behind are told apart.
"""

import argparse
import asyncio
import json
import os
import random
import re
import subprocess
import sys
import tempfile
from contextlib import suppress
from time import monotonic

import httpx

from tmm_sheets import catalogue, kept

LENGTH = re.compile(r'(?m)^(length|a|r) = "([\d.]+) (m|mm)"')
PDF = 0.05
"""Share of changes after which somebody takes a PDF."""


class Person:
    """Somebody at a browser."""

    def __init__(self, client, text, sheets, seed):
        self.client, self.text, self.sheets, self.random = client, text, sheets, random.Random(seed)
        self.answers, self.errors = {}, []

    async def ask(self, door, kind, **fields):
        """Ask for work and take its time, s."""
        begin = monotonic()
        answer = await self.client.post(door, files={key: (None, str(value)) for key, value in fields.items()})
        took = monotonic() - begin
        last = json.loads(answer.text.splitlines()[-1]) if answer.status_code == 200 else {"problem": answer.status_code}
        self.answers.setdefault(kind, []).append(took)
        if "done" not in last or "mistakes" in last["done"]:
            self.errors.append((door, last))
        return took

    def change(self):
        """Change a length: what is waited for, the check and the sheet that is looked at, and the sheets behind it."""
        text = LENGTH.sub(lambda m: f'{m[1]} = "{float(m[2]) * self.random.uniform(0.995, 1.005):.6f} {m[3]}"', self.text, count=1)
        first, *others = self.random.sample(self.sheets, len(self.sheets))
        front = [self.ask("check", "check", text=text), self.ask("sheet", "sheet", text=text, sheet=first)]
        behind = [self.ask("sheet", "behind", text=text, sheet=n, behind="1") for n in others]
        behind.append(self.ask("remarks", "behind", text=text))
        return [asyncio.ensure_future(one) for one in front], [asyncio.ensure_future(one) for one in behind]

    async def work(self, seconds, pause):
        """Drag and build for a while."""
        end = monotonic() + seconds
        await asyncio.sleep(self.random.uniform(0, pause))
        while monotonic() < end:
            front, behind = self.change()
            await asyncio.gather(*front)
            if self.random.random() < PDF:
                await self.ask("take", "take", text=self.text, wanted="pdf")
            await asyncio.sleep(self.random.uniform(0.5, 1.5) * pause)
            for one in behind:
                one.cancel()
            await asyncio.gather(*behind, return_exceptions=True)


def share(times, percent):
    """What so many of a hundred are within."""
    return sorted(times)[min(int(percent / 100 * len(times)), len(times) - 1)]


async def measure(address, text, sheets, asked):
    """The figures, a line each."""
    host = "/".join(address.split("/")[:3])
    limits = httpx.Limits(max_connections=None)
    async with httpx.AsyncClient(base_url=address, timeout=300, headers={"origin": host}, limits=limits) as client:
        alone, times = Person(client, text, sheets, 0), []
        for _ in range(8):
            front, behind = alone.change()
            checked, first = await asyncio.gather(*front)
            times.append((checked, first, max(await asyncio.gather(*behind), default=first)))
        middle, least = ([pick(column) for column in zip(*times[1:], strict=True)] for pick in (lambda c: share(c, 50), min))
        print(f"one person: checked {middle[0]:.2f} s, sheet looked at {middle[1]:.2f} s, last sheet {middle[2]:.2f} s "
              f"(median of {len(times) - 1}; least {least[0]:.2f}, {least[1]:.2f}, {least[2]:.2f})", flush=True)
        people = [Person(client, text, sheets, seed) for seed in range(1, asked.people + 1)]
        await asyncio.gather(*(p.work(asked.seconds, asked.pause) for p in people))
    errors = [error for p in people for error in p.errors]
    print(f"{asked.people} people, {asked.seconds:g} s, a change in {asked.pause:g} s each: {len(errors)} errors")
    for kind in ("check", "sheet", "take", "behind"):
        if found := [took for p in people for took in p.answers.get(kind, ())]:
            print(f"  {kind}: {len(found)} answers, " + ", ".join(f"{s} % within {share(found, s):.2f} s" for s in (50, 95, 99)))
    for error in errors[:5]:
        print(error)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--people", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--project", default="lugansk/shaper")
    parser.add_argument("--pause", type=float, default=10, help="seconds that somebody drags between two changes, in the mean")
    asked = parser.parse_args()
    variant = catalogue.read(asked.project)
    with tempfile.TemporaryDirectory() as folder:
        os.environ[kept.FOLDER] = folder
        command = [sys.executable, "-m", "tmm_sheets", "serve", "--no-browser"]
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as process:
            try:
                address = process.stdout.readline().strip()
                asyncio.run(measure(address, variant.text, range(1, len(variant.sheets) + 1), asked))
            finally:
                with suppress(ProcessLookupError):
                    process.terminate()


if __name__ == "__main__":
    main()
