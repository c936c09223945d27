//! What can be wrong with a robot's description, in words.

use std::path::{Path, PathBuf};

use cloudtouch::PrepareError;
use cloudtouch_io::ReadError;

/// Why a file does not describe a robot that can be checked.
#[derive(Debug, thiserror::Error)]
#[error("{}: {fault}", file.display())]
pub struct RobotError {
    /// The URDF or SRDF.
    pub file: PathBuf,
    /// What is wrong with it.
    pub fault: Box<RobotFault>,
}

/// What is wrong with a robot's description.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RobotFault {
    /// The file cannot be read.
    #[error("cannot be read: {reason}")]
    File {
        /// What the system said.
        reason: std::io::Error,
    },
    /// The file is larger than is read.
    #[error(
        "has more than {limit} bytes, the most that is read: give the description of a robot, or raise the \
         limit on bytes"
    )]
    TooLarge {
        /// Bytes read at most, [`ReadLimits::bytes`](cloudtouch_io::ReadLimits::bytes).
        limit: u64,
    },
    /// Not text, or in another encoding.
    #[error("is not text in UTF-8 from byte {byte} on, counted from 0: save it as UTF-8")]
    Encoding {
        /// The first that is not.
        byte: usize,
    },
    /// A URDF in the place of an SRDF.
    #[error("is a URDF, which does not say which links may touch: give the SRDF of the robot")]
    NotSrdf,
    /// An SRDF in the place of a URDF.
    #[error("is an SRDF, which has no links: give the URDF of the robot")]
    NotUrdf,
    /// Another kind of file.
    #[error("is {found}: its root is <{root}>, and that of {wanted} is <robot>; {remedy}")]
    Root {
        /// What it is.
        found: &'static str,
        /// The element around all of it.
        root: String,
        /// What was asked for.
        wanted: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// Text without any element.
    #[error("is no description of a robot, for there is no <robot> in it: {remedy}")]
    NoRoot {
        /// What to do.
        remedy: &'static str,
    },
    /// Two files in one.
    #[error(
        "has a second root, <{root}>, of which nothing would be read: put all in one <robot>, or remove it"
    )]
    SecondRoot {
        /// The element around all that comes after the first.
        root: String,
    },
    /// Nothing is in it.
    #[error("is empty: give a file that describes the robot in a <robot> element")]
    Empty,
    /// Not XML, or not of its schema.
    #[error(
        "cannot be understood: {reason}; if it is made from a .xacro, expand that first, with \
         `xacro arm.xacro > arm.urdf`"
    )]
    Xml {
        /// What the parser said.
        reason: String,
    },
    /// A number is NaN or infinite.
    #[error("{of} has {value} for its {what}: every number must be finite")]
    NotFinite {
        /// Link or joint.
        of: String,
        /// Which number.
        what: &'static str,
        /// What was found.
        value: f64,
    },
    /// An angle of more than a whole turn, as of degrees.
    #[error("{of} has {value} for its origin rpy: more than a whole turn; write radians")]
    Turn {
        /// The link or joint.
        of: String,
        /// What was found.
        value: f64,
    },
    /// Two links or two joints of one name.
    #[error("{what} `{name}` appears twice: names must differ")]
    Repeated {
        /// Link or joint.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// A joint joins a link that is not there.
    #[error("joint `{joint}` has the {role} `{link}`, and there is no such link: correct the name")]
    UnknownLink {
        /// The joint.
        joint: String,
        /// Parent or child.
        role: &'static str,
        /// The name.
        link: String,
    },
    /// A link hangs on two joints.
    #[error("link `{link}` is the child of two joints, one of them `{joint}`: remove one")]
    TwoParents {
        /// The link.
        link: String,
        /// The second of its joints.
        joint: String,
    },
    /// Links are not one tree.
    #[error(
        "links do not hang on one root (`{root}`): no chain of joints leads to `{link}`; join it, or remove it"
    )]
    NotATree {
        /// The first link that is nobody's child.
        root: String,
        /// Another one.
        link: String,
    },
    /// Links that carry themselves.
    #[error(
        "link `{link}` is carried by itself, for joints lead around a circle: correct the parent of one of them, or \
         remove it"
    )]
    Circle {
        /// One of the links in the circle.
        link: String,
    },
    /// A joint that one number does not move.
    #[error(
        "joint `{joint}` is {kind}, which one position does not place: make it fixed, and give the pose of the base"
    )]
    JointKind {
        /// The joint.
        joint: String,
        /// Its kind.
        kind: &'static str,
    },
    /// A joint has no direction to move in.
    #[error("joint `{joint}` has an axis of length zero: give a direction, such as 0 0 1")]
    NoAxis {
        /// The joint.
        joint: String,
    },
    /// A joint that turns or slides by itself, and nothing says how far.
    #[error(
        "joint `{joint}` has no <limit> with a range, which a {kind} joint needs: add <limit lower=\"…\" \
         upper=\"…\" effort=\"…\" velocity=\"…\"/>, or make it {instead}"
    )]
    NoLimit {
        /// The joint.
        joint: String,
        /// Its kind.
        kind: &'static str,
        /// A kind without limits.
        instead: &'static str,
    },
    /// A lower limit above the upper.
    #[error("joint `{joint}` has the limits {lower} .. {upper}: the lower must not be the greater")]
    Limits {
        /// The joint.
        joint: String,
        /// rad or m.
        lower: f64,
        /// rad or m.
        upper: f64,
    },
    /// A joint follows one that it cannot follow.
    #[error(
        "joint `{joint}` mimics `{followed}`, which is not a joint that moves by itself: name one that does"
    )]
    Mimic {
        /// The joint.
        joint: String,
        /// What it names.
        followed: String,
    },
    /// A size that is no size.
    #[error("link `{link}` has {value} for its {what}: it must be above 0")]
    Size {
        /// The link.
        link: String,
        /// Which size.
        what: &'static str,
        /// What was found.
        value: f64,
    },
    /// A package whose folder is not known.
    #[error(
        "link `{link}`: {uri}: the folder of package `{package}` is not known: name it in `packages`"
    )]
    UnknownPackage {
        /// The link.
        link: String,
        /// Where its mesh is said to be.
        uri: String,
        /// The package.
        package: String,
    },
    /// A mesh is somewhere that is not looked at.
    #[error(
        "link `{link}`: {uri}: only package://, file:// and plain paths are read: copy the file"
    )]
    Scheme {
        /// The link.
        link: String,
        /// Where its mesh is said to be.
        uri: String,
    },
    /// A mesh without a file.
    #[error("link `{link}`: its <mesh> has an empty filename: name the file of the mesh")]
    UnnamedMesh {
        /// The link.
        link: String,
    },
    /// A mesh file is not there.
    #[error(
        "link `{link}`: {uri}: there is no file {}: correct the path, or the folder of its package",
        path.display()
    )]
    MissingMesh {
        /// The link.
        link: String,
        /// As the URDF says.
        uri: String,
        /// Where it was looked for.
        path: PathBuf,
    },
    /// A mesh in a format that is not read.
    #[error(
        "link `{link}`: {uri}: COLLADA (.dae) is not read: convert it to STL or OBJ (Blender, MeshLab, \
         assimp export) and name that in <collision>"
    )]
    Collada {
        /// The link.
        link: String,
        /// As the URDF says.
        uri: String,
    },
    /// A mesh cannot be read.
    #[error("link `{link}`: {error}")]
    Mesh {
        /// The link.
        link: String,
        /// What is wrong with the file.
        error: ReadError,
    },
    /// A mesh cannot be used.
    #[error("link `{link}`: {geometry}: {error}")]
    Prepare {
        /// The link.
        link: String,
        /// The mesh file, or the primitive.
        geometry: String,
        /// Why.
        error: PrepareError,
    },
    /// A mesh of a size that cannot be meant.
    #[error(
        "link `{link}`: {uri} is {size:.3} m across, and the whole robot reaches {reach:.3} m by its \
         joints: is the mesh in millimetres (scale=\"0.001 0.001 0.001\"), or scaled twice?"
    )]
    LinkSize {
        /// The link.
        link: String,
        /// As the URDF says.
        uri: String,
        /// Diagonal of its box, m.
        size: f64,
        /// Sum of the distances between joints, m.
        reach: f64,
    },
    /// Nothing can collide.
    #[error("no link has <collision> geometry: nothing could be found to touch; add it")]
    NoGeometry,
}

impl RobotFault {
    pub(crate) fn of(self, file: &Path) -> RobotError {
        RobotError { file: file.to_owned(), fault: Box::new(self) }
    }

    /// Of triangles that were scaled or made.
    pub(crate) fn prepare(link: &str, geometry: &str, error: impl Into<PrepareError>) -> Self {
        let (link, geometry) = (link.to_owned(), geometry.to_owned());
        Self::Prepare { link, geometry, error: error.into() }
    }
}
