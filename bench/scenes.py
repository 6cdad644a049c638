#!/usr/bin/env python3
"""How many scene files of whole folders open: strictly, with stand-ins, and why not; and what Mitsuba 3 says of them.

    bench/scenes.py [OPTION...] PROGRAM FOLDER...

PROGRAM is the program lightswitch; each FOLDER is a checkout of one repository. Its scenes are the XML files whose root
is a <scene> of some version, .gltf and .glb, and OBJ files that name a material file. Set apart are fragments (XML that
another file includes, or without a shape), XML that is not well-formed or of another program, copies of a file that was
counted before, and scenes of which a mesh, an image or another file is not in the repository, or which need values for
$name.

`lightswitch info` opens each and builds it to be rendered, within --seconds and --gib. `strictly` are those without a
problem, `leniently` those that open at all, these included; a time-out, too much memory or a signal is neither. `plain`
are Mitsuba scenes of version 2 and 3 without a plug-in of their own, by the names below. With --mitsuba, Mitsuba
(scalar_rgb) in that Python loads the XML files as well, within the same bounds; `theirs` are those that it loads.

At last come the causes why files do not open strictly, by the number of files; a file may have several."""
import argparse
import collections
import hashlib
import json
import os
import re
import resource
import subprocess
import sys
import urllib.parse
import xml.etree.ElementTree as ElementTree

# Plug-ins of Mitsuba 2 and 3, by the files that 3.9.1 installs, its integrators in Python, and what 2 had besides.
STOCK = set("""
aov area batch bitmap blackbody blendbsdf blendphase box bsplinecurve bumpmap catmullrom checkerboard circular
conductor constant constvolume cube cylinder d65 depth dielectric diffuse direct direct_projective direct_reparam
directional directionalarea disk distant ellipsoids ellipsoidsmesh emission_reparam envmap gaussian gridvolume hair
hdrfilm heterogeneous hg homogeneous independent instance interpolated irradiancemeter irregular isotropic lanczos
ldsampler linearcurve mask measured measured_polarized merge mesh_attribute mitchell moment multijitter normalmap null
obj orthogonal orthographic path perspective plastic ply point polarizer pplastic prb prb_basic prb_projective
prb_reparam prb_threepoint prbvolpath principled principledthin projector ptracer radiancemeter rawconstant rayleigh
rectangle regular retarder rgb roughconductor roughdielectric roughplastic scale scene sdfgrid serialized sggx
shapegroup sky specfilm sphere spot srgb srgb_d65 stokes stratified sun sunsky tabphase tent texture thindielectric
thinlens timed_sunsky twosided uniform volpath volpathmis volprim_rf_basic volume""".split())
OBJECTS = {"bsdf", "shape", "emitter", "sensor", "film", "rfilter", "sampler", "integrator", "texture", "medium",
           "phase", "volume", "spectrum"}
READERS = OBJECTS - {"film", "sampler", "integrator"}  # of files that they name


def found(name, folders):
    """The path of a file that one of the folders has, with slashes for backslashes and in any capitals, or None."""
    name = name.replace("\\", "/")
    for folder in folders:
        if os.path.exists(os.path.join(folder, name)):
            return os.path.join(folder, name)
    for folder in folders:
        path = "/" if name.startswith("/") else folder
        for part in (part for part in name.split("/") if part):
            entries = os.listdir(path or ".") if os.path.isdir(path or ".") else []
            same = [entry for entry in entries if entry.lower() == part.lower()]
            path = os.path.join(path, part if part in ("..", ".") else same[0]) if same or part in ("..", ".") else None
            if path is None:
                break
        else:
            return path
    return None


def whole(path):
    """Whether a file is there, and not as the placeholder that Git LFS leaves."""
    if not path or not os.path.isfile(path):
        return False
    with open(path, "rb") as file:
        return not file.read(40).startswith(b"version https://git-lfs")


class MitsubaScene:
    """What an XML file and those that it includes say about themselves."""

    def __init__(self, path):
        self.path, self.includes, self.missing, self.undefined = path, [], [], False
        self.has_shape, self.own, self.values, self.folders = False, set(), {}, [os.path.dirname(path)]
        root = ElementTree.parse(path).getroot()
        self.is_scene = root.tag == "scene" and "version" in root.attrib
        self.version = root.get("version", "")
        if self.is_scene:
            self.read(root, os.path.dirname(path), 0)

    def text(self, value):
        def replace(name):
            for length in range(len(name.group(1)), 0, -1):
                if name.group(1)[:length] in self.values:
                    return self.values[name.group(1)[:length]] + name.group(1)[length:]
            self.undefined = True
            return name.group(0)
        return re.sub(r"(?<!\\)\$(\w+)", replace, value)

    def read(self, node, folder, depth, parent=""):
        places = self.folders + [folder]
        if node.tag == "default":
            self.values.setdefault(node.get("name"), self.text(node.get("value", "")))
            return
        for value in node.attrib.values():
            self.text(value)
        if node.tag == "path":
            self.folders.insert(0, found(self.text(node.get("value", "")), places) or folder)
        self.has_shape |= node.tag == "shape"
        if node.tag in OBJECTS and node.get("type") and self.text(node.get("type")) not in STOCK:
            self.own.add((node.tag, self.text(node.get("type"))))
        if node.tag == "include" or (node.tag == "spectrum" and node.get("filename")) or (
                node.tag == "string" and node.get("name") == "filename" and parent in READERS):
            name = self.text(node.get("filename") or node.get("value") or "")
            path = found(name, places)
            if not whole(path):
                self.missing.append(name)
            elif node.tag == "include" and depth < 8:
                self.includes.append(os.path.realpath(path))
                self.read(ElementTree.parse(path).getroot(), os.path.dirname(path), depth + 1)
        for child in node:
            self.read(child, folder, depth, node.tag)


def missing_of_gltf(path):
    with open(path, "rb") as file:
        data = file.read()
    if data[:4] == b"glTF":
        data = data[20:20 + int.from_bytes(data[12:16], "little")]
    document = json.loads(data)
    names = [part["uri"] for kind in ("buffers", "images") for part in document.get(kind, []) if "uri" in part]
    return [name for name in names if not name.startswith("data:") and
            not whole(os.path.join(os.path.dirname(path), urllib.parse.unquote(name)))]


def library_of_obj(path):
    """Whether an OBJ file names a material file, and that is there; None when it names none."""
    with open(path, "rb") as file:
        names = re.findall(rb"^mtllib[ \t]+([^\r\n]+?)[ \t]*\r?$", file.read(1 << 20), re.M)
    if not names:
        return None
    return any(whole(found(name.decode(errors="replace"), [os.path.dirname(path)])) for name in names)


def scenes_of(folder, seen, apart):
    """The folder's scenes as (path, kind, own plug-ins); those that are none are counted in `apart`."""
    paths = [os.path.join(place, name) for place, _, names in os.walk(folder) for name in names]
    read, result = [], []
    for path in sorted(paths):
        ending = path.lower().rsplit(".", 1)[-1]
        if ending not in ("xml", "gltf", "glb", "obj") or not os.path.isfile(path):
            continue
        with open(path, "rb") as file:
            data = file.read()
        if ending == "xml" and b"<scene" not in data:
            continue
        digest = hashlib.sha256(data).digest()
        try:
            if ending == "xml":
                scene = MitsubaScene(path)
                read.append((path, digest, scene))
            elif ending != "obj":
                lacks = missing_of_gltf(path)
                result.append((path, digest, "glTF", set(), lacks))
            elif (there := library_of_obj(path)) is not None:
                result.append((path, digest, "OBJ", set(), [] if there else ["material file"]))
        except (ElementTree.ParseError, ValueError, KeyError, AttributeError, RecursionError):
            apart["malformed"] += 1
    included = {path for _, _, scene in read for path in scene.includes}
    for path, digest, scene in read:
        if not scene.is_scene:
            apart["other format"] += 1
        elif os.path.realpath(path) in included or not scene.has_shape:
            apart["fragment"] += 1
        else:
            old = re.match(r"\s*[01](\.|\s*$)", scene.version) is not None
            result.append((path, digest, "0.x" if old else "2-3", scene.own,
                           scene.missing + (["$name"] if scene.undefined else [])))
    kept = []
    for path, digest, kind, own, lacks in result:
        if lacks:
            apart["without data"] += 1
        elif digest in seen:
            apart["copy"] += 1
        else:
            seen.add(digest)
            kept.append((path, kind, own))
    return kept


def run(command, options):
    """Exit status, or "time-out"; output and errors."""
    def limit():
        resource.setrlimit(resource.RLIMIT_AS, (int(options.gib * (1 << 30)),) * 2)
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    try:
        done = subprocess.run(command, capture_output=True, timeout=options.seconds, preexec_fn=limit)
    except subprocess.TimeoutExpired:
        return "time-out", "", ""
    return done.returncode, done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")


def cause(line):
    """A problem without file, line, ids, numbers and what is known instead."""
    line = re.sub(r"^.*?:\d+: |^.*?\.\w+: ", "", line.strip(), count=1)
    line = re.sub(r"; (known (is|are)|give it|the first|it |they |a constant|the bsdf|a camera|the mask|its |middle|"
                  r"far_clip).*", "", line)
    line = re.sub(r' (id|name)="[^"]*"', lambda m: m.group(0) if m.group(1) == "name" else "", line)
    line = re.sub(r"(/[^ :]+)+", "FILE", line)
    return re.sub(r"[-+]?\d*\.?\d+(e[-+]?\d+)?", "N", line)[:150]


def opened(options, path):
    """One of "strictly", "leniently", "refused", "time-out", "crash"; and the causes."""
    status, output, errors = run([options.program, "info", path], options)
    if status == "time-out":
        return "time-out", ["time-out"]
    if status < 0:
        return "crash", ["signal %d" % -status]
    if status != 0:
        return "refused", [cause(errors.strip().splitlines()[-1].replace("error: ", "") if errors.strip() else "?")]
    lines = output.splitlines()
    begin = next((i for i, line in enumerate(lines) if line.startswith("problems ")), None)
    if begin is None:
        return "strictly", []
    return "leniently", [cause(line) for line in lines[begin + 1:]]


LOAD = """import sys, mitsuba as mi
mi.set_variant('scalar_rgb')
mi.set_log_level(mi.LogLevel.Error)
mi.load_file(sys.argv[1])"""


def percent(part, whole_number):
    return "%d (%.0f %%)" % (part, 100 * part / whole_number) if whole_number else "-"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folders", nargs="+")
    parser.add_argument("--seconds", type=float, default=60, help="for one file (default: 60)")
    parser.add_argument("--gib", type=float, default=8, help="of address space for one file (default: 8)")
    parser.add_argument("--most", type=int, default=0, help="files of a folder, evenly chosen (default: all)")
    parser.add_argument("--mitsuba", metavar="PYTHON", help="a Python that has Mitsuba 3")
    parser.add_argument("--causes", type=int, default=30, help="lines of causes (default: 30)")
    parser.add_argument("--list", metavar="FILE", help="a line for each file: kind, ours, Mitsuba's, path, causes")
    options = parser.parse_args()

    seen, files, folders_with, apart = set(), collections.Counter(), collections.defaultdict(set), collections.Counter()
    total, rows = collections.Counter(), []
    listing = open(options.list, "w") if options.list else None
    for folder in options.folders:
        name = os.path.basename(os.path.normpath(folder)).replace("+", "/")
        apart_here = collections.Counter()
        scenes = scenes_of(folder, seen, apart_here)
        if options.most and len(scenes) > options.most:
            apart_here["not chosen"] += len(scenes) - options.most
            scenes = [scenes[i * len(scenes) // options.most] for i in range(options.most)]
        apart.update(apart_here)
        counts = collections.Counter()
        for path, kind, own in scenes:
            verdict, causes = opened(options, path)
            theirs = ""
            if options.mitsuba and kind in ("0.x", "2-3"):
                theirs = "theirs" if run([options.mitsuba, "-c", LOAD, path], options)[0] == 0 else "not theirs"
            opens = verdict in ("strictly", "leniently")
            for group in ["all", kind] + (["plain"] if kind == "2-3" and not own else []) + (
                    ["theirs"] if theirs == "theirs" else []):
                counts[group] += 1
                counts[group, "strictly"] += verdict == "strictly"
                counts[group, "leniently"] += opens
            counts[verdict] += 1
            for each in set(causes):
                files[each] += 1
                folders_with[each].add(name)
            if listing:
                line = [kind, verdict, theirs, "own" if own else "plain", path, " | ".join(causes)]
                listing.write("\t".join(line) + "\n")
                listing.flush()
        total.update(counts)
        if scenes or sum(apart_here.values()):
            rows.append((name, counts, apart_here))
            print("%s: %d" % (name, len(scenes)), file=sys.stderr, flush=True)

    columns = ["repository", "scenes", "0.x", "2-3", "glTF, OBJ", "strictly", "leniently", "time-outs", "crashes",
               "set apart"]
    print("| " + " | ".join(columns) + " |\n|" + "---|" * len(columns))
    for name, counts, apart_here in rows + [("**all**", total, apart)]:
        if counts["all"] == 0:
            continue
        print("| %s | %d | %d | %d | %d | %d | %d | %d | %d | %d |" % (
            name, counts["all"], counts["0.x"], counts["2-3"], counts["glTF"] + counts["OBJ"],
            counts["all", "strictly"], counts["all", "leniently"], counts["time-out"], counts["crash"],
            sum(apart_here.values())))
    print("\nfolders with scenes: %d; set apart: %s\n" % (
        sum(counts["all"] > 0 for _, counts, _ in rows), ", ".join("%s %d" % pair for pair in apart.most_common())))
    print("| of | files | strictly | leniently |\n|---|---|---|---|")
    for group in ["all", "0.x", "2-3", "plain", "theirs", "glTF", "OBJ"]:
        if total[group]:
            print("| %s | %d | %s | %s |" % (group, total[group], percent(total[group, "strictly"], total[group]),
                                              percent(total[group, "leniently"], total[group])))
    print("\n| cause | files | repositories |\n|---|---|---|")
    for text, count in files.most_common(options.causes):
        print("| %s | %d | %d |" % (text.replace("|", "\\|"), count, len(folders_with[text])))


main()
