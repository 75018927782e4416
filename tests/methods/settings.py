"""How random mechanisms are tried: many bad draws are filtered out on purpose."""

from itertools import product

import pytest
from hypothesis import HealthCheck, Phase, settings

from tests.few import seldom

ALONE = [(kind,) for kind in range(1, 6)]
CHAINS = list(product(range(1, 6), repeat=2))

every_kind = pytest.mark.parametrize(
    "kinds", ALONE + [kinds if n % 3 == 0 else seldom(kinds) for n, kinds in enumerate(CHAINS)],
    ids=lambda kinds: "-".join(map(str, kinds)))
"""Every kind of group alone, and every chain of two."""

kinds_alone = pytest.mark.parametrize("kinds", ALONE, ids=lambda kinds: str(kinds[0]))


def tried(kinds):
    """As many draws of a kind as of the chains it leads, so that all kinds are tried alike."""
    return settings(max_examples=20 if len(kinds) == 1 else 5, phases=[Phase.explicit, Phase.generate, Phase.shrink],
                    suppress_health_check=[HealthCheck.filter_too_much, HealthCheck.too_slow])
