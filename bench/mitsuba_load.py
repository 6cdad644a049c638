#!/usr/bin/env python3
"""Speed of reading mesh files over that of Mitsuba 3 (scalar_rgb), on one processor.

    python3 -m pip install mitsuba
    bench/mitsuba_load.py build/bench/load FILE.obj|FILE.ply ...

Both read each file in turn, 5 times, from the system's cache; best rates, in megabytes of the file per second of processor
time, and their ratio, so that what else the machine does counts little. Mitsuba is told to make no normals (face_normals),
which is no work of reading; it keeps single precision, we double. It builds nothing to trace rays with until a scene asks."""
import os
import sys
import subprocess
import time

import mitsuba as mi

RUNS = 5


def ours(program, path):
    line = subprocess.run([program, path], check=True, capture_output=True, text=True).stdout.splitlines()[1]
    return float(line.split()[-4])


def theirs(path):
    kind = os.path.splitext(path)[1][1:].lower()
    begin = time.process_time()
    mi.load_dict({"type": kind, "filename": path, "face_normals": True})
    return os.path.getsize(path) * 1e-6 / (time.process_time() - begin)


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    mi.set_variant("scalar_rgb")
    print("%-24s %10s %13s %8s" % ("file", "ours MB/s", "Mitsuba MB/s", "ratio"))
    for path in sys.argv[2:]:
        pairs = [(ours(sys.argv[1], path), max(theirs(path), theirs(path))) for _ in range(RUNS)]
        a, b = max(p[0] for p in pairs), max(p[1] for p in pairs)
        print("%-24s %10.0f %13.0f %8.2f" % (os.path.basename(path), a, b, a / b))


main()
