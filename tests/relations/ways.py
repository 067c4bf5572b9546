"""What a run tells in two ways must agree: sums over particles, works by hand, energies, stresses and what is made of them."""
import math

from quantities import turned_vector

DENSITY, THICKNESS = 2.0, 0.2


def check(outcome, deck, found):
    told = Told(outcome, deck, found)
    told.energies()
    told.families()
    told.means()
    told.peaks()
    for name in ("derived", "lagrange", "hooke", "mass", "work", "moments", "broken", "damped", "still", "water", "slides", "weighs", "first"):
        if name in deck["ways"]:
            getattr(told, name)()
    if "mass moved" in deck["ways"]:
        told.mass(spins=True)
    told.readings()
    told.value()


def length(v):
    return math.sqrt(sum(a * a for a in v))


def deviator(s, shear=1.0):
    mean = sum(s[:3]) / 3
    return math.sqrt(sum((a - mean) ** 2 for a in s[:3]) + 2 * sum((a / shear) ** 2 for a in s[3:]))


class Told:
    def __init__(self, outcome, deck, found):
        self.outcome, self.deck, self.found = outcome, deck, found
        self.fields, self.summary = found["fields"], found["summary"]
        self.points = self.fields["Points"].rows
        self.count = len(self.points)

    def near(self, a, b, tolerance, size, words):
        self.outcome.check(abs(a - b) <= tolerance * abs(size) + 1e-300, f"{self.deck['name']}: {words}: {a} is not {b}, of sizes like {size}")

    def last(self, name):
        return self.fields[name].rows[-self.count:]

    def number(self, name):
        return self.summary[name].rows[0][0]

    def series(self, file, name):
        return self.found[file].get(name) and self.found[file][name].rows

    def layers(self, end):
        """The particles of the selection left or right."""
        across = sorted({round(p[0], 9) for p in self.points})
        wanted = across[:2] if end == "left" else across[-2:]
        return [n for n, p in enumerate(self.points) if round(p[0], 9) in wanted]

    def volume(self):
        return 0.1 ** 2 * THICKNESS if self.deck["dimensions"] == 2 else 0.1 ** 3

    # ---- energies

    def energies(self):
        e = {key[7:]: self.number(key) for key in self.summary if key.startswith("energy/")}
        size = max(abs(v) for k, v in e.items() if k != "imbalance") or 1.0
        books = self.found["books.csv"]
        for key in ("kinetic", "internal", "stored", "dissipated", "external", "damping", "fracture", "shed", "friction", "imbalance"):
            self.near(books[key].rows[-1][0], e[key], 1e-8, size if key != "imbalance" else 1, f"{key} at the end in history and summary")
        self.near(books["broken bonds"].rows[-1][0], self.number("broken_bonds"), 0, 1, "broken bonds in history and summary")
        for row, whole in enumerate(books["internal"].rows):
            self.near(books["stored"].rows[row][0] + books["dissipated"].rows[row][0], whole[0], 0.3 if "pairwise" in self.deck["text"] else 0.02, size, f"stored and dissipated are not internal in row {row}")
        words = [(name, group.rows[0][0] * group.factor / 1e3) for name, group in self.found["words"].items()]
        begin = [name for name, _ in words].index(next(n for n, _ in words if "energy: external" in n))
        told = {}
        for name, value in words[begin:begin + 12]:
            told[name.split("(", 1)[1].strip(")").lstrip("=+- ").replace("numerical damping", "numerical").replace("shed in unstable jumps", "shed")] = value
        for key in ("kinetic", "stored", "dissipated", "fracture", "shed", "friction", "damping", "numerical"):
            if key in told:
                self.near(told[key], e[key], 0.006, max(abs(e[key]), 1e-6 * size), f"{key} in words and summary")
        start = told.get("kinetic at the start", 0) + told.get("stored at the start", 0)
        spent = e["kinetic"] + e["stored"] + e["dissipated"] + e["fracture"] + e["shed"] + e["friction"] + e["damping"] + e["numerical"] - e["between"]
        self.near(e["external"] + start, spent, 0.02 if "implicit" in self.deck["text"] or start else 6e-3 + 2 * abs(e["imbalance"]), size, "works and energies")

        loose = "initial stress" in self.deck["text"] or "support" in self.deck["text"] or "pairwise" in self.deck["text"] or "law " in self.deck["name"]
        most = 1e-5 if "broken" in self.deck["ways"] and "static" not in self.deck["text"] else 0.005
        if not loose:
            self.near(e["imbalance"], 0, most, 1, "imbalance")

    def families(self):
        """Bonds that are counted once are half of those of all particles."""
        group = {name.split("(", 1)[1]: group.rows[0][0] for name, group in self.found["words"].items()}
        mean = next((value for name, value in group.items() if name.startswith("per particle (mean")), None)
        if mean is not None and "rows of" not in self.deck["text"]:
            self.near(mean * self.number("particles") / 2, self.number("bonds"), 0.06 / mean, self.number("bonds"), "mean number of bonds of a particle")

    # ---- sums and means over particles

    def means(self):
        u = self.last("displacement")
        origin = self.fields["displacement"].rows[:self.count]
        total = self.series("total.csv", "vector")
        for k in range(3):
            mean = sum(r[k] for r in u) / self.count
            if "support" in self.deck["text"]:
                continue
            self.near(total[-1][k], mean, 1e-9, max(length(r) for r in u) or 1, f"mean displacement {'xyz'[k]}")
        del origin

    def readings(self):
        """The usual histories beside fields and positions."""
        if "moved.csv" not in self.found:
            return
        u, v, force = self.last("displacement"), self.last("velocity"), self.last("internal force")
        right = self.layers("right")
        sizes = [max(length(r) for r in rows) or 1 for rows in (u, v, force)]
        for k in range(3):
            self.near(self.series("moved.csv", "vector")[-1][k], sum(u[n][k] for n in right) / len(right), 1e-9, sizes[0], "mean displacement of a selection")
            self.near(self.series("fast.csv", "vector")[-1][k], sum(v[n][k] for n in right) / len(right), 1e-9, sizes[1], "mean velocity of a selection")
            if "unlike" not in self.deck["name"]:
                self.near(self.series("pulled.csv", "vector")[-1][k], sum(force[n][k] for n in right) * self.volume(), 1e-9, sizes[2] * self.volume() * len(right),
                          "force on a selection")
        damage = [self.last("damage")[n][0] for n in right]
        self.near(self.series("harmed.csv", "mean")[-1][0], sum(damage) / len(damage), 1e-9, 1, "mean damage")
        self.near(self.series("harmed.csv", "largest")[-1][0], max(damage), 1e-9, 1, "largest damage")
        plane = self.deck["dimensions"] == 2
        ends = [(0.35, 0.35) + ((0.0,) if plane else (0.05,)), (0.45, 0.45) + ((0.0,) if plane else (0.05,))]
        near = [min(range(self.count), key=lambda n: length([a - b for a, b in zip(self.points[n], end)])) for end in ends]
        if all(length([a - b for a, b in zip(self.points[n], end)]) < 1e-6 for n, end in zip(near, ends)):
            xi = [b - a for a, b in zip(self.points[near[0]], self.points[near[1]])]
            now = length([x + u[near[1]][k] - u[near[0]][k] for k, x in enumerate(xi)])
            if "displacements: zero" not in self.deck["text"]:
                self.near(self.series("gap.csv", "distance")[-1][0], now, 1e-10, 1, "distance of two particles")
                self.near(self.series("gap.csv", "opening")[-1][0], now - length(xi), 1e-10, 1, "opening between two particles")
                self.near(self.series("bond.csv", "stretch")[-1][0], now / length(xi) - 1, 1e-9, 1, "stretch of a bond")
        inside = ((0.3, 0.6), (0.3, 0.6), (-1, 1)) if plane else ((0.2, 0.5), (0.2, 0.5), (-0.1, 0.2))
        middle = [n for n, p in enumerate(self.points) if all(low < c < high for c, (low, high) in zip(p, inside))]
        if self.series("strained.csv", "strain"):
            for name in ("strain", "stress"):
                rows = [self.last(name)[n] for n in middle]
                size = max(abs(a) for r in rows for a in r) or 1
                told = self.series("strained.csv", name)[-1]
                for k in range(6):
                    self.near(told[k], sum(r[k] for r in rows) / len(rows), 1e-9, size, f"mean {name} {k}")
            strain, stress = self.series("strained.csv", "strain")[-1], self.series("strained.csv", "stress")[-1]
            self.near(self.series("strained.csv", "octahedral shear stress")[-1][0], deviator(stress) / math.sqrt(3), 1e-9, length(stress), "octahedral shear stress of means")
            self.near(self.series("strained.csv", "octahedral shear strain")[-1][0], 2 * deviator(strain, 2) / math.sqrt(3), 1e-9, length(strain), "octahedral shear strain of means")
            self.near(self.series("strained.csv", "mean stress")[-1][0], sum(stress[:3]) / 3, 1e-9, length(stress), "mean stress of means")

    def peaks(self):
        """The largest of the states written."""
        count = self.count
        rows = {name: self.fields[name].rows for name in ("displacement", "velocity", "octahedral shear stress", "mean stress", "damage")}
        if "support" in self.deck["text"]:
            return
        for key, value in (("displacement", max(length(r) for r in rows["displacement"])), ("velocity", max(length(r) for r in rows["velocity"])),
                           ("octahedral_shear_stress", max(r[0] for r in rows["octahedral shear stress"])), ("mean_stress_lowest", min(r[0] for r in rows["mean stress"])),
                           ("mean_stress_highest", max(r[0] for r in rows["mean stress"])), ("damage", max(r[0] for r in rows["damage"]))):
            if "displacements: zero" in self.deck["text"] and key == "displacement":
                continue
            self.near(self.number("peaks/peak " + key), value, 1e-8, max(abs(value), 1e-9), f"peak {key} of states")
        del count

    # ---- stresses and strains

    def derived(self):
        """What is made of stress and strain."""
        size = max(abs(a) for r in self.fields["stress"].rows for a in r)
        for n, stress in enumerate(self.last("stress")):
            s = deviator(stress)
            for name, value in (("octahedral shear stress", s / math.sqrt(3)), ("von Mises stress", s * math.sqrt(1.5)), ("deviator norm", s), ("mean stress", sum(stress[:3]) / 3)):
                self.near(self.last(name)[n][0], value, 1e-9, size, f"{name} of particle {n}")
            e = self.last("strain")[n]
            self.near(self.last("octahedral shear strain")[n][0], 2 * deviator(e, 2) / math.sqrt(3), 1e-9, 1e-3 + length(e), f"octahedral shear strain of particle {n}")

    def lagrange(self):
        """Green-Lagrange strain of the deformation gradient, and the stress of Hooke's law of it."""
        self.hooke()
        for n, f in enumerate(self.last("deformation gradient")):
            e = [[(sum(f[3 * k + i] * f[3 * k + j] for k in range(3)) - (i == j)) / 2 for j in range(3)] for i in range(3)]
            expected = [e[0][0], e[1][1], e[2][2], 2 * e[0][1], 2 * e[1][2], 2 * e[2][0]]
            for k in range(6):
                if k == 2 and "plane stress" in self.deck["text"]:
                    continue
                self.near(self.last("strain")[n][k], expected[k], 1e-9, 0.01, f"strain {k} of particle {n} from its deformation gradient")

    def hooke(self):
        young, nu = 1e4, 0.2
        shear = young / (2 * (1 + nu))
        lame = 2 * shear * nu / (1 - 2 * nu)
        for n, e in enumerate(self.last("strain")):
            volume = sum(e[:3])
            for k in range(6):
                stress = 2 * shear * e[k] + lame * volume if k < 3 else shear * e[k]
                self.near(self.last("stress")[n][k], stress, 1e-9, young * 0.01, f"stress {k} of particle {n} by Hooke's law")

    # ---- motion

    def mass(self, spins=False):
        """Kinetic energy of the velocities."""
        kinetic = sum(DENSITY * self.volume() * length(v) ** 2 / 2 for v in self.last("velocity"))
        if spins:
            radius = 0.1 ** 2 / 6  # of gyration, squared, of a cell of a square or cubic lattice
            kinetic += sum(DENSITY * self.volume() * radius * length(w) ** 2 / 2 for w in self.last("angular velocity"))
        self.near(self.number("energy/kinetic"), kinetic, 1e-4 if spins else 1e-8, kinetic or 1, "kinetic energy of all velocities")

    def steps(self):
        return [r[0] for r in self.found["books.csv"]["time"].rows]

    def work(self):
        """What loads have done, by the trapezium rule over what supports exert; these hold their particles as one."""
        done = 0.0
        right = [[0.0] * 3] + [[a - b for a, b in zip(now, before)] for before, now in zip(self.series("moved.csv", "vector"), self.series("moved.csv", "vector")[1:])] \
            if "moved.csv" in self.found else None
        reaction = self.series("pull.csv", "vector") if "pull.csv" in self.found else None
        if right is None or reaction is None:
            return
        for n in range(2, len(right)):  # what is prescribed jumps to its acceleration in the first step
            done += sum((a + b) / 2 * d for a, b, d in zip(reaction[n - 1], reaction[n], right[n]))
        told = [r[0] for r in self.found["books.csv"]["external"].rows]
        size = max(abs(v) for v in told)
        text = self.deck["text"]  # beside damping, which is booked with what holds a motion, the two are the same sum
        rough = 0.25 if "damping" in text or "scheme" in text or "gamma" in text else 1e-5
        self.near(told[-1] - told[1], done, rough, size, "work of what pulls")

    def moments(self):
        """What supports exert about the origin, from each of them about its middle."""
        force, moment = [0.0] * 3, [0.0] * 3
        for file, end in (("grip.csv", "left"), ("pull.csv", "right")):
            if file not in self.found:
                if "load " not in self.deck["name"] or any(w in self.deck["text"] for w in ("along:", "it, on: right, acceleration")):
                    return
                continue
            where = self.layers(end)
            u = self.last("displacement")
            middle = [sum(self.points[n][k] + u[n][k] for n in where) / len(where) for k in range(3)]
            f, m = self.series(file, "vector")[-1], self.series(file, "moment")[-1]
            force = [a + b for a, b in zip(force, f)]
            moment = [a + b + middle[(k + 1) % 3] * f[(k + 2) % 3] - middle[(k + 2) % 3] * f[(k + 1) % 3] for k, (a, b) in enumerate(zip(moment, m))]
        told, turning = self.summary["equilibrium/reactions"].rows[0], self.summary["equilibrium/moment of reactions"].rows[0]
        for k in range(3):
            self.near(told[k], force[k], 1e-8, length(told) or 1, "force of all supports")
            self.near(turning[k], moment[k], 1e-8, length(told) + length(turning), "moment of all supports")
        if "static" in self.deck["text"]:
            loads = self.summary["equilibrium/loads"].rows[0]
            for k in range(3):
                self.near(told[k] + loads[k], 0, 1e-7, length(self.series("grip.csv", "vector")[-1]), "reactions and loads at rest")

    def still(self):
        """Ground at rest does not move."""
        self.near(self.number("peaks/peak displacement"), 0, 1e-4, 1, "displacement of ground at rest")

    def water(self):
        """The force of water on a face: unit weight times depth, over particles 0.1 m high."""
        force = sum(10 * (0.65 - 0.25 - 0.1 * n) * 0.1 * THICKNESS for n in range(4))
        loads = self.summary["equilibrium/loads"].rows[0]
        self.near(loads[0], -force, 1e-6, force, "force of water")

    def slides(self):
        """What slides all the time has been given momentum along the faces by Coulomb's share of that across."""
        across, along, _ = self.series("second.csv", "vector")[-1]
        self.near(along / across, 0.3, 0.05, 0.3, "momentum by friction over that by pressure")

    def weighs(self):
        """The support of a body at rest bears all of its weight, also that of what is held."""
        weight = [-DENSITY * self.volume() * self.count * g for g in (1.0, -9.81, 0.0)]
        told = self.series("grip.csv", "vector")[-1]
        for k in range(3):
            self.near(told[k], weight[k], 1e-7, 10, "weight on the support")

    def first(self):
        """When the first bond breaks in a body that is stretched evenly."""
        self.near(self.number("first_broken_bond/time"), self.deck["value"], 1, 6e-5, "time at which the first bond breaks")

    def value(self):
        if callable(self.deck["value"]):
            for row, (t,) in enumerate(self.found["value.csv"]["time"].rows):
                self.near(self.found["value.csv"]["factor"].rows[row][0], self.deck["value"](t), 1e-7, 1, f"factor of the load at {t}")

    def broken(self):
        self.outcome.check(self.number("broken_bonds") > 0 and self.number("energy/fracture") > 0, f"{self.deck['name']}: nothing broke")
        held = self.last("damage")
        self.outcome.check(max(r[0] for r in held) > 0, f"{self.deck['name']}: nothing is damaged")

    def damped(self):
        """What mass damping takes: rate times twice the kinetic energy."""
        rate = 40.0 if "damping: 40" in self.deck["text"] else 4 * math.pi * 0.2 * 30
        held = DENSITY * self.volume() * len(self.layers("right")) / 2
        time = self.steps()
        kinetic = [r[0] - held * length(v) ** 2 for r, v in zip(self.found["books.csv"]["kinetic"].rows, self.series("fast.csv", "vector"))]
        taken = sum(rate * (a + b) * (t - s) for a, b, s, t in zip(kinetic, kinetic[1:], time, time[1:]))
        self.near(self.number("energy/damping"), taken, 0.02, taken, "what damping by mass takes")


__all__ = ["check", "turned_vector"]
