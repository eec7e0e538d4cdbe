"""Diagnoses of the records of a fleet, on any engine that maps batches of Arrow.

A row of the input is one record, with the columns of :data:`INPUT`: lists of times and of specific force, and
the text of the bench description. A row of the output is the result of one record, with the columns of
:data:`OUTPUT`. :func:`diagnose_batches` maps an iterator of batches to an iterator of batches; a row depends
on nothing but the row of its record, so that partitions, workers and order change no bit of it.
:func:`diagnose_partitions` runs it over Parquet files, here or on a Dask cluster, and goes on where an
earlier run ended.

It needs PyArrow, and Dask for a cluster.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any
from uuid import uuid4

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from . import _gyrocal
from ._arguments import call, check
from ._calls import diagnose
from ._errors import GyrocalError, InputError, refusal
from ._record import COLUMNS, Bench, Record, as_record
from ._results import Diagnosis, Fleet

__all__ = [
    "INPUT",
    "OUTPUT",
    "batch_of_records",
    "diagnose_batches",
    "diagnose_partitions",
    "read_manifest",
    "summarise",
]

_NUMBERS = pa.list_(pa.float64())

#: What an operator knows of a record beside its name: ``date_s`` are seconds since any fixed moment.
KNOWN = [
    pa.field("date_s", pa.float64()),
    pa.field("batch", pa.string()),
    pa.field("site", pa.string()),
]

#: Columns of the input; ``temperature_c`` and those of :data:`KNOWN` may be null, or absent.
INPUT = pa.schema(
    [
        pa.field("unit", pa.string()),
        pa.field("record", pa.string()),
        pa.field("bench", pa.string()),
        *(pa.field(name, _NUMBERS) for name in COLUMNS),
        *KNOWN,
    ]
)

#: Columns that a batch may lack.
_OPTIONAL = {COLUMNS[4], *(field.name for field in KNOWN)}

#: Columns of the output. ``status`` is ``done`` or ``failed``; ``result`` is the JSON of the diagnosis,
#: ``scores`` what :func:`summarise` pools (:attr:`gyrocal.Diagnosis.scores`), and ``error`` and ``advice``
#: tell what is wrong with a record that could not be diagnosed.
OUTPUT = pa.schema(
    [
        pa.field("unit", pa.string()),
        pa.field("record", pa.string()),
        pa.field("status", pa.string()),
        pa.field("verdict", pa.string()),
        pa.field("effects", pa.list_(pa.string())),
        pa.field("z", pa.float64()),
        pa.field("p_value", pa.float64()),
        pa.field("result", pa.string()),
        pa.field("scores", pa.binary()),
        *KNOWN,
        pa.field("error", pa.string()),
        pa.field("advice", pa.string()),
    ]
)

#: Columns whose values are often the same.
_REPEATED = ["status", "verdict", "effects.list.element"]

#: Records that are read, diagnosed and written at a time.
BATCH_ROWS = 64

_MANIFEST = "manifest.json"


def batch_of_records(records: Iterable[tuple[Any, ...]]) -> pa.RecordBatch:
    """A batch of the input from tuples of unit, name of the record, record and bench description.

    A fifth element is a mapping of what else is known, with the keys of :data:`KNOWN`.

    Args:
        records: The tuples; a record and a bench description as :func:`gyrocal.diagnose` takes them, but for the
            path of a bench file: a text is that of the file.

    Returns:
        A batch of the columns :data:`INPUT`, a row for each record: times in s, specific force in g.

    Raises:
        InputError: An element or a record is wrong.

    >>> import gyrocal
    >>> from gyrocal import fleet
    >>> made = gyrocal.simulate("examples/data/hidden_fault.scenario.toml")
    >>> batch = fleet.batch_of_records([("unit-1", "run-1", made.record, made.bench)])
    >>> batch.num_rows, batch.schema.names[:3]
    (1, ['unit', 'record', 'bench'])
    """
    columns: dict[str, list[Any]] = {name: [] for name in INPUT.names}
    for given in records:
        if not isinstance(given, (list, tuple)) or len(given) not in (4, 5):
            raise refusal("records", f"a {type(given).__name__}", "tuples of unit, name, record and bench")
        unit, name, record, bench, *rest = given
        known = rest[0] if rest else {}
        for field in KNOWN:
            columns[field.name].append(known.get(field.name))
        held = as_record(record)
        columns["unit"].append(unit)
        columns["record"].append(name)
        columns["bench"].append(bench.to_toml() if isinstance(bench, Bench) else bench)
        values = held.columns()
        for column in COLUMNS:
            columns[column].append(values.get(column))
    arrays = [pa.array(columns[field.name], field.type) for field in INPUT]
    return pa.RecordBatch.from_arrays(arrays, schema=INPUT)


def diagnose_batches(
    batches: Iterable[pa.RecordBatch], *, false_alarm: float = 0.01
) -> Iterator[pa.RecordBatch]:
    """Diagnoses every record of every batch: a batch of the output for each batch of the input.

    A record that is wrong gives a row with ``status`` ``failed`` that says what to do; the others go on.

    Args:
        batches: Batches of the columns :data:`INPUT`.
        false_alarm: Family-wise probability of a false alarm of each diagnosis.

    Yields:
        Batches of the columns :data:`OUTPUT`.

    Raises:
        InputError: A batch lacks a column, or a column has another type.

    >>> import gyrocal
    >>> from gyrocal import fleet
    >>> made = gyrocal.simulate("examples/data/hidden_fault.scenario.toml")
    >>> batch = fleet.batch_of_records([("unit-1", "run-1", made.record, made.bench)])
    >>> [row["effects"] for done in fleet.diagnose_batches([batch]) for row in done.to_pylist()]
    [['gyro_y.g_z']]
    """
    check("false_alarm", false_alarm)
    for batch in _of_arrow("batches", batches):
        rows = [_row(one, false_alarm) for one in _records(batch)]
        columns = [pa.array([row[field.name] for row in rows], field.type) for field in OUTPUT]
        yield pa.RecordBatch.from_arrays(columns, schema=OUTPUT)


def diagnose_partitions(
    source: str | os.PathLike[str],
    out: str | os.PathLike[str],
    *,
    client: Any = None,
    false_alarm: float = 0.01,
) -> dict[str, Any]:
    """Diagnoses the records of all Parquet files of a folder; results are files of the same names.

    A result is written whole or not at all, and beside it a note of what was done. A later call with the
    same settings repeats no partition that has one and whose input is the same. A partition that cannot be
    read, or is given up, is told in the manifest and has no result, not even one of an earlier call.

    Args:
        source: The folder of the input.
        out: The folder of the results, which is made. ``manifest.json`` in it tells what became of
            each partition, what failed, and which names are there twice.
        client: A ``distributed.Client``; without it the partitions are worked on here, one after the other.
            A partition is given up when more workers have died with it than
            ``distributed.scheduler.allowed-failures`` says.
        false_alarm: Family-wise probability of a false alarm of each diagnosis.

    Returns:
        The manifest.

    Raises:
        InputError: There is no partition, or an argument is wrong.

    >>> import gyrocal
    >>> from gyrocal import fleet
    >>> made = gyrocal.simulate("examples/data/hidden_fault.scenario.toml")
    >>> batch = fleet.batch_of_records([("unit-1", "run-1", made.record, made.bench)])
    >>> import pathlib, tempfile
    >>> import pyarrow as pa, pyarrow.parquet as pq
    >>> folder = pathlib.Path(tempfile.mkdtemp())
    >>> (folder / "records").mkdir()
    >>> pq.write_table(pa.Table.from_batches([batch]), folder / "records" / "part-0.parquet")
    >>> manifest = fleet.diagnose_partitions(folder / "records", folder / "results")
    >>> manifest["done"], manifest["failed"]
    (1, [])
    """
    check("false_alarm", false_alarm)
    source, out = Path(source), Path(out)
    partitions = sorted(source.glob("*.parquet"))
    if not partitions:
        raise InputError(
            f"{source}: found no partition, expected files *.parquet",
            file=str(source),
            advice="write the records with pyarrow.parquet; fleet.INPUT has the columns",
        )
    out.mkdir(parents=True, exist_ok=True)
    left = [path for path in partitions if not _is_done(path, out, false_alarm)]
    run = uuid4().hex
    if client is None:
        for path in left:
            _diagnose_partition(path, out, false_alarm, run)
    else:
        # Not pure: a result is a file, which the engine does not see. A worker that dies costs its
        # partition, which another one begins anew.
        tasks = client.map(_diagnose_partition, left, out=out, false_alarm=false_alarm, run=run, pure=False)
        client.gather(tasks, errors="skip")
        for path, task in zip(left, tasks):
            if task.status == "error":
                _note_failure(path, out, false_alarm, run, task.exception())
    # What workers of this run that died had begun; another run may be at work in the same folder.
    for unfinished in out.glob(f".*.{run}.*.tmp"):
        unfinished.unlink(missing_ok=True)
    manifest = _manifest(partitions, out, computed=len(left))
    _write_whole(out / _MANIFEST, json.dumps(manifest, indent=2).encode(), run)
    return manifest


def read_manifest(out: str | os.PathLike[str]) -> dict[str, Any]:
    """The manifest of the last call of :func:`diagnose_partitions` with this folder.

    Args:
        out: The folder of the results.

    Returns:
        What that call returned.

    >>> import pathlib, tempfile
    >>> from gyrocal import fleet
    >>> folder = pathlib.Path(tempfile.mkdtemp())
    >>> written = (folder / "manifest.json").write_text('{"done": 1, "failed": []}')
    >>> fleet.read_manifest(folder)["done"]
    1
    """
    return dict(json.loads((Path(out) / _MANIFEST).read_text()))


def summarise(
    results: str | os.PathLike[str] | pa.Table | Iterable[pa.RecordBatch],
    *,
    false_discovery_rate: float = _gyrocal.FALSE_DISCOVERY_RATE,
    group_probability: float = _gyrocal.GROUP_PROBABILITY,
    outlier_probability: float = _gyrocal.OUTLIER_PROBABILITY,
    seed: int = 0,
) -> Fleet:
    """Shows what the records of a fleet show together and none of them by itself.

    Coefficients over units and time, causes that recur below what each unit shows, batches and sites that
    differ. It needs the results of the records, and not their samples.

    Args:
        results: A folder of :func:`diagnose_partitions`, of which the partitions count that its manifest
            has as done; any other folder of Parquet files, or batches or a table of the output.
        false_discovery_rate: Share of false ones among the causes that recur.
        group_probability: Family-wise probability that a fleet without differences shows a batch or site.
        outlier_probability: Family-wise probability that a coefficient without outliers shows one.
        seed: Seed of the draws that p-values come from.

    Returns:
        Coefficients over units with spreads and intervals, recurring causes, and batches and sites that differ.

    Raises:
        InputError: An argument is wrong, or no record was diagnosed.

    >>> import gyrocal
    >>> from gyrocal import fleet
    >>> made = gyrocal.simulate("examples/data/hidden_fault.scenario.toml")
    >>> batch = fleet.batch_of_records([("unit-1", "run-1", made.record, made.bench)])
    >>> fleet.summarise(fleet.diagnose_batches([batch]))
    <gyrocal.Fleet of 1 units>
    """
    command = call(summarise, locals())
    records = [_summarised(row) for batch in _batches(results) for row in batch.to_pylist()]
    return Fleet(
        _gyrocal.summarise_fleet(
            records, false_discovery_rate, group_probability, outlier_probability, seed, command
        )
    )


#: Columns of the output that a summary reads.
_SUMMARISED = ("unit", "record", "result", "scores", "error", *(field.name for field in KNOWN))


def _batches(results: Any) -> Iterator[pa.RecordBatch]:
    if isinstance(results, (str, os.PathLike)):
        for path in _finished(Path(results)):
            with pq.ParquetFile(path) as file:
                yield from file.iter_batches(BATCH_ROWS, columns=list(_SUMMARISED))
        return
    yield from _of_arrow("results", results)


def _of_arrow(name: str, batches: Any) -> Iterator[pa.RecordBatch]:
    """The batches of an argument: of a table, or those that are given."""
    given = batches.to_batches() if isinstance(batches, pa.Table) else batches
    for batch in given if isinstance(given, Iterable) else [given]:
        if not isinstance(batch, pa.RecordBatch):
            raise refusal(name, f"a {type(batch).__name__}", "batches of Arrow", "give a list of pyarrow.RecordBatch")
        yield batch


def _finished(out: Path) -> list[Path]:
    """The files of results: those that a manifest has as done, else all."""
    if not (out / _MANIFEST).exists():
        return sorted(out.glob("*.parquet"))
    partitions = read_manifest(out)["partitions"]
    paths = [out / one["partition"] for one in partitions if one["status"] == "done"]
    missing = next((path for path in paths if not path.exists()), None)
    if missing is not None:
        raise InputError(
            f"{missing}: found no result, which the manifest has as done",
            file=str(missing),
            advice="finish the fleet: fleet.diagnose_partitions",
        )
    return paths


def _summarised(row: dict[str, Any]) -> dict[str, Any]:
    found = {name: row.get(name) for name in _SUMMARISED}
    for name in ("unit", "record"):
        if found[name] is None:
            found |= {name: "<without a name>", "result": None}
            found["error"] = found["error"] or f"it has no name of its {name}"
    return found


def _records(batch: pa.RecordBatch) -> Iterator[dict[str, Any]]:
    """The records of a batch, their numbers as views of its buffers."""
    names = batch.schema.names
    for field in INPUT:
        if field.name not in names and field.name not in _OPTIONAL:
            raise InputError(
                f"batch: found the columns {', '.join(names)}, expected `{field.name}` too",
                expected=field.name,
                advice="fleet.INPUT has the columns and their types",
            )
    columns = {field.name: _cells(_cast(batch, field)) for field in INPUT if field.name in names}
    for row in range(batch.num_rows):
        yield {name: cells[row] for name, cells in columns.items()}


def _cast(batch: pa.RecordBatch, field: pa.Field) -> pa.Array:
    column = batch.column(field.name)
    try:
        return column if column.type == field.type else column.cast(field.type)
    except pa.ArrowInvalid as error:
        raise _other_type(column, field) from error
    except pa.ArrowNotImplementedError as error:
        raise _other_type(column, field) from error


def _other_type(column: pa.Array, field: pa.Field) -> InputError:
    return InputError(
        f"batch, column `{field.name}`: found the type {column.type}, expected {field.type}",
        found=str(column.type),
        expected=str(field.type),
        advice="fleet.INPUT has the columns and their types",
    )


def _cells(column: pa.Array) -> list[Any]:
    """The values of a column; lists of numbers are views of its buffer."""
    if not pa.types.is_list(column.type) or len(column) == 0:
        return list(column.to_pylist())
    ends = column.offsets.to_numpy()
    # A batch may be a part of a larger buffer.
    ends, first = ends - ends[0], ends[0]
    numbers = column.values.slice(first, ends[-1]).to_numpy(zero_copy_only=False)
    known = column.is_valid().to_pylist()
    return [numbers[a:b] if is_known else None for a, b, is_known in zip(ends, ends[1:], known)]


def _row(given: dict[str, Any], false_alarm: float) -> dict[str, Any]:
    row = dict.fromkeys(OUTPUT.names)
    row.update(unit=given["unit"], record=given["record"], status="failed")
    row.update({field.name: given.get(field.name) for field in KNOWN})
    try:
        found = _diagnosis(given, false_alarm)
    except GyrocalError as error:
        row.update(error=": ".join([error.message, *error.causes]), advice=error.advice)
        return row
    findings = found.findings
    row.update(
        status="done",
        verdict=found.verdict,
        effects=[finding["effect"] for finding in findings],
        result=found.to_json(),
        scores=found.scores,
    )
    if findings:
        row.update(z=findings[0]["z"], p_value=findings[0]["p_value"])
    return row


def _diagnosis(given: dict[str, Any], false_alarm: float) -> Diagnosis:
    name = f"{given['unit']}/{given['record']}"
    required = ("unit", "record", "bench", *COLUMNS[:4])
    missing = [column for column in required if given[column] is None]
    if missing:
        raise InputError(
            f"{name}: found no `{missing[0]}`", advice="leave the record out, or give what is missing"
        )
    return diagnose(*_record_of(given), false_alarm=false_alarm)


def _record_of(given: dict[str, Any]) -> tuple[Record, Bench]:
    """The record and the bench description of a row."""
    name = f"{given['unit']}/{given['record']}"
    bench = Bench.parse(given["bench"], name=f"{name}: bench")
    columns = {column: given[column] for column in COLUMNS if given.get(column) is not None}
    lengths = {column: len(values) for column, values in columns.items()}
    if len(set(lengths.values())) > 1:
        raise InputError(
            f"{name}: found columns of different lengths, {lengths}, expected one",
            advice="give all columns of the same rows; a missing value is nan",
        )
    samples = np.column_stack([columns[column] for column in COLUMNS[1:4]])
    return Record(columns["time_s"], samples, columns.get(COLUMNS[4]), name=name), bench


def _diagnose_partition(path: Path, out: Path, false_alarm: float, run: str) -> None:
    """Diagnoses one partition, and writes its result and its note.

    An engine repeats a task whose worker dies after it: then there is nothing left to do.
    """
    if _is_done(path, out, false_alarm):
        return
    temporary = _temporary(out / path.name, run)
    try:
        note: dict[str, Any] = {"partition": path.name, "job": _job(path, false_alarm), "status": "done"}
        note |= _write_result(path, temporary, false_alarm)
        os.replace(temporary, out / path.name)
    except (OSError, pa.ArrowException, InputError) as error:
        # The partition cannot be read: the fleet goes on, and a later call tries again.
        _note_failure(path, out, false_alarm, run, error)
        return
    finally:
        temporary.unlink(missing_ok=True)
    _write_whole(_note(path, out), json.dumps(note).encode(), run)


def _write_result(path: Path, target: Path, false_alarm: float) -> dict[str, Any]:
    """Diagnoses the records of a partition; their numbers and names, and what failed."""
    counts = {"done": 0, "failed": 0}
    names: list[list[str | None]] = []
    failed: list[dict[str, Any]] = []
    with pq.ParquetFile(path) as file, pq.ParquetWriter(
        target, OUTPUT, use_dictionary=_REPEATED
    ) as writer:
        for batch in diagnose_batches(file.iter_batches(BATCH_ROWS), false_alarm=false_alarm):
            writer.write_batch(batch)
            for row in batch.select(["unit", "record", "status", "error"]).to_pylist():
                counts[row.pop("status")] += 1
                names.append([row["unit"], row["record"]])
                if row["error"] is not None:
                    failed.append(row)
    return {"records": counts, "names": names, "failed": failed}


def _note_failure(path: Path, out: Path, false_alarm: float, run: str, error: BaseException) -> None:
    """Notes that a partition cannot be read, or that the engine gave it up, and removes an earlier result."""
    # Another worker may have finished it.
    if _is_done(path, out, false_alarm):
        return
    (out / path.name).unlink(missing_ok=True)
    note = {"partition": path.name, "status": "unreadable", "error": f"{type(error).__name__}: {error}"}
    _write_whole(_note(path, out), json.dumps(note).encode(), run)


def _job(path: Path, false_alarm: float) -> dict[str, Any]:
    """What a result depends on."""
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while block := file.read(1 << 20):
            digest.update(block)
    return {
        "input_sha256": digest.hexdigest(),
        "false_alarm": false_alarm,
        "version": _gyrocal.VERSION,
        "model_hash": _gyrocal.MODEL_HASH,
    }


def _note(path: Path, out: Path) -> Path:
    return out / f"{path.stem}.done.json"


def _is_done(path: Path, out: Path, false_alarm: float) -> bool:
    try:
        note = json.loads(_note(path, out).read_text())
    except (OSError, ValueError):
        return False
    if note.get("status") != "done" or not (out / path.name).exists():
        return False
    try:
        return bool(note.get("job") == _job(path, false_alarm))
    except OSError:
        return False


def _manifest(partitions: list[Path], out: Path, computed: int) -> dict[str, Any]:
    notes = [json.loads(_note(path, out).read_text()) for path in partitions]
    seen: set[tuple[str | None, ...]] = set()
    twice: set[tuple[str | None, ...]] = set()
    for note in notes:
        for name in map(tuple, note.get("names", [])):
            (twice if name in seen else seen).add(name)
    read = [note for note in notes if note["status"] == "done"]
    return {
        "version": _gyrocal.VERSION,
        "model_hash": _gyrocal.MODEL_HASH,
        "partitions": [
            {key: value for key, value in note.items() if key not in ("names", "failed")}
            for note in notes
        ],
        "computed_partitions": computed,
        "done": sum(note["records"]["done"] for note in read),
        "failed": [
            {"partition": note["partition"], **row} for note in read for row in note["failed"]
        ],
        "unreadable": [
            {"partition": note["partition"], "error": note["error"]}
            for note in notes
            if note["status"] != "done"
        ],
        "names_given_twice": sorted(list(name) for name in twice),
    }


def _temporary(path: Path, run: str) -> Path:
    """A new name beside a file, which tells the run: processes on other machines have the same numbers."""
    return path.with_name(f".{path.name}.{run}.{uuid4().hex}.tmp")


def _write_whole(path: Path, content: bytes, run: str) -> None:
    temporary = _temporary(path, run)
    temporary.write_bytes(content)
    os.replace(temporary, path)
