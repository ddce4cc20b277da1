"""A scan on its simulation: cleared of all else, in its pose, each joint by its neighbourhood."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from simulearn.compare.aligning import MIRRORED, Pose, ambiguous, mirrored, rigid, rms
from simulearn.compare.clutter import without_strays, without_table
from simulearn.compare.fitting import Found, fitted
from simulearn.compare.measurement import Numbers, Scan
from simulearn.compare.registering import registered
from simulearn.compare.simulated import Stations, Surface, stations_of, surface_of
from simulearn.errors import Cancel, InputError, Message
from simulearn.simulate import Result

FEWEST_POINTS = 1500  # of a scan
FEWEST_JOINTS = 4
SHARE = 0.4  # of the joints that must be found
TRIED = 4  # poses whose joints are fitted
DOUBTFUL = 0.02  # of the dimension, residual from which a scan may be mirrored
EQUAL, FLOOR = 1.1, 0.1  # times and mm: residuals that are as good
REACH = 10.0  # mm, from the middle of a bar to what belongs to it, with some room
BEYOND = 0.1  # of the points that belong to nothing that was found
SHOWN = 20_000  # points kept for pictures


@dataclass(frozen=True, eq=False)
class PlacedScan:
    """What a scan says, in the frame of the simulation.

    Attributes:
        joints: (J, 3) mm, NaN where a joint was not found.
        stations: (B, 3, 3) places along the beams, NaN where none was found.
        noise: mm, roughness of the scan about the fitted patches.
        points: (N, 3) some points of the scan.
        messages: what is to be known about the scan and its pose.
    """

    joints: Numbers
    stations: Numbers
    noise: float
    points: Numbers
    messages: tuple[Message, ...]


@dataclass(frozen=True, eq=False)
class _Laid:
    """A pose, the stations found in it, and the residual of the joints."""

    pose: Pose
    found: Found
    residual: float
    lost: int


def place_scan(
    scan: Scan, result: Result, width: float, cancel: Cancel | None = None
) -> PlacedScan:
    """Return the joints and beams of a scan, brought onto the simulation.

    Args:
        scan: in mm.
        result: the simulation.
        width: of the beams, mm.
        cancel: stops the work.

    Raises:
        InputError: the scan has too few points, or does not fit the grid.
        CancelledError: the token was set.
    """
    if len(scan.points) < FEWEST_POINTS:
        text = f"the scan has {len(scan.points)} points; at least {FEWEST_POINTS} are needed"
        raise InputError(text, "scan-few", "measurement")
    scan, strays = without_strays(scan)
    scan, table = without_table(scan, result.grid, width)
    if len(scan.points) < FEWEST_POINTS:
        text = f"the scan has {len(scan.points)} points besides its table"
        raise InputError(f"{text}; at least {FEWEST_POINTS} are needed", "scan-few", "measurement")
    surface, stations = surface_of(result), stations_of(result)
    ends = result.grid.joints[result.grid.beams]
    beam = float(np.median(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)))
    many = len(result.grid.joints)

    def best_poses(mirror: bool) -> list[_Laid]:
        fits = registered(scan.points, surface.points, beam, mirror, cancel)[:TRIED]
        every = [_laid(scan, fit.pose, surface, stations, many, cancel) for fit in fits]
        return sorted((one for one in every if one is not None), key=_quality)

    laid = best_poses(mirror=False)
    if not laid or laid[0].residual > DOUBTFUL * result.grid.dimension:
        other = best_poses(mirror=True)
        if other and (not laid or other[0].residual * MIRRORED < laid[0].residual):
            laid = other
    if not laid:
        text = (
            "the scan does not fit the grid: hardly any of its joints are found near to where they "
            "are simulated; it may be another grid, or mostly something else"
        )
        raise InputError(text, "measurement-other", "measurement")
    best = laid[0]
    messages = [*strays, *table]
    as_good = [
        one
        for one in laid
        if one.lost <= best.lost + 1 and one.residual <= EQUAL * best.residual + FLOOR
    ]
    if len(as_good) > 1:
        messages.append(ambiguous(len(as_good), "poses"))
    if best.pose.mirrored:
        messages.append(mirrored())
    messages += _beyond(best, scan, stations)
    places = best.found.places.copy()
    places[~best.found.seen] = np.nan
    step = max(1, len(scan.points) // SHOWN)
    return PlacedScan(
        joints=places[:many],
        stations=places[many:].reshape(-1, 3, 3),
        noise=float(np.median(best.found.residual[best.found.seen])),
        points=best.pose(scan.points[::step]),
        messages=tuple(messages),
    )


def _laid(
    scan: Scan, pose: Pose, surface: Surface, stations: Stations, many: int, cancel: Cancel | None
) -> _Laid | None:
    """Return a pose by the joints found in it, None where too few are."""
    normals = scan.normals
    if normals is not None:
        normals = _outwards(scan.points, normals @ pose.turn.T, pose, surface)
    found = fitted(Scan(pose(scan.points), normals), surface, stations, cancel)
    seen = found.seen[:many]
    if seen.sum() < max(FEWEST_JOINTS, SHARE * many):
        return None
    simulated = stations.centres[:many][seen]
    better = rigid(found.places[:many][seen], simulated)
    found = Found(
        better.turn @ found.turns, better(found.places), found.seen, found.residual, found.count
    )
    residual = rms(found.places[:many][seen], simulated)
    return _Laid(better.after(pose), found, residual, int((~found.seen).sum()))


def _beyond(best: _Laid, scan: Scan, stations: Stations) -> list[Message]:
    """Return a warning where much of a scan lies at no joint and no beam that was found."""
    apart = stations.centres[stations.links]
    reach = 0.75 * float(np.linalg.norm(apart[:, 1] - apart[:, 0], axis=1).max()) + REACH
    away, _ = KDTree(best.found.places[best.found.seen]).query(best.pose(scan.points))
    share = float((away > reach).mean())
    if share < BEYOND:
        return []
    text = (
        f"{share:.0%} of the points lie at no joint and no beam that was found; it may be another "
        "grid, or there is something besides it in the scan"
    )
    return [Message("scan-beyond", "measurement", text)]


def _quality(one: _Laid) -> tuple[float, float]:
    return one.residual + 0.2 * one.lost, one.residual


def _outwards(points: Numbers, normals: Numbers, pose: Pose, surface: Surface) -> Numbers:
    """Return the normals of a scan, turned round where most of them point into the body."""
    few = slice(None, None, max(1, len(points) // 3000))
    away, near = KDTree(surface.points).query(pose(points[few]))
    close = away < 2 * np.quantile(away, 0.3)
    agree = (normals[few] * surface.normals[near]).sum(axis=1)[close]
    return -normals if np.median(agree) < 0 else normals
