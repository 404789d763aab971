#!/usr/bin/env bash
# resvg-py 0.5.0 (resvg) and the size of an SVG that has a viewBox of a fractional size, and no width and height.
#
# Common guess: rendered at a larger size, the picture is the drawing scaled to that size; rounding to whole pixels costs less than a pixel.
# Real behaviour: the size of the drawing is rounded to whole pixels first, and the rest is scaled from there, so that the error does not shrink with the size
# of the picture: of a square viewBox of 12.59 the left half covers 46.9 % of a picture of 1000 x 1000, of 12.4 it covers 51.7 %. Who measures areas
# by counting pixels is 6 % off at any resolution, unless the file has a width and height in whole pixels.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet 'resvg-py==0.5.0' 'pillow==13.0.0'
cat > try.py <<'PY'
import io

import resvg_py
from PIL import Image

SVG = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0} {0}"{2}><rect width="{1}" height="{0}"/></svg>'


def share(side, more="", **options):
    """Of the picture, what the left half of the drawing covers."""
    png = resvg_py.svg_to_bytes(svg_string=SVG.format(side, side / 2, more), **options)
    alpha = Image.open(io.BytesIO(bytes(png))).convert("RGBA").getchannel("A")
    return sum(alpha.tobytes()) / 255 / (alpha.width * alpha.height)


large = {"width": 1000, "height": 1000}
seen = {
    "12.59 in 1000 pixels": share(12.59, **large),
    "12.59, ten times": share(12.59, zoom=10),
    "12.4 in 1000 pixels": share(12.4, **large),
    "12 in 1000 pixels": share(12, **large),
    "12.59 with width and height of 1000": share(12.59, ' width="1000" height="1000"'),
}
for what, part in seen.items():
    print("%-40s %.4f" % (what, part))
expected = [0.469, 0.470, 0.517, 0.5, 0.5]
assert all(abs(a - b) < 2e-3 for a, b in zip(seen.values(), expected)), "resvg behaves otherwise now"
PY
venv/bin/python try.py
