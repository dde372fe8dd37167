//! URIs of buffers, pictures and profiles: data within the URI itself, or paths of files.

use crate::percent::percent_decoded;
use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

/// Base64 without padding. Bits of the last digit beyond the last whole byte are ignored.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_allow_trailing_bits(true).with_decode_padding_mode(DecodePaddingMode::RequireNone),
);

/// The target of a URI.
#[derive(Debug, PartialEq)]
pub(super) enum Uri {
    Data(Vec<u8>),
    Path(String),
}

pub(super) fn resolve_uri(uri: &str) -> Result<Uri, String> {
    if let Some(rest) = uri.strip_prefix("data:") {
        let (header, data) = rest.split_once(',').ok_or("has a data URI without a comma")?;
        if header.ends_with(";base64") {
            return decoded_base64(data).map(Uri::Data).ok_or_else(|| "has a data URI that is not valid base64".to_string());
        }
        return Ok(Uri::Data(percent_decoded(data)));
    }
    if let Some((scheme, _)) = uri.split_once("://") {
        return Err(format!("is at {uri:?}; {scheme} addresses are not followed, so download the file and refer to it by a relative path"));
    }
    String::from_utf8(percent_decoded(uri)).map(Uri::Path).map_err(|_| format!("has the uri {uri:?}, which is not text"))
}

/// Base64 of either alphabet of RFC 4648; padding may be absent, white space and what follows the padding are skipped.
fn decoded_base64(text: &str) -> Option<Vec<u8>> {
    let digits = text.bytes().filter(|c| !c.is_ascii_whitespace()).take_while(|&c| c != b'=');
    let standard = |c| match c {
        b'-' => b'+',
        b'_' => b'/',
        other => other,
    };
    let mut digits: Vec<u8> = digits.map(standard).collect();
    // One digit alone does not make a byte. Data that are cut short so are read up to there.
    let dangling = digits.len() % 4 == 1;
    if dangling {
        digits.push(b'A');
    }
    let mut bytes = BASE64.decode(digits).ok()?;
    if dangling {
        bytes.pop();
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uris_are_data_paths_or_refused() {
        assert_eq!(resolve_uri("data:application/octet-stream;base64,aGVsbG8="), Ok(Uri::Data(b"hello".to_vec())));
        assert_eq!(resolve_uri("data:,a%20b"), Ok(Uri::Data(b"a b".to_vec())));
        assert_eq!(resolve_uri("my%20textures/wood.png"), Ok(Uri::Path("my textures/wood.png".into())));
        assert_eq!(resolve_uri("50%.png"), Ok(Uri::Path("50%.png".into())));
        assert!(resolve_uri("https://example.org/a.png").unwrap_err().contains("https addresses are not followed"));
        assert!(resolve_uri("data:;base64,a$b").is_err());
    }

    #[test]
    fn base64_is_read_in_both_alphabets_and_as_far_as_it_goes() {
        assert_eq!(decoded_base64("+/+/"), decoded_base64("-_-_"));
        assert_eq!(decoded_base64("aG Vs\nbG8"), Some(b"hello".to_vec()));
        assert_eq!(decoded_base64("aGVsb"), Some(b"hel".to_vec()));
        // The last digit may have more bits than the last byte needs; text after the padding is skipped.
        assert_eq!(decoded_base64("aGVsbG9=aGVs"), Some(b"hello".to_vec()));
        assert_eq!((decoded_base64(""), decoded_base64("=")), (Some(vec![]), Some(vec![])));
        assert_eq!((decoded_base64("aGVs%"), decoded_base64("a%Vs")), (None, None));
    }
}
