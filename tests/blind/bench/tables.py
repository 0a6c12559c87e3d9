"""Writes recordings as text files in the styles of different benches."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Style:
    """How a file looks. `time_heading` empty: no time column; `time_scale` turns seconds into its unit.

    `units_row` puts the units into a second line; `header` are lines before the headings; {rate} and {rows} are filled in.
    """

    time_heading: str = "t_s"
    time_scale: float = 1.0
    time_digits: int = 3
    separator: str = ","
    decimal: str = "."
    units_row: tuple = ()
    header: tuple = ()
    quote: str = ""


def text(value, digits, decimal):
    """A number with fixed decimals, or nothing for a lost cell."""
    if np.isnan(value):
        return ""
    return f"{value + 0.0:.{digits}f}".replace(".", decimal)


def write(path, style, sensors, times, columns):
    """Writes one recording; `columns` maps headings to readings."""
    headings = [sensor.heading for sensor in sensors]
    if style.time_heading:
        headings.insert(0, style.time_heading)
    rate = (len(times) - 1) / (times[-1] - times[0])
    lines = [line.format(rate=f"{rate:g}", rows=len(times)) for line in style.header]
    lines.append(style.separator.join(style.quote + h + style.quote for h in headings))
    if style.units_row:
        lines.append(style.separator.join(style.units_row))
    for row, time in enumerate(times):
        cells = [text(columns[s.heading][row], s.digits, style.decimal) for s in sensors]
        if style.time_heading:
            cells.insert(0, text(time * style.time_scale, style.time_digits, style.decimal))
        lines.append(style.separator.join(cells))
    path.write_text("\n".join(lines) + "\n")
