# SPDX-License-Identifier: MIT
"""Time and memory of visibility at 100,000 points by Python and by the program: python3 cost.py PROGRAM"""

import os
import subprocess
import sys
import tempfile
import time

LEVEL, COUNT, ROUNDS = "builtin:courtyard", 100_000, 3
CHILD = """
import resource, sys, time, numpy as np, nook
begun = time.monotonic()
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
rows = np.load(sys.argv[1])
level = nook.Level.load(sys.argv[2])
made = level.visibility(rows[:, :3], rows[:, 3:], radius=1.0, rays=256, output=".csv")
open(sys.argv[3], "wb").write(made.file(".csv"))
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
print(f"python without its start: {time.monotonic() - begun:.2f} s, {(peak - before) / 1024:.0f} MB")
"""


def measured(command):
    """Seconds, processor seconds and megabytes of a command."""
    begun = time.monotonic()
    process = subprocess.Popen(command, stdout=sys.stdout)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    assert process.returncode == 0, command
    return time.monotonic() - begun, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def main(program):
    import numpy as np

    rng = np.random.default_rng(1)
    rows = np.hstack([rng.uniform(-8, 8, (COUNT, 3)) * (1, 0, 1) + (0, 0.01, 0), np.tile([0.0, 1.0, 0.0], (COUNT, 1))])
    with tempfile.TemporaryDirectory() as folder:
        array, csv = os.path.join(folder, "points.npy"), os.path.join(folder, "points.csv")
        np.save(array, rows)
        with open(csv, "w") as file:
            file.writelines(",".join(repr(number) for number in row) + "\n" for row in rows.tolist())
        outputs = [os.path.join(folder, name) for name in ("program.csv", "python.csv")]
        commands = [[program, "reference", LEVEL, "--points", csv, "--radius", "1", "--rays", "256", "-o", outputs[0], "--json", os.devnull],
                    [sys.executable, "-c", CHILD, array, LEVEL, outputs[1]]]
        runs = [[measured(command) for command in commands] for _ in range(ROUNDS)]
        for name, which in (("program", 0), ("python", 1)):
            wall, processor, memory = (min(run[which][i] for run in runs) for i in range(3))
            print(f"{name}: {wall:.2f} s, {processor:.2f} s of processors, {memory:.0f} MB")
        with open(outputs[0], "rb") as one, open(outputs[1], "rb") as other:
            print("bytes:", "the same" if one.read() == other.read() else "different")


if __name__ == "__main__":
    main(sys.argv[1])
