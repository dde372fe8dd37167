//! Fields of structs in the code: names as files have them, types and doc comments.

use syn::{Attribute, Expr, Field, GenericArgument, Lit, Meta, PathArguments, Token, Type};

/// A field of a struct, or of a struct variant.
#[derive(Clone)]
pub struct Declared {
    /// Name of the field as files have it.
    pub name: String,
    /// Rust type of the field without `Option` and `Spanned`.
    pub of: Type,
    /// Doc comment of the field, on one line.
    pub doc: String,
    /// Default of an option, where it is a number, true, false, none, or the variant of a word.
    pub default: Option<String>,
}

/// A field as files have it.
pub fn declared(field: &Field) -> Option<Declared> {
    let name = serde_word(&field.attrs, "rename").or_else(|| Some(field.ident.as_ref()?.to_string()))?;
    let mut of = field.ty.clone();
    while matches!(last_name(&of).as_deref(), Some("Option" | "Spanned")) {
        of = argument(&of)?.clone();
    }
    Some(Declared { name, of, doc: doc(&field.attrs), default: None })
}

/// A doc comment on one line.
fn doc(attributes: &[Attribute]) -> String {
    doc_lines(attributes).join(" ").trim().to_string()
}

/// The lines of a doc comment.
pub fn doc_lines(attributes: &[Attribute]) -> Vec<String> {
    let line = |attribute: &Attribute| match &attribute.meta {
        Meta::NameValue(pair) if pair.path.is_ident("doc") => text(&pair.value),
        _ => None,
    };
    attributes.iter().filter_map(line).map(|line| line.strip_prefix(' ').unwrap_or(&line).to_string()).collect()
}

/// The text that an expression is.
pub fn text(expression: &Expr) -> Option<String> {
    match expression {
        Expr::Lit(literal) => {
            if let Lit::Str(text) = &literal.lit {
                Some(text.value())
            } else {
                None
            }
        }
        _ => None,
    }
}

/// The value of `key` in a `#[serde(…)]` of these.
pub fn serde_word(attributes: &[Attribute], key: &str) -> Option<String> {
    let mut found = None;
    for attribute in attributes.iter().filter(|attribute| attribute.path().is_ident("serde")) {
        // Other attributes of serde have other forms and are not needed.
        let _ = attribute.parse_nested_meta(|meta| {
            if meta.path.is_ident(key) {
                found = Some(meta.value()?.parse::<syn::LitStr>()?.value());
            } else if meta.input.peek(Token![=]) {
                meta.value()?.parse::<Expr>()?;
            }
            Ok(())
        });
    }
    found
}

/// `Vec` of `std::vec::Vec<T>`.
pub fn last_name(of: &Type) -> Option<String> {
    if let Type::Path(path) = of { Some(path.path.segments.last()?.ident.to_string()) } else { None }
}

/// `T` of `Vec<T>`.
pub fn argument(of: &Type) -> Option<&Type> {
    let Type::Path(path) = of else { return None };
    let PathArguments::AngleBracketed(arguments) = &path.path.segments.last()?.arguments else { return None };
    arguments.args.iter().find_map(|argument| if let GenericArgument::Type(of) = argument { Some(of) } else { None })
}
