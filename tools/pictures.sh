#!/usr/bin/env bash
# Makes the pictures of README.md from the samples.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

cargo build --release --quiet
mkdir -p samples/pictures
draw() { # draw SAMPLE PICTURE OPTION…
  local sample=$1 picture=$2
  shift 2
  target/release/squinch draw --quiet "samples/$sample" -o "samples/pictures/$picture.png" "$@"
}

draw naca4412.dat naca4412 --view=-0.35,-0.35,1.35,0.45 --width 900
draw naca4412.dat naca4412_far_field --width 600
draw two_element.dat two_element --view=-0.2,-0.5,1.5,0.4 --width 900
draw tangent_curves.json tangent_curves_domain --stage domain --width 600
draw tangent_curves.json tangent_curves --width 900
draw tangent_curves.json tangent_curves_corner --view=-0.3,-0.3,0.3,0.3 --width 600
draw plate.json plate --width 900
draw transition.json transition --width 900
draw logo.svg logo --colour region --width 600
draw bracket.dxf bracket --colour region --width 900
draw gear.json gear --colour region --width 600
for angle in 0.1 1 5 20; do
  draw "wedges/wedge_$angle.poly" "wedge_$angle" --width 480
done
