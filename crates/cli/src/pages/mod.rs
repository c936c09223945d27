//! `--html`: what a command knows, as a report page shows it.

pub(crate) mod batch;
pub(crate) mod path;
pub(crate) mod robot;
pub(crate) mod scene;

use std::path::Path;

use anyhow::Result;
use cloudtouch_io::{ReadLimits, read_colors_within, write_atomically};
use cloudtouch_page::{Body as Drawn, Page, Shape};

use crate::answers::print;
use crate::body::{Body, PreparedCloud};
use crate::load::Loaded;
use crate::remedies;

/// Writes a page whole or not at all, which tells this tool's options.
pub(crate) fn write(path: &Path, page: Page<'_>) -> Result<()> {
    let page = Page { remedy: Some(remedies::of_warning), ..page };
    Ok(write_atomically(path, |out| out.write_all(page.html().as_bytes()))?)
}

/// A body as a page draws it, as bright as `file` shows it, if that has colours.
pub(crate) fn body<C: PreparedCloud>(
    loaded: &Loaded<C>,
    file: Option<&Path>,
    limits: &ReadLimits,
) -> Result<Drawn> {
    let shape = match &loaded.body {
        Body::Mesh(mesh) => mesh.into(),
        Body::Cloud(cloud) => {
            let colors = file.map(|file| read_colors_within(file, limits)).transpose()?.flatten();
            let bright = |colors: Vec<[u8; 3]>| {
                let of_row = |row: &usize| colors.get(*row).map(luminance);
                cloud.file_rows().iter().map(of_row).collect::<Option<Vec<u8>>>()
            };
            let brightness = colors.and_then(bright).filter(|b| b.len() == cloud.count());
            Shape::Cloud { points: cloud.points(), brightness }
        }
    };
    Ok(Drawn { name: loaded.input.short.clone(), about: print::about(loaded), shape })
}

/// How bright a colour looks (ITU-R BT.601).
fn luminance(&[r, g, b]: &[u8; 3]) -> u8 {
    (0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b)).round() as u8
}
