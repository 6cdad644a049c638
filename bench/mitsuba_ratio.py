#!/usr/bin/env python3
"""Samples per second of path-nee over those of Mitsuba 3's path tracer (llvm_ad_rgb, independent sampler), one thread each.

    python3 -m pip install mitsuba            # its LLVM mode also needs libLLVM (Debian: libllvm19, DRJIT_LIBLLVM_PATH)
    bench/mitsuba_ratio.py PROGRAM SCENE.xml [SCENE.xml ...]

PROGRAM is the program lightswitch. Both are held to one processor and render in turn; the ratio is taken pair by pair, and
the median with the middle half is printed. Loading, building and Mitsuba's compilation are not counted."""
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

import drjit as dr
import mitsuba as mi

SAMPLES, PAIRS = 32, 9


def ours(program, scene, stats):
    subprocess.run([program, "render", scene, "--method", "path-nee", "--spp", str(SAMPLES), "--threads", "1", "--quiet",
                    "--output", stats + ".pfm", "--stats", stats], check=True)
    with open(stats) as file:
        return json.load(file)["samples_per_second"]


def theirs(scene, seed):
    begin = time.perf_counter()
    image = mi.render(scene, spp=SAMPLES, seed=seed)
    dr.eval(image)
    dr.sync_thread()
    seconds = time.perf_counter() - begin
    height, width = image.shape[:2]
    return SAMPLES * width * height / seconds


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    mi.set_variant("llvm_ad_rgb")
    dr.set_thread_count(1)
    print("%-16s %12s %12s %8s" % ("scene", "ours Ms/s", "Mitsuba Ms/s", "ratio"))
    for path in sys.argv[2:]:
        scene = mi.load_file(path)
        with tempfile.TemporaryDirectory() as folder:
            stats = os.path.join(folder, "stats.json")
            ours(sys.argv[1], path, stats), theirs(scene, 0)
            pairs = [(ours(sys.argv[1], path, stats), theirs(scene, seed)) for seed in range(1, PAIRS + 1)]
        low, ratio, high = statistics.quantiles([a / b for a, b in pairs], n=4)
        print("%-16s %12.3f %12.3f %8.3f  (%.3f to %.3f)" % (
            os.path.splitext(os.path.basename(path))[0], statistics.median(a for a, _ in pairs) * 1e-6,
            statistics.median(b for _, b in pairs) * 1e-6, ratio, low, high))


main()
