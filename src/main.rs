//! The `photopic` command: see `photopic --help`.

use std::process::ExitCode;

fn main() -> ExitCode {
    photopic::cli::run(wild::args_os())
}
