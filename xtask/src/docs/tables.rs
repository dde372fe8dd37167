//! The structs that macros declare: `options!` and `keys!` of the crate `options`.

use super::fields::{Declared, declared};
use syn::parse::ParseStream;
use syn::{Attribute, Expr, Field, Ident, Lit, Token, Visibility, braced};

/// Structs by name.
pub struct Tables(pub Vec<(String, Vec<Declared>)>);

/// `struct Name { field: Type, … } with { field: Type, … }`: a struct with only its own fields.
///
/// # Errors
/// If it has another form.
pub fn keys(input: ParseStream) -> syn::Result<Tables> {
    let name = struct_name(input)?;
    let fields = named_fields(input)?;
    if !input.is_empty() {
        input.parse::<Ident>()?;
        named_fields(input)?;
    }
    Ok(Tables(vec![(name, fields)]))
}

/// `struct Name { option, … }`, or with `keys Keys` after the name: structs with only the options.
///
/// # Errors
/// If it has another form.
pub fn options(input: ParseStream) -> syn::Result<Tables> {
    let mut names = vec![struct_name(input)?];
    if input.parse::<Option<Ident>>()?.is_some() {
        input.parse::<Visibility>()?;
        names.push(input.parse::<Ident>()?.to_string());
    }
    let content;
    braced!(content in input);
    let options: Vec<Declared> = content.parse_terminated(option, Token![,])?.into_iter().flatten().collect();
    Ok(Tables(names.into_iter().map(|name| (name, options.clone())).collect()))
}

fn struct_name(input: ParseStream) -> syn::Result<String> {
    Attribute::parse_outer(input)?;
    input.parse::<Visibility>()?;
    input.parse::<Token![struct]>()?;
    Ok(input.parse::<Ident>()?.to_string())
}

fn named_fields(input: ParseStream) -> syn::Result<Vec<Declared>> {
    let content;
    braced!(content in input);
    let list = content.parse_terminated(Field::parse_named, Token![,])?;
    Ok(list.iter().filter_map(declared).collect())
}

/// `pub name: Type = default => shown`; `None` where it is no option.
fn option(input: ParseStream) -> syn::Result<Option<Declared>> {
    let field = Field::parse_named(input)?;
    input.parse::<Token![=]>()?;
    let default: Expr = input.parse()?;
    if input.parse::<Option<Token![=>]>>()?.is_some() && matches!(input.parse()?, Expr::Path(shown) if shown.path.is_ident("fixed")) {
        return Ok(None);
    }
    // Records may have it under another name.
    let name = field.ident.as_ref().map(ToString::to_string).unwrap_or_default();
    Ok(declared(&field).map(|option| Declared { name, default: literal(&default), ..option }))
}

/// A number, true, false, none, or the variant of a word.
fn literal(expression: &Expr) -> Option<String> {
    match expression {
        Expr::Path(path) if path.path.is_ident("None") => Some("None".into()),
        // `Enum::Variant`.
        Expr::Path(path) if path.path.segments.len() == 2 => path.path.segments.last().map(|segment| segment.ident.to_string()),
        // `Whole::new(8)`.
        Expr::Call(call) => call.args.first().and_then(literal),
        Expr::Lit(literal) => match &literal.lit {
            Lit::Bool(value) => Some(value.value.to_string()),
            Lit::Int(number) => Some(number.base10_digits().into()),
            Lit::Float(number) => Some(number.base10_digits().into()),
            _ => None,
        },
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use syn::parse::Parser;

    #[test]
    fn options_are_read_with_types_and_defaults() {
        let text = "/// A file.\npub struct Source keys pub(super) Keys {\n/// The file.\npub file: String = String::new() => fixed,\n\
            /// Metres.\npub unit: f64 = 1.0 => named(\"X\"),\n/// Names.\npub panes: Vec<String> = Vec::new(),\n\
            /// Points.\npub points: Whole<1> = Whole::new(9),\n/// Words.\npub word: Word = Word::AsIs,\n}";
        let Tables(tables) = options.parse_str(text).unwrap();
        assert_eq!(tables.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), ["Source", "Keys"]);
        let options: Vec<_> =
            tables[1].1.iter().map(|option| (option.name.as_str(), option.doc.as_str(), option.default.as_deref())).collect();
        let expected = [
            ("unit", "Metres.", Some("1.0")),
            ("panes", "Names.", None),
            ("points", "Points.", Some("9")),
            ("word", "Words.", Some("AsIs")),
        ];
        assert_eq!(options, expected);
    }

    #[test]
    fn keys_are_read_without_those_that_others_declare() {
        let Tables(tables) = keys.parse_str("struct Scene { /// Name.\n name: Option<String> } with { level: Level }").unwrap();
        assert_eq!((tables[0].0.as_str(), tables[0].1.len(), tables[0].1[0].name.as_str()), ("Scene", 1, "name"));
    }
}
