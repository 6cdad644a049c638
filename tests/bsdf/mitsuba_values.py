#!/usr/bin/env python3
"""Writes tests/data/bsdf/MODEL.txt: what Mitsuba's surface models say for directions drawn at random.

    python3 tests/bsdf/mitsuba_values.py [MODEL...]      needs mitsuba (3.9.1 wrote what is checked in) and numpy

A model is a name and a list of dictionaries, each with the parameters of one plugin by Mitsuba's names; colours are lists
of three numbers. Keys that are not Mitsuba's:
    type       the plugin, where it is not the name of the model
    transport  "importance" where it is not radiance
    rows       how many pairs of directions, 6 by default; 0 for models of Dirac lobes alone
    samples    how many samples, none by default: of models whose samples do not depend on how a direction is made from two
               numbers

A file holds, per dictionary, a line `model KEY=VALUE...` and under it
    e  wo(3) wi(3)  value(3) pdf            the value contains the cosine of wi
    s  wo(3) u  wi(3) weight(3) eta         u chooses the lobe
in the words of the library: `wo`, where the path comes from, is `wi` in Mitsuba's.
"""

import pathlib
import sys

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")

FOLDER = pathlib.Path(__file__).resolve().parent.parent / "data" / "bsdf"
OURS = ("rows", "samples", "transport")

GOLD = {"eta": [0.2, 0.92, 1.1], "k": [3.9, 2.45, 2.14]}
FACETS = [
    {"distribution": distribution, "alpha_u": u, "alpha_v": v}
    for distribution in ("ggx", "beckmann")
    for u, v in ((0.05, 0.05), (0.3, 0.1), (0.1, 0.6), (0.5, 0.5), (1, 0.2), (1, 1))
]

COLOURS = {"diffuse_reflectance": [0.8, 0.5, 0.1], "specular_reflectance": [0.9, 0.7, 0.4]}
GREYS = {"diffuse_reflectance": [0.7, 0.7, 0.7], "specular_reflectance": [0.9, 0.9, 0.9]}


def disney(seed, names, specular):
    """Parameters of one of Disney's models at random. Of `names`, every other one is left out."""
    random = np.random.default_rng(seed)
    number = lambda low=0.0, high=1.0: round(float(random.uniform(low, high)), 3)
    parameters = {"base_color": [number() for _ in range(3)], "roughness": number(), "rows": 4}
    for name in names:
        if random.random() < 0.5:
            parameters[name] = number(high=2.0 if name == "diff_trans" else 1.0)
    if specular and random.random() < 0.3:
        parameters["specular"] = number()
    elif random.random() < 0.8:
        parameters["eta"] = number(0.5, 2.2)
    return parameters


COMMON = ("anisotropic", "spec_trans", "spec_tint", "sheen", "sheen_tint", "flatness")
BLUE = [0.0, 0.0, 1.0]

MODELS = {
    "plastic": [
        {"int_ior": int_ior, "ext_ior": ext_ior, "nonlinear": nonlinear, **(GREYS if nonlinear else COLOURS)}
        for int_ior, ext_ior in ((1.49, 1.000277), (1.3, 1.0), (1.9, 1.1))
        for nonlinear in (False, True)
    ],
    "roughplastic": [
        {"distribution": distribution, "alpha": alpha, "int_ior": int_ior, "ext_ior": ext_ior, "nonlinear": nonlinear,
         **COLOURS}
        for distribution in ("ggx", "beckmann")
        for alpha, int_ior, ext_ior, nonlinear in (
            (0.05, 1.49, 1.000277, False), (0.1, 1.49, 1.000277, True), (0.2, 1.9, 1.0, False), (0.3, 1.3, 1.0, True),
            (0.5, 1.49, 1.000277, False), (1, 1.5, 1.0, False), (0.2, 1.0, 1.33, False))
    ],
    "roughconductor": [{**f, **GOLD, "specular_reflectance": [0.9, 0.8, 0.7]} for f in FACETS],
    "roughdielectric": [
        {**f, "int_ior": int_ior, "ext_ior": ext_ior, "rows": 5, "specular_reflectance": [0.9, 0.8, 0.7],
         "specular_transmittance": [0.5, 0.6, 0.7], "transport": transport}
        for f in FACETS
        for int_ior, ext_ior, transport in ((1.5, 1.0, "radiance"), (1.0, 1.33, "importance"), (2.4, 1.1, "radiance"))
    ],
    "thindielectric": [
        {"int_ior": int_ior, "ext_ior": ext_ior, "rows": 0, "samples": 12, "specular_reflectance": [0.9, 0.8, 0.7],
         "specular_transmittance": [0.5, 0.6, 0.7]}
        for int_ior, ext_ior in ((1.5, 1.0), (1.0, 1.33), (2.4, 1.1))
    ],
    "principled": [{}] + [
        {**disney([1, i], COMMON + ("metallic", "clearcoat", "clearcoat_gloss"), True),
         "transport": "importance" if i % 4 == 0 else "radiance"}
        for i in range(12)
    ] + [
        {"roughness": 0.0, "metallic": 0.5, "rows": 3},
        {"roughness": 1.0, "anisotropic": 1.0, "clearcoat": 1.0, "clearcoat_gloss": 1.0, "eta": 1.3},
        {"specular": 0.0, "metallic": 0.7, "clearcoat": 1.0, "flatness": 1.0},
        {"specular": 0.0, "spec_trans": 0.7},
        {"eta": 1.0, "spec_trans": 0.4, "roughness": 0.9},
        {"base_color": BLUE, "eta": 0.7, "spec_tint": 1.0, "sheen": 1.0, "sheen_tint": 1.0, "spec_trans": 0.5},
        {"base_color": [0.0, 0.0, 0.0], "spec_tint": 0.5, "sheen": 1.0, "sheen_tint": 1.0},
        {"metallic": 1.0, "spec_trans": 1.0, "base_color": [0.9, 0.6, 0.2]},
        {"spec_trans": 1.0, "roughness": 0.3, "base_color": [0.9, 0.6, 0.2]},
    ],
    "principledthin": [{}] + [disney([2, i], COMMON + ("diff_trans",), False) for i in range(12)] + [
        {"spec_trans": 1.0, "roughness": 0.0, "rows": 3},
        {"spec_trans": 1.0, "roughness": 1.0, "anisotropic": 1.0, "eta": 2.5},
        {"spec_trans": 0.5, "spec_tint": 1.0, "eta": 1.0, "base_color": BLUE},
        {"spec_trans": 0.5, "spec_tint": 0.7, "eta": 0.4, "sheen": 1.0, "sheen_tint": 1.0, "base_color": BLUE},
        {"diff_trans": 2.0, "sheen": 1.0},
    ],
}


def load(name, parameters):
    plugin = {"type": name}
    for key, value in parameters.items():
        if key not in OURS:
            plugin[key] = {"type": "rgb", "value": value} if isinstance(value, list) else value
    return mi.load_dict(plugin)


def direction(random):
    z = random.uniform(-1, 1)
    phi = random.uniform(0, 2 * np.pi)
    r = np.sqrt(1 - z * z)
    return mi.Vector3f(r * np.cos(phi), r * np.sin(phi), z)


def text(*parts):
    numbers = [float(x) for part in parts for x in (part if hasattr(part, "__len__") else [part])]
    return " ".join(f"{x:.9g}" for x in numbers)


def rows_of(bsdf, parameters, random):
    mode = mi.TransportMode.Importance if parameters.get("transport") == "importance" else mi.TransportMode.Radiance
    context = mi.BSDFContext(mode)

    def seen_from(wo):
        si = mi.SurfaceInteraction3f()
        si.wi = wo
        return si

    number = 0
    while number < parameters.get("rows", 6):
        si = seen_from(direction(random))
        # Three of four are drawn by the model, to be where it is bright; of the others, some are black.
        if number % 4 != 3:
            wi = bsdf.sample(context, si, random.random(), mi.Point2f(random.random(2)))[0].wo
            if not abs(mi.Vector3f(wi).z) > 1e-3:
                continue
        else:
            wi = direction(random)
        value, pdf = bsdf.eval(context, si, wi), bsdf.pdf(context, si, wi)
        if number % 4 != 3 and not pdf > 0:
            continue
        number += 1
        yield "e " + text(si.wi, wi, value, np.nan_to_num(pdf))  # 0 / 0 where no lobe is sampled
    for _ in range(parameters.get("samples", 0)):
        si, u = seen_from(direction(random)), float(np.float32(random.random()))
        sample, weight = bsdf.sample(context, si, u, mi.Point2f(0.5, 0.5))
        yield "s " + text(si.wi, u, sample.wo, weight, sample.eta)


def write(name):
    lines = [f"# {name} by Mitsuba {mi.__version__}: see tests/bsdf/mitsuba_values.py"]
    for index, parameters in enumerate(MODELS[name]):
        random = np.random.default_rng([index, *name.encode()])
        words = (f"{k}={','.join(map(str, v)) if isinstance(v, list) else v}" for k, v in parameters.items())
        lines.append(" ".join(["model", *(w for w in words if not w.startswith(("rows=", "samples=")))]))
        bsdf = load(parameters.get("type", name), parameters)
        lines += rows_of(bsdf, parameters, random)
    FOLDER.mkdir(exist_ok=True)
    (FOLDER / f"{name}.txt").write_text("\n".join(lines) + "\n")


for model in sys.argv[1:] or MODELS:
    write(model)
