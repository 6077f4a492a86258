//! Robots of ROS, `.urdf`: links that are joined by joints, as XML.
//!
//! ```text
//! <robot name="…">
//!   <material name="…"><color rgba="r g b a"/></material>
//!   <link name="…">
//!     <visual>                                    any number
//!       <origin xyz="x y z" rpy="r p y"/>         from the link's frame
//!       <geometry> box size | cylinder radius length | sphere radius | mesh filename </geometry>
//!       <material name="…"/>
//!     </visual>
//!   </link>
//!   <joint name="…" type="revolute | continuous | fixed | …">
//!     <parent link="…"/> <child link="…"/>
//!     <origin xyz="x y z" rpy="r p y"/>           the child's frame in the parent's
//!     <axis xyz="x y z"/>                         in the child's frame; x if there is none
//!     <limit lower="…" upper="…"/>
//!   </joint>
//! </robot>
//! ```
//!
//! Lengths are metres, angles radians; r, p and y turn about fixed axes, R_z(y)·R_y(p)·R_x(r). z
//! points up. Source: the URDF specification, <https://wiki.ros.org/urdf/XML>.
//!
//! # Import
//!
//! Each link becomes a joint of the skeleton, at the link's frame. If it turns it has the name of
//! its joint, otherwise that of the link. It turns about z of its own frame alone, by the angle of
//! the file's joint, within its limits. Joints that do not turn are locked, and so are those that a
//! `mimic` element couples to others. Boxes, cylinders and spheres become a mesh on the joints.

mod file;
mod rig;
mod shapes;
mod xml;

pub use file::is_urdf;
pub use rig::read;
