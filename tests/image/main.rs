//! Spectral images: conversion, formats, and files written by other programs.

#[path = "../common/mod.rs"]
mod common;

mod agreement;
mod cli;
mod compare;
mod envi;
mod exr;
mod falsecolor;
mod kernel;
mod npy;
mod picture;
mod probe;
mod radiance;
mod rgb;
mod stack;
mod streaming;
mod tone;
