//! `cargo run -p cloudtouch-testkit --example families -- FOLDER [SEED]`: a picture of each family in
//! FOLDER, the body that stays in grey and the moving one in orange, in collision; and a table of
//! sizes, spacings and of the time that a scene and 32 poses take.

use std::{error::Error, fmt::Write, path::PathBuf, time::Instant};

use cloudtouch_geom::{Point3, TriangleMesh, Vector3};
use cloudtouch_testkit::{
    family::{Family, Side},
    scene::{moved, subdivide_to_max_edge},
};

/// The longer side of a picture, pixels.
const SIZE: f64 = 900.0;

/// Red, green and blue of the two bodies in full light.
const COLORS: [[f64; 3]; 2] = [[220.0, 220.0, 230.0], [250.0, 143.0, 66.0]];

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = PathBuf::from(arguments.next().ok_or("name a folder for the pictures")?);
    let seed = arguments.next().map_or(Ok(1), |s| s.parse())?;
    std::fs::create_dir_all(&folder)?;
    println!("| family | s for 32 poses | triangles of A, B | spacing of 10,000 points, cm |");
    println!("| --- | --- | --- | --- |");
    for family in Family::ALL {
        let start = Instant::now();
        let scene = family.scene(seed);
        let poses = scene.poses(32, seed);
        let seconds = start.elapsed().as_secs_f64();
        let [many, few] = [&scene.a, &scene.b].map(|body| body.mesh().triangles().len());
        let [a, b] = [Side::A, Side::B].map(|side| 100.0 * scene.spacing(side, 10_000));
        println!("| {} | {seconds:.2} | {many}, {few} | {a:.1}, {b:.1} |", family.name());
        let colliding = poses.iter().find(|p| p.in_collision).ok_or("half of them collide")?;
        let moving = moved(scene.b.mesh(), &colliding.scene_from_object);
        // The table is in the frame of a camera, the others have z up.
        let [right, up] = match family {
            Family::Tabletop => [Vector3::x(), -Vector3::y()],
            _ => [Vector3::new(0.88, 0.48, 0.0), Vector3::new(-0.26, 0.48, 0.84)],
        };
        let svg = picture([scene.a.mesh(), &moving], right.normalize(), up.normalize())?;
        std::fs::write(folder.join(format!("{}.svg", family.name())), svg)?;
    }
    Ok(())
}

/// Triangles from far to near, along `up` × `right`; their order is that of their middles, so that
/// large ones may hide what is close before them.
fn picture(
    bodies: [&TriangleMesh; 2],
    right: Vector3,
    up: Vector3,
) -> Result<String, std::fmt::Error> {
    let away = up.cross(&right);
    let lamp = Vector3::new(0.3, -0.5, 0.8);
    let mut faces: Vec<(f64, [Point3; 3], [u8; 3])> = Vec::new();
    for (body, color) in bodies.into_iter().zip(COLORS) {
        let fine = subdivide_to_max_edge(body, 0.1);
        let is_closed = fine.open_edges() == 0;
        for corners in (0..fine.triangles().len()).map(|t| fine.corners(t)) {
            let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).normalize();
            if is_closed && normal.dot(&away) > 0.0 {
                continue;
            }
            let light = 0.3 + 0.7 * normal.dot(&lamp).abs().min(1.0);
            let depth = corners.iter().map(|p| p.coords.dot(&away)).sum();
            faces.push((depth, corners, color.map(|c| (c * light) as u8)));
        }
    }
    faces.sort_by(|a, b| b.0.total_cmp(&a.0));
    let flat = |p: &Point3| [p.coords.dot(&right), -p.coords.dot(&up)];
    let all = || faces.iter().flat_map(|(_, corners, _)| corners.iter().map(flat));
    let low = [0, 1].map(|k| all().map(|p| p[k]).fold(f64::INFINITY, f64::min));
    let high = [0, 1].map(|k| all().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max));
    let scale = SIZE / (high[0] - low[0]).max(high[1] - low[1]);
    let [width, height] = [0, 1].map(|k| (high[k] - low[k]) * scale);
    let mut svg = String::new();
    writeln!(svg, "<svg xmlns='http://www.w3.org/2000/svg' width='{width}' height='{height}'>")?;
    for (_, corners, [r, g, b]) in &faces {
        let [p, q, s] = corners.each_ref().map(|corner| {
            let [x, y] = flat(corner);
            format!("{:.1} {:.1}", (x - low[0]) * scale, (y - low[1]) * scale)
        });
        let color = format!("#{r:02x}{g:02x}{b:02x}");
        writeln!(svg, "<path d='M{p} {q} {s}z' fill='{color}' stroke='{color}'/>")?;
    }
    Ok(svg + "</svg>\n")
}
