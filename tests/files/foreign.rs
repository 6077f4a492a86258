//! Files of formats that cannot be read are told by name, with what converts them.

use ik_arm::io::{self, OpenError, OpenOptions};

fn refusal(bytes: &[u8]) -> OpenError {
    io::read("model.x", bytes, &OpenOptions::default()).expect_err("it is refused")
}

#[test]
fn a_format_is_recognised_by_its_first_bytes() {
    let collada = br#"<?xml version="1.0" encoding="utf-8"?>
<!-- made by a program -->
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">"#;
    let gltf_1 =
        br#"{"accessors":{"a":{}},"asset":{"version":"1.0"},"nodes":{"n":{}},"scene":"s"}"#;
    let gltf_1_number = br#"{"asset":{"version":1},"nodes":{"n":{}}}"#;
    let gltf_1_unversioned = br#"{"nodes":{"n":{"children":[]}},"asset":{"generator":"g"}}"#;
    let gltf_1_1 = br#"{"asset":{"version":"1.1"},"nodes":[]}"#;
    for (bytes, what, tool) in [
        (&b"Kaydara FBX Binary  \0\x1a\0\xe8\x1c\0\0"[..], "an FBX file", "FBX2glTF"),
        (b"; FBX 7.5.0 project file\n", "an FBX file", "Blender"),
        (collada, "a COLLADA file", "assimp"),
        (gltf_1, "glTF 1", "gltf-pipeline"),
        (gltf_1_1, "glTF 1", "gltf-pipeline"),
        (b"glTF\x01\0\0\0\xff\0\0\0", "glTF 1", "gltf-pipeline"),
        (b"BLENDER-v306", "Blender", ".glb"),
        (b"\x28\xb5\x2f\xfd\x04", "Blender", ".glb"),
        (b"PK\x03\x04rest", "archive", "unpack"),
        (b"PXR-USDC", "USD", "Blender"),
        (b"#usda 1.0\n(", "USD", "Blender"),
        (b"# AST/ASF file\n:version 1.10\n:name VICON", "Acclaim", "amc2bvh"),
        (b"#!OML:ASF F:\\VICON\n:FULLY-SPECIFIED\n", "Acclaim", "amc2bvh"),
        (b"Vocaloid Motion Data 0002\0", "MikuMikuDance", "Blender"),
        (b"//Maya ASCII 2020 scene\n", "Maya", "Blender"),
        (b"version https://git-lfs.github.com/spec/v1\noid sha256:4d\n", "Git LFS", "git lfs pull"),
        (b"MD5Version 10\ncommandline \"\"\n", "MD5", "assimp"),
        (b"INTERQUAKEMODEL\0\x02\0\0\0", "IQM", "Blender"),
        (b"xof 0303txt 0032\nFrame Root {", "DirectX", "assimp"),
        (b"\n<!DOCTYPE html>\n<html lang=\"en\">", "HTML", "Raw"),
        (b"<html>", "HTML", "Raw"),
        (b"<?xml version=\"1.0\"?>\n<sdf version=\"1.6\">", "Gazebo", "URDF"),
        (b"<mujoco model=\"arm\">", "MuJoCo", "URDF"),
        (b"\xff\xfe{\0}\0", "UTF-16", "iconv"),
        (b"\xfe\xff\0{\0}", "UTF-16", "iconv"),
        (gltf_1_number, "glTF 1", "gltf-pipeline"),
        (gltf_1_unversioned, "glTF 1", "gltf-pipeline"),
    ] {
        let error = refusal(bytes);
        assert!(matches!(error, OpenError::Foreign { .. }), "{error}");
        let told = error.to_string();
        assert!(told.contains(what) && told.contains(tool), "{told}");
        assert!(told.contains(".json, .js3d, .glb, .gltf, .bvh, .urdf and .obj"), "{told}");
    }
}

#[test]
fn other_contents_keep_their_own_errors() {
    for bytes in [
        &b""[..],
        b"hello",
        b"{}",
        b"<robots>",
        b"\xff\xfc",
        b"HIERARCHY",
        b"{\"asset\":{\"version\":\"3\"}}",
    ] {
        let error = refusal(bytes);
        assert!(!matches!(error, OpenError::Foreign { .. }), "{error}");
    }
}
