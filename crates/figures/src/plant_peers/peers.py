"""What sparse and symbolic regression find where a diagnosis names an effect of a quadrotor.

    python peers.py DIRECTORY

reads `ours.json` and the records it names, and writes `peers.json`. All six states are measured. Each
method has the same terms, and its model is simulated in the same way over windows of a second record.
"""

import json
import sys
import time
import warnings
from pathlib import Path

import numpy as np
import pysindy as ps
from pyoperon.sklearn import SymbolicRegressor
from scipy.signal import savgol_filter

warnings.filterwarnings("ignore")
STATES, TORQUES = ("roll", "pitch", "yaw", "p", "q", "r"), ("up", "uq", "ur")
SIGMAS = np.array([0.002, 0.002, 0.004, 0.01, 0.01, 0.01])
# Terms of the nominal model and of the catalogue in the rate of each state that a torque drives.
NOMINAL = {"p": ["up", "p", "q r"], "q": ["uq", "q", "p r"], "r": ["ur", "r"]}
CATALOGUE = {
    "p": {"roll.drag": "p|p|", "p_rate.bias": "1", "roll.mixing": "uq"},
    "q": {"pitch.drag": "q|q|", "q_rate.bias": "1", "pitch.mixing": "up"},
    "r": {"yaw.drag": "r|r|", "r_rate.bias": "1", "yaw.mixing_p": "up", "yaw.mixing_q": "uq"},
}
# Parameters of the nominal terms: gain, damping, coupling with its sign.
NAMES = {"p": [("l", 1), ("dp", -1), ("j", 1)], "q": [("m", 1), ("dq", -1), ("j", -1)],
         "r": [("n", 1), ("dr", -1)]}
WINDOW = 40
# Lengths of smoothing, rows. Each method takes the one whose model of the first two thirds of its record
# simulates the last third best, and is fitted with it to the whole record.
SMOOTHING = (5, 7, 9, 13)
# A state, rad or rad/s, beyond which a model has left a record, and the error of such a model.
LOST, DIVERGED = 1e3, 1e9
# Half widths of the windows of the weak form, s, and their number; the best is taken in the same way.
HALF_WIDTHS_S, WINDOWS = (0.2, 0.4, 0.8), 400


def read(path):
    return np.genfromtxt(path, delimiter=",", names=True)


def columns(states, torques):
    p, q, r = states[..., 3], states[..., 4], states[..., 5]
    return {"up": torques[..., 0], "uq": torques[..., 1], "ur": torques[..., 2], "p": p, "q": q, "r": r,
            "q r": q * r, "p r": p * r, "p|p|": p * abs(p), "q|q|": q * abs(q), "r|r|": r * abs(r),
            "1": np.ones_like(p)}


def matrix(table, terms):
    return np.stack([table[term] for term in terms], axis=-1)


def measured(record):
    states = np.stack([record[f"angle_{n}"] for n in STATES[:3]] + [record[f"gyro_{n}"] for n in STATES[3:]], 1)
    return record["time_s"], states, np.stack([record[n] for n in TORQUES], 1)


def centred(torques):
    """Torques about a row: they are held, and a difference about the row sees the one before too."""
    return 0.5 * (torques + np.concatenate([torques[:1], torques[:-1]]))


def by_held_out(ways, record):
    """What the way gives whose model of the first two thirds simulates the last third best."""
    split = 2 * len(record) // 3
    first, last = record[:split], record[split:]
    return min(ways, key=lambda way: later_error(way(first)[1], last))(record)


def best_operon(record, seconds, seed):
    """By its best smoothing."""
    return by_held_out([lambda part, length=length: operon(part, length, seconds, seed)
                        for length in SMOOTHING], record)


def linear(coefficients):
    """Rates of p, q and r from factors of terms."""
    def rates(states, torques):
        table = columns(states, torques)
        return [sum(c * table[term] for term, c in coefficients[axis].items()) for axis in "pqr"]
    return rates


def later_error(rates, record):
    """Root mean square error over windows of a record, in standard deviations of the sensors."""
    time_s, states, torques = measured(record)
    step = time_s[1] - time_s[0]
    smooth = savgol_filter(states, 9, 3, axis=0)
    starts = np.arange(5, len(states) - WINDOW - 5, WINDOW)
    here, squares = smooth[starts].copy(), []

    def slope(x, u):
        # What is lost goes no further: formulas take no infinite numbers.
        roll, pitch, yaw, p, q, r = np.clip(np.nan_to_num(x, nan=10 * LOST), -10 * LOST, 10 * LOST).T
        turn = (np.sin(roll) * q + np.cos(roll) * r) / np.cos(pitch)
        return np.stack([p + turn * np.sin(pitch), np.cos(roll) * q - np.sin(roll) * r, turn,
                         *rates(np.stack([roll, pitch, yaw, p, q, r], 1), u)], 1)

    for index in range(WINDOW):
        u = torques[starts + index]
        k1 = slope(here, u)
        k2 = slope(here + step / 2 * k1, u)
        k3 = slope(here + step / 2 * k2, u)
        k4 = slope(here + step * k3, u)
        here = here + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        if not np.all(np.abs(here) < LOST):
            return DIVERGED
        squares.append(((here - states[starts + index + 1]) / SIGMAS) ** 2)
    return float(np.sqrt(np.mean(squares)))


def weak(record, half_width_s):
    """Terms and rates of p, q and r integrated over windows with smooth weights, which needs no derivatives of
    noisy data: the weak form that pysindy's documentation advises for these. The middle of each window too."""
    time_s, states, torques = measured(record)
    table = columns(states, centred(torques))
    library = ps.WeakPDELibrary(ps.IdentityLibrary(), spatiotemporal_grid=time_s, K=WINDOWS,
                                H_xt=[half_width_s], is_uniform=True)
    np.random.seed(0)
    library.fit(matrix(table, list(table)))
    terms = np.asarray(library.transform(matrix(table, list(table))))
    driven = ps.AxesArray(states[:, 3:], {"ax_time": 0, "ax_coord": 1})
    middles = np.array([np.mean(places[0]) for places in library.inds_k])
    return dict(zip(table, terms.T)), np.asarray(library.convert_u_dot_integral(driven)), middles


def differences(record, length):
    """The same by smoothed differences, row by row."""
    time_s, states, torques = measured(record)
    smoother = ps.SmoothedFiniteDifference(smoother_kws={"window_length": length, "polyorder": 3})
    slopes = smoother._differentiate(states, time_s)
    return columns(smoother.smoothed_x_, centred(torques)), slopes[:, 3:], np.arange(len(states))


def sindy(table, rates, middles):
    """STLSQ of columns of length one; its threshold by Schwarz's criterion on the last third, its factors by
    least squares over all."""
    first, found, ranked = middles < np.quantile(middles, 2 / 3), {}, []
    for index, axis in enumerate("pqr"):
        terms = NOMINAL[axis] + list(CATALOGUE[axis].values())
        theta, target = matrix(table, terms), rates[:, index]
        scale = np.sqrt(np.mean(theta**2, axis=0))
        best = None
        for threshold in np.logspace(-4, 0, 41) * np.sqrt(np.mean(target**2)):
            optimizer = ps.STLSQ(threshold=threshold, alpha=1e-9)
            optimizer.fit(theta[first] / scale, target[first, None])
            factors = np.ravel(optimizer.coef_) / scale
            rest = (target - theta @ factors)[~first]
            score = len(rest) * np.log(np.mean(rest**2)) + np.log(len(rest)) * np.count_nonzero(factors)
            if best is None or score < best[0]:
                best = score, np.flatnonzero(factors)
        factors = np.zeros(len(terms))
        if len(best[1]):
            factors[best[1]] = np.linalg.lstsq(theta[:, best[1]], target, rcond=None)[0]
        found[axis] = dict(zip(terms, factors))
        rest = np.std(target - theta @ factors)
        ranked += [(abs(found[axis][term]) * np.sqrt(np.mean(table[term] ** 2)) / rest, name)
                   for name, term in CATALOGUE[axis].items() if found[axis][term]]
    return [name for _, name in sorted(ranked, reverse=True)], linear(found)


def best_sindy(record):
    """By its best form: weak, or by differences."""
    forms = [lambda part, width=width: sindy(*weak(part, width)) for width in HALF_WIDTHS_S]
    forms += [lambda part, length=length: sindy(*differences(part, length)) for length in SMOOTHING]
    return by_held_out(forms, record)


def operon(record, length, seconds, seed):
    """Symbolic regression of what the fitted nominal terms leave, with the same terms for variables."""
    time_s, states, torques = measured(record)
    slopes = savgol_filter(states, length, 3, deriv=1, delta=time_s[1] - time_s[0], axis=0)
    table = columns(savgol_filter(states, length, 3, axis=0), centred(torques))
    nominal, regressors, ranked = {}, {}, []
    for index, axis in enumerate("pqr"):
        theta, target = matrix(table, NOMINAL[axis]), slopes[:, 3 + index]
        factors = np.linalg.lstsq(theta, target, rcond=None)[0]
        nominal[axis] = dict(zip(NOMINAL[axis], factors))
        rest = target - theta @ factors
        names = [name for name, term in CATALOGUE[axis].items() if term != "1"]
        terms = [CATALOGUE[axis][name] for name in names]
        inputs = matrix(table, terms)
        regressor = SymbolicRegressor(
            allowed_symbols="add,sub,mul,constant,variable", optimizer_iterations=10, max_length=15,
            max_time=max(1, round(seconds / 3 / len(SMOOTHING))), n_threads=1, random_state=seed)
        regressor.fit(inputs, rest)
        regressors[axis] = regressor, terms
        told = regressor.predict(inputs)
        noise = np.std(rest - told)
        bias = [name for name, term in CATALOGUE[axis].items() if term == "1"]
        scores = [(abs(np.mean(told)) / noise, name) for name in bias]
        for place, name in enumerate(names):
            without = inputs.copy()
            without[:, place] = np.mean(inputs[:, place])
            scores.append((np.std(told - regressor.predict(without)) / noise, name))
        # What moves the formula by less than a tenth of the noise counts as absent from it.
        ranked += [score for score in scores if score[0] > 0.1]
    base = linear(nominal)

    def rates(states, torques):
        table = columns(states, torques)
        return [own + regressors[axis][0].predict(matrix(table, regressors[axis][1]))
                for axis, own in zip("pqr", base(states, torques))]
    return [name for _, name in sorted(ranked, reverse=True)], rates


def ours(entry):
    values, sizes = entry["parameters"], entry["sizes"]
    found = {axis: {term: sign * values[name] for term, (name, sign) in zip(NOMINAL[axis], NAMES[axis])}
             for axis in "pqr"}
    for axis in "pqr":
        for name, term in CATALOGUE[axis].items():
            if name in sizes:
                found[axis][term] = found[axis].get(term, 0.0) + sizes[name]
    return linear(found)


def main():
    directory = Path(sys.argv[1])
    results = []
    for index, entry in enumerate(json.loads((directory / "ours.json").read_text())):
        record, later = read(directory / entry["record"]), read(directory / entry["later"])
        row = {"ours": {"names": entry["names"], "error": later_error(ours(entry), later),
                        "seconds": entry["seconds"]}}
        for name, method in (("pysindy", lambda: best_sindy(record)),
                             ("pyoperon", lambda: best_operon(record, entry["seconds"], 1 + index))):
            began = time.perf_counter()
            names, rates = method()
            row[name] = {"names": names, "seconds": time.perf_counter() - began,
                         "error": later_error(rates, later)}
        results.append(row)
    (directory / "peers.json").write_text(json.dumps(results))


main()
