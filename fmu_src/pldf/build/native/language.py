"""The part of Python that kernels are written in, checked before anything is compiled.

numba takes far more than gives the same bits on every machine, or runs without Python. What it
refuses it explains for people who know numba. This check names file and line.
"""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterable, Set
from dataclasses import fields
from types import FunctionType, ModuleType
from typing import Any, Final

_ALLOWED: Final = (
    ast.FunctionDef, ast.Return, ast.Expr, ast.Pass,
    ast.Assign, ast.AnnAssign, ast.AugAssign, ast.If, ast.For, ast.While, ast.Break, ast.Continue,
    ast.Name, ast.Constant, ast.Attribute, ast.Subscript, ast.Tuple, ast.Call, ast.IfExp,
    ast.BoolOp, ast.And, ast.Or, ast.UnaryOp, ast.USub, ast.UAdd, ast.Not, ast.Invert,
    ast.BinOp, ast.Add, ast.Sub, ast.Mult, ast.Div, ast.BitAnd, ast.BitOr, ast.BitXor,
    ast.RShift,
    ast.Compare, ast.Eq, ast.NotEq, ast.Lt, ast.LtE, ast.Gt, ast.GtE, ast.In, ast.NotIn,
    ast.Load, ast.Store,
)  # fmt: skip
_BUILT_IN: Final = frozenset(
    {"abs", "bool", "float", "floor", "int", "len", "max", "min", "range", "sqrt"}
)
_ADVICE: Final[dict[type[ast.AST], str]] = {
    ast.Pow: "no ** in a kernel: it differs from machine to machine; write x * x",
    ast.FloorDiv: "no // in a kernel; write floor(a / b)",
    ast.Mod: "no % in a kernel; write a - b * floor(a / b)",
    ast.Dict: "no dict in a kernel; use fields of the record",
    ast.List: "no list in a kernel; use an array of a group",
    ast.Raise: "no exception in a kernel; set a code in the record",
}


def check_language(modules: Iterable[ModuleType], record: type[Any]) -> None:
    """Check all functions of a model's kernel.

    Args:
        modules: they define the functions.
        record: class of the record that the functions work on.

    Raises:
        ValueError: something else is used; with file and line of each place.
    """
    modules = tuple(modules)
    functions, attributes = set(_BUILT_IN), {field.name for field in fields(record)}
    for module in modules:
        for name, thing in vars(module).items():
            if isinstance(thing, FunctionType) and thing.__module__ == module.__name__:
                functions.add(name)
            attributes |= set(getattr(thing, "_fields", ()))  # of named tuples
    problems = []
    for module in modules:
        reader = _Reader(str(module.__file__), functions, attributes)
        for node in ast.parse(inspect.getsource(module)).body:
            if isinstance(node, ast.FunctionDef):
                reader.visit(node)
        problems += reader.problems
    if problems:
        raise ValueError("the kernel cannot be compiled:\n  " + "\n  ".join(problems))


class _Reader(ast.NodeVisitor):
    """Collects what does not belong into a kernel; annotations are left to mypy."""

    def __init__(self, file: str, functions: Set[str], attributes: Set[str]) -> None:
        self.problems: list[str] = []
        self._file = file
        self._functions = functions
        self._attributes = attributes
        self._line = 0

    def visit(self, node: ast.AST) -> None:
        """Check a node, and those inside it if it is sound."""
        self._line = getattr(node, "lineno", self._line)
        problem = self._problem(node)
        if problem:
            self.problems.append(f"{self._file}:{self._line}: {problem}")
        elif isinstance(node, ast.FunctionDef):
            for statement in node.body:
                self.visit(statement)
        elif isinstance(node, ast.AnnAssign):
            for part in (node.target, node.value):
                if part is not None:
                    self.visit(part)
        else:
            self.generic_visit(node)

    def _problem(self, node: ast.AST) -> str:
        if not isinstance(node, _ALLOWED):
            default = f"{type(node).__name__} is not in the part of Python that kernels use"
            return _ADVICE.get(type(node), default)
        if isinstance(node, ast.Call):
            name = ast.unparse(node.func)
            return "" if name in self._functions else f"{name}() is no function of the kernel"
        if isinstance(node, ast.Attribute) and node.attr not in self._attributes:
            return f"neither the record nor a group of arrays has a field {node.attr!r}"
        return ""
