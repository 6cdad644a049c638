#!/usr/bin/env python3
"""Renders Mitsuba scene files with path-nee and with Mitsuba 3's path tracer (llvm_ad_rgb), and tests if means agree.

    python3 -m pip install mitsuba numpy scipy   # Mitsuba's LLVM mode also needs libLLVM (Debian: libllvm19)
    bench/mitsuba_agree.py [OPTION...] PROGRAM SCENE.xml [SCENE.xml ...]

PROGRAM is the program lightswitch. Files are rendered as they are but for the film's size, in a copy beside them that
is removed again; with paths of at most DEPTH as `max_depth` counts them. Each renderer makes some images with different
seeds; Welch's test compares each of 8 x 8 tiles, per channel. `p` is the smallest of a scene, times their number: below
0.001 the renderers differ there, or have noise of outliers that so few images do not show. `mean` is ours over theirs,
with its standard error. Files that one of the two does not open are listed and not counted."""
import argparse
import os
import re
import subprocess
import sys
import tempfile

import mitsuba as mi
import numpy as np
import scipy.stats

TILES = 8


def included(text, folder, depth=0):
    """The text with the contents of the files that it includes."""
    def contents(element):
        with open(os.path.join(folder, element.group(1)), errors="replace") as file:
            inside = re.sub(r"<\?xml.*?\?>|</?scene\b[^>]*>", "", file.read(), flags=re.S)
        return included(inside, folder, depth + 1) if depth < 8 else inside
    return re.sub(r'<include\s+filename="([^"$]*)"\s*/>', contents, text)


def sized(text, size):
    """The text with films of that size."""
    def resize(film):
        inside = re.sub(r'<integer\s+name="(?:width|height|crop_\w+)"[^>]*/>', "", film.group(2))
        return "%s<integer name=\"width\" value=\"%d\"/><integer name=\"height\" value=\"%d\"/>%s" % (
            film.group(1), size, size, inside)
    text = re.sub(r"<film\b([^>]*)/>", r"<film\1></film>", text)
    return re.sub(r"(<film\b[^>]*>)(.*?</film>)", resize, text, flags=re.S)


def tiles(image, size):
    side = size // TILES
    return image.reshape(TILES, side, TILES, side, -1)[..., :3].mean(axis=(1, 3))


def ours(options, scene, seed):
    with tempfile.TemporaryDirectory() as folder:
        output = os.path.join(folder, "image.pfm")
        run = subprocess.run([options.program, "render", scene, "--method", options.method, "--spp", str(options.spp),
                              "--seed", str(seed), "--sampler", "independent", "--max-depth", str(options.depth),
                              "--quiet", "--output", output], capture_output=True, text=True, timeout=options.timeout)
        if run.returncode != 0:
            raise RuntimeError(run.stderr.strip().splitlines()[0])
        return tiles(np.array(mi.Bitmap(output), dtype=np.float64), options.size)


def compare(options, path):
    with open(path, errors="replace") as file:
        text = sized(included(file.read(), os.path.dirname(path) or "."), options.size)
    handle, copy = tempfile.mkstemp(".xml", ".agree-", os.path.dirname(path) or ".")
    try:
        with os.fdopen(handle, "w") as file:
            file.write(text)
        mine = np.array([ours(options, copy, seed) for seed in range(options.images)])
        scene = mi.load_file(copy)
        hides = re.search(r'name="hide_emitters"\s+value="true"', text) is not None
        path_tracer = mi.load_dict({"type": "path", "max_depth": options.depth, "hide_emitters": hides})
        theirs = np.array([tiles(np.array(mi.render(scene, integrator=path_tracer, spp=options.spp, seed=seed),
                                          dtype=np.float64), options.size) for seed in range(options.images)])
    finally:
        os.remove(copy)
    if mine.shape != theirs.shape:
        raise RuntimeError("images of %s and %s values" % (mine.shape, theirs.shape))
    without_noise = (mine == mine[0]).all(axis=0) & (theirs == theirs[0]).all(axis=0)
    same = without_noise & np.isclose(mine[0], theirs[0], 1e-4, 1e-7)
    p = scipy.stats.ttest_ind(mine, theirs, axis=0, equal_var=False).pvalue
    p = np.where(same, 1.0, np.nan_to_num(p, nan=0.0))
    a, b = mine.mean(axis=(1, 2, 3)), theirs.mean(axis=(1, 2, 3))
    ratio = a.mean() / b.mean() if b.mean() != 0 else float(a.mean() == 0)
    deviations = [x.std(ddof=1) / max(x.mean(), 1e-30) for x in (a, b)]
    error = np.hypot(*deviations) / np.sqrt(options.images)
    return ratio, error, min(1.0, p.min() * p.size), np.unravel_index(p.argmin(), p.shape)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--size", type=int, default=64, help="pixels along each side")
    parser.add_argument("--spp", type=int, default=64, help="samples per pixel of an image")
    parser.add_argument("--images", type=int, default=8, help="images of each renderer")
    parser.add_argument("--depth", type=int, default=8)
    parser.add_argument("--method", default="path-nee")
    parser.add_argument("--timeout", type=float, default=60, help="seconds for an image")
    options = parser.parse_args()
    mi.set_variant("llvm_ad_rgb")
    mi.set_log_level(mi.LogLevel.Error)
    agree, differ, skipped = 0, 0, 0
    for path in options.scenes:
        try:
            ratio, error, p, (row, column, channel) = compare(options, path)
        except Exception as problem:  # whatever one of them says of the file
            skipped += 1
            print("%s: not compared: %s" % (path, str(problem).strip().splitlines()[0][:200]), flush=True)
            continue
        verdict = "agree" if p >= 1e-3 else "differ in tile (%d, %d), channel %d" % (row, column, channel)
        agree, differ = agree + (p >= 1e-3), differ + (p < 1e-3)
        print("%s: mean %.4f +- %.4f, p %.2g: %s" % (path, ratio, error, p, verdict), flush=True)
    print("%d agree, %d differ, %d not compared" % (agree, differ, skipped))
    sys.exit(0 if differ == 0 and agree > 0 else 1)


main()
