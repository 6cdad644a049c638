"""mitsuba_metals.py [--check]: writes the table of metals in include/lightswitch/load/metals.hpp, from what Mitsuba's variant
scalar_rgb shades its presets with; with --check it only says whether the table is that one."""

import pathlib
import re
import sys

import mitsuba as mi
import numpy as np

header = pathlib.Path(__file__).parents[2] / "include/lightswitch/load/metals.hpp"
mi.set_variant("scalar_rgb")

# The presets are the pairs of files in Mitsuba's own folder of data.
folder = pathlib.Path(mi.__file__).parent / "data/ior"
names = {path.name.removesuffix(".eta.spd") for path in folder.glob("*.eta.spd")}
assert names == {path.name.removesuffix(".k.spd") for path in folder.glob("*.k.spd")}


def shaded(name):
    """The line for a preset: what both kinds of conductor hold, as the shortest decimals that are these floats."""
    values = []
    for kind in ("conductor", "roughconductor"):
        parameters = mi.traverse(mi.load_dict({"type": kind, "material": name}))
        values.append([np.float32(x) for key in ("eta.value", "k.value") for x in np.ravel(parameters[key])])
    assert values[0] == values[1] and len(values[0]) == 6
    eta, k = ([f"{x!s}f" for x in part] for part in (values[0][:3], values[0][3:]))
    return f'    {{"{name}", {{{", ".join(eta)}}}, {{{", ".join(k)}}}}},\n'


table = "".join(shaded(name) for name in sorted(names))
text = header.read_text()
begin, end = text.index("metal_table{{\n") + len("metal_table{{\n"), text.index("}};", text.index("metal_table{{\n"))
if "--check" in sys.argv[1:]:
    same = text[begin:end] == table
    print(f"{len(names)} metals, Mitsuba {mi.__version__}: the table is {'that one' if same else 'ANOTHER ONE'}")
    sys.exit(0 if same else 1)
text = re.sub(r"NamedMetal, \d+>", f"NamedMetal, {len(names)}>", text[:begin]) + table + text[end:]
header.write_text(text)
