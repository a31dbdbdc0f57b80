"""What is wrong with files before anybody counts on them: all of it at once."""

from .checked import UNCHECKED, CheckedFile, Checks
from .files import check_file
from .folder import analysed, check_folder, is_study

__all__ = (
    "UNCHECKED",
    "CheckedFile",
    "Checks",
    "analysed",
    "check_file",
    "check_folder",
    "is_study",
)
