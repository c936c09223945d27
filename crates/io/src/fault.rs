//! What is wrong with some bytes: where among them, what was found, and what to do.

use std::fmt;

use cloudtouch_geom::{
    CovarianceError,
    message::{number, rounded},
};

use crate::depth_camera::CameraError;

/// Why some bytes are not a file of their format.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub struct FormatError {
    /// Where in the file.
    pub place: Place,
    /// What is wrong there.
    pub fault: Fault,
}

impl fmt::Display for FormatError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.place {
            Place::Whole => self.fault.fmt(f),
            place => write!(f, "{place}: {}", self.fault),
        }
    }
}

/// A place in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// Nowhere more than elsewhere.
    Whole,
    /// A line of text, from 1.
    Line(usize),
    /// A value in a line of text.
    Column {
        /// The line, from 1.
        line: usize,
        /// Which value of the line, from 1; a leading keyword does not count.
        column: usize,
    },
    /// A byte, from 0.
    Byte(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole => write!(f, "the file"),
            Self::Line(line) => write!(f, "line {line}"),
            Self::Column { line, column } => write!(f, "line {line}, column {column}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

impl Place {
    /// The error of finding `fault` here.
    pub(crate) fn error(self, fault: Fault) -> FormatError {
        FormatError { place: self, fault }
    }
}

/// What is wrong at some place of a file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// There is nothing in it.
    #[error("the file is empty: was it written completely?")]
    Empty,
    /// Text of two bytes a character, as Windows PowerShell and "Unicode text" of spreadsheets write it.
    #[error("the text is in UTF-16: save it as UTF-8")]
    Utf16,
    /// It does not begin as its format demands.
    #[error("found {found:?}, expected {expected}: is the file extension right?")]
    WrongMagic {
        /// How such a file begins.
        expected: &'static str,
        /// How this one does.
        found: String,
    },
    /// Something the format demands is not there.
    #[error("there is no {entry}: add it")]
    MissingEntry {
        /// What is missing.
        entry: &'static str,
    },
    /// A column is not there that has to be.
    #[error("there is no column {name}: it needs x, y, z, and all six of cov_* or none")]
    MissingColumn {
        /// Its name.
        name: &'static str,
    },
    /// Something has a value that cannot be used.
    #[error("{entry} is {found:?}, expected {expected}")]
    BadEntry {
        /// What it is a value of.
        entry: &'static str,
        /// The value.
        found: String,
        /// What can be used.
        expected: &'static str,
    },
    /// A PCD header counts its points in two ways that differ.
    #[error(
        "POINTS is {points}, and WIDTH times HEIGHT is {width} times {height}: correct what is wrong; the points \
         of no image have WIDTH {points} and HEIGHT 1"
    )]
    PointCount {
        /// What POINTS says.
        points: usize,
        /// What WIDTH says.
        width: usize,
        /// What HEIGHT says, 1 without.
        height: usize,
    },
    /// Something that can be there once is there twice.
    #[error("{entry} appears a second time: keep one")]
    Repeated {
        /// What it is.
        entry: String,
    },
    /// A binary file is shorter than its header says.
    #[error(
        "the header promises {promised} rows, which take {needed} bytes, and {available} bytes \
         follow: the file is cut off or its header is wrong"
    )]
    TooShort {
        /// Rows promised.
        promised: usize,
        /// Bytes they take, at least.
        needed: usize,
        /// Bytes that are there.
        available: usize,
    },
    /// There is more than is read, or the header promises more.
    #[error(
        "there are {found} {what} or more, and at most {limit} are read: split or thin the file, \
         or raise the limit on {what}"
    )]
    TooMany {
        /// What there are too many of.
        what: &'static str,
        /// How many are promised, or found so far.
        found: usize,
        /// How many are read, see [`ReadLimits`](crate::ReadLimits).
        limit: usize,
    },
    /// A text file has fewer rows than its header says.
    #[error(
        "the header promises {promised} rows, and the file ends after {found}: it is cut off or \
         its header is wrong"
    )]
    FewRows {
        /// Rows promised.
        promised: usize,
        /// Rows found.
        found: usize,
    },
    /// A file goes on after the last row its header promises.
    #[error(
        "the header promises {promised} rows, and more data follows them: correct the count, or \
         remove what follows"
    )]
    Leftover {
        /// Rows promised.
        promised: usize,
    },
    /// A file ends in the middle of something.
    #[error("the file ends where {expected} should follow: it is cut off")]
    UnexpectedEnd {
        /// What should follow.
        expected: &'static str,
    },
    /// A message ends in the middle of something.
    #[error(
        "the message ends where {expected} should follow: it is cut off, or no PointCloud2 of this \
         encoding"
    )]
    MessageEnd {
        /// What should follow.
        expected: &'static str,
    },
    /// A row has too few values, or more than its header says.
    #[error("the row has {found} values, expected {expected}: is the file cut off?")]
    RowLength {
        /// Values needed.
        expected: usize,
        /// Values found.
        found: usize,
    },
    /// A row has more values than there are names, so that some of them are not below theirs.
    #[error(
        "the row has {found} values below {names} names, so that it is not clear which is what: put text with a \
         separator in it into quotes, and write decimals with a point"
    )]
    SurplusValues {
        /// Columns named.
        names: usize,
        /// Values found.
        found: usize,
    },
    /// A row has so many values that several points seem to be in it.
    #[error(
        "the row has {found} values, those of several points: write one point a line, or name the \
         columns in the first row"
    )]
    ManyColumns {
        /// Values found.
        found: usize,
    },
    /// A column is named with a unit that is not metres.
    #[error(
        "the column {column} is named with the unit {unit:?}: name it {column} alone, and state that unit \
         for the whole file"
    )]
    ColumnUnit {
        /// Its name.
        column: String,
        /// The unit beside it.
        unit: String,
    },
    /// A number stands alone before the points.
    #[error(
        "the first line is {found} alone, as the count that a .pts begins with: remove it, and what is no \
         point after it"
    )]
    CountLine {
        /// The number.
        found: String,
    },
    /// The first column of a table without names grows by equal steps, as times and row numbers do.
    #[error(
        "the first column grows by {} in each of {rows} rows, from {}, as a time or a row number does, \
         and without names it is read as x: begin the file with a line that names its columns, such as \
         `{}`, or `{}` if it is x",
        rounded(*step),
        number(*first),
        header(["t", "x", "y", "z"], *separator),
        header(["x", "y", "z", "intensity"], *separator)
    )]
    CountedRows {
        /// How many rows there are.
        rows: usize,
        /// The first value.
        first: f64,
        /// How much it grows from row to row.
        step: f64,
        /// What is between the values of a row.
        separator: char,
    },
    /// A value that has to be a number is none.
    #[error("{found:?} is not a number: write it like -0.25, 1e-3 or nan")]
    NotANumber {
        /// What was found.
        found: String,
    },
    /// A coordinate of a mesh, or of the sensor, is NaN or infinite.
    #[error(
        "the coordinate {} is not finite: only points of a cloud may be missing",
        number(*value)
    )]
    NotFinite {
        /// What was found.
        value: f64,
    },
    /// A face names a vertex that is not there.
    #[error("the face names vertex {found}, and the file has {vertices}: correct the index")]
    MissingVertex {
        /// The index as it stands in the file.
        found: String,
        /// How many vertices there are.
        vertices: usize,
    },
    /// A face has a number of corners that makes no surface in its format.
    #[error("the face has {found} corners, expected {expected}: remove or repair it")]
    Corners {
        /// Corners found.
        found: usize,
        /// Corners needed.
        expected: &'static str,
    },
    /// The covariance columns of a point do not make a covariance.
    #[error("point {row}: {cause}")]
    Covariance {
        /// Which point, from 0, missing ones included.
        row: usize,
        /// What is wrong with it.
        cause: CovarianceError,
    },
    /// Compressed data contradicts the header or cannot be unpacked.
    #[error("the compressed data {reason}: the file is damaged, write it again")]
    Compression {
        /// What is wrong.
        reason: &'static str,
    },
    /// The counts on the first line of an OBJ file differ from what follows.
    #[error(
        "the first line promises {promised} {what}, and {found} follow: the file is cut off or \
         its first line is wrong"
    )]
    Count {
        /// Vertices or faces.
        what: &'static str,
        /// How many are promised.
        promised: usize,
        /// How many there are.
        found: usize,
    },
    /// A PNG is not one that holds depths.
    #[error(
        "the image is {found}, expected 16-bit grey: give the depth image itself, as the camera or data set \
         has it, neither the colour image nor a picture of the depths"
    )]
    NoDepthImage {
        /// What its pixels are.
        found: String,
    },
    /// An image of one row or column does not tell what lies between its pixels.
    #[error(
        "the image has {width} x {height} pixels: a depth image has two rows and columns at least"
    )]
    NoRowsAndColumns {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// A depth image without depths.
    #[error(
        "none of {pixels} pixels has a depth (0 and 65535 stand for none): give an image in which the \
         camera saw something, not a mask"
    )]
    NoReturns {
        /// How many there are.
        pixels: usize,
    },
    /// The contents of an image cannot be unpacked.
    #[error("the image is damaged ({problem}): write or copy it again")]
    DamagedImage {
        /// What the decoder says.
        problem: String,
    },
    /// The camera given for a depth image cannot have taken it.
    #[error(transparent)]
    Camera(CameraError),
    /// There are no triangles in what should be a mesh.
    #[error("there are no faces: read it as a point cloud, or export it as a mesh")]
    NoTriangles,
    /// There are faces in what should be a cloud.
    #[error(
        "a cloud has no triangles, and {found} would be lost: read it as a mesh, or write its vertices to a file \
         of their own"
    )]
    FacesOfCloud {
        /// How many there are.
        found: usize,
    },
    /// Points and faces in one file: more than a few vertices that no face uses.
    #[error(
        "{loose} of {vertices} vertices belong to no face: a file is a cloud or a mesh, so leave out the \
         faces, or the points beside them"
    )]
    LoosePoints {
        /// Vertices without a face.
        loose: usize,
        /// All of them.
        vertices: usize,
    },
    /// An OBJ has points beside its faces.
    #[error(
        "there are points (p) beside the faces: they would be lost; write them to a file of their own \
         (PLY, PCD), or leave them out"
    )]
    PointsBesideFaces,
    /// There are more vertices than 32-bit indices can name.
    #[error("there are {found} vertices, at most 2^32 - 1 can be indexed: split the mesh")]
    TooManyVertices {
        /// How many there are.
        found: usize,
    },
}

/// A line of names that is separated as the rows below it are.
fn header(names: [&str; 4], separator: char) -> String {
    names.join(&separator.to_string())
}
