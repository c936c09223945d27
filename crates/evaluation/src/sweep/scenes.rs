//! Where scenes come from: generators, and real meshes where their files are.

use std::path::Path;
use std::sync::Arc;

use anyhow::Result;
use cloudtouch_geom::TriangleMesh;
use cloudtouch_io::{LengthUnit, read_mesh};
use cloudtouch_testkit::family::{Family, FamilyScene, Kind, Real, RealMeshes};

/// A family of scenes.
#[derive(Clone)]
pub struct Scenes {
    /// Its name in tables.
    pub name: &'static str,
    /// What it is for.
    pub kind: Kind,
    /// The variant that belongs to a seed.
    scene: Arc<dyn Fn(u64) -> FamilyScene + Send + Sync>,
}

impl From<Family> for Scenes {
    fn from(family: Family) -> Self {
        let scene = Arc::new(move |seed| family.scene(seed));
        Self { name: family.name(), kind: family.kind(), scene }
    }
}

impl Scenes {
    /// Every generator.
    pub fn generated() -> Vec<Self> {
        Family::ALL.iter().copied().map(Self::from).collect()
    }

    /// The families of real meshes; none, with a printed reason, where there are no such files.
    ///
    /// # Errors
    /// When a file is there and cannot be read.
    pub fn real(data: &Path) -> Result<Vec<Self>> {
        let folder = data.join("meshes");
        if !folder.is_dir() {
            println!(
                "skipped: families of real meshes, no {}; name it with --data",
                folder.display()
            );
            return Ok(Vec::new());
        }
        let read = |name: &str| -> Result<TriangleMesh> {
            Ok(read_mesh(folder.join(name), LengthUnit::Metres)?)
        };
        let meshes = Arc::new(RealMeshes {
            piano: read("piano_m.stl")?,
            room: read("room_m.stl")?,
            pr2_gripper: read("pr2_gripper_lowres.stl")?,
            panda_hand: read("panda_hand.obj")?,
        });
        let scenes = |real: Real| {
            let meshes = Arc::clone(&meshes);
            let scene = Arc::new(move |seed| real.scene(&meshes, seed));
            Self { name: real.name(), kind: Kind::Real, scene }
        };
        Ok(Real::ALL.iter().copied().map(scenes).collect())
    }

    /// The variant that belongs to a seed.
    pub fn scene(&self, seed: u64) -> FamilyScene {
        (self.scene)(seed)
    }

    /// A number that only depends on the name: adding a family changes no other.
    pub fn number(&self) -> u64 {
        self.name
            .bytes()
            .fold(0, |number, byte| cloudtouch_geom::seed::derive(number, byte.into(), 0))
    }
}
