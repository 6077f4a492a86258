//! People with the joint names of widely used programs, and skeletons that are no people.

use glam::{Mat3, Vec3};
use ik_arm_kinematics::skeleton::{Joint, Skeleton};

use crate::common::Random;

/// Names of a person's joints. `%` is the side. The second name of a joint is its parent, the third
/// its place in [`PLACES`].
pub struct Scheme {
    pub name: &'static str,
    pub joints: &'static str,
    pub sides: [&'static str; 2],
    /// Upper joint, lower joint and end of arm and leg.
    pub limbs: [[&'static str; 3]; 2],
    pub head: &'static str,
}

/// Places of the left half of a person in a T-pose who faces +z.
const PLACES: &[(&str, [f32; 3])] = &[
    ("ground", [0.0, 0.0, 0.0]),
    ("hips", [0.0, 1.0, 0.0]),
    ("spine", [0.0, 1.1, -0.01]),
    ("chest", [0.0, 1.3, -0.02]),
    ("neck", [0.0, 1.5, 0.0]),
    ("neck2", [0.0, 1.55, 0.0]),
    ("head", [0.0, 1.6, 0.02]),
    ("top", [0.0, 1.8, 0.02]),
    ("eye", [0.03, 1.68, 0.1]),
    ("clavicle", [0.04, 1.45, 0.0]),
    ("shoulder", [0.2, 1.45, 0.0]),
    ("arm2", [0.34, 1.45, 0.0]),
    ("elbow", [0.48, 1.45, 0.0]),
    ("forearm2", [0.6, 1.45, 0.0]),
    ("wrist", [0.73, 1.45, 0.0]),
    ("palm", [0.76, 1.45, 0.0]),
    ("finger", [0.83, 1.45, 0.02]),
    ("fingertip", [0.9, 1.45, 0.02]),
    ("thumb", [0.76, 1.44, 0.05]),
    ("hip", [0.1, 0.95, 0.0]),
    ("thigh2", [0.1, 0.7, 0.0]),
    ("knee", [0.1, 0.5, 0.0]),
    ("shin2", [0.1, 0.3, 0.0]),
    ("ankle", [0.1, 0.08, 0.0]),
    ("toe", [0.1, 0.02, 0.14]),
    ("toes", [0.1, 0.0, 0.2]),
    ("heel", [0.1, 0.0, -0.05]),
];

pub const SCHEMES: &[Scheme] = &[
    Scheme {
        name: "VRM 1.0",
        joints: "hips - hips, spine hips spine, chest spine chest, neck chest neck, head neck head, \
            %Eye head eye, %Shoulder chest clavicle, %UpperArm %Shoulder shoulder, \
            %LowerArm %UpperArm elbow, %Hand %LowerArm wrist, %IndexProximal %Hand finger, \
            %ThumbMetacarpal %Hand thumb, %UpperLeg hips hip, %LowerLeg %UpperLeg knee, \
            %Foot %LowerLeg ankle, %Toes %Foot toe",
        sides: ["left", "right"],
        limbs: [["%UpperArm", "%LowerArm", "%Hand"], ["%UpperLeg", "%LowerLeg", "%Foot"]],
        head: "head",
    },
    Scheme {
        name: "VRoid Studio",
        joints: "Root - ground, J_Bip_C_Hips Root hips, J_Bip_C_Spine J_Bip_C_Hips spine, \
            J_Bip_C_Chest J_Bip_C_Spine chest, J_Bip_C_Neck J_Bip_C_Chest neck, \
            J_Bip_C_Head J_Bip_C_Neck head, J_Adj_%_FaceEye J_Bip_C_Head eye, \
            J_Bip_%_Shoulder J_Bip_C_Chest clavicle, J_Bip_%_UpperArm J_Bip_%_Shoulder shoulder, \
            J_Bip_%_LowerArm J_Bip_%_UpperArm elbow, J_Bip_%_Hand J_Bip_%_LowerArm wrist, \
            J_Bip_%_Index1 J_Bip_%_Hand finger, J_Bip_%_UpperLeg J_Bip_C_Hips hip, \
            J_Bip_%_LowerLeg J_Bip_%_UpperLeg knee, J_Bip_%_Foot J_Bip_%_LowerLeg ankle, \
            J_Bip_%_ToeBase J_Bip_%_Foot toe",
        sides: ["L", "R"],
        limbs: [
            ["J_Bip_%_UpperArm", "J_Bip_%_LowerArm", "J_Bip_%_Hand"],
            ["J_Bip_%_UpperLeg", "J_Bip_%_LowerLeg", "J_Bip_%_Foot"],
        ],
        head: "J_Bip_C_Head",
    },
    Scheme {
        name: "Mixamo",
        joints: "mixamorig:Hips - hips, mixamorig:Spine mixamorig:Hips spine, \
            mixamorig:Spine1 mixamorig:Spine chest, mixamorig:Neck mixamorig:Spine1 neck, \
            mixamorig:Head mixamorig:Neck head, mixamorig:HeadTop_End mixamorig:Head top, \
            mixamorig:%Shoulder mixamorig:Spine1 clavicle, \
            mixamorig:%Arm mixamorig:%Shoulder shoulder, mixamorig:%ForeArm mixamorig:%Arm elbow, \
            mixamorig:%Hand mixamorig:%ForeArm wrist, mixamorig:%HandIndex1 mixamorig:%Hand finger, \
            mixamorig:%HandThumb1 mixamorig:%Hand thumb, mixamorig:%UpLeg mixamorig:Hips hip, \
            mixamorig:%Leg mixamorig:%UpLeg knee, mixamorig:%Foot mixamorig:%Leg ankle, \
            mixamorig:%ToeBase mixamorig:%Foot toe, mixamorig:%Toe_End mixamorig:%ToeBase toes",
        sides: ["Left", "Right"],
        limbs: [
            ["mixamorig:%Arm", "mixamorig:%ForeArm", "mixamorig:%Hand"],
            ["mixamorig:%UpLeg", "mixamorig:%Leg", "mixamorig:%Foot"],
        ],
        head: "mixamorig:Head",
    },
    Scheme {
        name: "Mixamo as three.js writes it",
        joints: "mixamorigHips - hips, mixamorigSpine mixamorigHips spine, \
            mixamorigSpine1 mixamorigSpine chest, mixamorigNeck mixamorigSpine1 neck, \
            mixamorigHead mixamorigNeck head, mixamorig%Shoulder mixamorigSpine1 clavicle, \
            mixamorig%Arm mixamorig%Shoulder shoulder, mixamorig%ForeArm mixamorig%Arm elbow, \
            mixamorig%Hand mixamorig%ForeArm wrist, mixamorig%HandMiddle1 mixamorig%Hand finger, \
            mixamorig%UpLeg mixamorigHips hip, mixamorig%Leg mixamorig%UpLeg knee, \
            mixamorig%Foot mixamorig%Leg ankle, mixamorig%ToeBase mixamorig%Foot toe",
        sides: ["Left", "Right"],
        limbs: [
            ["mixamorig%Arm", "mixamorig%ForeArm", "mixamorig%Hand"],
            ["mixamorig%UpLeg", "mixamorig%Leg", "mixamorig%Foot"],
        ],
        head: "mixamorigHead",
    },
    Scheme {
        name: "Unreal",
        joints: "root - ground, pelvis root hips, spine_01 pelvis spine, spine_02 spine_01 chest, \
            neck_01 spine_02 neck, head neck_01 head, clavicle_% spine_02 clavicle, \
            upperarm_% clavicle_% shoulder, upperarm_twist_01_% upperarm_% arm2, \
            lowerarm_% upperarm_% elbow, lowerarm_twist_01_% lowerarm_% forearm2, \
            hand_% lowerarm_% wrist, index_01_% hand_% finger, thumb_01_% hand_% thumb, \
            thigh_% pelvis hip, thigh_twist_01_% thigh_% thigh2, calf_% thigh_% knee, \
            calf_twist_01_% calf_% shin2, foot_% calf_% ankle, ball_% foot_% toe, \
            ik_foot_root root ground, ik_foot_% ik_foot_root ankle, ik_hand_root root ground, \
            ik_hand_gun ik_hand_root wrist, ik_hand_% ik_hand_gun wrist",
        sides: ["l", "r"],
        limbs: [["upperarm_%", "lowerarm_%", "hand_%"], ["thigh_%", "calf_%", "foot_%"]],
        head: "head",
    },
    Scheme {
        name: "Unity",
        joints: "Hips - hips, Spine Hips spine, Chest Spine chest, Neck Chest neck, Head Neck head, \
            %Shoulder Chest clavicle, %UpperArm %Shoulder shoulder, %LowerArm %UpperArm elbow, \
            %Hand %LowerArm wrist, %IndexProximal %Hand finger, %UpperLeg Hips hip, \
            %LowerLeg %UpperLeg knee, %Foot %LowerLeg ankle, %Toes %Foot toe",
        sides: ["Left", "Right"],
        limbs: [["%UpperArm", "%LowerArm", "%Hand"], ["%UpperLeg", "%LowerLeg", "%Foot"]],
        head: "Head",
    },
    Scheme {
        name: "Rigify metarig",
        joints: "spine - hips, spine.001 spine spine, spine.003 spine.001 chest, \
            spine.004 spine.003 neck, spine.005 spine.004 neck2, spine.006 spine.005 head, \
            shoulder.% spine.003 clavicle, upper_arm.% shoulder.% shoulder, \
            forearm.% upper_arm.% elbow, hand.% forearm.% wrist, palm.01.% hand.% palm, \
            f_index.01.% palm.01.% finger, thumb.01.% hand.% thumb, pelvis.% spine hips, \
            thigh.% spine hip, shin.% thigh.% knee, foot.% shin.% ankle, toe.% foot.% toe, \
            heel.02.% foot.% heel",
        sides: ["L", "R"],
        limbs: [["upper_arm.%", "forearm.%", "hand.%"], ["thigh.%", "shin.%", "foot.%"]],
        head: "spine.006",
    },
    Scheme {
        name: "Rigify DEF bones below ORG bones",
        joints: "root - ground, ORG-spine root hips, DEF-spine ORG-spine hips, \
            ORG-spine.001 ORG-spine spine, DEF-spine.001 DEF-spine spine, \
            DEF-spine.003 DEF-spine.001 chest, DEF-spine.004 DEF-spine.003 neck, \
            DEF-spine.006 DEF-spine.004 head, ORG-shoulder.% DEF-spine.003 clavicle, \
            ORG-upper_arm.% ORG-shoulder.% shoulder, ORG-forearm.% ORG-upper_arm.% elbow, \
            ORG-hand.% ORG-forearm.% wrist, DEF-shoulder.% DEF-spine.003 clavicle, \
            DEF-upper_arm.% DEF-shoulder.% shoulder, DEF-upper_arm.%.001 DEF-upper_arm.% arm2, \
            DEF-forearm.% DEF-upper_arm.%.001 elbow, DEF-forearm.%.001 DEF-forearm.% forearm2, \
            DEF-hand.% DEF-forearm.%.001 wrist, DEF-f_index.01.% DEF-hand.% finger, \
            upper_arm_fk.% root shoulder, forearm_fk.% upper_arm_fk.% elbow, \
            hand_fk.% forearm_fk.% wrist, DEF-thigh.% DEF-spine hip, \
            DEF-thigh.%.001 DEF-thigh.% thigh2, DEF-shin.% DEF-thigh.%.001 knee, \
            DEF-shin.%.001 DEF-shin.% shin2, DEF-foot.% DEF-shin.%.001 ankle, \
            DEF-toe.% DEF-foot.% toe",
        sides: ["L", "R"],
        limbs: [
            ["DEF-upper_arm.%", "DEF-forearm.%", "DEF-hand.%"],
            ["DEF-thigh.%", "DEF-shin.%", "DEF-foot.%"],
        ],
        head: "DEF-spine.006",
    },
    Scheme {
        name: "Rigify ORG bones",
        joints: "ORG-spine - hips, ORG-spine.001 ORG-spine spine, ORG-spine.003 ORG-spine.001 chest, \
            ORG-spine.004 ORG-spine.003 neck, ORG-spine.006 ORG-spine.004 head, \
            ORG-shoulder.% ORG-spine.003 clavicle, ORG-upper_arm.% ORG-shoulder.% shoulder, \
            ORG-forearm.% ORG-upper_arm.% elbow, ORG-hand.% ORG-forearm.% wrist, \
            MCH-hand.% ORG-forearm.% wrist, ORG-thigh.% ORG-spine hip, \
            ORG-shin.% ORG-thigh.% knee, ORG-foot.% ORG-shin.% ankle, ORG-toe.% ORG-foot.% toe",
        sides: ["L", "R"],
        limbs: [
            ["ORG-upper_arm.%", "ORG-forearm.%", "ORG-hand.%"],
            ["ORG-thigh.%", "ORG-shin.%", "ORG-foot.%"],
        ],
        head: "ORG-spine.006",
    },
    Scheme {
        name: "3ds Max Biped",
        joints: "Bip01 - hips, Bip01_Pelvis Bip01 hips, Bip01_Spine Bip01_Pelvis spine, \
            Bip01_Spine1 Bip01_Spine chest, Bip01_Neck Bip01_Spine1 neck, \
            Bip01_Head Bip01_Neck head, Bip01_%_Clavicle Bip01_Neck clavicle, \
            Bip01_%_UpperArm Bip01_%_Clavicle shoulder, Bip01_%_Forearm Bip01_%_UpperArm elbow, \
            Bip01_%_Hand Bip01_%_Forearm wrist, Bip01_%_Finger1 Bip01_%_Hand finger, \
            Bip01_%_Thigh Bip01_Spine hip, Bip01_%_Calf Bip01_%_Thigh knee, \
            Bip01_%_Foot Bip01_%_Calf ankle, Bip01_%_Toe0 Bip01_%_Foot toe",
        sides: ["L", "R"],
        limbs: [
            ["Bip01_%_UpperArm", "Bip01_%_Forearm", "Bip01_%_Hand"],
            ["Bip01_%_Thigh", "Bip01_%_Calf", "Bip01_%_Foot"],
        ],
        head: "Bip01_Head",
    },
    Scheme {
        name: "CMU, Acclaim",
        joints: "root - hips, %hipjoint root hips, %femur %hipjoint hip, %tibia %femur knee, \
            %foot %tibia ankle, %toes %foot toe, lowerback root spine, thorax lowerback chest, \
            lowerneck thorax neck, upperneck lowerneck neck2, head upperneck head, \
            %clavicle thorax clavicle, %humerus %clavicle shoulder, %radius %humerus elbow, \
            %wrist %radius wrist, %hand %wrist palm, %fingers %hand finger, %thumb %wrist thumb",
        sides: ["l", "r"],
        limbs: [["%humerus", "%radius", "%wrist"], ["%femur", "%tibia", "%foot"]],
        head: "head",
    },
    Scheme {
        name: "CMU, BVH",
        joints: "Hips - hips, LowerBack Hips spine, Spine LowerBack spine, Spine1 Spine chest, \
            Neck Spine1 neck, Neck1 Neck neck2, Head Neck1 head, %HipJoint Hips hips, \
            %UpLeg %HipJoint hip, %Leg %UpLeg knee, %Foot %Leg ankle, %ToeBase %Foot toe, \
            %Shoulder Spine1 clavicle, %Arm %Shoulder shoulder, %ForeArm %Arm elbow, \
            %Hand %ForeArm wrist, %FingerBase %Hand palm, %HandIndex1 %FingerBase finger, \
            %Thumb %Hand thumb",
        sides: ["Left", "Right"],
        limbs: [["%Arm", "%ForeArm", "%Hand"], ["%UpLeg", "%Leg", "%Foot"]],
        head: "Head",
    },
    Scheme {
        name: "SMPL",
        joints: "Pelvis - hips, Spine1 Pelvis spine, Spine3 Spine1 chest, Neck Spine3 neck, \
            Head Neck head, %_Collar Spine3 clavicle, %_Shoulder %_Collar shoulder, \
            %_Elbow %_Shoulder elbow, %_Wrist %_Elbow wrist, %_Hand %_Wrist palm, \
            %_Hip Pelvis hip, %_Knee %_Hip knee, %_Ankle %_Knee ankle, %_Foot %_Ankle toe",
        sides: ["L", "R"],
        limbs: [["%_Shoulder", "%_Elbow", "%_Wrist"], ["%_Hip", "%_Knee", "%_Ankle"]],
        head: "Head",
    },
    Scheme {
        name: "Daz",
        joints: "hip - hips, abdomenLower hip spine, chestLower abdomenLower chest, \
            neckLower chestLower neck, head neckLower head, %Collar chestLower clavicle, \
            %ShldrBend %Collar shoulder, %ShldrTwist %ShldrBend arm2, \
            %ForearmBend %ShldrTwist elbow, %ForearmTwist %ForearmBend forearm2, \
            %Hand %ForearmTwist wrist, %Index1 %Hand finger, %ThighBend hip hip, \
            %ThighTwist %ThighBend thigh2, %Shin %ThighTwist knee, %Foot %Shin ankle, \
            %Toe %Foot toe",
        sides: ["l", "r"],
        limbs: [["%ShldrBend", "%ForearmBend", "%Hand"], ["%ThighBend", "%Shin", "%Foot"]],
        head: "head",
    },
    Scheme {
        name: "MakeHuman",
        joints: "root - hips, spine05 root spine, spine01 spine05 chest, neck01 spine01 neck, \
            neck03 neck01 neck2, head neck03 head, clavicle.% spine01 clavicle, \
            upperarm01.% clavicle.% shoulder, upperarm02.% upperarm01.% arm2, \
            lowerarm01.% upperarm02.% elbow, lowerarm02.% lowerarm01.% forearm2, \
            wrist.% lowerarm02.% wrist, finger2-1.% wrist.% finger, pelvis.% root hips, \
            upperleg01.% pelvis.% hip, upperleg02.% upperleg01.% thigh2, \
            lowerleg01.% upperleg02.% knee, lowerleg02.% lowerleg01.% shin2, \
            foot.% lowerleg02.% ankle, toe1-1.% foot.% toe",
        sides: ["L", "R"],
        limbs: [
            ["upperarm01.%", "lowerarm01.%", "wrist.%"],
            ["upperleg01.%", "lowerleg01.%", "foot.%"],
        ],
        head: "head",
    },
    Scheme {
        name: "MikuMikuDance",
        joints: "センター - hips, 上半身 センター spine, 上半身2 上半身 chest, 首 上半身2 neck, 頭 首 head, \
            %肩 上半身2 clavicle, %腕 %肩 shoulder, %腕捩 %腕 arm2, %ひじ %腕捩 elbow, \
            %手捩 %ひじ forearm2, %手首 %手捩 wrist, %人指１ %手首 finger, 下半身 センター hips, \
            %足 下半身 hip, %ひざ %足 knee, %足首 %ひざ ankle, %つま先 %足首 toe, \
            %足ＩＫ センター ankle",
        sides: ["左", "右"],
        limbs: [["%腕", "%ひじ", "%手首"], ["%足", "%ひざ", "%足首"]],
        head: "頭",
    },
    Scheme {
        name: "joints by name, as many BVH files",
        joints: "Hips - hips, Chest Hips spine, Chest2 Chest chest, Neck Chest2 neck, Head Neck head, \
            %Collar Chest2 clavicle, %Shoulder %Collar shoulder, %Elbow %Shoulder elbow, \
            %Wrist %Elbow wrist, %Hip Hips hip, %Knee %Hip knee, %Ankle %Knee ankle, \
            %Toe %Ankle toe",
        sides: ["Left", "Right"],
        limbs: [["%Shoulder", "%Elbow", "%Wrist"], ["%Hip", "%Knee", "%Ankle"]],
        head: "Head",
    },
    Scheme {
        name: "a character's name in front",
        joints: "Bob_Hips - hips, Bob_Spine Bob_Hips chest, Bob_Neck Bob_Spine neck, \
            Bob_Head Bob_Neck head, Bob_Shoulder_% Bob_Spine clavicle, \
            Bob_UpperArm_%_jnt Bob_Shoulder_% shoulder, Bob_LowerArm_%_jnt Bob_UpperArm_%_jnt elbow, \
            Bob_Hand_%_jnt Bob_LowerArm_%_jnt wrist, Bob_UpperLeg_%_jnt Bob_Hips hip, \
            Bob_LowerLeg_%_jnt Bob_UpperLeg_%_jnt knee, Bob_Foot_%_jnt Bob_LowerLeg_%_jnt ankle, \
            Bob_Toes_%_jnt Bob_Foot_%_jnt toe",
        sides: ["left", "right"],
        limbs: [
            ["Bob_UpperArm_%_jnt", "Bob_LowerArm_%_jnt", "Bob_Hand_%_jnt"],
            ["Bob_UpperLeg_%_jnt", "Bob_LowerLeg_%_jnt", "Bob_Foot_%_jnt"],
        ],
        head: "Bob_Head",
    },
];

/// A joint's name, that of its parent, and its place in skeleton space.
pub type Place = (String, Option<String>, Vec3);

impl Scheme {
    /// The joints of a person, left before right.
    pub fn places(&self) -> Vec<Place> {
        let mut places = Vec::new();
        for joint in self.joints.split(',') {
            let [name, parent, place] = joint.split_whitespace().collect::<Vec<_>>()[..] else {
                panic!("{}: {joint:?} must have a name, a parent and a place", self.name);
            };
            let (_, [x, y, z]) = PLACES.iter().find(|(it, _)| *it == place).expect(place);
            let sides: &[(&str, f32)] = if name.contains('%') {
                &[(self.sides[0], 1.0), (self.sides[1], -1.0)]
            } else {
                &[("", 1.0)]
            };
            for (side, sign) in sides {
                let of_side = |name: &str| name.replace('%', side);
                let parent = (parent != "-").then(|| of_side(parent));
                places.push((of_side(name), parent, Vec3::new(sign * x, *y, *z)));
            }
        }
        places
    }

    /// A person in a T-pose.
    pub fn person(&self) -> Skeleton {
        skeleton(&self.places(), |_| Mat3::IDENTITY)
    }
}

/// A skeleton of joints at these places, with frames that `frame` gives. Bones end at the first
/// child, as simple importers have them.
pub fn skeleton(places: &[Place], mut frame: impl FnMut(usize) -> Mat3) -> Skeleton {
    let index = |name: &str| places.iter().position(|(it, ..)| it == name).expect(name);
    let joint = |(at, (name, parent, place)): (usize, &Place)| {
        let parent = parent.as_deref().map(index);
        let origin = parent.map_or(Vec3::ZERO, |parent| places[parent].2);
        let child = places.iter().find(|(_, above, _)| above.as_ref() == Some(name));
        let axis = child.map_or(Vec3::ZERO, |(_, _, child)| *child - *place);
        let joint = Joint::new(name, parent.map(Into::into), axis);
        Joint { offset: *place - origin, frame: frame(at), ..joint }
    };
    let joints = places.iter().enumerate().map(joint).collect();
    Skeleton::from_joints(joints).expect("a valid skeleton")
}

/// The places with other names, which tell nothing, and every joint before its children but otherwise in a
/// random order.
pub fn unnamed(places: &[Place], random: &mut Random) -> Vec<Place> {
    let mut left: Vec<&Place> = places.iter().collect();
    let mut ordered: Vec<&Place> = Vec::new();
    while !left.is_empty() {
        let next = random.below(left.len());
        let (_, parent, _) = left[next];
        let is_ready = |name: &String| ordered.iter().any(|(it, ..)| it == name);
        if parent.as_ref().is_none_or(is_ready) {
            ordered.push(left.swap_remove(next));
        }
    }
    let number = |name: &String| {
        let index = ordered.iter().position(|(it, ..)| it == name);
        format!("joint_{}", index.expect("a joint of this name"))
    };
    let renamed =
        |(name, parent, place): &&Place| (number(name), parent.as_ref().map(number), *place);
    ordered.iter().map(renamed).collect()
}
