"""Reference values of the total and the overlapping Hadamard deviation by allantools 2024.06.

    python3 -m venv venv && venv/bin/pip install allantools==2024.6
    venv/bin/python crates/statistics/tests/data/allan_estimators_reference.py \
        > crates/statistics/tests/data/allan_estimators_reference.csv

The series are those of allan_reference.py. Degrees of freedom of the total deviation are those of
NIST SP 1065, those of the Hadamard deviation the ones of Greenhall and Riley (2003), both for the noise
that the series is made of.
"""

import allantools
import numpy as np
from allantools import ci

n = [1234567890]
while len(n) < 1000:
    n.append(16807 * n[-1] % 2147483647)
white = np.array(n) / 2147483647
series = {
    "white": (white, 0),
    "difference": (np.diff(white), 2),
    "sum": (np.cumsum(white - 0.5), -2),
}
print("series,averaging,total,total_degrees_of_freedom,hadamard,hadamard_degrees_of_freedom")
for name, (rate, alpha) in series.items():
    phase = allantools.frequency2phase(rate, 1.0)
    for averaging in (1, 2, 4, 8, 16, 32, 128):
        of = {"rate": 1.0, "data_type": "phase", "taus": [averaging]}
        total = allantools.totdev(phase, **of)[1][0]
        hadamard = allantools.ohdev(phase, **of)[1][0]
        total_edf = ci.edf_totdev(len(rate), averaging, alpha) if alpha <= 0 else float("nan")
        edf = ci.edf_greenhall(alpha, 3, averaging, len(phase), overlapping=True, modified=False)
        print(name, averaging, float(total), float(total_edf), float(hadamard), float(edf), sep=",")
