//! All tests of this crate's interface, one module a behaviour: one program to link.

mod arm;
mod deadline;
mod description;
mod limits;
mod nested;
mod path;
mod places;
mod real;
mod root;
mod seen;
mod slips;
mod support;
