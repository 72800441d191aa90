"""Every command of the site is run when the site is built, and what it prints is what is shown.

Blocks of Markdown fenced as ``console run`` hold commands after ``$ ``; they run in one folder for the whole site, in which
``data`` and ``docs`` are the repository's and ``out`` takes what they write. Blocks fenced as ``python run`` are cells of one session a page,
and ``example NAME`` fences a notebook of ``python/examples``. Figures that a block leaves in ``out`` are pages' ``made/NAME``.

    cut=N       shows the first N lines that each command prints
    exit=N      the exit code that the last command must have, 0 where nothing is said
    last        of a notebook, shows what its last cell gives, without the code
    wrap        long lines are broken at the page's edge

A block of commands or of Python that does not run says ``why="..."``, and the page shows the reason. Anything else is an error.

The program is KICKDRIFT, or target/release/kickdrift. Python's blocks need the package; where it is not installed they are
shown with a note, or end the build where KICKDRIFT_DOCS is "all".
"""

import ast
import contextlib
import html
import importlib.util
import io
import os
import re
import shutil
import subprocess
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File

ROOT = Path(__file__).resolve().parent.parent
BLOCK = re.compile(r"^```(console|sh|bash|python|example)\b([^\n]*)\n(.*?)^```[ ]*$", re.MULTILINE | re.DOTALL)
SHOWN = {".svg", ".png", ".pdf", ".html"}
# The figures that Python's cells leave open, in the letters of the page.
STYLE = {"figure.dpi": 96, "savefig.bbox": "tight", "svg.hashsalt": "kickdrift", "figure.figsize": (7, 4)}

replaced: dict[str, list[str]] = {}
# What the cells of each notebook gave: one that stands on two pages runs once.
notebooks: dict[Path, list[str]] = {}


def on_files(files, config):
    """Runs the blocks of all pages, and adds the figures that they make to the site."""
    folder = Path(tempfile.mkdtemp(prefix="kickdrift-docs-"))
    (folder / "out").mkdir()
    for name in "data", "docs":
        (folder / name).symlink_to(ROOT / name)
    began = os.getcwd()
    try:
        os.chdir(folder)
        pages = [(file.src_uri, BLOCK.findall(file.content_string)) for file in files.documentation_pages()]
        pages = [(page, blocks) for page, blocks in pages if blocks]
        # Cells of Python share this process, its output and its figures, so their pages run one after the other. Pages of commands
        # alone run beside them.
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            beside = {page: pool.submit(answered, page, blocks, folder) for page, blocks in pages if not needs_python(blocks)}
            here = {page: answered(page, blocks, folder) for page, blocks in pages if page not in beside}
            for page, blocks in pages:
                replaced[page], seconds = here[page] if page in here else beside[page].result()
                print(f"hooks: {page}: {len(blocks)} blocks, {seconds:.1f} s")
        for path in sorted((folder / "out").iterdir()):
            if path.suffix in SHOWN:
                files.append(File.generated(config, f"made/{path.name}", content=path.read_bytes()))
    finally:
        os.chdir(began)
        shutil.rmtree(folder, ignore_errors=True)
    return files


def needs_python(blocks):
    return any(language in ("python", "example") for language, _, _ in blocks)


def answered(page, blocks, folder):
    """What is put in the place of a page's blocks, and the seconds that they took."""
    start, session = time.monotonic(), Session(page, folder)
    return [session.block(*block) for block in blocks], time.monotonic() - start


def on_page_markdown(markdown, page, config, files):
    """Puts what was printed in the place of the blocks."""
    texts = iter(replaced.get(page.file.src_uri, []))
    return BLOCK.sub(lambda _: next(texts), markdown)


class Session:
    """The blocks of one page."""

    def __init__(self, page, folder):
        self.page, self.folder = page, folder
        self.names = {"__name__": "__docs__"}
        self.cells = 0

    def block(self, language, options, body):
        why = re.search(r'why="([^"]*)"', options)
        words = dict(word.split("=", 1) for word in options.split() if "=" in word and not why)
        if why:
            return f"```{language}\n{body}```\n\n<small>Not run when this page is built: {why[1]}</small>"
        if language == "example":
            return self.notebook(ROOT / "python" / "examples" / body.strip(), "last" in options.split())
        if "run" not in options.split():
            raise PluginError(f"{self.page}: this block says neither run nor why:\n{body}")
        if language == "python":
            return self.python(body)
        kind = "{ .console .wrap }" if "wrap" in options.split() else "console"
        return self.console(body, int(words.get("cut", 10**6)), int(words.get("exit", 0)), kind)

    def console(self, body, cut, code, kind):
        program = Path(os.environ.get("KICKDRIFT", ROOT / "target/release/kickdrift")).absolute()
        if not program.exists():
            raise PluginError(f"there is no {program}: build it (cargo build --release), or name it in KICKDRIFT")
        path = f"{program.parent}{os.pathsep}{os.environ['PATH']}"
        shown = []
        commands = re.findall(r"^\$ ((?:.*\\\n)*.*)$", body, re.MULTILINE)
        for position, command in enumerate(commands):
            done = subprocess.run(
                ["bash", "-c", command],
                env={**os.environ, "PATH": path, "COLUMNS": "200"},
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                # The slowest block takes 20 s on two idle cores; this leaves room for a busy machine.
                timeout=300,
            )
            wanted = code if position == len(commands) - 1 else 0
            if done.returncode != wanted:
                raise PluginError(f"{self.page}: {command}\nended with {done.returncode}, not {wanted}:\n{done.stdout}")
            lines = done.stdout.rstrip().splitlines()
            shown += [f"$ {folded(command)}", *lines[:cut], *(["..."] if len(lines) > cut else []), ""]
        return f"``` {kind}\n" + "\n".join(shown).rstrip() + "\n```"

    def notebook(self, path, last):
        """A notebook written as Python: cells begin at ``# %%``, and those of text are comments."""
        if "/" in self.page:
            raise PluginError(f"{self.page}: figures of notebooks are found from pages without a folder alone")
        if path not in notebooks:
            notebooks[path] = Session(f"notebook-{path.name}", self.folder).cells_of(path)
        return notebooks[path][-1].split("```\n\n", 1)[-1] if last else "\n\n".join(notebooks[path])

    def cells_of(self, path):
        text = []
        for cell in re.split(r"^# %%", path.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]:
            kind, _, body = cell.partition("\n")
            if "markdown" in kind:
                prose = re.sub(r"^# ?", "", body.strip(), flags=re.MULTILINE)
                text.append(re.sub(r"^# ", "## ", prose, flags=re.MULTILINE))
            else:
                text.append(self.python(body.strip() + "\n"))
        return text

    def python(self, body):
        code = f"```python\n{body}```"
        if importlib.util.find_spec("kickdrift") is None:
            if os.environ.get("KICKDRIFT_DOCS") == "all":
                raise PluginError(f"{self.page}: the Python package kickdrift is not installed")
            return f"{code}\n\n<small>Not run when this page was built: the Python package was not installed there.</small>"
        import matplotlib

        matplotlib.use("svg")
        import matplotlib.pyplot as plt

        tree = ast.parse(body)
        last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
        printed, value = io.StringIO(), None
        try:
            with contextlib.redirect_stdout(printed), plt.rc_context(STYLE):
                exec(compile(tree, self.page, "exec"), self.names)
                if last is not None:
                    value = eval(compile(ast.Expression(last.value), self.page, "eval"), self.names)
        except Exception as error:
            raise PluginError(f"{self.page}: {type(error).__name__}: {error}\nin\n{body}") from error
        parts = [code]
        said = printed.getvalue()
        pictures = [plt.figure(number) for number in plt.get_fignums()]
        drawn = value is not None and type(value).__module__.startswith("matplotlib")
        if type(value).__name__ == "Explorer":
            parts.append("<small>In a notebook this cell is the page itself, as a widget.</small>")
        elif value is not None and not drawn and not hasattr(value, "_repr_html_"):
            said += repr(value)
        if said.strip():
            parts.append(f"```text\n{said.rstrip()}\n```")
        if hasattr(value, "_repr_html_") and not drawn:
            parts.append(f'<div class="result">{tidy(value._repr_html_())}</div>')
        for picture in pictures:
            self.cells += 1
            name = f"{Path(self.page).stem}-{self.cells}.svg"
            with plt.rc_context(STYLE):
                picture.savefig(self.folder / "out" / name, metadata={"Date": None})
            plt.close(picture)
            up = "../" * self.page.count("/")
            parts.append(f"![{html.escape(describe(picture))}]({up}made/{name})")
        return "\n\n".join(parts)


def folded(command, width=88):
    """A long command on several lines, broken before its flags."""
    lines = [[]]
    for part in re.split(r" (?=--|\| )", command):
        if lines[-1] and len(" ".join([*lines[-1], part])) > width:
            lines.append(["   "])
        lines[-1].append(part)
    return " \\\n".join(" ".join(line) for line in lines)


def describe(picture):
    """The words on a figure, for those who cannot see it."""
    words = []
    for axes in picture.axes:
        words += [axes.get_title(), axes.get_ylabel() and f"{axes.get_ylabel()} over {axes.get_xlabel()}"]
    return "; ".join(word for word in words if word) or "The figure that the cell draws"


def tidy(text):
    """HTML in one piece: Markdown ends a block at an empty line and takes indented lines for code."""
    return "".join(line.strip() + "\n" for line in text.splitlines() if line.strip())
