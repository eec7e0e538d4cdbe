"""Measures what `cargo figures fleet` prints; writes JSON to stdout.

measure.py import               seconds of the import, in this process
measure.py diagnosis            seconds of one diagnosis of the example from a frame
measure.py fleet RECORDS        a fleet of short records on Dask
measure.py spark RECORDS        the same rows by Spark, by the lines of docs/python.md; needs Java and pyspark
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
    tables = []
    resident = []
    for at in range(0, count, 64):
        tables += fleet.diagnose_batches([batch.slice(at, 64)])
        resident.append((time.perf_counter() - started, present_mb()))
    batches_s = time.perf_counter() - started
    table = pa.Table.from_batches(tables, fleet.OUTPUT)
    expected = in_order(table)
    held_mb = table.nbytes / 1e6

    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        stages = measure_stages(folder, batch, table, library_s)
        equal = True
        worker_mb = 0.0
        two_s = None
        killed = {"kills": 0, "lost": 0, "repeated": 0}
        runs = 0
        for partitions in (3, 7, 16):
            source = folder / f"in-{partitions}"
            write(source, batch, partitions)
            for workers in (1, 2, 4):
                # The speed is that of two workers which nothing disturbs.
                kills = 0 if (workers, partitions) == (2, 16) else 3
                out = folder / f"out-{partitions}-{workers}"
                seconds, memory, own = on_cluster(source, out, workers, kills)
                equal &= results(out).equals(expected)
                worker_mb = max(worker_mb, memory)
                two_s = two_s if kills else seconds
                killed = {name: killed[name] + own[name] for name in killed}
                runs += 1
    return {
        "records": count,
        "library_s": library_s,
        "batches_s": batches_s,
        "two_workers_s": two_s,
        "equal": equal,
        "runs": runs,
        "worker_mb": worker_mb,
        "growth_mb": growth(resident, held_mb),
        "largest_sent_bytes": max(
            len(row["result"]) + len(row["scores"]) for row in expected.to_pylist()
        ),
        **stages,
        **killed,
    }


def growth(resident, held_mb):
    """Growth of the memory from the first half of the batches to the second, without their results."""
    half = len(resident) // 2
    if not half:
        return 0.0
    first, last = (sum(mb for _, mb in part) / len(part) for part in (resident[:half], resident[half:]))
    return last - first - 0.5 * held_mb


def measure_stages(folder, batch, table, library_s):
    """Seconds of each stage over all records, and bytes that it moves."""
    import pyarrow.parquet as pq

    import gyrocal
    from gyrocal import fleet

    write(folder / "stages", batch, 1)
    (source,) = (folder / "stages").glob("*.parquet")
    started = time.perf_counter()
    read = [one for one in pq.ParquetFile(source).iter_batches(64)]
    read_s = time.perf_counter() - started
    started = time.perf_counter()
    for one in read:
        for given in fleet._records(one):
            fleet._record_of(given)
    records_s = time.perf_counter() - started
    started = time.perf_counter()
    pq.write_table(table, folder / "result.parquet")
    write_s = time.perf_counter() - started
    started = time.perf_counter()
    before = present_mb()
    fleet.summarise(table)
    summary_s = time.perf_counter() - started
    return {
        "read_s": read_s,
        "records_s": records_s,
        "diagnosis_s": library_s,
        "write_s": write_s,
        "summary_s": summary_s,
        "summary_mb": max(resident_mb() - before, 0.0),
        "bytes_in": source.stat().st_size,
        "bytes_out": (folder / "result.parquet").stat().st_size,
        "rows_of_a_record": len(batch.column("time_s")[0]),
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


def present_mb():
    import resource

    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * resource.getpagesize() / 2**20


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


def measure_spark(count):
    """The lines of the page, in a folder of their own."""
    import os
    import tempfile
    from pathlib import Path

    import pyarrow as pa

    import gyrocal
    from gyrocal import fleet

    os.environ.setdefault("PYSPARK_PYTHON", sys.executable)
    page = Path("docs/python.md").read_text()
    (lines,) = [block.partition("```")[0] for block in page.split("```python\n")[1:] if "mapInArrow" in block]
    made = [gyrocal.simulate(scenario(seed)) for seed in range(count)]
    rows = [(f"unit-{i % 7}", f"run-{i}", m.record, m.bench) for i, m in enumerate(made)]
    batch = fleet.batch_of_records(rows)
    expected = in_order(pa.Table.from_batches(fleet.diagnose_batches([batch]), fleet.OUTPUT))
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        write(Path("records"), batch, 3)
        started = time.perf_counter()
        exec(lines, {"__name__": "__main__"})
        seconds = time.perf_counter() - started
        found = results(Path("results")).cast(fleet.OUTPUT)
        os.chdir("/")
    return {"records": count, "seconds": seconds, "equal": found.equals(expected)}


if __name__ == "__main__":
    kind, *arguments = sys.argv[1:]
    if kind == "import":
        measured = measure_import()
    elif kind == "diagnosis":
        measured = measure_diagnosis()
    elif kind == "spark":
        measured = measure_spark(int(arguments[0]))
    else:
        measured = measure_fleet(int(arguments[0]))
    print(json.dumps(measured))
