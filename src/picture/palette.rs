//! Colours that people with any kind of colour vision can distinguish.

use super::canvas::{Colour, Stroke};

/// Text and lines.
pub const INK: Colour = Colour::hex(0x2b3440);
/// Edges on dark cells.
pub const CHALK: Colour = Colour::hex(0xffffff);
/// Secondary text.
pub const FAINT: Colour = Colour::hex(0x7b8794);
/// Acute corners and flaws.
pub const ALARM: Colour = Colour::hex(0xd6002a);
/// Protecting balls.
pub const BALL: Colour = Colour::hex(0x7a1fa2);

/// Boundary names: the colours of Okabe & Ito, for any kind of colour vision. Their yellow is darkened for a white
/// background.
pub const LINES: [u32; 8] = [0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7, 0x8c6d00, 0x56b4e9, 0xe69f00, 0x444444];
/// Regions: the same hues, light enough for lines on top.
pub const AREAS: [u32; 8] = [0xcfe3f1, 0xf8ddc9, 0xcdebdf, 0xf2dde9, 0xebe4c4, 0xdcf0fb, 0xfbe9c6, 0xdddddd];
/// Smallest angle of a triangle: from brown (bad) over orange and cream to blue (good), a pair for any kind of colour
/// vision. It turns pale just above 20.7°, the angle that corner lopping reaches. So the triangles that a corner
/// exempts are conspicuous.
pub const QUALITY: [(f64, u32); 7] = [
    (0.0, 0x6b1f00),
    (10.0, 0xc8500a),
    (20.0, 0xf6a54a),
    (23.0, 0xfbdcae),
    (32.0, 0xf0efe3),
    (44.0, 0xb7d9ee),
    (60.0, 0x4f9ccb),
];
/// Size: dark is fine, light is coarse. Lightness alone tells them apart.
pub const SIZE: [(f64, u32); 5] =
    [(0.0, 0x1f2a5a), (0.25, 0x22668d), (0.5, 0x37a08f), (0.75, 0x9ad07a), (1.0, 0xf6f3b0)];

/// The line of a boundary: one of eight colours, then the same colours dashed.
pub fn line_stroke(index: usize, width: f64) -> Stroke {
    let stroke = Stroke::new(Colour::hex(LINES[index % LINES.len()]), width);
    match index / LINES.len() % 3 {
        0 => stroke,
        1 => stroke.dashed(4.0 * width, 2.4 * width),
        _ => stroke.dashed(0.5 * width, 2.0 * width),
    }
}

/// The colour of an area.
pub fn area_colour(index: usize) -> Colour {
    Colour::hex(AREAS[index % AREAS.len()])
}

/// The colour of a value on a scale.
pub fn along(scale: &[(f64, u32)], value: f64) -> Colour {
    let above = scale.partition_point(|&(at, _)| at < value).clamp(1, scale.len() - 1);
    let ((a, from), (b, to)) = (scale[above - 1], scale[above]);
    Colour::hex(from).mix(Colour::hex(to), (value - a) / (b - a))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_hit_their_anchors_and_stay_inside() {
        for (at, colour) in QUALITY {
            assert_eq!(along(&QUALITY, at), Colour::hex(colour));
        }
        assert_eq!(along(&QUALITY, -5.0), Colour::hex(QUALITY[0].1));
        assert_eq!(along(&SIZE, 7.0), Colour::hex(SIZE[4].1));
    }

    #[test]
    fn region_names_have_light_colours() {
        for i in 0..AREAS.len() {
            let Colour(r, g, b) = area_colour(i);
            assert!(r.min(g).min(b) > 0xb0, "lines must stand out on {i}");
        }
    }
}
