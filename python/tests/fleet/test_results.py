"""Keys, tables, manifests and the page, without Ray."""

import json
from html.parser import HTMLParser

import pytest
from excavator import fleet
from excavator.fleet._pairs import key_of
from excavator.fleet._results import moment, parameters_of, summary_of
from excavator.fleet._unit import topics_of

DIAGNOSIS = {
    "verdict": "missing_effect",
    "validation_error": {"before": 0.4, "after": 0.1},
    "candidates": [{"effect": "pump_leakage", "cylinder": "pump", "validation_error_before": 0.4, "validation_error_after": 0.1, "evidence": 9.0}],
    "rejected": [{"effect": "hose_loss", "cylinder": "arm", "validation_error_before": 0.4, "validation_error_after": 0.39, "evidence": 0.1}],
    "effects": [
        {"effect": "pump_leakage", "cylinder": "pump", "parameters": [{"name": "leakage", "value": 1e-12, "margin_95": 1e-13, "unit": "m³/(s Pa)"}]}
    ],
    "refitted": [{"name": "friction", "value": 900.0, "std_error": 5.0, "margin_95": 10.0, "unit": "N"}],
}


def test_a_key_is_of_everything_that_counts():
    identity = {"program": "1", "verb": "diagnose", "validation": ["sha256:1"]}
    assert key_of(identity) == key_of(dict(reversed(identity.items())))
    assert len({key_of(identity), key_of(identity | {"program": "2"}), key_of(identity | {"validation": []})}) == 3


def test_a_manifest_is_read_beside_its_recordings(tmp_path):
    manifest = tmp_path / "fleet.csv"
    manifest.write_text("machine,model,identification,validation,map,recorded\nA,zx30u-arm,a.mcap;b.mcap,s3://bucket/c,,2026-05-01\n")
    (pair,) = fleet.read_manifest(manifest)
    assert pair.identification == (f"{tmp_path}/a.mcap", f"{tmp_path}/b.mcap")
    assert (pair.validation, pair.map, pair.model) == (("s3://bucket/c",), None, "zx30u-arm")
    manifest.write_text("machine,modle\nA,b\n")
    with pytest.raises(ValueError, match="no column modle"):
        fleet.read_manifest(manifest)


def test_topics_of_a_map():
    pytest.importorskip("tomllib")
    text = '[clock]\ntopic = "/a"\n[[signals]]\nsignal = "x"\ntopic = "/b"\n[names.p]\ntopic = "/c"\n'
    assert topics_of(text) == ["/a", "/b", "/c"]
    assert topics_of('dbc = "x.dbc"\n' + text) is None


def test_rows_of_a_diagnosis():
    assert summary_of(DIAGNOSIS) == {"verdict": "missing_effect", "effects": ["pump_leakage@pump"], "error_before": 0.4, "error_after": 0.1}
    assert [(one["effect"], one["parameter"], one["margin_95"]) for one in parameters_of(DIAGNOSIS)] == [
        ("", "friction", 10.0),
        ("pump_leakage@pump", "leakage", 1e-13),
    ]


class _Checker(HTMLParser):
    VOID = {"meta", "circle", "line", "path", "br"}

    def __init__(self):
        super().__init__()
        self.open, self.tags = [], []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.tags.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def test_the_page_draws_everything_and_runs_nothing():
    pyarrow = pytest.importorskip("pyarrow")
    common = [{"key": str(n), "machine": f"<b>{n % 3}</b>", "recorded": moment(f"2026-0{1 + n}-01")} for n in range(6)]
    tables = {
        "results": pyarrow.Table.from_pylist([row | {"model": "m"} | summary_of(DIAGNOSIS) for row in common]),
        "parameters": pyarrow.Table.from_pylist([row | one for row in common for one in parameters_of(DIAGNOSIS)]),
    }
    poison = [fleet.Poison("k", "<script>", "data", "http://x/<i> cannot be read", 1, ("s3://bucket/a",))]
    text = fleet.page(tables, poison, parameter="friction")
    checker = _Checker()
    checker.feed(text)
    assert not checker.open and checker.tags.count("svg") == 2 and "script" not in checker.tags and "i" not in checker.tags
    assert "http://" not in text and "https://" not in text
    assert all(words in text for words in ("pump_leakage@pump", "friction in N", "1 pair could not be computed", "&lt;script&gt;", "prefers-color-scheme:dark"))
