//! Environment variables in paths: `$NAME` and `${NAME}`.

/// `path` with every `$NAME` and `${NAME}` replaced by what `lookup` gives; `$$` stands for a dollar sign.
///
/// # Errors
/// The name that `lookup` does not know, or the text that is no name.
pub(crate) fn expand(path: &str, lookup: &dyn Fn(&str) -> Option<String>) -> Result<String, String> {
    let mut out = String::with_capacity(path.len());
    let mut rest = path;
    while let Some(dollar) = rest.find('$') {
        out.push_str(&rest[..dollar]);
        rest = &rest[dollar + 1..];
        if let Some(after) = rest.strip_prefix('$') {
            out.push('$');
            rest = after;
            continue;
        }
        let (name, after) = match rest.strip_prefix('{') {
            Some(braced) => braced.split_once('}').ok_or("a `${` without its `}`")?,
            None => rest.split_at(rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(rest.len())),
        };
        if name.is_empty() {
            return Err("a `$` without a variable's name (write `$$` for a dollar sign)".into());
        }
        out.push_str(&lookup(name).ok_or_else(|| format!("the environment variable {name} is not set"))?);
        rest = after;
    }
    out.push_str(rest);
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variables_are_replaced_and_missing_ones_named() {
        let lookup = |name: &str| (name == "ROOMS").then(|| "/data".to_string());
        assert_eq!(expand("$ROOMS/a", &lookup).unwrap(), "/data/a");
        assert_eq!(expand("x/${ROOMS}b/$$5", &lookup).unwrap(), "x//datab/$5");
        assert_eq!(expand("$OTHER/a", &lookup).unwrap_err(), "the environment variable OTHER is not set");
        assert!(expand("${ROOMS", &lookup).is_err());
        assert!(expand("a$/b", &lookup).is_err());
    }
}
