#!/usr/bin/env python3
"""Mesh every file of some folders with the command line and print what became of each.

    outcomes.py BINARY FOLDER_OR_FILE… [-- OPTIONS OF mesh…]

One line a file: outcome, triangles, smallest unexcused angle, excused triangles, seconds, first line of the message. A file that takes
longer than 20 s is a hang. Needs nothing but Python.
"""
import json, os, re, subprocess, sys, tempfile, time

LIMIT_S = 20
SUFFIXES = (".dat", ".poly", ".node", ".json", ".svg", ".dxf", ".step")


def files(paths):
    for path in paths:
        if os.path.isdir(path):
            yield from sorted(os.path.join(path, f) for f in os.listdir(path) if f.endswith(SUFFIXES))
        else:
            yield path


def run(binary, path, options):
    with tempfile.TemporaryDirectory() as folder:
        out, report = os.path.join(folder, "m.vtu"), os.path.join(folder, "r.json")
        begin = time.time()
        try:
            p = subprocess.run([binary, "mesh", path, "-o", out, "--report", report, "--quiet", *options],
                               capture_output=True, text=True, timeout=LIMIT_S, cwd=folder)
        except subprocess.TimeoutExpired:
            return "HANG", {}, LIMIT_S, ""
        seconds = time.time() - begin
        try:
            with open(report) as f:
                facts = json.load(f)
        except (OSError, ValueError):
            facts = {}
        kind = {0: "kept", 3: "unreadable", 4: "refused", 5: "bound missed", 70: "OUR BUG"}.get(p.returncode, "exit %d" % p.returncode)
        if p.returncode == 0 and not os.path.exists(out):
            kind = "NO FILE"
        return kind, facts, seconds, re.sub(r"\s+", " ", p.stderr)[:160]


def main():
    args = sys.argv[1:]
    options = args[args.index("--") + 1:] if "--" in args else []
    args = args[:args.index("--")] if "--" in args else args
    tally = {}
    binary = os.path.abspath(args[0])
    for path in map(os.path.abspath, files(args[1:])):
        kind, facts, seconds, message = run(binary, path, options)
        mesh, quality, promise = (facts.get(k) or {} for k in ("mesh", "quality", "promise"))
        broken = [c["name"] for c in promise.get("checks", []) if c["status"] == "broken"]
        print("%-44s %-12s %8s triangles %6s deg %6s excused %6.2f s %s %s" % (
            os.path.basename(path), kind, mesh.get("triangles", "-"),
            "%.2f" % quality["min_unexcused_angle_deg"] if quality.get("min_unexcused_angle_deg") else "-",
            (promise.get("excused") or {}).get("count", "-"), seconds, ",".join(broken), message if kind != "kept" else ""))
        tally[kind] = tally.get(kind, 0) + 1
    print(", ".join("%s: %d" % item for item in sorted(tally.items())))


if __name__ == "__main__":
    main()
