# SPDX-License-Identifier: MIT
"""Time and memory of visibility at 100,000 points by the program, by Python and by C: python3 cost.py PROGRAM [POINTS [LEVEL]]

POINTS is the program of examples/library/points.c; LEVEL is builtin:courtyard by default. The last rows are what Python takes before nook is imported.
"""

import os
import subprocess
import sys
import tempfile

COUNT, ROUNDS = 100_000, 5
CHILD = """
import sys, numpy as np, nook
rows = np.load(sys.argv[1])
level = nook.Level.load(sys.argv[2])
made = level.visibility(rows[:, :3], rows[:, 3:], radius=1.0, rays=256, output=".csv")
open(sys.argv[3], "wb").write(made.file(".csv"))
"""
# A process of its own, which is small, starts the command: Linux counts the memory of whoever starts a program as the program's.
STARTER = """
import os, sys, time
begun = time.monotonic()
child = os.fork()
if child == 0:
    os.execv(sys.argv[1], sys.argv[1:])
_, status, usage = os.wait4(child, 0)
print(os.waitstatus_to_exitcode(status), time.monotonic() - begun, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024)
"""


def measured(command):
    """Seconds, processor seconds and megabytes of a command."""
    said = subprocess.run([sys.executable, "-S", "-c", STARTER, *command], stdout=subprocess.PIPE, text=True, check=True).stdout
    code, wall, processor, memory = said.splitlines()[-1].split()
    assert code == "0", command
    return float(wall), float(processor), float(memory)


def main(program, points=None, level="builtin:courtyard"):
    import numpy as np

    rng = np.random.default_rng(1)
    rows = np.hstack([rng.uniform(-8, 8, (COUNT, 3)) * (1, 0, 1) + (0, 0.01, 0), np.tile([0.0, 1.0, 0.0], (COUNT, 1))])
    with tempfile.TemporaryDirectory() as folder:
        array, plain, csv = (os.path.join(folder, name) for name in ("points.npy", "points.f64", "points.csv"))
        np.save(array, rows)
        rows.tofile(plain)
        with open(csv, "w") as file:
            file.writelines(",".join(repr(number) for number in row) + "\n" for row in rows.tolist())
        commands = {"program": [program, "reference", level, "--points", csv, "--radius", "1", "--rays", "256", "-o", "program", "--json", os.devnull],
                    "python": [sys.executable, "-c", CHILD, array, level, "python"]}
        if points is not None:
            commands["c"] = [points, level, plain, "c"]
        commands["python's import of numpy"] = [sys.executable, "-c", "import numpy"]
        commands["python's start"] = [sys.executable, "-c", ""]
        made = {name: os.path.join(folder, name + ".csv") for name in commands}
        commands = {name: [made.get(word, word) for word in command] for name, command in commands.items()}
        runs = [{name: measured(command) for name, command in commands.items()} for _ in range(ROUNDS)]
        for name in commands:
            wall, processor, memory = (min(run[name][i] for run in runs) for i in range(3))
            print(f"{name}: {wall:.2f} s, {processor:.2f} s of processors, {memory:.0f} MB")
        contents = [open(path, "rb").read() for path in made.values() if os.path.exists(path)]
        print("bytes:", "the same" if len(contents) > 1 and len(set(contents)) == 1 else "different")


if __name__ == "__main__":
    main(*(name if name.startswith("builtin:") else os.path.abspath(name) for name in sys.argv[1:]))
