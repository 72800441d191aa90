"""An atlas that any web host can serve, or a person open from a folder: the page of `kickdrift explore` in one file, without a program.

    python3 docs/atlas.py target/release/kickdrift atlas.html

The program serves its page once; the page itself, its letters, tiles of Figure 1's window and every tongue with
p + q <= 60 in it are written into the file, and `atlas.js` answers in the server's place. Only Python's own library is needed.
"""

import base64
import json
import math
import re
import struct
import subprocess
import sys
import urllib.error
import urllib.parse
import urllib.request
import zlib
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from pathlib import Path

PLANE = {"lambda1": "pi^2", "lambda2": "pi^2/25"}
SUM = 60
SIZE = 256
#: Levels of tiles for each stretch of h2 against h1: at level l the cells are 2^-l steps apart.
LEVELS = {2: range(-3, 3), 3: range(-3, 3)}
#: The page's coarsest level, from which the server counts.
COARSEST = -10
STEP = Fraction(1, 1000)
#: What the first view may show above the window.
ABOVE = 1.2


def main(program, target):
    server = subprocess.Popen([program, "explore", "--no-open"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        address = next(found[0] for line in server.stdout if (found := re.search(r"http://127\.0\.0\.1:\d+/\w+/", line)))
        Path(target).write_text(page(program, lambda path, **query: get(address, path, query)), encoding="utf-8")
    finally:
        # Not an interrupt, which a job in the background inherits as ignored.
        server.terminate()
        server.wait()


def get(address, path, query):
    with urllib.request.urlopen(f"{address}{path}?{urllib.parse.urlencode(query)}" if query else address + path) as reply:
        return reply.read()


def page(program, ask):
    text = {name: ask(name).decode() for name in ("", "page.css", "page.js")}
    begun = json.loads(re.search(r'id="begun">(.*?)</script>', text[""])[1])
    tiles, names = tiled(ask, begun["window"])
    edges, labels = tongues(program)
    held = {
        "tiles": names, "bytes": len(tiles) // len(names), "finest": str(STEP / 2 ** max(LEVELS[3])),
        "deepest": max(LEVELS[3]) - COARSEST, "stretched": [str(STEP * 2 ** (8 - COARSEST) * 2**stretch) for stretch in LEVELS],
        "tongues": len(edges) // 16, "sum": SUM, "lambda1": begun["values"]["lambda1"],
    }
    style = re.sub(
        r'url\("(fonts/[^"]+)"\)', lambda face: f'url("data:font/otf;base64,{base64.b64encode(ask(face[1])).decode()}")', text["page.css"]
    )
    head, rest = text[""].split("<link", 1)
    body = rest[rest.index('<script type="application/json" id="begun">') :]
    parts = [
        re.sub("<title>.*?</title>", "<title>kickdrift: an atlas</title>", head),
        f"<style>{style}</style>",
        f'<script type="application/json" id="held">{json.dumps(held)}</script>',
        f'<script type="text/plain" id="tiles">{packed(tiles)}</script>',
        f'<script type="text/plain" id="tongues">{packed(edges + labels)}</script>',
        body.replace("</body>", f"<script>{(Path(__file__).parent / 'atlas.js').read_text()}</script>"
                                f'<script type="module">{text["page.js"]}</script></body>'),
    ]
    return "\n".join(re.sub(r"<script type=\"module\" src.*?</script>", "", part) for part in parts)


def packed(data):
    return base64.b64encode(zlib.compress(data, 9)).decode()


def tiled(ask, window):
    """All tiles of the window in one piece, and the place of each by its question."""
    questions = []
    for stretch, levels in LEVELS.items():
        unit = STEP * 2 ** (8 - COARSEST)
        for level in levels:
            wide = float(STEP) * SIZE / 2**level
            high = ABOVE * window[3] if level <= 0 else window[3]
            for x in range(math.ceil(window[1] / wide)):
                for y in range(math.ceil(high / (wide * 2**stretch))):
                    unit2 = unit * 2**stretch
                    questions.append((str(unit), str(unit2), level - COARSEST, x, y))

    def asked(question):
        unit, unit2, level, x, y = question
        query = PLANE | {"what": "verdict", "size": SIZE, "unit": unit, "unit2": unit2, "level": level, "x": x, "y": y}
        try:
            return ask("tile", **query)
        except urllib.error.HTTPError:
            return None

    with ThreadPoolExecutor(4) as pool:
        found = [(q, data) for q, data in zip(questions, pool.map(asked, questions)) if data is not None]
    names = {f"verdict {unit2} {level} {x} {y}": k for k, ((_, unit2, level, x, y), _) in enumerate(found)}
    return b"".join(data for _, data in found), names


def tongues(program):
    """Every tongue in the window: its edges in h1 as doubles, its labels as integers of two bytes."""
    command = [program, "tongues", "--max-sum", str(SUM), "--h1-range", "0..2/pi", "--h2-range", "0..7/2", "--format", "json", "--quiet"]
    for name, value in PLANE.items():
        command += [f"--{name}", value]
    rows = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)["tongues"]
    middle = lambda edge: (edge["h1"]["lo"] + edge["h1"]["hi"]) / 2 if edge else math.inf
    edges = b"".join(struct.pack("<2d", middle(row["lower"]), middle(row["upper"])) for row in rows)
    labels = b"".join(struct.pack("<5h", *(row[key] for key in "pqmab")) for row in rows)
    return edges, labels


if __name__ == "__main__":
    main(*sys.argv[1:])
