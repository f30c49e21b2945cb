"""What interpreters show as a small table."""

from __future__ import annotations


class Tabular:
    """Something that interpreters show as a small table of labels and texts."""

    @property
    def heading(self) -> str:
        """What stands above the table."""
        return type(self).__name__

    def rows(self) -> list[tuple[str, str]]:
        """Pairs of label and text to show."""
        raise NotImplementedError

    def brief_rows(self) -> list[tuple[str, str]]:
        """Rows of the text form: all of them, unless a kind of result can have too many."""
        return self.rows()

    def __repr__(self) -> str:
        rows = self.brief_rows()
        width = max((len(name) for name, _ in rows), default=0)
        return "\n".join([self.heading, *(f"  {name:<{width}}  {text}".rstrip() for name, text in rows)])
