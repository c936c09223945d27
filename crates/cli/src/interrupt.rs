//! Ctrl-C and SIGTERM: files that are half written go, and the program ends as by the signal itself.

/// Ends the program so from now on. Where signals are of another kind, a hidden file stays behind.
#[cfg(unix)]
pub(crate) fn leave_nothing_behind() -> std::io::Result<()> {
    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::low_level::emulate_default_handler;

    // Not SIGHUP: who runs the tool by `nohup` has it ignored, and a handler would end that.
    let mut signals = signal_hook::iterator::Signals::new([SIGINT, SIGTERM])?;
    std::thread::Builder::new().spawn(move || {
        if let Some(signal) = signals.forever().next() {
            cloudtouch_io::abandon_unfinished();
            // The shell sees the signal. It fails for no signal of these, and must not go on if it did.
            let _ = emulate_default_handler(signal);
            std::process::exit(128 + signal);
        }
    })?;
    Ok(())
}

#[cfg(not(unix))]
pub(crate) fn leave_nothing_behind() -> std::io::Result<()> {
    Ok(())
}
