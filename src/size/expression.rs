//! A size as an expression in x and y: `0.1 + 0.05 * hypot(x - 2, y)`.
//!
//! Numbers, `x`, `y`, `pi`; `+ - * / ^` (a power binds tightest, and from the right); parentheses; `abs sqrt exp log
//! sin cos tan atan` of one and `min max hypot` of two arguments; angles in radians. Read once into steps of a stack
//! machine (Dijkstra's shunting yard), so that neither reading nor evaluating recurses.

use crate::geometry::Point;

/// An expression ready to be evaluated, and the text that it was read from.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    text: String,
    steps: Vec<Step>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Step {
    Number(f64),
    X,
    Y,
    Call(Function),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Function {
    Negate,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Abs,
    Sqrt,
    Exp,
    Log,
    Sin,
    Cos,
    Tan,
    Atan,
    Min,
    Max,
    Hypot,
}

impl Function {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "abs" => Self::Abs,
            "sqrt" => Self::Sqrt,
            "exp" => Self::Exp,
            "log" => Self::Log,
            "sin" => Self::Sin,
            "cos" => Self::Cos,
            "tan" => Self::Tan,
            "atan" => Self::Atan,
            "min" => Self::Min,
            "max" => Self::Max,
            "hypot" => Self::Hypot,
            _ => return None,
        })
    }

    fn arguments(self) -> usize {
        match self {
            Self::Add | Self::Subtract | Self::Multiply | Self::Divide | Self::Power => 2,
            Self::Min | Self::Max | Self::Hypot => 2,
            _ => 1,
        }
    }

    /// The precedence of an operator; a higher one binds tighter.
    fn precedence(self) -> u8 {
        match self {
            Self::Add | Self::Subtract => 1,
            Self::Multiply | Self::Divide => 2,
            Self::Negate => 3,
            _ => 4,
        }
    }

    fn of(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Negate => -a,
            Self::Add => a + b,
            Self::Subtract => a - b,
            Self::Multiply => a * b,
            Self::Divide => a / b,
            Self::Power => libm::pow(a, b),
            Self::Abs => a.abs(),
            Self::Sqrt => a.sqrt(),
            Self::Exp => libm::exp(a),
            Self::Log => libm::log(a),
            Self::Sin => libm::sin(a),
            Self::Cos => libm::cos(a),
            Self::Tan => libm::tan(a),
            Self::Atan => libm::atan(a),
            Self::Min => a.min(b),
            Self::Max => a.max(b),
            Self::Hypot => libm::hypot(a, b),
        }
    }
}

/// An entry of the operator stack.
enum Waiting {
    Operator(Function),
    /// An opening parenthesis; for a call with the function and the number of its arguments so far.
    Open(Option<(Function, usize)>),
}

impl Expression {
    /// Reads an expression.
    ///
    /// # Errors
    /// A sentence that names the place, by characters from 1, where the text is no expression.
    pub fn read(text: &str) -> Result<Self, String> {
        let mut reader = Reader { steps: Vec::new(), waiting: Vec::new(), wants_value: true };
        let mut rest = text.trim_end();
        loop {
            let trimmed = rest.trim_start();
            let at = text.trim_end().len() - trimmed.len();
            if trimmed.is_empty() {
                break;
            }
            let length = reader.token(trimmed).map_err(|what| {
                format!("{what} at character {} of '{}'", text[..at].chars().count() + 1, text.trim())
            })?;
            rest = &trimmed[length..];
        }
        let steps = reader.finish().map_err(|what| format!("{what} at the end of '{}'", text.trim()))?;
        Ok(Self { text: text.trim().to_owned(), steps })
    }

    /// The text that the expression was read from, without blanks around it.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The value at a point; infinite or not a number where the arithmetic has no finite result.
    pub fn at(&self, p: Point) -> f64 {
        let mut stack: Vec<f64> = Vec::with_capacity(8);
        for step in &self.steps {
            let value = match *step {
                Step::Number(value) => value,
                Step::X => p.x,
                Step::Y => p.y,
                Step::Call(function) => {
                    let b = if function.arguments() == 2 { stack.pop().unwrap_or(f64::NAN) } else { 0.0 };
                    function.of(stack.pop().unwrap_or(f64::NAN), b)
                }
            };
            stack.push(value);
        }
        stack.pop().unwrap_or(f64::NAN)
    }
}

struct Reader {
    steps: Vec<Step>,
    waiting: Vec<Waiting>,
    /// Whether a value must come next, not an operator.
    wants_value: bool,
}

impl Reader {
    /// Reads one token, and returns its length in bytes.
    fn token(&mut self, rest: &str) -> Result<usize, String> {
        let first = rest.chars().next().unwrap_or(' ');
        match (self.wants_value, first) {
            (true, '0'..='9' | '.') => self.number(rest),
            (true, 'a'..='z' | 'A'..='Z') => self.word(rest),
            (true, '(') => {
                self.waiting.push(Waiting::Open(None));
                Ok(1)
            }
            (true, '-') => {
                self.waiting.push(Waiting::Operator(Function::Negate));
                Ok(1)
            }
            (true, '+') => Ok(1),
            (false, '+') => self.operator(Function::Add),
            (false, '-') => self.operator(Function::Subtract),
            (false, '*') => self.operator(Function::Multiply),
            (false, '/') => self.operator(Function::Divide),
            (false, '^') => self.operator(Function::Power),
            (false, ',') => self.comma(),
            (false, ')') => self.close(),
            (true, _) => Err(format!("a number, x, y or a function is expected, not '{first}'")),
            (false, _) => Err(format!("an operator is expected, not '{first}'")),
        }
    }

    fn value(&mut self, step: Step) {
        self.steps.push(step);
        self.wants_value = false;
    }

    fn number(&mut self, rest: &str) -> Result<usize, String> {
        let bytes = rest.as_bytes();
        let belongs = |i: usize| match bytes[i] {
            b'0'..=b'9' | b'.' | b'e' | b'E' => true,
            b'+' | b'-' => i > 0 && matches!(bytes[i - 1], b'e' | b'E'),
            _ => false,
        };
        let length = (0..bytes.len()).find(|&i| !belongs(i)).unwrap_or(bytes.len());
        let value: f64 = rest[..length].parse().map_err(|_| format!("'{}' is no number", &rest[..length]))?;
        self.value(Step::Number(value));
        Ok(length)
    }

    fn word(&mut self, rest: &str) -> Result<usize, String> {
        let length = rest.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(rest.len());
        let word = &rest[..length];
        match word {
            "x" => self.value(Step::X),
            "y" => self.value(Step::Y),
            "pi" => self.value(Step::Number(std::f64::consts::PI)),
            _ => {
                let function = Function::named(word).ok_or_else(|| format!("'{word}' is not known"))?;
                let gap = rest[length..].len() - rest[length..].trim_start().len();
                if !rest[length + gap..].starts_with('(') {
                    return Err(format!("'{word}' needs its arguments in parentheses"));
                }
                self.waiting.push(Waiting::Open(Some((function, 1))));
                return Ok(length + gap + 1);
            }
        }
        Ok(length)
    }

    fn operator(&mut self, operator: Function) -> Result<usize, String> {
        let goes_first = |waiting: Function| match operator {
            Function::Power => waiting.precedence() > operator.precedence(),
            _ => waiting.precedence() >= operator.precedence(),
        };
        while let Some(&Waiting::Operator(waiting)) = self.waiting.last() {
            if !goes_first(waiting) {
                break;
            }
            self.waiting.pop();
            self.steps.push(Step::Call(waiting));
        }
        self.waiting.push(Waiting::Operator(operator));
        self.wants_value = true;
        Ok(1)
    }

    /// Moves operators to the steps, down to the opening parenthesis, which is removed.
    fn unwind(&mut self) -> Option<Option<(Function, usize)>> {
        while let Some(waiting) = self.waiting.pop() {
            match waiting {
                Waiting::Operator(operator) => self.steps.push(Step::Call(operator)),
                Waiting::Open(call) => return Some(call),
            }
        }
        None
    }

    fn comma(&mut self) -> Result<usize, String> {
        match self.unwind() {
            Some(Some((function, arguments))) if arguments < function.arguments() => {
                self.waiting.push(Waiting::Open(Some((function, arguments + 1))));
                self.wants_value = true;
                Ok(1)
            }
            _ => Err("a comma that parts no arguments".into()),
        }
    }

    fn close(&mut self) -> Result<usize, String> {
        match self.unwind() {
            None => Err("a parenthesis that was not opened".into()),
            Some(Some((function, arguments))) if arguments != function.arguments() => {
                Err(format!("{} arguments are needed", function.arguments()))
            }
            Some(call) => {
                self.steps.extend(call.map(|(function, _)| Step::Call(function)));
                Ok(1)
            }
        }
    }

    fn finish(mut self) -> Result<Vec<Step>, String> {
        if self.wants_value {
            return Err("a value is missing".into());
        }
        match self.unwind() {
            Some(_) => Err("a parenthesis is not closed".into()),
            None => Ok(self.steps),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(text: &str, x: f64, y: f64) -> f64 {
        Expression::read(text).unwrap().at(Point::new(x, y))
    }

    #[test]
    fn operators_bind_as_in_mathematics() {
        assert_eq!(at("1 + 2 * 3 - 4 / 2", 0.0, 0.0), 5.0);
        assert_eq!(at("2 ^ 3 ^ 2", 0.0, 0.0), 512.0);
        assert_eq!(at("-2 ^ 2 + (-2) ^ 2", 0.0, 0.0), 0.0);
        assert_eq!(at("8 - 4 - 2", 0.0, 0.0), 2.0);
        assert_eq!(at("2 * -x", 3.0, 0.0), -6.0);
        assert_eq!(at(" +1.5e-3 ", 0.0, 0.0), 1.5e-3);
    }

    #[test]
    fn functions_and_places() {
        assert_eq!(at("0.1 + 0.05 * hypot(x - 2, y)", 5.0, 4.0), 0.35);
        assert_eq!(at("min(x, max(y, 1)) + abs(-x) + sqrt(y * y)", 3.0, 2.0), 7.0);
        assert!((at("sin(pi / 2) + cos(0) + tan (0) + atan(0) + log(exp(2))", 0.0, 0.0) - 4.0).abs() < 1e-15);
    }

    #[test]
    fn what_is_no_expression_is_told_with_its_place() {
        for (text, told) in [
            ("", "a value is missing at the end of ''"),
            ("1 +", "a value is missing at the end of '1 +'"),
            ("(1", "a parenthesis is not closed at the end of '(1'"),
            ("1)", "a parenthesis that was not opened at character 2 of '1)'"),
            ("1 2", "an operator is expected, not '2' at character 3 of '1 2'"),
            ("  z + 1", "'z' is not known at character 3 of 'z + 1'"),
            ("sin x", "'sin' needs its arguments in parentheses at character 1 of 'sin x'"),
            ("min(1)", "2 arguments are needed at character 6 of 'min(1)'"),
            ("sin(1, 2)", "a comma that parts no arguments at character 6 of 'sin(1, 2)'"),
            ("1..2", "'1..2' is no number at character 1 of '1..2'"),
            ("é", "a number, x, y or a function is expected, not 'é' at character 1 of 'é'"),
        ] {
            assert_eq!(Expression::read(text).unwrap_err(), told);
        }
    }

    #[test]
    fn a_hundred_thousand_parentheses_do_not_overflow_the_stack() {
        let deep = "(".repeat(100_000) + "1" + &")".repeat(100_000);
        assert_eq!(at(&deep, 0.0, 0.0), 1.0);
    }
}
