"""Columns as frames of other packages, which are imported where they are asked for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd
    import polars as pl
    import pyarrow as pa

__all__ = ["Table", "needed"]


class Table:
    """What has columns: its frames."""

    __slots__ = ()

    def _columns(self) -> Mapping[str, Any]:
        raise NotImplementedError

    def to_pandas(self) -> pd.DataFrame:
        """The rows as a frame of pandas; of a result those of its main table."""
        with needed("pandas", "pandas"):
            import pandas as pd
        return pd.DataFrame(self._columns())

    def to_polars(self) -> pl.DataFrame:
        """The rows as a frame of Polars."""
        with needed("Polars", "polars"):
            import polars as pl
        return pl.DataFrame(self._columns(), strict=False)

    def to_arrow(self) -> pa.Table:
        """The rows as a table of PyArrow."""
        with needed("PyArrow", "pyarrow"):
            import pyarrow as pa
        return pa.table(self._columns())

    def __arrow_c_stream__(self, requested_schema: Any = None) -> Any:
        """The rows by the C stream interface of Arrow, which Polars, DuckDB and others read; it needs PyArrow."""
        return self.to_arrow().__arrow_c_stream__(requested_schema)


@contextmanager
def needed(name: str, package: str, install: str | None = None) -> Iterator[None]:
    """Tells how an optional package is installed, where it cannot be imported; `install` if not by its own name."""
    try:
        yield
    except ImportError as error:
        raise ImportError(
            f"{name} is not installed: python -m pip install {install or package}", name=package
        ) from error
