//! The steps of the tour: each is one row of the table [`STEPS`].

use crate::document::Document;
use crate::io::{OpenError, OpenOptions, parse};
use crate::session::preferences::PanelTab;

/// A step of the tour.
///
/// Texts may name live numbers of the scene in braces, such as `{hand}`. Parts of the window and
/// new terms are between asterisks.
#[derive(Clone, Debug, PartialEq)]
pub struct TourStep {
    /// The step's title.
    pub title: &'static str,
    /// Text of the file with the scene.
    scene: &'static str,
    /// Page of the panel on the right that the step shows.
    pub tab: Option<PanelTab>,
    /// Section of the left panel that the step opens, after the section that it is in and `/`.
    pub section: Option<&'static str>,
    /// Name of the joint that is selected at first.
    pub(in crate::session) select: Option<&'static str>,
    /// Introduction to the scene.
    pub text: &'static str,
    /// The question to think about before the task.
    pub guess: Guess,
    /// The task, done with the mouse.
    pub task: &'static str,
    /// The same task without a mouse.
    pub keyboard: &'static str,
    /// The task, for the program.
    pub goal: Goal,
    /// The result of the task, and its cause.
    pub result: &'static str,
}

/// A question with its possible answers.
#[derive(Clone, Debug, PartialEq)]
pub struct Guess {
    /// The question.
    pub question: &'static str,
    /// Two to four answers.
    pub answers: &'static [&'static str],
    /// Index of the right answer.
    right: usize,
}

impl Guess {
    /// The right answer.
    pub fn right_answer(&self) -> &'static str {
        self.answers.get(self.right).copied().unwrap_or_default()
    }

    /// True for the right answer, counted from 0.
    pub fn is_right(&self, answer: usize) -> bool {
        answer == self.right
    }
}

/// The task of a step, which the program notices when it is done (`goals.rs`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Goal {
    /// Move the hand above the shoulder to the other side.
    PassOverTheShoulder,
    /// Pose the arm by FK so that the hand moves.
    MoveTheHandByFk,
    /// Bend the elbow at a right angle.
    BendTheElbowAtARightAngle,
    /// Turn the elbow by at least a quarter of its circle, without the hand.
    TurnTheElbowAlongItsCircle,
    /// Give both limbs the same length.
    CloseTheHole,
    /// Move the Cursor farther away than the arm is long.
    MoveTheCursorOutOfReach,
    /// Soften the limits of the reach.
    SoftenTheLimits,
    /// Choose the twist reference Transport.
    ChooseTransport,
    /// Move the shoulder while the hand stays in the world.
    MoveTheShoulderAndKeepTheHand,
    /// Play the timeline by IK.
    PlayByIk,
    /// Race all solvers to the end.
    RaceAllSolvers,
    /// Move the skeleton so that a target is out of reach.
    LeaveATargetOutOfReach,
    /// Pull a hand so far that the body comes along, while hands and feet reach their targets.
    PullTheBodyAlong,
}

/// The card after the last step, with the conclusions of the tour.
#[derive(Clone, Debug, PartialEq)]
pub struct TourEnd {
    /// The card's title.
    pub title: &'static str,
    /// Conclusions, in the user's words.
    pub sentences: &'static [&'static str],
    /// Where to go next, with parts of the window between asterisks.
    pub next: &'static str,
}

impl TourEnd {
    /// The card after the last step.
    pub fn get() -> &'static Self {
        &END
    }
}

impl TourStep {
    /// All steps, in order.
    pub fn all() -> &'static [Self] {
        &STEPS
    }

    /// The document of the step's scene.
    ///
    /// # Errors
    ///
    /// Never fails: a test opens every scene.
    pub fn document(&self) -> Result<Document, OpenError> {
        let mut document = parse(self.title, self.scene, &OpenOptions::default())?.document;
        // A body that follows would keep the targets within reach.
        document.rig.body_follows &= self.goal != Goal::LeaveATargetOutOfReach;
        Ok(document)
    }
}

static STEPS: [TourStep; 13] = [
    TourStep {
        title: "Over the shoulder",
        scene: include_str!("../../../assets/tour/over-the-shoulder.json"),
        tab: Some(PanelTab::Pops),
        section: None,
        select: None,
        text: "You move the hand of this arm, and the program finds a place for the elbow. When \
            the hand moves a little, the elbow moves a little.",
        guess: Guess {
            question: "The hand passes right above the shoulder. What does the elbow do?",
            answers: &["It follows smoothly", "It stops", "It jumps to the other side"],
            right: 2,
        },
        task: "Drag the red arrow at the hand to the left, until the hand has passed over the \
            shoulder.",
        keyboard: "Tab to the slider *Hand x* and hold the left arrow key.",
        goal: Goal::PassOverTheShoulder,
        result: "In one step of the drag the hand moved {hand_step} mm and the elbow {elbow_step} mm, \
            {elbow_to_hand} times as far. Nothing is broken. The elbow could be in many places, \
            so a rule chooses one. This rule says: as high as it can be. When the hand is \
            straight above the shoulder, all these places are equally high, and the rule cannot \
            choose. To the right of there it chooses one place, to the left the opposite one. \
            Such a jump is called a *pop*, and a pop to the other side a *flip*. The next steps \
            show why a rule is needed.",
    },
    TourStep {
        title: "From hand to angles, and back",
        scene: include_str!("../../../assets/tour/elbow-circle.json"),
        tab: None,
        section: Some("Limb/FK and IK"),
        select: None,
        text: "An arm bends at its *joints*: at the shoulder by three angles, at the elbow by one. \
            These four *joint angles* make its *pose*. With *inverse kinematics* (IK) you give \
            the place of the hand, and the program computes the angles. With *forward kinematics* \
            (FK) you give the angles, and the place of the hand follows.",
        guess: Guess {
            question: "With FK you bend the elbow and nothing else. Where does the hand go?",
            answers: &["It stays", "Along a circle around the elbow", "Along a straight line"],
            right: 1,
        },
        task: "In *FK and IK* on the left, press *FK*. Then drag the slider *Bend*.",
        keyboard: "Tab to *FK*, press Space, Tab on to *Bend*, and use the arrow keys.",
        goal: Goal::MoveTheHandByFk,
        result: "You gave an angle, and the hand went along a circle around the elbow, to {hand}. \
            These are x (to the right), y (up) and z (towards you), in millimetres from the \
            shoulder. FK goes along the arm from joint to joint and has exactly one answer. IK \
            asks backwards: given are the lengths of the limbs and the place of the hand, wanted \
            are the four angles. There can be one answer, many, or none.",
    },
    TourStep {
        title: "Three lengths make a triangle",
        scene: include_str!("../../../assets/tour/elbow-circle.json"),
        tab: Some(PanelTab::Triangle),
        section: None,
        select: None,
        text: "Shoulder, elbow and hand are the corners of a triangle. Its sides are the upper \
            limb ({upper} mm), the lower limb ({lower} mm) and the distance from shoulder to hand \
            ({distance} mm). The elbow's angle φ, between the limbs, is {elbow_angle} now.",
        guess: Guess {
            question: "The hand moves away from the shoulder. What does the elbow's angle do?",
            answers: &["It grows", "It shrinks", "It stays"],
            right: 0,
        },
        task: "Drag the hand away from the shoulder until the elbow has a right angle. The page \
            *Triangle* on the right marks its angle φ.",
        keyboard: "Tab to the slider *Hand x* and use the arrow keys.",
        goal: Goal::BendTheElbowAtARightAngle,
        result: "It grew: at the distance {distance} mm it is {elbow_angle}. Why do three lengths fix \
            it? Lay the triangle flat. The elbow is as far from the shoulder as the upper limb is \
            long: on a circle around the shoulder. It is as far from the hand as the lower limb \
            is long: on a circle around the hand. The circles cross in two points, mirror images \
            of each other. Both give the same triangle, so all its angles are fixed. The law of \
            cosines computes them: cos φ = (upper² + lower² − distance²) / (2 · upper · lower), \
            and at the shoulder cos θ = (upper² + distance² − lower²) / (2 · upper · distance).",
    },
    TourStep {
        title: "Where the elbow can be",
        scene: include_str!("../../../assets/tour/elbow-circle.json"),
        tab: Some(PanelTab::Twist),
        section: None,
        select: None,
        text: "The line from the shoulder to the hand is called the *Pointer*. Two angles say where \
            it points: the *yaw* sideways, tan yaw = z / x, and the *pitch* upwards, tan pitch = \
            y / √(x² + z²), with the hand's x, y and z (page *Triangle*). The upper limb leans \
            away from it by the angle θ of step 3. In this step the hand keeps its place.",
        guess: Guess {
            question: "How many places can the elbow have?",
            answers: &["One", "Two", "A whole circle of them"],
            right: 2,
        },
        task: "Drag the elbow as far as it goes, at least a quarter of the way round.",
        keyboard: "Tab to the slider *Socket twist* and press Page Up a few times.",
        goal: Goal::TurnTheElbowAlongItsCircle,
        result: "A whole circle: the triangle turned about the Pointer, like a door on its hinges, and \
            the hand stayed at {hand}. These three numbers fix three of the four joint angles: \
            the elbow's φ, and yaw and pitch at the shoulder (θ comes with the triangle). The \
            fourth, at the shoulder, too, is free: the *Socket twist*, now {twist}, turns the \
            triangle about the Pointer. So place *and* twist are given, and the pose is computed. \
            Twist 0° is a mark on the circle. A rule says where this mark is for each direction \
            of the Pointer: the *twist reference*. In step 1 it was the highest point.",
    },
    TourStep {
        title: "Where the hand can be",
        scene: include_str!("../../../assets/tour/limits.json"),
        tab: Some(PanelTab::Reach),
        section: Some("Limb/Lengths"),
        select: None,
        text: "No side of a triangle is longer than the other two together. So the hand is at most \
            as far from the shoulder as both limbs together ({farthest} mm, the large sphere), \
            and at least as far as their difference ({nearest} mm, the small sphere): when the \
            arm is folded, the longer limb still sticks out. Every place between the spheres can \
            be reached.",
        guess: Guess {
            question: "The inside of the small sphere is a hole. Suppose both limbs get the same length. \
                What becomes of the hole?",
            answers: &["It grows", "It stays", "It vanishes"],
            right: 2,
        },
        task: "In *Lengths* on the left, drag *Lower* until both limbs are equally long.",
        keyboard: "Tab to the number beside *Lower*, type 200 and press Enter.",
        goal: Goal::CloseTheHole,
        result: "It vanished: the nearest distance, the difference of the lengths, is now \
            {nearest} mm. An arm with equal limbs can fold up completely and bring its hand back \
            to the shoulder. The farthest distance, the sum, is now {farthest} mm.",
    },
    TourStep {
        title: "Out of reach",
        scene: include_str!("../../../assets/tour/limits.json"),
        tab: Some(PanelTab::Reach),
        section: None,
        select: None,
        text: "The place where the hand should be is its target. The target of this arm is called \
            the *Cursor*. The Cursor can be anywhere. The hand cannot.",
        guess: Guess {
            question: "The Cursor is farther away than the arm is long. What does the arm do?",
            answers: &[
                "It stops where it was",
                "It points at the Cursor, straight",
                "It gives an error",
            ],
            right: 1,
        },
        task: "Drag the Cursor away from the shoulder, out of the large sphere.",
        keyboard: "Tab to the slider *Hand x* and press Page Up until the arm is straight.",
        goal: Goal::MoveTheCursorOutOfReach,
        result: "The arm is straight and points at the Cursor. The hand is {gap} mm short of it: \
            the dashed line. No other pose of this arm brings the hand nearer, so this is a \
            result, not an error. For a Cursor inside the hole of the small sphere, the arm folds \
            up, and the hand stops at that sphere, as near as it can be.",
    },
    TourStep {
        title: "Nearly straight",
        scene: include_str!("../../../assets/tour/nearly-straight.json"),
        tab: Some(PanelTab::Reach),
        section: Some("Limb/Soft limits"),
        select: None,
        text: "The limbs are {upper} mm and {lower} mm long, together {sum} mm. The Cursor is \
            {cursor_at_start} mm away: the arm is nearly straight.",
        guess: Guess {
            question: "The Cursor moves outwards by 1 mm. How far does the elbow move?",
            answers: &["Less than 1 mm", "About 1 mm", "More than 5 mm"],
            right: 2,
        },
        task: "Drag the hand slowly outwards until the arm is straight, and watch the elbow. Then \
            raise *Softness* to 0.1 in *Soft limits* on the left, and drag again.",
        keyboard: "Hold Page Up at the slider *Hand x*. Then Tab to the number beside *Softness*, \
            type 0.1 and press Enter.",
        goal: Goal::SoftenTheLimits,
        result: "That 1 mm moves the elbow by {hard_race} mm, and the straighter the arm, the more: \
            the elbow *races*, then stops dead. The page *Reach* on the right shows why: two \
            poses laid over each other. In a flat triangle the limbs swing almost at right angles \
            to the line from shoulder to hand, so they must swing far to make it a little longer. \
            With the softness {softness} the hand slows down shortly before the arm is straight, \
            and the same 1 mm moves the elbow by {race} mm. The price: the hand stays {soft_gap} \
            mm short of a Cursor that it could reach.",
    },
    TourStep {
        title: "A rule for the elbow",
        scene: include_str!("../../../assets/tour/globe.json"),
        tab: Some(PanelTab::Twist),
        section: Some("Socket twist"),
        select: None,
        text: "A *twist reference* (step 4) is the rule that sets the elbow's mark on its circle. \
            *Up* takes the highest point, *Pole* the point nearest to a fixed place, \
            *Stereographic* one that a map gives for each direction. The globe shows these \
            directions: the brighter, the farther the elbow turns there.",
        guess: Guess {
            question: "These three look only at the direction of the hand. Which of them never \
                flips the elbow?",
            answers: &["Up", "Pole", "Stereographic", "None of them"],
            right: 3,
        },
        task: "On the left, beside *Socket twist*, choose the references Pole, Stereographic and \
            at last Transport. Watch the bright spots on the globe.",
        keyboard: "Tab to *Twist reference*, press Space, and choose with the arrow keys and \
            Enter.",
        goal: Goal::ChooseTransport,
        result: "All three flip: Up straight above and below, Pole on the line through shoulder and \
            pole, Stereographic in one direction, to the left. Every rule that looks at the \
            direction alone flips somewhere: hairs lying on the globe, each showing where the \
            elbow is, cannot be combed without a parting or a swirl. But you choose where: \
            another rule, or a pole elsewhere, moves the flip to where the hand never goes. \
            *Transport* looks at the hand's path instead: it carries the elbow along and never \
            flips. Its price: after a round trip the elbow is elsewhere, turned by {holonomy} \
            here.",
    },
    TourStep {
        title: "The shoulder moves",
        scene: include_str!("../../../assets/tour/elbow-circle.json"),
        tab: None,
        section: Some("Limb/Root"),
        select: None,
        text: "A hand leans on a table while the body moves. If the hand *slides* over the table, \
            everyone sees that something is wrong. Here the Cursor belongs to the shoulder and \
            goes along with it. It can also be *pinned to the world*: then it keeps its place \
            wherever the shoulder goes.",
        guess: Guess {
            question: "Nothing is pinned, and the shoulder moves. When does the hand slide?",
            answers: &["By FK, with fixed angles", "By IK, with this Cursor", "By both"],
            right: 2,
        },
        task: "Beside *Hand* on the left, tick *Pinned to world*. Then drag the shoulder by its \
            middle.",
        keyboard: "Tab to *Pinned to world*, press Space, Tab to *Root x*, and use Page Up.",
        goal: Goal::MoveTheShoulderAndKeepTheHand,
        result: "By both: fixed angles carry the hand along with the shoulder, and so does a \
            Cursor that belongs to the shoulder. Now the Cursor is pinned to the world. The \
            shoulder (called the Root) moved by {shoulder_moved} mm, and the hand is {gap} mm from \
            its Cursor: IK computed new angles for each place of the shoulder. Untick *Pinned to \
            world* and drag the shoulder again: the hand slides.",
    },
    TourStep {
        title: "Between two keys",
        scene: include_str!("../../../assets/tour/two-keys.json"),
        tab: None,
        section: Some("Limb/FK and IK"),
        select: None,
        text: "A *key* stores a pose at a time. Here are two, and the program fills in the poses \
            between. With FK it goes evenly from angles to angles, with IK from place to place of \
            the hand. The thin line is the path of the hand.",
        guess: Guess {
            question: "Which of them takes the hand along a straight line?",
            answers: &["FK, from angles", "IK, from places", "Both: the keys are the same"],
            right: 1,
        },
        task: "Press Space to play: now it is FK. Then press *IK* in *FK and IK* on the left and \
            watch the path.",
        keyboard: "Space plays while the view has the keyboard; Tab to *IK* and press Space there.",
        goal: Goal::PlayByIk,
        result: "IK: its path leaves the straight line by {ik_bow} mm, that of FK by {fk_bow} mm. \
            FK turns each joint evenly, so the hand swings along an arc. That looks natural for \
            what swings freely, such as the arms in a walk. What touches the world must keep its \
            place or its line, such as a hand on a table or a foot on the floor: use IK for it.",
    },
    TourStep {
        title: "Why long chains iterate",
        scene: include_str!("../../../assets/ten-joints.json"),
        tab: Some(PanelTab::Race),
        section: None,
        select: None,
        text: "This chain has {angles} joint angles, and the target of its tip gives three numbers. \
            Even with rules for the {spare} left over, no formula gives these three: there is no \
            triangle, each angle depends on all others. So a *solver* starts from the pose that \
            is there and improves it again and again. Each time is an *iteration*.",
        guess: Guess {
            question: "All solvers start from the same pose and have the same target. Do they end \
                in the same pose?",
            answers: &["Yes, there is one target", "No, each finds its own way"],
            right: 1,
        },
        task: "On the page *Race* on the right, press *Race all solvers* and wait for the end.",
        keyboard: "Tab to *Race all solvers* and press Space.",
        goal: Goal::RaceAllSolvers,
        result: "No. *Jacobian transpose* turns all joints, each by how fast it brings the tip nearer. \
            *Damped least squares* computes the turns that together bring the tip there, and \
            damps huge ones. *CCD* turns one joint after the other, until tip and target are in \
            line. *FABRIK* puts the tip on the target, pulls the joints after it, then does so \
            from the root. *Constraint relaxation* puts the tip there, then moves both ends of \
            each bone to restore its length. *Two-bone* turns two bones only (step 3) and ends \
            {two_bone_miss} away. Fewest iterations: {first}, {fewest}; most: {last}, {most}. \
            Start with FABRIK.",
    },
    TourStep {
        title: "A figure of your own",
        scene: include_str!("../../../assets/human.json"),
        tab: None,
        section: Some("Skeleton/Translation"),
        select: Some("pelvis"),
        text: "Each hand and each foot of this figure has a target in the world. Every limb is such \
            an arm: a knee has its triangle (step 3) and its circle (step 4), and a foot stays on \
            the floor like the pinned hand of step 9. Drag a hand, a foot or the pelvis.",
        guess: Guess {
            question: "The pelvis goes up and up. What do the feet do?",
            answers: &[
                "They go up with it at once",
                "They stay until the legs are straight",
                "They stay, and the legs get longer",
            ],
            right: 1,
        },
        task: "Drag the pelvis up, until a hand or a foot does not reach its target any more.",
        keyboard: "Select *pelvis* in the tree on the left, Tab to *y* in *Translation*, and use \
            Page Up.",
        goal: Goal::LeaveATargetOutOfReach,
        result: "They stayed until the legs were straight, like the arm in step 6. Now {missed} is \
            {miss} short of its target, as the list of targets says, and points at it. Pull the \
            pelvis down again: the feet stay on the floor, and the knees bend.",
    },
    TourStep {
        title: "A body is a chain of compromises",
        scene: include_str!("../../../assets/human.json"),
        tab: None,
        section: None,
        select: Some("left_hand"),
        text: "Now *Whole body follows*, the switch below the targets, is on: where an arm is \
            too short, it pulls its shoulder along. All joints up to the pelvis share the motion, \
            stiff ones give less, and the feet, whose targets weigh most, stay where they are.",
        guess: Guess {
            question: "You pull the left hand farther away than the arm is long. What comes along?",
            answers: &[
                "Nothing: the hand stays short",
                "The chest and the pelvis",
                "The whole figure, feet and all",
            ],
            right: 1,
        },
        task: "Drag the left hand to the side, away from the body, until the chest leans after it.",
        keyboard: "Select *left_hand* in the tree on the left, Tab to *Target x*, and use Page Up.",
        goal: Goal::PullTheBodyAlong,
        result: "The chest moved by {chest_moved} and the pelvis by {pelvis_moved}; the hand is there, \
            and the feet are where they were. Pull farther, and the legs end it: then the targets \
            cannot all be reached, and the panel tells which one is short and why.",
    },
];

static END: TourEnd = TourEnd {
    title: "What you can say now",
    sentences: &[
        "IK computes joint angles from the place of the hand; FK goes the other way.",
        "Three lengths fix the triangle. It can still turn, so the elbow has a circle.",
        "A rule picks the elbow's place. If it looks at the direction alone, it flips somewhere.",
        "Nearly straight, the elbow races. Softness calms it; the hand then stays a little short.",
        "FK swings along arcs, IK keeps places. Long chains need solvers, which iterate.",
    ],
    next: "Go on with *Examples → Inside a solver*, *Examples → Why not reached*, *Help → Glossary*, and \
        docs/guide.md. *Finish* puts your own document back.",
};
