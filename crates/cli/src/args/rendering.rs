//! Flags that say what to make otherwise than the configuration, from the declaration of these options.

use super::flags::Flags;
use crate::outcome::Problem;
use clap::{ArgMatches, Args, Command, FromArgMatches};
use enfilade_pipeline::{Overrides, RenderChoices};

/// Choices about rendering. None is made unless asked for.
#[derive(Args)]
#[command(next_help_heading = "Rendering (of a dataset made before: from now on)")]
struct RenderFlags {
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    choices: Flags<RenderChoices>,
}

/// What to make otherwise than the file says, for `run` and `farm plan`.
pub struct SettingFlags {
    make: Flags<Overrides>,
    render: RenderFlags,
}

impl SettingFlags {
    /// Choices that the flags make.
    pub fn overrides(&self) -> Result<Overrides, Problem> {
        Ok(Overrides { render: self.render.choices.options()?, ..self.make.options()? })
    }
}

impl FromArgMatches for SettingFlags {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        Ok(Self { make: Flags::from_arg_matches(matches)?, render: RenderFlags::from_arg_matches(matches)? })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Args for SettingFlags {
    fn augment_args(command: Command) -> Command {
        // One word for the samples, or their number.
        let command = Flags::<Overrides>::augment_args(command).mut_arg("quality", |arg| arg.conflicts_with("samples"));
        RenderFlags::augment_args(command)
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}
