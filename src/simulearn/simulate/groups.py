"""Whether prints of one design come to one shape that varies, or to several apart from each other.

A grid near a snap, or one that may curl either of two sides, comes to another shape in a part of
its prints: a mean and a standard deviation then describe none of them. Prints are joined to the
nearest others; where the last joints are far longer than usual, what they join are groups (single
linkage: P. Sneath, J. Gen. Microbiology 17, 201, 1957).
"""

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.hierarchy import fcluster, linkage

APART = 0.05  # of the dimension, root mean square distance of the joints between two groups
USUAL = 5.0  # times the median distance of a print from those it is joined to
SHARE, FEWEST = 0.05, 3  # of the prints, and prints, that make a group; else they are outliers


def groups_of(centres: NDArray[np.float64], dimension: float) -> tuple[int, ...]:
    """Return how many prints each group of shapes has, the largest first; () if all are one group.

    Args:
        centres: (T, J, 3) of the joints in each print, mm.
        dimension: of the grid, mm.
    """
    count, joints = centres.shape[:2]
    if count < 2 * FEWEST:
        return ()
    tree = linkage(centres.reshape(count, -1) / np.sqrt(joints), "single")
    gap = max(APART * dimension, USUAL * float(np.median(tree[:, 2])))
    sizes = np.bincount(fcluster(tree, gap, "distance"))
    large = np.sort(sizes[sizes >= max(FEWEST, SHARE * count)])[::-1]
    return tuple(large.tolist()) if len(large) > 1 else ()
