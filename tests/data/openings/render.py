"""render.py SCENE.xml NAME [SAMPLES]: what Mitsuba 3.9.1 makes of a scene, as two independent halves NAME-a.pfm and NAME-b.pfm of
that many samples per pixel each (4096), for ../reference/make_tiles.cpp."""

import sys

import mitsuba as mi

mi.set_variant("scalar_rgb")
scene = mi.load_file(sys.argv[1])
samples = int(sys.argv[3]) if len(sys.argv) > 3 else 4096
for half, seed in (("a", 1), ("b", 2)):
    image = mi.render(scene, spp=samples, seed=seed)
    mi.Bitmap(image).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False).write(f"{sys.argv[2]}-{half}.pfm")
