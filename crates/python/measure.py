"""Measures what `cargo figures fleet` prints; writes JSON to stdout.

measure.py import               seconds of the import, in this process
measure.py diagnosis            seconds of one diagnosis of the example from a frame
measure.py fleet RECORDS        a fleet of short records on Dask
"""

import json
import sys
import time


def measure_import():
    started = time.perf_counter()
    import gyrocal

    return {"seconds": time.perf_counter() - started, "version": gyrocal.__version__}


def measure_diagnosis():
    import gyrocal

    frame = gyrocal.Record.read("examples/data/hidden_fault.csv").columns()
    started = time.perf_counter()
    found = gyrocal.diagnose(frame, "examples/data/hidden_fault.bench.toml")
    plain = found.to_dict()
    seconds = time.perf_counter() - started
    return {"seconds": seconds, "verdict": plain["verdict"]}


def scenario(seed):
    """Half a day of one platform; every tenth has a fault."""
    hidden = [{"effect": "gyro_y.g_z", "size": 0.5}] if seed % 10 == 0 else []
    return {
        "seed": seed,
        "site": {"latitude_deg": 39.1},
        "platform": {
            "initial_angles_deg": "random",
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


def measure_fleet(count):
    import tempfile
    from pathlib import Path

    import pyarrow as pa

    import gyrocal
    from gyrocal import fleet

    made = [gyrocal.simulate(scenario(seed)) for seed in range(count)]
    rows = [(f"unit-{i % 97}", f"run-{i}", m.record, m.bench) for i, m in enumerate(made)]
    batch = fleet.batch_of_records(rows)

    started = time.perf_counter()
    for one in made:
        gyrocal.diagnose(one.record, one.bench).to_json()
    library_s = time.perf_counter() - started
    started = time.perf_counter()
    batches = (batch.slice(at, 64) for at in range(0, count, 64))
    table = pa.Table.from_batches(fleet.diagnose_batches(batches), fleet.OUTPUT)
    batches_s = time.perf_counter() - started
    expected = in_order(table)

    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        equal = True
        worker_mb = 0.0
        two_s = None
        for workers, partitions in ((1, 3), (2, 16), (4, 7)):
            source, out = folder / f"in-{partitions}", folder / f"out-{partitions}"
            write(source, batch, partitions)
            seconds, memory, _ = on_cluster(source, out, workers, kills=0)
            equal &= results(out).equals(expected)
            worker_mb = max(worker_mb, memory)
            two_s = seconds if workers == 2 else two_s
        out = folder / "killed"
        source = folder / "in-killed"
        write(source, batch, 32)
        _, _, killed = on_cluster(source, out, 2, kills=20)
        equal &= results(out).equals(expected)
    return {
        "records": count,
        "library_s": library_s,
        "batches_s": batches_s,
        "two_workers_s": two_s,
        "equal": equal,
        "worker_mb": worker_mb,
        "largest_result_bytes": max(len(text) for text in expected.column("result").to_pylist()),
        **killed,
    }


def in_order(table):
    return table.sort_by([("unit", "ascending"), ("record", "ascending")])


def write(source, batch, partitions):
    import pyarrow as pa
    import pyarrow.parquet as pq

    source.mkdir()
    rows = -(-batch.num_rows // partitions)
    for part in range(partitions):
        table = pa.Table.from_batches([batch.slice(part * rows, rows)])
        pq.write_table(table, source / f"part-{part:04}.parquet")


def results(out):
    import pyarrow as pa
    import pyarrow.parquet as pq

    return in_order(pa.concat_tables([pq.read_table(path) for path in out.glob("part-*.parquet")]))


def resident_mb(dask_worker=None):
    import resource

    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def on_cluster(source, out, workers, kills):
    """Seconds, largest resident memory of a worker, and what killed workers lost and repeated."""
    import os
    import random
    import signal
    import threading

    import dask
    import distributed

    from gyrocal import fleet

    finished = {}
    killed = []
    stop = threading.Event()

    def watch(client):
        chance = random.Random(11)
        while not stop.is_set():
            for path in out.glob("part-*.parquet"):
                finished.setdefault(path.name, path.stat().st_mtime_ns)
            if len(killed) < kills:
                pids = client.run(os.getpid, on_error="ignore").values()
                pids = [pid for pid in pids if isinstance(pid, int)]
                if pids:
                    os.kill(chance.choice(pids), signal.SIGKILL)
                    killed.append(len(finished))
            time.sleep(chance.uniform(0.1, 1.0))

    with (
        dask.config.set({"distributed.scheduler.allowed-failures": 1000}),
        distributed.LocalCluster(
            n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        client.run(__import__, "gyrocal.fleet")
        watcher = threading.Thread(target=watch, args=(client,))
        if kills:
            watcher.start()
        started = time.perf_counter()
        manifest = fleet.diagnose_partitions(source, out, client=client)
        seconds = time.perf_counter() - started
        stop.set()
        if kills:
            watcher.join()
        memory = max(client.run(resident_mb).values())
    partitions = len(manifest["partitions"])
    repeated = sum((out / name).stat().st_mtime_ns != moment for name, moment in finished.items())
    lost = partitions - len(list(out.glob("part-*.parquet")))
    return seconds, memory, {"kills": len(killed), "lost": lost, "repeated": repeated}


if __name__ == "__main__":
    kind, *arguments = sys.argv[1:]
    if kind == "import":
        measured = measure_import()
    elif kind == "diagnosis":
        measured = measure_diagnosis()
    else:
        measured = measure_fleet(int(arguments[0]))
    print(json.dumps(measured))
