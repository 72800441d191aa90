"""Plots of a few points for LaTeX: axes and marks as paths of PDF in a picture environment, words in the document's own font."""

from math import ceil, floor, log10

BP = 72 / 25.4  # of a millimetre
BLUE, ORANGE, GREY = "0.14 0.23 0.46", "0.82 0.36 0.05", "0.55 0.55 0.55"


class Plot:
    """Axes of a given size in mm; x and y are (lowest, highest, logarithmic)."""

    def __init__(self, width, height, x, y):
        self.size, self.ranges, self.items = (width, height), (x, y), []

    def place(self, x, y):
        """In mm from the lower left corner of the axes."""
        def share(value, lowest, highest, logarithmic):
            f = log10 if logarithmic else float
            return (f(value) - f(lowest)) / (f(highest) - f(lowest))
        return tuple(share(value, *span) * size for value, span, size in zip((x, y), self.ranges, self.size, strict=True))

    def path(self, points, colour="0 0 0", width=0.5, dash="", close="S"):
        """A line through points in mm."""
        steps = " ".join(f"{a * BP:.2f} {b * BP:.2f} {'l' if i else 'm'}" for i, (a, b) in enumerate(points))
        self.items.append(rf"\put(0,0){{\pdfliteral{{q {width} w {colour} RG {colour} rg [{dash}] 0 d {steps} {close} Q}}}}")

    def words(self, a, b, text, anchor=""):
        self.items.append(rf"\put({a:.2f},{b:.2f}){{\makebox(0,0)[{anchor}]{{{text}}}}}")

    def mark(self, a, b, colour, shape):
        """A square, a diamond or a triangle, full or not."""
        r = 0.75
        corners = {"square": [(-r, -r), (r, -r), (r, r), (-r, r)], "diamond": [(0, -1.4 * r), (1.4 * r, 0), (0, 1.4 * r), (-1.4 * r, 0)],
                   "triangle": [(-1.2 * r, -r), (1.2 * r, -r), (0, 1.2 * r)]}[shape.removeprefix("open ")]
        self.path([(a + i, b + j) for i, j in corners], colour, 0.6, close="s" if shape.startswith("open") else "b")

    def series(self, points, colour, shape, name, at, anchor="l", line=True):
        """Points of the data, joined or not, and the series' name at a place of the data."""
        places = [self.place(*point) for point in points]
        if line:
            self.path(places, colour, 0.7)
        for place in places:
            self.mark(*place, colour, shape)
        self.words(*self.place(*at), name, anchor)

    def axis(self, which, ticks, labels, title):
        """Ticks at values, with labels, and a title."""
        width, height = self.size
        for value, label in zip(ticks, labels, strict=True):
            if which == "x":
                a, _ = self.place(value, self.ranges[1][0])
                self.path([(a, 0), (a, 1)])
                self.words(a, -1.5, label, "t")
            else:
                _, b = self.place(self.ranges[0][0], value)
                self.path([(0, b), (1, b)])
                self.words(-1.5, b, label, "r")
        if which == "x":
            self.words(width / 2, -8, title, "t")
        else:
            # Upright, above the axis: turned words are harder to read.
            self.words(0, height + 3, title, "l")

    def decades(self, which, title, every=1):
        """An axis of powers of ten."""
        lowest, highest, _ = self.ranges["xy".index(which)]
        powers = range(ceil(log10(lowest) - 1e-9), floor(log10(highest) + 1e-9) + 1, every)
        self.axis(which, [10.0**n for n in powers], [f"$10^{{{n}}}$" for n in powers], title)

    def latex(self, left=14, right=4, below=14, above=7):
        width, height = self.size
        self.path([(0, 0), (width, 0), (width, height), (0, height), (0, 0)])
        head = rf"\begin{{picture}}({width + left + right},{height + below + above})(-{left},-{below})"
        return "\n".join([r"{\footnotesize\setlength{\unitlength}{1mm}%", head, *self.items, r"\end{picture}}"]) + "\n"
