"""What the examples with beams share (Tuniki 2012, chapter 5): failure loads that the program finds, runs under one load, pictures, times."""
import csv
import json
import os
import re
import resource
import shutil

from reporting import breccia, failure_load, trials, work


def last(path):
    """The last row of a history, by the names of its columns without their units."""
    with open(path) as file:
        rows = list(csv.reader(file))
    return {name.split(" (")[0]: float(value) for name, value in zip(rows[0], rows[-1])}


def pictures_of(folder, name):
    """Files of a picture, in order of the times in their names, which no report knows: an end follows from the period that the program finds."""
    files = os.listdir(os.path.join(folder, "pictures"))
    drawn = [(float(found[1] or 0), file) for file in files if (found := re.fullmatch(re.escape(name) + r"(?:-([\d.]+)ms)?\.png", file))]
    return [os.path.join(folder, "pictures", file) for _, file in sorted(drawn)]


class Beam:
    """A deck with a variable `load`; unit: that of the load in the deck; settings: other variables."""

    def __init__(self, deck, unit, **settings):
        self.deck, self.unit = deck, unit
        self.words = [word for key, value in settings.items() for word in ("--set", f"variables.{key}={value}")]
        self.folder = os.path.join(work.name, "-".join([deck, *(f"{key}-{value}" for key, value in settings.items())]).replace(" ", "").replace("/", "-"))

    def search(self, low, high, within=0.01):
        """The largest load that the beam bears and the smallest under which it fails."""
        self.bears, self.fails = failure_load(self.trials(low, high, within, 0, "-search"))
        return self.bears, self.fails

    def shares(self, low, high, bands, loads):
        """Rows (first and last load of a band, how many loads in it, under how many of them the beam fails). The bands divide
        the range between two loads, of which the beam must bear the first and fail under the second."""
        outcomes, rows = self.trials(low, high, 0.9, bands * loads, "-shares"), []
        for band in range(bands):
            first, last = (low + (high - low) * (band + k) / bands for k in (0, 1))
            inside = [outcome for load, outcome in outcomes.items() if first < load < last]
            rows.append((first, last, len(inside), sum(outcome != "bears it" for outcome in inside)))
        return rows

    def trials(self, low, high, within, samples, name):
        """{load: outcome} of the runs of `breccia failure`."""
        return trials(self.deck, *self.words, "--load", f"variables.load={low} {self.unit}:{high} {self.unit}", "--within", str(within),
                      "--samples", str(samples), output=self.folder + name)

    def run(self, load, pictures=()):
        """Runs it under a load and keeps pictures: (what the program calls them, the names here of all that it drew of this, in order of time)."""
        folder = os.path.join(self.folder, f"{load:g}")
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        breccia("run", self.deck, *self.words, "--set", f"variables.load={load} {self.unit}", "--quiet", "--output", folder)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return Result(folder, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, pictures)


class Result:
    """seconds: of a processor, with the period, the pictures and all files."""

    def __init__(self, folder, seconds, pictures):
        self.folder, self.seconds = folder, seconds
        with open(os.path.join(folder, "summary.json")) as file:
            self.summary = json.load(file)
        os.makedirs("pictures", exist_ok=True)
        for name, *here in pictures:
            for drawn, kept in zip(pictures_of(folder, name), here, strict=True):
                shutil.copy(drawn, f"pictures/{kept}.png")

    def verdict(self):
        return self.summary["rest"]["quasi-static"]

    def history(self, name):
        return last(os.path.join(self.folder, name + ".csv"))

    def bar(self):
        return self.summary["bars"][0]

    def bar_stresses(self):
        """(place along the x axis [in], stress [ksi]) of all elements."""
        with open(os.path.join(self.folder, "bars", "bars.csv")) as file:
            rows = list(csv.reader(file))
        names = [name.split(" (")[0] for name in rows[0]]
        return [(float(row[names.index("x")]), float(row[names.index("stress")]) / 1e3) for row in rows[1:]]
