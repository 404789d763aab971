//! The colour of a region in a file: the drawing's, else one of a palette.

use crate::ids::Colour;
use crate::mesh::Mesh;

/// Red, green, blue (linear light) and opacity of the region with this name, the `i`-th of its mesh, as glTF has them.
pub fn linear(mesh: &Mesh, name: &str, i: usize) -> [f64; 4] {
    drawn(mesh, name).map_or_else(|| palette(i), |[r, g, b, a]| [to_linear(r), to_linear(g), to_linear(b), a])
}

/// The same in sRGB, as drawings and most readers of `.mtl` have them.
pub fn srgb(mesh: &Mesh, name: &str, i: usize) -> [f64; 4] {
    drawn(mesh, name).unwrap_or_else(|| {
        let [r, g, b, a] = palette(i);
        [to_srgb(r), to_srgb(g), to_srgb(b), a]
    })
}

/// The colour of the drawing, in sRGB from 0 to 1.
fn drawn(mesh: &Mesh, name: &str) -> Option<[f64; 4]> {
    let Colour(bytes) = *mesh.colours.get(&mesh.names.find(name)?)?;
    Some(bytes.map(|byte| f64::from(byte) / 255.0))
}

// Both formulas are from IEC 61966-2-1.

fn to_linear(value: f64) -> f64 {
    if value <= 0.04045 { value / 12.92 } else { libm::pow((value + 0.055) / 1.055, 2.4) }
}

fn to_srgb(value: f64) -> f64 {
    if value <= 0.003_130_8 { 12.92 * value } else { 1.055 * libm::pow(value, 1.0 / 2.4) - 0.055 }
}

/// An endless list of colours in linear light, in which neighbours differ clearly: equal steps of the golden angle
/// around the hue circle.
fn palette(i: usize) -> [f64; 4] {
    const GOLDEN: f64 = 0.618_034;
    let hue = (0.58 + i as f64 * GOLDEN).fract();
    // Hue to red, green and blue at half saturation.
    let [r, g, b] = [0.0, 2.0 / 3.0, 1.0 / 3.0].map(|shift| {
        let wave = ((hue + shift).fract() * 6.0 - 3.0).abs() - 1.0;
        0.35 + 0.4 * wave.clamp(0.0, 1.0)
    });
    [r, g, b, 1.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_palette_is_the_same_in_both() {
        let mesh = Mesh::default();
        for i in 0..20 {
            let ([r, g, b, _], [sr, sg, sb, _]) = (linear(&mesh, "", i), srgb(&mesh, "", i));
            for (light, coded) in [(r, sr), (g, sg), (b, sb)] {
                assert!((to_linear(coded) - light).abs() < 1e-12 && (0.0..1.0).contains(&coded));
            }
        }
    }
}
