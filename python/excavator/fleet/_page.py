"""Page with charts of a fleet: plain HTML with inline SVG, without scripts or network access."""

from __future__ import annotations

import html
import math
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Sequence
from datetime import datetime
from typing import TYPE_CHECKING, Any

from ._results import Poison

if TYPE_CHECKING:
    import pyarrow

WIDTH, ROW_HEIGHT, LEFT, RIGHT = 900, 26, 190, 20
"""Sizes of the charts, in pixels. `LEFT` is the margin for names of machines."""

DRIFT_HEIGHT = 260
"""Height of the drift chart, in pixels."""

VERDICTS = {
    "adequate": ("ok", "the model is adequate", "with an adequate model"),
    "missing_effect": ("effect", "an effect is missing", "with a missing effect"),
    "unexplained": ("open", "unexplained", "unexplained"),
}
"""CSS class of each verdict, its text, and its text after a number."""

SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")

LINES = 8
"""Number of machines with their own colour in a drift chart; the others are grey."""

_STYLE = """
:root{color-scheme:light dark;--ink:#1c2128;--dim:#68717d;--rule:#d4d9df;--paper:#fff;--ok:#2b8a57;--effect:#c2570c;--open:#9b2c7e;
--c0:#2563b0;--c1:#c2570c;--c2:#2b8a57;--c3:#9b2c7e;--c4:#8a6d00;--c5:#0f7f8c;--c6:#b3324b;--c7:#5b4bb5}
@media (prefers-color-scheme:dark){:root{--ink:#e3e6ea;--dim:#98a2ad;--rule:#3a424c;--paper:#15181c;--ok:#5cc48d;--effect:#f2a35e;--open:#dd8bc8;
--c0:#79aef0;--c1:#f2a35e;--c2:#5cc48d;--c3:#dd8bc8;--c4:#d8bf4e;--c5:#5cc7d3;--c6:#ee8497;--c7:#a99cf2}}
body{font:15px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--paper);max-width:920px;margin:2rem auto;padding:0 1rem}
h1{font-size:1.5rem}h2{font-size:1.15rem;margin-top:2.2rem}p.dim{color:var(--dim)}
svg{display:block;width:100%;height:auto}svg text{font:12px system-ui,sans-serif;fill:var(--ink)}svg text.dim{fill:var(--dim)}
.rule{stroke:var(--rule)}.ok{fill:var(--ok)}.effect{fill:var(--effect)}.open{fill:var(--open)}
.scroll{overflow-x:auto}table{border-collapse:collapse;width:100%}th,td{text-align:left;padding:.25rem .7rem .25rem 0;border-bottom:1px solid var(--rule);
vertical-align:top;overflow-wrap:anywhere}td.number{text-align:right}
"""


def page(tables: dict[str, pyarrow.Table], poison: Sequence[Poison] = (), *, parameter: str | None = None, title: str = "Fleet") -> str:
    """Returns the page of a fleet, from the tables of `Results.collect()` and the poison list.

    `parameter` is the parameter in the drift chart. By default, it is the one that most recordings have.
    """
    results = tables["results"].to_pylist()
    parts = [
        f"<h1>{_text(title)}</h1>",
        _lead(results, poison),
        _section("Verdicts", "One mark for each pair of recordings.", _verdicts(results)),
        _section("Effects", "How many recordings of a machine show an effect that its model is missing.", _effects(results)),
        _drift(tables["parameters"].to_pylist(), parameter),
        _poison(poison),
    ]
    head = f'<meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{_text(title)}</title>'
    return f'<!DOCTYPE html><html lang="en"><head>{head}<style>{_STYLE}</style></head><body>{"".join(parts)}</body></html>\n'


def _text(value: object) -> str:
    """Escapes text for HTML. Addresses are masked so that no client turns them into links."""
    return html.escape(str(value)).replace("://", ":&#47;&#47;")


def _number(value: float) -> str:
    return f"{value:.4g}"


def _section(title: str, words: str, content: str) -> str:
    return f'<h2>{_text(title)}</h2><p class="dim">{_text(words)}</p>{content}' if content else ""


def _lead(results: list[dict[str, Any]], poison: Sequence[Poison]) -> str:
    machines = len({row["machine"] for row in results})
    verdicts = Counter(row["verdict"] for row in results)
    counts = [f"{verdicts[name]} {words}" for name, (_, _, words) in VERDICTS.items() if verdicts[name]]
    judged = f"{_count(len(results), 'pair')} of {_count(machines, 'machine')}: {', '.join(counts) or 'no verdicts'}."
    failed = f" {_count(len(poison), 'pair')} could not be computed and {'is' if len(poison) == 1 else 'are'} on the poison list." if poison else ""
    return f"<p>{_text(judged + failed)}</p>"


def _count(number: int, thing: str) -> str:
    return f"{number} {thing}{'' if number == 1 else 's'}"


def _places(moments: Iterable[datetime | None], left: float, right: float) -> tuple[Callable[[datetime], float], list[datetime]]:
    """Returns the function from time to x coordinate, and the first and last time."""
    known = sorted(one for one in moments if one is not None)
    if not known:
        return (lambda _: (left + right) / 2), []
    first, last = known[0], known[-1]
    span = (last - first).total_seconds()
    if span <= 0:
        return (lambda _: (left + right) / 2), [first]
    return (lambda one: left + (right - left) * (one - first).total_seconds() / span), [first, last]


def _dates(ends: list[datetime], y: float) -> str:
    marks = zip(ends, [(LEFT + 8, "start"), (WIDTH - RIGHT, "end")] if len(ends) > 1 else [((LEFT + WIDTH) / 2, "middle")])
    return "".join(
        f'<text class="dim" x="{x:.0f}" y="{y:.0f}" text-anchor="{anchor}">{moment:%Y-%m-%d}</text>' for moment, (x, anchor) in marks
    )


def _svg(height: float, label: str, content: str) -> str:
    return f'<svg viewBox="0 0 {WIDTH} {height:.0f}" role="img" aria-label="{_text(label)}">{content}</svg>'


def _shortened(name: str) -> str:
    return name if len(name) <= 26 else f"{name[:25]}…"


def _verdicts(results: list[dict[str, Any]]) -> str:
    """Draws one row for each machine, with time to the right. Verdicts differ in shape as well as in colour."""
    judged = [row for row in results if row["verdict"] in VERDICTS]
    if not judged:
        return ""
    machines = sorted({row["machine"] for row in judged})
    place, ends = _places((row["recorded"] for row in judged), LEFT + 14, WIDTH - RIGHT - 6)
    out = []
    for number, machine in enumerate(machines):
        y = ROW_HEIGHT * (number + 0.5)
        out.append(f'<line class="rule" x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{y:.1f}" y2="{y:.1f}"/>')
        out.append(f'<text x="0" y="{y + 4:.1f}">{_text(_shortened(machine))}</text>')
    for row in judged:
        y = ROW_HEIGHT * (machines.index(row["machine"]) + 0.5)
        x = LEFT + 4 if row["recorded"] is None else place(row["recorded"])
        kind, words, _ = VERDICTS[row["verdict"]]
        when = "" if row["recorded"] is None else f"{row['recorded']:%Y-%m-%d %H:%M}"
        tip = f"{row['machine']} {when}: {words} {', '.join(row['effects'] or [])}"
        out.append(f"<g><title>{_text(tip)}</title>{_mark(kind, x, y)}</g>")
    height = ROW_HEIGHT * len(machines) + 44
    out.append(_dates(ends, height - 28))
    x = float(LEFT)
    for kind, words, _ in VERDICTS.values():
        out.append(f'{_mark(kind, x + 6, height - 10)}<text x="{x + 18:.0f}" y="{height - 6}">{_text(words)}</text>')
        x += 200
    return _svg(height, "verdicts of each machine over time", "".join(out))


def _mark(kind: str, x: float, y: float) -> str:
    if kind == "ok":
        return f'<circle class="ok" cx="{x:.1f}" cy="{y:.1f}" r="5"/>'
    if kind == "effect":
        return f'<path class="effect" d="M{x:.1f} {y - 6:.1f}l6 11h-12z"/>'
    return f'<path class="open" d="M{x:.1f} {y - 6:.1f}l6 6l-6 6l-6 -6z"/>'


def _effects(results: list[dict[str, Any]]) -> str:
    counts: dict[str, Counter[str]] = defaultdict(Counter)
    for row in results:
        for effect in row["effects"] or []:
            counts[effect][row["machine"]] += 1
    if not counts:
        return ""
    recordings = Counter(row["machine"] for row in results)
    rows = []
    for effect in sorted(counts, key=lambda name: (-sum(counts[name].values()), name)):
        where = ", ".join(f"{machine} ({count} of {recordings[machine]})" for machine, count in counts[effect].most_common())
        rows.append(f'<tr><td>{_text(effect)}</td><td class="number">{sum(counts[effect].values())}</td><td>{_text(where)}</td></tr>')
    heads = "<tr><th>effect</th><th>recordings</th><th>machines</th></tr>"
    return f'<div class="scroll"><table>{heads}{"".join(rows)}</table></div>'


def _ticks(low: float, high: float) -> tuple[list[float], int]:
    """Returns ticks at round numbers that span `low` to `high`, and the power of ten by which the labels are scaled."""
    if high <= low:
        reach = 0.05 * abs(low) or 1.0
        low, high = low - reach, high + reach
    rough = (high - low) / 4
    decade = 10.0 ** math.floor(math.log10(rough))
    step = next(factor * decade for factor in (1, 2, 5, 10) if factor * decade >= rough)
    first, last = math.floor(low / step), math.ceil(high / step)
    ticks = [number * step for number in range(first, last + 1)]
    largest = math.floor(math.log10(max(abs(one) for one in ticks)))
    return ticks, 0 if -3 <= largest <= 4 else 3 * (largest // 3)


def _drift(parameters: list[dict[str, Any]], wanted: str | None) -> str:
    """Draws a parameter over time with its 95 % intervals, with one line for each machine."""
    usable = [row for row in parameters if row["value"] is not None and row["recorded"] is not None]
    given = [row for row in usable if wanted in (None, row["parameter"])]
    if not given:
        return "" if wanted is None else _section("Drift", f"No result has the parameter {wanted}.", "<p></p>")
    name = wanted or Counter(row["parameter"] for row in given).most_common(1)[0][0]
    rows = [row for row in given if row["parameter"] == name]
    margin = lambda row: row["margin_95"] or 0.0  # noqa: E731
    low, high = min(row["value"] - margin(row) for row in rows), max(row["value"] + margin(row) for row in rows)
    ticks, exponent = _ticks(low, high)
    low, high = ticks[0], ticks[-1]
    top, bottom = 12.0, DRIFT_HEIGHT - 40.0
    height_of = lambda value: bottom - (bottom - top) * (value - low) / (high - low)  # noqa: E731
    place, ends = _places((row["recorded"] for row in rows), LEFT + 14, WIDTH - RIGHT - 6)
    out = []
    for value in ticks:
        y = height_of(value)
        out.append(f'<line class="rule" x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{y:.1f}" y2="{y:.1f}"/>')
        out.append(f'<text class="dim" x="{LEFT - 8}" y="{y + 4:.1f}" text-anchor="end">{_number(value / 10.0**exponent)}</text>')
    machines = [machine for machine, _ in Counter(row["machine"] for row in rows).most_common()]
    for number, machine in enumerate(machines):
        colour = f"var(--c{number})" if number < LINES else "var(--dim)"
        own = sorted((row for row in rows if row["machine"] == machine), key=lambda row: row["recorded"])
        points = [(place(row["recorded"]), height_of(row["value"])) for row in own]
        path = "L".join(f"{x:.1f} {y:.1f}" for x, y in points)
        out.append(f'<path d="M{path}" fill="none" stroke="{colour}" stroke-opacity=".5"/>')
        for row, (x, y) in zip(own, points):
            upper, lower = height_of(row["value"] + margin(row)), height_of(row["value"] - margin(row))
            tip = f"{machine} {row['recorded']:%Y-%m-%d}: {_number(row['value'])} ± {_number(margin(row))} {row['unit'] or ''}"
            out.append(
                f'<g><title>{_text(tip)}</title><line x1="{x:.1f}" x2="{x:.1f}" y1="{upper:.1f}" y2="{lower:.1f}" stroke="{colour}"/>'
                f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/></g>'
            )
    out.append(_dates(ends, DRIFT_HEIGHT - 18))
    for number, machine in enumerate(machines[:LINES]):
        y = 20 + 18 * number
        out.append(f'<circle cx="6" cy="{y}" r="4" fill="var(--c{number})"/><text x="16" y="{y + 4}">{_text(machine[:16])}</text>')
    unit = next((row["unit"] for row in rows if row["unit"]), "")
    power = "" if exponent == 0 else "10" + str(exponent).translate(SUPERSCRIPTS) + " "
    words = f"{name} in {power}{unit}. Bars are 95 % intervals."
    return _section("Drift", words, _svg(DRIFT_HEIGHT, f"{name} of each machine over time", "".join(out)))


def _poison(poison: Sequence[Poison]) -> str:
    rows = [
        f"<tr><td>{_text(one.machine)}</td><td>{_text(one.kind)}</td><td class=number>{one.attempts}</td><td>{_text(one.error)}"
        f"<br>{_text(', '.join(one.recordings))}</td></tr>"
        for one in poison
    ]
    if not rows:
        return ""
    heads = "<tr><th>machine</th><th>kind</th><th>attempts</th><th>what was said</th></tr>"
    table = f'<div class="scroll"><table>{heads}{"".join(rows)}</table></div>'
    return _section("Poison list", "Work that could not be done.", table)
