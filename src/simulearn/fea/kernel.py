"""What one iteration needs of the bricks: tangent stiffness and residual, compiled by JAX.

Total Lagrangian with growth: F_e = F F_g^-1, F_g = I + s diag(growth) in the printing frame. With
gradients taken in the grown state, dN_g = dN F_g^-1, that is F_e = F_g^-1 + u dN_g, and everything
else is standard: r = sum P dN_g w J_g, K = sum dN_g A dN_g w J_g.

Mixed integration point Newton (Magisano, Leonetti, Garcea 2017, doi:10.1002/nme.5348): the second
Piola-Kirchhoff stress S~ at the points is carried along as an own unknown. It replaces the stress
in the geometric stiffness only; the residual keeps the stress of the displacements, so that the
solution is the same and slender, turning beams need less than half of Newton's iterations.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from skfem import Basis, ElementHexS2, MeshHex

from simulearn.fea.laws import Law
from simulearn.fea.laws.law import inverse_transpose
from simulearn.fea.solid import Solid
from simulearn.fea.structure import PAIRS

jax.config.update("jax_enable_x64", True)


class Points(NamedTuple):
    """The material points of E bricks with Q points each.

    Attributes:
        gradients: (E, Q, 20, 3) of the shape functions in the flat grid, 1/mm.
        volumes: (E, Q) mm3.
        frame: (E, 3, 3) rows are the axes of the printing frame.
        growth: (E, Q, 3) released strains along these axes at full release.
        load: (E, 20) nodal share of the bricks' volume, mm3.
    """

    gradients: Array
    volumes: Array
    frame: Array
    growth: Array
    load: Array


class Response(NamedTuple):
    """Answer of the bricks to displacements.

    Attributes:
        entries: (E, 6, 20, 20) tangent stiffness for PAIRS of displacement components, N/mm, with
            the carried stress in its geometric part.
        residual: (E, 20, 3) internal forces, N.
        stress: (3, 3, M) second Piola-Kirchhoff stress of the displacements, MPa, M = E Q.
        A: (3, 3, 3, 3, M) moduli dP/dF.
        F: (3, 3, M) elastic deformation gradient.
    """

    entries: Array
    residual: Array
    stress: Array
    A: Array
    F: Array


def points_of(solid: Solid) -> Points:
    """Return the material points of a solid."""
    in_joint = solid.parts[:, 0] < 0
    bricks, points = len(solid.bricks), len(solid.weights)
    gradients = np.empty((bricks, points, 20, 3))
    volumes, load = np.empty((bricks, points)), np.empty((bricks, 20))
    for chosen, rule in (
        (~in_joint, (solid.points, solid.weights)),
        (in_joint, (solid.joint_points, solid.joint_weights)),
    ):
        if chosen.any():
            basis = _basis(solid.nodes, solid.bricks[chosen], rule)
            gradients[chosen] = np.stack([n[0].grad for n in basis.basis]).transpose(2, 3, 0, 1)
            volumes[chosen] = basis.dx
            load[chosen] = np.stack(
                [(np.asarray(n[0]) * basis.dx).sum(axis=1) for n in basis.basis], 1
            )
    c, s = np.cos(solid.angle), np.sin(solid.angle)
    zero, one = np.zeros_like(c), np.ones_like(c)
    frame = np.stack([[c, s, zero], [-s, c, zero], [zero, zero, one]]).transpose(2, 0, 1)
    return Points(
        gradients=jnp.asarray(gradients),
        volumes=jnp.asarray(volumes),
        frame=jnp.asarray(frame),
        growth=jnp.asarray(solid.growth),
        load=jnp.asarray(load),
    )


def _basis(nodes: np.ndarray, bricks: np.ndarray, rule: tuple[np.ndarray, np.ndarray]) -> Basis:
    """Return the shape functions of bricks at their integration points."""
    vertices, corners = np.unique(bricks[:, :8], return_inverse=True)
    mesh = MeshHex(
        np.ascontiguousarray(nodes[vertices].T), np.ascontiguousarray(corners.reshape(-1, 8).T)
    )
    return Basis(mesh, ElementHexS2(), quadrature=rule)


def deformation(points: Points, u: Array, s: Array | float) -> tuple[Array, Array, Array]:
    """Return F_e (3, 3, M), grown gradients (E, Q, 20, 3) and grown volumes (E, Q).

    Args:
        points: the material points.
        u: (E, 20, 3) displacements of the bricks' nodes, mm.
        s: released fraction.
    """
    grown = 1 + s * points.growth
    inverse = jnp.einsum("eai,eqa,eaj->eqij", points.frame, 1 / grown, points.frame)
    gradients = jnp.einsum("eqnj,eqji->eqni", points.gradients, inverse)
    F = inverse + jnp.einsum("enk,eqni->eqki", u, gradients)
    return _last(F), gradients, points.volumes * grown.prod(axis=-1)


def respond(
    law: Law, points: Points, u: Array, s: Array | float, carried: Array | None
) -> Response:
    """Return tangent and residual at displacements u (E, 20, 3) and released fraction s.

    Args:
        law: the constitutive law.
        points: the material points.
        u: (E, 20, 3) displacements of the bricks' nodes, mm.
        s: released fraction.
        carried: (3, 3, M) stress S~ of the geometric stiffness, MPa; None for plain Newton.
    """
    F, gradients, volumes = deformation(points, u, s)
    P, A = law.response(F)
    S = _second(F, P)
    e, q = volumes.shape
    weighted = gradients * volumes[..., None, None]
    residual = jnp.einsum("kim,mni->mnk", P, weighted.reshape(e * q, 20, 3)).reshape(e, q, 20, 3)
    eye = jnp.eye(3)
    moduli = A
    if carried is not None:
        moduli += eye[:, None, :, None, None] * (carried - S)[None, :, None, :]
    flat = gradients.transpose(0, 1, 3, 2).reshape(e, q * 3, 20)

    def block(k: int, l: int) -> Array:  # noqa: E741
        pair = moduli[k, :, l].reshape(3, 3, e, q)
        right = jnp.einsum("ijeq,eqnj->eqin", pair, weighted).reshape(e, q * 3, 20)
        return jnp.einsum("exa,exb->eab", flat, right)

    entries = jnp.stack([block(*pair) for pair in PAIRS], axis=1)
    return Response(entries, residual.sum(axis=1), S, A, F)


def carry(points: Points, response: Response, du: Array, s: Array | float) -> Array:
    """Return the stress S + dS/dE : (F^T dF) that the next iteration carries, (3, 3, M) MPa.

    Args:
        points: the material points.
        response: of the iteration that led to du.
        du: (E, 20, 3) its change of the displacements, mm.
        s: released fraction.
    """
    dF = deformation(points, du, s)[0] - deformation(points, jnp.zeros_like(du), s)[0]
    dP = jnp.einsum("kiljm,ljm->kim", response.A, dF)
    change = dP - jnp.einsum("kjm,jim->kim", dF, response.stress)
    return response.stress + _second(response.F, change)


def _last(field: Array) -> Array:
    """Move the points (E, Q) of a tensor field (E, Q, 3, 3) to the last axis: (3, 3, M)."""
    return field.transpose(2, 3, 0, 1).reshape(3, 3, -1)


def _second(F: Array, P: Array) -> Array:
    """Return F^-1 P (3, 3, M), symmetric by the balance of moments."""
    S = jnp.einsum("kjm,kim->jim", inverse_transpose(F)[0], P)
    return (S + S.transpose(1, 0, 2)) / 2
