//! Licence expressions as crates state them: SPDX with `AND`, `OR`, `WITH` and parentheses, and the old `MIT/Apache-2.0`.

use std::iter::Peekable;
use std::vec::IntoIter;

/// Whether `expression` can be satisfied with licences of `allowed` alone.
///
/// A licence `WITH` an exception counts as one licence, to be listed as such.
///
/// # Errors
/// When the expression cannot be understood.
pub fn satisfied(expression: &str, allowed: &[String]) -> Result<bool, String> {
    let mut parser = Parser { tokens: tokens(expression).into_iter().peekable(), allowed };
    let value = parser.any_of();
    match value {
        Some(value) if parser.tokens.peek().is_none() => Ok(value),
        _ => Err(format!("cannot understand the licence expression `{expression}`")),
    }
}

fn tokens(expression: &str) -> Vec<String> {
    let spaced = expression.replace('(', " ( ").replace(')', " ) ").replace('/', " OR ");
    spaced.split_whitespace().map(str::to_string).collect()
}

/// Reads tokens from left to right; each method returns `None` if it cannot continue.
struct Parser<'a> {
    tokens: Peekable<IntoIter<String>>,
    allowed: &'a [String],
}

impl Parser<'_> {
    /// a OR b OR …
    fn any_of(&mut self) -> Option<bool> {
        let mut value = self.all_of()?;
        while self.tokens.next_if(|token| token == "OR").is_some() {
            value |= self.all_of()?;
        }
        Some(value)
    }

    /// a AND b AND …
    fn all_of(&mut self) -> Option<bool> {
        let mut value = self.one()?;
        while self.tokens.next_if(|token| token == "AND").is_some() {
            value &= self.one()?;
        }
        Some(value)
    }

    /// A licence, perhaps with an exception, or an expression in parentheses.
    fn one(&mut self) -> Option<bool> {
        let mut name = self.tokens.next()?;
        match name.as_str() {
            "(" => {
                let value = self.any_of()?;
                return self.tokens.next_if(|token| token == ")").map(|_| value);
            }
            ")" | "AND" | "OR" | "WITH" => return None,
            _ => {}
        }
        if self.tokens.next_if(|token| token == "WITH").is_some() {
            name = format!("{name} WITH {}", self.tokens.next()?);
        }
        Some(self.allowed.contains(&name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ask(expression: &str) -> Result<bool, String> {
        satisfied(expression, &["MIT", "Zlib", "Unicode-3.0", "Apache-2.0 WITH LLVM-exception"].map(String::from))
    }

    #[test]
    fn one_of_several_is_enough_and_all_of_several_are_needed() {
        assert_eq!(ask("MIT"), Ok(true));
        assert_eq!(ask("GPL-3.0-only"), Ok(false));
        assert_eq!(ask("GPL-3.0-only OR MIT"), Ok(true));
        assert_eq!(ask("GPL-2.0/MIT"), Ok(true));
        assert_eq!(ask("GPL-3.0-only AND MIT"), Ok(false));
        assert_eq!(ask("Zlib AND MIT"), Ok(true));
    }

    #[test]
    fn parentheses_come_before_and_and_that_before_or() {
        assert_eq!(ask("(MIT OR GPL-3.0-only) AND Unicode-3.0"), Ok(true));
        assert_eq!(ask("MIT OR Zlib AND GPL-3.0-only"), Ok(true));
        assert_eq!(ask("(MIT OR Zlib) AND GPL-3.0-only"), Ok(false));
        assert_eq!(ask("((MIT))"), Ok(true));
    }

    #[test]
    fn an_exception_belongs_to_its_licence() {
        assert_eq!(ask("Apache-2.0 WITH LLVM-exception"), Ok(true));
        assert_eq!(ask("Apache-2.0"), Ok(false));
        assert_eq!(ask("MIT WITH LLVM-exception"), Ok(false));
        assert_eq!(ask("GPL-3.0-only OR Apache-2.0 WITH LLVM-exception"), Ok(true));
    }

    #[test]
    fn nonsense_is_an_error() {
        for expression in ["", "MIT OR", "(MIT", "MIT)", "MIT Zlib", "AND MIT", "MIT WITH"] {
            assert!(ask(expression).unwrap_err().contains(expression));
        }
    }
}
