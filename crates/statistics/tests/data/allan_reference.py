"""Reference values of the overlapping Allan deviation by allantools 2024.06.

    python3 -m venv venv && venv/bin/pip install allantools==2024.6
    venv/bin/python crates/statistics/tests/data/allan_reference.py > crates/statistics/tests/data/allan_reference.csv

The series is the one of NIST SP 1065, section 12.4 (1000 points, n(i+1) = 16807 n(i) mod
2147483647 from 1234567890, divided by 2147483647), taken three ways: as a rate (white), as
differences of it (white angle) and summed (random walk). Noise identification and degrees of
freedom are those of its table 5.
"""

import allantools
import numpy as np
from allantools import ci

n = [1234567890]
while len(n) < 1000:
    n.append(16807 * n[-1] % 2147483647)
white = np.array(n) / 2147483647
series = {
    "white": white,
    "difference": np.diff(white),
    "sum": np.cumsum(white - 0.5),
}
print("series,averaging,deviation,alpha,degrees_of_freedom,low,high")
for name, rate in series.items():
    phase = allantools.frequency2phase(rate, 1.0)
    for averaging in (1, 2, 4, 8, 16, 32):
        _, deviation, _, _ = allantools.oadev(phase, rate=1.0, data_type="phase", taus=[averaging])
        alpha = max(-2, min(2, ci.autocorr_noise_id(phase, averaging)[0]))
        edf = ci.edf_simple(len(phase), averaging, alpha)
        low, high = ci.confidence_interval(deviation[0], edf)
        values = (float(value) for value in (edf, low, high))
        print(name, averaging, float(deviation[0]), alpha, *values, sep=",")
