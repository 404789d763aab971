//! Exact sums and products of floating-point numbers, as expansions (Shewchuk 1997): sums of numbers that do not
//! overlap, the smallest first. For what the filters of [`super::exact_space`] cannot tell.

/// A number as the exact sum of its components, the smallest first, none of them 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Expansion(Vec<f64>);

/// a + b as the rounded sum and what rounding lost.
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

/// The upper and the lower half of the digits.
fn split(a: f64) -> (f64, f64) {
    // 2^27 + 1: 53 digits fall into 26 and 26, and a sign.
    let scaled = 134_217_729.0 * a;
    let high = scaled - (scaled - a);
    (high, a - high)
}

/// a · b as the rounded product and what rounding lost.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let ((ah, al), (bh, bl)) = (split(a), split(b));
    (product, al * bl - (((product - ah * bh) - al * bh) - ah * bl))
}

impl Expansion {
    /// a · b, exactly.
    pub fn product(a: f64, b: f64) -> Self {
        let (high, low) = two_product(a, b);
        Self([low, high].into_iter().filter(|&x| x != 0.0).collect())
    }

    /// The sum, exactly.
    pub fn plus(&self, other: &Self) -> Self {
        // Both lists are merged by magnitude, and summed from the smallest up.
        let mut sum = Vec::with_capacity(self.0.len() + other.0.len());
        let (mut a, mut b) = (self.0.iter().copied().peekable(), other.0.iter().copied().peekable());
        let mut next = || match (a.peek(), b.peek()) {
            (Some(x), Some(y)) if x.abs() < y.abs() => a.next(),
            (_, Some(_)) => b.next(),
            _ => a.next(),
        };
        let Some(mut high) = next() else { return Self(sum) };
        while let Some(x) = next() {
            let (s, low) = two_sum(high, x);
            if low != 0.0 {
                sum.push(low);
            }
            high = s;
        }
        if high != 0.0 {
            sum.push(high);
        }
        Self(sum)
    }

    /// The difference, exactly.
    pub fn minus(&self, other: &Self) -> Self {
        self.plus(&Self(other.0.iter().map(|x| -x).collect()))
    }

    /// The product with a number, exactly.
    pub fn times(&self, factor: f64) -> Self {
        let mut product = Vec::with_capacity(2 * self.0.len());
        let mut high = 0.0;
        for &x in &self.0 {
            let (p, low) = two_product(x, factor);
            let (s, below) = two_sum(high, low);
            let (above, between) = two_sum(p, s);
            product.extend([below, between].into_iter().filter(|&x| x != 0.0));
            high = above;
        }
        if high != 0.0 {
            product.push(high);
        }
        Self(product)
    }

    /// The largest component: it has the sign of the sum, and is 0 only of 0.
    pub fn sign(&self) -> f64 {
        self.0.last().copied().unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_and_products_are_those_of_whole_numbers() {
        let mut rng = crate::geometry::rng::Rng::new(7);
        for _ in 0..2000 {
            let mut whole = || (rng.below(1 << 40) as i128 - (1 << 39)) as f64;
            let (a, b, c, d, e) = (whole(), whole(), whole(), whole(), whole());
            let exact = (a as i128 * b as i128 - c as i128 * d as i128) * e as i128;
            let found = Expansion::product(a, b).minus(&Expansion::product(c, d)).times(e);
            // The components are whole numbers too.
            assert_eq!(found.0.iter().map(|&x| x as i128).sum::<i128>(), exact);
            assert_eq!(found.sign().total_cmp(&0.0), (exact as f64).total_cmp(&0.0));
        }
        assert_eq!(Expansion::product(3.0, 5.0).minus(&Expansion::product(15.0, 1.0)).sign(), 0.0);
    }
}
