//! A picture of one pose: what `cloudtouch query --ply` writes, seen from the side.

use std::{collections::BTreeMap, fmt::Write as _, fs, path::Path};

use anyhow::{Context, Result, bail};
use cloudtouch_geom::{Point3, Vector3};

use super::{
    Places,
    case_file::Case,
    tool::{Answer, Tool},
};

type Color = [u8; 3];

/// The tool's colours of the object and of contacts; a mesh has no point probabilities.
const OBJECT: Color = [70, 130, 220];
const CONTACT: Color = [30, 200, 60];
/// Where one looks from, in the camera's frame (x right, y down, z forward): from the right and a
/// little above, so that both fingers and the rim between them are seen.
const TOWARDS_EYE: [f64; 3] = [0.9, -0.25, -0.3];
/// Into the table, as the camera sees it.
const DOWN: [f64; 3] = [0.05, 0.8, 0.6];
/// What is shown, m around the likeliest contact: left, right, up, down.
const LEFT: f64 = 0.13;
const RIGHT: f64 = 0.13;
const UP: f64 = 0.165;
const BELOW: f64 = 0.1;
/// Depths between which brightness falls, m around the likeliest contact.
const DEPTH: f64 = 0.12;
/// Side of the squares that make the picture, m: of the points in one the likeliest is drawn, of
/// equally likely ones the nearest to the eye.
const SQUARE: f64 = 0.0012;
/// Side of a square on the screen, pixels.
const PIXELS: f64 = 3.0;
/// Contacts at least this likely are drawn.
const LIKELY: f64 = 0.5;
/// Length of a normal, m.
const NORMAL: f64 = 0.025;

/// Draws `gripper-mug.svg` from the coloured points of one case.
pub(super) fn draw(
    tool: &Tool,
    places: &Places,
    case: &Case,
    answer: &Answer,
    sensor: &str,
) -> Result<()> {
    let points = colored_points(tool, places, case, sensor)?;
    let first = answer.contacts.first().context("the pictured case has no contact")?;
    let view = View::around(first.point());
    let path = places.figures.join("gripper-mug.svg");
    fs::write(&path, svg(&view, &points, answer))
        .with_context(|| format!("write {}", path.display()))
}

/// Runs the query again for its picture file.
fn colored_points(
    tool: &Tool,
    places: &Places,
    case: &Case,
    sensor: &str,
) -> Result<Vec<(Point3, Color)>> {
    let pose = places.work.join("gripper-mug.pose.json");
    fs::write(&pose, serde_json::to_string(&case.pose)?)?;
    let ply = places.work.join("gripper-mug.ply");
    let output = tool
        .command("query")
        .args([&case.scene, &case.object, "--sensor", sensor])
        .arg("--pose")
        .arg(&pose)
        .arg("--ply")
        .arg(&ply)
        .output()?;
    if !output.status.success() {
        bail!("cloudtouch query --ply: {}", String::from_utf8_lossy(&output.stderr));
    }
    read_colored_ply(&ply)
}

/// Reads the one layout the tool writes: three little-endian doubles and three bytes a point, and
/// whatever follows them.
fn read_colored_ply(path: &Path) -> Result<Vec<(Point3, Color)>> {
    const END: &[u8] = b"end_header\n";
    const NEEDED: usize = 27;
    let bytes = fs::read(path).with_context(|| format!("read {}", path.display()))?;
    let start =
        bytes.windows(END.len()).position(|w| w == END).context("no PLY header")? + END.len();
    let header = String::from_utf8_lossy(&bytes[..start]);
    let count = header
        .lines()
        .find_map(|line| line.strip_prefix("element vertex "))
        .and_then(|count| count.trim().parse::<usize>().ok())
        .filter(|&count| count > 0)
        .context("no points in the PLY header")?;
    let rows = &bytes[start..];
    let row_length = rows.len() / count;
    if row_length < NEEDED || row_length * count != rows.len() {
        bail!("{}: rows are not of {NEEDED} bytes or more", path.display());
    }
    let number = |row: &[u8], i: usize| {
        let mut eight = [0; 8];
        eight.copy_from_slice(&row[8 * i..8 * i + 8]);
        f64::from_le_bytes(eight)
    };
    let point = |row: &[u8]| Point3::new(number(row, 0), number(row, 1), number(row, 2));
    Ok(rows.chunks_exact(row_length).map(|row| (point(row), [row[24], row[25], row[26]])).collect())
}

/// An orthographic projection.
struct View {
    center: Point3,
    right: Vector3,
    down: Vector3,
    towards_eye: Vector3,
}

impl View {
    fn around(center: Point3) -> Self {
        let towards_eye = Vector3::from(TOWARDS_EYE).normalize();
        let right = Vector3::from(DOWN).cross(&-towards_eye).normalize();
        Self { center, right, down: (-towards_eye).cross(&right), towards_eye }
    }

    /// Across, down and towards the eye, m from the centre.
    fn project(&self, point: &Point3) -> [f64; 3] {
        let offset = point - self.center;
        [offset.dot(&self.right), offset.dot(&self.down), offset.dot(&self.towards_eye)]
    }

    /// Column and row of the picture, in squares.
    fn position(&self, point: &Point3) -> [f64; 2] {
        let [x, y, _] = self.project(point);
        [(x + LEFT) / SQUARE, (y + UP) / SQUARE]
    }
}

/// The points that are seen, then contacts with their normals; lengths in squares.
fn svg(view: &View, points: &[(Point3, Color)], answer: &Answer) -> String {
    let [width, height] = [(LEFT + RIGHT) / SQUARE, (UP + BELOW) / SQUARE].map(f64::floor);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
         width=\"{}\" height=\"{}\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
        width * PIXELS,
        height * PIXELS,
    );
    for (color, squares) in seen(view, points) {
        // A little wider than a square, so that no seams show; one path for each color, and one
        // line for squares side by side, keep the file small.
        let _ = write!(svg, "<path stroke=\"{}\" stroke-width=\"1.1\" d=\"", hex(color));
        for [row, column, length] in runs(&squares) {
            let _ = write!(svg, "M{column} {row}.5h{length}");
        }
        svg += "\"/>\n";
    }
    let green = hex(CONTACT);
    for contact in answer.contacts.iter().filter(|c| c.probability >= LIKELY) {
        let [x, y] = view.position(&contact.point());
        let [to_x, to_y] = view.position(&(contact.point() + contact.normal() * NORMAL));
        let _ = writeln!(
            svg,
            "<path stroke=\"{green}\" stroke-width=\"0.7\" d=\"M{x:.1} {y:.1}L{to_x:.1} {to_y:.1}\"/>\
             <circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"1.2\" fill=\"{green}\"/>",
        );
    }
    svg += "</svg>\n";
    svg
}

fn hex([r, g, b]: Color) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Row, first column and number of squares side by side; the squares are given in that order.
fn runs(squares: &[[i32; 2]]) -> Vec<[i32; 3]> {
    let mut runs: Vec<[i32; 3]> = Vec::new();
    for &[row, column] in squares {
        match runs.last_mut() {
            Some(last) if last[0] == row && last[1] + last[2] == column => last[2] += 1,
            _ => runs.push([row, column, 1]),
        }
    }
    runs
}

/// Rows and columns of the squares to fill, in order, by their colour.
fn seen(view: &View, points: &[(Point3, Color)]) -> BTreeMap<Color, Vec<[i32; 2]>> {
    let mut squares: BTreeMap<[i32; 2], (u8, f64, Color)> = BTreeMap::new();
    for (point, color) in points.iter().filter(|(_, color)| *color != CONTACT) {
        let [column, row] = view.position(point).map(f64::floor);
        let inside = |at: f64, length: f64| at >= 0.0 && at < (length / SQUARE).floor();
        if !(inside(column, LEFT + RIGHT) && inside(row, UP + BELOW)) {
            continue;
        }
        let [_, _, depth] = view.project(point);
        let square = [row as i32, column as i32];
        let (redness, shade) = (redness(*color), shaded(*color, depth));
        let held = squares.entry(square).or_insert((redness, depth, shade));
        if (redness, depth) > (held.0, held.1) {
            *held = (redness, depth, shade);
        }
    }
    let mut by_color = BTreeMap::new();
    for (square, (_, _, color)) in squares {
        by_color.entry(color).or_insert_with(Vec::new).push(square);
    }
    by_color
}

/// How likely a scene point collides, in five steps; zero for the object.
fn redness(color: Color) -> u8 {
    if color == OBJECT { 0 } else { color[0].saturating_sub(color[1]) / 38 }
}

/// Darker the farther from the eye, in few steps so that there are few colours.
fn shaded(color: Color, depth: f64) -> Color {
    const STEPS: f64 = 24.0;
    let nearness = ((0.5 * depth / DEPTH + 0.5).clamp(0.0, 1.0) * STEPS).round() / STEPS;
    let light = if redness(color) == 0 { 0.5 + 0.65 * nearness } else { 1.0 };
    // Rounded, which joins shades that look alike.
    color.map(|c| ((f64::from(c) * light / 5.0).round() * 5.0).min(255.0) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_point_hides_others_unless_they_are_likely() {
        let view = View::around(Point3::origin());
        let at = |depth: f64| Point3::origin() + view.towards_eye * depth;
        let (grey, red) = ([170; 3], [220, 30, 20]);
        let colors = |points: &[(Point3, Color)]| -> Vec<Color> {
            let seen = seen(&view, points);
            assert!(seen.values().all(|squares| squares.len() == 1));
            seen.into_keys().collect()
        };
        let hidden = colors(&[(at(0.0), grey), (at(0.05), OBJECT), (at(0.1), CONTACT)]);
        assert_eq!(hidden, [shaded(OBJECT, 0.05)]);
        assert_eq!(colors(&[(at(0.0), red), (at(0.05), OBJECT)]), [shaded(red, 0.0)]);
    }

    #[test]
    fn squares_side_by_side_are_one_line() {
        let lines = runs(&[[0, 1], [0, 2], [0, 4], [1, 5]]);
        assert_eq!(lines, [[0, 1, 2], [0, 4, 1], [1, 5, 1]]);
    }

    #[test]
    fn the_view_is_right_handed_and_down_is_down() {
        let view = View::around(Point3::origin());
        assert!((view.right.cross(&view.down) + view.towards_eye).norm() < 1e-12);
        assert!(view.down.dot(&Vector3::from(DOWN)) > 0.5);
    }
}
