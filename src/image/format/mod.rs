//! Image files; one folder or file per format.
