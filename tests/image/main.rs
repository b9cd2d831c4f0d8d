//! Spectral images: conversion, formats, and files written by other programs.

#[path = "../common/mod.rs"]
mod common;

mod agreement;
mod envi;
mod exr;
