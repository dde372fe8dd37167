//! `make`: one verb for everything that is made of finished frames, with a noun for each; and which flags go with which noun.

use super::flags::Flags;
use super::{CamerasArg, FramesArg};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::error::ErrorKind;
use clap::parser::ValueSource;
use clap::{ArgMatches, Args, Command, FromArgMatches};
use enfilade_options::{Options, Spec};
use enfilade_pipeline::{Product, ProductOptions};
use std::path::PathBuf;

/// `make`.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  enfilade make out pairs --overlap 0.2..0.7 --baseline 0.3.. --angle ..90\n  enfilade make out pairs flow tracks\n  \
    enfilade make out flow --between cam_00/3 cam_01/7\n  enfilade make out rooms words\n  enfilade make out --stale\n  \
    enfilade make out sensors --sensors examples/sensors.toml --frames 0..4\n  enfilade make out relit --mixes examples/mixes.csv\n\n\
    Nothing is rendered. flow, tracks and surfaces ask the scene itself, so they need the folder in which `enfilade run` made the dataset;\n\
    relit needs frames of `enfilade run --fixtures`. docs/ground-truth.md has a page for each."
)]
pub struct MakeArgs {
    /// The dataset's folder
    #[arg(value_name = "OUT")]
    pub dataset: PathBuf,
    /// What to make, one or several
    #[arg(value_name = "WHAT", required_unless_present = "stale", value_parser = product())]
    pub what: Vec<Product>,
    /// Make again what is out of date, as it was asked for: of WHAT, or of everything
    #[arg(long, conflicts_with = "force")]
    pub stale: bool,
    /// Make also what is up to date
    #[arg(long)]
    pub force: bool,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub chosen: FramesArg,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub options: ProductFlags,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub table: CamerasArg,
}

/// Reads a noun: a product that people request by name.
fn product() -> impl TypedValueParser<Value = Product> {
    let values = Product::ON_REQUEST.map(|product| PossibleValue::new(product.name()).help(product.spec().about));
    PossibleValuesParser::new(values).try_map(|name| Product::from_name(&name).ok_or("expected a product"))
}

/// A call that makes a product.
pub fn example(product: Product) -> String {
    let files = match product {
        Product::Sensors => " --sensors sensors.toml",
        Product::Relit => " --mixes mixes.csv",
        _ => "",
    };
    format!("enfilade make OUT {}{files}", product.name())
}

/// The options of products, each under the nouns that it is for.
pub struct ProductFlags(pub Flags<ProductOptions>);

impl FromArgMatches for ProductFlags {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        Flags::from_arg_matches(matches).map(Self)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        self.0.update_from_arg_matches(matches)
    }
}

impl Args for ProductFlags {
    fn augment_args(command: Command) -> Command {
        let command = ProductOptions::OPTIONS.iter().fold(Flags::<ProductOptions>::augment_args(command), |command, spec| {
            command.mut_arg(spec.name, |flag| flag.help_heading(named(&nouns(spec), ", ")))
        });
        command.mut_arg("between", |flag| flag.conflicts_with("step"))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

/// The nouns that an option is for.
fn nouns(spec: &Spec) -> Vec<Product> {
    Product::ON_REQUEST.into_iter().filter(|product| product.options().any(|name| name == spec.name)).collect()
}

fn named(products: &[Product], separator: &str) -> String {
    products.iter().map(|product| product.name()).collect::<Vec<_>>().join(separator)
}

/// Nouns that are always of a whole scene, by the flags that would choose a part of it.
const OF_WHOLE_SCENES: [(&str, &[Product]); 2] =
    [("camera", &[Product::Words]), ("frames", &[Product::Pairs, Product::Flow, Product::Words])];

/// Refuses flags of nouns that are not asked for, and choices of frames that a noun does not know.
///
/// # Errors
/// One of clap's, with its exit code.
pub fn check_make(matches: &ArgMatches, command: &mut Command) -> Result<(), clap::Error> {
    let asked: Vec<Product> = matches.get_many::<Product>("what").into_iter().flatten().copied().collect();
    if matches.get_flag("stale") {
        return check_stale(matches, command);
    }
    for spec in given(matches) {
        let nouns = nouns(spec);
        if !nouns.iter().any(|noun| asked.contains(noun)) {
            let message = format!("--{} goes with {}, but {} is asked for", spec.flag(), named(&nouns, " and "), named(&asked, " and "));
            return Err(command.error(ErrorKind::ArgumentConflict, message));
        }
    }
    for (flag, nouns) in OF_WHOLE_SCENES {
        let whole: Vec<Product> = nouns.iter().copied().filter(|noun| asked.contains(noun)).collect();
        if matches.contains_id(flag) && !whole.is_empty() {
            let message = format!("--{flag} does not go with {}; --scene does", named(&whole, " and "));
            return Err(command.error(ErrorKind::ArgumentConflict, message));
        }
    }
    let other = ["step", "between"].into_iter().find(|flag| matches.contains_id(flag));
    match other.filter(|_| matches.contains_id("pairs") && !asked.contains(&Product::Pairs)) {
        Some(flag) => {
            let message = format!("--pairs and --{flag} both say between which frames flow leads; give one of them");
            Err(command.error(ErrorKind::ArgumentConflict, message))
        }
        None => Ok(()),
    }
}

/// Refuses flags that say how something is to be made, beside one that makes it as it was.
fn check_stale(matches: &ArgMatches, command: &mut Command) -> Result<(), clap::Error> {
    let of_nouns = given(matches).map(Spec::flag);
    let of_frames = ["camera", "frames"].into_iter().filter(|flag| matches.contains_id(flag)).map(String::from);
    match of_nouns.chain(of_frames).next() {
        Some(flag) => {
            let message = format!("--stale makes products as they were asked for, so --{flag} does not go with it; --scene does");
            Err(command.error(ErrorKind::ArgumentConflict, message))
        }
        None => Ok(()),
    }
}

/// The options of products that are given.
fn given(matches: &ArgMatches) -> impl Iterator<Item = &'static Spec> {
    ProductOptions::OPTIONS.iter().filter(|spec| matches.value_source(spec.name) == Some(ValueSource::CommandLine))
}

#[cfg(test)]
mod tests {
    use super::super::Cli;
    use super::*;
    use clap::CommandFactory;

    fn refusal(words: &str) -> Option<String> {
        let mut command = Cli::command();
        let matches = command.try_get_matches_from_mut(words.split(' ')).unwrap();
        check_make(matches.subcommand().unwrap().1, &mut command).err().map(|error| error.to_string())
    }

    #[test]
    fn every_option_of_a_product_is_a_flag_below_its_nouns() {
        let command = Cli::command();
        let make = command.find_subcommand("make").unwrap();
        let below = |flag: &str| make.get_arguments().find(|arg| arg.get_long() == Some(flag)).unwrap().get_help_heading().unwrap();
        for (flag, heading) in
            [("pairs", "pairs, flow"), ("baseline", "pairs"), ("between", "flow"), ("seed", "tracks"), ("mixes", "relit")]
        {
            assert_eq!(below(flag), heading);
        }
        assert!(ProductOptions::OPTIONS.iter().all(|spec| !nouns(spec).is_empty()));
    }

    #[test]
    fn values_of_options_are_read() {
        let read = |words: &str| {
            let cli = Cli::of(&words.split(' ').map(Into::into).collect::<Vec<_>>()).map_err(|error| error.to_string())?;
            let super::super::Verb::Make(args) = cli.verb else { panic!() };
            Ok::<_, String>(args.options.0.options().unwrap())
        };
        let options = read("enfilade make out flow pairs --between cam_00/3 cam_01/7 --overlap 20%.. --baseline ..2").unwrap();
        assert_eq!(options.between, Some([("cam_00".into(), 3), ("cam_01".into(), 7)]));
        let ends = (options.overlap.unwrap().ends(), options.baseline_m.unwrap().ends());
        assert_eq!(ends, ([0.2, 1.0], [0.0, 2.0]));
        assert_eq!(read("enfilade make out flow --step -1").unwrap().step, Some(-1));
        assert_eq!(read("enfilade make out tracks").unwrap(), ProductOptions::default());
        for (words, told) in [
            ("enfilade make out flow --step 1 --between a/1 b/2", "cannot be used with"),
            ("enfilade make out flow --between a/1", "2 values required"),
            ("enfilade make out surfaces --layers 65", "expected a whole number from 1 to 64"),
            ("enfilade make out pairs --baseline -1..2", "expected two numbers from 0"),
            ("enfilade make out depth", "[possible values: pairs, flow, tracks"),
        ] {
            let found = read(words).unwrap_err();
            assert!(found.contains(told), "{words}: {found}");
        }
    }

    #[test]
    fn flags_of_other_nouns_are_refused_by_name() {
        assert_eq!(refusal("enfilade make out pairs tracks --points 9 --overlap 0.1.. --pairs a.csv"), None);
        assert_eq!(refusal("enfilade make out pairs flow --step 1 --pairs a.csv"), None);
        assert_eq!(refusal("enfilade make out sensors --stale --scene room"), None);
        for (words, told) in [
            ("enfilade make out pairs --points 9", "--points goes with tracks, but pairs is asked for"),
            ("enfilade make out rooms words --pairs a.csv", "--pairs goes with pairs and flow, but rooms and words is asked for"),
            ("enfilade make out tracks pairs --frames 3", "--frames does not go with pairs; --scene does"),
            ("enfilade make out words --camera cam_00", "--camera does not go with words"),
            ("enfilade make out flow --step 1 --pairs a.csv", "--pairs and --step both say"),
            ("enfilade make out pairs --stale --overlap 0.1..", "so --overlap does not go with it"),
            ("enfilade make out --stale --frames 3", "so --frames does not go with it"),
        ] {
            let found = refusal(words).unwrap_or_default();
            assert!(found.contains(told), "{words}: {found}");
        }
    }
}
