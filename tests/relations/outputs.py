"""What runs write, as named groups of numbers with their units: histories, profiles, fields, the summary, the words that are printed."""
import csv
import json
import os
import re
import subprocess

from quantities import parse_unit, turned_tensor, turned_vector, turned_voigt

VOIGT = ["xx", "yy", "zz", "xy", "yz", "zx"]
NINE = ["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"]


class Group:
    """Rows of numbers that belong together: one number, or the components of a vector or tensor; each with a power of length, force, time."""

    def __init__(self, kind, unit, rows, where, digits=17):
        self.kind, self.unit, self.rows, self.digits = kind, unit, rows, digits
        self.factor, *self.powers = parsed(unit, where)

    def turned(self, axes):
        how = {"vector": lambda r: turned_vector(axes, r), "axial": lambda r: turned_vector(axes, r, True),
               "voigt": lambda r: turned_voigt(axes, r, 1), "strain": lambda r: turned_voigt(axes, r, 2),
               "nine": lambda r: turned_tensor(axes, r)}.get(self.kind)
        return [how(r) for r in self.rows] if how else self.rows


def parsed(unit, where):
    found = parse_unit(unit)
    if found is None:
        raise ValueError(f"{where}: '{unit}' is no unit")
    return found


def heading(cell):
    match = re.match(r"(.*?)(?: \(([^()]*)\))?$", cell)
    return match.group(1), match.group(2) or ""


def groups_of_table(path, tell):
    """Groups of a CSV file, by name; components are gathered by the ends of their names."""
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    names = [heading(cell) for cell in rows[0]]
    numbers = [[float(cell) for cell in row] for row in rows[1:]]
    groups, k = {}, 0
    while k < len(names):
        name, unit = names[k]
        stem = name[:-2].strip() if name.endswith("xx") else None
        if stem is not None and [n for n, _ in names[k:k + 6]] == [(stem + " " + c).strip() for c in VOIGT]:
            count, kind = 6, "strain" if "strain" in stem else "voigt"
        elif name == "x" or name.endswith(" x"):
            stem, count = name[:-1].strip(), 0
            while k + count < len(names) and count < 3 and names[k + count][0] == (stem + " " + "xyz"[count]).strip():
                count += 1
            kind = "axial" if "moment" in stem or "rotation" in stem else "vector"
            if count == 1:
                stem, kind = name, "number"
        else:
            stem, count, kind = name, 1, "number"
        units = {u for _, u in names[k:k + count]}
        if len(units) != 1:
            raise ValueError(f"{tell}: {stem} has components of unlike units {units}")
        values = [row[k:k + count] for row in numbers]
        if kind == "vector" and count == 2:
            values = [v + [0.0] for v in values]
        groups[stem or "vector"] = Group(kind, unit, values, tell)
        k += count
    return groups


def groups_of_fields(reader, folder, tell):
    """Positions and fields of all written states, read by print_results."""
    done = subprocess.run([reader, os.path.join(folder, "results.vtkhdf")], capture_output=True, text=True)
    if done.returncode:
        raise ValueError(f"{tell}: {done.stderr}")
    groups = {}
    for line in done.stdout.splitlines():
        if line.startswith("="):
            name, unit, components, _ = line[1:].split("|")
            kind = {"x y z": "vector", " ".join(VOIGT): "voigt", " ".join(NINE): "nine"}.get(components, "number")
            if name == "strain":
                kind = "strain"
            if name in ("rotation", "angular velocity", "internal moment"):
                kind = "axial"
            group = groups[name] = Group(kind, unit, [], tell)
        else:
            group.rows.append([float(v) for v in line.split()])
    return groups


SKIPPED = {"broken_bonds_by_cause", "title", "version", "deck", "settings", "variables", "wall_seconds", "ns_per_directed_bond_step", "threads", "units", "servers"}
SUMMARY_UNITS = {"time": "times", "time_step": "times", "stable_time_step": "times", "times": "times", "at": "positions and displacements",
                 "reactions": "forces", "loads": "forces", "moment of reactions": "moments", "moment of loads": "moments",
                 "displacement": "positions and displacements", "velocity": "velocities", "octahedral_shear_stress": "stresses",
                 "mean_stress_lowest": "stresses", "mean_stress_highest": "stresses", "size": "positions and displacements", "held": "times"}
BAR_UNITS = {"elements": "", "area": "areas", "stress": "stresses", "strain": "", "stress_so_far": "stresses", "stored": "energies", "dissipated": "energies", "yielded_share": "",
             "torn_share": "", "slip": "positions and displacements"}


def groups_of_summary(path):
    with open(path) as file:
        summary = json.load(file)
    summary["peaks"] = {"peak " + key: value for key, value in summary["peaks"].items()}
    groups, units = {}, summary["units"]

    def walk(name, key, value, parent):
        where = f"summary: {name}"
        if key in SKIPPED or isinstance(value, str) or value is None:
            return
        if isinstance(value, dict):
            for k, v in value.items():
                walk(name + "/" + k, k, v, key)
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            for n, item in enumerate(value):
                if key == "bars":
                    for k, unit in BAR_UNITS.items():
                        if k in item:
                            groups[f"{name}/{n}/{k}"] = Group("number", units.get(unit, unit), [[float(v)] for v in (item[k] if isinstance(item[k], list) else [item[k]])], where, 10)
                elif key == "loads":
                    if item["peak"] is not None:
                        groups[f"{name}/{n}"] = Group("number", item["unit"], [[item["peak"]]], where, 10)
                    for k in ("largest_force", "force_at_end"):
                        if k in item:
                            groups[f"{name}/{n}/{k}"] = Group("vector", units["forces"], [[float(v) for v in item[k]]], where, 10)
                elif key == "largest_compressions":  # in the order of the particles; of equal ones the place is that of the first
                    groups[f"{name}/{item['material']}"] = Group("number", units["stresses"], [[item["compression"]]], where, 10)
                else:
                    walk(f"{name}/{n}", key, item, parent)
        elif parent == "first_broken_bond" and key in ("value", "limit"):
            groups[name] = Group("number", summary["first_broken_bond"]["unit"], [[float(value)]], where, 10)
        elif key != "particles" or parent != "first_broken_bond":
            unit = units["energies"] if parent == "energy" and key != "imbalance" else units[SUMMARY_UNITS[key.replace("peak ", "")]] if key.replace("peak ", "") in SUMMARY_UNITS else ""
            numbers = value if isinstance(value, list) else [value]
            kind = "number" if len(numbers) != 3 else "axial" if "moment" in key else "vector"
            groups[name] = Group(kind, unit, [[float(v) for v in numbers]], where, 10)

    for key, value in summary.items():
        walk(key, key, value, None)
    return groups


NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?"
TOKEN = re.compile(rf"\[({NUMBER}(?:, {NUMBER})*)\](?: ([^\s,;:)]+))?|(?<![\w.'-])({NUMBER})(?: to ({NUMBER}))?(?: ?([^\s,;:)]+))?")
IDLE = re.compile(r"; [\d.]+ s for .*|, \d+ MB, .*|^ +(?:/|[^ ]*/)[^ ]* .*|^written:.*", re.M)


def groups_of_words(text, tell, time):
    """Numbers in what is printed, with the unit behind them; and the words between."""
    groups, count, force, name = {}, 0, "", ""
    text = IDLE.sub("", text.split("written:")[0])
    text = re.sub(r"(\.yaml:\d+):\d+", r"\1", text)  # numbers in other units make lines of other lengths
    words = []
    position = 0
    for match in TOKEN.finditer(text):
        words.append(text[position:match.start()])
        position = match.end()
        vector, unit, number, end, own = match.groups()
        unit = unit if vector else own
        if unit is None or parse_unit(unit) is None or unit == "1":
            if unit is not None:
                position -= len(unit)
            unit = ""
        if vector:
            unit = force = unit or force  # of several in a row the first one tells it
            numbers = [float(v) for v in vector.split(",")]
            kind = "vector" if len(numbers) == 3 else "number"
        else:
            numbers, kind = [float(v) for v in (number, end) if v], "number"
            if words[-1].endswith("of the stable ") or (words[-1].endswith(", from time ") and not unit):
                unit = time
            if words[-1].strip() == "x" and name in groups:  # lengths side by side
                groups[name].rows[0].append(numbers[0] * parse_unit(unit)[0] / groups[name].factor)
                continue
        name = f"{count} ({words[-1].strip()[-30:]})"
        groups[name] = Group(kind, unit, [numbers], tell, 4 if unit != "%" else 2)
        count += 1
    words.append(text[position:])
    return groups, words
