"""The extension module. Users call the functions of the package."""

from os import PathLike
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

VERSION: str
MODEL_HASH: str
FALSE_DISCOVERY_RATE: float
GROUP_PROBABILITY: float
OUTLIER_PROBABILITY: float

@final
class Record:
    @staticmethod
    def read(path: str | PathLike[str]) -> Record: ...
    @staticmethod
    def of_columns(
        name: str,
        time_s: NDArray[np.float64],
        accel_g: list[NDArray[np.float64]],
        temperature_c: NDArray[np.float64] | None,
    ) -> Record: ...
    @staticmethod
    def of_arrow(name: str, stream: object) -> Record: ...
    def __len__(self) -> int: ...
    @property
    def name(self) -> str: ...
    @property
    def sha256(self) -> str: ...
    @property
    def time_s(self) -> NDArray[np.float64]: ...
    @property
    def accel_g(self) -> NDArray[np.float64]: ...
    @property
    def temperature_c(self) -> NDArray[np.float64] | None: ...
    def to_csv(self) -> str: ...

@final
class Bench:
    @staticmethod
    def read(path: str | PathLike[str]) -> Bench: ...
    @staticmethod
    def of_text(text: str, name: str) -> Bench: ...
    @staticmethod
    def of_json(json: str, name: str) -> Bench: ...
    @property
    def name(self) -> str: ...
    @property
    def sha256(self) -> str: ...
    @property
    def latitude_deg(self) -> float: ...
    def to_toml(self) -> str: ...

@final
class Plant:
    @staticmethod
    def of_program(text: str, name: str) -> Plant: ...
    @property
    def name(self) -> str: ...
    @property
    def inputs(self) -> list[str]: ...
    @property
    def outputs(self) -> list[str]: ...
    @property
    def regressors(self) -> list[str]: ...
    @property
    def effects(self) -> list[str]: ...
    def record(self, columns: dict[str, Any]) -> PlantRecord: ...
    def diagnose(
        self,
        record: PlantRecord,
        later: PlantRecord | None,
        false_alarm: float,
        inputs: list[tuple[str, str]],
        command: str,
    ) -> tuple[str, PlantPage, dict[str, NDArray[np.float64]]]: ...
    def fit(
        self,
        record: PlantRecord,
        later: PlantRecord | None,
        first_rows: int,
        inputs: list[tuple[str, str]],
        command: str,
    ) -> tuple[str, dict[str, NDArray[np.float64]]]: ...

@final
class PlantPage: ...

@final
class PlantRecord:
    @property
    def bridged(self) -> list[str]: ...

def command(arguments: list[str]) -> int: ...
def check_columns(names: list[str], frame: str) -> None: ...
def simulate(
    path: str | PathLike[str] | None, tables: str | None, seed: int | None, name: str, command: str
) -> tuple[Record, Bench, str]: ...
def calibrate(
    runs: list[tuple[Record, Bench]],
    axes: list[tuple[str, NDArray[np.float64] | str]],
    method: str,
    factorised: bool,
    noise: bool,
    average_s: float | None,
    robust_sigmas: float | None,
    effects: list[str],
    command: str,
) -> tuple[str, float | None]: ...
def diagnose(
    record: Record,
    bench: Bench,
    later: tuple[Record, Bench] | None,
    axes: NDArray[np.float64] | str | None,
    later_axes: NDArray[np.float64] | str | None,
    effects: list[str],
    false_alarm: float,
    euler_filter: bool,
    command: str,
) -> tuple[str, bytes | None]: ...
def plan(
    record: Record,
    bench: Bench,
    axes: NDArray[np.float64] | str | None,
    diagnosis: str | None,
    hours: list[float],
    limits_deg: list[tuple[str, tuple[float, float]]],
    aim: str | None,
    sigmas: list[tuple[str, float]],
    one_name: bool,
    effects: list[str],
    false_alarm: float,
    command: str,
) -> str: ...
def characterise(
    cells: list[str],
    runs: int | None,
    seed: int,
    results: str | PathLike[str] | None,
    methods: list[str] | None,
    threads: int | None,
    command: str,
) -> str: ...
def summarise_fleet(
    records: list[dict[str, Any]],
    false_discovery_rate: float,
    group_probability: float,
    outlier_probability: float,
    seed: int,
    command: str,
) -> str: ...
def words_of(kind: str, result: str) -> tuple[str, str]: ...
def text_of(words: str) -> str: ...
def html_of(words: str) -> str: ...
def report(results: list[tuple[str, str, PlantPage | None]]) -> str: ...
