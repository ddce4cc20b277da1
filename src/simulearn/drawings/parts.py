"""Which of many things hang together, by the pairs that do.

SciPy has this, too; importing it takes as long as reading and mending 3,000 lines.
"""

import numpy as np
from numpy.typing import NDArray

Indices = NDArray[np.int64]


def parts(count: int, a: Indices, b: Indices) -> Indices:
    """Return for each thing the least number in its part (count,).

    Args:
        count: of the things, numbered from 0.
        a: (n,) things.
        b: (n,) those that hang together with them.
    """
    least = np.arange(count)
    while (apart := least[a] != least[b]).any():
        a, b = a[apart], b[apart]
        low, high = np.minimum(least[a], least[b]), np.maximum(least[a], least[b])
        np.minimum.at(least, high, low)
        while (further := least[least] != least).any():
            least[further] = least[least[further]]
    return least
