//! A report as one HTML file: sections of text, tables and figures, with everything in it that it shows.
//!
//! The file needs no network, no script and no other file; it is laid out for a narrow and a wide window and for paper. Figures are given as
//! data URIs (`plot::data_uri`), so that what is defined inside of one does not meet what is defined in another.

use std::fmt::Write;

use crate::finding::{Finding, Severity};

/// A report.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Page {
    /// Its title, also that of the window.
    pub title: String,
    /// What it is about, in a sentence or two below the title.
    pub lead: String,
    /// Its sections, listed at the top.
    pub sections: Vec<Section>,
}

/// A section.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Section {
    /// Its heading.
    pub title: String,
    /// What is in it, in this order.
    pub blocks: Vec<Block>,
}

/// A part of a section.
#[derive(Debug, Clone, PartialEq)]
pub enum Block {
    /// A paragraph.
    Text(String),
    /// A table.
    Table(Table),
    /// Figures, side by side where there is room.
    Figures(Vec<Figure>),
    /// What was noticed.
    Findings(Vec<Finding>),
}

/// A table; it scrolls sideways where the window is too narrow for it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    /// What it shows, above it.
    pub caption: String,
    /// Names of the columns, with units.
    pub head: Vec<String>,
    /// Cells; those that are numbers are set flush right.
    pub rows: Vec<Vec<String>>,
}

/// A picture with a caption.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Figure {
    /// The picture as a data URI.
    pub uri: String,
    /// What it shows: in words for who cannot see it.
    pub alt: String,
    /// Below the picture.
    pub caption: String,
    /// Of a drawing: its letters can still be read where it is as narrow as the window of a phone. It need not scroll then.
    pub large_letters: bool,
}

impl Section {
    /// A section without content.
    #[must_use]
    pub fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), blocks: Vec::new() }
    }

    /// Adds a paragraph.
    #[must_use]
    pub fn text(mut self, text: impl Into<String>) -> Self {
        self.blocks.push(Block::Text(text.into()));
        self
    }

    /// Adds a table.
    #[must_use]
    pub fn table<const N: usize>(mut self, caption: &str, head: [&str; N], rows: Vec<[String; N]>) -> Self {
        self.blocks.push(Block::Table(Table {
            caption: caption.to_owned(),
            head: head.map(str::to_owned).to_vec(),
            rows: rows.into_iter().map(Vec::from).collect(),
        }));
        self
    }

    /// Adds figures.
    #[must_use]
    pub fn figures(mut self, figures: Vec<Figure>) -> Self {
        self.blocks.push(Block::Figures(figures));
        self
    }
}

const STYLE: &str = "\
:root{color-scheme:light}
*{box-sizing:border-box}
body{margin:0 auto;max-width:76rem;padding:1rem;background:#fff;color:#191919;\
font:1rem/1.5 system-ui,-apple-system,'Segoe UI',Roboto,'DejaVu Sans',sans-serif}
h1{font-size:1.6rem;line-height:1.2;margin:.5rem 0}
h2{font-size:1.2rem;margin:2.2rem 0 .6rem;padding-top:.6rem;border-top:1px solid #ccc}
p{max-width:44rem;margin:.5rem 0}
nav{margin:1rem 0}
nav a{display:inline-block;margin:0 1rem .3rem 0;color:#0b4f8a}
.scroll{overflow-x:auto;margin:.8rem 0}
table{border-collapse:collapse;font-size:.875rem;font-variant-numeric:tabular-nums}
caption{text-align:left;color:#4b4b4b;padding:.2rem 0}
th,td{padding:.25rem .7rem .25rem 0;text-align:left;vertical-align:top;border-bottom:1px solid #e2e2e2;white-space:nowrap}
th{font-weight:600}
.n{text-align:right}
td.long{white-space:normal;overflow-wrap:anywhere;min-width:14rem}
.figures{display:grid;grid-template-columns:minmax(0,1fr);gap:1rem;margin:.8rem 0}
.drawing{overflow-x:auto}
.drawing img{min-width:32rem}
figure{margin:0}
figure img{display:block;width:100%;height:auto}
figcaption{font-size:.875rem;color:#4b4b4b;margin:.3rem 0 0}
ul{list-style:none;padding:0;margin:.8rem 0}
li{border-left:.25rem solid #888;padding:.2rem 0 .2rem .7rem;margin:.5rem 0;max-width:60rem;overflow-wrap:anywhere}
li.error{border-color:#b3261e}
li.warning{border-color:#b26a00}
li small{color:#4b4b4b}
@media(min-width:48rem){.figures{grid-template-columns:repeat(3,minmax(0,1fr))}.drawings{grid-template-columns:repeat(2,minmax(0,1fr))}.drawing img{min-width:0}}
@page{size:A4;margin:15mm}
@media(max-width:30rem){td:first-child{white-space:normal;min-width:6rem}}
@media print{body{max-width:none;padding:0;font-size:10pt}nav{display:none}figure,tr,li{break-inside:avoid}\
h2{break-after:avoid}.scroll{overflow:visible}td{white-space:normal}\
.figures{grid-template-columns:repeat(3,minmax(0,1fr))}.drawings{grid-template-columns:repeat(2,minmax(0,1fr))}.drawing img{min-width:0}}
";

/// Text as it may stand in HTML, between tags and in attributes.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            // Not allowed in HTML.
            c if c.is_control() && !c.is_whitespace() => {}
            c => out.push(c),
        }
    }
    out
}

impl Page {
    /// The file.
    #[must_use]
    pub fn html(&self) -> String {
        let title = escaped(&self.title);
        let mut out = format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta name=\"generator\" content=\"photopic {}\">\n<title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n\
             <body>\n<header>\n<h1>{title}</h1>\n<p>{}</p>\n</header>\n",
            env!("CARGO_PKG_VERSION"),
            escaped(&self.lead)
        );
        out.push_str("<nav aria-label=\"Sections\">\n");
        // Writing to a string cannot fail.
        for (n, section) in self.sections.iter().enumerate() {
            let _ = writeln!(out, "<a href=\"#s{n}\">{}</a>", escaped(&section.title));
        }
        out.push_str("</nav>\n<main>\n");
        for (n, section) in self.sections.iter().enumerate() {
            let _ = writeln!(out, "<section id=\"s{n}\">\n<h2>{}</h2>", escaped(&section.title));
            section.blocks.iter().for_each(|b| b.write(&mut out));
            out.push_str("</section>\n");
        }
        out.push_str("</main>\n</body>\n</html>\n");
        out
    }
}

impl Block {
    fn write(&self, out: &mut String) {
        // Writing to a string cannot fail.
        match self {
            Self::Text(text) => {
                let _ = writeln!(out, "<p>{}</p>", escaped(text));
            }
            Self::Table(table) => table.write(out),
            Self::Figures(figures) => {
                // Drawings have small letters: they get more room, and on a narrow window they scroll.
                let is_drawing = |f: &Figure| f.uri.starts_with("data:image/svg");
                let all = if figures.iter().any(is_drawing) { " drawings" } else { "" };
                let _ = writeln!(out, "<div class=\"figures{all}\">");
                for f in figures {
                    let class = if is_drawing(f) && !f.large_letters { " class=\"drawing\"" } else { "" };
                    let (uri, alt, caption) = (escaped(&f.uri), escaped(&f.alt), escaped(&f.caption));
                    let _ = writeln!(
                        out,
                        "<figure>\n<div{class}><img src=\"{uri}\" alt=\"{alt}\"></div>\n<figcaption>{caption}</figcaption>\n</figure>"
                    );
                }
                out.push_str("</div>\n");
            }
            Self::Findings(findings) => {
                out.push_str("<ul>\n");
                for f in findings {
                    let class = match f.severity {
                        Severity::Error => "error",
                        Severity::Warning => "warning",
                        Severity::Info => "info",
                    };
                    let place = f.location.item.as_ref().map_or_else(String::new, |i| format!("{}: ", escaped(i)));
                    let hint =
                        f.hint.as_ref().map_or_else(String::new, |h| format!("<br><small>{}</small>", escaped(h)));
                    let (code, message) = (escaped(f.code), escaped(&f.message));
                    let _ = writeln!(out, "<li class=\"{class}\"><b>{code}</b> {class}: {place}{message}{hint}</li>");
                }
                out.push_str("</ul>\n");
            }
        }
    }
}

impl Table {
    fn write(&self, out: &mut String) {
        let is_number = |cell: &str| cell.starts_with(|c: char| c.is_ascii_digit() || "-−+".contains(c));
        let numeric: Vec<bool> = (0..self.head.len())
            .map(|c| {
                !self.rows.is_empty()
                    && self.rows.iter().all(|r| r[c].is_empty() || is_number(&r[c]) && r[c].len() < 40)
            })
            .collect();
        let class = |c: usize| if numeric[c] { " class=\"n\"" } else { "" };
        // Writing to a string cannot fail.
        let _ = writeln!(
            out,
            "<div class=\"scroll\">\n<table>\n<caption>{}</caption>\n<thead>\n<tr>",
            escaped(&self.caption)
        );
        for (c, name) in self.head.iter().enumerate() {
            let _ = writeln!(out, "<th scope=\"col\"{}>{}</th>", class(c), escaped(name));
        }
        out.push_str("</tr>\n</thead>\n<tbody>\n");
        for row in &self.rows {
            out.push_str("<tr>");
            for (c, cell) in row.iter().enumerate() {
                let class = if cell.chars().count() > 40 { " class=\"long\"" } else { class(c) };
                let _ = write!(out, "<td{class}>{}</td>", escaped(cell));
            }
            out.push_str("</tr>\n");
        }
        out.push_str("</tbody>\n</table>\n</div>\n");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_put_in_is_text_not_markup() {
        let figure =
            Figure { uri: "data:image/png;base64,AA==".to_owned(), alt: "a \"b\"".to_owned(), ..Figure::default() };
        let page = Page {
            title: "<script>".to_owned(),
            lead: "a & b".to_owned(),
            sections: vec![
                Section::new("one")
                    .text("x < y")
                    .table("t", ["name", "value"], vec![["a".to_owned(), "1.5".to_owned()]])
                    .figures(vec![figure]),
            ],
        };
        let html = page.html();
        assert!(!html.contains("<script") && html.contains("&lt;script&gt;") && html.contains("a &amp; b"));
        assert!(html.contains("x &lt; y") && html.contains("alt=\"a &quot;b&quot;\""));
        assert!(html.contains("<td>a</td><td class=\"n\">1.5</td>"), "{html}");
        assert!(html.contains("<a href=\"#s0\">one</a>") && html.contains("<section id=\"s0\">"));
        // Nothing is fetched.
        assert!(!html.contains("http") && !html.contains("src=\"data:text"));
    }
}
