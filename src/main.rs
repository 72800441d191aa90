//! The binary: nothing but the command line of the library.

fn main() -> std::process::ExitCode {
    kickdrift::cli::main()
}
