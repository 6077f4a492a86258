//! Files of other programs that cannot be read, recognised by how they begin.

/// A format that cannot be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ForeignFormat {
    /// Description of a file of this format, like `an FBX file`.
    pub what: &'static str,
    /// Program that usually turns it into a file that can be read.
    pub advice: &'static str,
}

const FBX: ForeignFormat = ForeignFormat {
    what: "an FBX file",
    advice: "Blender imports it and exports .glb; FBX2glTF converts it, too",
};

const COLLADA: ForeignFormat = ForeignFormat {
    what: "a COLLADA file (.dae)",
    advice: "Blender up to version 4 imports it and exports .glb; assimp export x.dae x.glb converts it, too",
};

/// The first bytes of binary files.
const BINARY: [(&[u8], ForeignFormat); 12] = [
    (b"Kaydara FBX Binary", FBX),
    (b"glTF\x01\0\0\0", ForeignFormat::GLTF_1),
    (b"BLENDER", BLENDER),
    // Blender compresses its files by Zstandard or gzip.
    (b"\x28\xb5\x2f\xfd", BLENDER),
    (b"\x1f\x8b", COMPRESSED),
    (b"PK\x03\x04", COMPRESSED),
    (b"PXR-USDC", USD),
    (b"PMX ", MMD),
    (b"Vocaloid Motion Data", MMD),
    (b"INTERQUAKEMODEL\0", IQM),
    (b"\xff\xfe", UTF_16),
    (b"\xfe\xff", UTF_16),
];

const BLENDER: ForeignFormat =
    ForeignFormat { what: "a file of Blender (.blend)", advice: "Blender exports .glb and .bvh" };

const COMPRESSED: ForeignFormat = ForeignFormat {
    what: "a compressed archive (.zip, .usdz, .gz)",
    advice: "unpack it and open one of its files",
};

const USD: ForeignFormat =
    ForeignFormat { what: "a USD file", advice: "Blender imports it and exports .glb" };

const MMD: ForeignFormat = ForeignFormat {
    what: "a file of MikuMikuDance",
    advice: "Blender with the add-on MMD Tools imports it and exports .glb",
};

const ACCLAIM: ForeignFormat = ForeignFormat {
    what: "an Acclaim file (.asf, .amc)",
    advice: "amc2bvh converts a pair of these to .bvh",
};

const MAYA: ForeignFormat = ForeignFormat {
    what: "a file of Maya (.ma)",
    advice: "Maya exports .fbx, which Blender or FBX2glTF converts to .glb",
};

const IQM: ForeignFormat = ForeignFormat {
    what: "an IQM file (Inter-Quake Model)",
    advice: "Noesis or Blender with an add-on for IQM imports it and exports .glb",
};

const UTF_16: ForeignFormat = ForeignFormat {
    what: "a text in UTF-16",
    advice: "iconv -f UTF-16 -t UTF-8 x > y, or an editor, saves it as UTF-8",
};

const GIT_LFS: ForeignFormat = ForeignFormat {
    what: "a pointer of Git LFS, which stands for a file that was not downloaded",
    advice: "git lfs pull downloads the file",
};

const MD5: ForeignFormat = ForeignFormat {
    what: "an MD5 file of Doom 3 (.md5mesh, .md5anim)",
    advice: "Blender with an add-on for MD5 imports it and exports .glb; assimp export x.md5mesh x.glb converts it, too",
};

const DIRECTX: ForeignFormat =
    ForeignFormat { what: "a DirectX file (.x)", advice: "assimp export x.x x.glb converts it" };

const SDF: ForeignFormat =
    ForeignFormat { what: "an SDF file of Gazebo", advice: "most robots have a URDF file, too" };

const MUJOCO: ForeignFormat =
    ForeignFormat { what: "a model of MuJoCo (MJCF)", advice: "most robots have a URDF file, too" };

const HTML: ForeignFormat = ForeignFormat {
    what: "a web page (HTML)",
    advice: "download the file itself, often by a link \"Raw\" or \"Download\" on that page",
};

/// The first words of text files, after blanks.
const TEXT: [(&str, ForeignFormat); 9] = [
    ("version https://git-lfs.github.com/spec/", GIT_LFS),
    ("MD5Version", MD5),
    ("xof ", DIRECTX),
    ("; FBX", FBX),
    ("#usda", USD),
    (":version", ACCLAIM),
    (":FULLY-SPECIFIED", ACCLAIM),
    ("#!OML:ASF", ACCLAIM),
    ("//Maya", MAYA),
];

impl ForeignFormat {
    /// The first version of glTF.
    pub const GLTF_1: Self = Self {
        what: "a file of glTF 1",
        advice: "gltf-pipeline -i x.gltf -o y.glb converts it to glTF 2",
    };

    /// The format of a file with these bytes; `None` if it is not known.
    pub fn of(bytes: &[u8]) -> Option<Self> {
        if let Some((_, format)) = BINARY.iter().find(|(start, _)| bytes.starts_with(start)) {
            return Some(*format);
        }
        /// Number of bytes in which an XML file names its root.
        const HEAD: usize = 2000;
        let head = String::from_utf8_lossy(bytes.get(..HEAD).unwrap_or(bytes));
        let mut lines = head.trim_start_matches('\u{feff}').lines().map(str::trim_start);
        let first = lines.find(|line| !line.is_empty()).unwrap_or_default();
        let roots = [("<COLLADA", COLLADA), ("<sdf", SDF), ("<mujoco", MUJOCO)];
        let root = roots.into_iter().find(|(root, _)| head.contains(root));
        if let Some((_, format)) = root.filter(|_| first.starts_with('<')) {
            return Some(format);
        }
        let lower = first.to_ascii_lowercase();
        if lower.starts_with("<!doctype html") || lower.starts_with("<html") {
            return Some(HTML);
        }
        let is_comment = |line: &&str| line.starts_with("# ") || line.is_empty();
        let word = [first].into_iter().chain(lines).find(|line| !is_comment(line));
        let begins = |(start, _): &&(&str, ForeignFormat)| {
            first.starts_with(start) || word.is_some_and(|line| line.starts_with(start))
        };
        TEXT.iter().find(begins).map(|(_, format)| *format)
    }
}
