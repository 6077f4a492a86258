//! Documents, files and dialogs.

use std::path::PathBuf;
use std::sync::Arc;

use glam::{Affine3A, Vec3};
use ik_arm::document::{Bake, Baked, Document, Inspection, SkeletonRig, Timeline};
use ik_arm::io::{Example, OpenOptions, Progress};
use ik_arm::kinematics::skeleton::{Joint, JointId, Skeleton};
use ik_arm::rig::{Posture, PosturedJoint};
use ik_arm::session::{
    BakeJob, Dialog, Export, ExportJob, FileAction, FileContents, InspectAction, InspectionJob,
    PathDialog, ReachJob,
};
use pollster::block_on;

use super::Values;
use crate::common::skeletons;

impl Values<'_> {
    pub fn path(&mut self) -> PathBuf {
        const PATHS: [&str; 7] = ["a.json", "/x/b.json", "", "é 😀.glb", "c.bvh", "..", "d.csv"];
        self.one_of(&PATHS).into()
    }

    pub fn file(&mut self) -> Option<PathBuf> {
        self.coin().then(|| self.path())
    }

    pub fn export(&mut self) -> Export {
        let side = self.one_of(&[0, 1, 100, u32::MAX]);
        Export {
            path: self.path(),
            frame_rate: self.one_of(&[0.0, 24.0, 33.33, 5000.0]),
            size: (side, 100),
        }
    }

    pub fn job(&mut self) -> ExportJob {
        ExportJob { path: self.path(), progress: Arc::new(Progress::default()) }
    }

    pub fn bake(&mut self) -> Bake {
        let frames = Timeline { frame_rate: self.one_of(&[0.0, 2.0, 5000.0]), ..self.timeline() };
        Bake { frames, tolerance: self.one_of(&[0.0, 1e-3, 0.1, f32::NAN]) }
    }

    /// The job of the bake dialog, or another one.
    pub fn bake_job(&mut self) -> BakeJob {
        match self.session.shell().dialog() {
            Some(Dialog::Bake { job: Some(job), .. }) => job.clone(),
            _ => BakeJob { progress: Arc::new(Progress::default()) },
        }
    }

    /// A posture of one joint, which the skeleton may not have.
    pub fn posture(&mut self) -> Posture {
        let rotation = Some(self.angles());
        let joint = PosturedJoint { rotation, offset: self.coin().then(|| self.angles()) };
        Posture { joints: [(self.joint(), joint)].into(), ..Posture::default() }
    }

    /// A search for the reach region of a target of the present rig, or of another rig.
    pub fn reach_job(&mut self) -> ReachJob {
        let other = crate::common::documents::example("human").rig;
        let rig = if self.session.rig().targets.is_empty() { &other } else { self.session.rig() };
        let index = self.random.below(rig.targets.len());
        ReachJob::new(rig, index, self.session.playback().time())
    }

    /// The end of an inspection of the present document, cancelled half the time.
    pub fn inspected(&mut self) -> InspectAction {
        let job = InspectionJob::new(self.session.history());
        let found = self.coin().then(|| Box::new(Inspection::default()));
        InspectAction::Ended(job, found)
    }

    /// A bake of a few frames; one that changes nothing if the document cannot be baked.
    pub fn baked(&mut self) -> Box<Baked> {
        let document = self.session.document();
        let frames = Timeline { start: 0.0, end: 0.2, frame_rate: 10.0 };
        let settings = Bake { frames, tolerance: 1e-3 };
        let baked =
            block_on(settings.run(document, async |done, _| done < 100)).unwrap_or_else(|_| {
                Baked {
                    document: document.clone(),
                    keys_at_frames: 0,
                    keys: 0,
                    error: 0.0,
                    shortened: Vec::new(),
                }
            });
        Box::new(baked)
    }

    pub fn example(&mut self) -> Example {
        self.one_of(&Example::ALL)
    }

    /// An example or a random forest, transformed or mirrored; rarely with many joints.
    pub fn document(&mut self) -> Document {
        match self.random.below(60) {
            0..30 => self.example().open().expect("it opens").document,
            30..34 => Document::default(),
            34 if self.chance(0.005) => skeleton(long_chain()),
            _ => {
                let joints = 1 + self.random.below(20);
                let mut forest = skeletons::forest(self.random, joints);
                if self.coin() {
                    let transform = skeletons::transform(self.random);
                    forest.set_transform(transform).expect("finite");
                }
                skeleton(forest)
            }
        }
    }

    pub fn path_dialog(&mut self) -> PathDialog {
        let path = || "x.json".to_owned();
        match self.random.below(4) {
            0 => PathDialog::SavePicture { path: path() },
            1 => PathDialog::Export(self.export()),
            2 => PathDialog::Open { path: path(), problem: None },
            _ => PathDialog::SaveAs { path: path(), problem: Some(self.name()) },
        }
    }

    pub fn dialog(&mut self) -> Dialog {
        match self.random.below(14) {
            0 => Dialog::About,
            1 if self.coin() => Dialog::Glossary,
            1 => Dialog::Shortcuts,
            2 => Dialog::Recover { document: Box::new(self.document()), file: self.file() },
            3 => Dialog::Unsaved { then: Box::new(FileAction::Quit) },
            4..=7 => Dialog::Path(self.path_dialog()),
            8 => Dialog::ChooseContents(Box::new(FileContents {
                path: self.path(),
                options: OpenOptions::of_animation(&self.name()),
                skeletons: vec![self.name(), self.name()],
                animations: Vec::new(),
                animation: None,
            })),
            9 if self.coin() => Dialog::FileChanged { path: self.path() },
            9 => Dialog::Exporting,
            10 => Dialog::DeleteJoints { joints: self.some_joints() },
            11 => {
                let then = Box::new(FileAction::SaveAs(self.path()));
                Dialog::Replace { path: self.path(), then, back: self.path_dialog() }
            }
            12 => Dialog::Bake { settings: self.bake(), job: None },
            _ => Dialog::Rename { joint: self.joint(), name: self.name() },
        }
    }
}

fn skeleton(skeleton: Skeleton) -> Document {
    let rig = SkeletonRig::new(skeleton);
    let document = Document::new(rig);
    Document { camera: document.framing_camera(), ..document }
}

/// A skeleton with the largest number of joints.
fn long_chain() -> Skeleton {
    let joint = |index: usize| {
        let parent = index.checked_sub(1);
        let offset = if parent.is_some() { Vec3::Y } else { Vec3::ZERO };
        Joint { offset, ..Joint::new(&format!("j{index}"), parent.map(JointId::new), Vec3::Y) }
    };
    let mut chain =
        Skeleton::from_joints((0..Skeleton::MOST_JOINTS).map(joint).collect()).expect("a skeleton");
    chain.set_transform(Affine3A::from_scale(Vec3::splat(0.01))).expect("finite");
    chain
}
