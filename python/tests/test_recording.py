"""Recordings: reading, columns, conversions, writing."""

import gc
import warnings

import numpy as np
import pytest

import excavator


def test_a_bag_is_read(samples):
    rec = excavator.read(samples / "arm-swing")
    assert len(rec) == 501
    assert rec.time[0] == 0.0 and np.all(np.diff(rec.time) > 0)
    assert rec.signals["arm.cap_pressure"] == "Pa"
    assert rec.signals["arm.displacement"] == "m"
    assert "arm.cap_pressure" in rec and "arm.rod_force" not in rec
    assert rec.duration == rec.time[-1]
    assert rec.sample_interval == pytest.approx(np.median(np.diff(rec.time)))


@pytest.mark.parametrize("name", ["arm-swing.csv", "parquet/arm-swing.parquet"])
def test_tables_are_read_with_a_map(samples, name):
    map = samples / "arm-swing.csv.map.toml"
    rec = excavator.read(samples / name, map=map)
    assert "arm.displacement" in rec


def test_a_map_may_be_a_dict(samples):
    import tomllib

    path = samples / "arm-swing.csv.map.toml"
    by_file = excavator.read(samples / "arm-swing.csv", map=path)
    by_dict = excavator.read(samples / "arm-swing.csv", map=tomllib.loads(path.read_text()))
    for name in by_file:
        np.testing.assert_array_equal(by_file[name], by_dict[name])


def test_joint_states_are_read_by_the_map_beside_them(samples):
    rec = excavator.read(samples / "joint-states")
    assert len(rec.signals) > 0


def test_columns_are_views_that_keep_their_recording(samples):
    rec = excavator.read(samples / "arm-swing")
    first, second = rec["arm.displacement"], rec["arm.displacement"]
    assert first.__array_interface__["data"][0] == second.__array_interface__["data"][0]
    assert not first.flags.owndata and not first.flags.writeable and first.flags.c_contiguous
    with pytest.raises(ValueError):
        first[0] = 1.0
    before = first.copy()
    del rec, second
    gc.collect()
    np.testing.assert_array_equal(first, before)


def test_arrow_shares_memory(samples):
    pytest.importorskip("pyarrow")
    rec = excavator.read(samples / "arm-swing")
    table = rec.to_arrow()
    assert table.schema.field("arm.cap_pressure").metadata == {b"unit": b"Pa"}
    own = rec["arm.cap_pressure"].__array_interface__["data"][0]
    assert table.column("arm.cap_pressure").chunk(0).buffers()[1].address == own


def test_tables_of_others(samples):
    rec = excavator.read(samples / "arm-swing")
    pandas, polars = pytest.importorskip("pandas"), pytest.importorskip("polars")
    frame = rec.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and list(frame.columns) == list(rec.signals)
    np.testing.assert_array_equal(frame.index, rec.time)
    frame = rec.to_polars()
    assert isinstance(frame, polars.DataFrame) and frame.columns == ["time", *rec.signals]
    np.testing.assert_array_equal(frame["arm.displacement"].to_numpy(), rec["arm.displacement"])


def test_a_part_is_a_part(samples):
    rec = excavator.read(samples / "arm-swing")
    part = excavator.read(samples / "arm-swing", start=1.0, stop=2.0)
    chosen = (rec.time >= 1.0) & (rec.time <= 2.0)
    np.testing.assert_array_equal(part["arm.displacement"], rec["arm.displacement"][chosen])
    np.testing.assert_array_equal(rec.part(1.0, 2.0).time, part.time)
    assert part.source.endswith("arm-swing@1..2")
    with pytest.raises(excavator.ReadError, match="the recording ends at"):
        rec.part(1e6)
    with pytest.raises(excavator.ReadError, match="is not before"):
        rec.part(2.0, 1.0)


def test_what_is_written_is_read_back(samples, tmp_path):
    rec = excavator.read(samples / "arm-swing")
    rec.write(tmp_path / "copy")
    again = excavator.read(tmp_path / "copy")
    assert again.signals == rec.signals
    for name in rec:
        np.testing.assert_array_equal(again[name], rec[name])
    with pytest.raises(excavator.ReadError):
        rec.write(tmp_path / "copy")
    rec.write(tmp_path / "copy", replace=True)


def test_arrays_make_a_recording():
    time = 5.0 + np.arange(100) / 100
    rec = excavator.Recording.from_arrays(time, {"arm.orifice_command": np.sin(time), "pump_pressure": 1e6})
    assert rec.signals == {"arm.orifice_command": "m2", "pump_pressure": "Pa"}
    assert rec.time[0] == 0.0 and rec.start_nanoseconds == 5_000_000_000
    assert np.all(rec["pump_pressure"] == 1e6)
    other = rec.with_signals({"tank_pressure": 0.0})
    assert set(other) == {"arm.orifice_command", "pump_pressure", "tank_pressure"}
    with pytest.raises(excavator.ReadError, match="increas"):
        excavator.Recording.from_arrays([0.0, 0.0], {"pump_pressure": [1.0, 2.0]})
    with pytest.raises(ValueError):
        excavator.Recording.from_arrays([0.0, 1.0], {"no such signal": [1.0, 2.0]})


def test_errors_are_one_line(samples):
    for work in [
        lambda: excavator.read("nowhere"),
        lambda: excavator.read(samples / "arm-swing.csv", map="nowhere.toml"),
        lambda: excavator.read(samples / "arm-swing.csv", map={"signals": []}),
    ]:
        with pytest.raises(excavator.ReadError) as caught:
            work()
        assert isinstance(caught.value, excavator.ExcavatorError)
        assert "\n" not in str(caught.value)
    with pytest.raises(KeyError, match="no signal"):
        excavator.read(samples / "arm-swing")["arm.nothing"]


def test_it_shows_itself(samples):
    rec = excavator.read(samples / "arm-swing")
    assert "samples" in repr(rec) and "<table>" in rec._repr_html_()
    pytest.importorskip("matplotlib").use("agg")
    assert len(rec.plot("arm.displacement", "arm.cap_pressure").axes) == 2


def test_remarks_are_warnings(samples, tmp_path):
    import shutil

    folder = shutil.copytree(samples / "hidden-law/validation", tmp_path / "cut")
    file = next(folder.glob("*.mcap"))
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        rec = excavator.read(folder)
    assert caught and all(issubclass(one.category, excavator.Remark) for one in caught)
    assert caught[0].filename == __file__
    assert [str(one.message) for one in caught] == [f"{folder}: {line}" for line in rec.remarks]


def test_a_map_is_guessed(samples):
    import tomllib

    text = excavator.guess_map(samples / "arm-swing.csv")
    assert tomllib.loads(text)["signals"]
