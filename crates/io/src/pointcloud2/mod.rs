//! Point clouds as ROS sends and records them: the bytes of a `sensor_msgs/PointCloud2`.

mod cursor;
mod header;
mod parse;

pub use cursor::Encoding;
pub use parse::{Scan, frame_id, parse, parse_within};
