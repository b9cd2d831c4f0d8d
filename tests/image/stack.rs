//! Stacks of grey pictures.

use std::io::Cursor;

use image::{ImageBuffer, Luma};
use photopic::image::format::envi::Options;
use photopic::image::format::exr::{self, Depth};
use photopic::image::format::stack::{Band, gather, read_list};
use photopic::image::{Channel, Description, Meaning, Memory, Source};

const PIXELS: [u8; 6] = [64, 65, 100, 200, 255, 0];

fn png8() -> Vec<u8> {
    let picture: ImageBuffer<Luma<u8>, _> = ImageBuffer::from_raw(3, 2, PIXELS.to_vec()).expect("six pixels");
    let mut out = Cursor::new(Vec::new());
    picture.write_to(&mut out, image::ImageFormat::Png).expect("writes");
    out.into_inner()
}

fn png16() -> Vec<u8> {
    let raw = PIXELS.iter().map(|v| u16::from(*v) * 256).collect();
    let picture: ImageBuffer<Luma<u16>, Vec<u16>> = ImageBuffer::from_raw(3, 2, raw).expect("six pixels");
    let mut out = Cursor::new(Vec::new());
    picture.write_to(&mut out, image::ImageFormat::Png).expect("writes");
    out.into_inner()
}

fn tiff32() -> Vec<u8> {
    let mut out = Cursor::new(Vec::new());
    let raw: Vec<f32> = PIXELS.iter().map(|v| f32::from(*v) / 8.0).collect();
    let mut encoder = tiff::encoder::TiffEncoder::new(&mut out).expect("an encoder");
    encoder.write_image::<tiff::encoder::colortype::Gray32Float>(3, 2, &raw).expect("writes");
    out.into_inner()
}

fn exr_half() -> Vec<u8> {
    let description = Description::planes(3, 2, vec![Channel::new("Y", "", Meaning::Photopic)]);
    let mut image = Memory::new(description, PIXELS.iter().map(|v| f32::from(*v)).collect());
    let mut out = Cursor::new(Vec::new());
    exr::write(&mut out, &mut image, Depth::Half).expect("writes");
    out.into_inner()
}

fn band(file: &str, wavelength_nm: f64, gain: f64, dark: f64) -> Band {
    Band { file: file.to_owned(), wavelength_nm, gain, dark }
}

fn load(bands: &[Band], picture: impl Fn(&str) -> Vec<u8>) -> Result<Memory, String> {
    let scratch = Cursor::new(Vec::new());
    let mut opened = gather(bands, |b| Ok(picture(&b.file)), scratch, Options::default()).map_err(|e| e.to_string())?;
    Memory::load(&mut opened.value).map_err(|e| e.to_string())
}

#[test]
fn pictures_of_every_kind_make_one_cube() {
    let bands = [
        band("a.png", 500.0, 2.0, 64.0),
        band("b.png", 400.0, 1.0 / 256.0, 0.0),
        band("c.tif", 600.0, 8.0, 0.0),
        band("d.exr", 700.0, 1.0, 0.0),
    ];
    let image = load(&bands, |file| match file {
        "a.png" => png8(),
        "b.png" => png16(),
        "c.tif" => tiff32(),
        _ => exr_half(),
    })
    .expect("valid");
    assert_eq!(image.description().bands(), [(1, 400.0), (0, 500.0), (2, 600.0), (3, 700.0)]);
    for (i, value) in PIXELS.iter().enumerate() {
        let (x, y, value) = (i % 3, i / 3, f32::from(*value));
        assert_eq!(image.at(x, y, 0), (value - 64.0) * 2.0);
        assert_eq!([image.at(x, y, 1), image.at(x, y, 2), image.at(x, y, 3)], [value; 3]);
    }
}

#[test]
fn what_makes_no_stack_is_refused_with_the_file() {
    let rgb: ImageBuffer<image::Rgb<u8>, Vec<u8>> = ImageBuffer::new(3, 2);
    let mut out = Cursor::new(Vec::new());
    rgb.write_to(&mut out, image::ImageFormat::Png).expect("writes");
    let rgb = out.into_inner();
    let large: ImageBuffer<Luma<u8>, Vec<u8>> = ImageBuffer::new(4, 2);
    let mut out = Cursor::new(Vec::new());
    large.write_to(&mut out, image::ImageFormat::Png).expect("writes");
    let large = out.into_inner();
    let bands = [band("a.png", 500.0, 1.0, 0.0), band("b.png", 600.0, 1.0, 0.0)];
    for (second, want) in [
        (rgb, "b.png: found a PNG picture of type Rgb8, which is not supported; expected a grey picture"),
        (large, "b.png: found 4 × 2 pixels; expected 3 × 2 as in a.png"),
        (png8()[..40].to_vec(), "b.png: found a damaged PNG picture"),
        (tiff32()[..20].to_vec(), "b.png: found a damaged TIFF picture"),
        (Vec::new(), "b.png: found an empty input"),
        (b"GIF89a".to_vec(), "b.png: found another kind of file; expected a PNG, TIFF or EXR picture"),
    ] {
        let error = load(&bands, |file| if file == "a.png" { png8() } else { second.clone() }).expect_err(want);
        assert!(error.starts_with(want), "{error}\n{want}");
    }
    let twice = [band("a.png", 500.0, 1.0, 0.0), band("b.png", 500.0, 1.0, 0.0)];
    assert!(load(&twice, |_| png8()).expect_err("one wavelength twice").contains("strictly ascending"));
}

#[test]
fn lists_are_read_with_their_lines() {
    let list = read_list("# a comment\nfile, wavelength_nm, gain, dark\na.png, 500, 2e-3, 64\nb.png, 510.5,,\n")
        .expect("valid");
    assert_eq!(list, [band("a.png", 500.0, 2e-3, 64.0), band("b.png", 510.5, 1.0, 0.0)]);
    for (text, want) in [
        ("", "1: found no `wavelength_nm`"),
        ("file\na\n", "1: found no `wavelength_nm`"),
        ("wavelength_nm\n", "1: found no row; expected a row per band"),
        ("file,wavelength_nm\na,500\nb,green\n", "3: found `green` for wavelength_nm; expected a number"),
        ("file,wavelength_nm\na\n", "2: found a broken table"),
    ] {
        let error = read_list(text).expect_err(want).to_string();
        assert!(error.starts_with(want), "{error}\n{want}");
    }
}
