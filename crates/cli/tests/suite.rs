//! All tests of this crate's interface, one module a behaviour: one program to link.

mod batch;
mod demo;
mod effort;
mod errors;
mod exit_codes;
mod help;
mod html;
mod html_browser;
mod html_touch;
mod info;
mod inside;
mod interrupted;
mod json_documented;
mod json_schema;
mod limits;
mod margin;
mod motion;
mod paper_settings;
mod path;
mod query;
mod real_scan;
mod recording;
mod robot;
mod scene;
mod slips;
mod support;
