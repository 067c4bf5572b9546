"""The drawings of the pages: python3 scripts/drawings.py docs/pictures writes them as SVG files."""

import math
import os
import sys

INK, QUIET, LINE, FAMILY, STRONG, PALE, WARM, FIRM = (
    "#1c2430", "#5b6672", "#b3bbc4", "#2f6db3", "#0f3d73", "#dce8f5", "#c8501e", "#fbe6dc")
FONT = "DejaVu Sans, Verdana, Arial, sans-serif"


class Drawing:
    def __init__(self, width, height, what):
        self.parts = [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" '
            f'font-family="{FONT}" font-size="15" fill="{INK}">',
            f"<title>{what}</title>",
            f'<rect width="{width}" height="{height}" fill="#ffffff"/>',
            "<defs>" + "".join(
                f'<marker id="{name}" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="8" markerHeight="8" '
                f'orient="auto-start-reverse"><path d="M0 0.8 L10 5 L0 9.2 z" fill="{colour}"/></marker>'
                for name, colour in (("ink", INK), ("warm", WARM), ("strong", STRONG))) + "</defs>",
        ]

    def add(self, text):
        self.parts.append(text)

    def line(self, a, b, colour=INK, width=1.5, dash=None, tips=""):
        marker = {INK: "ink", WARM: "warm", STRONG: "strong"}.get(colour, "ink")
        extra = f' stroke-dasharray="{dash}"' if dash else ""
        if "<" in tips:
            extra += f' marker-start="url(#{marker})"'
        if ">" in tips:
            extra += f' marker-end="url(#{marker})"'
        self.add(f'<line x1="{a[0]:.1f}" y1="{a[1]:.1f}" x2="{b[0]:.1f}" y2="{b[1]:.1f}" stroke="{colour}" '
                 f'stroke-width="{width}"{extra}/>')

    def dot(self, centre, radius, fill, stroke="none", width=1.0):
        self.add(f'<circle cx="{centre[0]:.1f}" cy="{centre[1]:.1f}" r="{radius}" fill="{fill}" stroke="{stroke}" '
                 f'stroke-width="{width}"/>')

    def box(self, x, y, width, height, fill="none", stroke=INK, round_=0, dash=None):
        extra = f' stroke-dasharray="{dash}"' if dash else ""
        self.add(f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height:.1f}" rx="{round_}" fill="{fill}" '
                 f'stroke="{stroke}" stroke-width="1.5"{extra}/>')

    def polygon(self, points, fill, stroke=INK, width=1.5):
        corners = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        self.add(f'<polygon points="{corners}" fill="{fill}" stroke="{stroke}" stroke-width="{width}" '
                 'stroke-linejoin="round"/>')

    def text(self, x, y, words, anchor="start", colour=INK, size=15, weight="normal", mono=False):
        words = words.replace("&", "&amp;").replace("<", "&lt;")
        family = ' font-family="DejaVu Sans Mono, Consolas, monospace"' if mono else ""
        self.add(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}" font-size="{size}" '
                 f'font-weight="{weight}"{family}>{words}</text>')

    def finish(self):
        return "\n".join(self.parts + ["</svg>", ""])


def horizon_and_family():
    d = Drawing(860, 460, "Horizon and family of a particle")
    step, centre = 46, (220, 230)
    horizon = 3.015 * step
    grid = [(i, j) for j in range(-4, 5) for i in range(-4, 5)]
    place = {(i, j): (centre[0] + i * step, centre[1] - j * step) for i, j in grid}
    family = [k for k in grid if k != (0, 0) and math.hypot(*k) <= 3.015]
    d.dot(centre, f"{horizon:.1f}", PALE, STRONG, 2)
    for k in family:
        d.line(centre, place[k], FAMILY, 0.9)
    for k in grid:
        if k in family:
            d.dot(place[k], 8, FAMILY)
        elif k != (0, 0):
            d.dot(place[k], 8, "#ffffff", LINE, 2)
    d.dot(place[(2, 2)], 8, WARM)
    d.line(centre, (place[(2, 2)][0] - 6, place[(2, 2)][1] + 6), WARM, 3, tips=">")
    d.dot(centre, 10, STRONG)
    # spacing, below the lattice's lowest row but one
    a, b = place[(-4, -4)], place[(-3, -4)]
    d.line((a[0], a[1] + 22), (b[0], b[1] + 22), INK, 1.5, tips="<>")
    d.text(b[0] + 12, b[1] + 27, "spacing Δx")
    edge = (centre[0] + horizon * math.cos(math.radians(-20)), centre[1] - horizon * math.sin(math.radians(-20)))
    x = 470
    d.line((x - 10, 62), (place[(2, 2)][0] + 12, place[(2, 2)][1] - 6), QUIET, 1)
    d.text(x, 60, "bond ξ", weight="bold", colour=WARM)
    d.text(x, 80, "joins the particle to one of its family;", colour=QUIET)
    d.text(x, 100, "it breaks for good where a limit is passed", colour=QUIET)
    d.line((x - 10, 182), (centre[0] + 13, centre[1] - 4), QUIET, 1)
    d.text(x, 180, "particle", weight="bold", colour=STRONG)
    d.text(x, 200, "stands for the volume of one lattice cell", colour=QUIET)
    d.line((x - 10, 272), edge, QUIET, 1)
    d.text(x, 270, "horizon δ = 3.015 Δx", weight="bold", colour=STRONG)
    d.text(x, 290, "radius within which particles interact", colour=QUIET)
    d.line((x - 10, 362), place[(2, -2)], QUIET, 1)
    d.text(x, 360, "family", weight="bold", colour=FAMILY)
    d.text(x, 380, "all particles within the horizon:", colour=QUIET)
    d.text(x, 400, "28 on a square lattice, 122 on a cubic one", colour=QUIET)
    return d.finish()


def axes_and_faces():
    d = Drawing(900, 430, "Axes and faces of a block")
    origin, ex, ey, ez = (105, 305), (210, 0), (95, -58), (0, -140)

    def at(x, y, z):
        return (origin[0] + x * ex[0] + y * ey[0] + z * ez[0], origin[1] + x * ex[1] + y * ey[1] + z * ez[1])

    d.text(30, 34, "In space: six faces", weight="bold", size=17)
    d.polygon([at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)], "#eef3f8")
    d.polygon([at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1)], "#d3e2f2")
    d.polygon([at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)], "#f7fafc")
    for a, b in (((0, 0, 0), (0, 1, 0)), ((0, 1, 0), (1, 1, 0)), ((0, 1, 0), (0, 1, 1))):
        d.line(at(*a), at(*b), LINE, 1.3, dash="5 4")
    for place, words in (((0.7, 0, 0.5), "y-"), ((1, 0.5, 0.5), "x+"), ((0.72, 0.5, 1), "z+")):
        x, y = at(*place)
        d.text(x, y + 6, words, "middle", STRONG, 19, "bold", True)
    for inner, outer, shift, words in (((0, 0.5, 0.5), (-0.42, 0.5, 0.5), (-18, 6), "x-"),
                                       ((0.2, 1, 0.75), (0.2, 1.0, 1.25), (0, -6), "y+"),
                                       ((0.5, 0.5, 0), (0.5, 0.5, -0.5), (0, 20), "z-")):
        a, b = at(*inner), at(*outer)
        d.line(b, a, QUIET, 1.2, dash="2 3")
        d.dot(a, 3.5, QUIET)
        d.text(b[0] + shift[0], b[1] + shift[1], words, "middle", STRONG, 19, "bold", True)
    d.text(200, 402, "dotted: hidden faces", colour=QUIET, size=14)
    corner = (50, 400)
    for (dx, dy), words, shift in (((66, 0), "x", (10, 5)), ((38, -24), "y", (10, 0)), ((0, -62), "z", (-4, -8))):
        tip = (corner[0] + dx, corner[1] + dy)
        d.line(corner, tip, WARM, 2.2, tips=">")
        d.text(tip[0] + shift[0], tip[1] + shift[1], words, "start", WARM, 16, "bold")

    left, top, step, nx, ny = 510, 122, 24, 13, 8
    d.text(480, 34, "In the plane: four faces, and layers", weight="bold", size=17)
    for j in range(ny):
        for i in range(nx):
            held, pulled = i == 0, i >= nx - 3
            d.dot((left + i * step, top + j * step), 8.5, STRONG if held else WARM if pulled else "#c9d3dd")
    right, bottom = left + (nx - 1) * step, top + (ny - 1) * step
    middle = (left + right) / 2
    d.text(left - 22, (top + bottom) / 2 + 5, "x-", "end", STRONG, 19, "bold", True)
    d.text(right + 22, (top + bottom) / 2 + 5, "x+", "start", STRONG, 19, "bold", True)
    d.text(middle, top - 22, "y+", "middle", STRONG, 19, "bold", True)
    d.text(middle, bottom + 36, "y-", "middle", STRONG, 19, "bold", True)
    d.text(480, 74, "on: {face: x-}", mono=True, colour=STRONG, size=14)
    d.text(880, 74, "on: {face: x+, layers: 3}", "end", WARM, 14, mono=True)
    d.line((left + 8, 82), (left + 1, top - 13), STRONG, 1.2, tips=">")
    d.line((right - step, 82), (right - step, top - 13), WARM, 1.2, tips=">")
    corner = (500, 398)
    for (dx, dy), words, shift in (((60, 0), "x", (10, 5)), ((0, -56), "y", (-4, -8))):
        tip = (corner[0] + dx, corner[1] + dy)
        d.line(corner, tip, WARM, 2.2, tips=">")
        d.text(tip[0] + shift[0], tip[1] + shift[1], words, "start", WARM, 16, "bold")
    d.text(610, 372, "The outermost particles stand", colour=QUIET)
    d.text(610, 392, "half a spacing inside the shape.", colour=QUIET)
    return d.finish()


def cut_and_removed():
    d = Drawing(1000, 430, "A cut, removed particles, and both")
    step, columns, rows, reach = 34, 8, 7, 2.015
    panels = (
        ("cut", "bonds across the line are cut;", "no particle is lost, the gap is 0"),
        ("remove", "one row of particles is taken out; bonds", "still cross the gap: it is narrower than δ"),
        ("remove, cut faces: yes", "the row is taken out, and the bonds", "across it are cut: an open notch"))
    for n, (name, first, second) in enumerate(panels):
        left, top = 46 + n * 330, 92
        place = lambda i, j: (left + i * step, top + (rows - 1 - j) * step)
        depth, row = 4, 3  # the notch reaches over so many columns; in the removed row, or just above it
        gone = {(i, row) for i in range(depth)} if n else set()
        height, end = (row + 0.5 if n == 0 else row), depth - 0.5
        particles = [(i, j) for j in range(rows) for i in range(columns) if (i, j) not in gone]
        for a in particles:
            for b in particles:
                if b <= a or math.hypot(a[0] - b[0], a[1] - b[1]) > reach:
                    continue
                low, high = min(a[1], b[1]), max(a[1], b[1])
                crosses = False
                if low < height < high:
                    x = a[0] + (b[0] - a[0]) * (height - a[1]) / (b[1] - a[1])
                    crosses = x < end
                if crosses and n != 1:
                    continue
                d.line(place(*a), place(*b), WARM if crosses else "#c3ccd6", 1.8 if crosses else 1)
        for k in particles:
            d.dot(place(*k), 7, FAMILY)
        for k in gone:
            d.dot(place(*k), 7, "#ffffff", LINE, 1.5)
        a, b = place(-0.6, height), place(end, height)
        if n != 1:
            d.line(a, b, WARM, 3)
        d.text(left - 14, 34, name, weight="bold", size=17, mono=True, colour=STRONG)
        d.text(left - 14, 56, ("a crack", "bonds still hold the faces together", "a notch")[n], colour=QUIET)
        d.text(left - 14, 350, first, colour=INK, size=14)
        d.text(left - 14, 370, second, colour=INK, size=14)
    d.line((40, 404), (72, 404), WARM, 3)
    d.text(82, 409, "where bonds are cut", colour=QUIET, size=14)
    d.line((362, 404), (394, 404), WARM, 1.8)
    d.text(404, 409, "bonds that hold the faces together", colour=QUIET, size=14)
    d.dot((706, 404), 7, "#ffffff", LINE, 1.5)
    d.text(722, 409, "removed particle", colour=QUIET, size=14)
    return d.finish()


def material_server():
    d = Drawing(920, 384, "A material server: the run, the sockets, the OpenSees processes")
    d.box(24, 60, 300, 300, PALE, STRONG, 8)
    d.text(44, 90, "breccia run plate.yaml", weight="bold", mono=True, size=15, colour=STRONG)
    for n, words in enumerate(("particles, families, bonds", "displacements → strains", "stresses → forces",
                               "time steps, loads, breakage", "results and pictures")):
        d.dot((52, 127 + 32 * n), 4, STRONG)
        d.text(66, 132 + 32 * n, words)
    d.text(44, 318, "The deck names the command", colour=QUIET, size=14)
    d.text(44, 338, "of OpenSees that makes a point.", colour=QUIET, size=14)
    for n in range(2):
        top = 60 + 170 * n
        d.box(640, top, 256, 130, FIRM, WARM, 8)
        d.text(660, top + 28, f"OpenSees, process {n + 1}", weight="bold", colour=WARM)
        d.text(660, top + 56, ("points 1 to n/2", "points n/2 + 1 to n")[n])
        d.text(660, top + 82, "the state of each point:", colour=QUIET, size=14)
        d.text(660, top + 102, "yield surfaces, plastic strains", colour=QUIET, size=14)
        y = top + 44
        d.line((332, y), (632, y), STRONG, 2.2, tips=">")
        d.text(482, y - 10, "strains of all its points", "middle", STRONG)
        d.line((632, y + 42), (332, y + 42), WARM, 2.2, tips=">")
        d.text(482, y + 64, "stresses of all its points", "middle", WARM)
    d.text(482, 210, "one message each way per step,", "middle", QUIET, 14)
    d.text(482, 229, "over a Unix or TCP socket", "middle", QUIET, 14)
    d.text(24, 36, "The program", weight="bold", size=17)
    d.text(640, 36, "Material servers", weight="bold", size=17)
    return d.finish()


DRAWINGS = {"horizon-and-family": horizon_and_family, "axes-and-faces": axes_and_faces, "cut-and-removed": cut_and_removed,
            "material-server": material_server}

if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: drawings.py FOLDER")
    os.makedirs(sys.argv[1], exist_ok=True)
    for name, draw in DRAWINGS.items():
        with open(os.path.join(sys.argv[1], name + ".svg"), "w", encoding="utf-8") as out:
            out.write(draw())
