#!/usr/bin/env python3
"""trade.py PROGRAM [FILE]: sweeps every stock scene with `lightswitch sweep`, and writes what a second buys where.

FILE is docs/trade.md unless it is named. Options behind `--` go to the program, such as `-- --seconds 2`.
"""

import csv
import io
import math
import pathlib
import re
import subprocess
import sys

SCENES = ["cornell-box", "cornell-spheres", "cornell-sculpture", "still-life", "ajar-door", "furnace"]
HEAD = """# What a second buys

The error (relMSE) that each method leaves of each stock scene, at 128 x 128 pixels, by the time that it had; made by

```sh
{command}
```

on a shared virtual machine with two cores: absolute times depend on the machine, and what stands beside each other much less, since
methods take turns. Errors are means over {seeds} seeds, less the part of the reference's own noise; a dash is where a method has no image yet,
or where its error is lost in that noise (`<`). The best of a row is bold; two are bold where they differ by less than two standard
errors. [performance.md](performance.md#methods-at-equal-time) has longer runs on one thread.

A scene of one's own: `lightswitch sweep SCENE --report sweep.html` ([methods.md](methods.md)), or from code
(`sweep/sweep.hpp`):

```cpp
const std::vector<ls::Contender> methods{{ls::contender(scene, ls::PathTracerNee{{}}), ls::contender(scene, Mine{{}})}};
const ls::Sweep sweep = ls::sweep(methods, {{.seconds = 1}});
ls::save_report("sweep.html", ls::sweep_report("mine", sweep));
```
"""


def error_at(points, seconds):
    """Between two points, by a power of time; nothing before the first, and behind the last but for an iteration."""
    if not points or seconds < 0.999 * points[0]["seconds"]:
        return None
    for a, b in zip(points, points[1:]):
        if a["seconds"] <= seconds <= b["seconds"]:
            part = math.log(seconds / a["seconds"]) / math.log(b["seconds"] / a["seconds"])
            return a["error"] * (b["error"] / a["error"]) ** part, b
    last = points[-1]
    if seconds <= points[0]["seconds"]:
        return points[0]["error"], points[0]
    return (last["error"], last) if seconds < 1.25 * last["seconds"] else None


def sweep(program, scene, options):
    run = subprocess.run([program, "sweep", scene, "--csv", "-", *options], capture_output=True, text=True, check=True)
    curves = {}
    for row in csv.DictReader(io.StringIO(run.stdout)):
        point = {"seconds": float(row["seconds"]), "error": float(row["relmse"]), "resolved": row["resolved"] == "1",
                 "seeds": int(row["seeds"]), "spread": float(row["high"]) - float(row["low"])}
        curves.setdefault(row["method"], []).append(point)
    return curves, run.stderr


def table(curves, seconds):
    times = [seconds / 2**k for k in range(5, -1, -1)]
    cells, resolved = {}, {m: [p for p in c if p["resolved"]] for m, c in curves.items()}
    for k, time in enumerate(times):
        found = {m: e for m, c in resolved.items() if (e := error_at(c, time))}
        least = min((e[0] for e in found.values()), default=0)
        for m, (error, point) in found.items():
            # The standard error of the logarithm: of n seeds, the range is about sqrt(n) standard deviations.
            doubt = point["spread"] / point["seeds"] / point["error"]
            close = error == least or math.log(error / least) < 2 * math.sqrt(2) * doubt
            cells[m, k] = f"**{error:.3g}**" if close else f"{error:.3g}"
    lines = ["| seconds | " + " | ".join(f"`{m}`" for m in curves) + " |", "|---" * (len(curves) + 1) + "|"]
    for k, time in enumerate(times):
        if any((m, k) in cells for m in curves):
            row = []
            for m, c in curves.items():
                lost = not c[-1]["resolved"] and c[-1]["seconds"] <= 1.25 * time
                row.append(cells.get((m, k), "<" if lost else "-"))
            lines.append(f"| {time:.3g} | " + " | ".join(row) + " |")
    return "\n".join(lines)


def main():
    words = sys.argv[1:]
    options = words[words.index("--") + 1:] if "--" in words else []
    words = words[:words.index("--")] if "--" in words else words
    if not words:
        sys.exit(__doc__)
    file = pathlib.Path(words[1] if len(words) > 1 else pathlib.Path(__file__).parents[1] / "docs/trade.md")
    seconds = float(options[options.index("--seconds") + 1]) if "--seconds" in options else 0.25
    command = "bench/trade.py build/samples/lightswitch" + (" -- " + " ".join(options) if options else "")
    text, seeds = "", 4
    for scene in SCENES:
        curves, said = sweep(words[0], scene, options)
        seeds = curves["path"][0]["seeds"]
        best = re.search(r"^(Best: .*|No error .*)$", said, re.MULTILINE)
        reference = re.search(r"^Reference: .*$", said, re.MULTILINE)
        text += f"\n## {scene}\n\n{table(curves, seconds)}\n\n{best[1] if best else ''}\n\n{reference[0]}\n"
        print(scene, best[1] if best else "", flush=True)
    lines = []
    for line in (HEAD.format(command=command, seeds=seeds) + text).split("\n"):
        while len(line) > 150 and not line.startswith("|"):  # as the other pages are wrapped
            cut = line.rfind(" ", 0, 150)
            lines.append(line[:cut])
            line = line[cut + 1:]
        lines.append(line)
    file.write_text("\n".join(lines))
    print(f"wrote {file}")


if __name__ == "__main__":
    main()
