#!/usr/bin/env python3
"""Prints the table of reference values in tests/compare/flip_test.cpp, which makes the same images.

Needs NumPy and the authors' implementation of FLIP, the Python module flip_evaluator (1.7 made the table).
"""
import flip_evaluator
import numpy as np


def noise(x, y, c, s):
    n = (x + 97 * y + 8191 * c + 65537 * s) * 2654435761 % 2**32
    n = (n ^ n >> 15) * 2246822519 % 2**32
    return n >> 24


INKS = [[16, 2, 0], [1, 10, 15], [13, 13, 2], [6, 6, 6]]


def tiles(x, y, c):
    return INKS[(x // 8 + y // 8) % 4][c] / 16


def moved_tiles(x, y, c):
    return INKS[((x - (x >= 20)) // 8 + y // 8) % 4 ^ int(y >= 48 and x < 20)][c] / 16


def ground(x, y, c):
    return (4 + x + 2 * y + 8 * c) / 256


def in_disc(x, y, centre):
    return (x - centre) ** 2 + (y - 9) ** 2 <= 4


def spots(x, y, c):
    return 60 if in_disc(x, y, 10) else 900 if (x, y) == (30, 20) else ground(x, y, c)


def other_spots(x, y, c):
    return 60 if in_disc(x, y, 11) else 300 if (x, y) == (40, 5) else ground(x, y, c)


def smooth(x, y, c):
    return (20 + x * (43 - x) + y * (35 - y) * (c + 1)) / 256


def noisy(x, y, c):
    samples = [noise(x, y, c, s) for s in range(4)]
    return smooth(x, y, c) * sum(2048 if n < 6 else n for n in samples) / 1024


def image(width, height, pattern):
    return np.array([[[pattern(x, y, c) for c in range(3)] for x in range(width)] for y in range(height)], np.float32)


for name, width, height, pattern, reference, pixels in [
    ("tiles", 40, 72, moved_tiles, tiles, [(0, 0), (39, 71), (19, 5), (30, 20), (20, 68)]),
    ("spots", 48, 32, other_spots, spots, [(0, 0), (8, 9), (13, 9), (30, 20), (40, 5)]),
    ("noise", 44, 36, noisy, smooth, [(0, 0), (43, 35), (19, 5), (12, 30), (22, 32)]),
]:
    for kind in "LDR", "HDR":
        for degree in {"tiles": [67.0206433, 30], "spots": [67.0206433], "noise": [67.0206433, 200]}[name]:
            error, _, used = flip_evaluator.evaluate(
                image(width, height, reference), image(width, height, pattern), kind,
                inputsRGB=False, applyMagma=False, parameters={"ppd": float(degree)})
            values = ", ".join("{%d, %d, %.6f}" % (x, y, error[y, x, 0]) for x, y in pixels)
            exposures = "{%.6f, %.6f, %d}" % (used["startExposure"], used["stopExposure"], used["numExposures"])
            mean = error.mean(dtype=float)
            print("{%s, %s, %s, %.8f, %s,\n {%s}},"
                  % (name, str(kind == "HDR").lower(), degree, mean, exposures if kind == "HDR" else "{}", values))
