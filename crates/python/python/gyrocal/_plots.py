"""Pictures of results by Matplotlib, which is imported where one is asked for."""

from __future__ import annotations

from statistics import NormalDist
from typing import TYPE_CHECKING

import numpy as np

from ._errors import refusal
from ._estimates import Estimates
from ._table import needed

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

__all__ = ["coefficients", "over_time"]

#: Half width of the band that holds 95 % of a normal distribution, in standard deviations.
_BAND = NormalDist().inv_cdf(0.975)


def coefficients(result: Estimates, alpha: float, fig: Figure | None) -> Figure:
    """The coefficients with their intervals, a panel for each unit."""
    places: dict[str, list[int]] = {}
    for place, one in enumerate(result._estimated()):
        places.setdefault(one["unit"], []).append(place)
    if not places:
        raise refusal("plot", "a result without coefficients", "one with coefficients", "see its `setup`")
    ends = result.conf_int(alpha)
    figure = _figure(fig, height=0.7 + 0.5 * (len(result.names) + len(places)))
    ratios = [len(own) for own in places.values()]
    panels = figure.subplots(len(places), squeeze=False, gridspec_kw={"height_ratios": ratios})[:, 0]
    for axes, (unit, own) in zip(panels, places.items()):
        rows, values, reach = np.arange(len(own)), result.estimates[own], ends[own]
        beside = np.abs(reach.T - values)
        # What is not determined at all has no bar.
        beside[~np.isfinite(beside)] = 0.0
        axes.errorbar(values, rows, xerr=beside, fmt="o", capsize=4)
        axes.set_yticks(rows, [result.names[place] for place in own])
        axes.set_ylim(len(own) - 0.5, -0.5)
        axes.set_xlabel(unit)
        axes.grid(axis="x", alpha=0.3)
        for row, value, (low, high) in zip(rows, values, reach):
            words = f"{value:.6g} [{low:.6g}, {high:.6g}]"
            axes.text(1.02, row, words, transform=axes.get_yaxis_transform(), va="center", fontsize="small")
    panels[0].set_title(f"Coefficients with intervals of {100.0 * (1.0 - alpha):g} %")
    return figure


def over_time(
    outputs: list[tuple[str, str]],
    time_s: NDArray[np.float64],
    measured: NDArray[np.float64],
    simulated: NDArray[np.float64],
    sigmas: NDArray[np.float64],
    fig: Figure | None,
) -> Figure:
    """Each output measured and simulated, and below it the difference with the band of the sensor's noise."""
    figure = _figure(fig, height=4.0 * len(outputs))
    panels: list[Axes] = list(figure.subplots(2 * len(outputs), sharex=True, squeeze=False)[:, 0])
    for place, (name, unit) in enumerate(outputs):
        above, below = panels[2 * place : 2 * place + 2]
        above.plot(time_s, measured[:, place], ".", markersize=3, color="0.6", label="measured")
        above.plot(time_s, simulated[:, place], linewidth=1.0, label="simulated")
        above.set_ylabel(f"{name} [{unit}]")
        above.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, frameon=False)
        reach = _BAND * sigmas[place]
        below.axhspan(-reach, reach, color="0.9", label="95 % band of the sensor's noise")
        below.plot(time_s, measured[:, place] - simulated[:, place], linewidth=1.0, label="measured less simulated")
        below.set_ylabel(f"residual of {name} [{unit}]")
        below.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, frameon=False)
    panels[-1].set_xlabel("time [s]")
    return figure


def _figure(fig: Figure | None, height: float) -> Figure:
    with needed("Matplotlib", "matplotlib", "'gyrocal[plot]'"):
        import matplotlib.pyplot as plt
    if fig is None:
        return plt.figure(figsize=(9.0, height), layout="constrained")
    if not hasattr(fig, "subplots"):
        raise refusal("fig", f"a {type(fig).__name__}", "a figure of Matplotlib")
    return fig
