//! Files that are either written completely or not at all.

use std::{
    fs::{self, File, OpenOptions},
    io::{self, BufWriter, Write},
    path::{Path, PathBuf},
    process,
    sync::{
        Mutex, MutexGuard, PoisonError,
        atomic::{AtomicU64, Ordering},
    },
};

use crate::error::WriteError;

/// Writes a file so that its name never stands for half of it.
///
/// `write` fills a temporary file in the same folder, which then takes the name `path`; on any
/// error (or a panic of `write`) the temporary file is removed and what stood under the name stays.
/// A symbolic link is followed. Something that is not a regular file, such as a pipe or
/// `/dev/null`, is written to directly: it cannot be replaced.
///
/// # Errors
/// When the file cannot be created, written or renamed, or `write` itself fails.
pub fn write_atomically(
    path: impl AsRef<Path>,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), WriteError> {
    let path = path.as_ref();
    replace(path, write).map_err(|cause| WriteError::Io { path: path.to_owned(), cause })
}

fn replace(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    if fs::metadata(&target).is_ok_and(|existing| !existing.is_file()) {
        let mut writer = BufWriter::new(OpenOptions::new().write(true).open(&target)?);
        write(&mut writer)?;
        return writer.flush();
    }
    let (file, temporary) = create_beside(&target)?;
    let mut writer = BufWriter::new(file);
    write(&mut writer)?;
    writer.flush()?;
    // Otherwise a crash soon afterwards could leave the new name on an empty file.
    writer.get_ref().sync_all()?;
    drop(writer);
    // Once renamed there is nothing left for `temporary` to remove.
    fs::rename(&temporary.0, &target)
}

/// Temporary files that have not taken their names yet.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes every temporary file of [`write_atomically`], for a program that is told to end and does so
/// at once: no other thread comes to begin a file afterwards, it waits for ever.
pub fn abandon_unfinished() {
    let all = unfinished();
    for path in all.iter() {
        // There is nobody left to hear of it.
        let _ = fs::remove_file(path);
    }
    std::mem::forget(all);
}

/// Removes the file it names, if it is still there.
struct Temporary(PathBuf);

impl Drop for Temporary {
    fn drop(&mut self) {
        // The error that led here is the one to report.
        let _ = fs::remove_file(&self.0);
        unfinished().retain(|path| *path != self.0);
    }
}

fn create_beside(target: &Path) -> io::Result<(File, Temporary)> {
    static COUNTER: AtomicU64 = AtomicU64::new(0);
    let name = target
        .file_name()
        .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "the path names no file"))?;
    loop {
        let mut hidden = std::ffi::OsString::from(".");
        hidden.push(name);
        let number = COUNTER.fetch_add(1, Ordering::Relaxed);
        hidden.push(format!(".{}-{number}.partial", process::id()));
        let path = target.with_file_name(hidden);
        // Held over both, so that no file is there that is not listed.
        let mut listed = unfinished();
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            Ok(file) => {
                listed.push(path.clone());
                return Ok((file, Temporary(path)));
            }
            // Left behind by a killed process with the same number: take the next name.
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
}
