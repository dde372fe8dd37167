//! The program `enfilade`.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(enfilade_cli::main(std::env::args_os(), std::env::current_exe().ok()))
}
