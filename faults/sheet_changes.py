"""What happens to tables on their way: each change by its name, drawn by chance with a seed."""

from __future__ import annotations

import codecs
import random
import re
from collections.abc import Callable
from typing import Final

from .sheets import NUMBER, Sheet

# Changes a sheet.
Change = Callable[[Sheet, random.Random], None]


def _dressed(**marks: object) -> Change:
    def change(sheet: Sheet, chance: random.Random) -> None:
        for name, mark in marks.items():
            setattr(sheet.dress, name, mark)

    return change


def _blank_lines(sheet: Sheet, chance: random.Random) -> None:
    sheet.dress.blank_lines = tuple(chance.randrange(99) for _ in range(3))


def _comments(sheet: Sheet, chance: random.Random) -> None:
    sheet.dress.comments = tuple(chance.randrange(99) for _ in range(2))


DRESSES: Final[dict[str, Change]] = {
    "semicolons": _dressed(separator=";"),
    "semicolons_decimal_commas": _dressed(separator=";", decimal=","),
    "tabs": _dressed(separator="\t"),
    "tabs_decimal_commas": _dressed(separator="\t", decimal=","),
    "commas_decimal_commas": _dressed(decimal=","),
    "bars": _dressed(separator="|"),
    "thousands_commas": _dressed(thousands=","),
    "thousands_points": _dressed(separator=";", decimal=",", thousands="."),
    "thousands_apostrophes": _dressed(thousands="'"),
    "thousands_narrow_blanks": _dressed(separator=";", decimal=",", thousands="\u202f"),
    "quotes": _dressed(quote_all=True),
    "quoted_semicolons": _dressed(quote_all=True, separator=";", decimal=","),
    "crlf": _dressed(line_end="\r\n"),
    "cr": _dressed(line_end="\r"),
    "no_last_line_end": _dressed(last_end=False),
    "utf_8_mark": _dressed(mark=codecs.BOM_UTF8),
    "utf_16_le": _dressed(encoding="utf-16-le", mark=codecs.BOM_UTF16_LE),
    "utf_16_be": _dressed(encoding="utf-16-be", mark=codecs.BOM_UTF16_BE),
    "utf_16_bare": _dressed(encoding="utf-16-le"),
    "utf_32": _dressed(encoding="utf-32-le", mark=codecs.BOM_UTF32_LE),
    "utf_7": _dressed(encoding="utf-7"),
    "latin_1": _dressed(encoding="latin-1"),
    "cp1252": _dressed(encoding="cp1252"),
    "gb2312": _dressed(encoding="gb2312"),
    "shift_jis": _dressed(encoding="shift_jis"),
    "blank_lines": _blank_lines,
    "comments": _comments,
    "padding": _dressed(padding=" "),
    "padding_non_breaking": _dressed(padding="\u00a0"),
}


def _number_cell(sheet: Sheet, chance: random.Random) -> tuple[int, int] | None:
    """Return the place of a cell with a number, None if there is none."""
    places = [
        (r, c)
        for r, row in enumerate(sheet.rows)
        for c, cell in enumerate(row)
        if NUMBER.fullmatch(cell)
    ]
    return chance.choice(places) if places else None


def _cell(new: Callable[[str, random.Random], str]) -> Change:
    """Return the change of one number."""

    def change(sheet: Sheet, chance: random.Random) -> None:
        if place := _number_cell(sheet, chance):
            row, at = place
            sheet.rows[row][at] = new(sheet.rows[row][at], chance)

    return change


def _column(new: Callable[[str, random.Random], str]) -> Change:
    """Return the change of all numbers in a column."""

    def change(sheet: Sheet, chance: random.Random) -> None:
        if place := _number_cell(sheet, chance):
            for row in sheet.rows:
                if NUMBER.fullmatch(row[place[1]]):
                    row[place[1]] = new(row[place[1]], chance)

    return change


def _digit(cell: str, chance: random.Random) -> str:
    at = chance.choice([m.start() for m in re.finditer(r"\d", cell)])
    return cell[:at] + chance.choice("0123456789") + cell[at + 1 :]


def _sign(cell: str, chance: random.Random) -> str:
    return cell[1:] if cell.startswith("-") else "-" + cell


def _minus(cell: str, chance: random.Random) -> str:
    return chance.choice("\u2212\u2013") + cell.lstrip("-+")


def _script(cell: str, chance: random.Random) -> str:
    zero = chance.choice((0x0660, 0x0966, 0x0E50, 0xFF10, 0x1D7CE))
    return "".join(chr(zero + int(c)) if c.isdigit() and c.isascii() else c for c in cell)


def _float(cell: str, chance: random.Random) -> str:
    return cell if "." in cell or "e" in cell.lower() else cell + chance.choice((".0", ".", ".00"))


def _exponent(cell: str, chance: random.Random) -> str:
    return f"{float(cell):.17e}".replace("e", chance.choice("eE"))


def _with_unit(cell: str, chance: random.Random) -> str:
    return cell + chance.choice((" km/h", "m", " %", " s", "ms", "\u00b0"))


def _missing(cell: str, chance: random.Random) -> str:
    return chance.choice(("", "NA", "NaN", "nan", "N/A", "-99", "-999", "null", "#N/A", "."))


def _odd(cell: str, chance: random.Random) -> str:
    return chance.choice(
        ("1_000", "0x1F", "1e999", "-1e999", "inf", "-inf", "1/2", "1:30", "True", "1.2.3", "--1",
         "1e", "12 34", "1,5", "=1+1", "9" * 400, "01.02.2026", "\u00bd", "\u4e09", "1\u00a0500,25",
         "1.234,5", "1,234.5", "(5)", "5-", "1d3", "+-1", "nan(1)", "infinity", "0b1", "1L")
    )  # fmt: skip


def _huge(cell: str, chance: random.Random) -> str:
    return chance.choice(("1e9", "1e300", "-1e300", "123456789012345678901234567890", "1e-320"))


def _swap_names(sheet: Sheet, chance: random.Random) -> None:
    a, b = chance.sample(range(len(sheet.header)), 2)
    sheet.header[a], sheet.header[b] = sheet.header[b], sheet.header[a]


def _move_column(sheet: Sheet, chance: random.Random) -> None:
    a, b = chance.sample(range(len(sheet.header)), 2)
    for row in (sheet.header, *sheet.rows):
        row.insert(b, row.pop(a))


def _repeat_column(sheet: Sheet, chance: random.Random) -> None:
    at, change = chance.randrange(len(sheet.header)), chance.random() < 0.5
    sheet.header.append(sheet.header[at])
    for row in sheet.rows:
        row.append(_digit(row[at], chance) if change and NUMBER.fullmatch(row[at]) else row[at])


def _drop_column(sheet: Sheet, chance: random.Random) -> None:
    at = chance.randrange(len(sheet.header))
    for row in (sheet.header, *sheet.rows):
        del row[at]


def _rename_column(sheet: Sheet, chance: random.Random) -> None:
    at = chance.randrange(len(sheet.header))
    name = sheet.header[at]
    cut = chance.randrange(len(name))
    sheet.header[at] = chance.choice(
        (name.upper(), name.title(), name.replace("_", " "), name[:cut] + name[cut + 1 :],
         f"{name} ", name + "s", name.replace("_", "-"), f"\u200b{name}",
         name.replace("mps", "kmh"))
    )  # fmt: skip


def _more_columns(sheet: Sheet, chance: random.Random) -> None:
    extra = chance.randrange(1, 30)
    sheet.header += [f"other_{n}" for n in range(extra)]
    for row in sheet.rows:
        row.extend([chance.choice(("1", "x", "", "a,b;c", 'he said "no"', "two\nlines"))] * extra)


def _no_header(sheet: Sheet, chance: random.Random) -> None:
    if sheet.rows:
        sheet.header = sheet.rows.pop(0)


def _repeat_row(sheet: Sheet, chance: random.Random) -> None:
    at = chance.randrange(len(sheet.rows))
    sheet.rows.insert(chance.choice((at, len(sheet.rows))), list(sheet.rows[at]))


def _drop_rows(sheet: Sheet, chance: random.Random) -> None:
    at = chance.randrange(len(sheet.rows))
    del sheet.rows[at : at + chance.choice((1, 1, 5, 99))]


def _shuffle_rows(sheet: Sheet, chance: random.Random) -> None:
    chance.shuffle(sheet.rows)


def _short_row(sheet: Sheet, chance: random.Random) -> None:
    sheet.rows[chance.randrange(len(sheet.rows))].pop()


def _long_row(sheet: Sheet, chance: random.Random) -> None:
    sheet.rows[chance.randrange(len(sheet.rows))].append(chance.choice(("", "1", "x")))


def _header_again(sheet: Sheet, chance: random.Random) -> None:
    sheet.rows.insert(chance.randrange(len(sheet.rows) + 1), list(sheet.header))


def _word(sheet: Sheet, chance: random.Random) -> None:
    """Write a word otherwise: in lower case, with blanks, as another one, as a number."""
    row = chance.choice(sheet.rows)
    at = [n for n, cell in enumerate(row) if cell and not NUMBER.fullmatch(cell)]
    if at:
        n = chance.choice(at)
        row[n] = chance.choice(
            (row[n].lower(), row[n].upper(), row[n].title(), f" {row[n]}", row[n][:-1], "", "2",
             f"{row[n]}\u00a0", row[n] + "\n", "\u00e4\u00f6\u00fc \u6f22", "NA")
        )  # fmt: skip


CONTENTS: Final[dict[str, Change]] = {
    "digit": _cell(_digit),
    "sign": _cell(_sign),
    "sign_of_a_column": _column(_sign),
    "minus_u2212": _cell(_minus),
    "minus_u2212_column": _column(_minus),
    "digits_of_other_scripts": _cell(_script),
    "floats": _cell(_float),
    "floats_column": _column(_float),
    "exponent": _cell(_exponent),
    "exponent_column": _column(_exponent),
    "unit": _cell(_with_unit),
    "unit_column": _column(_with_unit),
    "missing": _cell(_missing),
    "missing_column": _column(lambda _cell, _chance: "NA"),
    "odd": _cell(_odd),
    "huge": _cell(_huge),
    "swapped_names": _swap_names,
    "moved_column": _move_column,
    "repeated_column": _repeat_column,
    "dropped_column": _drop_column,
    "renamed_column": _rename_column,
    "more_columns": _more_columns,
    "no_header": _no_header,
    "repeated_row": _repeat_row,
    "dropped_rows": _drop_rows,
    "shuffled_rows": _shuffle_rows,
    "short_row": _short_row,
    "long_row": _long_row,
    "header_again": _header_again,
    "word": _word,
}


# What is plain to anybody: alone, it has to be read.
PLAIN: Final = frozenset(
    ("semicolons", "semicolons_decimal_commas", "tabs", "tabs_decimal_commas", "quotes",
     "quoted_semicolons", "crlf", "no_last_line_end", "utf_8_mark", "utf_16_le", "utf_16_be",
     "blank_lines", "comments", "padding", "floats", "floats_column", "moved_column",
     "more_columns")
)  # fmt: skip
