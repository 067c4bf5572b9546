"""Small decks that combine all keys of the deck language at random, and calls of the verbs material, plot, spectrum,
calibrate and modes.

A deck is a dictionary of its keys. Each choice is a hash of the number of the deck and the name of the choice, so that
a new key or level changes only the decks that take it."""

import hashlib

SPACES = ("plane strain", "plane stress", "3-D", "1-D")
GREEN, SMALL = "green-lagrange", "small"

# Constitutive models: parameters of all decks, parameters of which each deck takes some, and formulations.
ELASTIC = {"Young modulus": "1e4 kPa", "Poisson ratio": 0.2}
STIFF = {"Young modulus": "2e4 kPa", "Poisson ratio": 0.2}
BULK = {"bulk modulus": "9e3 kPa", "shear modulus": "6e3 kPa"}
POINTS = ("correspondence", "hybrid")
FAMILIES = POINTS + ("ordinary",)
SOFTENS = {"Young modulus": "1e4 kPa", "tensile strength": "30 kPa", "fracture energy": "0.1 kN/m"}
HARDENS = {
    "hardening ratio": 0.05,
    "compression shift": 0.1,
    "compression range": 0.5,
    "tension shift": 0.2,
    "tension range": 0.5,
}
LAWS = {
    "elastic": (ELASTIC, {}, FAMILIES + ("micropolar",)),
    "j2": (
        dict(STIFF, **{"yield stress": "40 kPa"}),
        {
            "saturation stress": "60 kPa",
            "saturation rate": 30,
            "hardening modulus": "100 kPa",
            "kinematic modulus": "300 kPa",
        },
        FAMILIES,
    ),
    "viscoelastic": (dict(ELASTIC, **{"relaxing share": 0.6, "relaxation time": "2 ms"}), {}, FAMILIES),
    "multi-yield-j2": (
        dict(BULK, **{"octahedral strength": "20 kPa"}),
        {
            "peak octahedral strain": 0.02,
            "surfaces": 8,
            "friction angle": "25 deg",
            "reference pressure": "80 kPa",
            "pressure exponent": 0.5,
        },
        POINTS,
    ),
    "cap": (
        dict(
            STIFF,
            **{
                "envelope strength": "60 kPa",
                "cap ratio": 2,
                "cap position": "150 kPa",
                "largest compaction": 0.4,
                "compaction rate": "0.002 1/kPa",
                "tension cut-off": "30 kPa",
            },
        ),
        {"envelope drop": "20 kPa", "envelope rate": "0.01 1/kPa", "envelope slope": 0.1, "strict cap": 1},
        POINTS,
    ),
    "drucker-prager": (
        dict(STIFF, **{"cohesion": "20 kPa", "friction angle": "30 deg"}),
        {
            "dilation angle": "10 deg",
            "tension cut-off": "30 kPa",
            "hardening modulus": "500 kPa",
            "saturation gain": "10 kPa",
            "saturation rate": 50,
        },
        POINTS,
    ),
    "mohr-coulomb": (
        dict(STIFF, **{"cohesion": "20 kPa", "friction angle": "30 deg"}),
        {"dilation angle": "10 deg", "tensile strength": "15 kPa"},
        POINTS,
    ),
    "bounding-surface-clay": (
        dict(BULK, **{"undrained strength": "30 kPa", "hardening modulus": "6e3 kPa"}),
        {"hardening exponent": 1.3, "least hardening": "50 kPa", "implicit share": 0.7, "opensees steps": 1},
        POINTS,
    ),
    "damage-plasticity": (
        dict(
            STIFF, **{"tensile strength": "20 kPa", "compressive strength": "150 kPa", "fracture energy": "0.08 kN/m"}
        ),
        {
            "first yield": 0.4,
            "crushing energy": "5 kN/m",
            "biaxial ratio": 1.2,
            "meridian ratio": 0.7,
            "dilation angle": "25 deg",
            "eccentricity": 0.2,
            "tension damage": 0.6,
            "compression damage": 0.4,
            "length": "0.12 m",
            "initial fracture energy": "0.03 kN/m",
            "recovery by share": 1,
        },
        POINTS,
    ),
    "mazars": (
        dict(STIFF, **{"tensile strength": "20 kPa", "fracture energy": "0.08 kN/m"}),
        {"compression share": 1.1, "compression rate": 900, "length": "0.12 m"},
        POINTS,
    ),
    "link-damage": (
        dict(STIFF, **{"tensile stretch": 0.001}),
        {"compressive stretch": 0.002, "compressive ductility": 3, "stiffness recovery": 0.3},
        POINTS + ("micropolar",),
    ),
    "elastic-1d": ({"Young modulus": "1e4 kPa"}, {}, ("bond-based",)),
    "elastic-brittle": ({"Young modulus": "1e4 kPa"}, {}, ("bond-based",)),
    "bilinear-softening": (SOFTENS, {"length": "0.12 m"}, ("bond-based",)),
    "trilinear-softening": (SOFTENS, {"length": "0.12 m", "kink stress": 0.3, "kink place": 0.2}, ("bond-based",)),
    "exponential-softening": (SOFTENS, {"length": "0.12 m", "decay": 10, "tail": 0.4}, ("bond-based",)),
    "fib-concrete": (
        dict(SOFTENS, **{"compressive strength": "100 kPa", "peak strain": 0.02}),
        {"crushing energy": "2 kN/m", "decay": 10, "tail": 0.4, "dimensions": 1, "length": "0.12 m"},
        ("bond-based",),
    ),
    "kent-scott-park": (
        {"compressive strength": "10 kPa"},
        {"peak strain": 0.003, "residual strength": "2 kPa", "crushing strain": 0.008},
        ("bond-based",),
    ),
    "concrete02": (
        {"compressive strength": "10 kPa", "tensile strength": "3 kPa"},
        {
            "peak strain": 0.003,
            "residual strength": "2 kPa",
            "crushing strain": 0.008,
            "unloading ratio": 0.2,
            "tension softening": "500 kPa",
        },
        ("bond-based",),
    ),
    "mander": (
        {"compressive strength": "10 kPa", "Young modulus": "1e4 kPa"},
        {"peak strain": 0.003, "confining pressure": "1 kPa"},
        ("bond-based",),
    ),
    "elastic-perfectly-plastic": (
        {"Young modulus": "1e4 kPa", "yield stress": "30 kPa"},
        {"compressive yield stress": "20 kPa", "initial strain": 5e-4},
        ("bond-based",),
    ),
    "steel-bilinear": (
        {"Young modulus": "1e4 kPa", "yield stress": "30 kPa"},
        HARDENS,
        ("bond-based",),
    ),
    "menegotto-pinto": (
        {"Young modulus": "1e4 kPa", "yield stress": "30 kPa"},
        {
            **HARDENS,
            "roundness": 18,
            "roundness fall": 0.9,
            "roundness range": 0.2,
            "initial stress": "2 kPa",
        },
        ("bond-based",),
    ),
}
SPENDS = (
    {"tensile ductility": 5},
    {"fracture energy": "0.08 kN/m"},
    {"fracture energy": "0.08 kN/m", "length": "0.12 m"},
    {"fracture energy": "0.08 kN/m", "initial fracture energy": "0.03 kN/m"},
    {"fracture energy": "0.08 kN/m", "initial fracture energy": "0.03 kN/m", "kink stress": 0.4},
)
BRITTLE = (
    {"tensile strength": "60 kPa"},
    {"fracture energy": "0.01 kN/m"},
    {"fracture energy": "0.01 kN/m", "length": "0.12 m"},
)
LIMITS = {"smallest strain": -0.01, "largest strain": 0.012}  # of laws of one strain
HISTORIES = {
    "j2": "equivalent plastic strain",
    "multi-yield-j2": "active surface",
    "cap": "cap parameter",
    "drucker-prager": "equivalent plastic strain",
    "bounding-surface-clay": "distance to the bounding surface",
    "damage-plasticity": "material damage",
    "mazars": "equivalent strain",
    "link-damage": "tensile damage",
    "kent-scott-park": "largest compressive strain",
    "concrete02": "largest tensile strain",
    "mander": "largest compressive strain",
    "elastic-perfectly-plastic": "plastic strain",
    "steel-bilinear": "least strain",
    "menegotto-pinto": "largest strain",
    "fib-concrete": "bond damage",
}

PERIDYNAMICS = {
    "influence": ("constant", "conical", "inverse", "inverse-square", "gaussian", "quartic", "cubic-spline"),
    "volume correction": ("none", "partial", "partial-beyond"),
}
OF_FORMULATION = {
    "correspondence": {
        "strain": (GREEN, SMALL),
        "zero-energy control": (
            {"silling": 0.15},
            {"wan": 0.1},
            {"none": True},
            {"silling": 0.2, "fades": "never"},
            {"silling": 0.2, "fades": "softening"},
            {"wan": 0.2, "fades": "yielding"},
        ),
    },
    "bond-based": {
        "calibration": ("continuum", "uniform-expansion", "uniaxial"),
        "surface correction": ("none", "energy"),
        "strength of": ("body", "bonds"),
    },
    "ordinary": {"lattice weights": ("isotropic", "plain")},
    "hybrid": {"form": ("variational", "variational", "pairwise"), "strain": (GREEN, SMALL), "own bond": (0.8,)},
    "micropolar": {"kinematics": ("corotational", "thesis"), "torsion": (0.7,)},
}


class Choices:
    """Choices of one deck by its number."""

    def __init__(self, number):
        self.number = number

    def share(self, name):
        """Returns a number from 0 to 1 for a name."""
        digest = hashlib.sha256(f"{self.number} {name}".encode()).digest()
        return int.from_bytes(digest[:8], "big") / 2**64

    def holds(self, name, share):
        return self.share(name) < share

    def one(self, name, levels):
        """Returns one of several levels; a level that is added later is taken by few decks and changes no others."""
        named = {f"{name} {str(level)[:200]}": level for level in levels}
        return named[max(named, key=self.share)]

    def some(self, name, levels, share):
        """Returns some of the items of a dictionary, each with one of its levels where it has several."""
        return {
            key: self.one(f"{name}.{key}", values) if isinstance(values, tuple) else values
            for key, values in levels.items()
            if self.holds(f"{name}.{key}", share)
        }


class Deck:
    """A deck under construction; `text` is its dictionary."""

    def __init__(self, number):
        self.choose = Choices(number)
        choose = self.choose
        self.formulation = choose.one("formulation", OF_FORMULATION)
        self.law = choose.one("law", [law for law in LAWS if self.formulation in LAWS[law][2]])
        spaces = SPACES if self.formulation == "bond-based" else SPACES[:3]
        self.space = choose.one("space", spaces)
        self.fibres = "Poisson ratio" not in LAWS[self.law][0] and "bulk modulus" not in LAWS[self.law][0]
        solvers = list(SOLVERS)
        if self.fibres and self.law != "elastic-1d" and choose.holds("in motion", 0.8):
            solvers = ["explicit", "long explicit", "implicit", "quasi-static"]  # softening has no equilibrium
        self.solver = choose.one("solver", solvers)
        self.text = {"units": choose.one("units", ({"length": "m", "force": "kN", "time": "s"}, {"length": "cm"}))}
        for part in (
            "materials", "body", "selections", "peridynamics", "loads", "solve", "failure", "cracks", "contact", "bars",
            "initial_stress", "watch", "profiles", "results",
        ):  # fmt: skip
            getattr(self, part)()
        self.text["pictures"] = []

    # ---- places

    def flat(self):
        return self.space.startswith("plane")

    def point(self, x, y, z=0.05, unit="m"):
        parts = [x, y, z] if self.space == "3-D" else [x, y]
        return [f"{p:.10g} {unit}" for p in parts]

    def box(self, low, high):
        return {"box": {"from": self.point(*low), "to": self.point(*high)}}

    def vector(self, size, unit, other=0.4):
        """Returns a vector mostly along x."""
        if self.space == "1-D":
            return [f"{size:.6g} {unit}", 0]
        return self.point(size, other * size, -0.6 * size, unit)

    # ---- matter

    def materials(self):
        choose = self.choose
        always, optional, _ = LAWS[self.law]
        text = {"model": self.law, "density": "2 t/m3", **always, **choose.some("material", optional, 0.5)}
        if "cohesion" in text and self.law == "drucker-prager" and choose.holds("cone", 0.3):
            for key in ("cohesion", "friction angle", "dilation angle"):
                text.pop(key, None)
            text.update({"cone strength": "20 kPa", "cone slope": 0.2})
            text.update(choose.some("material", {"dilation slope": 0.1}, 0.5))
        if self.law == "multi-yield-j2" and choose.holds("cohesion", 0.3):
            del text["octahedral strength"]
            text["cohesion"] = "15 kPa"
        if self.law == "multi-yield-j2" and "octahedral strength" in text:
            text.pop("friction angle", None)
        if self.law == "link-damage":
            text.update(choose.one("spends", SPENDS))
        if self.law == "elastic-brittle":
            text.update(choose.one("brittle", BRITTLE))
        if self.law == "j2" and self.formulation == "ordinary":
            for key in ("saturation stress", "saturation rate", "hardening modulus", "kinematic modulus"):
                text.pop(key, None)
        if text.get("Young modulus") and "Poisson ratio" in text and choose.holds("moduli", 0.3):
            del text["Young modulus"], text["Poisson ratio"]
            text.update(BULK)
        if self.formulation == "bond-based":
            text.update(choose.some("material", LIMITS, 0.15))
        self.text["materials"] = {"m": text}
        self.two = self.space != "1-D" and choose.holds("two", 0.3)
        if self.two:
            line = self.formulation == "bond-based"
            second = {"model": "elastic-1d", "Young modulus": "3e4 kPa"} if line else {"model": "elastic", **STIFF}
            self.text["materials"]["n"] = {"density": "3 t/m3", **second}

    def body(self):
        choose = self.choose
        lattice = {"3-D": "cubic", "1-D": "line"}.get(self.space, "square")
        if choose.holds("lattice", 0.15) and lattice != "line":
            lattice = {"cubic": "face-centred cubic", "square": "hexagonal"}[lattice]
        self.two = self.two and lattice != "face-centred cubic"
        if not self.two:
            self.text["materials"].pop("n", None)
        common = {"lattice": lattice, "spacing": "0.1 m"}
        if self.flat():
            common["thickness"] = "0.2 m"
        if self.space == "1-D":
            common["area"] = "0.03 m2"
            shape = {"box": {"from": ["0.1 m", 0], "to": ["1.1 m", "0.1 m"]}}
            self.text["body"] = {"b": {"material": "m", **common, "shape": shape}}
            self.boxed = False
            return
        whole = [(0.1, 0.2, -0.1), (0.9 if self.flat() else 0.7, 0.7 if self.flat() else 0.5, 0.2)]
        if self.two:
            self.boxed = lattice in ("cubic", "square")
            low, high = (whole[0], (0.5, *whole[1][1:])), ((0.5, *whole[0][1:]), whole[1])
            self.text["body"] = {
                "b": {"material": "m", **common, "shape": self.box(*low)},
                "c": {"material": "n", **common, "shape": self.box(*high)},
            }
            return
        shapes = {
            "box": self.box(*whole),
            "numbers": {"box": {"particles": [8, 5] if self.flat() else [6, 3, 3]}},
            "without a hole": {"difference": [self.box(*whole), self.hole()]},
            "with an ear": {"union": [self.box(*whole), self.ear()]},
        }
        if self.flat():
            corners = [["0.1 m", "0.2 m"], ["0.9 m", "0.2 m"], ["0.9 m", "0.7 m"], ["0.3 m", "0.8 m"]]
            shapes["polygon"] = {"polygon": {"corners": corners}}
        else:
            corners = [["0.1 m", "0.2 m"], ["0.7 m", "0.2 m"], ["0.7 m", "0.7 m"]]
            shapes["polygon"] = {"polygon": {"corners": corners, "bottom": "-0.1 m", "top": "0.2 m"}}
            ends = {"from": self.point(0.1, 0.4, 0.05), "to": self.point(0.8, 0.4, 0.05)}
            shapes["cylinder"] = {"cylinder": {**ends, "radius": "0.22 m"}}
        shape = shapes["box"] if choose.holds("plain", 0.5) else choose.one("shape", shapes.values())
        if lattice == "face-centred cubic":
            shape = shapes["numbers"]
        self.boxed = "box" in shape and lattice in ("cubic", "square")
        if "particles" in shape.get("box", {}) and choose.holds("first particle", 0.7):
            shape["box"]["first particle"] = self.point(0.15, 0.25, -0.05)
        self.text["body"] = {"b": {"material": "m", **common, "shape": shape}}

    def hole(self):
        return {"sphere": {"centre": self.point(0.45, 0.45), "radius": "0.08 m"}}

    def ear(self):
        return self.box((0.3, 0.6, -0.1), (0.5, 0.9, 0.2))

    def selections(self):
        right = {"face": "x+"} if self.space == "1-D" else {"face": "x+", "layers": 2}
        left = dict(right, face="x-")
        if self.space == "1-D":
            self.text["selections"] = {
                "left": left, "right": right, "middle": {"nearest": ["0.55 m", 0]}, "corner": {"nearest": ["1 m", 0]},
                "top": {"nearest": ["0.75 m", 0]},
            }  # fmt: skip
            return
        choose = self.choose
        middle = {
            "inside": {"inside": self.box((0.3, 0.3, -0.1), (0.6, 0.5, 0.2))},
            "any": {"any of": [{"nearest": self.point(0.45, 0.35)}, {"nearest": self.point(0.55, 0.45)}]},
            "all": {"all of": [{"block": "b"}, {"inside": self.box((0.3, 0.3, -0.1), (0.6, 0.5, 0.2))}]},
            "except": {"all": True, "except": ["left", "right", {"face": "y-"}]},
        }
        self.text["selections"] = {
            "left": left, "right": right, "middle": choose.one("middle", middle.values()),
            "corner": {"nearest": self.point(0.65, 0.55, 0.15)}, "top": {"all of": [{"face": "y+", "layers": 1}, {"inside": self.box((0.3, 0, -0.1), (0.6, 1, 0.2))}]},
        }  # fmt: skip

    def peridynamics(self):
        choose = self.choose
        text = {"formulation": self.formulation, "space": self.space}
        text["horizon"] = choose.one(
            "horizon", ("2.015 spacings", "1.5 spacings", "0.3015 m")[: 2 if self.space == "3-D" else 3]
        )
        text.update(choose.some("peridynamics", PERIDYNAMICS, 0.3))
        text.update(choose.some("peridynamics", OF_FORMULATION[self.formulation], 0.4))
        if text.get("form") == "pairwise":
            text.pop("own bond", None)
        if self.space == "3-D":
            text.pop("kinematics", None)
        if self.two and choose.holds("region", 0.6):
            line = self.formulation == "bond-based"
            others = ("bond-based",) if line else ("correspondence", "ordinary", "hybrid", "micropolar")
            other = choose.one("other", others)
            options = choose.some("region", OF_FORMULATION[other], 0.4)
            if self.space == "3-D":
                options.pop("kinematics", None)
            if options.get("kinematics") == "thesis":
                options["kinematics"] = "corotational"
            if options.get("form") == "pairwise":
                options["form"] = "variational"
            text["regions"] = {"far": {"blocks": ["c"], "formulation": other, **options}}
        self.text["peridynamics"] = text

    # ---- loads

    def history(self, name):
        end = 1 if self.rests() else 0.004
        table = [[0, 0], [f"{end / 2} s", 1.2], [f"{end} s", 0.3]]
        sine = {"frequency": "90 Hz", **self.choose.some(name, SINE, 0.4)}
        if self.rests():
            sine = {"frequency": "0.3 Hz"}
        return self.choose.one(
            name,
            (
                {"constant": True},
                {"ramp to": f"{end / 2} s"},
                {"ramp to": f"{2 * end} s"},
                {"table": table},
                {"sine": sine},
                {"product": [{"ramp to": f"{end / 2} s"}, {"table": table}]},
                {"sum": [{"ramp to": f"{end} s"}, {"sine": sine}]},
                {"file": {"name": "record.csv", "column": "b", **self.choose.some(name + " file", FILE, 0.4)}},
                {"file": {"name": "record.csv", "column": "b", "times": "late", "scale": 0.5}},
            ),
        )

    def rests(self):
        return self.solver in ("static", "relaxation", "control", "static stages")

    def loads(self):
        choose, rests = self.choose, self.rests()
        shift = choose.one("sign", (0.004, 0.006, -0.004, -0.007))
        grips = {
            "held": {"displacement": self.vector(0, "m")},
            "roller": {"roller": self.vector(1, "", 0)},
            "springs": {"spring": {"stiffness": "3000 kN/m"}},
            "stays": {"velocity": self.vector(0, "m/s")},
        }
        if self.space != "1-D" and not rests:
            leaves = choose.some("dashpots", DASHPOTS, 0.5)
            grips["dashpots"] = {"dashpots": leaves}
            for key, (motion,) in OUTCROPS.items():
                moves = {"dashpots": dict(leaves, **{key: motion[: len(self.point(0, 0))]})}
                grips[key] = dict(moves, history=self.history("outcrop"))
        grip = choose.one("grip", grips.values()) if choose.holds("grips", 0.35) else grips["held"]
        on = {"face": "x-"} if "dashpots" in grip else "left"
        loads = [{"name": "grip", "on": on, **grip}]
        if "roller" in grip and self.space != "1-D":
            loads.append({"on": {"face": "y-"}, "roller": self.point(0, 1, 0, "")})
            if self.space == "3-D":
                loads.append({"on": {"face": "z-"}, "roller": self.point(0, 0, 1, "")})
        speed = shift * 500
        drives = {
            "displacement": {"displacement": self.vector(shift, "m")},
            "velocity": {"velocity": self.vector(speed if not rests else shift, "m/s")},
            "acceleration": {"acceleration": self.vector(speed * 400 if not rests else 2 * shift, "m/s2")},
            "force": {"force": self.vector(shift * 300, "kN")},
        }
        if self.space != "1-D":
            gains = {"displacement": f"{shift} m", "velocity": f"{speed if not rests else shift} m/s"}
            gains["acceleration"] = f"{speed * 400 if not rests else 2 * shift} m/s2"
            for key, value in gains.items():
                drives["along " + key] = {"along": {"direction": self.point(3, 1, -1, ""), key: value}}
            drives["platen"] = {"along": {"direction": self.point(1, 0, 0, ""), "displacement": f"{shift} m"},
                                "platen": choose.one("platen", ("turning", "fixed"))}  # fmt: skip
            drives["presses"] = {"along": {"direction": self.point(1, 0, 0, ""), "displacement": f"{shift} m"},
                                 "only presses": True, "on": {"face": "x+"}}  # fmt: skip
            formula = [f"{shift} * x / 0.9", f"{shift} * y", "free"][: len(self.point(0, 0))]
            drives["field"] = {"field": {"displacement": formula}}
            if not rests:
                drives["field of velocity"] = {
                    "field": {"velocity": [f + " / 0.01 s" if f != "free" else f for f in formula]}
                }
        drive = choose.one("drive", drives.values())
        self.load = {"name": "pull", "on": "right", **drive, "history": self.history("history")}
        if self.solver == "quasi-static" and choose.holds("own ramp", 0.7):
            del self.load["history"]
        if self.solver == "control":
            self.load = {"name": "pull", "on": "right", "force": self.vector(shift * 300, "kN", 0.1)}
            self.load["history"] = {"controlled": True}
        loads.append(self.load)
        extras = {name: load for name, load in self.extras(shift).items() if choose.holds(f"extra {name}", 0.09)}
        for name, load in extras.items():
            load = {"name": name, **load}
            if choose.holds(f"{name} history", 0.6) and set(load) & VARIES:
                load["history"] = self.history(name)
            loads.append(load)
        self.text["loads"] = loads
        self.reacts = bool({"displacement", "velocity"} & set(grip))

    def extras(self, shift):
        area = "0.1 m2" if self.flat() else "0.12 m2"
        found = {
            "body force": {"on": {"all": True}, "body force": self.vector(shift * 4000, "kN/m3")},
            "gravity": {"gravity": self.vector(shift * 2000, "m/s2", -2)},
            "swelling": {"initial strain": shift / 4, "on": "middle"},
        }
        if not self.rests():
            found["base"] = {"base acceleration": self.vector(shift * 5000, "m/s2")}
            found["start"] = {"on": "top", "initial velocity": {"translation": self.vector(50 * shift, "m/s")}}
        if self.space == "1-D":
            return found
        if not self.rests():
            spin = [0, 0, "2 rad/s"] if self.flat() else ["0.5 rad/s", "-1 rad/s", "2 rad/s"]
            found["spin"] = {"on": "top", "initial velocity": {"rotation": spin}}
            found["spin about"] = {
                "on": "top", "initial velocity": {"rotation": spin, "about": self.point(0.4, 0.3)}}  # fmt: skip
        found["push"] = {"on": "corner", "force": self.vector(-shift * 50, "kN", 2)}
        found["pressure"] = {"on": {"face": "y+"}, "pressure": f"{shift * 4000:.6g} kPa"}
        found["traction"] = {"on": {"face": "y+"}, "traction": self.vector(shift * 3000, "kPa", 1)}
        found["traction of layers"] = {
            "on": {"face": "y+", "layers": 2}, "spread": "layers", "traction": self.vector(shift * 3000, "kPa", 1)}  # fmt: skip
        if self.formulation in POINTS and not self.two and self.boxed:
            found["traction of bonds"] = {
                "on": {"face": "y+"}, "spread": "bonds", "traction": self.vector(shift * 3000, "kPa", 1)}  # fmt: skip
        found["traction of an area"] = {
            "on": "top", "area": area, "centre": self.point(0.5, 0.7), "traction": self.vector(shift * 3000, "kPa")}  # fmt: skip
        height = "0.5 m" if self.flat() else "0.15 m"
        weight = self.choose.some("water", {"unit weight": "30 kN/m3"}, 0.5)
        found["water"] = {"on": {"face": "x+"}, "water pressure": {"surface": height, **weight}}
        axis = {} if self.flat() else self.choose.some("radial", {"axis": [0, 0, 1]}, 0.5)
        found["radial"] = {"on": "top", "radial pressure": {
            "pressure": "5 kPa", "area": area, "centre": self.point(0.4, 0.3), **axis}}  # fmt: skip
        direction = self.choose.some("spring", {"direction": self.point(1, 2, 0.5, "")}, 0.5)
        found["spring"] = {"on": "top", "spring": {"stiffness": "2000 kN/m", **direction}}
        found["spring between"] = {"on": "top", "spring": {"stiffness": "2000 kN/m", "to": "middle", **direction}}
        found["tie"] = {
            "on": {"inside": self.box((0.4, 0.2, -0.1), (0.6, 0.4, 0.2))},
            "tie": self.choose.some("tie", {"directions": ("x", "y", "xy")}, 0.7),
        }
        found["tie to"] = {
            "on": {"nearest": self.point(0.55, 0.35)},
            "tie": {"to": {"nearest": self.point(0.35, 0.35)}, "directions": "x"},
        }
        held = self.choose.one("held", ("all", "across", "periodic"))
        layers = self.choose.some("support", {"layers": 2}, 0.5)
        found["support"] = {"on": {"block": "b", "face": "y-"}, "support": {"held": held, **layers}}
        if held != "periodic":
            found["support"]["support"].update(
                self.choose.some("support", {"displacement": self.point(0, shift, 0, "m")}, 0.4)
            )
        if not self.boxed:
            del found["support"]
        found["roller that presses"] = {"on": {"face": "y-"}, "roller": self.point(0, 1, 0, ""), "only presses": True}
        if self.formulation == "micropolar":
            moment = ["0.02 kN m"] if self.flat() else ["0.01 kN m", 0, "0.02 kN m"]
            found["moment"] = {"on": "top", "moment": [0, 0, moment[0]] if self.flat() else moment}
            found["rotation"] = {"on": "corner", "rotation": [0, 0, f"{shift:.6g} rad"]}
        if (
            self.law in ("mohr-coulomb", "drucker-prager", "bounding-surface-clay", "multi-yield-j2", "j2")
            and not self.two
        ):
            found["reduction"] = {"strength reduction": 1.4}
        return found

    # ---- solvers

    def solve(self):
        self.text["solve"] = SOLVERS[self.solver](self, self.choose)

    # ---- breaking, contact, bars

    def failure(self):
        choose = self.choose
        if (
            self.space == "1-D"
            or self.law not in ("elastic", "j2", "elastic-1d", "viscoelastic")
            or not choose.holds("failure", 0.7)
        ):
            return
        brittle = {"calibration": ("lattice", "continuum")}
        criteria = (
            {"critical stretch": 0.004},
            {"criterion": "critical stretch", "fracture energy": "0.01 kN/m", **choose.some("failure", brittle, 0.5)},
            {"criterion": "critical bond energy", "bond energy": "3 kN/m5"},
            {
                "criterion": "critical bond energy",
                "fracture energy": "5e-3 kN/m",
                **choose.some("failure", brittle, 0.5),
            },
            {"criterion": "critical bond stress", "bond tensile strength": "60 kPa"},
            {"criterion": "critical bond stress", "bond tensile strength": "90 kPa", "bond shear strength": "40 kPa"},
        )
        stretches = self.formulation in ("bond-based", "ordinary")
        criteria = [c for c in criteria if stretches or "fracture energy" not in c or "energy" in c["criterion"]]
        criteria = [
            c
            for c in criteria
            if "stress" not in c.get("criterion", "") or (self.formulation == "hybrid" and not self.fibres)
        ]
        text = choose.one("criterion", criteria)
        text["near grips"] = choose.one("near grips", ("break", "hold"))
        if "regions" not in self.text["peridynamics"]:
            text.update(choose.some("failure", {"failed laws": ("stop", "break")}, 0.3))
        spared = choose.some("spared", {"of": "right", "distance": "0.15 m"}, 0.7)
        text.update(choose.some("failure", {"no failure within": spared}, 0.3))
        self.text["failure"] = text

    def cracks(self):
        choose = self.choose
        self.cut = self.space != "1-D" and choose.holds("crack", 0.3)
        if not self.cut:
            return
        faces = choose.some("crack", {"cut faces": True}, 0.5)
        ways = [{"remove": self.box((0.4, 0.1, -0.2), (0.5, 0.4, 0.3)), **faces}]
        if self.flat():
            ways.append({"cut": {"line": [["0.4 m", "0.1 m"], ["0.4 m", "0.4 m"]]}})
        else:
            corners = [(0.4, 0.1, -0.2), (0.4, 0.4, -0.2), (0.4, 0.4, 0.3), (0.4, 0.1, 0.3)]
            ways.append({"cut": {"polygon": [self.point(*corner) for corner in corners]}})
            ways.append({"cut": {"line": [["0.4 m", "0.1 m"], ["0.4 m", "0.4 m"]]}})
        self.text["cracks"] = [choose.one("cut", ways)]

    def contact(self):
        if self.choose.holds("contact", 0.5 if self.cut else 0.05) and self.space != "1-D":
            for damping in ("stiffness damping", "Rayleigh damping"):
                if isinstance(self.text["solve"], dict):
                    self.text["solve"].get("explicit", {}).pop(damping, None)
            self.text["contact"] = self.choose.some("contact", {"stiffness": 0.7, "friction": 0.3}, 0.6)

    def bars(self):
        choose = self.choose
        if not self.boxed or not choose.holds("bars", 0.35):
            return
        steel = choose.one("steel", ({"model": "steel-bilinear", "yield stress": "4 MPa"}, {"model": "elastic-1d"}))
        self.text["materials"]["s"] = {"density": "7 t/m3", "Young modulus": "2e6 kPa", **steel}
        bonds = (
            {"law": "linear", "stiffness": "2e4 kN/m3"},
            {"compressive strength": "30 MPa", "rib spacing": "8 mm", **choose.some("bond", BOND, 0.4)},
            {
                "law": "fib",
                "compressive strength": "30 MPa",
                "rib spacing": "0.05 mm",
                **choose.some("bond", BOND, 0.4),
            },
            {
                "compressive strength": "30 MPa",
                "rib spacing": "0.05 mm",
                "splitting stress": "1 MPa",
                **choose.some("bond", {"confinement": ("none", "stirrups"), **BOND}, 0.6),
            },
        )
        bar = {"material": "s", "points": [self.point(0.15, 0.27), self.point(0.62, 0.41)]}
        bar.update(choose.one("section", ({"diameter": "0.02 m"}, {"area": "2e-4 m2"})))
        bar.update(choose.some("bar", {"number": 2}, 0.3))
        bar.update(choose.one("line", ({}, {}, {"snap": True}, {"bending": True}, {"snap": False, "bending": True})))
        if choose.holds("slips", 0.5):
            bar["bond"] = choose.one("bond", bonds)
            bar.update(
                choose.some("bar", {"bonded": ["0.1 m", "0.4 m"], "anchored": (["start"], ["start", "end"])}, 0.4)
            )
        repeats = (
            {"along": self.point(0, 1, 0, ""), "pitch": "0.12 m", "number": 2},
            {"along": self.point(0, 1, 0, ""), "pitch": "0.06 m", "over": "0.1 m",
             **choose.some("repeat", {"last gap": ("short", "even", "open")}, 0.7)},
        )  # fmt: skip
        if choose.holds("repeat", 0.3):
            bar["repeat"] = choose.one("repeat", repeats)
            bar["points"] = [self.point(0.15, 0.25), self.point(0.62, 0.28)]
        for damping in ("stiffness damping", "Rayleigh damping"):
            if isinstance(self.text["solve"], dict):
                self.text["solve"].get("explicit", {}).pop(damping, None)
        self.text["bars"] = {"long": bar}
        if choose.holds("prestress", 0.3):
            stretch = choose.one("prestress", ({"stress": "1 MPa"}, {"strain": 5e-4}))
            self.text["loads"].append({"name": "jack", "prestress": {"bars": ["long"], **stretch}})

    def initial_stress(self):
        choose = self.choose
        if self.formulation not in POINTS or not choose.holds("initial stress", 0.15):
            return
        ground = choose.some("initial", {"unit weight": "25 kN/m3", "surcharge": "3 kPa"}, 0.6)
        ground.setdefault("unit weight", "20 kN/m3")
        up = "0.7 m" if self.flat() else "0.2 m"
        items = (
            {"stress": ["-3 kPa", "-5 kPa", 0 if self.space == "plane stress" else "-2 kPa", "1 kPa", 0, 0]},
            {"surface": up, "K0": 0.4, **ground},
            {"on": "middle", "stress": ["-3 kPa", "-5 kPa", 0, 0, 0, 0]},
        )
        self.text["initial stress"] = choose.one("initial stress", items)

    # ---- readings

    def watch(self):
        choose = self.choose
        ends = [self.point(0.35, 0.35), self.point(0.45, 0.45)]
        if self.space == "1-D":
            ends = [["0.35 m", 0], ["0.45 m", 0]]
        kinds = {
            "moved": {"displacement of": "right"},
            "fast": {"velocity of": "right"},
            "pulled": {"force on": "right"},
            "strained": {"stress and strain of": "middle"},
            "harmed": {"damage of": "middle"},
            "gap": {"opening between": ends},
            "bond": {"bond between": ends},
            "factor": {"load": "pull"},
        }
        if self.reacts:
            kinds["grip"] = {"reaction of": "grip"}
            kinds["reaction"] = {"reaction on": "left"}
        if self.law in HISTORIES and not self.two:
            kinds["past"] = {"history of": "middle"}
        if "bars" in self.text:
            kinds["bar"] = {"bar": "long"}
            kinds["there"] = {"bar": "long", "at": self.point(0.4, 0.4)}
        text = {"books": {"energy": True}}
        text.update({name: kind for name, kind in kinds.items() if choose.holds(f"watch {name}", 0.35)})
        self.text["watch"] = {
            name: dict(kind, **choose.some(name, {"every": 2}, 0.3)) for name, kind in text.items()}  # fmt: skip

    def profiles(self):
        if self.choose.holds("profile", 0.2):
            every = self.choose.some("profile", {"every": 2}, 0.5)
            axis = "x" if self.space == "1-D" else self.choose.one("axis", ("x", "y"))
            self.text["profiles"] = {"layers": {"of": {"all": True}, "along": axis, **every}}

    def results(self):
        fields = ["displacement", "velocity", "stress", "strain", "damage", "internal force"]
        if self.formulation == "micropolar":
            fields += ["rotation", "internal moment"]
        if self.law in HISTORIES:
            fields.append(HISTORIES[self.law])
        self.text["results"] = {"number": 1, "precision": "double", "fields": fields}


VARIES = {"force", "body force", "gravity", "base acceleration", "pressure", "traction", "water pressure", "radial pressure",
          "initial strain", "moment", "rotation", "strength reduction"}  # fmt: skip
SINE = {"phase": "30 deg", "from": "1 ms", "until": "3.5 ms", "envelope": [[0, 0.5], ["2 ms", 1.5]]}
FILE = {
    "scale": 0.7,
    "time step": "0.3 ms",
    "baseline correction": ("none", "constant", "linear", "quadratic", "cubic"),
    "band pass": ({"from": "50 Hz", "to": "900 Hz"}, {"to": "800 Hz", "order": 2}),
    "end at rest": True,
}
OUTCROPS = {
    "outcrop velocity": (["0.2 m/s", "0.1 m/s", "-0.1 m/s"],),
    "outcrop acceleration": (["20 m/s2", "10 m/s2", "-5 m/s2"],),
}
DASHPOTS = {"density": "2.5 t/m3", "shear wave speed": "50 m/s", "compression wave speed": "80 m/s"}
BOND = {"condition": ("good", "other"), "unloading stiffness": "20 MPa/mm"}
DAMPING = {"damping": ("60 1/s", {"ratio": 0.3, "at": "60 Hz"}), "stiffness damping": "6e-5 s"}


def damping(choose, share=0.3):
    if choose.holds("Rayleigh", 0.15):
        return {"Rayleigh damping": {"ratio": 0.05, "from": "30 Hz", "to": "120 Hz"}}
    return choose.some("damping", DAMPING, share)


def explicit(deck, choose):
    text = {"time step": "2e-4 s", **damping(choose)}
    text.update(choose.one("length", ({"steps": 24}, {"end time": "4.9 ms"})))
    if choose.holds("safety", 0.3):
        del text["time step"]
        text.update(choose.some("explicit", {"safety": 0.6}, 0.6))
    if not set(text) & {"damping", "stiffness damping", "Rayleigh damping"}:
        text.update(choose.some("explicit", {"local damping": 0.5}, 0.3))
    if set(text) & {"damping", "local damping"}:
        text.update(choose.some("explicit", {"rest": 0.02}, 0.2))
    return {"explicit": text}


def quasi_static(deck, choose):
    more = {"ramp": 1.5, "hold": 0.6, "longest hold": 1.2, "damping ratio": 0.6, "steady": 0.3}
    return {"explicit": {"quasi-static": {"period": "6 ms", **choose.some("quasi-static", more, 0.4)}}}


def implicit(deck, choose):
    text = {"end time": "4 ms", **damping(choose)}
    options = {"time step": "1 ms", "local error": (1, 0.01), "smallest time step": 1e-3}
    text.update(choose.some("implicit", options, 0.7))
    if choose.holds("HHT", 0.4):
        text.update({"scheme": "HHT", **choose.some("implicit", {"alpha": -0.1}, 0.6)})
    else:
        text.update(choose.one("Newmark", ({}, {"scheme": "Newmark"}, {"beta": 0.3}, {"beta": 0.3, "gamma": 0.55})))
    text.update(tolerances(choose))
    return {"implicit": text}


def tolerances(choose):
    options = {
        "residual": 1e-10,
        "displacement tolerance": 1e-8,
        "energy tolerance": 1e-14,
        "iterations": 30,
        "equations": ("automatic", "direct", "conjugate gradients", "minimal residuals"),
    }
    return choose.some("tolerances", options, 0.3)


def static(deck, choose):
    options = {"end time": 1.2, "increments": 3, "smallest increment": 0.01, "bonds at once": 2}
    return {"static": {**choose.some("static", options, 0.5), **tolerances(choose)}}


def relaxation(deck, choose):
    return {
        "static": {
            "method": "relaxation",
            "increments": 2,
            **choose.some("static", {"relaxation iterations": 3000}, 0.5),
        }
    }


def control(deck, choose):
    if deck.space == "1-D":
        measures = ({"displacement of": "right", "direction": [1, 0]},)
    else:
        ends = [deck.point(0.35, 0.35), deck.point(0.55, 0.35)]
        measures = (
            {"displacement of": "right", "direction": deck.point(1, 0.1, 0, ""), "to": "0.004 m"},
            {"opening between": ends, "to": "0.001 m"},
            {"stretch in": "middle", "to": 0.006},
            {"arc length of": "right", "to": "0.004 m"},
        )
    measure = choose.one("control", measures)
    return {"static": {"increments": 4, "control": {"to": "0.004 m", **measure}}}


def stages(deck, choose):
    first = {"name": "weight", "static": {"end time": 1, "increments": 2}}
    first.update(choose.some("stages", {"laws": ("as given", "elastic")}, 0.6))
    second = {"name": "motion", "explicit": {"time step": "2e-4 s", "steps": 15}}
    second.update(choose.some("stages", {"displacements": ("keep", "zero")}, 0.6))
    push = {"name": "late", "on": "top", "force": deck.vector(0.3, "kN")}
    second.update(choose.some("stages", {"loads": [push], "without": ["pull"]}, 0.6))
    if "without" in second and choose.holds("carries", 0.4) and not {"force", "field"} & set(deck.load):
        second.setdefault("loads", []).append({"name": "carried", "reaction of": "pull"})
    return [first, second]


def static_stages(deck, choose):
    first = {"static": {"end time": 1, "increments": 2}, **choose.some("stages", {"laws": ("elastic",)}, 0.3)}
    first["static"].update(choose.some("static", {"no equilibrium": ("stop", "next stage")}, 0.4))
    second = {"static": {"end time": 1, "increments": 2}}
    second["loads"] = [{"name": "late", "on": "top", "force": deck.vector(0.3, "kN")}]
    return [first, second]


SOLVERS = {
    "explicit": explicit,
    "long explicit": explicit,
    "quasi-static": quasi_static,
    "implicit": implicit,
    "static": static,
    "relaxation": relaxation,
    "control": control,
    "stages": stages,
    "static stages": static_stages,
}


class WideDeck(Deck):
    """Deck of a kind of body that Deck has not: particles from a file, a file beside a lattice, blocks of different
    spacings, three materials, more layers than a family is deep. Sizes, thicknesses and densities are not round."""

    def materials(self):
        super().materials()
        kinds = ("file", "file beside", "three", "deep", "spacings")[: 4 if self.space == "3-D" else 5]
        self.kind = "line" if self.space == "1-D" else self.choose.one("kind", kinds)
        if self.kind in ("deep", "spacings") and self.solver not in ("explicit", "stages"):
            self.solver = "explicit"  # the others take seconds for these bodies
        if self.law in ("elastic-1d", "elastic-brittle", "bilinear-softening", "trilinear-softening"):
            self.text["materials"]["m"].pop("smallest strain", None)
        self.text["materials"]["m"]["density"] = "1.7 t/m3"
        self.two = self.kind in ("file beside", "spacings", "three")
        line = self.formulation == "bond-based"
        others = (
            {"model": "elastic-1d", "Young modulus": "2.6e4 kPa", "density": "2.9 t/m3"} if line
            else {"model": "elastic", "Young modulus": "2.6e4 kPa", "Poisson ratio": 0.23, "density": "2.9 t/m3"},
            {"model": "elastic-1d", "Young modulus": "0.7e4 kPa", "density": "1.3 t/m3"} if line
            else {"model": "elastic", "Young modulus": "0.7e4 kPa", "Poisson ratio": 0.11, "density": "1.3 t/m3"},
        )  # fmt: skip
        for name, other in zip("no"[: 2 if self.kind == "three" else 1 if self.two else 0], others):
            self.text["materials"][name] = other

    def body(self):
        flat = self.flat()
        common = {"lattice": "square" if flat else "cubic", "spacing": "0.1 m"}
        if flat:
            common["thickness"] = "0.27 m"
        if self.kind == "line":
            common = {"lattice": "line", "spacing": "0.07 m", "area": "0.013 m2"}
            shape = {"box": {"particles": [17, 1], "first particle": ["0.135 m", 0]}}
            self.text["body"] = {"b": {"material": "m", **common, "shape": shape}}
            self.boxed = False
            return
        low, high = (0.1, 0.2, -0.1), (0.9 if flat else 0.7, 0.7 if flat else 0.5, 0.2)
        self.boxed = self.kind in ("three", "deep")
        file = {"material": "m", **common, "file": "plane.csv" if flat else "space.csv"}
        if self.kind == "file":
            self.text["body"] = {"b": file}
        if self.kind == "file beside":
            beyond = self.box((high[0], low[1], low[2]), (high[0] + 0.3, high[1], high[2]))
            self.text["body"] = {"c": {"material": "n", **common, "shape": beyond}, "b": file}
        if self.kind == "spacings":
            self.text["body"] = {
                "b": {"material": "m", **common, "shape": self.box(low, (0.5, *high[1:]))},
                "c": {"material": "n", **common, "spacing": "0.05 m", "shape": self.box((0.5, *low[1:]), high)},
            }
        if self.kind == "three":
            self.text["body"] = {
                "b": {"material": "m", **common, "shape": self.box(low, (0.4, *high[1:]))},
                "c": {"material": "n", **common, "shape": self.box((0.4, *low[1:]), (0.6, *high[1:]))},
                "d": {"material": "o", **common, "shape": self.box((0.6, *low[1:]), high)},
            }
        if self.kind == "deep":
            high = (1.3, 0.9, 0) if flat else (0.8, 0.7, 0.5)
            self.text["body"] = {"b": {"material": "m", **common, "shape": self.box(low, high)}}

    def peridynamics(self):
        super().peridynamics()
        text = self.text["peridynamics"]
        if self.kind in ("deep", "line"):
            text["horizon"] = self.choose.one("reach", ("3.015 spacings", "2.6 spacings"))
        if self.kind == "spacings":
            text["horizon"] = "0.21 m"
        if self.kind in ("file", "file beside"):
            text["horizon"] = self.choose.one("reach", ("0.2015 m", "0.17 m"))

    def loads(self):
        super().loads()
        for load in self.text["loads"]:
            if self.kind in ("file", "file beside") and set(load) & {"pressure", "traction"}:
                load.setdefault("area", "0.13 m2")


class Laboratory:
    """Test of one material point: arguments of `breccia material`."""

    SOLID = ("uniaxial", "triaxial", "undrained triaxial", "oedometer", "biaxial", "isotropic", "simple shear",
             "undrained shear")  # fmt: skip

    def __init__(self, number):
        choose = Choices(number)
        self.law = list(LAWS)[number % len(LAWS)]
        always, optional, formulations = LAWS[self.law]
        text = {**always, **choose.some("material", optional, 0.5)}
        if "octahedral strength" in text:
            text.pop("friction angle", None)
        if self.law == "elastic-brittle":
            text.update(choose.one("brittle", BRITTLE))
        if self.law == "link-damage":
            text.update(choose.one("spends", SPENDS))
        if "fracture energy" in text or "crushing energy" in text:
            text["length"] = "0.12 m"
        line = formulations == ("bond-based",)
        test = "uniaxial" if line else choose.one("test", self.SOLID)
        size = choose.one("size", (0.004, -0.004, 0.012, -0.012, 0.03, -0.03))
        words = ["material", "--model", self.law, "--test", test, "--to", size, "--steps", choose.one("steps", (7, 19))]
        for key, value in text.items():
            words += ["--set", f"{key}={value}"]
        if choose.holds("cycles", 0.6):
            words += ["--cycles", choose.one("cycles", (1, 2))]
            if choose.holds("return", 0.5):
                words += ["--return", -0.3 * size]
        if test != "uniaxial" and choose.holds("confining", 0.5):
            words += ["--confining", choose.one("pressure", ("8 kPa", "35 kPa"))]
            if choose.holds("zero", 0.3):
                words += ["--strain-zero", "before consolidation"]
        if self.law == "viscoelastic":
            words += ["--duration", "3 ms"]
        if choose.holds("units", 0.3):
            words += ["--units", "cm,kN,s"]
        self.words = [str(word) for word in words + ["--tangent"]]


class Pictures:
    """Five pictures of the results of a deck: arguments of `breccia plot` for each."""

    FIELDS = ("displacement", "velocity", "stress", "strain", "damage", "internal force")
    PARTS = {"stress": ("xx", "yy", "xy"), "strain": ("yy", "xy"), "damage": ("",)}

    def __init__(self, number):
        self.deck = deck(PICTURES[number - PICTURE])
        self.words = [self.picture(Choices(f"{number} {n}")) for n in range(5)]

    def picture(self, choose):
        field = choose.one("field", self.FIELDS)
        part = choose.one("part", self.PARTS.get(field, ("x", "y", "")))
        words = ["--field", field] + (["--component", part] if part else [])
        words += ["--step", "0"] if choose.holds("step", 0.2) else []
        words += choose.one("deformed", ([], ["--deformed", "0"], ["--deformed", "7"]))
        words += choose.one("size", ([], ["--size", "333"]))
        words += ["--broken-bonds"] if choose.holds("bonds", 0.4) else []
        words += ["--range=-0.003:0.011"] if choose.holds("range", 0.2) else []
        if choose.holds("inside", 0.3):
            low, high = (20, 55) if self.deck.text["units"]["length"] == "cm" else (0.2, 0.55)
            words += ["--inside", f"{low}:{high},{low}:" + (",:" if self.deck.space == "3-D" else "")]
        if self.deck.space == "3-D":
            words += choose.one("view", ([], ["--view", "35:20"], ["--view=-120:-40"]))
        return words


RECORD = "time (ms),late (ms),a,b\n" + "".join(
    f"{0.5 * n:g},{0.7 * n + 1:g},{n % 3},{0.2 * n + 0.3 * (n % 4):.10g}\n" for n in range(12))  # fmt: skip

# Files of particles off the points of a lattice, with different volumes. Their columns have units that no deck has.
PLANE = "x (mm),y (mm),volume (cm3)\n" + "".join(
    f"{100 * i + 150 + 7 * ((i * j) % 3)},{100 * j + 250 + 4 * ((i + 2 * j) % 5)},{2700 + 31 * ((2 * i + j) % 4)}\n"
    for i in range(9) for j in range(7))  # fmt: skip
SPACE = "x (mm),y (mm),z (mm),volume (cm3)\n" + "".join(
    f"{100 * i + 150 + 7 * ((i * j) % 3)},{100 * j + 250 + 4 * ((i + k) % 5)},{100 * k - 50 + 3 * ((i + j) % 4)},"
    f"{1000 + 13 * ((2 * i + j + k) % 4)}\n" for i in range(6) for j in range(5) for k in range(5))  # fmt: skip
FILES = {"record.csv": RECORD, "plane.csv": PLANE, "space.csv": SPACE}
# First numbers of wide decks, of tests of material points, of pictures and of calls of other verbs.
WIDE, LABORATORY, PICTURE, VERB = 1000, 2000, 3000, 4000
PICTURES = (1016, 1018, 1024, 1010, 1044, 1049)  # decks whose results are drawn: they run fast


def deck(number):
    return (WideDeck if number >= WIDE else Deck)(number)


# Calls of other verbs: number of the deck of the call, and its arguments. Each call has a folder of its own; its
# results go to `out`.
SPECTRUM = "spectrum record.csv --output out"
VERBS = (
    (0, f"{SPECTRUM} --column b --unit g --count 9 --periods 0.0007:0.02 --damping 0.13"),
    (0, f"{SPECTRUM} --column a --times late --unit m/s --count 7 --smoothing 0"),
    (0, f"{SPECTRUM} record.csv --column b --below-column a --unit m/s2 --count 5 --smoothing 17 --damping 0"),
    (0, "material stages.yaml --tangent --output out/stages.csv"),
    (0, "material slow.yaml --tangent --output out/slow.csv"),
    (0, "calibrate fit.yaml"),
    (0, "calibrate concrete --fc 4000psi --aggregate 20mm --unverified"),
    (0, "calibrate concrete --fc 37MPa --ft 2.9MPa --fracture-energy 88N/m --initial-fracture-energy 40N/m "
     "--modulus 33GPa --poisson 0.17 --density 2350kg/m3 --spacing 0.03m --unverified"),
    (1003, "modes deck.yaml --count 4 --output out"),
    (1010, "modes deck.yaml --count 4 --output out"),
    (1016, "modes deck.yaml --count 3 --output out"),
    (1024, "modes deck.yaml --count 3 --output out"),
)  # fmt: skip
STAGES = """units: {length: m, force: kN, time: s}
material: {model: drucker-prager, density: 2 t/m3, Young modulus: 2e4 kPa, Poisson ratio: 0.2, cohesion: 20 kPa,
  friction angle: 30 deg, dilation angle: 10 deg, hardening modulus: 500 kPa}
stages:
  - {stress xx: -40, stress yy: -25, stress zz: -30, consolidation: yes, steps: 3}
  - {strain xx: -0.004, stress yy: -25, stress zz: -30, strain xy: 0.001, steps: 5}
  - {strain xx: -0.001, stress yy: -45, stress zz: -30, strain xy: -0.003, stress yz: 4, steps: 6}
"""
SLOW = """material: {model: viscoelastic, density: 2 t/m3, shear modulus: 100 MPa, bulk modulus: 200 MPa,
  relaxing share: 0.35, relaxation time: 1.7 s}
stages:
  - {strain xy: 0.003, strain xx: -0.001, stress zz: 30 kPa, steps: 3, duration: 0.4 s}
  - {strain xy: 0.001, stress xx: -20 kPa, steps: 4, duration: 2.3 s}
"""
FIT = """units: {length: m, force: kN, time: s}
material: {model: j2, density: 2 t/m3, Young modulus: 2e4, Poisson ratio: 0.3, yield stress: 40}
test: {kind: uniaxial, strain: 0.01, cycles: 1, steps: 12}
against: curve.csv
fit: {Young modulus: {from: 1e4, to: 1e5}, yield stress: {from: 20, to: 90}}
"""
CURVE = "strain,stress\n" + "".join(f"{0.0007 * n:.4f},{min(26e3 * 0.0007 * n, 57 + n):.6g}\n" for n in range(14))
FILES.update({"stages.yaml": STAGES, "slow.yaml": SLOW, "fit.yaml": FIT, "curve.csv": CURVE})
