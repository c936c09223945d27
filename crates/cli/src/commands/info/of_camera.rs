//! What a camera sees.

use cloudtouch::geom::PointCloud;
use cloudtouch_io::DepthCamera;

/// The camera of a depth image, and how wide it sees.
pub(super) fn describe_camera(camera: &DepthCamera, cloud: &PointCloud) -> String {
    let DepthCamera { fx, fy, cx, cy, depth_scale, .. } = camera;
    let (width, height) = cloud.image_size.unwrap_or_default();
    let seen = |focal_length: f64, middle: f64, pixels: usize| {
        let edges = [-0.5 - middle, pixels as f64 - 0.5 - middle];
        let [from, to] = edges.map(|edge| (edge / focal_length).atan().to_degrees());
        to - from
    };
    let (across, down) = (seen(*fx, *cx, width), seen(*fy, *cy, height));
    format!(
        "camera      fx {fx}, fy {fy}, cx {cx}, cy {cy} pixels, {depth_scale} m a step: sees {across:.1} x \
         {down:.1} degrees"
    )
}
