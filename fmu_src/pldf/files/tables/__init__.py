"""Tables: CSV files with a header line, declared by their columns; one reader, one writer."""

from .declared import Column, Fault, Format, TableError
from .names import meant_names, misspelt, told_meant, told_misspelt
from .reader import LeftOut, Table, parse_table, read_header, read_table
from .writer import Cell, table_csv, write_table

__all__ = (
    "Cell",
    "Column",
    "Fault",
    "Format",
    "LeftOut",
    "Table",
    "TableError",
    "meant_names",
    "misspelt",
    "parse_table",
    "read_header",
    "read_table",
    "table_csv",
    "told_meant",
    "told_misspelt",
    "write_table",
)
