//! The verb about the command line itself.

use clap::Args;
use std::path::PathBuf;

/// `completions`.
#[derive(Args)]
#[command(after_help = "Examples:\n  enfilade completions bash > ~/.local/share/bash-completion/completions/enfilade\n  \
    enfilade completions zsh > ~/.zfunc/_enfilade\n  enfilade completions fish > ~/.config/fish/completions/enfilade.fish\n  \
    enfilade completions --man ~/.local/share/man/man1     # then: man enfilade-run")]
pub struct CompletionsArgs {
    /// The shell
    #[arg(required_unless_present = "man")]
    pub shell: Option<clap_complete::Shell>,
    /// Instead write the manual pages, in section 1, into this folder, which is made if it is missing
    #[arg(long, value_name = "DIR", conflicts_with = "shell")]
    pub man: Option<PathBuf>,
}
