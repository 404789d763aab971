#!/usr/bin/env python3
"""Write outlines of a font's glyphs as SVG drawings, chosen by a seed: curves as fonts have them, quadratic or cubic.

    glyphs.py FONT.ttf|FONT.otf COUNT FOLDER [SEED]

One file a glyph, FOLDER/NAME.svg, in font units, filled by the nonzero rule. Glyphs without an outline are left out. Then:

    squinch batch FOLDER --out-dir MESHES --format vtu

Needs fontTools (pip install fonttools).
"""
import os, random, sys
from fontTools.pens.boundsPen import BoundsPen
from fontTools.pens.svgPathPen import SVGPathPen
from fontTools.ttLib import TTFont

PAGE = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="{x0} {top} {width} {height}">
<path id="{name}" fill-rule="nonzero" transform="scale(1 -1)" d="{data}"/>
</svg>
"""


def main():
    path, count, folder = sys.argv[1], int(sys.argv[2]), sys.argv[3]
    seed = int(sys.argv[4]) if len(sys.argv) > 4 else 0
    glyphs = TTFont(path).getGlyphSet()
    drawn = {}
    for name in sorted(glyphs.keys()):
        bounds, outline = BoundsPen(glyphs), SVGPathPen(glyphs)
        glyphs[name].draw(bounds)
        glyphs[name].draw(outline)
        if bounds.bounds:
            drawn[name] = bounds.bounds, outline.getCommands()
    os.makedirs(folder, exist_ok=True)
    chosen = random.Random(seed).sample(sorted(drawn), min(count, len(drawn)))
    for name in chosen:
        (x0, y0, x1, y1), data = drawn[name]
        text = PAGE.format(x0=x0, top=-y1, width=x1 - x0, height=y1 - y0, name=name, data=data)
        # Names that differ in case only are one file on some systems: the glyph's place in the font tells them apart.
        with open(os.path.join(folder, "%s-%d.svg" % (name, sorted(drawn).index(name))), "w") as file:
            file.write(text)
    print("%d of %d glyphs with an outline" % (len(chosen), len(drawn)))


if __name__ == "__main__":
    main()
