"""Speed signs by country: which ``type`` and ``subtype`` of an OpenDRIVE signal is one.

Types are those of the national catalogues, as exporters write them: the German numbers (VzKat) also
under the country "OpenDRIVE" and others that have none of their own, as VTD, CARLA, openPASS and
CommonRoad do; esmini's names for Sweden; MUTCD for the USA.
"""

from __future__ import annotations

import math
import re
from typing import Final, Literal, NamedTuple

from ..opendrive.xml_tree import as_number
from ..options import LimitUnit

# limit: begins a limit; end: ends it; implied: the law has a limit here, which it does not show.
Meaning = Literal["limit", "end", "implied"]


class SignType(NamedTuple):
    """What a signal says of the speed.

    Attributes:
        meaning: what it does.
        number: what it shows, None: nothing.
        unit: of the number, unless it stands in ``value`` and has its own.
        doubt: what contradicts the number, empty: nothing.
    """

    meaning: Meaning
    number: float | None
    unit: LimitUnit
    doubt: str


class _Row(NamedTuple):
    pattern: str  # of TYPE or TYPE-SUBTYPE; group n: the number
    meaning: Meaning = "limit"
    number: float | None = None


_N: Final = r"(?:(?:[-._V]|\()(?P<n>[0-9]+)\)?)?"
_GERMAN: Final = (
    _Row(r"274(?:-(?P<n>[0-9]+))?"),
    _Row(r"274\.1(?:-(?P<n>[0-9]+))?", number=30.0),
    _Row(r"(?:274\.2|278)(?:-\d+)?|282", "end"),
    _Row(r"(?:310|311|325\.1|325\.2)(?:-\d+)?", "implied"),
)
_AMERICAN: Final = (_Row(r"R2-1" + _N),)
_ROWS: Final[dict[str, tuple[_Row, ...]]] = {
    "AT": (_Row(r"(?:52A?[-./]?)?1[01]A" + _N), _Row(r"(?:52A?[-./]?)?1[01]B" + _N, "end")),
    "AU": (_Row(r"R4-1" + _N), _Row(r"R4-(?:2|12)", "end")),
    "BE": (
        _Row(r"C-?43" + _N), _Row(r"C-?45" + _N, "end"),
        _Row(r"F-?4A", number=30.0), _Row(r"F-?4B", "end"),
    ),
    "CH": (_Row(r"2\.(?:30|59\.1)(?:[-.](?P<n>[0-9]+))?"), _Row(r"2\.(?:53|58|59\.2)", "end")),
    "CZ": (_Row(r"B-?20A" + _N), _Row(r"B-?20B" + _N, "end")),
    "DE": _GERMAN,
    "DK": (_Row(r"C-?55" + _N), _Row(r"C-?56" + _N, "end")),
    "ES": (
        _Row(r"R-?301" + _N), _Row(r"R-?50[01]" + _N, "end"),
        _Row(r"S-?30", number=30.0), _Row(r"S-?31", "end"),
    ),
    "FI": (
        _Row(r"(?:361|363|C-?32|C-?34)(?:[-_](?P<n>[0-9]+))?"),
        _Row(r"(?:362|364|C-?33|C-?35)(?:[-_]\d+)?", "end"),
    ),
    "FR": (
        _Row(r"B-?14" + _N), _Row(r"B-?3[13]" + _N, "end"),
        _Row(r"B-?30", number=30.0), _Row(r"B-?51", "end"),
    ),
    "GB": (
        _Row(r"670" + _N), _Row(r"674", number=20.0), _Row(r"675", "end"),
        _Row(r"671", "end"),
    ),
    "IT": (_Row(r"(?:II[-. ]?)?50" + _N), _Row(r"(?:II[-. ]?)?7[01]", "end")),
    "JP": (_Row(r"323" + _N),),
    "KR": (_Row(r"224" + _N),),
    "NL": (_Row(r"A-?0?1" + _N), _Row(r"A-?0?2" + _N, "end")),
    "NO": (_Row(r"36[26](?:[-.](?P<n>[0-9]+))?"), _Row(r"36[48](?:[-.]\d+)?", "end")),
    "PL": (_Row(r"B-?(?:33|43)" + _N), _Row(r"B-?(?:34|42|44)" + _N, "end")),
    "RU": (_Row(r"3\.24" + _N), _Row(r"5\.31" + _N), _Row(r"(?:3\.25|3\.31|5\.32)" + _N, "end")),
    "SE": (_Row(r"C-?31" + _N), _Row(r"C-?32" + _N, "end")),
    "US": _AMERICAN,
}  # fmt: skip
_MPH: Final = ("GB", "US")
# Alpha-3 codes and the names of OpenDRIVE up to 1.4.
_CODES: Final = {
    "AUT": "AT", "AUSTRIA": "AT", "AUS": "AU", "BEL": "BE", "CHE": "CH", "SWITZERLAND": "CH",
    "CZE": "CZ", "DEU": "DE", "GERMANY": "DE", "DNK": "DK", "ESP": "ES", "FIN": "FI", "FRA": "FR",
    "FRANCE": "FR", "GBR": "GB", "UK": "GB", "ITA": "IT", "ITALY": "IT", "JPN": "JP", "KOR": "KR",
    "NLD": "NL", "NOR": "NO", "POL": "PL", "RUS": "RU", "SWE": "SE", "SWEDEN": "SE", "USA": "US",
}  # fmt: skip
_SWEDISH_MAX: Final = 13.0
_NOTHING: Final = ("", "-1", "NONE")


def sign_type(country: str, kind: str, subtype: str, value: str) -> SignType | None:
    """Return what a signal says of the speed, None if it is no speed sign.

    Args:
        country: alpha-2 or alpha-3 code or name, in any case; "OpenDRIVE" or empty: any.
        kind: attribute ``type``.
        subtype: attribute ``subtype``; -1 and none are none.
        value: attribute ``value``; it counts if it is a number above 0.
    """
    code = _code(country)
    named = _full_code(kind, subtype)
    for row in _rows(code):
        found = re.fullmatch(row.pattern, named)
        if found:
            named_number = found.groupdict().get("n")
            in_name = set() if named_number is None else _readings(code, row, float(named_number))
            number, doubt = _chosen(_value(code, value), in_name, row)
            unit: LimitUnit = "mph" if code in _MPH or row in _AMERICAN else "km/h"
            return SignType(row.meaning, number, unit, doubt)
    return None


def supplementary(country: str, kind: str, subtype: str) -> str:
    """Return the code of a German supplementary sign (when wet, at night), empty: none."""
    named = _full_code(kind, subtype)
    is_german = _GERMAN[0] in _rows(_code(country))[:1]
    return named if is_german and re.fullmatch(r"10[0-6]\d(?:-\d+)?", named) else ""


def country_rows() -> dict[str, tuple[str, ...]]:
    """Return the patterns of each country, for the documentation's test."""
    return {country: tuple(row.pattern for row in rows) for country, rows in _ROWS.items()}


def _code(country: str) -> str:
    code = "".join(country.split()).upper()
    return _CODES.get(code, code)


def _rows(country: str) -> tuple[_Row, ...]:
    own = _ROWS.get(country)
    # CommonRoad writes 274 for the limit in every country.
    return _GERMAN + _AMERICAN if own is None else own + _GERMAN[:1]


def _full_code(kind: str, subtype: str) -> str:
    parts = ["".join(part.split()).upper() for part in (kind, subtype)]
    return "-".join(part for part in parts if part not in _NOTHING)


def _value(country: str, text: str) -> float | None:
    value = as_number(text)
    if country == "SE" and 0.0 < value <= _SWEDISH_MAX:
        value *= 10.0  # esmini has the last part of the code there: C31-5 shows 50
    return value if 0.0 < value < math.inf else None


def _readings(country: str, row: _Row, number: float) -> set[float]:
    """Return the km/h or mph that the number of a code stands for; several where it is unclear."""
    if country == "SE" and number <= _SWEDISH_MAX:
        return {10.0 * number}
    old = 10.0 * (number - 50.0)  # 274-55 showed 50 until 2017, when that became 274-50
    if row is _GERMAN[0] and 0.0 < old <= 130.0:
        return {number, old} if number % 10.0 == 0.0 else {old}
    if row is _GERMAN[1]:
        return {number} if number < 50.0 else set()  # 274.1-50 was the zone of 30
    return {number}


def _chosen(value: float | None, in_name: set[float], row: _Row) -> tuple[float | None, str]:
    """Return what counts, value before subtype, and what contradicts it."""
    shown = " or ".join(f"{number:g}" for number in sorted(in_name))
    if value is not None:
        return value, f"its subtype means {shown}" if in_name and value not in in_name else ""
    if not in_name:
        return row.number, ""
    return min(in_name), f"its subtype means {shown}" if len(in_name) > 1 else ""
