"""Stands in for OpenSees where it is not installed: materials whose six strains each pull an elastic, perfectly plastic bar.

As in OpenSees, a PressureIndependMultiYield is elastic until its stage is 1, and all ManzariDafalias have one stage, which is plastic at first.

What the server does with trials, commits, sockets and clients is tried with it; the laws of OpenSees are tried in tests/external.
"""

STIFFNESS, YIELD_STRESS = 2e8, 2e5
points = {}
STAGED = {"PressureIndependMultiYield": 1, "PressureDependMultiYield03": 1, "ManzariDafalias": 5}  # parameter of the stage
class_stage = {"ManzariDafalias": 1}


class Point:
    def __init__(self, kind):
        self.kind, self.stage = kind, 0 if kind in STAGED else 1
        self.strain, self.stress, self.plastic = [0.0] * 6, [0.0] * 6, [0.0] * 6

    def set_strain(self, *strain):
        self.strain = strain
        plastic = class_stage.get(self.kind, self.stage)
        self.stress = [STIFFNESS * e for e in strain] if not plastic else [min(max(STIFFNESS * (e - p), -YIELD_STRESS), YIELD_STRESS) for e, p in zip(strain, self.plastic)]

    def commit(self):
        self.plastic = [e - s / STIFFNESS for e, s in zip(self.strain, self.stress)]


def version():
    return "stand-in"


def model(*_):
    pass


def wipe():
    points.clear()


def nDMaterial(kind, tag, *_):
    if kind == "InitStrain":
        points[tag] = Point(points[_[0]].kind)
    elif kind == "Bars" or kind in STAGED:
        points[tag] = Point(kind)
    else:
        raise ValueError(f"{kind} is unknown")


def set_stage(point, number, stage):
    if number != STAGED[point.kind]:
        raise ValueError(f"{point.kind} has no parameter {number}")
    if point.kind in class_stage:
        class_stage[point.kind] = stage
    else:
        point.stage = stage


def NDTest(what, tag, *numbers):
    if what in ("UpdateIntegerParameter", "UpdateDoubleParameter"):
        return set_stage(points[tag], *numbers)
    if what == "SetStrain":
        return points[tag].set_strain(*numbers)
    if what == "CommitState":
        return points[tag].commit()
    if what == "GetStress":
        return points[tag].stress
    return [STIFFNESS * (row == column) for row in range(6) for column in range(6)]
