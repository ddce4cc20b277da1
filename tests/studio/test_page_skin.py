"""The surface that the page draws is that of the library."""

import base64
import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

import synthetic
from simulearn.grid import drop_beams, grid_to_dict
from simulearn.interop import frames
from simulearn.simulate import skin

SCRIPT = Path(__file__).parent / "page" / "skins.mjs"
SPACING = 4.0  # mm
FRAMES = [0, 6, 11]
MOST = 120  # seconds for node, on a busy machine
BEAM, JOINT, FIXED, TOP, BOTTOM = range(5)  # tones of the page


@pytest.fixture
def drawn(node):
    """Return a function that measures the page's surface of a result in some frames."""

    def measures(result):
        question = {
            "spacing": SPACING,
            "frames": FRAMES,
            "grid": grid_to_dict(result.grid),
            "message": base64.b64encode(frames.to_bytes([result.grid], [result])).decode(),
        }
        done = subprocess.run(
            [node, str(SCRIPT)],
            input=json.dumps(question),
            capture_output=True,
            text=True,
            check=False,
            timeout=MOST,
        )
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    return measures


def results():
    """Yield results without a solid, which the page has not either."""
    yield synthetic.result(solid=False)
    yield synthetic.result(bend=synthetic.cylinder, solid=False)
    yield synthetic.result(drop_beams(synthetic.square_grid((3, 2)), {5, 9}), solid=False)
    ratios = [(-1.0, -0.5, 0.0, 0.75)[k % 4] for k in range(12)]
    yield synthetic.result(synthetic.square_grid(actuators=ratios), solid=False)


def area(surface, frame, chosen):
    corners = surface.vertices[frame][surface.quads[chosen]]
    vectors = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]) / 2
    return np.linalg.norm(vectors, axis=1).sum()


def test_bounds_volume_and_areas_are_those_of_the_library(drawn):
    for result in results():
        surface = skin(result, spacing=SPACING)
        for frame, page in zip(FRAMES, drawn(result), strict=True):
            vertices = surface.vertices[frame]
            # The page has a station more, in the middle of the beams, and single precision.
            np.testing.assert_allclose(page["low"], vertices.min(axis=0), atol=0.01)
            np.testing.assert_allclose(page["high"], vertices.max(axis=0), atol=0.01)
            corners = vertices[surface.quads]
            vectors = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]) / 2
            volume = np.einsum("qd,qd->", corners.mean(axis=1), vectors) / 3
            assert page["volume"] == pytest.approx(volume, rel=2e-3)
            np.testing.assert_allclose(page["vector"], vectors.sum(axis=0), atol=0.05)
            joint, ratio = surface.joint, surface.ratio
            fixed = result.grid.fixed
            kinds = {
                BEAM: (joint < 0) & (ratio == 0),
                JOINT: (joint >= 0) & (joint != fixed),
                FIXED: joint == fixed,
                TOP: ratio > 0,
                BOTTOM: ratio < 0,
            }
            for tone, chosen in kinds.items():
                assert page["areas"][tone] == pytest.approx(area(surface, frame, chosen), rel=5e-3)


def test_normals_look_outwards(drawn):
    for result in results():
        assert min(page["facing"] for page in drawn(result)) > 0.9
