//! `capture`: the camera, its response and merging, against OpenCV's figures and closed forms.

#[path = "../common/mod.rs"]
mod common;

mod camera;
mod response;
