//! PNG, JPEG and TIFF: decoded as their standards say, and written so that others read them.

use std::io::Cursor;

use photopic::colorimetry::rgb::{DISPLAY_P3, RADIANCE, SRGB, Space};
use photopic::finding::Finding;
use photopic::image::format::picture::{Bits, Options, open, write_png};
use photopic::image::{Channel, Description, Meaning, Memory, RgbSpace, Source};

fn load(bytes: &[u8]) -> (Memory, Vec<&'static str>) {
    let mut opened = open(Cursor::new(bytes), Options::default()).expect("a picture");
    let codes = opened.findings.iter().map(|f| f.code).collect();
    (Memory::load(&mut opened.value).expect("memory does not fail"), codes)
}

/// A PNG of one pixel.
fn png(
    colour: png::ColorType,
    depth: png::BitDepth,
    data: &[u8],
    set: impl Fn(&mut png::Encoder<&mut Vec<u8>>),
) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 1, 1);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    set(&mut encoder);
    encoder.write_header().expect("a header").write_image_data(data).expect("a pixel");
    bytes
}

fn close(got: &[f32], want: [f64; 3]) {
    got.iter().zip(want).for_each(|(got, want)| assert!((f64::from(*got) - want).abs() < 6e-7, "{got} {want}"));
}

#[test]
fn png_samples_become_light_by_the_curve_that_is_stated() {
    let eight = |set: &dyn Fn(&mut png::Encoder<&mut Vec<u8>>)| {
        png(png::ColorType::Rgb, png::BitDepth::Eight, &[128, 255, 10], set)
    };
    // IEC 61966-2-1: ((128/255 + .055)/1.055)^2.4 and 10/255/12.92.
    let srgb = [0.215_861, 1.0, 0.003_035_27];
    let (image, codes) = load(&eight(&|_| ()));
    close(image.samples(), srgb);
    assert_eq!(codes, ["I102"]);
    assert_eq!(
        image.description().rgb.as_ref().map(|r| (r.space.key, r.encoded, r.white_luminance)),
        Some(("srgb", false, None))
    );
    let (image, codes) = load(&eight(&|e| e.set_source_srgb(png::SrgbRenderingIntent::Perceptual)));
    close(image.samples(), srgb);
    assert!(codes.is_empty(), "{codes:?}");
    // PNG specification, 11.3.2.2: light is the sample to the power of 1/gAMA; 0.5 squares it. P3's primaries in cHRM.
    let (image, codes) = load(&eight(&|e| {
        e.set_source_gamma(png::ScaledFloat::new(0.5));
        e.set_source_chromaticities(png::SourceChromaticities::new(
            (0.3127, 0.329),
            (0.68, 0.32),
            (0.265, 0.69),
            (0.15, 0.06),
        ));
    }));
    close(image.samples(), [(128.0_f64 / 255.0).powi(2), 1.0, (10.0_f64 / 255.0).powi(2)]);
    assert_eq!((codes, image.description().rgb.as_ref().map(|r| r.space.key)), (vec!["I104"], Some("display_p3")));
    // Sixteen bits, and alpha that is not applied.
    let sixteen = png(png::ColorType::Rgba, png::BitDepth::Sixteen, &[128, 128, 255, 255, 10, 10, 0, 0], |_| ());
    let (image, codes) = load(&sixteen);
    close(image.samples(), srgb);
    assert_eq!(codes, ["I102", "I105"]);
    // Grey is R = G = B.
    close(load(&png(png::ColorType::Grayscale, png::BitDepth::Eight, &[128], |_| ())).0.samples(), [0.215_861; 3]);
    let mut linear = open(Cursor::new(eight(&|_| ())), Options { linear: true }).expect("a picture").value;
    close(Memory::load(&mut linear).expect("memory").samples(), [128.0 / 255.0, 1.0, 10.0 / 255.0]);
}

#[test]
fn jpeg_and_tiff_are_read() {
    let picture = image::RgbImage::from_pixel(16, 8, image::Rgb([128, 128, 128]));
    let mut jpeg = Vec::new();
    picture.write_to(&mut Cursor::new(&mut jpeg), image::ImageFormat::Jpeg).expect("written");
    let (image, codes) = load(&jpeg);
    assert_eq!((image.description().width, image.description().height, codes), (16, 8, vec!["I102"]));
    // A grey of one value is exact but for the rounding of Y, Cb, Cr to codes: one code is .0087 here.
    assert!((f64::from(image.at(3, 3, 1)) - 0.215_861).abs() < 0.0088);
    let cut = open(Cursor::new(&jpeg[..jpeg.len() - 2]), Options::default()).map(|_| ()).expect_err("cut off");
    assert!(cut.to_string().contains("the file is cut off"), "{cut}");

    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = tiff::encoder::TiffEncoder::new(&mut bytes).expect("a file");
    encoder.write_image::<tiff::encoder::colortype::RGB32Float>(1, 1, &[0.25, 7.5, -1.0]).expect("written");
    let (image, codes) = load(bytes.get_ref());
    assert_eq!((image.samples(), codes), (&[0.25, 7.5, -1.0][..], vec!["I102", "I104"]));
    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = tiff::encoder::TiffEncoder::new(&mut bytes).expect("a file");
    encoder.write_image::<tiff::encoder::colortype::RGB16>(1, 1, &[128 * 257, 65535, 10 * 257]).expect("written");
    close(load(bytes.get_ref()).0.samples(), [0.215_861, 1.0, 0.003_035_27]);
}

/// A picture of 2 × 1 pixels, (0, 128, 255) and (255, 0, 128), each component in a strip of its own (TIFF 6.0, tag 284).
fn planar_tiff() -> Vec<u8> {
    const STRIPS: u32 = 150;
    let mut out = b"II*\0\x08\0\0\0".to_vec();
    let (short, long) = (3_u16, 4_u16);
    let entries = [
        (256_u16, long, 1_u32, 2_u32),
        (257, long, 1, 1),
        (258, short, 3, STRIPS + 6),
        (259, short, 1, 1),
        (262, short, 1, 2),
        (273, long, 3, STRIPS + 12),
        (277, short, 1, 3),
        (278, long, 1, 1),
        (279, long, 3, STRIPS + 24),
        (284, short, 1, 2),
    ];
    out.extend(u16::try_from(entries.len()).expect("few").to_le_bytes());
    for (tag, kind, count, value) in entries {
        out.extend(tag.to_le_bytes().into_iter().chain(kind.to_le_bytes()));
        out.extend(count.to_le_bytes().into_iter().chain(value.to_le_bytes()));
    }
    out.resize(STRIPS as usize, 0);
    out.extend([0, 255, 128, 0, 255, 128]);
    out.extend([8_u16; 3].iter().flat_map(|v| v.to_le_bytes()));
    out.extend([STRIPS, STRIPS + 2, STRIPS + 4, 2, 2, 2].iter().flat_map(|v| v.to_le_bytes()));
    out
}

#[test]
fn a_tiff_may_keep_its_components_apart() {
    let (image, codes) = load(&planar_tiff());
    assert_eq!((image.description().width, image.description().height, codes), (2, 1, vec!["I102"]));
    // By row, then component: 128 is 0.215 861 by IEC 61966-2-1.
    let want = [0.0, 1.0, 0.215_861, 0.0, 1.0, 0.215_861];
    for (got, want) in image.samples().iter().zip(want) {
        assert!((f64::from(*got) - want).abs() < 1e-6, "{got} {want}");
    }
}

#[test]
fn damaged_pictures_are_refused() {
    let whole = png(png::ColorType::Rgb, png::BitDepth::Eight, &[1, 2, 3], |_| ());
    for bytes in [&whole[..40], &whole[..8], &[0xff, 0xd8, 0xff, 0xe0][..], b"II*\0", b""] {
        let error = open(Cursor::new(bytes), Options::default()).map(|_| ()).expect_err("damaged");
        assert!(error.to_string().contains("expected"), "{error}");
    }
}

fn encoded(space: Space, samples: [f32; 6]) -> Memory {
    let channels = (0..).zip(["R", "G", "B"]).map(|(k, n)| Channel::new(n, "", Meaning::Primary(k))).collect();
    let mut d = Description::planes(2, 1, channels);
    d.rgb = Some(RgbSpace { space, encoded: true, white_luminance: Some(100.0) });
    d.set_attribute("photopic:target", "encoded sRGB");
    Memory::new(d, samples.to_vec())
}

#[test]
fn a_written_png_is_read_by_others_with_its_space() {
    // By rows: R of both pixels, G, B.
    let samples = [0.0, 1.0, 0.5, 0.25, 1.0, 0.75];
    for (bits, most, depth) in
        [(Bits::Eight, 255.0, image::ColorType::Rgb8), (Bits::Sixteen, 65535.0, image::ColorType::Rgb16)]
    {
        let mut bytes = Vec::new();
        assert_eq!(write_png(&mut bytes, &mut encoded(SRGB, samples), bits).expect("written"), Vec::<Finding>::new());
        let picture = image::load_from_memory(&bytes).expect("a PNG");
        assert_eq!(picture.color(), depth);
        let got: Vec<f64> = match picture {
            image::DynamicImage::ImageRgb8(p) => p.into_raw().into_iter().map(f64::from).collect(),
            other => other.into_rgb16().into_raw().into_iter().map(f64::from).collect(),
        };
        let want = [0.0, 0.5, 1.0, 1.0, 0.25, 0.75].map(|v: f64| (v * most).round());
        assert_eq!(got, want);
        let info = png::Decoder::new(Cursor::new(&bytes)).read_info().expect("a PNG").info().clone();
        assert!(info.srgb.is_some() && info.utf8_text.iter().any(|t| t.keyword == "photopic:target"));
    }
    let mut bytes = Vec::new();
    write_png(&mut bytes, &mut encoded(DISPLAY_P3, samples), Bits::Eight).expect("written");
    let info = png::Decoder::new(Cursor::new(&bytes)).read_info().expect("a PNG").info().clone();
    let code = info.coding_independent_code_points.expect("cICP");
    // ITU-T H.273: P3 with D65 is 12, the sRGB curve 13.
    assert_eq!((code.color_primaries, code.transfer_function), (12, 13));
    assert_eq!(load(&bytes).0.description().rgb.as_ref().map(|r| r.space.key), Some("display_p3"));
}

#[test]
fn what_a_png_cannot_hold_is_counted() {
    let samples = [1.5, -0.5, f32::NAN, 1.0, 1.000_001, 0.0];
    let findings = write_png(Vec::new(), &mut encoded(SRGB, samples), Bits::Eight).expect("written");
    assert_eq!(findings.iter().map(|f| f.code).collect::<Vec<_>>(), ["I121", "I121", "I020"]);
    assert!(findings[0].message.starts_with("1 of 6 samples (16.67 %)"), "{}", findings[0].message);
    let mut linear = encoded(SRGB, samples);
    let mut d = linear.description().clone();
    d.rgb = Some(RgbSpace { space: SRGB, encoded: false, white_luminance: None });
    linear = Memory::new(d, samples.to_vec());
    let error = write_png(Vec::new(), &mut linear, Bits::Eight).expect_err("linear");
    assert!(error.to_string().contains("expected encoded RGB for a PNG picture"), "{error}");
    let error = write_png(Vec::new(), &mut encoded(RADIANCE, samples), Bits::Eight).expect_err("no code");
    assert!(error.to_string().contains("expected sRGB, Display P3 or Rec. 2020"), "{error}");
}
