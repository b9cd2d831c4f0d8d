//! The name of an ICC profile: its `desc` tag (ICC.1, 9.2.41), text in version 2, multi-localised text in version 4.

/// Bytes of the header, and of an entry in the table of tags.
const HEADER: usize = 128;
const ENTRY: usize = 12;

fn number(bytes: &[u8], at: usize) -> Option<usize> {
    let four = bytes.get(at..at.checked_add(4)?)?;
    usize::try_from(u32::from_be_bytes(four.try_into().ok()?)).ok()
}

/// The profile's name, as far as it can be read.
pub(super) fn name(profile: &[u8]) -> Option<String> {
    let count = number(profile, HEADER)?;
    let entry =
        (0..count.min(100)).map(|i| HEADER + 4 + i * ENTRY).find(|at| profile.get(*at..at + 4) == Some(b"desc"))?;
    let (start, length) = (number(profile, entry + 4)?, number(profile, entry + 8)?);
    let tag = profile.get(start..start.checked_add(length)?)?;
    let text = match tag.get(..4)? {
        b"desc" => {
            let length = number(tag, 8)?;
            String::from_utf8_lossy(tag.get(12..12_usize.checked_add(length)?)?).into_owned()
        }
        b"mluc" => {
            let (length, offset) = (number(tag, 20)?, number(tag, 24)?);
            let (units, _) = tag.get(offset..offset.checked_add(length)?)?.as_chunks::<2>();
            String::from_utf16_lossy(&units.iter().map(|u| u16::from_be_bytes(*u)).collect::<Vec<_>>())
        }
        _ => return None,
    };
    let text = text.trim_matches(|c: char| c == '\0' || c.is_whitespace());
    (!text.is_empty()).then(|| text.to_owned())
}
