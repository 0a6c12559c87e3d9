"""Makes the spreadsheet sample. Needs the Python package openpyxl.

    make_xlsx.py FILE.csv FILE.xlsx     the start of the table of make.py, as a person would keep it: a cover sheet behind it, lines
                                        above the headings, times as dates, formulas
"""

import datetime
import sys
from pathlib import Path

import openpyxl

ROWS = 60
START = datetime.datetime(2026, 5, 4, 9, 30)


def main(csv: Path, target: Path) -> None:
    lines = csv.read_text().splitlines()
    names = lines[0].split(";")
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.title = "drive 1"
    sheet.append(["Arm swing on rig 3"])
    sheet.append(["Sampling rate:", "125 Hz"])
    sheet.append([])
    sheet.append(["when"] + names[1:] + ["dp"])
    for number, line in enumerate(lines[1 : ROWS + 1]):
        cells = [float(cell.replace(",", ".")) for cell in line.split(";")]
        when = START + datetime.timedelta(milliseconds=cells[0])
        row = sheet.max_row + 1
        # Nothing was measured once, and a formula of which openpyxl keeps no value stands in the last column.
        values = [None if number == 7 and at == 0 else cell for at, cell in enumerate(cells[1:])]
        sheet.append([when] + values + [f"=C{row}-D{row}"])
        sheet.cell(row, 1).number_format = "yyyy-mm-dd hh:mm:ss.000"
    notes = book.create_sheet("notes")
    notes.append(["Oil", "HLP 46"])
    counted = book.create_sheet("counted")
    counted.append(["Abtastrate [Hz]", 1000])
    counted.append(["p_A", "x"])
    counted.append(["bar", "mm"])
    for number in range(5):
        counted.append([10.5 + number, f"{number} mm"])
    book.save(target)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
