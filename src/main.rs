//! The binary: nothing but the command line of the library.

use std::sync::atomic::{AtomicBool, Ordering};

/// Whether standard output was closed when the process began. Rust's runtime opens the null device in its
/// place, where what is written is lost without an error, so this is asked before it.
static IS_STDOUT_CLOSED: AtomicBool = AtomicBool::new(false);

#[cfg(any(target_os = "linux", target_os = "macos"))]
extern "C" fn look_at_stdout() {
    unsafe extern "C" {
        fn fcntl(descriptor: i32, command: i32, ...) -> i32;
    }
    const F_GETFD: i32 = 1;
    // SAFETY: this command reads the flags of a descriptor and takes no argument; of one that is closed it
    // fails.
    IS_STDOUT_CLOSED.store(unsafe { fcntl(1, F_GETFD) } == -1, Ordering::Relaxed);
}

// SAFETY: what stands in these sections is called once before `main`, and takes nothing of the runtime.
#[cfg(any(target_os = "linux", target_os = "macos"))]
#[used]
#[cfg_attr(target_os = "linux", unsafe(link_section = ".init_array"))]
#[cfg_attr(target_os = "macos", unsafe(link_section = "__DATA,__mod_init_func"))]
static BEFORE_MAIN: extern "C" fn() = look_at_stdout;

fn main() -> std::process::ExitCode {
    kickdrift::cli::main(IS_STDOUT_CLOSED.load(Ordering::Relaxed))
}
