"""Identifiers, docstrings, messages and documents use the words of ``docs/glossary.md``, and no two classes have one name."""

import ast
import io
import re
import tokenize
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).parents[1]
SOURCES = sorted((ROOT / "src" / "carom").rglob("*.py"))
DOCUMENTS = [path for path in sorted((ROOT / "docs").rglob("*.md")) if not {"decisions", "generated"} & set(path.parts)]
IN_NAMES = re.compile(
    r"(?<![a-z])(told|harmless|heavy|strikes?|struck|blows?|hits?|mirror(ed|s)?|fate|forget|doubt|keeps_step|set_out|carry_to_wall"
    r"|spare_(friction|grip)|telling_pair|rests_on|felt|wished|gives_way|yields|arrivals?|known_of)(?![a-z])",
    re.IGNORECASE,
)
CONSTANTS = {"SAME", "NEAR", "ALIKE", "CLOSE", "AROUND", "BESIDE"}
IN_TEXT = re.compile(
    r"\b(told|mirrored|felt mass|walls? that gives? way|gives way|strikes|struck|arrivals?|blows?)\b", re.IGNORECASE
)
ALLOWED = {
    "gives_way": "a local name of a kernel, which would be compiled anew",
    "STRUCK": "a verdict of a kernel, which would be compiled anew",
    "harmless_kick": "a key of JSON",
    "spare_friction": "a number of stored certificates",
    "Arrivals at a wall and lasting contact there": "the first line of a module of kernels",
}
"""Names and lines that stay, and why.  Keys of JSON such as ``harmless_up_to_si`` are texts, no names."""


def names_in(path):
    """Lines and identifiers of a module that have a better name."""
    for token in tokenize.generate_tokens(io.StringIO(path.read_text(encoding="utf-8")).readline):
        name = token.string
        if token.type == tokenize.NAME and (IN_NAMES.search(name) or name in CONSTANTS) and name not in ALLOWED:
            yield f"{path}:{token.start[0]}: {name}"


def texts_in(path):
    """Lines of a file with a phrase that has a better word."""
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        if IN_TEXT.search(line) and not any(text in line for text in ALLOWED):
            yield f"{path}:{number}: {line.strip()}"


def test_names_and_texts_use_the_terms_of_the_field():
    names = [found for path in SOURCES for found in names_in(path)]
    texts = [found for path in (*SOURCES, ROOT / "README.md", *DOCUMENTS) for found in texts_in(path)]
    assert not names + texts, "\n".join(names + texts)


def test_no_two_classes_have_one_name():
    places = defaultdict(list)
    for path in SOURCES:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ClassDef):
                places[node.name].append(f"{path.relative_to(ROOT)}:{node.lineno}")
    assert not {name: found for name, found in places.items() if len(found) > 1}
