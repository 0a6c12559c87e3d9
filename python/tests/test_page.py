"""The page about Python, followed by a reader: its blocks run in order, in one session."""

import pytest

from pages import DOCS, blocks


@pytest.mark.full
def test_the_page_about_python_runs(samples, tmp_path, monkeypatch):
    pytest.importorskip("matplotlib").use("Agg")
    (tmp_path / "bags").symlink_to(samples.parent)
    monkeypatch.chdir(tmp_path)
    session = {}
    for block in blocks(DOCS / "python.md", "python"):
        exec(compile(block, "python.md", "exec"), session)
    assert (tmp_path / "comparison.html").stat().st_size > 10_000
    # The two ways to write the law are one law.
    assert session["law"]["formula"].replace(" ", "") == "-k*v*abs(p_cap-p_rod)"
    assert session["refined"].steps[-1]["added"] == "load_damping@arm"
