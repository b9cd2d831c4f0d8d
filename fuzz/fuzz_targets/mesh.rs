#![no_main]

use photopic::render::format::{gltf, obj, ply};
use photopic::render::mesh::Mesh;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let ply = ply::read(bytes).map(|object| vec![object]);
    for read in [ply, obj::read(bytes), gltf::read(bytes, |_| Err("nothing is beside it".to_owned()))] {
        match read {
            Ok(objects) => {
                for object in objects {
                    Mesh::new(object.mesh).expect("corners that are there, as many normals as corners");
                }
            }
            Err(error) => assert!(error.to_string().contains("; expected "), "{error}"),
        }
    }
});
