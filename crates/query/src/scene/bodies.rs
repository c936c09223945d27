//! The bodies of a scene: added, replaced, moved, removed.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use cloudtouch_geom::Pose;

use crate::body::Body;
use crate::check::coordinates::bad_entry;
use crate::error::SceneError;

/// Named bodies, each with its own pose, of which [`Self::check`] tells which may touch.
///
/// A pose maps the file frame of a body into that of the scene, or of the body it is attached to, m.
/// Moving a body costs nothing: what a check needs to know of their poses it finds out by itself. A body is owned by the scene or
/// shared, and may be in it under several names.
///
/// ```
/// use std::sync::Arc;
/// use cloudtouch::geom::{Point3, PointCloud, Pose, Vector3};
/// use cloudtouch::noise::SensorModel;
/// use cloudtouch::{Body, Cloud, CloudSettings, Query, QuerySettings, Scene, Verdict};
///
/// let sheet: Vec<Point3> =
///     (0..400).map(|i| Point3::new(0.01 * (i % 20) as f64, 0.01 * (i / 20) as f64, 0.0)).collect();
/// let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.001 });
/// let plate = Arc::new(Body::from(Cloud::prepare(&PointCloud::from_points(sheet), &settings)?));
/// let at = |z: f64| Pose::from_translation(Vector3::new(0.0, 0.0, z));
///
/// let mut scene = Scene::default();
/// scene.add("table", Arc::clone(&plate), at(0.0))?;
/// scene.add("tray", Arc::clone(&plate), at(0.3))?;
/// scene.add("plate", plate, at(0.3))?;
/// scene.attach("plate", "tray", at(0.0))?;
/// scene.allow("plate", "tray")?;
///
/// let query = Query::new(QuerySettings::default())?;
/// assert_eq!(scene.check(&query).verdict(), Verdict::Free);
/// scene.set_pose("tray", at(0.0))?;
/// let found = scene.check(&query);
/// assert_ne!(found.verdict(), Verdict::Free);
/// assert_eq!(found.pairs.len(), 2, "the plate came along");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Scene {
    pub(super) bodies: BTreeMap<String, Placed>,
    /// Pairs that may touch, each by its names in order.
    pub(super) allowed: BTreeSet<[String; 2]>,
}

/// A body and where it is.
#[derive(Debug, Clone)]
pub(super) struct Placed {
    pub body: Arc<Body>,
    /// Into the frame of what it is attached to, or else of the scene.
    pub pose: Pose,
    pub attached_to: Option<String>,
}

impl Scene {
    /// Adds a body, owned or shared, at its pose in the scene.
    ///
    /// # Errors
    /// When the name is taken, or the pose is not finite or beyond 1e10 m.
    pub fn add(
        &mut self,
        name: impl Into<String>,
        body: impl Into<Arc<Body>>,
        scene_from_body: Pose,
    ) -> Result<(), SceneError> {
        let name = name.into();
        if self.bodies.contains_key(&name) {
            return Err(SceneError::NameTaken { name });
        }
        check(&name, &scene_from_body)?;
        let placed = Placed { body: body.into(), pose: scene_from_body, attached_to: None };
        self.bodies.insert(name, placed);
        Ok(())
    }

    /// Puts another body in the place of one, such as a new scan of the same thing, and returns that.
    ///
    /// # Errors
    /// When there is no body of this name.
    pub fn replace(
        &mut self,
        name: &str,
        body: impl Into<Arc<Body>>,
    ) -> Result<Arc<Body>, SceneError> {
        Ok(std::mem::replace(&mut self.placed_mut(name)?.body, body.into()))
    }

    /// Removes a body and the pairs that it was allowed in.
    ///
    /// # Errors
    /// When there is no body of this name, or others are attached to it.
    pub fn remove(&mut self, name: &str) -> Result<Arc<Body>, SceneError> {
        let body = Arc::clone(&self.placed(name)?.body);
        let is_held = |placed: &Placed| placed.attached_to.as_deref() == Some(name);
        if let Some((attached, _)) = self.bodies.iter().find(|(_, placed)| is_held(placed)) {
            let (name, attached) = (name.to_owned(), attached.clone());
            return Err(SceneError::HoldsOthers { name, attached });
        }
        self.bodies.remove(name);
        self.allowed.retain(|pair| !pair.iter().any(|of_pair| of_pair == name));
        Ok(body)
    }

    /// Moves a body, and what is attached to it: `pose` maps into the frame of what it is itself
    /// attached to, or else of the scene.
    ///
    /// # Errors
    /// When there is no body of this name, or the pose is not finite or beyond 1e10 m.
    pub fn set_pose(&mut self, name: &str, pose: Pose) -> Result<(), SceneError> {
        let placed = self.placed_mut(name)?;
        check(name, &pose)?;
        placed.pose = pose;
        Ok(())
    }

    /// A body.
    ///
    /// # Errors
    /// When there is none of this name.
    pub fn body(&self, name: &str) -> Result<&Arc<Body>, SceneError> {
        Ok(&self.placed(name)?.body)
    }

    /// A body to be changed, such as a cloud that points are inserted in.
    ///
    /// # Errors
    /// When there is none of this name, or it is shared.
    pub fn body_mut(&mut self, name: &str) -> Result<&mut Body, SceneError> {
        let shared = || SceneError::Shared { name: name.to_owned() };
        Arc::get_mut(&mut self.placed_mut(name)?.body).ok_or_else(shared)
    }

    /// The names of all bodies, in order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.bodies.keys().map(String::as_str)
    }

    pub(super) fn placed(&self, name: &str) -> Result<&Placed, SceneError> {
        self.bodies.get(name).ok_or_else(|| SceneError::UnknownName { name: name.to_owned() })
    }

    pub(super) fn placed_mut(&mut self, name: &str) -> Result<&mut Placed, SceneError> {
        let unknown = || SceneError::UnknownName { name: name.to_owned() };
        self.bodies.get_mut(name).ok_or_else(unknown)
    }
}

/// Whether a pose can be reckoned with.
pub(super) fn check(name: &str, pose: &Pose) -> Result<(), SceneError> {
    match bad_entry(pose) {
        Some(value) => Err(SceneError::Pose { name: name.to_owned(), value }),
        None => Ok(()),
    }
}
