"""Errors and warnings."""

from dataclasses import dataclass
from typing import Any

from wale.codes import Code


@dataclass(frozen=True)
class Span:
    """A place in a Wale file."""

    file: str
    line: int
    """From 1."""
    column: int
    """From 1, in characters."""
    length: int
    """Bytes from there on; 0 if that is not known."""


class Error(Exception):
    """What a call raises; also a warning about a text, which is not raised (`Program.warnings`)."""

    code: Code | int
    """A `Code`, or the number of a newer one. Programs decide by it."""
    severity: str
    """ "error" or "warning"."""
    sentence: str
    """What is wrong, for people."""
    mend: str
    """What to do about it; may be empty."""
    expected: str
    """What would be right, in a Wale file or as an argument; may be empty."""
    found: str
    """What the text or the argument has; may be empty."""
    argument: str
    """The argument, file or section that it is about; may be empty."""
    text: str
    """The text at that place; may be empty."""
    span: Span | None
    """The place in a Wale file, if it is about one."""
    nearest: tuple[str, ...]
    """Names that may have been meant, the nearest first."""
    others: "tuple[Error, ...]"
    """The other errors and warnings of the same text."""

    def __init__(self, words: str, **fields: Any) -> None:
        super().__init__(words)
        vars(self).update(fields)

    @staticmethod
    def of_file(path: str, why: OSError) -> "Error":
        """For a file that this package reads itself."""
        sentence, mend = f"cannot be read: {why.strerror or why}", "name a file that this user may read"
        shown = "".join(each if each.isprintable() else f"\\u{ord(each):04x}" for each in path)  # as the library does
        return Error(f"{shown}: {sentence}; {mend}", code=Code.unreadable_file, severity="error", sentence=sentence, mend=mend,
                     expected="", found="", argument=path, text="", span=None, nearest=(), others=())

    @staticmethod
    def of_argument(argument: str, sentence: str, mend: str, *, expected: str = "", found: str = "") -> "Error":
        """For an argument that C takes for another wish."""
        return Error(f"{argument}: {sentence}; {mend}", code=Code.malformed_value, severity="error", sentence=sentence,
                     mend=mend, expected=expected, found=found, argument=argument, text=found, span=None, nearest=(), others=())

    @property
    def name(self) -> str:
        """ "unknown_name"; empty for a code that is newer than this package."""
        return self.code.name if isinstance(self.code, Code) else ""

    @property
    def title(self) -> str:
        """One line that describes the code in general; empty for a code that is newer than this package."""
        return self.code.title if isinstance(self.code, Code) else ""

    def __str__(self) -> str:
        return f"W{self.code:04}: {self.args[0]}"
