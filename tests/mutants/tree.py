"""A copy of the working tree in build/mutants, and what is built of it: the tests as they are, with counts of the lines that run, and under the
sanitizers. All link one shared library of all rooms, so that a fault is one file to compile and one library to link."""
import hashlib
import os
import pathlib
import shutil
import subprocess
import tempfile

import faults

TREE = pathlib.Path("build/mutants/tree").absolute()
KINDS = {
    "test": ["--preset", "test"],
    "coverage": ["--preset", "test", "-B", "build/coverage", "-DCMAKE_C_FLAGS=--coverage", "-DBRECCIA_WARNINGS_AS_ERRORS=OFF"],
    "asan-ubsan": ["--preset", "asan-ubsan"],
}


def copy_tree():
    """The working tree as it is, and nothing that git ignores. Files that have not changed keep their times."""
    files = set(faults.git("ls-files", "-z", "--cached", "--others", "--exclude-standard").split("\0")) - {""}
    for name in files:
        here, there = pathlib.Path(name), TREE / name
        if not here.is_file() or (there.is_file() and there.read_bytes() == here.read_bytes()):
            continue
        there.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(here, there)
    for there in TREE.rglob("*"):
        name = there.relative_to(TREE)
        if name.parts[0] != "build" and there.is_file() and str(name) not in files:
            there.unlink()


def digest(*parts):
    """Of all that lies in these folders of the tree, and of these files."""
    of = hashlib.sha256()
    for part in parts:
        for there in sorted((TREE / part).rglob("*")) if (TREE / part).is_dir() else [TREE / part]:
            if there.is_file():
                of.update(str(there.relative_to(TREE)).encode() + there.read_bytes())
    return of.hexdigest()


def configure(kind):
    options = ["-DBRECCIA_ONE_LIBRARY=ON"] + (["-DCMAKE_C_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else [])
    subprocess.run(["cmake", *KINDS[kind], *options], cwd=TREE, check=True, stdout=subprocess.DEVNULL)


def build(kind, *targets):
    """@return whether it could be built, and what was said"""
    call = ["cmake", "--build", f"build/{kind}", "--parallel", str(os.cpu_count())]
    done = subprocess.run(call + (["--target", *targets] if targets else []), cwd=TREE, capture_output=True, text=True)
    return done.returncode == 0, done.stdout + done.stderr


def machine_code():
    """Of library and command, without what debuggers are told of lines and columns."""
    code = b""
    for file in ("libbreccia_objects.so", "breccia"):
        with tempfile.NamedTemporaryFile() as bare:
            strip = ["objcopy", "--strip-all", "--remove-section=.note.gnu.build-id"]
            subprocess.run([*strip, TREE / "build/test" / file, bare.name], check=True)
            code += pathlib.Path(bare.name).read_bytes()
    return code
