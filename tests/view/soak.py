"""soak.py PROGRAM [SECONDS [SEED]]: presses random keys in the window of `lightswitch view`, drags the mouse in it, resizes
it, opens scenes, for so long (600 s); then it closes the window.

Exit status: 0 when the program went on, its memory did not grow, and it ended with success. Meant for a program that was
built with sanitizers (-DLIGHTSWITCH_SANITIZE=address;undefined).
"""

import os
import random
import sys
import tempfile
import time

from display import Display

SCENES = ["cornell-box", "cornell-spheres", "cornell-sculpture", "still-life", "furnace", "no-such-scene"]
KEYS = ([str(i) for i in range(9)] + [f"shift+{i}" for i in range(10)] + [f"F{i}" for i in range(1, 12)] +
        ["p", "p", "x", "b", "v", "t", "c", "z", "h", "o", "n", "equal", "minus", "comma", "period", "Home", "Left", "Right",
         "Up", "Down", "question", "Escape", "Prior", "Next", "ctrl+c", "ctrl+shift+c", "w", "a", "s", "d", "q", "e"])


def resident(process):
    """Megabytes."""
    with open(f"/proc/{process.pid}/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE") / 1e6


def main():
    program = os.path.abspath(sys.argv[1])
    seconds = float(sys.argv[2]) if len(sys.argv) > 2 else 600
    dice = random.Random(int(sys.argv[3]) if len(sys.argv) > 3 else 1)
    display = Display()
    # The graphics driver is gone when leaks are looked for, so that nobody can tell its own from others. Growth is seen.
    display.environment.setdefault("ASAN_OPTIONS", "detect_leaks=0")
    actions, sizes = 0, []
    with tempfile.TemporaryDirectory() as directory:
        log = open(os.path.join(directory, "log"), "w+")
        process = display.start([program, "view", "cornell-box", "--size", "96x96", "--window", "1000x700"], cwd=directory,
                                stdout=log, stderr=log)
        display.wait_for_title(bool, 120)
        window = display.do("search", "--name", "^lightswitch").split("\n")[0]
        begin = time.monotonic()
        while time.monotonic() - begin < seconds and process.poll() is None:
            what = dice.random()
            if what < 0.7:
                display.key(*dice.choices(KEYS, k=dice.randint(1, 4)))
            elif what < 0.9:
                x, y = dice.randint(0, 990), dice.randint(0, 690)
                button = dice.choice([1, 1, 2, 3, 4, 5])
                display.do("mousemove", x, y, "mousedown", button)
                for _ in range(dice.randint(0, 6)):
                    display.do("mousemove_relative", "--", dice.randint(-60, 60), dice.randint(-60, 60))
                display.do("mouseup", button)
            elif what < 0.91:
                display.do("keydown", "ctrl", "click", "--repeat", 100, "--delay", 1, dice.choice([4, 5]), "keyup", "ctrl")
            elif what < 0.94:
                display.do("windowsize", window, dice.randint(40, 1280), dice.randint(40, 800))
            elif what < 0.97:
                display.key("Escape", "ctrl+o")
                time.sleep(0.5)
                display.do("type", dice.choice(SCENES))
                display.key("Return")
            else:
                # Saving needs only a key, and what was there is not replaced.
                display.key("Escape", dice.choice(["ctrl+s", "ctrl+e", "ctrl+r"]))
                time.sleep(0.5)
                display.key("Return", "Escape")
                for name in os.listdir(directory):
                    if name != "log":
                        os.remove(os.path.join(directory, name))
            actions += 1
            time.sleep(dice.random() * 0.1)
            if actions % 20 == 0:
                sizes.append(resident(process))
        alive = process.poll() is None
        display.key("Escape", "Escape")
        process.terminate() if not alive else display.key("ctrl+q")
        try:
            status = process.wait(timeout=60)
        except Exception:  # it asks whether to close
            display.key("Escape")
            process.kill()
            status = "killed"
        log.flush()
        log.seek(0)
        output = log.read()
    display.close()
    # The first minutes fill caches; after that the largest size of a third says whether it grows.
    third = max(len(sizes) // 3, 1)
    middle, last = max(sizes[third:2 * third], default=0), max(sizes[2 * third:], default=0)
    print(f"{actions} actions in {time.monotonic() - begin:.0f} s, alive {alive}, status {status}; resident at most "
          f"{max(sizes[:third], default=0):.0f}, {middle:.0f}, {last:.0f} MB in the three thirds")
    bad = "ERROR" in output or "runtime error" in output
    if bad or not alive:
        print(output[-6000:])
    return 0 if alive and not bad and last < 1.3 * middle + 50 else 1


sys.exit(main())
