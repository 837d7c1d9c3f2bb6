"""Writes the type stub of a wrapped VTK class from the signatures in its documentation.

Usage: write_vtk_stub.py MODULE CLASS FILE.pyi
"""

from __future__ import annotations

import importlib
import re
import sys
from typing import List

SIMPLE = {"int", "float", "bool", "str", "bytes", "None"}


def python_type(text: str) -> str:
    """A type as VTK's documentation writes it, as annotations do."""
    text = text.strip()
    if text in SIMPLE:
        return text
    inner = re.fullmatch(r"[(\[](.*)[)\]]", text, re.DOTALL)
    if inner and not re.search(r"[(\[]", inner[1]):
        parts = [python_type(part) for part in inner[1].split(",") if part.strip()]
        # VTK takes any sequence where it documents a list.
        return f"Tuple[{', '.join(parts)}]" if text[0] == "(" else "Sequence[Any]"
    # Classes of VTK: its modules have no stubs that could be relied on.
    return "Any"


def stub_of(name: str, signature: str) -> str:
    """One signature, such as "SetBits(self, _arg:int) -> None", as a line of a stub."""
    arguments, result = re.fullmatch(r"\w+\((.*)\)\s*->\s*(.*)", signature, re.DOTALL).groups()
    own = arguments.startswith("self")
    rest = arguments[4:].lstrip(", ") if own else arguments
    parts = [] if not own else ["self"]
    # Commas inside of tuples part no arguments.
    for argument in re.findall(r"(\w+):((?:\([^)]*\)|\[[^\]]*\]|[^,(\[])+)", rest):
        annotation, given, _ = argument[1].partition("=")
        kind = python_type(annotation)
        # Strings of C++ are bytes as well.
        kind = "Union[str, bytes]" if kind == "str" else kind
        parts.append(f"{argument[0]}: {kind}" + (" = ..." if given else ""))
    line = f"    def {name}({', '.join(parts)}) -> {python_type(result)}: ..."
    return line if own else "    @staticmethod\n" + line


def methods_of(cls: type) -> List[str]:
    """The stubs of all public methods of a class that are its own."""
    lines = []
    for name, value in vars(cls).items():
        if name.startswith("_"):
            continue
        if isinstance(value, type):
            lines.append(f"    class {name}(int): ...")
            continue
        if isinstance(value, int):
            lines.append(f"    {name}: int")
            continue
        documentation = value.__doc__ or ""
        pattern = rf"^({name}\(.*?\)\s*->.*?)\nC\+\+:"
        found = re.findall(pattern, documentation, re.DOTALL | re.MULTILINE)
        signatures = [re.sub(r"\s+", " ", signature) for signature in found]
        for signature in signatures:
            overload = "    @overload\n" if len(signatures) > 1 else ""
            lines.append(overload + stub_of(name, signature))
        if not signatures:
            lines.append(f"    def {name}(self, *arguments: Any) -> Any: ...")
    return lines


def main(module: str, class_name: str, path: str) -> None:
    cls = getattr(importlib.import_module(module), class_name)
    base = cls.__bases__[0]
    text = [
        "from typing import Any, Sequence, Tuple, Union, overload",
        "",
        f"from {base.__module__} import {base.__name__}",
        "",
        f"class {class_name}({base.__name__}):",
        *methods_of(cls),
        "",
    ]
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(text))


if __name__ == "__main__":
    main(*sys.argv[1:])
