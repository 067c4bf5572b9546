"""Stands in for OpenSees where it is not installed: materials whose six strains each pull an elastic, perfectly plastic bar.

What the server does with trials, commits, sockets and clients is tried with it; the laws of OpenSees are tried in tests/external.
"""

STIFFNESS, YIELD_STRESS = 2e8, 2e5
points = {}


class Point:
    def __init__(self):
        self.strain, self.stress, self.plastic = [0.0] * 6, [0.0] * 6, [0.0] * 6

    def set_strain(self, *strain):
        self.strain = strain
        self.stress = [min(max(STIFFNESS * (e - p), -YIELD_STRESS), YIELD_STRESS) for e, p in zip(strain, self.plastic)]

    def commit(self):
        self.plastic = [e - s / STIFFNESS for e, s in zip(self.strain, self.stress)]


def version():
    return "stand-in"


def model(*_):
    pass


def wipe():
    points.clear()


def nDMaterial(kind, tag, *_):
    if kind != "Bars":
        raise ValueError(f"{kind} is unknown")
    points[tag] = Point()


def NDTest(what, tag, *numbers):
    if what == "SetStrain":
        return points[tag].set_strain(*numbers)
    if what == "CommitState":
        return points[tag].commit()
    if what == "GetStress":
        return points[tag].stress
    return [STIFFNESS * (row == column) for row in range(6) for column in range(6)]
