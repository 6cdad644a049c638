#!/usr/bin/env python3
"""Renders public scenes that may be shown, and puts them on one sheet.

    bench/gallery.py [OPTION...] PROGRAM FOLDER OUTPUT.png

PROGRAM is the program lightswitch. FOLDER holds checkouts of the repositories that docs/gallery.md names, each called
OWNER+NAME; the scenes' files are no part of this project. Pictures stand row by row in the order of that table. Each is
rendered with path-nee, or the method named below, and shown at its automatic exposure; notices and stand-ins are
printed."""
import argparse
import os
import struct
import subprocess
import sys
import tempfile
import zlib

COLUMNS, GAP = 3, 6
# File below FOLDER, how many times as many samples it gets, and options of its own.
SCENES = [
    ("SojeongKim-42+denoising-nerf/scenes/staircase/scene.xml", 4, []),
    ("hchoi405+dppm-scenes/scenes/living-room/scene.xml", 8, []),
    ("niklassanden+ReSTIR_GI_DR/scenes/staircase2/scene.xml", 4, []),
    ("hchoi405+dppm-scenes/scenes/classroom/scene.xml", 8, []),
    ("takkasila+practical_path_guiding_lab/scenes/veach-bidir/scene.xml", 4, ["--method", "bdpt"]),
    ("takkasila+practical_path_guiding_lab/scenes/veach-mis/scene.xml", 2, []),
    ("KhronosGroup+glTF-Tutorials/AddingMaterialExtensions/samples/GlassHurricaneCandleHolder_Green.gltf", 4, []),
    ("SaschaWillems+Vulkan-Assets/models/retroufo.gltf", 1, []),
    ("BabylonJS+MeshesLibrary/vintageDeskFan/vintageFan_animated.gltf", 1, []),
    ("webgltf+webgltf-sample-models/models/Barrel/glTF-Binary/barrel.glb", 1, []),
    ("BabylonJS+MeshesLibrary/seagulf.glb", 1, []),
    ("BabylonJS+MeshesLibrary/Marble/marbleTower/marbleTower.gltf", 1, []),
]


def read_png(path):
    """Width, height and rows of bytes of an 8-bit RGB file without interlacing."""
    with open(path, "rb") as file:
        data = file.read()
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, color, _, _, interlaced = struct.unpack(">IIBBBBB", body)
            assert (depth, color, interlaced) == (8, 2, 0), path
        packed += body if kind == b"IDAT" else b""
        at += length + 12
    raw, size = zlib.decompress(packed), 3 * width
    rows, above = [], bytearray(size)
    for y in range(height):
        begin = y * (size + 1)
        kind, row = raw[begin], bytearray(raw[begin + 1:begin + 1 + size])
        for i in range(size):
            left, corner = (row[i - 3], above[i - 3]) if i >= 3 else (0, 0)
            row[i] = (row[i] + predicted(kind, left, above[i], corner)) & 255
        rows.append(row)
        above = row
    return width, height, rows


def predicted(kind, left, up, corner):
    """What PNG's filter of that number takes a byte for."""
    if kind == 4:
        nearest = left + up - corner
        return min((left, up, corner), key=lambda value: abs(nearest - value))
    return (0, left, up, (left + up) // 2)[kind]


def write_png(path, width, rows):
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    raw, above = bytearray(), bytearray(3 * width)
    for row in rows:
        # The filter whose bytes are smallest in sum, as PNG's specification advises.
        tries = []
        for kind in range(5):
            line = bytearray()
            for i in range(len(row)):
                left, corner = (row[i - 3], above[i - 3]) if i >= 3 else (0, 0)
                line.append((row[i] - predicted(kind, left, above[i], corner)) & 255)
            tries.append((sum(min(value, 256 - value) for value in line), kind, bytes(line)))
        _, kind, line = min(tries)
        raw += bytes([kind]) + line
        above = row
    header = struct.pack(">IIBBBBB", width, len(rows), 8, 2, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(raw), 9)) +
                   chunk(b"IEND", b""))


def sheet(pictures, width, height):
    """Rows of bytes of the pictures (each a list of rows) in a grid with white gaps."""
    full = COLUMNS * width + (COLUMNS - 1) * GAP
    rows = []
    for first in range(0, len(pictures), COLUMNS):
        if first:
            rows += [bytearray(b"\xff" * (3 * full)) for _ in range(GAP)]
        group = pictures[first:first + COLUMNS]
        for y in range(height):
            row = bytearray((b"\xff" * (3 * GAP)).join(bytes(picture[y]) for picture in group))
            rows.append(row + b"\xff" * (3 * full - len(row)))
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("output")
    parser.add_argument("--size", default="360x240", metavar="WxH", help="of each picture (default: 360x240)")
    parser.add_argument("--spp", type=int, default=64, help="samples per pixel (default: 64)")
    options = parser.parse_args()
    width, height = map(int, options.size.split("x"))
    pictures = []
    with tempfile.TemporaryDirectory() as folder:
        for scene, times, extra in SCENES:
            picture = os.path.join(folder, "picture.png")
            command = [options.program, "render", os.path.join(options.folder, scene), "--lenient",
                       "--size", options.size, "--spp", str(times * options.spp), "--exposure", "auto",
                       "--output", picture] + extra
            print(scene, file=sys.stderr, flush=True)
            subprocess.run(command, check=True)
            pictures.append(read_png(picture)[2])
    write_png(options.output, COLUMNS * width + (COLUMNS - 1) * GAP, sheet(pictures, width, height))


if __name__ == "__main__":
    main()
