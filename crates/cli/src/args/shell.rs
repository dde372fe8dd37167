//! The verbs about the command line itself.

use clap::Args;
use std::path::PathBuf;

/// `completions`.
#[derive(Args)]
#[command(after_help = "Examples:\n  enfilade completions bash > ~/.local/share/bash-completion/completions/enfilade\n  \
    enfilade completions zsh > ~/.zfunc/_enfilade\n  enfilade completions fish > ~/.config/fish/completions/enfilade.fish")]
pub struct CompletionsArgs {
    /// The shell
    pub shell: clap_complete::Shell,
}

/// `man`.
#[derive(Args)]
#[command(after_help = "Example:\n  enfilade man ~/.local/share/man/man1     # then: man enfilade-run")]
pub struct ManArgs {
    /// The folder; made if it is missing
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
}
