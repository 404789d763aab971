#!/usr/bin/env bash
# ezdxf 1.4.5 and the style of a hatch (group 75: which islands are hatched).
#
# Common guess: filling a hatch with a pattern or a colour changes its pattern or colour; its style stays as it was given when the hatch was made.
# Real behaviour: set_pattern_fill and set_solid_fill have a parameter `style` of their own, whose default 1 (outermost areas only) overwrites what stood there:
# a hatch made with style 0 loses its islands' islands, one made with style 2 (ignore) gets holes. set_gradient leaves it alone. Drawings
# generated so have areas that their authors did not ask for, and no viewer that was used to check them need show it.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet 'ezdxf==1.4.5'
cat > try.py <<'PY'
import ezdxf

space = ezdxf.new().modelspace()
seen = {}
for given in (0, 2):
    for name, fill in (
        ("set_pattern_fill", lambda hatch: hatch.set_pattern_fill("ANSI31")),
        ("set_solid_fill", lambda hatch: hatch.set_solid_fill()),
        ("set_gradient", lambda hatch: hatch.set_gradient()),
    ):
        hatch = space.add_hatch(dxfattribs={"hatch_style": given})
        fill(hatch)
        seen[given, name] = hatch.dxf.hatch_style
        print("made with style %d, after %s: %d" % (given, name, hatch.dxf.hatch_style))
expected = {(g, n): (g if n == "set_gradient" else 1) for g in (0, 2) for n in ("set_pattern_fill", "set_solid_fill", "set_gradient")}
assert seen == expected, "ezdxf behaves otherwise now"
PY
venv/bin/python try.py
