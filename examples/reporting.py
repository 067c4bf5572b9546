"""What the reports of examples with closed forms share: they run decks at several spacings and read stresses at chosen points."""
import csv
import json
import os
import subprocess
import tempfile

work = tempfile.TemporaryDirectory()


class Run:
    """A deck run with watches of displacement and stress at points; without pictures."""

    def __init__(self, deck, settings=(), points=(), edits=(), results=0):
        """points: (x, y) in the deck's units; edits: (old, new) texts of the deck."""
        text = open(deck).read().split("\npictures:")[0] + "\npictures: []\n"
        for old, new in edits:
            assert old in text, old
            text = text.replace(old, new)
        watches = "".join(f"  u{n}: {{displacement of: {{nearest: [{x:.9g}, {y:.9g}]}}, every: 1}}\n"
                          f"  s{n}: {{stress and strain of: {{nearest: [{x:.9g}, {y:.9g}]}}, every: 1}}\n"
                          for n, (x, y) in enumerate(points))
        text = text.replace("watch:\n", "watch:\n" + watches).replace("results: {number: 1}", f"results: {{number: {results}}}")
        self.folder = tempfile.mkdtemp(dir=work.name)
        self.points = points
        changed = os.path.join(self.folder, "deck.yaml")
        with open(changed, "w") as file:
            file.write(text)
        self.results = os.path.join(self.folder, "results")
        done = breccia("run", changed, "--quiet", "--output", self.results, *(a for s in settings for a in ("--set", s)), check=False)
        self.said = done.stderr
        self.summary = json.load(open(os.path.join(self.results, "summary.json")))

    def column(self, watch, column):
        """All values of a column, by its name without the unit."""
        with open(os.path.join(self.results, watch + ".csv")) as file:
            rows = list(csv.reader(file))
        place = [name.split(" (")[0] for name in rows[0]].index(column)
        return [float(row[place]) for row in rows[1:]]

    def last(self, watch, column):
        return self.column(watch, column)[-1]

    def stress(self, component):
        """At the points."""
        return [self.last(f"s{n}", "stress " + component) for n in range(len(self.points))]

    def displacement(self, axis):
        return [self.last(f"u{n}", axis) for n in range(len(self.points))]


def breccia(*words, check=True):
    program = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../build/release/breccia")
    return subprocess.run([program, *words], check=check, capture_output=True, text=True)


def trials(*words, output):
    """Runs `breccia failure` with these words. @return {load in the unit of the words: outcome}"""
    breccia("failure", *words, "--output", output)
    with open(os.path.join(output, "failure.csv")) as file:
        rows = list(csv.reader(file))
    load, outcome = [name.split(" (")[0] for name in rows[0]].index("load"), rows[0].index("outcome")
    return {float(row[load]): row[outcome] for row in rows[1:]}


def failure_load(outcomes):
    """The largest load that a body bears and the smallest under which it fails, of {load: outcome}."""
    fails = min(load for load, outcome in outcomes.items() if outcome != "bears it")
    return max(load for load, outcome in outcomes.items() if outcome == "bears it" and load < fails), fails


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def compared(rows):
    """A table of rows (what, the thesis or test, a hand calculation, computed, accepted). 'accepted', a range like 2.2 to 3.0 or words, is what all
    numbers or the words under 'computed' must keep to, or empty; scripts/examples.py marks what does not."""
    return table(["", "published", "by hand", "computed", "accepted"], rows)


def between(mark, text, page="README.md"):
    """Puts a text between the marks of a page."""
    old = open(page).read()
    begin, end = f"<!-- {mark} -->\n", f"<!-- end of {mark} -->"
    new = old[:old.index(begin) + len(begin)] + "\n" + text + "\n\n" + old[old.index(end):]
    with open(page, "w") as file:
        file.write(new)


def chart(name, title, x, y, curves, more="", besides=()):
    """A picture of curves (label, style of gnuplot, [(x, y), ...]) in pictures/; more: further commands of gnuplot; besides: what else it is to plot."""
    script = f"""set terminal pngcairo size 800,520 font "sans,12"
set output "pictures/{name}.png"
set title "{title}"
set xlabel "{x}"
set ylabel "{y}"
set key outside below Left reverse maxcols 2 samplen 2.5
set grid lc rgb "#dddddd" lw 1 lt 1
set border lc rgb "#333333"
{more}
plot {", ".join([f"'-' {style} title '{label}'" for label, style, _ in curves] + list(besides))}
"""
    for _, _, values in curves:
        script += "".join(f"{a} {b}\n" for a, b in values) + "e\n"
    subprocess.run(["gnuplot"], input=script, text=True, check=True)


LINE = "with lines lw 1.5 lc rgb '#555555'"
STYLES = ["with linespoints pt 7 ps 0.5 lw 1.5 lc rgb '#c8501e'", "with linespoints pt 5 ps 0.5 lw 1.5 lc rgb '#21918c'",
          "with linespoints pt 9 ps 0.5 lw 1.5 lc rgb '#3b3f87'", "with linespoints pt 11 ps 0.5 lw 1.5 lc rgb '#8a6d00'"]


def picture(run, field, name, *words):
    breccia("plot", run.results, "--field", field, "--output", f"pictures/{name}.png", *words)
    assert os.path.getsize(f"pictures/{name}.png") < 150000, f"{name}.png is larger than 150 kB"
