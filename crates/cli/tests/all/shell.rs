//! Completions and manual pages.

use crate::common::{fail, folder, run, succeed};

#[test]
fn every_shell_gets_completions_with_the_verbs_and_their_options() {
    let dir = folder();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let text = succeed(dir.path(), &["completions", shell]);
        for word in ["partition", "farm", "meters-per-unit"] {
            assert!(text.contains(word), "{shell} lacks {word}");
        }
    }
    fail(dir.path(), &["completions", "cmd"], 2, &["bash", "zsh", "fish"]);
}

#[test]
fn every_verb_has_a_manual_page() {
    let dir = folder();
    assert_eq!(succeed(dir.path(), &["completions", "--man", "man/man1"]).trim(), "man/man1/enfilade.1");
    let (_, help, _) = run(dir.path(), &["--help"]);
    let verbs: Vec<&str> =
        help.lines().filter_map(|line| line.strip_prefix("  ")?.split(' ').next()).filter(|word| !word.is_empty()).collect();
    assert!(verbs.contains(&"run") && verbs.contains(&"make"), "{verbs:?}");
    for verb in verbs.iter().filter(|verb| verb.chars().all(char::is_alphabetic) && !["help", "enfilade"].contains(verb)) {
        let page = std::fs::read_to_string(dir.path().join(format!("man/man1/enfilade-{verb}.1"))).unwrap();
        assert!(page.starts_with(".ie") && page.contains(".SH OPTIONS"), "{verb}: {page}");
    }
    fail(dir.path(), &["completions", "--man", "/dev/null/pages"], 1, &["/dev/null/pages", "can be written to"]);
}
