"""Quantities: units as outputs tell them, other units, other scales, and other axes of decks and of what runs write.

Decks are texts in m, kN, s in which every number with a dimension has its unit (0.1 m) and every vector is marked: V[...] is a vector or a place,
A[...] one that turns by a rotation and is mirrored otherwise (moments, angular velocities), S[...] a stress (xx yy zz xy yz zx), N[...] numbers of
particles along the axes.
"""
import re

BASE = {"m": (1.0, 1, 0, 0), "g": (1e-3, -1, 1, 2), "s": (1.0, 0, 0, 1), "N": (1.0, 0, 1, 0), "Pa": (1.0, -2, 1, 0), "J": (1.0, 1, 1, 0),
        "Hz": (1.0, 0, 0, -1), "t": (1e3, -1, 1, 2)}
PREFIX = {"": 1.0, "k": 1e3, "M": 1e6, "G": 1e9, "T": 1e12, "m": 1e-3, "µ": 1e-6, "n": 1e-9, "p": 1e-12, "c": 1e-2}
UNITS = {"lbf": (4.4482216152605, 0, 1, 0), "deg": (1.0, 0, 0, 0), "rad": (1.0, 0, 0, 0), "%": (0.01, 0, 0, 0), "1": (1.0, 0, 0, 0),
         "min": (60.0, 0, 0, 1), "h": (3600.0, 0, 0, 1)}
for prefix, factor in PREFIX.items():
    for name, (size, *powers) in BASE.items():
        if not (name == "t" and prefix) and prefix + name not in UNITS:
            UNITS[prefix + name] = (factor * size, *powers)
WORD = re.compile(r"([a-zA-Zµ%1]+?)(-?\d*)$")


def parse_unit(text):
    """(factor to SI, power of length, of force, of time) of a unit like kN*ms2/cm4, or None where it is none."""
    if text == "":
        return (1.0, 0, 0, 0)
    factor, powers = 1.0, [0, 0, 0]
    for side, part in enumerate(text.split("/")):
        for name in part.split("*"):
            match = WORD.match(name)
            if not match or match.group(1) not in UNITS or (match.group(1) == "1" and match.group(2)):
                return None
            size, *own = UNITS[match.group(1)]
            power = int(match.group(2) or 1) * (-1 if side else 1)
            factor *= size ** power
            powers = [a + power * b for a, b in zip(powers, own)]
    return (factor, *powers)


class System:
    """In which a variant of a deck is: units that its texts are in, and by how much lengths, masses and times are larger than in the deck as it is."""

    def __init__(self, units="m, kN, s", scale=(1, 1, 1), axes=None, plain=True):
        self.names = [name.strip() for name in units.split(",")]
        self.length, self.mass, self.time = scale
        self.force = self.mass * self.length / self.time ** 2
        self.axes, self.plain = axes, plain  # plain: numbers of the deck stand without units

    def growth(self, powers):
        return self.length ** powers[0] * self.force ** powers[1] * self.time ** powers[2]

    # ---- decks

    def quantity(self, number, unit):
        found = parse_unit(unit)
        if found is None:
            raise ValueError(f"'{unit}' is no unit")
        if not self.plain or unit == "deg":
            return f"{number} {unit}"
        expected = 1.0
        for power, base in zip(found[1:], (1.0, 1e3, 1.0)):
            expected *= base ** power
        value = float(number) * (found[0] / expected if abs(found[0] / expected - 1) > 1e-9 else 1)
        return repr(value * self.growth(found[1:]))

    def turn(self, entries, axial):
        """The entries (texts) of a vector along the new axes."""
        if not self.axes:
            return entries
        rows = [list(row[:len(entries)]) for row in self.axes[:len(entries)]]
        if axial and len(entries) == 3:
            sign = determinant(self.axes)
            rows = [[sign * a for a in row] for row in rows]
        new = []
        for row in rows:
            k = next(k for k, a in enumerate(row) if a)
            new.append(entries[k] if row[k] > 0 else negative(entries[k]))
        return new

    def stress(self, entries):
        if not self.axes:
            return entries
        place = [[0, 3, 5], [3, 1, 4], [5, 4, 2]]
        new = []
        for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)):
            (a, p), (b, q) = ((next((k, v) for k, v in enumerate(self.axes[r]) if v)) for r in (i, j))
            entry = entries[place[a][b]]
            new.append(entry if p * q > 0 else negative(entry))
        return new

    def axis(self, k):
        """Where the axis k goes: (new axis, +1 or -1)."""
        return next((n, row[k]) for n, row in enumerate(self.axes) if row[k])

    def deck(self, text):
        def marked(match):
            kind, entries = match.group(1), [e.strip() for e in match.group(2).split(",")]
            if kind == "S":
                entries = self.stress(entries)
            elif kind == "N":
                entries = [e.lstrip("-") for e in self.turn(entries, False)]
            else:
                entries = self.turn(entries, kind == "A")
            return "[" + ", ".join(entries) + "]"

        if self.axes:
            text = re.sub(r"\b([xyz])([+-])", lambda m: face(self, m), text)
            text = re.sub(r"\b(along|directions): ([xyz]+)\b", lambda m: m.group(1) + ": " + "".join(
                sorted("xyz"[self.axis("xyz".index(c))[0]] for c in m.group(2))).replace("xz", "xz"), text)
        text = re.sub(r"\b([VASN])\[([^\]]*)\]", marked, text)
        if self.axes:
            text = re.sub(r"box: \{from: \[([^\]]*)\], to: \[([^\]]*)\]", ordered, text)
        text = re.sub(r"(-?\d[\d.]*(?:e-?\d+)?) ((?:1/)?[a-zA-Z][a-zA-Z0-9*/]*)(?=[\],}\s]|$)", self.known, text)
        return text.replace("UNITS", "{length: %s, force: %s, time: %s}" % tuple(self.names))

    def known(self, match):
        return self.quantity(*match.groups()) if parse_unit(match.group(2)) is not None else match.group(0)


def face(system, match):
    new, sign = system.axis("xyz".index(match.group(1)))
    return "xyz"[new] + ("+" if (match.group(2) == "+") == (sign > 0) else "-")


def ordered(match):
    """A box whose corners are the lowest and the highest one."""
    pairs = [sorted(pair, key=lambda e: float(e.split()[0])) for pair in zip(*(e.split(", ") for e in match.groups()))]
    return "box: {from: [" + ", ".join(p[0] for p in pairs) + "], to: [" + ", ".join(p[1] for p in pairs) + "]"


def negative(entry):
    if entry in ("free", "0"):
        return entry
    return entry[1:] if entry[0] == "-" else "-" + entry


def determinant(m):
    return (m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]))


def turned_vector(axes, v, axial=False):
    sign = determinant(axes) if axial else 1
    return [sign * sum(a * b for a, b in zip(row, v)) for row in axes]


def turned_tensor(axes, t):
    """Of a tensor of nine components, row by row."""
    first = [[sum(axes[i][k] * t[3 * k + j] for k in range(3)) for j in range(3)] for i in range(3)]
    return [sum(first[i][k] * axes[j][k] for k in range(3)) for i in range(3) for j in range(3)]


def turned_voigt(axes, t, shear):
    """Of xx yy zz xy yz zx; shear: 2 where these are engineering strains."""
    xx, yy, zz, xy, yz, zx = t
    xy, yz, zx = xy / shear, yz / shear, zx / shear
    n = turned_tensor(axes, [xx, xy, zx, xy, yy, yz, zx, yz, zz])
    return [n[0], n[4], n[8], shear * n[1], shear * n[5], shear * n[6]]
