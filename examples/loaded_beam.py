"""What the reports of beams beside tests share: a deck is run, and gives the load over the deflection."""
import csv
import json
import os
import resource

from reporting import breccia, work


def columns(path):
    with open(path) as file:
        rows = list(csv.reader(file))
    return {name.split(" (")[0]: [float(row[k]) for row in rows[1:]] for k, name in enumerate(rows[0])}


class Model:
    """curve: (deflection [mm], load [kN]), means over a time, so that vibrations do not count as loads."""

    def __init__(self, deck, words, field, mean=1e-3, deformed=20):
        self.deck, self.words = deck, words
        folder = os.path.join(work.name, deck)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        breccia("run", deck + ".yaml", "--quiet", "--output", folder)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        jack, moved = columns(os.path.join(folder, "jack.csv")), columns(os.path.join(folder, "moved.csv"))
        self.curve, self.times, first = [], jack["time"], 0
        sums = [0, 0]
        for k, time in enumerate(self.times):
            sums = [sums[0] + moved["y"][k], sums[1] + jack["y"][k]]
            while self.times[first] < time - mean:
                sums = [sums[0] - moved["y"][first], sums[1] - jack["y"][first]]
                first += 1
            self.curve.append((-1e3 * sums[0] / (k - first + 1), -sums[1] / (k - first + 1)))
        peak = max(range(len(self.curve)), key=lambda k: self.curve[k][1])
        self.at, self.load = self.curve[peak]
        after_peak = next((k for k in range(peak, len(self.curve)) if self.curve[k][1] < 0.5 * self.load), len(self.curve) - 1)
        self.lost = self.curve[after_peak][0]  # deflection at which half of the load is gone, or the last one
        with open(os.path.join(folder, "summary.json")) as file:
            self.bar = json.load(file)["bars"][0]["stress_so_far"][1] / 1e3  # MPa
        breccia("plot", folder, "--field", field, "--deformed", str(deformed), "--time", f"{min(self.times[after_peak] + 2e-3, self.times[-1]):.6g}", "--size", "560",
                "--output", f"pictures/{deck}.png")

    def carried(self, deflection):
        """The load at a deflection."""
        return next((load for moved, load in self.curve if moved >= deflection), None)
