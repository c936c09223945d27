//! Answers, for programs (a line of JSON each) and for people.

pub(crate) mod gradient;
pub(crate) mod path;
pub(crate) mod penetration;
pub(crate) mod per_point;
pub(crate) mod print;
pub(crate) mod query;
pub(crate) mod robot;
pub(crate) mod scene;
pub(crate) mod table;
pub(crate) mod text;
