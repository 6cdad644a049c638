"""make_spectra.py [--check]: writes spectra.txt beside it, what Mitsuba makes of spectra in scene files; with --check it only compares.
Each line: how it is used, the spectrum, and red, green and blue, between semicolons."""

import pathlib
import sys

import mitsuba as mi
import numpy as np

here = pathlib.Path(__file__).parent
pairs = [
    "360:1, 830:1",
    "400:0.1, 500:0.2, 600:0.6, 700:0.4",
    "400:0.04 420:0.06,440:0.046  470:0.042,500:0.09,550:0.4,560:0.47,600:0.06,650:0.07,700:0.16",
    "550:0.9, 570:0.9",
    "500:1, 520:3",
    "100:0.3, 540:0.3, 540.5:0.7, 2000:0.7",
    "359.9:5, 360:0.2, 361:0.9",
    "829:1, 831:-0.5",
    "450:1, 451:1",
    "450.5:1, 450.9:1",
    "10:1, 300:1",
    "400:-1, 700:-1",
    "600:12.5, 640:80, 830:3",
]
uses = {  # an object, the type and the name of a parameter, and where Mitsuba keeps its colour
    "reflectance": ("bsdf", "diffuse", "reflectance"),
    "index": ("bsdf", "conductor", "eta"),
    "emission": ("emitter", "constant", "radiance"),
}


def rgb(use, attribute, name=None):
    tag, kind, parameter = uses[use]
    text = f'<{tag} version="3.0.0" type="{kind}"><spectrum name="{parameter}" {attribute}/></{tag}>'
    parameters = mi.traverse(mi.load_string(text))
    return np.broadcast_to(np.float32(parameters[f"{parameter}.value"]).ravel(), 3)


def blackbody(temperature, *ends):
    """The sum by which Mitsuba gives lists of samples a colour, on the spectrum that only its spectral variants have."""
    description = {"type": "blackbody", "temperature": temperature}
    if ends:
        description |= {"wavelength_min": ends[0], "wavelength_max": ends[1]}
    mi.set_variant("scalar_spectral")
    texture, place = mi.load_dict(description), mi.SurfaceInteraction3f()
    xyz, wavelengths = np.zeros(3), np.linspace(360, 830, 1000)
    for wavelength in wavelengths:
        place.wavelengths = [wavelength] * 4
        xyz += texture.eval(place)[0] * np.float64(mi.cie1931_xyz(wavelength))
    xyz *= (830 - 360) / len(wavelengths) * mi.MI_CIE_Y_NORMALIZATION
    return np.maximum(mi.xyz_to_srgb(mi.Color3f(xyz)), 0)


mi.set_variant("scalar_rgb")
lines = []


def add(use, spectrum, color):
    lines.append("; ".join([use, spectrum, " ".join(f"{x:.9g}" for x in color)]) + "\n")


for use in uses:
    for value in ["0.25", "3", "-1"]:
        add(use, value, rgb(use, f'value="{value}"'))
    for value in pairs:
        add(use, value, rgb(use, f'value="{value}"'))
    add(use, "lamp.spd", rgb(use, f'filename="{here / "lamp.spd"}"'))
for body in ["800", "1900", "2856", "5000", "6504", "20000", "5000 500 600"]:
    add("blackbody", body, blackbody(*map(float, body.split())))

table = here / "spectra.txt"
if "--check" in sys.argv[1:]:
    same = table.read_text() == "".join(lines)
    print(f"{len(lines)} spectra, Mitsuba {mi.__version__}: the table is {'that one' if same else 'ANOTHER ONE'}")
    sys.exit(0 if same else 1)
table.write_text("".join(lines))
