#!/bin/sh
# Makes data/fonts/DejaVuSans-subset.ttf: DejaVu Sans cut down to the characters that our drawings use.
#
# Needs Debian's fonts-dejavu-core (2.37) and Python's fonttools (`pip install fonttools`).
# Run from the root of the repository. The same input gives the same bytes.
# Hinting and kerning are dropped: pictures are drawn without them, so text is equally wide in SVG and PNG.
set -eu
source=${1:-/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf}
target=data/fonts/DejaVuSans-subset.ttf
# Basic Latin, Latin-1, Latin Extended-A; Greek; Cyrillic; dashes, quotes, primes, ellipsis; super- and subscripts;
# ohm, angstrom; arrows; minus, infinity, almost equal, less or equal, greater or equal, delta.
characters='U+0020-007E,U+00A0-017F,U+0218-021B,U+0391-03A9,U+03B1-03C9,U+03D1,U+03D5,U+0401,U+0410-044F,U+0451,
U+2009,U+200A,U+2010-2014,U+2018-201A,U+201C-201E,U+2020,U+2022,U+2026,U+202F,U+2030,U+2032-2034,
U+2070,U+2071,U+2074-208E,U+2090-209C,U+20AC,U+2113,U+2126,U+212B,U+1D62-1D65,
U+2190-2194,U+2202,U+2206,U+2211,U+2212,U+221A,U+221E,U+222B,U+2248,U+2260,U+2264,U+2265,U+22C5'
SOURCE_DATE_EPOCH=0 pyftsubset "$source" --unicodes="$(printf %s "$characters" | tr -d '\n')" --output-file="$target" \
  --no-hinting --desubroutinize --layout-features='' --no-glyph-names --notdef-outline --name-IDs='0,1,2,4,5,13,14' \
  --drop-tables+=FFTM,MATH,GSUB,GPOS,GDEF,kern,gasp --no-legacy-kern --no-recalc-timestamp
ls -l "$target"
