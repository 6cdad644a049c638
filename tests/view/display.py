"""A display of its own (Xvfb) with one program in it, its keys, its mouse and its pixels."""

import os
import shutil
import struct
import subprocess
import tempfile
import time


class Display:
    """Runs Xvfb; `pixels()` reads the screen, `key` and the others drive what is on it (xdotool)."""

    def __init__(self, width=1280, height=800):
        self.directory = tempfile.mkdtemp(prefix="lightswitch-display-")
        reading, writing = os.pipe()
        # Without -noreset the server begins anew when its last client leaves, such as an xdotool that looks whether the
        # window is there yet, and turns away a program that comes in that moment.
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(writing), "-screen", "0", f"{width}x{height}x24", "-nolisten", "tcp", "-noreset",
             "-fbdir", self.directory], pass_fds=[writing], stderr=subprocess.DEVNULL)
        os.close(writing)
        with os.fdopen(reading) as numbers:
            number = numbers.readline().strip()
        if not number:
            raise RuntimeError("Xvfb did not start")
        self.environment = dict(os.environ, DISPLAY=":" + number)

    @staticmethod
    def missing():
        """What has to be installed, or an empty list."""
        return [program for program in ("Xvfb", "xdotool") if not shutil.which(program)]

    def close(self):
        self.server.terminate()
        self.server.wait()
        shutil.rmtree(self.directory, ignore_errors=True)

    def start(self, command, **more):
        return subprocess.Popen(command, env=self.environment, **more)

    def do(self, *arguments):
        result = subprocess.run(["xdotool", *map(str, arguments)], env=self.environment, capture_output=True, text=True)
        return result.stdout.strip()

    def key(self, *names):
        self.do("key", *names)

    def title(self):
        """Of the window, or an empty text as long as there is none."""
        return self.do("search", "--name", "^lightswitch", "getwindowname").split("\n")[0]

    def wait_for_title(self, condition, seconds=60):
        """The first title that meets the condition."""
        end = time.monotonic() + seconds
        title = ""
        while time.monotonic() < end:
            title = self.title()
            if title and condition(title):
                return title
            time.sleep(0.02)
        raise AssertionError(f"the title stays {title!r}")

    def pixels(self):
        """(width, height, rows): rows of bytes, four for each pixel: blue, green, red, and one more."""
        with open(os.path.join(self.directory, "Xvfb_screen0"), "rb") as file:
            data = file.read()
        header = struct.unpack(">25I", data[:100])
        begin = header[0] + 12 * header[19]
        width, height, stride = header[4], header[5], header[12]
        return width, height, [data[begin + y * stride:begin + (y + 1) * stride] for y in range(height)]


def color(rows, x, y):
    """Red, green, blue."""
    b, g, r = rows[y][4 * x:4 * x + 3]
    return r, g, b


def write_png(path, rows, width):
    """For looking at it."""
    import zlib
    raw = b"".join(b"\0" + bytes(c for x in range(width) for c in color(rows, x, y)) for y in range(len(rows)))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, len(rows), 8, 2, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(raw, 6)) + chunk(b"IEND", b""))
