"""The page about fleets, followed by a reader: its blocks, its command and its queries, on folders instead of buckets."""

import re
import shlex
import subprocess
import sys

import excavator
import pytest

from pages import DOCS, blocks


def test_the_page_about_fleets_runs(engine, samples, tmp_path, monkeypatch):
    pytest.importorskip("duckdb")
    pytest.importorskip("polars")
    import duckdb

    monkeypatch.chdir(tmp_path)
    for name, source, stop in (("may-a", "identification", 3), ("may-b", "validation", 2)):
        excavator.read(samples / "hidden-law" / source, stop=stop).write(tmp_path / "bags" / "crane7" / name)

    def here(text):
        return text.replace("s3://bags/", f"{tmp_path}/bags/").replace("s3://results/spring", "results")

    first, ask = (here(block) for block in blocks(DOCS / "fleets.md", "python"))
    session = {}
    exec(compile(first, "fleets.md", "exec"), session)
    assert (session["report"].keys, len(session["report"].done)) == (1, 1)
    exec(compile(ask, "fleets.md", "exec"), session)
    for query in blocks(DOCS / "fleets.md", "sql"):
        duckdb.sql(query).fetchall()
    assert (tmp_path / "fleet.html").stat().st_size > 1000

    # From a shell: what is done already is not done again.
    pair = session["pairs"][0]
    (tmp_path / "fleet.csv").write_text(",".join(pair) + "\n" + ",".join(pair.values()) + "\n")
    (command,) = re.findall(r"^    python (-m excavator\.fleet .*)$", (DOCS / "fleets.md").read_text(), re.MULTILINE)
    done = subprocess.run([sys.executable, *shlex.split(here(command))], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "0 done, 1 done before" in done.stdout
