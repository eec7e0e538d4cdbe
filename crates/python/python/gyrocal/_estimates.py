"""Results with coefficients."""

from __future__ import annotations

from statistics import NormalDist
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._arguments import check
from ._errors import refusal
from ._result import Result

__all__ = ["Estimates", "Searched", "WithCovariance"]


class Estimates(Result):
    """Coefficients with their standard deviations, under the names of this package and of statsmodels."""

    __slots__ = ()

    def _estimated(self) -> list[dict[str, Any]]:
        raise NotImplementedError

    @property
    def names(self) -> list[str]:
        """Names of the coefficients, in the order of all arrays of them."""
        return [one["name"] for one in self._estimated()]

    @property
    def estimates(self) -> NDArray[np.float64]:
        """The coefficients, each in its unit."""
        return np.array([one["estimate"] for one in self._estimated()])

    @property
    def sigmas(self) -> NDArray[np.float64]:
        """Standard deviations of the coefficients, each in its unit."""
        return np.array([one["sigma"] for one in self._estimated()])

    @property
    def params(self) -> NDArray[np.float64]:
        """The same as ``estimates``."""
        return self.estimates

    @property
    def bse(self) -> NDArray[np.float64]:
        """The same as ``sigmas``."""
        return self.sigmas

    def conf_int(self, alpha: float = 0.05) -> NDArray[np.float64]:
        """Confidence intervals of the coefficients, from the normal distribution.

        Args:
            alpha: Probability that an interval misses.

        Returns:
            Lower and upper ends, (coefficients, 2), each in its unit.
        """
        check("alpha", alpha)
        reach = -NormalDist().inv_cdf(alpha / 2.0) * self.sigmas
        return np.column_stack([self.estimates - reach, self.estimates + reach])


class WithCovariance(Estimates):
    """Coefficients whose covariance is in the result."""

    __slots__ = ()

    def _covariance(self) -> list[list[float]]:
        raise NotImplementedError

    @property
    def covariance(self) -> NDArray[np.float64]:
        """Covariance of the coefficients, (coefficients, coefficients), in products of their units."""
        return np.array(self._covariance())

    def cov_params(self) -> NDArray[np.float64]:
        """The same as ``covariance``."""
        return self.covariance


class Searched(Estimates):
    """A search for effects; the coefficients are those with the accepted findings in the model.

    There are none where the set-up is wrong.
    """

    __slots__ = ()

    def _estimated(self) -> list[dict[str, Any]]:
        found = self._fields["coefficients"]
        if found is None:
            return []
        best: list[dict[str, Any]] = found["nominal"] if found["extended"] is None else found["extended"]
        return best

    @property
    def pvalues(self) -> dict[str, float]:
        """The p-value of each finding, corrected for the search, by its effect."""
        return {one["effect"]: one["p_value"] for one in self._fields["findings"]}

    def conf_int(self, alpha: float = 0.05) -> NDArray[np.float64]:
        """Confidence intervals of the coefficients.

        With findings they are those of the result, over all members of the confidence sets, where it holds them,
        and only of 95 %; otherwise from the normal distribution.

        Args:
            alpha: Probability that an interval misses.

        Returns:
            Lower and upper ends, (coefficients, 2), each in its unit.
        """
        found = self._fields["coefficients"]
        over_set = None if found is None else found["over_set"]
        if over_set is None:
            return super().conf_int(alpha)
        check("alpha", alpha)
        if alpha != 0.05:
            raise refusal("alpha", repr(alpha), "0.05", "the result holds intervals of 95 %")
        return np.array([one["interval"] for one in over_set])

    def _rows(self) -> list[dict[str, Any]]:
        """One row a finding; its parameters are columns."""
        return _finding_rows(self._fields["findings"])


def _finding_rows(findings: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """One row a finding; the parameters are columns."""
    keys = ("effect", "name", "kind", "formula", "z", "p_value", "coverage", "gain_nats", "accepted")
    rows = []
    for finding in findings:
        row = {key: finding[key] for key in keys if key in finding}
        row["alternatives"] = [other["effect"] for other in finding["alternatives"]]
        for parameter in finding["parameters"]:
            row[parameter["name"]] = parameter["estimate"]
            row[parameter["name"] + "_sigma"] = parameter["sigma"]
            row[parameter["name"] + "_unit"] = parameter["unit"]
        rows.append(row)
    return rows
