"""make_serialized.py: writes two.serialized (version 4) and old.serialized (version 3) beside it, and checks that Mitsuba reads them
as they are meant."""

import pathlib
import struct
import zlib

import mitsuba as mi
import numpy as np

here = pathlib.Path(__file__).parent
quad = [(0, 0, 0), (2, 0, 0), (2, 3, 0), (0, 3, 0.5)]
normals = [(0, 0, 1), (0, 0.6, 0.8), (0.6, 0, 0.8), (0, 0, 1)]
uvs = [(0, 0), (1, 0), (1, 0.25), (0, 0.25)]
colors = [(1, 0, 0)] * 4
triangles = [(0, 1, 2), (0, 2, 3)]
tip = [(0, 0, 0), (1, 0, 0), (0, 1e-9, 1)]


def mesh(version, flags, real, arrays, faces, name=b"name"):
    body = struct.pack("<I", flags) + (name + b"\0" if version == 4 else b"") + struct.pack("<QQ", len(arrays[0]), len(faces))
    for array in arrays:
        body += b"".join(struct.pack(f"<{len(v)}{real}", *v) for v in array)
    body += b"".join(struct.pack("<3I", *face) for face in faces)
    return struct.pack("<HH", 0x041C, version) + zlib.compress(body, 9)


def file(name, version, meshes):
    offsets = np.cumsum([0] + [len(m) for m in meshes])[:-1]
    table = b"".join(struct.pack("<Q" if version == 4 else "<I", o) for o in offsets) + struct.pack("<I", len(meshes))
    (here / name).write_bytes(b"".join(meshes) + table)


for name, version in (("two.serialized", 4), ("old.serialized", 3)):
    file(name, version, [mesh(version, 0x100B, "f", [quad, normals, uvs, colors], triangles),
                         mesh(version, 0x2000, "d", [tip], [(0, 1, 2)])])

mi.set_variant("scalar_rgb")
for name in ("two.serialized", "old.serialized"):
    for index, positions, faces in ((0, quad, triangles), (1, tip, [(0, 1, 2)])):
        read = mi.traverse(mi.load_dict({"type": "serialized", "filename": str(here / name), "shape_index": index}))
        assert np.array_equal(np.float32(positions).ravel(), read["vertex_positions"])
        assert np.array_equal(np.ravel(faces), read["faces"])
        if index == 0:
            assert np.allclose(np.ravel(normals), read["vertex_normals"], atol=1e-6)
            assert np.array_equal(np.float32(uvs).ravel(), read["vertex_texcoords"])
    print(f"{name}: Mitsuba {mi.__version__} reads it as meant")
