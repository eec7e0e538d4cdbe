"""The default filter in extended precision: what tests/numerics holds the Rust filters against.

Run by hand, from the root of the repository; writes the two tables beside this file:

    python3 -m venv VENV
    VENV/bin/pip install mpmath==1.4.1 gmpy2==2.3.2     # gmpy2 makes it faster, nothing else
    VENV/bin/python tests/data/numerics/reference.py

A dense textbook extended Kalman filter, written from docs/model.md. It shares nothing with the
derivation or the Rust code: derivatives are differences of whole discrete steps, with a step of
2^-150 in 400-bit arithmetic, hence good to 40 digits.

samples.csv     accelerometer samples [g]: a simulated platform with noise, cut to ten decimals
reference.csv   rule, run, step, quantity, i, j, value: after the update of that step, 25 digits.
                attitude: platform_c_enu; coefficient: i of nine; covariance: small rotation
                [rad] first, then the coefficients; entries of the covariance as listed below.

Most of a filter's rounding error arises in the first updates and stays: one run is one draw.
So there are several, which differ in the prior sigmas.
"""

import csv
import multiprocessing
import pathlib

from mpmath import cos, fdot, mp, mpf, nstr, pi, sin, sqrt

mp.prec = 400
DIFFERENCE = mpf(2) ** -150

# The filter starts from these numbers, which are binary fractions exactly as written in Rust.
STEPS = 1000
STEP_S = mpf(60.0)
LATITUDE_RAD = mpf(-0.575)
EARTH_RATE_RAD_PER_S = mpf(7.292115e-5)
ANGLES_RAD = [mpf(0.3), mpf(-0.5), mpf(1.9)]
ANGLE_SIGMA_RAD = mpf(2) ** -12
RUNS = 8


def coefficient_sigma(run):
    return 1 + mpf(run) / 16


DRIFT_DENSITY = mpf(2.4e-4)  # (deg/h)^2 s
ACCEL_VARIANCE = mpf(1e-10)  # g^2

# What made the samples; unknown to the filter.
TRUE_OFFSETS_RAD = [mpf("1e-4"), mpf("-2e-4"), mpf("1.5e-4")]
TRUE_COEFFICIENTS = [mpf(c) / 1000 for c in (210, -130, 35, -90, 160, -45, 120, 55, 25)]
DECIMALS = 10

CHECKPOINTS = [1, 2, 10, 100, 1000]
# Each angle with its gyro's bias, and the coefficients of each gyro among themselves.
OFF_DIAGONALS = [(0, 3), (1, 6), (2, 9)] + [
    (3 * g + i, 3 * g + j) for g in (1, 2, 3) for i, j in ((0, 1), (0, 2), (1, 2))
]
DEG_PER_H = pi / 180 / 3600


def times(a, b):
    """Product of two lists of rows."""
    columns = list(zip(*b))
    return [[fdot(row, column) for column in columns] for row in a]


def transposed(a):
    return [list(row) for row in zip(*a)]


def plus(a, b):
    return [[x + y for x, y in zip(u, v)] for u, v in zip(a, b)]


def rotate(a, vector):
    return [fdot(row, vector) for row in a]


def attitude(theta):
    """(4): Rz Ry Rx of passive rotations."""
    (cx, cy, cz), (sx, sy, sz) = [cos(t) for t in theta], [sin(t) for t in theta]
    about_x = [[1, 0, 0], [0, cx, sx], [0, -sx, cx]]
    about_y = [[cy, 0, -sy], [0, 1, 0], [sy, 0, cy]]
    about_z = [[cz, sz, 0], [-sz, cz, 0], [0, 0, 1]]
    return times(about_z, times(about_y, about_x))


def angle_rates_to_rotation(theta):
    """(6): W."""
    sy, cy, sz, cz = sin(theta[1]), cos(theta[1]), sin(theta[2]), cos(theta[2])
    return [[cy * cz, sz, mpf(0)], [-cy * sz, cz, mpf(0)], [sy, mpf(0), mpf(1)]]


def solve3(a, b):
    """Cramer's rule."""

    def determinant(m):
        return (
            m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
            - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
        )

    whole = determinant(a)
    replaced = lambda k: [[b[i] if j == k else a[i][j] for j in range(3)] for i in range(3)]
    return [determinant(replaced(k)) / whole for k in range(3)]


def rates(theta, coefficients, noise, omega_0, f_0):
    """(1), (2), (7), (9): rates of the angles [rad/s]."""
    c = attitude(theta)
    a = rotate(c, f_0)
    earth = rotate(c, omega_0)
    drift = []
    for i in range(3):
        fixed, first, second = coefficients[3 * i : 3 * i + 3]
        drift.append(DEG_PER_H * (fixed + first * a[i] + second * a[i] ** 2 + noise[i]))
    return solve3(angle_rates_to_rotation(theta), [d - e for d, e in zip(drift, earth)])


def euler(theta, *rest):
    return [t + STEP_S * rate for t, rate in zip(theta, rates(theta, *rest))]


def rk4(theta, *rest):
    moved = lambda rate, part: [t + STEP_S * part * r for t, r in zip(theta, rate)]
    k1 = rates(theta, *rest)
    k2 = rates(moved(k1, mpf(1) / 2), *rest)
    k3 = rates(moved(k2, mpf(1) / 2), *rest)
    k4 = rates(moved(k3, mpf(1)), *rest)
    combined = [a + 2 * b + 2 * c + d for a, b, c, d in zip(k1, k2, k3, k4)]
    return moved(combined, mpf(1) / 6)


def turned_by(phi):
    """exp(-[phi]x), Rodrigues."""
    x, y, z = phi
    square = fdot(phi, phi)
    angle = sqrt(square)
    generator = [[mpf(0), z, -y], [-z, mpf(0), x], [y, -x, mpf(0)]]
    first, second = sin(angle) / angle, (1 - cos(angle)) / square
    twice = times(generator, generator)
    return [
        [(1 if i == j else 0) + first * generator[i][j] + second * twice[i][j] for j in range(3)]
        for i in range(3)
    ]


def derivative(function, at):
    """Columns by forward differences: a list of rows."""
    value = function(at)
    columns = []
    for k in range(len(at)):
        shifted = list(at)
        shifted[k] += DIFFERENCE
        columns.append([(s - v) / DIFFERENCE for s, v in zip(function(shifted), value)])
    return transposed(columns)


class Chance:
    """Knuth's 64-bit linear congruential generator; twelve uniforms make a normal."""

    def __init__(self):
        self.state = 1

    def normal(self):
        total = mpf(-6)
        for _ in range(12):
            self.state = (6364136223846793005 * self.state + 1442695040888963407) % 2**64
            total += mpf(self.state >> 11) / 2**53
        return total


def earth_rate_enu():
    return [mpf(0), EARTH_RATE_RAD_PER_S * cos(LATITUDE_RAD), EARTH_RATE_RAD_PER_S * sin(LATITUDE_RAD)]


UP = [mpf(0), mpf(0), mpf(1)]


def simulated_samples():
    chance = Chance()
    c = attitude([a + o for a, o in zip(ANGLES_RAD, TRUE_OFFSETS_RAD)])
    rows = []
    for _ in range(STEPS):
        noise = [sqrt(DRIFT_DENSITY / STEP_S) * chance.normal() for _ in range(3)]
        inputs = (rotate(c, earth_rate_enu()), rotate(c, UP))
        c = times(attitude(rk4([mpf(0)] * 3, TRUE_COEFFICIENTS, noise, *inputs)), c)
        measured = [a + sqrt(ACCEL_VARIANCE) * chance.normal() for a in rotate(c, UP)]
        rows.append([f"{int(mp.nint(a * 10**DECIMALS)) / 10**DECIMALS:.{DECIMALS}f}" for a in measured])
    return rows


def filtered(rule, run, samples):
    """Yields step, attitude, coefficients and covariance at the checkpoints."""
    zero3 = [mpf(0)] * 3
    c = attitude(ANGLES_RAD)
    coefficients = [mpf(0)] * 9
    w = angle_rates_to_rotation(ANGLES_RAD)
    p = [[coefficient_sigma(run) ** 2 if i == j else mpf(0) for j in range(12)] for i in range(12)]
    for i in range(3):
        for j in range(3):
            p[i][j] = ANGLE_SIGMA_RAD**2 * fdot(w[i], w[j])

    for step, row in enumerate(samples, start=1):
        inputs = (rotate(c, earth_rate_enu()), rotate(c, UP))
        one_step = lambda x: rule(x[:3], x[3:12], x[12:], *inputs)
        theta = one_step(zero3 + coefficients + zero3)
        by_all = times(
            angle_rates_to_rotation(theta), derivative(one_step, zero3 + coefficients + zero3)
        )
        c = times(attitude(theta), c)
        phi = [r[:12] for r in by_all] + [
            [mpf(1 if j == i else 0) for j in range(12)] for i in range(3, 12)
        ]
        gamma = [r[12:] for r in by_all] + [zero3] * 9
        held = DRIFT_DENSITY / STEP_S
        p = plus(
            times(phi, times(p, transposed(phi))),
            [[held * fdot(u, v) for v in gamma] for u in gamma],
        )

        predicted = rotate(c, UP)
        h = [
            r + [mpf(0)] * 9
            for r in derivative(lambda t: rotate(attitude(t), predicted), zero3)
        ]
        cross = times(p, transposed(h))
        s = times(h, cross)
        for i in range(3):
            s[i][i] += ACCEL_VARIANCE
        gain = [solve3(s, row_of_cross) for row_of_cross in cross]
        residual = [mpf(float(m)) - a for m, a in zip(row, predicted)]
        correction = rotate(gain, residual)
        keep = [
            [(1 if i == j else 0) - fdot(gain[i], [r[j] for r in h]) for j in range(12)]
            for i in range(12)
        ]
        p = plus(
            times(keep, times(p, transposed(keep))),
            [[ACCEL_VARIANCE * fdot(u, v) for v in gain] for u in gain],
        )
        coefficients = [d + change for d, change in zip(coefficients, correction[3:])]
        c = times(turned_by(correction[:3]), c)
        if step in CHECKPOINTS:
            yield step, c, coefficients, p


def printed(value):
    """25 digits without an exponent."""
    return nstr(value, 25, min_fixed=-mp.inf, max_fixed=mp.inf)


def table(rule, run, samples):
    """The rows of reference.csv of one run."""
    rows = []
    for step, c, coefficients, p in filtered(rule, run, samples):
        entries = [("attitude", i, j, c[i][j]) for i in range(3) for j in range(3)]
        entries += [("coefficient", i, 0, d) for i, d in enumerate(coefficients)]
        pairs = [(i, i) for i in range(12)] + OFF_DIAGONALS
        entries += [("covariance", i, j, p[i][j]) for i, j in pairs]
        rows += [[rule.__name__, run, step, *at, printed(value)] for *at, value in entries]
    return rows


def main():
    here = pathlib.Path(__file__).parent
    samples = simulated_samples()
    with open(here / "samples.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["accel_x_g", "accel_y_g", "accel_z_g"])
        writer.writerows(samples)
    jobs = [(rule, run, samples) for rule in (euler, rk4) for run in range(RUNS)]
    with multiprocessing.Pool() as pool:
        tables = pool.starmap(table, jobs, chunksize=1)
    with open(here / "reference.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["rule", "run", "step", "quantity", "i", "j", "value"])
        for rows in tables:
            writer.writerows(rows)


if __name__ == "__main__":
    main()
