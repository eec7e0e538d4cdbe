"""Lays out the sources of the manual: stage.py COMMAND FOLDER.

The folder gets the pages of docs at their places in the repository, every page and file that they lead to, and
pages that are made here: the command reference, from the help of COMMAND, the JSON schemas, and the Python API.
A link to a file that does not exist is an error; Sphinx checks the links between pages.
"""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HERE = Path(__file__).resolve().parent

#: Pages that nothing of the contents leads to, but whose links are checked with the others.
ALSO = ["README.md", "CHANGELOG.md"]

#: A link or picture of Markdown: its path, without an anchor.
LINK = re.compile(r"\]\(([^)\s#]+)(?:#[^)\s]*)?\)")
FENCE = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)


def main(command: str, folder: Path) -> None:
    """Lays out everything; ends the program with a message where a link leads nowhere."""
    pages = sorted(ROOT.glob("docs/*.md")) + sorted(ROOT.glob("docs/figures/*.md"))
    copied = copied_with_links(pages + [ROOT / name for name in ALSO], folder)
    made = folder / "docs/reference"
    made.mkdir(parents=True)
    (made / "commands.md").write_text(command_reference(command), encoding="utf-8")
    (made / "schemas.md").write_text(schema_reference(folder), encoding="utf-8")
    shutil.copy(HERE / "python-api.md", made)
    index = folder / "docs/index.md"
    index.write_text(with_contents(index.read_text(encoding="utf-8"), copied), encoding="utf-8")


def copied_with_links(pages: list[Path], folder: Path) -> list[Path]:
    """Copies pages, and all that they lead to; returns the pages, relative to the repository."""
    waiting, done, wrong = list(pages), set(), []
    while waiting:
        source = waiting.pop()
        if source in done:
            continue
        done.add(source)
        target = folder / source.relative_to(ROOT)
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.suffix != ".md":
            shutil.copy(source, target)
            continue
        text = source.read_text(encoding="utf-8")
        target.write_text(for_sphinx(text), encoding="utf-8")
        for path in LINK.findall(FENCE.sub("", text)):
            if "://" in path:
                continue
            linked = (source.parent / path).resolve()
            if linked.is_file() and linked.is_relative_to(ROOT):
                waiting.append(linked)
            else:
                wrong.append(f"{source.relative_to(ROOT)}: found a link to {path}, expected a file")
    if wrong:
        sys.exit("\n".join(sorted(wrong)))
    return sorted(path.relative_to(ROOT) for path in done if path.suffix == ".md")


def for_sphinx(text: str) -> str:
    """A page whose code blocks have the names of languages only, without the words of other tools."""
    return re.sub(r"^```(\w+),\S+$", r"```\1", text, flags=re.MULTILINE)


def with_contents(index: str, pages: list[Path]) -> str:
    """The index with tables of contents: one for each heading, of the pages that stand below it."""
    head, *sections = re.split(r"^## ", index, flags=re.MULTILINE)
    listed: set[str] = set()
    contents = []
    for section in sections:
        title = section.splitlines()[0]
        paths = [path for path in dict.fromkeys(LINK.findall(section)) if path.endswith(".md")]
        listed.update(str((ROOT / "docs" / path).resolve().relative_to(ROOT)) for path in paths)
        contents.append(toctree(title, paths))
    made = ["reference/commands.md", "reference/python-api.md", "reference/schemas.md"]
    others = [
        "../" + str(page)
        for page in pages
        if str(page) not in listed and page != Path("docs/index.md")
    ]
    figures = [path for path in others if path.startswith("../docs/figures/")]
    others = [path for path in others if path not in figures]
    contents += [toctree("Reference", made), toctree("Measured figures", figures), toctree("More", others)]
    return "\n## ".join([head, *sections]) + "\n".join(contents)


def toctree(caption: str, paths: list[str]) -> str:
    """A table of contents that shows at the side only."""
    lines = "\n".join(path.removesuffix(".md") for path in paths)
    return f"\n```{{toctree}}\n:hidden:\n:caption: {caption}\n\n{lines}\n```\n"


def command_reference(command: str) -> str:
    """The help of the command and of all its commands."""
    page = ["# Command reference", "The help of every command, as `--help` prints it."]
    waiting: list[list[str]] = [[]]
    while waiting:
        words = waiting.pop(0)
        text = subprocess.run(
            [command, *words, "--help"], capture_output=True, text=True, check=True
        ).stdout.rstrip()
        page.append(f"## {' '.join(['gyrocal', *words])}\n\n```text\n{text}\n```")
        block = re.search(r"^Commands:\n((?: .*\n|\n)*)", text + "\n", re.MULTILINE)
        names = re.findall(r"^  (\w\S*)", block[1], re.MULTILINE) if block else []
        waiting = [[*words, name] for name in names if name != "help"] + waiting
    return "\n\n".join(page) + "\n"


def schema_reference(folder: Path) -> str:
    """The JSON schemas, with their descriptions and members."""
    page = [
        "# JSON schemas",
        "Results for programs have a JSON Schema each; [file formats](../formats.md) describes their fields.",
    ]
    target = folder / "docs/schema"
    target.mkdir(parents=True, exist_ok=True)
    for path in sorted(ROOT.glob("docs/schema/*.json")):
        shutil.copy(path, target)
        schema = json.loads(path.read_text(encoding="utf-8"))
        rows = ["| member | meaning |", "|---|---|"]
        for name, member in schema.get("properties", {}).items():
            meaning = " ".join(member.get("description", "").split()).replace("|", "\\|")
            rows.append(f"| `{name}` | {meaning} |")
        page.append(
            f"## {path.name.removesuffix('.schema.json')}\n\n{schema.get('description', '')}\n\n"
            f"[{path.name}](../schema/{path.name})\n\n" + "\n".join(rows)
        )
    return "\n\n".join(page) + "\n"


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
