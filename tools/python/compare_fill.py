#!/usr/bin/env python3
"""Compare the area that squinch fills with what an independent renderer paints, on drawings chosen by a seed.

    compare_fill.py BINARY FOLDER [--count N] [--seed N] [--list FILE] [--size PX] [--jobs N]

Drawings are prepared so that both mean the same by "painted": strokes, markers, masks and filters are off, text and images are not shown,
everything is opaque, and what reaches beyond the page is cut. resvg then renders each without anti-aliasing, and the share of pixels that
are painted is compared with the area of squinch's regions (`inspect --json`) over that of the page. One line for each drawing whose
areas differ by more than 1 %, and a summary; FILE gets a line for every drawing. Needs resvg-py, numpy and Pillow (PyPI), and the Debian
package openclipart-svg for the folder /usr/share/openclipart.
"""
import argparse
import concurrent.futures
import gzip
import io
import json
import os
import random
import re
import subprocess
import tempfile

LIMIT = 0.01  # relative difference
LIMIT_S = 60
PX = {"": 1, "px": 1, "in": 96, "cm": 96 / 2.54, "mm": 9.6 / 2.54, "pt": 96 / 72, "pc": 16, "q": 2.4 / 2.54}
NEUTRAL = """<style type="text/css">* { stroke: none !important; opacity: 1 !important; fill-opacity: 1 !important;
stop-opacity: 1 !important; marker: none !important; marker-start: none !important; marker-mid: none !important;
marker-end: none !important; mask: none !important; filter: none !important } text, image { display: none !important }</style>"""


def text_of(path):
    data = open(path, "rb").read()
    if data[:2] == b"\x1f\x8b":
        data = gzip.decompress(data)
    return data.decode("utf-8")


def pixels(length):
    match = re.fullmatch(r"\s*([-+.\deE]+?)\s*([a-zA-Z]*)\s*", length or "")
    return float(match[1]) * PX[match[2].lower()] if match and match[2].lower() in PX else None


def prepared(text, size):
    """The text with a view box for its page, `size` pixels on the longer side, and nothing but fills; and the page's size in user units."""
    root = re.search(r"<(\w+:)?svg\b(?:[^>\"']|\"[^\"]*\"|'[^']*')*>", text)
    if not root:
        raise ValueError("no svg element")
    tag, prefix = root[0], root[1] or ""

    def attribute(name):
        found = re.search(r"\s%s\s*=\s*(\"[^\"]*\"|'[^']*')" % name, tag)
        return found[1][1:-1] if found else None

    box = attribute("viewBox")
    if box:
        x, y, width, height = [float(v) for v in re.split(r"[\s,]+", box.strip())]
    else:
        x, y, width, height = 0, 0, pixels(attribute("width")), pixels(attribute("height"))
        if not width or not height:
            raise ValueError("no page")
    closed = tag.endswith("/>")
    for name in ("viewBox", "width", "height", "overflow", "preserveAspectRatio"):
        tag = re.sub(r"\s%s\s*=\s*(\"[^\"]*\"|'[^']*')" % name, "", tag, count=1)
    tag = re.sub(r"overflow\s*:\s*visible\s*;?", "", tag)
    if "xmlns=" not in tag and not prefix:
        tag = tag.replace("<svg", '<svg xmlns="http://www.w3.org/2000/svg"', 1)
    if "xmlns:xlink" not in tag:
        tag = tag.replace("svg", 'svg xmlns:xlink="http://www.w3.org/1999/xlink"', 1)
    # Whole pixels, to which the page is stretched: the renderer rounds a size up, and paints that much less.
    across, up = [max(200, round(size * side / max(width, height))) for side in (width, height)]
    tag = tag.rstrip("/>") + ' viewBox="%r %r %r %r" width="%d" height="%d" preserveAspectRatio="none" overflow="hidden"%s' % (
        x, y, width, height, across, up, "/>" if closed else ">")
    neutral = NEUTRAL.replace("style", prefix + "style")
    end = text.rfind("</%ssvg" % prefix)
    return text[: root.start()] + tag + text[root.end() : end] + neutral + text[end:], width, height


def painted(text):
    """The share of the page that resvg paints."""
    import numpy
    import resvg_py
    from PIL import Image

    png = resvg_py.svg_to_bytes(svg_string=text, shape_rendering="crisp_edges", skip_system_fonts=True)
    alpha = numpy.asarray(Image.open(io.BytesIO(bytes(png))).convert("RGBA"))[:, :, 3]
    return float((alpha > 0).mean())


def filled(binary, text, width, height):
    """The share of the page that squinch fills, and what it left out."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "drawing.svg")
        open(path, "w", encoding="utf-8").write(text)
        done = subprocess.run([binary, "inspect", path, "--json"], capture_output=True, text=True, timeout=LIMIT_S)
        try:
            facts = json.loads(done.stdout)
        except ValueError:
            facts = {}
        if not facts.get("domain"):
            word = (done.stderr + " ".join(flaw.get("what", str(flaw)) for flaw in facts.get("flaws", []))).strip()
            return (0.0 if "nothing to mesh" in word else None), word[:160]
        area = facts["domain"]["area"]
        left_out = "; ".join("%s %s" % (s["count"], s["why"]) for s in facts.get("skipped", []))
        return area / (width * height), left_out


def compare(binary, path, size):
    try:
        text, width, height = prepared(text_of(path), size)
        theirs = painted(text)
    except Exception as error:  # whatever the renderer or the preparation cannot do
        return path, None, None, "not comparable: %s" % str(error)[:120]
    try:
        ours, word = filled(binary, text, width, height)
    except subprocess.TimeoutExpired:
        return path, theirs, None, "longer than %d s" % LIMIT_S
    return path, theirs, ours, word


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("binary")
    parser.add_argument("folder")
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--seed", type=int, default=14)
    parser.add_argument("--list")
    parser.add_argument("--size", type=int, default=2000)
    parser.add_argument("--jobs", type=int, default=2)
    args = parser.parse_args()
    found = sorted(os.path.join(d, f) for d, _, files in os.walk(args.folder) for f in files if f.endswith((".svg", ".svgz")))
    chosen = sorted(random.Random(args.seed).sample(found, min(args.count, len(found))))
    alike, apart, beside = 0, [], 0
    lines = []
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        for path, theirs, ours, word in pool.map(lambda p: compare(args.binary, p, args.size), chosen):
            name = os.path.relpath(path, args.folder)
            lines.append("%s\t%s\t%s\t%s" % (name, theirs, ours, word))
            if theirs is None:
                beside += 1
                print("%s: %s" % (name, word), flush=True)
            elif ours is not None and abs(ours - theirs) <= LIMIT * max(theirs, 1e-4):
                alike += 1
            else:
                apart.append(name)
                print("%s: resvg %.5f, squinch %s  %s" % (name, theirs, "%.5f" % ours if ours is not None else "-", word), flush=True)
    if args.list:
        open(args.list, "w").write("\n".join(lines) + "\n")
    print("%d drawings: %d within 1 %%, %d not, %d not comparable" % (len(chosen), alike, len(apart), beside))


if __name__ == "__main__":
    main()
