"""What the records of a fleet show together."""

import pickle

import pyarrow as pa
import pytest

import gyrocal
from gyrocal import fleet

UNITS = 8


def scenario(unit, record):
    bias = 0.4 + 0.01 * unit + 0.02 * record
    return {
        "seed": 10 * unit + record,
        "site": {"latitude_deg": 39.1},
        "platform": {
            "initial_angles_deg": [12.0, -25.0, 40.0],
            "initial_angles_sigma_deg": [0.01, 0.01, 0.01],
        },
        "gyros": {
            "bias_deg_per_h": [bias, -0.287, 0.153],
            "g_deg_per_h_per_g": [-0.126, 0.214, 0.087],
            "gg_deg_per_h_per_g2": [0.041, -0.068, 0.023],
        },
        "hidden": [],
        "noise": {"accel_g": 1e-5, "gyro_deg_per_h": 0.002},
        "sampling": {"duration_s": 43200.0, "interval_s": 900.0},
    }


@pytest.fixture(scope="module")
def results():
    rows = []
    for unit in range(UNITS):
        for record in range(2):
            made = gyrocal.simulate(scenario(unit, record))
            known = {"batch": f"B{unit % 2}", "site": "north", "date_s": record * 31_557_600.0}
            rows.append((f"unit-{unit}", f"run-{record}", made.record, made.bench, known))
    batch = fleet.batch_of_records(rows)
    return pa.Table.from_batches(fleet.diagnose_batches([batch]))


def test_coefficients_of_a_fleet(results, tmp_path):
    found = fleet.summarise(results)
    assert (found.units, found.records, found.problems) == (UNITS, 2 * UNITS, [])
    frame = found.to_pandas().set_index("name")
    row = frame.loc["gyro_x.bias"]
    # Biases of 0.40 to 0.47, and 0.02 more in the second record.
    assert row.mean_low < 0.445 < row.mean_high
    assert row.spread_low < 0.0245 < row.spread_high
    assert pickle.loads(pickle.dumps(found)) == found
    assert "gyro_x.bias" in str(found) and "<table" in found._repr_html_()
    page = tmp_path / "fleet.html"
    found.report(page)
    assert "gyro_x.bias" in page.read_text() and "<html" in page.read_text()
    # What travels between machines.
    sizes = [len(row["result"]) + len(row["scores"]) for row in results.to_pylist()]
    assert max(sizes) < 200_000


def test_partitions_and_order_change_nothing(results):
    expected = fleet.summarise(results).to_dict()
    rows = [results.slice(at, 3).to_batches()[0] for at in range(0, results.num_rows, 3)]
    found = fleet.summarise(iter(rows[::-1])).to_dict()
    for result in (found, expected):
        del result["manifest"]["command"]
    assert found == expected


def test_wrong_records_are_named(results):
    rows = results.to_pylist()
    rows[1] |= {"result": None, "scores": None, "status": "failed", "error": "no bench"}
    rows[2] |= {"scores": b"other bytes"}
    rows[5] |= {"unit": rows[4]["unit"], "record": rows[4]["record"]}
    rows[7] |= {"result": "{}"}
    found = fleet.summarise([pa.RecordBatch.from_pylist(rows, fleet.OUTPUT)])
    problems = {(one.unit, one.record): one.problem for one in found.problems}
    assert set(problems) == {
        ("unit-0", "run-1"), ("unit-1", "run-0"), ("unit-2", "run-0"), ("unit-3", "run-1")
    }
    assert problems["unit-0", "run-1"] == "no bench"
    assert "two units with one name" in problems["unit-2", "run-0"]
    assert found.records == 2 * UNITS - 4
    with pytest.raises(gyrocal.InputError, match="no diagnosed record"):
        fleet.summarise([])
    with pytest.raises(gyrocal.InputError, match="probability"):
        fleet.summarise(results, false_discovery_rate=1.5)


def test_a_unit_with_one_record_has_a_level_and_no_change(results):
    rows = [row for row in results.to_pylist() if (row["unit"], row["record"]) != ("unit-0", "run-1")]
    found = fleet.summarise([pa.RecordBatch.from_pylist(rows, fleet.OUTPUT)])
    assert (found.units, found.records, found.problems) == (UNITS, 2 * UNITS - 1, [])
    bias = next(one for one in found.coefficients if one.name == "gyro_x.bias")
    own = next(level for level in bias.levels if level.unit == "unit-0")
    assert own.slope is None and abs(own.estimate - 0.4) < 0.01
    # A fleet of one unit with one record has no mean and no spread, and says so with null.
    found = fleet.summarise([pa.RecordBatch.from_pylist(rows[:1], fleet.OUTPUT)])
    assert (found.units, found.records) == (1, 1)
    assert all(one.mean is None and one.spread is None for one in found.coefficients)
    assert found.recurring == [] and found.groups == []
    assert "1 unit" in str(found)


def test_reports_of_other_results(results, tmp_path, simulated, diagnosed):
    page = tmp_path / "diagnosis.html"
    diagnosed.report(page)
    assert "gyro_y.g_z" in page.read_text()
    planned = gyrocal.plan(simulated.record, simulated.bench, diagnosis=diagnosed, hours=12)
    planned.report(page)
    assert "What the run gives" in page.read_text()
    calibrated = gyrocal.calibrate(simulated.record, simulated.bench)
    calibrated.report(page)
    text = page.read_text()
    assert "gyro_x.bias" in text and "<html" in text
    together = fleet.summarise(results)
    gyrocal.report([calibrated, diagnosed, planned, together], page)
    text = page.read_text()
    assert all(word in text for word in ("gyro_x.bias", "gyro_y.g_z", "What the run gives"))
    for wrong in ([], [1], simulated.record):
        with pytest.raises((gyrocal.InputError, TypeError)):
            gyrocal.report(wrong, page)
    with pytest.raises(gyrocal.InputError, match="Simulation"):
        simulated.report(page)
    assert together.manifest.command == "gyrocal.fleet.summarise(<Table>)"
    other = fleet.summarise(results, seed=3, group_probability=0.05, outlier_probability=0.02)
    assert other.manifest.command == (
        "gyrocal.fleet.summarise(<Table>, group_probability=0.05, outlier_probability=0.02, seed=3)"
    )
    assert diagnosed.scores and pickle.loads(pickle.dumps(diagnosed)).scores == diagnosed.scores
