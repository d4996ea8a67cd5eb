"""Line length of templates: a rule for j2lint, whose class must be named after this file."""

from j2lint.linter.error import LinterError
from j2lint.linter.rule import Rule

LONGEST = 120


class LineLength(Rule):
    """Lines have at most 120 characters, as in the code."""

    rule_id = "L1"
    description = f"Lines should have at most {LONGEST} characters"
    short_description = "line-length"
    severity = "LOW"

    def checktext(self, filename: str, text: str) -> list[LinterError]:
        raise NotImplementedError  # the base class then asks for each line

    def checkline(self, filename: str, line: str, line_no: int) -> list[LinterError]:
        return [LinterError(line_no, line, filename, self)] if len(line.rstrip("\n")) > LONGEST else []
