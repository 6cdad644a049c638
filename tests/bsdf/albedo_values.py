#!/usr/bin/env python3
"""Writes tests/data/bsdf/albedo.txt: how much white light rough surfaces return, by quadrature over their slopes.

    python3 tests/bsdf/albedo_values.py      needs numpy

Formulas of Walter et al. 2007 as they stand there, in double precision, nothing shared with the library. A line is
    DISTRIBUTION alpha_u alpha_v eta  wo(3)  reflected transmitted
in power, that is, as importance sees it; eta 0 is a perfect mirror.
"""

import math
import pathlib

import numpy as np

SIZE = 1500
FILE = pathlib.Path(__file__).resolve().parent.parent / "data" / "bsdf" / "albedo.txt"

erf = np.vectorize(math.erf, otypes=[float])


def masking_table():
    a = np.linspace(0, 8, 20001)[1:]
    return a, 2 / (1 + erf(a) + np.exp(-a * a) / (a * math.sqrt(math.pi)))


A, G1 = masking_table()


def masking(distribution, alpha, v):
    tangent = np.hypot(alpha[0] * v[0], alpha[1] * v[1]) / np.maximum(np.abs(v[2]), 1e-30)
    if distribution == "ggx":
        return 2 / (1 + np.sqrt(1 + tangent**2))
    return np.interp(1 / np.maximum(tangent, 1e-30), np.r_[0, A], np.r_[0, G1])


def fresnel(c, eta):
    if eta == 0:
        return np.ones_like(c)
    g = np.sqrt(np.maximum(eta**2 - 1 + c**2, 0))
    value = 0.5 * ((g - c) / (g + c)) ** 2 * (1 + ((c * (g + c) - 1) / (c * (g - c) + 1)) ** 2)
    return np.where(eta**2 - 1 + c**2 > 0, value, 1)


def albedo(distribution, alpha, eta, wo):
    # The radius of the slopes, in units of roughness, by its distribution function 1 - t^2.
    t, angle = np.meshgrid((np.arange(SIZE) + 0.5) / SIZE, 2 * np.pi * (np.arange(SIZE) + 0.5) / SIZE)
    r = np.sqrt(-np.log(t * t)) if distribution == "beckmann" else np.sqrt(1 - t * t) / t
    slopes = np.stack([alpha[0] * r * np.cos(angle), alpha[1] * r * np.sin(angle)])
    m = np.stack([-slopes[0], -slopes[1], np.ones_like(t)])
    facing = np.tensordot(wo, m, 1)
    area = 2 * t * np.maximum(facing, 0) / wo[2] * masking(distribution, alpha, wo)
    m /= np.linalg.norm(m, axis=0)
    c = np.clip(np.tensordot(wo, m, 1), 1e-12, 1)
    f = fresnel(c, eta)
    out = np.asarray(wo)[:, None, None]
    mirrored = 2 * c * m - out
    reflected = np.mean(area * f * masking(distribution, alpha, mirrored) * (mirrored[2] > 0))
    if eta == 0:
        return reflected, 0.0
    # Walter et al., equation 40.
    inverse = 1 / eta
    bent = (inverse * c - np.sqrt(np.maximum(1 + inverse**2 * (c**2 - 1), 0))) * m - inverse * out
    transmitted = np.mean(area * (1 - f) * masking(distribution, alpha, bent) * (bent[2] < 0))
    return reflected, transmitted


lines = ["# white light returned by rough surfaces: see tests/bsdf/albedo_values.py"]
for distribution in ("ggx", "beckmann"):
    for alpha in ((0.05, 0.05), (0.3, 0.3), (0.1, 0.6), (1, 0.3), (1, 1)):
        for eta in (0, 1.1, 1.5, 2.4, 1 / 1.5):
            for cosine, turn in ((1, 0), (0.6, 0.4), (0.15, 1.2)):
                sine = math.sqrt(1 - cosine**2)
                wo = (sine * math.cos(turn), sine * math.sin(turn), cosine)
                numbers = (*alpha, eta, *wo, *albedo(distribution, alpha, eta, wo))
                lines.append(distribution + " " + " ".join(f"{x:.6g}" for x in numbers))
FILE.write_text("\n".join(lines) + "\n")
