#!/usr/bin/env python3
"""Writes every section of a folder in other ways, meshes all of them, and compares the areas.

    airfoil_ways.py EXE FOLDER [--base EXE] [--keep DIR] [--tolerance T] [--threads N]

FOLDER holds Selig files (`.dat`), for instance the database of PyPI's aerosandbox. The ways are: lednicer (counts, then either surface
from the nose), index (a column that counts the points), mm (a chord of 120), percent, together (columns run together by minus signs;
ordinates are moved below zero for that, which leaves the area) and reversed (clockwise). Every way is meshed by `EXE batch --far-field 0`;
its area over that of the file as it is must be 1 to T [1e-6]. With --base the files as they are are also meshed by an older program, and
areas must agree to 1e-9. One line per file that does not; exit 0 only if there is none. Standard library only.
"""
import argparse
import json
import math
import os
import re
import subprocess
import sys
import tempfile

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
PAIR = re.compile(r"^\s*\(?(%s)\)?[\s,]+\(?(%s)\)?\s*$" % (NUMBER, NUMBER))


def points_of(path):
    """The longest run of lines of two numbers, as texts; None where another run could belong to it."""
    runs, run = [], []
    for line in open(path, encoding="latin-1"):
        pair = PAIR.match(line)
        if pair:
            run.append(pair.groups())
        elif line.strip():
            runs.append(run)
            run = []
    runs = sorted(runs + [run], key=len)
    if len(runs[-1]) < 5 or len(runs) > 1 and len(runs[-2]) > 2:
        return None
    return runs[-1]


def is_contour(points):
    x = [float(p[0]) for p in points]
    wide = max(x) - min(x)
    return wide > 0 and abs(wide - 1) < 0.1 and abs(x[0] - x[-1]) < 0.1 and min(x[0], x[-1]) > min(x) + 0.75 * wide


def shifted(number, by):
    """A decimal text times 10^by, exactly."""
    return repr(float("%se%d" % (number, by))) if "e" not in number.lower() else repr(float(number) * 10.0 ** by)


def ways(points):
    """(name, text, area factor) of each."""
    far = [float(x) for x, _ in points]
    tail = (float(points[0][0]) + float(points[-1][0])) / 2, (float(points[0][1]) + float(points[-1][1])) / 2
    nose = max(range(len(points)), key=lambda i: math.dist((far[i], float(points[i][1])), tail))
    upper, lower = points[nose::-1], points[nose:]
    rows = lambda ps: "".join("%s %s\n" % p for p in ps)
    yield "lednicer", "Section\n %d. %d.\n\n%s\n%s" % (len(upper), len(lower), rows(upper), rows(lower)), 1
    yield "index", "Section\n" + "".join("%d\t%s\t%s\n" % (i + 1, x, y) for i, (x, y) in enumerate(points)), 1
    mm = [(repr(120 * float(x)), repr(120 * float(y))) for x, y in points]
    yield "mm", "Section, mm\n" + rows(mm), 120 ** 2
    yield "percent", "Section\n" + rows([(shifted(x, 2), shifted(y, 2)) for x, y in points]), 1
    below = max(float(y) for _, y in points) + 0.01
    yield "together", "Section\n" + "".join("%.9f%.9f\n" % (float(x), float(y) - below) for x, y in points), 1
    yield "reversed", "Section\n" + rows(points[::-1]), 1


def areas(exe, folder, out, threads):
    """Area, or the reason of the refusal, by the stem of the file."""
    command = [exe, "batch", folder, "--out-dir", out, "--format", "vtu", "--reports", "--far-field", "0", "--timeout", "20", "--quiet"]
    subprocess.run(command + ["--threads", str(threads)], stdout=subprocess.DEVNULL)
    found = {}
    for name in sorted(os.listdir(out)):
        if name.endswith(".report.json"):
            report = json.load(open(os.path.join(out, name), encoding="utf-8"))
            area = (report.get("quality") or {}).get("exact_measure")
            found[name[: -len(".report.json")]] = (report.get("failure") or {}).get("what", "no mesh") if area is None else area
    return found


def differs(a, b, tolerance):
    if isinstance(a, float) and isinstance(b, float):
        return abs(a - b) > tolerance * abs(b)
    return isinstance(a, float) != isinstance(b, float)


def main():
    p = argparse.ArgumentParser()
    p.add_argument("exe")
    p.add_argument("folder")
    p.add_argument("--base", metavar="EXE", help="an older program")
    p.add_argument("--keep", metavar="DIR", help="where the files go that are written")
    p.add_argument("--tolerance", type=float, default=1e-6, metavar="T")
    p.add_argument("--threads", type=int, default=1, metavar="N")
    a = p.parse_args()
    wrong = 0
    with tempfile.TemporaryDirectory() as tmp:
        place = a.keep or tmp
        known = areas(a.exe, a.folder, os.path.join(place, "as_they_are"), a.threads)
        if a.base:
            before = areas(a.base, a.folder, os.path.join(place, "base"), a.threads)
            changed = [n for n in before if differs(known.get(n), before[n], 1e-9)]
            for n in changed:
                print("%s: %s, was %s" % (n, known.get(n), before[n]))
            print("base: %d sections, %d differ by more than 1e-9" % (len(before), len(changed)), flush=True)
            wrong += len(changed)
        factors, left_out = {}, 0
        for stem, area in known.items():
            points = points_of(os.path.join(a.folder, stem + ".dat")) if isinstance(area, float) else None
            if not points or not is_contour(points):
                left_out += 1
                continue
            for way, text, factor in ways(points):
                folder = os.path.join(place, way)
                os.makedirs(folder, exist_ok=True)
                with open(os.path.join(folder, stem + ".dat"), "w", encoding="utf-8") as f:
                    f.write(text)
                factors[way] = factor
        print("%d sections as they are; %d of them are written in no other way" % (len(known), left_out), flush=True)
        for way, factor in factors.items():
            found = areas(a.exe, os.path.join(place, way), os.path.join(place, way + "_out"), a.threads)
            off, worst = 0, 0.0
            for stem, area in found.items():
                want = known[stem] * factor
                if differs(area, want, a.tolerance):
                    off += 1
                    print("%s as %s: %s, not %s" % (stem, way, area, want))
                else:
                    worst = max(worst, abs(area / want - 1))
            print("%s: %d sections, %d differ, the others by %.1e at most" % (way, len(found), off, worst), flush=True)
            wrong += off
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
