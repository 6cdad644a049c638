"""window.py PROGRAM: uses the window of `lightswitch view` on a display of its own, with keys and mouse.

Exit status: 0 when all holds, 1 when not, 77 when Xvfb or xdotool are missing. With a second argument, a directory, it
leaves pictures of the screen there. `window.py PROGRAM --long` tests what takes a minute. `window.py PROGRAM --picture
docs/window.png` makes the picture of the README.
"""

import json
import os
import re
import subprocess
import sys
import tempfile
import time
import zlib

from display import Display, color, write_png
from x11 import X11

HERE = os.path.dirname(os.path.abspath(__file__))
CBOX = os.path.join(HERE, "..", "data", "cbox", "cbox.xml")
METHODS = ["silhouette", "phong", "path", "path-nee", "light", "bdpt", "photon", "vcm", "mlt", "path-guided"]
VIEWS = ["image", "side by side", "split", "flicker", "difference", "relative difference", "significance", "albedo",
         "normal", "depth"]
LINE = (255, 210, 80)  # of the split view
failures = []


def check(condition, what):
    if not condition:
        failures.append(what)
        print("FAILED:", what, flush=True)


def read_png(path):
    """Rows of (red, green, blue)."""
    with open(path, "rb") as file:
        data = file.read()
    width, height = int.from_bytes(data[16:20], "big"), int.from_bytes(data[20:24], "big")
    packed, at = b"", 8
    while at < len(data):
        length, kind = int.from_bytes(data[at:at + 4], "big"), data[at + 4:at + 8]
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    raw, stride, rows, last = zlib.decompress(packed), 3 * width, [], bytes(3 * width)
    for y in range(height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            a, b, c = (row[i - 3] if i >= 3 else 0), last[i], (last[i - 3] if i >= 3 else 0)
            nearest = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            row[i] = (row[i] + [0, a, b, (a + b) // 2, nearest][kind]) & 255
        rows.append([tuple(row[3 * x:3 * x + 3]) for x in range(width)])
        last = row
    return rows


class Window:
    """The program on a display, in a directory where it may write."""

    def __init__(self, display, program, directory, *arguments):
        self.display, self.directory = display, directory
        self.stats = os.path.join(directory, "stats.json")
        if os.path.exists(self.stats):
            os.remove(self.stats)
        self.log = open(os.path.join(directory, "output.txt"), "w+")
        self.process = display.start([program, "view", *arguments, "--stats", self.stats, "--window", "900x600"],
                                     cwd=directory, stdout=self.log, stderr=subprocess.STDOUT)
        self.wait("")

    def wait(self, text, seconds=60):
        try:
            return self.display.wait_for_title(lambda title: text in title, seconds)
        except AssertionError as error:
            raise AssertionError(f"{error}, waiting for {text!r}; the program printed: {self.output()}") from None

    def settle(self):
        """Until what keys have done can be seen."""
        time.sleep(0.7)

    def output(self):
        self.log.flush()
        with open(self.log.name) as file:
            return file.read()

    def save(self, keys, ending):
        """Saves under the name that is proposed; returns the new file."""
        before = set(os.listdir(self.directory))
        self.display.key(keys)
        self.settle()
        self.display.key("Return")
        end = time.monotonic() + 20
        while time.monotonic() < end:
            new = [name for name in set(os.listdir(self.directory)) - before if name.endswith(ending)]
            if new:
                self.settle()
                return os.path.join(self.directory, new[0])
            time.sleep(0.05)
        raise AssertionError(f"{keys} wrote no {ending}")

    def quit(self):
        self.display.key("ctrl+q")
        check(self.process.wait(timeout=30) == 0, "the program ends with success")
        with open(self.stats) as file:
            return json.load(file)


def run(program, *arguments):
    return subprocess.run([program, *arguments], capture_output=True, text=True)


def largest_difference(program, a, b):
    result = run(program, "compare", a, b)
    check(result.returncode == 0, "images can be compared: " + result.stderr)
    found = re.search(r"max \|A - B\|\s+(\S+)", result.stdout)
    return found and float(found.group(1))


def check_methods(program, display, directory, pictures):
    window = Window(display, program, directory, CBOX, "--size", "60x60", "--spp", "4", "--exposure", "1")
    window.wait("path-nee, 4 samples, image")
    window.settle()

    # The image of so many samples is the one that render makes, and a picture of it has the same bytes.
    exr, png = window.save("ctrl+e", ".exr"), window.save("ctrl+s", ".png")
    reference, picture = os.path.join(directory, "render.exr"), os.path.join(directory, "render.png")
    rendered = run(program, "render", CBOX, "--size", "60x60", "--spp", "4", "--exposure", "1", "--output", reference,
                   "--output", picture)
    check(rendered.returncode == 0, "render works: " + rendered.stderr)
    check(largest_difference(program, exr, reference) == 0, "the saved image is what render makes, bit for bit")
    with open(png, "rb") as a, open(picture, "rb") as b:
        check(a.read() == b.read(), "the saved picture is what render makes")

    # What is on the screen is that picture, enlarged: in the middle row its runs of equal colours follow each other.
    display.key("h")
    window.settle()
    width, height, rows = display.pixels()
    wanted = read_png(picture)
    shown = [color(rows, x, 300) for x in range(900)]
    found = any(run_of(wanted[y], shown) for y in range(25, 35))
    check(found, "the screen shows the picture's colours")
    display.key("h")

    # Every key has its method at once, and what was made stays.
    for i, name in enumerate(METHODS):
        begin = time.monotonic()
        display.key(str(i))
        window.wait(f" {name}, ")
        check(time.monotonic() - begin < 5, f"the window switches to {name} at once")
        window.wait(f" {name}, 4 samples")
    display.key("3")
    window.wait("path-nee,")
    check("4 samples" in display.title(), "switching back loses nothing: " + display.title())

    # A file that exists is not proposed again, nor overwritten.
    again = window.save("ctrl+s", ".png")
    check(again != png and os.path.exists(again), "another name is proposed")

    # Keys that fly do not when they were pressed with Control, though that is let go of first.
    display.do("keydown", "ctrl", "keydown", "s")
    window.settle()
    display.do("keyup", "ctrl")
    window.settle()
    display.key("Escape")
    window.settle()
    display.do("keyup", "s")
    window.settle()
    check("4 samples" in display.title(), "saving does not move the camera: " + display.title())
    stats = window.quit()
    check(set(stats["methods"]) == set(METHODS), "the numbers tell of all methods")
    check(all(m["samples_per_pixel"] == 4 for m in stats["methods"].values()), "each of them rested after 4 samples")


def run_of(wanted, shown):
    """Whether the colours of `wanted`, each repeated some times, are somewhere in `shown`."""
    def squeeze(colors):
        return [c for i, c in enumerate(colors) if i == 0 or c != colors[i - 1]]
    wanted, shown = squeeze(wanted)[5:-5], squeeze(shown)
    return any(shown[i:i + len(wanted)] == wanted for i in range(len(shown) - len(wanted) + 1))


def check_views(program, display, directory, pictures):
    window = Window(display, program, directory, "cornell-spheres", "--size", "48x48", "--spp", "64", "--method", "light")
    window.wait("light, 64 samples")
    display.key("F6")
    window.settle()
    check("image" in display.title(), "without a reference there is no difference")
    display.key("shift+3")
    for i, view in enumerate(VIEWS):
        display.key(f"F{i + 2}")
        window.wait(view)
        window.settle()
        if view.startswith("diff"):
            time.sleep(3)  # both images
        if pictures:
            width, height, rows = display.pixels()
            write_png(os.path.join(pictures, view.replace(" ", "-") + ".png"), rows[:600], 900)
        if view == "difference":
            # path-nee sees what is in mirrors and through glass, light does not: blue is where light has less.
            width, height, rows = display.pixels()
            colors = [color(rows, x, y) for y in range(40, 500, 3) for x in range(0, 540, 3)]
            check(sum(b > 150 and r < 110 for r, g, b in colors) > 200, "the difference is blue where light has less")
            check(sum(min(c) > 230 for c in colors) > 1000, "and white where there is none")

    # The line of the split view is where the mouse has put it.
    def line_column():
        width, height, rows = display.pixels()
        return [x for x in range(560) if all(color(rows, x, y) == LINE for y in (100, 250, 400))]
    display.key("F4")
    display.do("mousemove", 20, 300)
    window.settle()
    before = line_column()
    check(before and 260 < before[0] < 300, f"the line is in the middle at first: {before}")
    display.do("mousemove", before[0] if before else 280, 300)
    window.settle()
    display.do("mousedown", 1)
    window.settle()
    for x in range(270, 139, -10):
        display.do("mousemove", x, 300)
        time.sleep(0.02)
    window.settle()
    display.do("mouseup", 1)
    window.settle()
    after = line_column()
    check(after and abs(after[0] - 140) <= 3, f"the line follows the mouse: {after}")

    # A pixel is picked with a click, and large after turning the wheel.
    display.key("F2")
    display.do("mousemove", 280, 300)
    window.settle()
    for _ in range(8):
        display.do("click", 4)
        time.sleep(0.05)
    display.do("click", 1)
    window.settle()
    width, height, rows = display.pixels()
    check(any(color(rows, x, 300) == LINE or color(rows, 280, x) == LINE for x in range(30, 560)), "a picked pixel is marked")
    if pictures:
        write_png(os.path.join(pictures, "zoomed.png"), rows[:600], 900)

    # Help, and away with it.
    plain = display.pixels()[2]
    display.key("question")
    window.settle()
    with_help = display.pixels()[2]
    check(with_help != plain, "? shows the keys")
    if pictures:
        write_png(os.path.join(pictures, "help.png"), with_help[:600], 900)
    display.key("Escape")

    # The verdict comes by itself; light lacks what is seen in mirrors, so it is about the rest or undecided.
    window.quit()


def check_camera(program, display, directory, pictures):
    window = Window(display, program, directory, CBOX, "--size", "40x40", "--spp", "8")
    window.wait("8 samples")
    window.settle()
    for keys in ("Right", "Up", "period"):
        display.key(keys)
    display.do("mousemove", 280, 300)
    window.settle()
    display.do("mousedown", 3)
    for x in range(280, 300, 4):
        display.do("mousemove", x, 305)
        time.sleep(0.05)
    display.do("mouseup", 3)
    window.wait("8 samples")
    window.settle()
    window.wait("8 samples")
    exr = window.save("ctrl+e", ".exr")
    display.key("ctrl+c")
    display.key("ctrl+shift+c")
    window.settle()
    window.quit()
    output = window.output()
    sensor = re.search(r"<sensor.*</sensor>", output, re.DOTALL)
    check(sensor is not None, "the camera is printed")
    check("lightswitch::CameraDescription camera{" in output, "as C++, too")
    with open(CBOX) as file:
        scene = file.read()
    moved = re.sub(r"<sensor.*</sensor>", sensor.group(0) if sensor else "", scene, flags=re.DOTALL)
    os.mkdir(os.path.join(directory, "moved"))
    path = os.path.join(directory, "moved", os.path.basename(CBOX))  # images of other scenes are not compared
    with open(path, "w") as file:
        file.write(moved)
    rendered = os.path.join(directory, "moved.exr")
    result = run(program, "render", path, "--path", os.path.dirname(CBOX), "--spp", "8", "--output", rendered)
    check(result.returncode == 0, "the copied camera can be read: " + result.stderr)
    check(largest_difference(program, exr, rendered) == 0, "the copied camera is the window's, bit for bit")
    original = os.path.join(directory, "original.exr")
    run(program, "render", CBOX, "--size", "40x40", "--spp", "8", "--output", original)
    refused = run(program, "compare", exr, original)
    check(refused.returncode == 2 and "camera" in refused.stderr, "it is not the scene's own camera")


def check_scenes(program, display, directory, pictures):
    window = Window(display, program, directory)  # without a scene
    display.key("3")
    display.key("ctrl+o")
    window.settle()
    display.do("type", "no-such-scene")
    display.key("Return")
    window.settle()
    display.key("ctrl+o")
    window.settle()
    display.do("type", "furnace")
    display.key("Return")
    window.wait("furnace: path-nee")
    display.key("ctrl+o")
    window.settle()
    display.do("type", CBOX)
    display.key("Return")
    window.wait("cbox.xml: path-nee")
    check(window.process.poll() is None, "the program goes on")
    drop(display, copy_of_box(directory))
    window.wait("a copy.xml: path-nee")
    window.quit()

    nowhere = dict(os.environ)
    nowhere.pop("DISPLAY", None)
    nowhere.pop("WAYLAND_DISPLAY", None)
    result = subprocess.run([program, "view", "furnace"], env=nowhere, capture_output=True, text=True)
    check(result.returncode == 2 and "display" in result.stderr, "without a display there is an error: " + result.stderr)
    result = subprocess.run([program, "view", "furnace", "--method", "pth"], env=nowhere, capture_output=True, text=True)
    check(result.returncode == 2 and "path" in result.stderr, "a method that is not there is an error")


def copy_of_box(directory):
    """A scene file with a space in its name; the part of a URI that leads to it."""
    with open(CBOX) as original, open(os.path.join(directory, "a copy.xml"), "w") as copy:
        copy.write(original.read().replace("meshes/", os.path.join(os.path.dirname(os.path.abspath(CBOX)), "meshes/")))
    return os.path.join(directory, "a%20copy.xml")


def drop(display, file):
    x11 = X11(display.environment["DISPLAY"])
    x11.drop(int(display.do("search", "--name", "^lightswitch")), file)
    x11.close()


def check_dense_screen(program, display, directory, pictures):
    """Twice as many pixels per inch: all is twice as large, and the mouse is where it points."""
    x11 = X11(display.environment["DISPLAY"])
    x11.set_dots_per_inch(192)
    window = Window(display, program, directory, CBOX, "--size", "60x60", "--spp", "4")
    window.wait("4 samples")
    display.do("mousemove", 500, 600)
    window.settle()
    display.do("click", 1)
    window.settle()
    width, height, rows = display.pixels()
    x11.close()
    if pictures:
        write_png(os.path.join(pictures, "dense-screen.png"), rows, width)
    check(any(color(rows, x, 1190) != (0, 0, 0) for x in range(1800)), "the window is twice as high")
    check(all(color(rows, x, 1150) == (0, 0, 0) for x in range(1805, width)), "and twice as wide, not more")
    bar = next(y for y in range(4, 100) if color(rows, 1700, y) != color(rows, 1700, 4))
    check(30 <= bar <= 50, f"so is the menu bar: {bar} pixels")
    marks = [x for x in range(1100) if color(rows, x, 600) in (LINE, (0, 0, 0)) and color(rows, x, 606) in (LINE, (0, 0, 0))]
    check(any(abs(x - 500) < 22 for x in marks), f"the pixel under the mouse is marked: {marks}")
    window.quit()


def check_unsaved(program, display, directory, pictures):
    """What took longer than half a minute is not lost unasked. (Long.)"""
    window = Window(display, program, directory, "furnace", "--size", "32x32")
    time.sleep(35)
    drop(display, copy_of_box(directory))
    window.settle()
    if pictures:
        width, height, rows = display.pixels()
        write_png(os.path.join(pictures, "not-saved.png"), rows[:600], 900)
    display.key("Escape")
    time.sleep(2)
    check("furnace: " in display.title(), "another scene does not take the place of images: " + display.title())
    display.key("ctrl+q")
    window.settle()
    check(window.process.poll() is None, "nor is the window closed")
    display.key("Escape")
    window.settle()
    window.save("ctrl+e", ".exr")
    drop(display, copy_of_box(directory))
    window.wait("a copy.xml: ")
    window.quit()


def make_picture(program, display, path):
    """The picture of the README: two methods side by side, after a while."""
    with tempfile.TemporaryDirectory() as directory:
        process = display.start([program, "view", "cornell-spheres", "--size", "512x512", "--method", "vcm", "--against",
                                 "path-nee", "--window", "1280x800"], cwd=directory)
        display.wait_for_title(bool)
        for method in ("8", "5", "7"):
            time.sleep(6)
            display.key(method)
        display.key("F4")
        time.sleep(30)
        display.do("mousemove", 640, 790)
        time.sleep(1)
        width, height, rows = display.pixels()
        write_png(path, rows, width)
        process.terminate()
        process.wait()


def main():
    program = os.path.abspath(sys.argv[1])
    if len(sys.argv) == 4 and sys.argv[2] == "--picture":
        display = Display()
        make_picture(program, display, sys.argv[3])
        display.close()
        return 0
    pictures = sys.argv[2] if len(sys.argv) > 2 else None
    missing = Display.missing()
    if missing:
        print("skipped: no", " and no ".join(missing))
        return 77
    parts = (check_methods, check_views, check_camera, check_scenes, check_dense_screen)
    if pictures == "--long":
        parts, pictures = (check_unsaved,), None
    for part in parts:
        display = Display(2000, 1300)
        try:
            with tempfile.TemporaryDirectory() as directory:
                part(program, display, directory, pictures)
        except (AssertionError, subprocess.TimeoutExpired, OSError) as error:
            check(False, f"{part.__name__}: {error}")
        finally:
            display.close()
    print(f"{len(failures)} failures")
    return 1 if failures else 0


sys.exit(main())
