//! The editions of LM-63 and what differs between them.

use std::fmt;

/// An edition of ANSI/IES LM-63.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Version {
    /// LM-63-1986: no version line, free lines of text before TILT. Files without a version line are read by its rules.
    Lm63_1986,
    /// LM-63-1991: `IESNA91`, keywords in brackets.
    Lm63_1991,
    /// LM-63-1995: `IESNA:LM-63-1995`.
    Lm63_1995,
    /// LM-63-2002: `IESNA:LM-63-2002`; new signs for the luminous opening, no ballast-lamp photometric factor.
    Lm63_2002,
    /// LM-63-2019: `IES:LM-63-2019`; the place of that factor holds the file-generation code.
    Lm63_2019,
}

impl Version {
    /// All editions, oldest first.
    pub const ALL: [Self; 5] = [Self::Lm63_1986, Self::Lm63_1991, Self::Lm63_1995, Self::Lm63_2002, Self::Lm63_2019];

    /// The version line; the edition of 1986 has none.
    #[must_use]
    pub fn line(self) -> Option<&'static str> {
        match self {
            Self::Lm63_1986 => None,
            Self::Lm63_1991 => Some("IESNA91"),
            Self::Lm63_1995 => Some("IESNA:LM-63-1995"),
            Self::Lm63_2002 => Some("IESNA:LM-63-2002"),
            Self::Lm63_2019 => Some("IES:LM-63-2019"),
        }
    }

    /// The edition that a year means, in four or two digits.
    #[must_use]
    pub fn of_year(year: &str) -> Option<Self> {
        Some(match year {
            "1986" | "86" => Self::Lm63_1986,
            "1991" | "91" => Self::Lm63_1991,
            "1995" | "95" => Self::Lm63_1995,
            "2002" | "02" => Self::Lm63_2002,
            "2019" | "19" => Self::Lm63_2019,
            _ => return None,
        })
    }

    /// The most characters of a line, without its end.
    #[must_use]
    pub fn line_length(self) -> usize {
        match self {
            Self::Lm63_1986 => 80,
            Self::Lm63_1991 | Self::Lm63_1995 => 132,
            Self::Lm63_2002 | Self::Lm63_2019 => 256,
        }
    }

    /// Keywords that a file must have.
    #[must_use]
    pub fn required(self) -> &'static [&'static str] {
        match self {
            Self::Lm63_1986 | Self::Lm63_1995 => &[],
            Self::Lm63_1991 => &["TEST", "MANUFAC"],
            Self::Lm63_2002 | Self::Lm63_2019 => &["TEST", "TESTLAB", "ISSUEDATE", "MANUFAC"],
        }
    }

    /// Whether lines before TILT are keywords in brackets.
    #[must_use]
    pub fn has_keywords(self) -> bool {
        self != Self::Lm63_1986
    }
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Lm63_1986 => "LM-63-1986",
            Self::Lm63_1991 => "LM-63-1991",
            Self::Lm63_1995 => "LM-63-1995",
            Self::Lm63_2002 => "LM-63-2002",
            Self::Lm63_2019 => "LM-63-2019",
        })
    }
}

/// What the first line says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum VersionLine {
    /// It is the version line of an edition, written as the standard has it or (`false`) nearly so.
    Is(Version, bool),
    /// It is a version line, of no known edition.
    Unknown,
    /// It is no version line.
    Missing,
}

/// Reads a version line: blanks, case and punctuation do not matter.
pub(super) fn version_line(line: &str) -> VersionLine {
    let bare: String = line.chars().filter(char::is_ascii_alphanumeric).collect::<String>().to_ascii_uppercase();
    let year = match bare.strip_prefix("IESNALM63").or_else(|| bare.strip_prefix("IESLM63")) {
        Some(year) => year,
        None => match bare.strip_prefix("ANSIIESNALM63").or_else(|| bare.strip_prefix("ANSIIESLM63")) {
            Some(year) => year,
            None => match bare.strip_prefix("IESNA").or_else(|| bare.strip_prefix("LM63")) {
                Some(year) if year.len() == 2 || year.len() == 4 => year,
                _ => return VersionLine::Missing,
            },
        },
    };
    match Version::of_year(year) {
        Some(version) => VersionLine::Is(version, version.line() == Some(line)),
        None if year.bytes().all(|b| b.is_ascii_digit()) => VersionLine::Unknown,
        // `IESNA:LM-63-2002 by …`: the year stands first.
        None => match Version::of_year(year.get(..4).unwrap_or_default()) {
            Some(version) => VersionLine::Is(version, false),
            None => VersionLine::Unknown,
        },
    }
}

/// The keywords of the editions of 1991 to 2019; others begin with `_`.
pub(super) const KEYWORDS: [&str; 35] = [
    "ADDON",
    "BALLAST",
    "BALLASTCAT",
    "BLOCK",
    "COLORCONSTANT",
    "CLASS",
    "DATE",
    "DISTRIBUTION",
    "ENDBLOCK",
    "FLASHAREA",
    "INPUT",
    "ISSUEDATE",
    "LABNAME",
    "LAMP",
    "LAMPCAT",
    "LAMPPOSITION",
    "LUMCAT",
    "LUMINAIRE",
    "LUMINOUSGEOMETRY",
    "MAINTCAT",
    "MANUFAC",
    "MORE",
    "MOUNTING",
    "NEARFIELD",
    "OPTIC",
    "OTHER",
    "REFLECTOR",
    "REFRACTOR",
    "SEARCH",
    "SHIELDING",
    "TEST",
    "TESTDATE",
    "TESTLAB",
    "TESTMETHOD",
    "TYPE",
];

/// What a file-generation code of LM-63-2019 (its table 2) means.
#[must_use]
pub fn file_generation(code: f64) -> Option<&'static str> {
    Some(match (code * 1e5).round() as i64 {
        100_001 => "undefined, or an older file",
        100_010 => "computer simulation",
        100_000 => "test at an unaccredited laboratory",
        100_100 => "test at an unaccredited laboratory, lumens scaled",
        101_000 => "test at an unaccredited laboratory, angles interpolated",
        101_100 => "test at an unaccredited laboratory, angles interpolated, lumens scaled",
        110_000 => "test at an accredited laboratory",
        110_100 => "test at an accredited laboratory, lumens scaled",
        111_000 => "test at an accredited laboratory, angles interpolated",
        111_100 => "test at an accredited laboratory, angles interpolated, lumens scaled",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn version_lines_as_they_are_written_and_nearly_so() {
        for version in Version::ALL.into_iter().skip(1) {
            assert_eq!(version_line(version.line().expect("a line")), VersionLine::Is(version, true));
        }
        for (line, version) in [
            ("IESNA: LM-63-2002", Version::Lm63_2002),
            ("iesna:lm-63-1995 ", Version::Lm63_1995),
            ("IES:LM-63-19", Version::Lm63_2019),
            ("IESNA:LM-63-2019", Version::Lm63_2019),
            ("ANSI/IES LM-63-2019", Version::Lm63_2019),
            ("IESNA86", Version::Lm63_1986),
            ("IESNA:LM-63-2002 (EXTENDED)", Version::Lm63_2002),
        ] {
            assert_eq!(version_line(line), VersionLine::Is(version, false), "{line}");
        }
        assert_eq!(version_line("IESNA:LM-63-2012"), VersionLine::Unknown);
        for line in ["", "[TEST] 1", "TILT=NONE", "IESNA", "Acme Lighting 2002"] {
            assert_eq!(version_line(line), VersionLine::Missing, "{line}");
        }
    }
}
