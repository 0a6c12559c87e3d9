"""Makes the Parquet samples. Needs the Python package pyarrow.

    make_parquet.py table FILE.csv FOLDER   the table of make.py with every codec that pyarrow has for us: one file each
    make_parquet.py kinds FILE.parquet      a table with every type that a logger may write, nulls, and row groups of 3
"""

import datetime
import decimal
import sys
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

# Rows of the samples of each codec: they are the same but for their packing.
SHORT = 40


def table(path: Path) -> pa.Table:
    """A table with semicolons and decimal commas, as columns of doubles."""
    lines = path.read_text().splitlines()
    names = lines[0].split(";")
    rows = [[float(cell.replace(",", ".")) for cell in line.split(";")] for line in lines[1:]]
    # Empty cells are "nan" there and null here.
    columns = [[None if cell != cell else cell for cell in column] for column in zip(*rows)]
    return pa.table({name: pa.array(column, pa.float64()) for name, column in zip(names, columns)})


def write_table(csv: Path, folder: Path) -> None:
    """The whole table as pandas would write it, its start with every codec and with pages of version 2."""
    whole = table(csv)
    pq.write_table(whole, folder / "arm-swing.parquet", compression="snappy", row_group_size=200)
    short = whole.slice(0, SHORT)
    for codec in ["none", "snappy", "gzip", "lz4", "zstd"]:
        pq.write_table(short, folder / f"{codec}.parquet", compression=codec)
    pages = {"compression": "zstd", "data_page_version": "2.0", "use_dictionary": False}
    split = {name: "BYTE_STREAM_SPLIT" for name in whole.column_names}
    pq.write_table(short, folder / "pages-2.parquet", column_encoding=split, **pages)


def write_kinds(path: Path) -> None:
    """Seven rows, the fourth null in every column."""
    start = datetime.datetime(2026, 5, 4, 9, 30, tzinfo=datetime.timezone.utc)

    def column(kind: pa.DataType, value) -> pa.Array:
        return pa.array([None if row == 3 else value(row) for row in range(7)], kind)

    def instant(row: int) -> datetime.datetime:
        return start + datetime.timedelta(microseconds=10_250 * row)

    columns = {
        "when_utc": column(pa.timestamp("us", tz="UTC"), instant),
        "when_berlin": column(pa.timestamp("ns", tz="Europe/Berlin"), instant),
        "when_plain": column(pa.timestamp("ms"), lambda row: start.replace(tzinfo=None, microsecond=1000 * row)),
        "day": column(pa.date32(), lambda row: start.date() + datetime.timedelta(days=row)),
        "of_day": column(pa.time64("us"), lambda row: datetime.time(0, 0, row)),
        "switch": column(pa.bool_(), lambda row: row % 2 == 1),
        "i8": column(pa.int8(), lambda row: row - 100),
        "u8": column(pa.uint8(), lambda row: row + 200),
        "i64": column(pa.int64(), lambda row: -(2**40) * row),
        "u32": column(pa.uint32(), lambda row: 2**32 - 1 - row),
        "u64": column(pa.uint64(), lambda row: 2**64 - 2048),
        "half": column(pa.float16(), lambda row: 0.5 * row - 1.0),
        "single": column(pa.float32(), lambda row: 0.25 * row),
        "p_A [bar]": column(pa.float64(), lambda row: 100.0 + row),
        "money": column(pa.decimal128(9, 2), lambda row: decimal.Decimal(row - 4) / 4),
        "wide": column(pa.decimal128(30, 3), lambda row: decimal.Decimal(2**80 - 2**40 * row) / 8),
        "arm": column(pa.struct([("x", pa.float64())]), lambda row: {"x": float(row)}),
        "name": column(pa.string(), lambda row: f"row {row}"),
        "spectrum": column(pa.list_(pa.float64()), lambda row: [1.0] * row),
        "raw": column(pa.binary(), lambda row: bytes(row)),
    }
    pq.write_table(pa.table(columns), path, row_group_size=3)


def main() -> None:
    """See the module's description."""
    match sys.argv[1:]:
        case ["table", csv, folder]:
            write_table(Path(csv), Path(folder))
        case ["kinds", path]:
            write_kinds(Path(path))
        case _:
            sys.exit(__doc__)


if __name__ == "__main__":
    main()
