"""Fleets: batches of Arrow, partitions of Parquet, workers that are killed."""

import json
import os
import random
import signal
import threading
import time

import dask
import distributed
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import gyrocal
from gyrocal import fleet

RECORDS = 16
FAULT_EVERY = 4


def scenario(index):
    hidden = [{"effect": "gyro_y.g_z", "size": 0.5}] if index % FAULT_EVERY == 0 else []
    return {
        "seed": index,
        "site": {"latitude_deg": 39.1},
        "platform": {
            "initial_angles_deg": [12.0, -25.0, 40.0],
            "initial_angles_sigma_deg": [0.01, 0.01, 0.01],
        },
        "gyros": {
            "bias_deg_per_h": [0.412, -0.287, 0.153],
            "g_deg_per_h_per_g": [-0.126, 0.214, 0.087],
            "gg_deg_per_h_per_g2": [0.041, -0.068, 0.023],
        },
        "hidden": hidden,
        "noise": {"accel_g": 1e-5, "gyro_deg_per_h": 0.002},
        "sampling": {"duration_s": 43200.0, "interval_s": 900.0},
    }


@pytest.fixture(scope="module")
def records():
    rows = []
    for index in range(RECORDS):
        made = gyrocal.simulate(scenario(index))
        rows.append((f"unit-{index % 7}", f"run-{index}", made.record, made.bench))
    return fleet.batch_of_records(rows)


def diagnosed(batches):
    table = pa.Table.from_batches(fleet.diagnose_batches(batches), fleet.OUTPUT)
    return table.sort_by([("unit", "ascending"), ("record", "ascending")])


@pytest.fixture(scope="module")
def expected(records):
    return diagnosed([records])


def write_partitions(folder, records, count):
    folder.mkdir(exist_ok=True)
    rows = -(-records.num_rows // count)
    for part in range(count):
        table = pa.Table.from_batches([records.slice(part * rows, rows)])
        pq.write_table(table, folder / f"part-{part:02}.parquet", row_group_size=3)


def results(out):
    tables = [pq.read_table(path) for path in sorted(out.glob("part-*.parquet"))]
    table = pa.concat_tables(tables)
    return table.sort_by([("unit", "ascending"), ("record", "ascending")])


def test_results_do_not_depend_on_batches_and_order(records, expected):
    for rows in (1, 5):
        batches = [records.slice(at, rows) for at in range(0, records.num_rows, rows)]
        random.Random(rows).shuffle(batches)
        assert diagnosed(iter(batches)).equals(expected)
    table = expected.to_pydict()
    # Half a day shows the fault; its name takes longer.
    for record, verdict in zip(table["record"], table["verdict"]):
        has_fault = int(record.split("-")[1]) % FAULT_EVERY == 0
        assert verdict in (("effects-found", "not-settled") if has_fault else ("clean",)), record


def test_a_row_is_the_result_of_its_record(records, expected):
    made = gyrocal.simulate(scenario(0))
    found = gyrocal.diagnose(made.record, made.bench).to_dict()
    row = next(row for row in expected.to_pylist() if row["record"] == "run-0")
    result = json.loads(row["result"])
    for one in (found, result):
        del one["manifest"]
    assert result == found
    # What travels between machines.
    assert max(len(text) for text in expected.column("result").to_pylist()) < 200_000


def test_wrong_records_are_rows_and_the_others_go_on(records, expected):
    rows = records.slice(0, 7).to_pylist()
    for column in ("accel_x_g", "accel_y_g", "accel_z_g"):
        rows[0][column] = [9.81 * value for value in rows[0][column]]
    rows[1]["bench"] = rows[1]["bench"].replace("39.1", "91.0")
    rows[2]["time_s"] = None
    rows[3]["accel_y_g"] = rows[3]["accel_y_g"][:-1]
    rows[4]["accel_z_g"][5] = float("inf")
    rows[5] |= {"time_s": [float("nan"), *rows[5]["time_s"][1:]]}
    found = diagnosed([pa.RecordBatch.from_pylist(rows, fleet.INPUT)]).to_pylist()
    found = {row["record"]: row for row in found}
    # A gross error of the set-up is an answer.
    assert (found["run-0"]["status"], found["run-0"]["verdict"]) == ("done", "setup")
    for name, words in [
        ("run-1", ["unit-1/run-1", "91"]),
        ("run-2", ["unit-2/run-2", "time_s"]),
        ("run-3", ["unit-3/run-3", "lengths"]),
        ("run-4", ["accel_z_g", "row 5", "inf"]),
        ("run-5", ["time_s", "row 0", "NaN"]),
    ]:
        assert found[name]["status"] == "failed"
        assert all(word in found[name]["error"] for word in words), found[name]["error"]
        assert found[name]["advice"] or name == "run-1"
    assert found["run-6"] == next(row for row in expected.to_pylist() if row["record"] == "run-6")
    with pytest.raises(gyrocal.InputError, match="bench"):
        list(fleet.diagnose_batches([records.drop_columns(["bench"])]))
    other = records.set_column(3, "time_s", pa.array(["a"] * RECORDS))
    with pytest.raises(gyrocal.InputError, match="time_s.*string"):
        list(fleet.diagnose_batches([other]))


def test_partitions_are_done_once(tmp_path, records, expected):
    source, out = tmp_path / "in", tmp_path / "out"
    write_partitions(source, records, 4)
    manifest = fleet.diagnose_partitions(source, out)
    assert (manifest["done"], manifest["failed"], manifest["computed_partitions"]) == (RECORDS, [], 4)
    assert results(out).equals(expected)
    assert fleet.read_manifest(out) == manifest
    times = {path.name: path.stat().st_mtime_ns for path in out.glob("*.parquet")}

    # One result is lost and one input changes; a partition cannot be read; a name comes twice.
    (out / "part-01.parquet").unlink()
    pq.write_table(pa.Table.from_batches([records.slice(0, 1)]), source / "part-03.parquet")
    (source / "part-04.parquet").write_bytes(b"no Parquet")
    manifest = fleet.diagnose_partitions(source, out)
    assert manifest["computed_partitions"] == 3
    assert [one["partition"] for one in manifest["unreadable"]] == ["part-04.parquet"]
    assert manifest["names_given_twice"] == [["unit-0", "run-0"]]
    after = {path.name: path.stat().st_mtime_ns for path in out.glob("*.parquet")}
    assert {name for name in times if times[name] != after[name]} == {
        "part-01.parquet",
        "part-03.parquet",
    }
    # Other settings are another job.
    (source / "part-04.parquet").unlink()
    assert fleet.diagnose_partitions(source, out, false_alarm=0.02)["computed_partitions"] == 4
    with pytest.raises(gyrocal.InputError, match="no partition"):
        fleet.diagnose_partitions(tmp_path, out)


def test_a_summary_counts_no_stale_result(tmp_path, records):
    source, out = tmp_path / "in", tmp_path / "out"
    write_partitions(source, records.slice(0, 6), 3)
    fleet.diagnose_partitions(source, out)
    assert fleet.summarise(out).records == 6
    # A partition can no longer be read, and one is gone.
    (source / "part-01.parquet").write_bytes(b"no Parquet")
    (source / "part-02.parquet").unlink()
    manifest = fleet.diagnose_partitions(source, out)
    assert [one["partition"] for one in manifest["unreadable"]] == ["part-01.parquet"]
    assert sorted(path.name for path in out.glob("*.parquet")) == ["part-00.parquet", "part-02.parquet"]
    assert fleet.summarise(out).records == 2
    # Without a manifest, as of another engine, all files count.
    (out / "manifest.json").unlink()
    assert fleet.summarise(out).records == 4
    fleet.diagnose_partitions(source, out)
    (out / "part-00.parquet").unlink()
    with pytest.raises(gyrocal.InputError, match="part-00.*no result"):
        fleet.summarise(out)


def test_what_is_no_file_is_told_and_the_others_go_on(tmp_path, records):
    source, out = tmp_path / "in", tmp_path / "out"
    write_partitions(source, records.slice(0, 4), 2)
    (source / "part-09.parquet").mkdir()
    (source / "part-10.parquet").symlink_to(tmp_path / "gone.parquet")
    manifest = fleet.diagnose_partitions(source, out)
    assert (manifest["done"], manifest["computed_partitions"]) == (4, 4)
    errors = {one["partition"]: one["error"] for one in manifest["unreadable"]}
    assert "directory" in errors["part-09.parquet"] and "No such file" in errors["part-10.parquet"]
    # A partition that was done, and is a directory now.
    (source / "part-01.parquet").unlink()
    (source / "part-01.parquet").mkdir()
    # What another run in the same folder is writing is not touched.
    other = out / ".part-00.parquet.0123.4567.tmp"
    other.touch()
    manifest = fleet.diagnose_partitions(source, out)
    assert (manifest["done"], len(manifest["unreadable"]), other.exists()) == (2, 3, True)
    assert fleet.summarise(out).records == 2


class GivingUp:
    """A cluster whose workers die of one partition, as often as it is tried."""

    def __init__(self, poison):
        self.poison = poison

    def map(self, function, paths, *, pure, **settings):
        return [self.Task(function, path, settings, self.poison) for path in paths]

    def gather(self, tasks, errors):
        assert errors == "skip"

    class Task:
        def __init__(self, function, path, settings, poison):
            self.status = "error" if path.name == poison else "finished"
            if self.status == "finished":
                function(path, **settings)

        def exception(self):
            return RuntimeError("the worker died")


def test_a_partition_that_kills_its_workers_is_named_and_the_others_go_on(tmp_path, records):
    source, out = tmp_path / "in", tmp_path / "out"
    write_partitions(source, records.slice(0, 6), 3)
    manifest = fleet.diagnose_partitions(source, out, client=GivingUp("part-01.parquet"))
    assert manifest["done"] == 4
    (lost,) = manifest["unreadable"]
    assert lost["partition"] == "part-01.parquet" and "the worker died" in lost["error"]
    # A later call tries it again, and nothing else.
    manifest = fleet.diagnose_partitions(source, out)
    assert (manifest["done"], manifest["unreadable"], manifest["computed_partitions"]) == (6, [], 1)
    # With other settings the partition is lost again, and its old result with it.
    cluster = GivingUp("part-01.parquet")
    assert fleet.diagnose_partitions(source, out, client=cluster, false_alarm=0.02)["done"] == 4
    assert not (out / "part-01.parquet").exists()


def test_columns_of_other_names_are_refused_in_words(records):
    columns = ["accel_x_mg" if name == "accel_x_g" else name for name in records.schema.names]
    with pytest.raises(gyrocal.InputError, match="accel_x_mg.*accel_x_g"):
        list(fleet.diagnose_batches([records.rename_columns(columns)]))


def test_killed_workers_lose_and_repeat_nothing(tmp_path, records, expected):
    source, out = tmp_path / "in", tmp_path / "out"
    write_partitions(source, records, 8)
    finished = {}
    stop = threading.Event()
    kills = []

    def watch(client):
        """Notes when each result appears, and kills a worker now and then."""
        chance = random.Random(7)
        while not stop.is_set():
            for path in out.glob("part-*.parquet"):
                finished.setdefault(path.name, path.stat().st_mtime_ns)
            if len(kills) < 3 and len(finished) >= len(kills):
                pids = list(client.run(os.getpid, on_error="ignore").values())
                pids = [pid for pid in pids if isinstance(pid, int)]
                if pids:
                    os.kill(chance.choice(pids), signal.SIGKILL)
                    kills.append(len(finished))
            time.sleep(chance.uniform(0.05, 0.4))

    settings = {
        "distributed.scheduler.allowed-failures": 100,
        "distributed.comm.timeouts.connect": "60s",
    }
    with (
        dask.config.set(settings),
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        watcher = threading.Thread(target=watch, args=(client,))
        watcher.start()
        manifest = fleet.diagnose_partitions(source, out, client=client)
        stop.set()
        watcher.join()
        assert kills and manifest["done"] == RECORDS
        assert results(out).equals(expected)
        # No result was written again after it was finished.
        for name, moment in finished.items():
            assert (out / name).stat().st_mtime_ns == moment, name
        assert fleet.diagnose_partitions(source, out, client=client)["computed_partitions"] == 0
    assert not list(out.glob(".*.tmp"))
