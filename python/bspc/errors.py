"""How errors of the VTK classes become exceptions."""

from __future__ import annotations

from typing import Any, List

from vtkmodules.util.misc import calldata_type
from vtkmodules.vtkCommonCore import VTK_STRING
from vtkmodules.vtkCommonMisc import vtkErrorCode


class Error(Exception):
    """A file could not be read or written; the text says what is wrong, where, and what to do.

    ``code`` is one of ``vtkmodules.vtkCommonMisc.vtkErrorCode``.
    """

    def __init__(self, message: str, code: int) -> None:
        super().__init__(message)
        self.code = code


class ErrorLog:
    """Collects what an algorithm and its executive report, so that nothing is printed."""

    def __init__(self, algorithm: Any) -> None:
        self._messages: List[str] = []
        self._algorithm = algorithm
        for source in (algorithm, algorithm.GetExecutive()):
            source.AddObserver("ErrorEvent", self._note)

    @calldata_type(VTK_STRING)
    def _note(self, _source: Any, _event: str, message: str) -> None:
        # "ERROR: In FILE, line N\nCLASS (ADDRESS): what is wrong\n\n"
        text = message.strip().split("\n", 1)[-1]
        self._messages.append(text.partition("): ")[2] or text)

    def check(self, succeeded: bool) -> None:
        """Raises the first error that was reported; FileNotFoundError if there is no file."""
        code = self._algorithm.GetErrorCode()
        if succeeded and code == 0 and not self._messages:
            return
        message = self._messages[0] if self._messages else "nothing was read or written"
        if code == vtkErrorCode.FileNotFoundError:
            raise FileNotFoundError(message)
        raise Error(message, code)
