"""Fleets of short records on Dask: what `cargo figures doors --part fleet` prints of them."""

import os
import random
import resource
import signal
import statistics
import tempfile
import threading
import time
from pathlib import Path

import dask
import distributed
import pyarrow as pa
import pyarrow.parquet as pq

import gyrocal
from gyrocal import fleet

#: A partition lasts about this long, s.
PARTITION_S = 1.0

#: Parts of the many records that are measured in turns.
BLOCKS = 20

#: Length of a short record.
HOURS = 3.0

#: Part of a block that the library works on, and one worker alone.
SAMPLE = 8

#: Kills in the run that is killed most, and in the others.
KILLS, KILLS_OF_OTHERS = 20, 2


def scenario(seed, hours):
    """Hours of one platform, a row a quarter of an hour; every tenth has a fault."""
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
        "sampling": {"duration_s": 3600.0 * hours, "interval_s": 900.0},
    }


def simulated(seeds, hours):
    """A batch of records, each of its seed."""
    made = [(seed, gyrocal.simulate(scenario(seed, hours))) for seed in seeds]
    rows = [(f"unit-{seed % 97}", f"run-{seed}", m.record, m.bench) for seed, m in made]
    return fleet.batch_of_records(rows)


def records_of(batch):
    return [fleet._record_of(given) for given in fleet._records(batch)]


def by_library(records):
    """Seconds of the library: results as JSON, as they are sent; what cannot be diagnosed is passed over."""
    started = time.perf_counter()
    for record, bench in records:
        try:
            gyrocal.diagnose(record, bench).to_json()
        except gyrocal.GyrocalError:
            continue
    return time.perf_counter() - started


def in_order(table):
    return table.sort_by([("unit", "ascending"), ("record", "ascending")])


def write(source, batch, partitions):
    """Partitions of equal numbers of rows."""
    source.mkdir()
    rows = -(-batch.num_rows // partitions)
    for part in range(partitions):
        table = pa.Table.from_batches([batch.slice(part * rows, rows)])
        pq.write_table(table, source / f"part-{part:04}.parquet")


def results(out):
    return in_order(pa.concat_tables([pq.read_table(path) for path in out.glob("part-*.parquet")]))


def present_mb():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * resource.getpagesize() / 2**20


def largest_mb():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def process():
    return os.getpid()


def cluster_of(workers):
    return distributed.LocalCluster(
        n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None
    )


# Equal results, whatever the workers and partitions are and whichever worker dies.


def measure_killed(count, folder):
    """1, 2 and 4 workers, three partitionings, workers that are killed."""
    batch = simulated(range(count), HOURS)
    table = pa.Table.from_batches(fleet.diagnose_batches([batch]), fleet.OUTPUT)
    expected = in_order(table)
    found = {"equal": True, "runs": 0, "kills": 0, "lost": 0, "repeated": 0}
    for partitions in (3, 7, 40):
        source = folder / f"in-{partitions}"
        write(source, batch, partitions)
        for workers in (1, 2, 4):
            kills = KILLS if (workers, partitions) == (2, 40) else KILLS_OF_OTHERS
            out = folder / f"out-{partitions}-{workers}"
            own = on_killed_cluster(source, out, workers, kills)
            found["equal"] &= results(out).equals(expected)
            found["runs"] += 1
            for name, value in own.items():
                found[name] += value
    return {"killed_records": count, **found}


def on_killed_cluster(source, out, workers, kills):
    """What killed workers lost and repeated."""
    finished = {}
    killed = []
    stop = threading.Event()

    def watch(client):
        chance = random.Random(11)
        while not stop.is_set():
            for path in out.glob("part-*.parquet"):
                finished.setdefault(path.name, path.stat().st_mtime_ns)
            if len(killed) < kills:
                kill_one(client, chance, killed)
            time.sleep(chance.uniform(0.1, 1.0))

    settings = {"distributed.scheduler.allowed-failures": 1000}
    with dask.config.set(settings), cluster_of(workers) as cluster, distributed.Client(cluster) as client:
        watcher = threading.Thread(target=watch, args=(client,))
        watcher.start()
        manifest = fleet.diagnose_partitions(source, out, client=client)
        stop.set()
        watcher.join()
        again = fleet.diagnose_partitions(source, out, client=client)
    changed = sum((out / name).stat().st_mtime_ns != moment for name, moment in finished.items())
    lost = len(manifest["partitions"]) - len(list(out.glob("part-*.parquet")))
    return {"kills": len(killed), "lost": lost, "repeated": changed + again["computed_partitions"]}


def kill_one(client, chance, killed):
    pids = client.run(process, on_error="ignore").values()
    pids = [pid for pid in pids if isinstance(pid, int)]
    if pids:
        pid = chance.choice(pids)
        try:
            os.kill(pid, signal.SIGKILL)
        except ProcessLookupError:
            return
        killed.append(pid)


# Cost of each stage.


def measure_stages(count, folder):
    """Seconds of each stage over records of three days, and bytes that it moves."""
    batch = simulated(range(count), 72.0)
    table = pa.Table.from_batches(fleet.diagnose_batches([batch]), fleet.OUTPUT)
    done = [row for row in table.to_pylist() if row["status"] == "done"]
    sizes = [len(row["result"]) + len(row["scores"] or b"") for row in done]
    write(folder / "stages", batch, 1)
    (source,) = (folder / "stages").glob("*.parquet")
    started = time.perf_counter()
    read = [one for one in pq.ParquetFile(source).iter_batches(64)]
    read_s = time.perf_counter() - started
    started = time.perf_counter()
    records = [record for one in read for record in records_of(one)]
    records_s = time.perf_counter() - started
    diagnosis_s = by_library(records)
    started = time.perf_counter()
    pq.write_table(table, folder / "result.parquet")
    write_s = time.perf_counter() - started
    started = time.perf_counter()
    before = present_mb()
    fleet.summarise(table)
    summary_s = time.perf_counter() - started
    return {
        "records": count,
        "largest_sent_bytes": max(sizes),
        "read_s": read_s,
        "records_s": records_s,
        "diagnosis_s": diagnosis_s,
        "write_s": write_s,
        "summary_s": summary_s,
        "summary_mb": max(largest_mb() - before, 0.0),
        "bytes_in": source.stat().st_size,
        "bytes_out": (folder / "result.parquet").stat().st_size,
        "rows_of_a_record": len(batch.column("time_s")[0]),
    }


def measure_fleet(killed, staged):
    """Equal results under kills, and the cost of each stage."""
    with tempfile.TemporaryDirectory() as folder:
        return measure_killed(killed, Path(folder)) | measure_stages(staged, Path(folder))


# Many short records: two workers against the library, part by part.


def measure_many(count):
    """Records a second and memory of workers over many records.

    In each part, the library works on a share of the records before the two workers, one worker on another
    one after them: what else the machine does is the same for all.
    """
    size = count // BLOCKS
    ratios, overheads, memory = [], [], []
    library_s = 0.0
    with cluster_of(2) as two, cluster_of(1) as one:
        with distributed.Client(two) as both, distributed.Client(one) as single:
            for client in (both, single):
                client.run(__import__, "gyrocal.fleet")
            partition = rows_of_a_partition()
            for block in range(BLOCKS):
                first = block * size
                chunks = [range(at, min(at + 250, first + size)) for at in range(first, first + size, 250)]
                batches = both.gather(both.map(simulated, chunks, hours=HOURS))
                (batch,) = pa.Table.from_batches(batches).combine_chunks().to_batches()
                sample = batch.slice(0, size // SAMPLE)
                with tempfile.TemporaryDirectory() as folder:
                    folder = Path(folder)
                    write(folder / "in", batch, -(-size // partition))
                    write(folder / "sample", sample, -(-sample.num_rows // partition))
                    records = records_of(sample)
                    before = by_library(records)
                    by_two = timed(folder / "in", folder / "two", both)
                    after = by_library(records)
                    by_one = timed(folder / "sample", folder / "one", single)
                alone = 0.5 * (before + after)
                library_s += alone / len(records)
                ratios.append(alone / len(records) / (by_two / size))
                overheads.append(by_one / alone - 1.0)
                memory.append(list(both.run(present_mb).values()))
            largest = max(both.run(largest_mb).values())
    return {
        "records": size * BLOCKS,
        "rows_of_a_record": len(batch.column("time_s")[0]),
        "rows_of_a_partition": partition,
        "library_s": library_s / BLOCKS,
        "blocks": BLOCKS,
        "ratio": statistics.median(ratios),
        "overhead": statistics.median(overheads),
        "worker_mb": largest,
        "growth_mb": growth(memory),
    }


def rows_of_a_partition():
    """Records of a partition that lasts as long as it should; the first diagnoses warm up."""
    records = records_of(simulated(range(200), HOURS))
    by_library(records[:50])
    return max(1, round(PARTITION_S * len(records) / by_library(records)))


def timed(source, out, client):
    started = time.perf_counter()
    manifest = fleet.diagnose_partitions(source, out, client=client)
    seconds = time.perf_counter() - started
    if manifest["unreadable"]:
        raise RuntimeError(str(manifest["unreadable"][0]))
    return seconds


def growth(memory):
    """Largest growth of a worker's memory from the first half of the parts to the second."""
    half = len(memory) // 2
    means = [
        [sum(part[worker] for part in parts) / len(parts) for parts in (memory[:half], memory[half:])]
        for worker in range(len(memory[0]))
    ]
    return max(last - first for first, last in means)
