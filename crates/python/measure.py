"""Measures what `cargo figures doors --part fleet` prints; writes JSON to stdout.

measure.py import               seconds of the import, in this process
measure.py diagnosis            seconds of one diagnosis of the example from a frame
measure.py fleet KILLED STAGED  records on Dask whose workers are killed; cost of each stage of records
measure.py many RECORDS         many short records on two workers and in one process
measure.py spark RECORDS        the same rows by Spark, by the lines of docs/python.md; needs Java and pyspark
"""

import json
import sys
import time

# The folder of the sources stays clean.
sys.dont_write_bytecode = True


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


def measure_spark(count):
    """The lines of the page, in a folder of their own."""
    import os
    import tempfile
    from pathlib import Path

    import pyarrow as pa
    from measure_fleet import in_order, results, simulated, write

    from gyrocal import fleet

    os.environ.setdefault("PYSPARK_PYTHON", sys.executable)
    page = Path("docs/python.md").read_text()
    (lines,) = [block.partition("```")[0] for block in page.split("```python\n")[1:] if "mapInArrow" in block]
    batch = simulated(range(count), 12.0)
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


def measured(kind, arguments):
    if kind == "import":
        return measure_import()
    if kind == "diagnosis":
        return measure_diagnosis()
    if kind == "spark":
        return measure_spark(int(arguments[0]))
    import measure_fleet

    if kind == "many":
        return measure_fleet.measure_many(int(arguments[0]))
    return measure_fleet.measure_fleet(*map(int, arguments))


if __name__ == "__main__":
    print(json.dumps(measured(sys.argv[1], sys.argv[2:])))
