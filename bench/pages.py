"""What scripts that write tables into pages share."""


def write(page, name, lines):
    """Puts lines between the marks <!-- NAME --> and <!-- end of NAME --> of a page."""
    with open(page) as file:
        before, rest = file.read().split(f"<!-- {name} -->\n")
    after = rest.split(f"<!-- end of {name} -->")[1]
    with open(page, "w") as file:
        file.write(f"{before}<!-- {name} -->\n\n" + "\n".join(lines) + f"\n\n<!-- end of {name} -->{after}")


def write_one_of(page, name, whose, lines):
    """The same between marks <!-- NAME of WHOSE -->, one pair for each of whom there are lines; new ones come before the mark <!-- end of all NAME -->."""
    begin, end, last = f"<!-- {name} of {whose} -->", f"<!-- end of {name} of {whose} -->", f"<!-- end of all {name} -->"
    with open(page) as file:
        words = file.read()
    if begin not in words:
        before, after = words.split(last)
        with open(page, "w") as file:
            file.write(f"{before}{begin}\n{end}\n\n{last}{after}")
    write(page, f"{name} of {whose}", lines)


def machine():
    """What the processor calls itself."""
    with open("/proc/cpuinfo") as file:
        words = dict(line.split(":", 1) for line in file.read().split("\n\n")[0].splitlines() if ":" in line)
    words = {key.strip(): value.strip() for key, value in words.items()}
    return f"{words.get('model name', 'an unknown processor')} (family {words.get('cpu family', '?')}, model {words.get('model', '?')})"
