"""Terms that no record can tell apart: zero, copies, sums of nominal parameters, equivalents.

A term enters rates and outputs through its derivative by its size. At random points of states, inputs and
parameters these derivatives are columns of numbers; what depends linearly at every point depends as an
expression.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca
import numpy as np

POINTS = 60
ROUNDING = 1e-9


@dataclass
class Judgement:
    """What the columns say of one term."""

    is_zero: bool = False
    copy_of: int | None = None
    # Nominal parameters that do the same together.
    covered_by: list[int] | None = None
    equivalents: tuple[int, ...] = ()


def _columns(function: ca.Function, points: list[np.ndarray]) -> np.ndarray:
    return np.vstack([np.array(function(point)) for point in points])


def judge(rates: ca.SX, output: ca.SX, variables: ca.SX, scales: list[float], nominal: ca.SX,
          values: list[float], sizes: ca.SX) -> list[Judgement]:
    """Judges every size; `variables` are states and inputs with typical sizes `scales`."""
    count = nominal.numel()
    jacobian = ca.jacobian(ca.vertcat(rates, output), ca.vertcat(nominal, sizes))
    jacobian = ca.substitute(jacobian, sizes, ca.SX.zeros(sizes.numel()))
    function = ca.Function("columns", [ca.vertcat(variables, nominal)], [ca.densify(jacobian)])
    random = np.random.default_rng(1)
    matrices = []
    # A dependence whose factors change with the parameters is none that a fit could use: each set of
    # parameters is looked at by itself and all must agree.
    for round_ in range(2):
        theta = np.array(values, dtype=float)
        if round_:
            theta = theta * np.exp(0.3 * random.standard_normal(count)) + (theta == 0) * 0.1
        points = [np.concatenate([random.standard_normal(len(scales)) * scales, theta])
                  for _ in range(POINTS)]
        matrix = _columns(function, points)
        matrices.append(matrix[np.all(np.isfinite(matrix), axis=1)])
    every = [_judge(matrix, count) for matrix in matrices]
    return [_agreed(one, other) for one, other in zip(*every)]


def _agreed(one: Judgement, other: Judgement) -> Judgement:
    return Judgement(
        one.is_zero and other.is_zero,
        one.copy_of if one.copy_of == other.copy_of else None,
        one.covered_by if one.covered_by is not None and other.covered_by is not None else None,
        tuple(sorted(set(one.equivalents) & set(other.equivalents))),
    )


def _judge(matrix: np.ndarray, count: int) -> list[Judgement]:
    theta, terms = matrix[:, :count], matrix[:, count:]
    norms = np.linalg.norm(terms, axis=0)
    typical = np.median(norms[norms > 0]) if np.any(norms > 0) else 1.0
    is_zero = norms <= ROUNDING * typical
    unit = terms / np.where(is_zero, 1.0, norms)
    theta_norms = np.linalg.norm(theta, axis=0)
    theta = theta / np.where(theta_norms > 0, theta_norms, 1.0)
    if count:
        left, singular, _ = np.linalg.svd(theta, full_matrices=False)
        basis = left[:, singular > ROUNDING * max(singular.max(), 1e-300)]
    else:
        basis = np.zeros((len(matrix), 0))
    rest = unit - basis @ (basis.T @ unit)
    lengths = np.linalg.norm(rest, axis=0)
    rest = rest / np.where(lengths > ROUNDING, lengths, 1.0)
    found = []
    for index in range(terms.shape[1]):
        own = Judgement(is_zero=bool(is_zero[index]))
        found.append(own)
        if own.is_zero:
            continue
        for other in range(index):
            if not is_zero[other] and _parallel(unit[:, index], unit[:, other]):
                own.copy_of = other
                break
        if lengths[index] <= 1e-7:
            factors, *_ = np.linalg.lstsq(theta, unit[:, index], rcond=None)
            own.covered_by = [int(i) for i in np.flatnonzero(np.abs(factors) > 1e-6)]
            continue
        own.equivalents = tuple(
            other for other in range(terms.shape[1])
            if other != index and not is_zero[other] and lengths[other] > 1e-7
            and _parallel(rest[:, index], rest[:, other]))
    return found


def _parallel(one: np.ndarray, other: np.ndarray) -> bool:
    cosine = float(one @ other)
    return bool(np.linalg.norm(one - np.sign(cosine) * other) < 1e-7)
