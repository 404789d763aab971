#!/usr/bin/env python3
"""Writes DXF drawings of known area, meshes them, and compares: what is read differently from what was meant must be told.

    generated_dxf.py EXE [--count 1000] [--seed 1] [--keep DIR]

Each drawing is a part with holes, in every entity kind that has an area: lines and arcs, light and old polylines with bulges, circles, ellipses,
splines, hatches with and without outlines, blocks, mirrored entities. Half of them have what real drawings have: contours drawn twice, hatches
instead of outlines, a frame, centre lines, a bolt circle, gaps of 0.3 to 3 units of the last decimal.

A drawing passes where the area is right to 1e-9 (with a gap: to the gap times the length of the outline), where it is refused with the gap as
the cause, or where a note names the layer of the frame or bolt circle that makes it another. Standard library only; exit 0 if all pass.
"""
import argparse
import json
import math
import os
import random
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

TAU = 2 * math.pi


# ---- shapes: closed loops of segments, counter-clockwise, with exact areas ----

def line(p, q):
    return ("line", p, q)


def arc(c, r, a, b):
    """Counter-clockwise from angle a to b, in radians."""
    return ("arc", c, r, a, b)


def rectangle(x, y, w, h):
    p = [(x, y), (x + w, y), (x + w, y + h), (x, y + h)]
    return [line(p[k], p[(k + 1) % 4]) for k in range(4)]


def rounded(x, y, w, h, r):
    out = []
    corners = [(x + w - r, y + r, -0.25), (x + w - r, y + h - r, 0), (x + r, y + h - r, 0.25), (x + r, y + r, 0.5)]
    sides = [((x + r, y), (x + w - r, y)), ((x + w, y + r), (x + w, y + h - r)),
             ((x + w - r, y + h), (x + r, y + h)), ((x, y + h - r), (x, y + r))]
    for (p, q), (cx, cy, turn) in zip(sides, corners):
        out += [line(p, q), arc((cx, cy), r, turn * TAU, (turn + 0.25) * TAU)]
    return out


def polygon(rng, x, y, r):
    n = rng.randint(3, 9)
    at = [k * TAU / n + rng.uniform(0, 0.5) * TAU / n for k in range(n)]
    p = [(x + r * math.cos(a), y + r * math.sin(a)) for a in at]
    return [line(p[k], p[(k + 1) % n]) for k in range(n)]


def slot(x, y, length, r):
    """Half circles at both ends, about its middle."""
    d = length / 2
    return [line((x - d, y - r), (x + d, y - r)), arc((x + d, y), r, -TAU / 4, TAU / 4),
            line((x + d, y + r), (x - d, y + r)), arc((x - d, y), r, TAU / 4, 3 * TAU / 4)]


def ellipse(x, y, a, b, turn):
    return [("ellipse", (x, y), (a * math.cos(turn), a * math.sin(turn)), b / a)]


def blob(rng, x, y, r):
    """A closed cubic of four spans, its control points around a circle."""
    n = 12
    p = []
    for k in range(n):
        s = r * (rng.uniform(0.7, 1.0) if k % 3 else rng.uniform(0.8, 1.0))
        p.append((x + s * math.cos(k * TAU / n), y + s * math.sin(k * TAU / n)))
    return [("spline", p + [p[0]])]


def area_of(loop):
    total = 0.0
    for s in loop:
        if s[0] == "line":
            (x, y), (u, v) = s[1:]
            total += (x * v - u * y) / 2
        elif s[0] == "arc":
            (cx, cy), r, a, b = s[1:]
            total += r * r * (b - a) / 2 + r * (cx * (math.sin(b) - math.sin(a)) - cy * (math.cos(b) - math.cos(a))) / 2
        elif s[0] == "ellipse":
            total += math.pi * (s[2][0] ** 2 + s[2][1] ** 2) * s[3]
        else:
            total += sum(bezier_area(s[1][k:k + 4]) for k in range(0, len(s[1]) - 1, 3))
    return total


def bezier_area(p):
    """Of a cubic and the origin: by Gauss's rule with three points, which is exact for its degree of five."""
    total = 0.0
    for t, w in [(0.5 - math.sqrt(0.15), 5 / 18), (0.5, 8 / 18), (0.5 + math.sqrt(0.15), 5 / 18)]:
        u = 1 - t
        b = [u ** 3, 3 * u * u * t, 3 * u * t * t, t ** 3]
        d = [-3 * u * u, 3 * u * u - 6 * u * t, 6 * u * t - 3 * t * t, 3 * t * t]
        x, y = (sum(b[k] * p[k][i] for k in range(4)) for i in (0, 1))
        dx, dy = (sum(d[k] * p[k][i] for k in range(4)) for i in (0, 1))
        total += w * (x * dy - y * dx) / 2
    return total


def length_of(loop):
    total = 0.0
    for s in loop:
        if s[0] == "line":
            total += math.dist(*s[1:])
        elif s[0] == "arc":
            total += s[2] * (s[4] - s[3])
        elif s[0] == "ellipse":
            total += TAU * math.hypot(*s[2])
        else:
            total += sum(math.dist(s[1][k], s[1][k + 1]) for k in range(len(s[1]) - 1))
    return total


# ---- DXF ----

class Dxf:
    def __init__(self, rng, decimals):
        self.rng, self.decimals, self.handle, self.out = rng, decimals, 0x100, []

    def number(self, x):
        return repr(float(x)) if self.decimals is None else "%.*f" % (self.decimals, x)

    def put(self, *pairs):
        for code, value in pairs:
            self.out.append("%d\n%s" % (code, self.number(value) if isinstance(value, float) else value))

    def begin(self, kind, layer, line_type=None, mirrored=False):
        self.handle += 1
        self.put((0, kind), (5, "%X" % self.handle), (8, layer))
        if line_type:
            self.put((6, line_type))
        if mirrored:
            self.put((210, "0.0"), (220, "0.0"), (230, "-1.0"))

    def point(self, code, p, mirrored=False):
        self.put((code, float(-p[0] if mirrored else p[0])), (code + 10, float(p[1])))

    def segment(self, s, layer, mirrored=False, line_type=None):
        """One segment as an entity; a mirrored arc or circle is given in the coordinates of the plane that is seen from below."""
        if s[0] == "line":
            self.begin("LINE", layer, line_type)
            self.point(10, s[1])
            self.point(11, s[2])
        elif s[0] == "arc":
            c, r, a, b = s[1:]
            if abs(b - a - TAU) < 1e-12:
                self.begin("CIRCLE", layer, line_type, mirrored)
                self.point(10, c, mirrored)
                self.put((40, float(r)))
                return
            self.begin("ARC", layer, line_type, mirrored)
            if mirrored:
                a, b = math.pi - b, math.pi - a
            self.point(10, c, mirrored)
            self.put((40, float(r)), (50, math.degrees(a) % 360), (51, math.degrees(b) % 360))
        elif s[0] == "ellipse":
            self.begin("ELLIPSE", layer, line_type)
            self.point(10, s[1])
            self.point(11, s[2])
            self.put((40, float(s[3])), (41, 0.0), (42, "6.283185307179586"))
        else:
            self.begin("SPLINE", layer, line_type)
            spans = (len(s[1]) - 1) // 3
            knots = [0] * 4 + [k for k in range(1, spans) for _ in range(3)] + [spans] * 4
            self.put((70, 8), (71, 3), (72, len(knots)), (73, len(s[1])), (74, 0))
            for k in knots:
                self.put((40, float(k)))
            for p in s[1]:
                self.point(10, p)

    def polyline(self, loop, layer, old, mirrored):
        """A closed polyline with bulges. Seen from below the way around turns, so that bulges change their signs."""
        vertices = []
        for s in loop:
            if s[0] == "line":
                vertices.append((s[1], 0.0))
            else:
                c, r, a, b = s[1:]
                bulge = math.tan((b - a) / 4)
                vertices.append(((c[0] + r * math.cos(a), c[1] + r * math.sin(a)), -bulge if mirrored else bulge))
        if old:
            self.begin("POLYLINE", layer, None, mirrored)
            self.put((66, 1), (70, 1))
            for p, bulge in vertices:
                self.begin("VERTEX", layer)
                self.point(10, p, mirrored)
                self.put((42, bulge if self.decimals is None else "%.12f" % bulge))
            self.begin("SEQEND", layer)
        else:
            self.begin("LWPOLYLINE", layer, None, mirrored)
            self.put((90, len(vertices)), (70, 1))
            for p, bulge in vertices:
                self.point(10, p, mirrored)
                self.put((42, bulge if self.decimals is None else "%.12f" % bulge))

    def hatch(self, loops, layer):
        self.begin("HATCH", layer)
        self.put((10, 0.0), (20, 0.0), (30, 0.0), (210, "0.0"), (220, "0.0"), (230, "1.0"), (2, "SOLID"), (70, 1), (71, 0), (91, len(loops)))
        for k, loop in enumerate(loops):
            edges = len(loop) == 1 or any(s[0] in ("ellipse", "spline") for s in loop) or self.rng.random() < 0.5
            outer = 1 if k == 0 else 16
            if not edges:
                self.put((92, 2 | outer), (72, 1), (73, 1), (93, sum(1 for _ in loop)))
                for s in loop:
                    start = s[1] if s[0] == "line" else (s[1][0] + s[2] * math.cos(s[3]), s[1][1] + s[2] * math.sin(s[3]))
                    self.point(10, start)
                    self.put((42, 0.0 if s[0] == "line" else math.tan((s[4] - s[3]) / 4)))
            else:
                self.put((92, outer), (93, len(loop)))
                for s in loop:
                    self.hatch_edge(s)
            self.put((97, 0))
        self.put((75, 0), (76, 1), (98, 0))

    def hatch_edge(self, s):
        if s[0] == "line":
            self.put((72, 1))
            self.point(10, s[1])
            self.point(11, s[2])
        elif s[0] == "arc":
            self.put((72, 2))
            self.point(10, s[1])
            self.put((40, float(s[2])), (50, math.degrees(s[3])), (51, math.degrees(s[4])), (73, 1))
        elif s[0] == "ellipse":
            self.put((72, 3))
            self.point(10, s[1])
            self.point(11, s[2])
            self.put((40, float(s[3])), (50, 0.0), (51, 360.0), (73, 1))
        else:
            spans = (len(s[1]) - 1) // 3
            knots = [0] * 4 + [k for k in range(1, spans) for _ in range(3)] + [spans] * 4
            self.put((72, 4), (94, 3), (73, 0), (74, 0), (95, len(knots)), (96, len(s[1])))
            for k in knots:
                self.put((40, float(k)))
            for p in s[1]:
                self.point(10, p)

    def text(self, blocks):
        head = "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1015\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n"
        body = "0\nSECTION\n2\nENTITIES\n" + "\n".join(self.out) + "\n0\nENDSEC\n0\nEOF\n"
        return head + blocks + body


def circle(x, y, r):
    return [arc((x, y), r, 0.0, TAU)]


def part(rng):
    """Outline, holes and their middles, of a plate 100 by 60; holes stand in a grid of their own, so that none touch."""
    outline = rng.choice([
        lambda: rectangle(0, 0, 100, 60), lambda: rounded(0, 0, 100, 60, rng.uniform(1, 5)), lambda: slot(50, 30, 60, 29),
        lambda: ellipse(50, 30, 70, 45, 0.0), lambda: circle(50, 30, 62)])()
    cells = [(26 + 16 * i, 18 + 12 * j) for i in range(4) for j in range(3)]
    holes, middles = [], rng.sample(cells, rng.randint(0, 8))
    for x, y in middles:
        holes.append(rng.choice([
            lambda: circle(x, y, rng.uniform(1, 4)), lambda: rectangle(x - 3, y - 2, 6, 4), lambda: rounded(x - 5, y - 4, 10, 8, 1.5),
            lambda: slot(x, y, 6, 2), lambda: ellipse(x, y, 5, 2, rng.uniform(0, 0.6)), lambda: polygon(rng, x, y, 4),
            lambda: blob(rng, x, y, 4.5)])())
    return outline, holes, middles


def widen(s, gap, rng):
    """A line that ends short of its end."""
    (x, y), (u, v) = s[1:]
    d = math.dist((x, y), (u, v))
    return line((x, y), (u - gap * (u - x) / d, v - gap * (v - y) / d))


def draw(rng):
    """The text of a drawing, and what is to be found: area, tolerance, what a refusal names, the layers of which a note may speak."""
    outline, holes, middles = part(rng)
    quirks = [q for q in ("twice", "hatch", "frame", "centre", "bolts", "gap") if rng.random() < 0.25] if rng.random() < 0.6 else []
    gap_line = next((k for k, s in enumerate(outline) if s[0] == "line"), None)
    has_gap = "gap" in quirks and gap_line is not None
    decimals = rng.choice([2, 3, 4]) if has_gap else None
    dxf, blocks = Dxf(rng, decimals), ""
    want = area_of(outline) - sum(area_of(h) for h in holes)
    tolerance, causes, layers = 1e-9 * want, [], []
    loops = [outline] + holes
    target = dxf
    block = rng.random() < 0.15 and not has_gap
    if block:
        target = Dxf(rng, decimals)
        target.handle = 0x1000
    for k, loop in enumerate(loops):
        round_only = all(s[0] in ("line", "arc") for s in loop) and not (len(loop) == 1)
        if k == 0 and has_gap:
            gap = rng.uniform(0.3, 3) * 10.0 ** -decimals
            for i, s in enumerate(loop):
                target.segment(widen(s, gap, rng) if i == gap_line else s, "PART")
            unit = 10.0 ** -decimals
            # Every number is rounded, angles to as many decimals of a degree.
            reach = max(math.hypot(*p) for s in loop for p in s[1:3] if isinstance(p, tuple))
            tolerance = (gap + 2 * unit + unit * reach / 50) * length_of(loop) + sum(2 * unit * length_of(h) for h in holes)
            causes.append("clos")
            continue
        if "hatch" in quirks and rng.random() < 0.6:
            target.hatch([loop], "PART")
            # A drawing of nothing but hatches is a picture, where what lies over each other is one area.
            if k > 0 and rng.random() < 0.5:
                continue
        style = rng.choice(["segments", "light", "old"]) if round_only else "segments"
        mirrored = rng.random() < 0.2
        for _ in range(2 if "twice" in quirks and rng.random() < 0.5 else 1):
            if style == "segments":
                order = list(loop)
                rng.shuffle(order)
                for s in order:
                    target.segment(s, "PART", mirrored)
            else:
                target.polyline(loop, "PART", style == "old", mirrored)
    if block:
        s, turn = rng.uniform(0.5, 3), rng.uniform(0, 360)
        blocks = ("0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n8\n0\n2\nPARTBLOCK\n70\n0\n10\n0.0\n20\n0.0\n" + "\n".join(target.out) + "\n0\nENDBLK\n8\n0\n0\nENDSEC\n")
        dxf.begin("INSERT", "PART")
        dxf.put((2, "PARTBLOCK"))
        dxf.point(10, (rng.uniform(-50, 50), rng.uniform(-50, 50)))
        dxf.put((41, s), (42, s), (43, 1.0), (50, turn))
        want, tolerance = want * s * s, tolerance * s * s
        quirks = [q for q in quirks if q in ("twice", "hatch")]
    if "frame" in quirks:
        dxf.polyline(rectangle(-60, -60, 220, 180), "SHEET", False, False)
        # Round a part without holes it cannot be told from a plate around its own hole.
        layers.append("SHEET")
        if not holes:
            return None
    if "centre" in quirks:
        for y in (18.0, 30.0, 42.0):
            dxf.segment(line((-15.0, y + 0.013), (115.0, y + 0.013)), "AXES", False, "CENTER")
        dxf.segment(circle(50, 30, 11.77)[0], "AXES", False, rng.choice(["CENTER2", "PHANTOM", "DASHDOT", "ACAD_ISO04W100", "HIDDEN"]))
    if "bolts" in quirks and holes:
        dxf.segment(circle(50, 30, math.dist((50, 30), middles[0]))[0], "BOLTS")
        layers.append("BOLTS")
    return dxf.text(blocks), want, tolerance, causes, layers, quirks


def notes_of(report):
    return "\n".join(report["input"]["notes"])


def check(exe, path, folder, want, tolerance, causes, layers):
    report = os.path.join(folder, os.path.basename(path) + ".json")
    mesh = os.path.join(folder, os.path.basename(path) + ".vtu")
    run = subprocess.run([exe, "mesh", path, "-o", mesh, "--report", report, "--edge-turning", "60", "--quiet", "--timeout", "30"],
                         capture_output=True, stdin=subprocess.DEVNULL)
    error = run.stderr.decode("utf-8", "replace")
    if run.returncode != 0:
        named = run.returncode in (3, 4) and any(cause in error for cause in causes)
        return "refused" if named else "exit %d: %s" % (run.returncode, error.strip()[:300])
    told = json.load(open(report, encoding="utf-8"))
    os.remove(mesh)
    area = told["quality"]["exact_measure"]
    if abs(area - want) <= tolerance:
        return "right"
    if any("Layer %s" % layer in notes_of(told) or "layer %s" % layer in notes_of(told) for layer in layers):
        return "told"
    return "area %.12g, not %.12g (%.2e; %s)" % (area, want, area - want, notes_of(told)[:200])


def main():
    p = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    p.add_argument("exe")
    p.add_argument("--count", type=int, default=1000)
    p.add_argument("--seed", type=int, default=1)
    p.add_argument("--keep", metavar="DIR", help="keeps the drawings there")
    a = p.parse_args()
    rng = random.Random(a.seed)
    jobs = []
    with tempfile.TemporaryDirectory() as folder:
        drawings = a.keep or folder
        os.makedirs(drawings, exist_ok=True)
        while len(jobs) < a.count:
            drawn = draw(rng)
            if drawn is None:
                continue
            text, want, tolerance, causes, layers, quirks = drawn
            path = os.path.join(drawings, "drawing%04d.dxf" % len(jobs))
            with open(path, "w") as f:
                f.write(text)
            jobs.append((path, want, tolerance, causes, layers, quirks))
        run = lambda job: check(os.path.abspath(a.exe), job[0], folder, *job[1:5])
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            results = list(pool.map(run, jobs))
    counts = {}
    for job, result in zip(jobs, results):
        kind = result if result in ("right", "refused", "told") else "wrong"
        counts[kind] = counts.get(kind, 0) + 1
        if kind == "wrong":
            print("%s %s: %s" % (os.path.basename(job[0]), ",".join(job[5]) or "plain", result), flush=True)
    print(", ".join("%d %s" % (counts[k], k) for k in sorted(counts)))
    sys.exit(1 if "wrong" in counts else 0)


if __name__ == "__main__":
    main()
