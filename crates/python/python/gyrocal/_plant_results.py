"""Results of a plant: fits and diagnoses, with the outputs over time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _gyrocal
from ._arguments import check
from ._estimates import Searched, WithCovariance
from ._plots import over_time
from ._result import Fields, Result

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["PlantDiagnosis", "PlantFit"]


class _OverTime(Result):
    """A result with the outputs of its record over time, under the names of this package and of statsmodels.

    They are not in the JSON: a result that was read from it does not have them.
    """

    __slots__ = ("_series",)
    _series: Mapping[str, NDArray[np.float64]] | None

    def _take(self, series: Mapping[str, NDArray[np.float64]] | None) -> None:
        for array in (series or {}).values():
            array.flags.writeable = False
        object.__setattr__(self, "_series", series)

    def _array(self, of: str, name: str) -> NDArray[np.float64]:
        if self._series is None:
            raise AttributeError(
                f"there is no `{name}`: outputs over time are not in the JSON that this result was read from; "
                "fit or diagnose the record again",
                name=name,
                obj=self,
            )
        return self._series[of]

    def _outputs(self) -> list[tuple[str, str]]:
        """Name and unit of each output."""
        raise NotImplementedError

    @property
    def output_names(self) -> list[str]:
        """Names of the outputs, the order of the columns of all arrays over time."""
        return [name for name, _ in self._outputs()]

    @property
    def time_s(self) -> NDArray[np.float64]:
        """Time of each row of the record, (rows,), s."""
        return self._array("time_s", "time_s")

    @property
    def measured(self) -> NDArray[np.float64]:
        """The outputs of the record, (rows, outputs), each in its unit; ``nan`` where one is missing."""
        return self._array("measured", "measured")

    @property
    def fittedvalues(self) -> NDArray[np.float64]:
        """The outputs that the fitted model simulates, (rows, outputs), each in its unit.

        Of a plant without noise of its rates they go from the initial states on, without any reading; otherwise
        over ``horizon_s`` at a time.
        """
        return self._array("simulated", "fittedvalues")

    @property
    def resid(self) -> NDArray[np.float64]:
        """Measured less simulated, (rows, outputs), each in its unit; ``nan`` where a reading is missing."""
        return self._array("measured", "resid") - self.fittedvalues

    def predict(self, *, one_step: bool = False) -> NDArray[np.float64]:
        """The outputs of the record as the fitted model has them.

        Args:
            one_step: Predicts each row from the readings of the rows before, in the noise of the fit. These are the
                predictions that the likelihood is of. Otherwise the rows are simulated, as in ``fittedvalues``.

        Returns:
            The outputs, (rows, outputs), each in its unit; one step ahead ``nan`` where a reading is missing.
        """
        check("one_step", one_step)
        return self._array("one_step", "predict") if one_step else self.fittedvalues

    def plot(self, *, fig: Figure | None = None) -> Figure:
        """Draws each output, measured and simulated, and the residuals, by Matplotlib.

        Args:
            fig: A figure to draw in; a new one of pyplot if it is not given.

        Returns:
            The figure, with two panels for each output. The band holds 95 % of the noise of the sensor.

        Raises:
            ImportError: Matplotlib is not installed; it is the extra ``plot``.
        """
        sigmas = self._array("sigmas", "plot")
        return over_time(self._outputs(), self.time_s, self.measured, self.fittedvalues, sigmas, fig)


class PlantFit(_OverTime, WithCovariance):
    """Result of :meth:`gyrocal.Plant.fit`.

    The coefficients are parameters and then initial states, in the units of the plant.

    >>> import gyrocal
    >>> plant = gyrocal.Plant("examples/duffing/plant.json")
    >>> fit = plant.fit("examples/duffing/record.csv", "examples/duffing/columns.toml")
    >>> fit.names, fit.cov_params().shape
    (['k', 'c', 'g', 'initial x', 'initial v'], (5, 5))
    >>> fit.output_names, fit.resid.shape == (fit.nobs, 1)
    (['y'], True)
    >>> fit.aic == 2 * fit.unknowns - 2 * fit.llf
    True
    """

    __slots__ = ()
    plant: str
    record: Fields
    first_rows: int
    coefficients: Fields
    correlations: list[Fields]
    condition: float | None
    undetermined: list[Fields]
    still_inputs: list[str]
    starts: Fields
    noise: list[Fields]
    undeclared_noise: list[Fields]
    remainder: list[Fields]
    values: int
    unknowns: int
    log_likelihood: float
    aic: float
    bic: float
    horizon_s: float
    outputs: list[Fields]
    later: Fields | None

    def __init__(self, text: str, series: Mapping[str, NDArray[np.float64]] | None = None) -> None:
        super().__init__(text)
        self._take(series)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._text, self._series)

    @property
    def llf(self) -> float:
        """The same as ``log_likelihood``: that of all values at the estimates, nats."""
        return self.log_likelihood

    @property
    def nobs(self) -> int:
        """The same as ``values``: the number of readings that are fitted, of all outputs."""
        return self.values

    def _covariance(self) -> list[list[float]]:
        rows: list[list[float]] = self._fields["coefficients"]["covariance"]
        return rows

    def _estimated(self) -> list[dict[str, Any]]:
        nominal: list[dict[str, Any]] = self._fields["coefficients"]["nominal"]
        return nominal

    def _rows(self) -> list[dict[str, Any]]:
        """One row a coefficient."""
        declared = self._fields["coefficients"]["declared"]
        return [one | {"declared": value} for one, value in zip(self._estimated(), declared)]

    def _outputs(self) -> list[tuple[str, str]]:
        return [(one["output"], one["unit"]) for one in self._fields["outputs"]]

    def __repr__(self) -> str:
        return f"<gyrocal.PlantFit of {self.plant}: {len(self.names)} coefficients>"


class PlantDiagnosis(_OverTime, Searched):
    """Result of :meth:`gyrocal.Plant.diagnose`. The page of one that was pickled has no charts.

    The coefficients are parameters and initial states in the units of the plant; the result has no covariance.
    Outputs over time are those of the model with what was found.

    >>> import gyrocal
    >>> plant = gyrocal.Plant("examples/duffing/plant.json")
    >>> found = plant.diagnose("examples/duffing/record.csv", "examples/duffing/columns.toml")
    >>> found.names, found.conf_int().shape
    (['k', 'c', 'g', 'initial x', 'initial v'], (5, 2))
    >>> list(found.pvalues)
    ['v_rate.x^3']
    """

    __slots__ = ("_charts",)
    _charts: _gyrocal.PlantPage | None
    verdict: str
    record: Fields
    findings: list[Fields]
    coefficients: Fields
    open_loop: list[Fields]
    noise: list[Fields]
    undetermined: list[Fields]
    gain: Fields | None
    remainder: Fields
    later_record: Fields | None

    def __init__(
        self,
        text: str,
        charts: _gyrocal.PlantPage | None = None,
        series: Mapping[str, NDArray[np.float64]] | None = None,
    ) -> None:
        super().__init__(text)
        object.__setattr__(self, "_charts", charts)
        self._take(series)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._text, None, self._series)

    @property
    def plant(self) -> str:
        """Name of the plant."""
        return str(self._fields["subject"]["plant"])

    def _outputs(self) -> list[tuple[str, str]]:
        return [(one["output"], one["unit"]) for one in self._fields["open_loop"]]

    def _page(self) -> _gyrocal.PlantPage | None:
        return self._charts

    def __repr__(self) -> str:
        effects = ", ".join(finding["effect"] for finding in self._fields["findings"])
        return f"<gyrocal.PlantDiagnosis of {self.plant}, {self.verdict}{': ' + effects if effects else ''}>"
