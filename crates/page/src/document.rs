//! The whole document.

use crate::answer::{list, section};
use crate::data;
use crate::escape;
use crate::page::Page;

/// Made of the sources in `viewer/` of the project.
const VIEWER: &str = include_str!("../viewer/viewer.js");
const LICENSE_OF_THREE: &str = include_str!("../viewer/LICENSE-three.txt");
const STYLE: &str = include_str!("page.css");

/// Where no script chooses an answer, all of them are there, and no legend of a picture that is not.
const ALL: &str = "section.answer[hidden] { display: block; } #legend { display: none; }";

/// Nothing is fetched from anywhere, whatever a file name says.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'";

impl Page<'_> {
    /// The page as one HTML document that needs nothing else: the same bytes for the same input.
    pub fn html(&self) -> String {
        let (data, more_notes) = data::of_page(self);
        // Numbers and strings always serialise.
        let data = escape::json(&serde_json::to_string(&data).unwrap_or_default());
        let title = escape::html(&self.title);
        let notes = self.notes.iter().chain(&more_notes);
        let notes: String = notes.map(|note| format!("<p>{}</p>\n", escape::html(note))).collect();
        let views = self.views.iter().enumerate();
        let answers: String = views.map(|(number, view)| section(number, view, self)).collect();
        let has_others = self.views.iter().any(|view| !view.around.is_empty());
        let others = if has_others { OTHERS } else { "" };
        let legend = LEGEND.replace("{others}", others);
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
             <title>{title}</title>\n<style>\n{STYLE}</style>\n\
             <noscript><style>{ALL}</style></noscript>\n</head>\n<body>\n\
             <main>\n<div id=\"picture\"><noscript><p>The picture needs JavaScript; the answers \
             beside it do not.</p></noscript>\n{legend}</div>\n\
             <aside>\n<h1>{title}</h1>\n<div id=\"poses\"></div>\n{}{answers}{PICTURE}\
             <div class=\"small\">\n{notes}<p>Drawn by cloudtouch {}.</p>\n\
             <details><summary>Licence of three.js, which draws the picture</summary>\
             <pre>{}</pre></details>\n</div>\n</aside>\n</main>\n\
             <script type=\"application/json\" id=\"data\">{data}</script>\n\
             <script>\n{VIEWER}</script>\n</body>\n</html>\n",
            list(&self.summary),
            env!("CARGO_PKG_VERSION"),
            escape::html(LICENSE_OF_THREE),
        )
    }
}

/// Beside the picture, whose script fills in the colours.
const LEGEND: &str = "\
<div id=\"legend\">
<p><span><i class=\"dot scene\"></i> scene</span><span><i class=\"dot object\"></i> object</span>\
{others}<span>&#10140; contact</span></p>
<div class=\"scale\" aria-hidden=\"true\"></div>
<p><span>unlikely</span><span>probability</span><span>certain</span></p>
</div>
";

/// Of what else is drawn.
const OTHERS: &str = "<span><i class=\"dot around\"></i> others</span>";

const PICTURE: &str = "\
<h3>The picture</h3>
<p>The darker a coloured point or disc, the likelier the surfaces meet there; 0 is yellow, 1 dark \
red. A disc is a contact, as large as the surface that belongs to it; its arrow points from the scene \
to the object. Shades of grey and blue are as bright as the file shows the points, or else \
lighter where they are lower. Points without a colour were not found near the other body. Drag to turn, \
scroll or pinch to come nearer. The scale bar is true at the middle of the picture.</p>
";

/// A page within another, as notebooks show it: a frame that keeps its styles and scripts to itself.
/// `height` is in pixels.
pub fn notebook_frame(page: &Page<'_>, height: u32) -> String {
    format!(
        "<iframe sandbox=\"allow-scripts\" style=\"width:100%;height:{height}px;border:0\" \
         title=\"{}\" srcdoc=\"{}\"></iframe>",
        escape::html(&page.title),
        escape::html(&page.html())
    )
}
