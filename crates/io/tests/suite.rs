//! All tests of this crate's interface, one module a behaviour: one program to link.

mod depth;
mod hostile;
mod limits;
mod line_ends;
mod obj;
mod other_readers;
mod pcd;
mod ply;
mod pointcloud2;
mod read;
mod real_scans;
mod recording;
mod ros;
mod rosbags;
mod stl;
mod write;
mod xyz;
