"""Runs the report scripts of the examples in a copy of them, and makes one page of what they found: tables, pictures, times, in red what failed or is out of its band.

    examples.py [--strict] [--minutes M] [--at-once N] [--page PAGE] SOURCE PROGRAMS WORK [EXAMPLE ...]

SOURCE: the project; PROGRAMS: the folder with the command breccia; WORK: a folder of its own, which is emptied first; PAGE: SOURCE/examples/report.html when absent.
Tables are those between marks in the pages of the examples, which report.sh has written there. A row with columns 'computed' and 'accepted' must keep to what is accepted,
'2.2 to 3.0' or words; a column whose head says '(accepted -5 to 5)' to these; a column 'difference' to the size in the 'band' beside it. --strict: numbers that differ from those of the
project's own pages by more than a hundredth, or by more than the 5 of '(± 5 m)' in the head of their column, count, too, and so does a time of all examples beyond M minutes (45).
N examples run at once, each on its share of the cores; as many as there are cores when absent, as small bodies gain little from a second one.
Ends with 1 if anything is red."""
import base64
import concurrent.futures
import html
import os
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time

NUMBER = re.compile(r"[-−+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
RANGE = re.compile(r"(?:^|accepted )([-−]?[\d.e+-]+) to ([-−]?[\d.e+-]+)")
ALLOWED = re.compile(r"\(± (\d+(?:\.\d+)?)[^)]*\)")  # how far last digits may carry a column
TIMES = re.compile(r"^(time|seconds|run time)\b|\btakes\b", re.I)  # rows and columns of times, which differ from run to run


def numbers(cell):
    return [float(word.replace("−", "-")) for word in NUMBER.findall(cell)]


def tables(page):
    """Of the text of a page: (mark, [rows of cells, the head first]) of all tables between marks."""
    found = []
    for mark, text in re.findall(r"^<!-- (?!end of )(.*?) -->\n(.*?)^<!-- end of \1 -->", page, re.S | re.M):
        rows = []
        for line in [*text.split("\n"), ""]:
            if line.startswith("|"):
                rows.append([cell.strip() for cell in re.split(r"(?<!\\)\|", line.strip()[1:-1])])
            elif rows:
                found.append((mark, [rows[0]] + rows[2:]))
                rows = []
    return found


def keeps_to(cell, accepted):
    """Whether all numbers of a cell are in an accepted range, or its words are those that are accepted."""
    limits = RANGE.search(accepted)
    if not limits:
        return cell == accepted
    low, high = (float(word.replace("−", "-")) for word in limits.groups())
    found = numbers(cell)
    return bool(found) and all(low <= value <= high for value in found)


def outside(head, row):
    """The columns of a row that are out of their bands."""
    bad = {n for n, (name, cell) in enumerate(zip(head, row)) if "(accepted " in name and cell and not keeps_to(cell, name[name.index("(accepted ") + 1:])}
    if "computed" in head and "accepted" in head and row[head.index("accepted")]:
        if not keeps_to(row[head.index("computed")], row[head.index("accepted")]):
            bad.add(head.index("computed"))
    for n, name in enumerate(head):
        band = numbers(row[n]) if name == "band" and n and head[n - 1] == "difference" else []
        if band and not all(abs(value) <= band[0] for value in numbers(row[n - 1])):
            bad.add(n - 1)
    return bad


def differs(new, old, head):
    """Whether the words of two cells differ, or a number by more than a hundredth and than the head allows. What reports run on request only may be left out."""
    allowed = ALLOWED.search(head)
    allowed = float(allowed[1]) if allowed else 0
    if new == "not run":
        return False
    if NUMBER.sub("#", new) != NUMBER.sub("#", old):
        return True
    return any(abs(a - b) > max(0.01 * max(abs(a), abs(b)), allowed) for a, b in zip(numbers(new), numbers(old)))


def changed(rows, old):
    """Places (row, column) of a table that are not as in its former version; None: it has another form."""
    if old is None or [len(row) for row in rows] != [len(row) for row in old]:
        return None
    return {(r, c) for r, row in enumerate(rows) for c, cell in enumerate(row)
            if not TIMES.search(row[0]) and not TIMES.search(rows[0][c]) and differs(cell, old[r][c], rows[0][c])}


class Example:
    """After run(): status (0 good), seconds, processor seconds, words (what it printed), page."""

    def __init__(self, name, source, copy):
        self.name, self.folder = name, os.path.join(copy, "examples", name)
        self.former = self.read(os.path.join(source, "examples", name, "README.md"))

    @staticmethod
    def read(path):
        if not os.path.exists(path):
            return ""
        with open(path, encoding="utf-8") as file:
            return file.read()

    def run(self, threads):
        begin = time.monotonic()
        with tempfile.TemporaryFile() as said:
            started = subprocess.Popen(["bash", "report.sh"], cwd=self.folder, stdin=subprocess.DEVNULL, stdout=said, stderr=subprocess.STDOUT,
                                       env={**os.environ, "OMP_NUM_THREADS": str(threads)})
            _, status, used = os.wait4(started.pid, 0)  # its own times: others run beside it
            started.returncode = self.status = os.waitstatus_to_exitcode(status)
            said.seek(0)
            self.words = said.read().decode(errors="replace")
        self.seconds, self.processor = time.monotonic() - begin, used.ru_utime + used.ru_stime
        self.page = self.read(os.path.join(self.folder, "README.md"))
        self.find()

    def find(self):
        """Tables with their marked places."""
        former, self.tables = tables(self.former), []
        for n, (mark, rows) in enumerate(tables(self.page)):
            bad = {(r, c) for r, row in enumerate(rows) if r for c in outside(rows[0], row)}
            other = changed(rows, former[n][1] if n < len(former) else None)
            self.tables.append((mark, rows, bad, other))
        self.outside = sum(len(bad) for *_, bad, _ in self.tables)
        self.differs = sum(len(other) if other is not None else 1 for *_, other in self.tables)

    def told(self):
        words = [f"FAILED with {self.status}"] if self.status else []
        words += [f"{self.outside} outside of what is accepted"] if self.outside else []
        words += [f"{self.differs} not as in README.md"] if self.differs else []
        return f"{', '.join(words) or 'good'}; {self.seconds:.0f} s, {self.processor:.0f} s of processors"

    def pictures(self):
        for words, path in re.findall(r"!\[(.*?)\]\((pictures/[^)]+)\)", self.page):
            try:
                with open(os.path.join(self.folder, path), "rb") as file:
                    yield words, base64.b64encode(file.read()).decode()
            except OSError:
                yield f"{words}: {path} is missing", ""


STYLE = """body {font: 15px/1.4 sans-serif; max-width: 1100px; margin: 2em auto; color: #222} table {border-collapse: collapse; margin: 1em 0}
td, th {border: 1px solid #ccc; padding: 3px 8px; text-align: left} th {background: #f2f2f2} .red {background: #f6b7ae} .changed {background: #fbe7b2}
figure {display: inline-block; margin: 8px; vertical-align: top} figure img {max-width: 520px} figcaption {color: #555} pre {background: #f6f6f6; padding: 8px; overflow-x: auto}"""


def text(words):
    return re.sub(r"`(.*?)`", r"<code>\1</code>", html.escape(words))


def section(example):
    title = example.page.split("\n")[0].lstrip("# ") or example.name
    out = [f'<h2 id="{example.name}">{text(title)}</h2>', f'<p class="{"red" if example.status or example.outside else ""}">{example.name}: {text(example.told())}</p>']
    if example.status:
        out.append(f"<pre>{html.escape(example.words[-3000:])}</pre>")
    for mark, rows, bad, other in example.tables:
        out.append("<table>")
        for r, row in enumerate(rows):
            kind = "td" if r else "th"
            marks = ["red" if (r, c) in bad else "changed" if other is None or (r, c) in other else "" for c in range(len(row))]
            out.append("<tr>" + "".join(f'<{kind} class="{m}">{text(cell)}</{kind}>' for cell, m in zip(row, marks)) + "</tr>")
        out.append("</table>")
    out += [f'<figure><img alt="" src="data:image/png;base64,{data}"><figcaption>{text(words)}</figcaption></figure>' if data else f'<p class="red">{text(words)}</p>'
            for words, data in example.pictures()]
    return "\n".join(out)


def whole_time(examples, seconds):
    return f"{seconds:.0f} s, {sum(e.processor for e in examples):.0f} s of processors"


def report(examples, seconds, late):
    rows = "".join(f'<tr class="{"red" if e.status or e.outside else "changed" if e.differs else ""}"><td><a href="#{e.name}">{e.name}</a></td><td>{text(e.told())}</td></tr>\n' for e in examples)
    return (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>Examples of Breccia</title><style>{STYLE}</style></head><body>\n<h1>Examples of Breccia</h1>\n'
            f"<p>Computed beside published. Red: failed, or out of what is accepted; yellow: not as in the example's README.md.</p>\n<table>{rows}"
            f'<tr class="{"changed" if late else ""}"><td>together</td><td>{whole_time(examples, seconds)}</td></tr>\n</table>\n'
            + "\n".join(section(e) for e in examples) + "\n</body></html>\n")


def copy_of(source, programs, work):
    """A folder in which the report scripts find what they expect: pages to write into, and the rest of the project."""
    if os.path.lexists(work):
        shutil.rmtree(work)
    os.makedirs(os.path.join(work, "build"))
    os.symlink(os.path.abspath(programs), os.path.join(work, "build", "release"))
    examples = os.path.join(source, "examples")

    def results(folder, names):  # of former runs: folders of an example other than its pictures
        return [name for name in names if os.path.dirname(folder) == examples and name != "pictures" and os.path.isdir(os.path.join(folder, name))]
    shutil.copytree(examples, os.path.join(work, "examples"), ignore=results)
    for name in os.listdir(source):
        if name == "docs":
            shutil.copytree(os.path.join(source, name), os.path.join(work, name))
        elif name not in ("build", "examples", ".git"):
            os.symlink(os.path.join(source, name), os.path.join(work, name))


def main(words):
    strict = "--strict" in words
    words = [word for word in words if word != "--strict"]
    cores = len(os.sched_getaffinity(0))
    values = {"--page": None, "--minutes": "45", "--at-once": str(cores)}
    for option in values:
        if option in words:
            place = words.index(option)
            values[option] = words[place + 1]
            del words[place:place + 2]
    page, minutes, at_once = values["--page"], float(values["--minutes"]), int(values["--at-once"])
    source, programs, work, *names = words
    source = os.path.abspath(source)
    known = sorted(name for name in os.listdir(os.path.join(source, "examples")) if os.path.exists(os.path.join(source, "examples", name, "report.sh")))
    for name in names:
        if name not in known:
            sys.exit(f"examples.py: there is no example '{name}' with a report.sh; there are {', '.join(known)}")
    at_once = max(1, min(at_once, len(names or known)))
    copy_of(source, programs, work)
    examples = [Example(name, source, work) for name in names or known]
    begin, ended, telling = time.monotonic(), [], threading.Lock()

    def late():
        return time.monotonic() - begin > 60 * minutes

    def run(example):
        example.run(max(1, cores // at_once))
        with telling:
            print(f"{example.name}: {example.told()}", flush=True)
            ended.append(example)
            with open(page or os.path.join(source, "examples", "report.html"), "w", encoding="utf-8") as file:
                file.write(report([e for e in examples if e in ended], time.monotonic() - begin, late()))

    with concurrent.futures.ThreadPoolExecutor(at_once) as pool:
        list(pool.map(run, examples))
    print(f"together: {whole_time(examples, time.monotonic() - begin)}" + (f", beyond {minutes:g} minutes" if late() else ""))
    return (strict and late()) or any(e.status or e.outside or (strict and e.differs) for e in examples)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
