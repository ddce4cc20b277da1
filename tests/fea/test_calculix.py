"""CalculiX against closed forms: what it is given, what it gives back, and how it fails."""

import os
import shutil
import stat
import threading
from pathlib import Path

import numpy as np
import pytest
from skfem import Basis, ElementHexS2, MeshHex

from requiring import required
from simulearn.errors import CancelledError, ComputationError, InputError
from simulearn.fea import THREE_ACROSS, Solid, simulate_grid
from simulearn.fea.calculix import calculix
from simulearn.fea.calculix import simulate_grid as simulate_by_calculix
from simulearn.fea.calculix.brick import ORDER, POINTS, bricks, matching
from simulearn.fea.calculix.growth import initial_strain, orthotropic
from simulearn.fea.calculix.moduli import moduli_of
from simulearn.fea.calculix.output import last_error, read_dat
from simulearn.fea.calculix.run import Kind
from simulearn.fea.calculix.schedule import schedule
from simulearn.fea.kernels import checks
from simulearn.fea.laws import law_of
from simulearn.grid import Grid, make
from simulearn.material import ElasticData, Material, load_material

SVK = "st-venant-kirchhoff"
WEIGHT = 2e-6  # N/mm3


@pytest.fixture
def ccx() -> None:
    required("calculix", shutil.which("ccx") is not None)


def material(poisson: float = 0.3, modulus: float = 2.0, weight: float = 0.0) -> Material:
    pla = load_material("pla-hot-water")
    gravity = pla.gravity.model_copy(update={"acceleration": weight / pla.gravity.density})
    law = ElasticData(kind=SVK, poisson=poisson, modulus=modulus)
    return pla.model_copy(update={"law": law, "gravity": gravity})


def bar(
    growth: np.ndarray,
    length: float = 20.0,
    slabs: int = 6,
    height: float = 2.0,
    width: float = 2.0,
    turn: float = 0.0,
) -> Solid:
    """A bar along a direction `turn` from +x, its start held, its layers with a growth each."""
    layers = len(growth)
    mesh = MeshHex.init_tensor(
        np.linspace(0, length, slabs + 1),
        np.array([-width / 2, width / 2]),
        np.linspace(-height / 2, height / 2, layers + 1),
    )
    basis = Basis(mesh, ElementHexS2(), intorder=3)
    nodes = basis.doflocs.T * [-1, 1, 1] + [length, 0, 0]  # scikit-fem's boxes are left-handed
    elements = basis.element_dofs.T
    layer = (
        np.searchsorted(np.linspace(-height / 2, height / 2, layers + 1), mid(nodes, elements)) - 1
    )
    rotation = np.array(
        [[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]]
    )
    points, weights = basis.quadrature
    return Solid(
        nodes=np.ascontiguousarray(nodes @ rotation.T),
        bricks=elements.astype(np.int64),
        parts=np.zeros((len(elements), 2), dtype=np.int64),
        slabs=slabs,
        points=points,
        weights=weights,
        joint_points=points,
        joint_weights=weights,
        angle=np.full(len(elements), turn),
        growth=np.repeat(np.asarray(growth, float)[layer][:, None], points.shape[1], axis=1),
        stress=np.zeros((len(elements), points.shape[1], 3)),
        fixed=np.flatnonzero(abs(nodes[:, 0]) < 1e-9),
        joints=np.zeros((0, 8), dtype=np.int64),
        beams=np.zeros((0, 3, 4), dtype=np.int64),
        samples=np.zeros((0, 4, 4, 8), dtype=np.int64),
        shares=np.zeros((0, 4, 4, 8)),
    )


def mid(nodes: np.ndarray, elements: np.ndarray) -> np.ndarray:
    return nodes[elements].mean(axis=1)[:, 2]


def with_(solid: Solid, **changes: object) -> Solid:
    return Solid(**{**vars(solid), **changes})  # type: ignore[arg-type]


def tensor(six: np.ndarray) -> np.ndarray:
    a, b, c, d, e, f = six
    return np.array([[a, d, e], [d, b, f], [e, f, c]])


def held(solid: Solid) -> tuple[Solid, int]:
    """Hold every node but those of the end face; return the first brick too, which is all held."""
    along = np.linalg.norm(solid.nodes[:, :2], axis=1)
    first = int(np.argmin(along[solid.bricks].mean(axis=1)))
    return with_(solid, fixed=np.flatnonzero(along < 0.9 * along.max())), first


# What needs no ccx


def test_every_node_of_a_brick_is_one_of_ours() -> None:
    assert sorted(ORDER) == list(range(20))
    assert (ElementHexS2.doflocs[ORDER[8]] == [0.5, 0, 0]).all()
    assert (ElementHexS2.doflocs[ORDER[16]] == [0, 0, 0.5]).all()


def test_a_brick_inside_out_is_refused() -> None:
    solid = bar(np.zeros((1, 3)), slabs=2)
    with pytest.raises(ComputationError, match="brick 0 is inside out"):
        bricks(solid.nodes * [1, 1, -1], solid.bricks)


def test_integration_points_are_matched_by_place() -> None:
    solid = bar(np.zeros((1, 3)), slabs=1)
    assert np.allclose(POINTS[matching(solid.points)].T, solid.points)
    with pytest.raises(InputError, match="at 8 points and not at these 12"):
        matching(np.full((3, 12), 0.5))


def test_orthotropic_constants_are_the_law_of_the_grown_volume() -> None:
    """S = D~ : (E - E0) is J_g F_g^-1 [D : E_e] F_g^-1 with F_e = F F_g^-1, for any F."""
    rng = np.random.default_rng(0)
    law = ElasticData(kind=SVK, poisson=0.406, modulus=2.2)
    growth, s, angle = np.array([-0.09, 0.04, 0.03]), 0.7, 0.6
    F = np.eye(3) + rng.normal(size=(3, 3)) / 10
    Q = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    inverse = Q @ np.diag(1 / (1 + s * growth)) @ Q.T
    Ee = ((F @ inverse).T @ F @ inverse - np.eye(3)) / 2
    shear = 2.2 / 2 / 1.406
    lame = 2.2 * 0.406 / 1.406 / (1 - 0.812)
    elastic = lame * np.trace(Ee) * np.eye(3) + 2 * shear * Ee
    expected = np.prod(1 + s * growth) * inverse @ elastic @ inverse

    E0 = tensor(initial_strain(np.array([angle]), growth[None], s)[0])
    E = Q.T @ ((F.T @ F - np.eye(3)) / 2 - E0) @ Q  # in the printing frame
    D = orthotropic(law, growth, s)
    normal = tensor(D[[0, 2, 5, 1, 3, 4]]) @ np.diag(E)
    S = np.diag(normal) + 2 * tensor(np.r_[0, 0, 0, D[6:]]) * E
    assert np.allclose(Q @ S @ Q.T, expected, atol=1e-14)


@pytest.mark.parametrize("kind", ["marlow", "neo-hookean", SVK])
def test_stress_by_the_energy_is_that_of_the_laws_own_response(kind: str) -> None:
    """S = J_g F_g^-1 (F_e^-1 P) F_g^-1, and D is its derivative."""
    rng = np.random.default_rng(1)
    data = material().law if kind == SVK else load_material("pla-hot-water").law
    if kind == "neo-hookean":
        data = ElasticData(kind="neo-hookean", poisson=0.406, modulus=2.2)
    law = law_of(data)
    F = np.eye(3) + rng.normal(size=(3, 3)) / 20
    stretch, angle = np.array([0.93, 1.03, 1.02]), 0.4
    frame = np.array(
        [[np.cos(angle), np.sin(angle), 0], [-np.sin(angle), np.cos(angle), 0], [0, 0, 1]]
    )
    inverse = frame.T @ np.diag(1 / stretch) @ frame
    Fe = F @ inverse
    P = checks.respond_at(law, Fe[None])[0][0]
    expected = stretch.prod() * inverse @ np.linalg.solve(Fe, P) @ inverse

    E = (F.T @ F - np.eye(3)) / 2
    strain = np.array([E[0, 0], E[1, 1], E[2, 2], 2 * E[0, 1], 2 * E[0, 2], 2 * E[1, 2]])
    moduli = moduli_of(law)

    def at(e: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return moduli(e[None], frame[None], stretch[None])

    S, D = (np.asarray(x)[0] for x in at(strain))
    assert np.allclose(tensor(S), expected, atol=1e-10)
    step = 1e-6 * rng.normal(size=6)
    change = (np.asarray(at(strain + step)[0]) - np.asarray(at(strain - step)[0]))[0] / 2
    assert np.allclose(D @ step, change, atol=1e-4 * abs(change).max())


def test_the_schedule_ends_in_eleven_frames() -> None:
    data = material(weight=WEIGHT)
    for parts in (1, 2):
        steps = schedule(data, parts)
        assert [step.frame for step in steps if step.frame is not None] == list(range(1, 12))
        assert [step.release for step in steps if step.frame][:3] == [0.1, 0.2, 0.3]
        assert steps[-1].load == pytest.approx(WEIGHT * (1 + data.creep.amplitude))


# Closed forms


@pytest.mark.usefixtures("ccx")
def test_growth_that_is_held_stresses_as_the_law_says() -> None:
    """A brick whose nodes are all held has F = I and F_e = F_g^-1."""
    growth, turn = np.array([-0.1, 0.04, 0.03]), 0.5
    solid = bar(growth[None], slabs=2, turn=turn)
    solid, first = held(solid)
    result = calculix(solid, material(poisson=0.406, modulus=2.2))
    Q = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    for frame in (1, 10):
        g = 1 + frame / 10 * growth
        Ee = (g**-2.0 - 1) / 2
        elastic = 2.2 * 0.406 / 1.406 / (1 - 0.812) * Ee.sum() + 2.2 / 1.406 * Ee
        stress = Q @ np.diag(g.prod() * elastic / g**2) @ Q.T
        assert np.allclose(result.stress[frame, first], result.stress[frame, first, :1], atol=1e-7)
        assert np.allclose(tensor(result.stress[frame, first, 0]), stress, rtol=1e-6, atol=1e-7)


@pytest.mark.usefixtures("ccx")
def test_a_bilayer_bends_as_timoshenko_says() -> None:
    """Equal layers, strain difference e: curvature 3 e / 2 h (m = n = 1)."""
    e, h = 0.01, 2.0
    solid = bar(np.array([[-e, 0, 0], [0, 0, 0]]), length=20, slabs=10, height=h)
    result = calculix(solid, material(poisson=0.0))
    x = solid.nodes + result.displacements[10]
    tip = abs(solid.nodes[:, 0] - 20) < 1e-9
    face = x[tip & (abs(solid.nodes[:, 2]) > 0.9)]
    slope = np.ptp(face[:, 0]) / np.ptp(face[:, 2])
    assert np.arctan(slope) / 20 == pytest.approx(1.5 * e / h, rel=0.02)


@pytest.mark.usefixtures("ccx")
def test_a_bilayer_stays_a_circle_however_far_it_turns() -> None:
    """Every slab bends alike: growth turns with the material (thermal expansion would not)."""
    solid = bar(np.array([[-0.09, 0, 0], [0, 0, 0]]), length=40, slabs=10)
    result = calculix(solid, material(poisson=0.0))
    middle = (abs(solid.nodes[:, 2]) < 1e-9) & (abs(solid.nodes[:, 1]) > 0.9)
    middle &= solid.nodes[:, 1] > 0
    order = np.argsort(solid.nodes[middle, 0])
    path = (solid.nodes + result.displacements[10])[middle][order][::2]  # faces of the slabs
    steps = np.diff(path, axis=0)
    angles = np.diff(np.unwrap(np.arctan2(steps[:, 2], steps[:, 0])))
    assert abs(angles.sum()) > 1.5  # it turns by more than 90 degrees in all
    assert np.allclose(angles[2:-2], angles[2:-2].mean(), rtol=2e-3)


@pytest.mark.usefixtures("ccx")
def test_turning_the_design_turns_the_answer() -> None:
    growth = np.array([[-0.06, 0.02, 0.02], [0.02, -0.05, 0.02]])
    results = []
    for turn in (0.0, 0.8):
        solid = bar(growth, slabs=4, turn=turn)
        result = calculix(solid, material(poisson=0.4, weight=WEIGHT))
        c, s = np.cos(turn), np.sin(turn)
        results.append(result.displacements @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]))
    assert abs(results[0]).max() > 1
    assert np.allclose(results[0], results[1], atol=2e-5)  # it prints seven digits


@pytest.mark.usefixtures("ccx")
def test_a_cantilever_sags_as_beam_theory_says_and_creeps_by_its_amplitude() -> None:
    """Small load: w = q L^4 / 8 E I, with shear q L^2 / 2 G (5/6) A; creep adds its amplitude."""
    length, h, width = 20.0, 2.0, 2.0
    solid = bar(np.zeros((2, 3)), length=length, slabs=8)
    weight = 1e-7
    data = material(poisson=0.0, weight=weight)
    result = calculix(solid, data)
    tip = abs(solid.nodes[:, 0] - length) < 1e-9
    area = h * width
    q, inertia = weight * area, width * h**3 / 12
    sag = q * length**4 / (8 * 2.0 * inertia) + q * length**2 / (2 * (5 / 6) * area)
    for frame in (1, 10):
        assert -result.displacements[frame, tip, 2].mean() == pytest.approx(sag, rel=0.01)
    assert result.displacements[11, tip, 2].mean() == pytest.approx(
        result.displacements[10, tip, 2].mean() * (1 + data.creep.amplitude), rel=1e-3
    )


# Laws that CalculiX lacks


@pytest.mark.usefixtures("ccx")
def test_a_held_neo_hookean_brick_is_stressed_as_the_law_says() -> None:
    growth = np.array([-0.1, 0.04, 0.03])
    solid = bar(growth[None], slabs=2)
    solid, first = held(solid)
    result = calculix(solid, material(poisson=0.406, modulus=2.2), law="neo-hookean")
    g = 1 + growth
    shear, bulk = 2.2 / 2 / 1.406, 2.2 / 3 / (1 - 0.812)
    J, c = 1 / g.prod(), g**-2.0
    # Cauchy stress: F = I, so J_g times the Kirchhoff stress of F_e.
    expected = g.prod() * (shear * J ** (-2 / 3) * (c - c.sum() / 3) + bulk * J * (J - 1))
    assert np.allclose(result.stress[10, first], np.r_[expected, 0, 0, 0], rtol=1e-5, atol=1e-6)


@pytest.mark.usefixtures("ccx")
@pytest.mark.parametrize("kind", ["marlow", "neo-hookean", SVK])
def test_both_programs_find_the_same_trial(kind: Kind) -> None:
    """One beam, half of it active, under gravity, with every law."""
    pla = load_material("pla-hot-water")
    grid = Grid([[0, 0], [47, 12]], [[0, 1]], [0.5], 0, pla.name)
    theirs = simulate_by_calculix(grid, pla, law=kind)
    data = pla.law
    if kind != "marlow":
        data = ElasticData(kind=kind, poisson=data.poisson, modulus=data.modulus)
    ours = simulate_grid(grid, pla.model_copy(update={"law": data}), layout=THREE_ACROSS)
    assert theirs.record["law"] == kind
    assert abs(ours.joints - ours.joints[0]).max() > 3
    assert np.allclose(theirs.displacements, ours.displacements, atol=1e-3)
    assert np.allclose(theirs.stress, ours.stress, atol=1e-4)


@pytest.mark.usefixtures("ccx")
def test_an_elastic_material_has_no_table_for_marlow() -> None:
    with pytest.raises(InputError, match="no test table"):
        calculix(bar(np.zeros((1, 3)), slabs=1), material(), law="marlow")


# How it answers and fails


@pytest.mark.usefixtures("ccx")
def test_frames_counts_and_progress(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    solid = bar(np.array([[-0.03, 0.01, 0.01], [0, 0, 0]]), slabs=2)
    progress: list[tuple[int, int]] = []
    result = calculix(solid, material(weight=WEIGHT), progress=lambda *at: progress.append(at))
    assert result.displacements.shape == (12, len(solid.nodes), 3)
    assert result.stress.shape == (12, len(solid.bricks), 8, 6)
    assert (result.displacements[0] == 0).all()
    assert (result.displacements[:, solid.fixed] == 0).all()
    assert result.record["iterations"][0] == 0
    assert min(result.record["iterations"][1:]) > 0
    assert progress[-1] == (12, 12)
    assert progress == sorted(progress)
    assert not list(tmp_path.iterdir())  # nothing is left behind

    monkeypatch.setenv("SIMULEARN_KEEP", "1")
    calculix(solid, material())
    assert list(tmp_path.glob("*/trial.inp"))


def test_a_missing_ccx_is_one_clear_line(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(InputError, match="apt install calculix-ccx"):
        calculix(bar(np.zeros((1, 3)), slabs=1), material())


def test_growth_that_varies_in_a_brick_is_refused(fake: "Fake") -> None:
    fake("exit 0")
    solid = bar(np.zeros((1, 3)), slabs=2)
    growth = solid.growth.copy()
    growth[1, 3] = -0.1
    with pytest.raises(InputError, match="brick 1 has several growths"):
        calculix(with_(solid, growth=growth), material())


class Fake:
    """Puts a shell script in the place of ccx."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.path = folder / "ccx"
        monkeypatch.setenv("PATH", str(folder), prepend=os.pathsep)

    def __call__(self, script: str) -> None:
        self.path.write_text(f"#!/bin/sh\n{script}\n")
        self.path.chmod(self.path.stat().st_mode | stat.S_IXUSR)


@pytest.fixture
def fake(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Fake:
    return Fake(tmp_path, monkeypatch)


def test_an_error_of_ccx_is_passed_on(fake: Fake) -> None:
    fake("echo ' *ERROR reading *ELASTIC: odd'; echo '        number'; echo; exit 201")
    with pytest.raises(ComputationError, match=r"step 1, increment 1: .*odd number"):
        calculix(bar(np.zeros((1, 3)), slabs=1), material())


def test_smaller_steps_are_tried_and_then_it_fails(fake: Fake, tmp_path: Path) -> None:
    fake(f"echo x >> {tmp_path}/runs; echo ' *ERROR: too many cutbacks'; exit 201")
    with pytest.raises(ComputationError, match="too many cutbacks"):
        calculix(bar(np.zeros((1, 3)), slabs=1), material())
    assert (tmp_path / "runs").read_text() == "x\n" * 3


def test_a_crash_without_a_word_is_an_error(fake: Fake) -> None:
    fake("kill -SEGV $$")
    with pytest.raises(ComputationError, match="exit status -11"):
        calculix(bar(np.zeros((1, 3)), slabs=1), material())


def test_a_run_that_hangs_is_ended(fake: Fake) -> None:
    fake("exec sleep 100")
    with pytest.raises(ComputationError, match=r"longer than the 0\.5 s allowed"):
        calculix(bar(np.zeros((1, 3)), slabs=1), material(), timeout=0.5)


def test_an_interrupt_ends_the_child(fake: Fake, tmp_path: Path) -> None:
    number = tmp_path / "number"
    fake(f"echo $$ > {number}; printf 'a\\nb\\n 4 1 1 2 .1 .1 .1\\n' > trial.sta; exec sleep 100")

    def interrupt(*_: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        calculix(bar(np.zeros((1, 3)), slabs=1), material(), progress=interrupt)
    with pytest.raises(ProcessLookupError):
        os.kill(int(number.read_text()), 0)


def test_a_file_cut_short_is_an_error(tmp_path: Path) -> None:
    path = tmp_path / "a.dat"
    path.write_text(
        "\n displacements (vx,vy,vz) for set NODES and time  0.1000000E+01\n\n"
        "         1  1.000000-101  0.000000E+00 -2.500000E-02\n"
    )
    moves, stresses = read_dat(path, 1, 1)
    assert np.allclose(moves[0], [[0, 0, -0.025]])
    assert stresses == []
    with pytest.raises(ComputationError, match="incomplete displacements"):
        read_dat(path, 2, 1)
    path.write_text(path.read_text().replace("-2.500000E-02", "          NaN"))
    with pytest.raises(ComputationError, match="not numbers"):
        read_dat(path, 1, 1)


def test_the_last_error_is_reported_in_one_line() -> None:
    log = "good\n *ERROR: first\n\n *ERROR in e_c3d: nonpositive jacobian\n   in 5\n\nend\n"
    assert last_error(log) == "in e_c3d: nonpositive jacobian in 5"
    assert last_error("fine") == ""


@pytest.mark.usefixtures("ccx")
def test_it_can_be_cancelled() -> None:
    event = threading.Event()
    event.set()
    with pytest.raises(CancelledError):
        simulate_by_calculix(make("flat", (1, 1)), load_material("pla-hot-water"), cancel=event)
