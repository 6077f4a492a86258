// Moves the vertices of a skin with its joints: linear blending, dual quaternions or spread twist.

const LINEAR = 0u;
const DUAL_QUATERNION = 1u;

struct Skin {
    to_world: array<vec4f, 3>, // rows; from skeleton space
    vertices: u32,
    skinning: u32, // linear, dual quaternion, spread twist
    weights_of: i32, // joint whose weight is passed on; -1 for none
    joints: u32, // in each set of inverse bind transforms
}

struct Joint {
    matrix: array<vec4f, 3>, // rows of J, from mesh space to skeleton space
    turn: array<vec4f, 3>, // rows of X·K·B⁻¹
    turn_twice: array<vec4f, 3>, // rows of X·K²·B⁻¹
    scale: array<vec4f, 3>, // rows of the scale of J
    real: vec4f, // unit dual quaternion of J without its scale
    dual: vec4f,
    along: vec4f, // fraction of the bone at a point: along · (v, 1)
    roll: vec4f, // x: roll of the joint about its bone
}

struct Vertex {
    position: vec3f,
    joints_low: u32, // two joints of 16 bits
    normal: vec3f,
    joints_high: u32,
    weights: vec4f,
}

struct Deformed {
    position: vec4f, // in the world; w: weight of the chosen joint
    normal: vec4f, // in the world
}

@group(0) @binding(0) var<uniform> skin: Skin;
@group(0) @binding(1) var<storage, read> joints: array<Joint>;
@group(0) @binding(2) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(3) var<storage, read_write> deformed: array<Deformed>;

alias Rows = array<vec4f, 3>;

fn times(rows: Rows, factor: f32) -> Rows {
    return Rows(rows[0] * factor, rows[1] * factor, rows[2] * factor);
}

fn plus(a: Rows, b: Rows) -> Rows {
    return Rows(a[0] + b[0], a[1] + b[1], a[2] + b[2]);
}

// Rows of the product of two transforms.
fn product(a: Rows, b: Rows) -> Rows {
    var rows: Rows;
    for (var i = 0; i < 3; i++) {
        rows[i] = a[i].x * b[0] + a[i].y * b[1] + a[i].z * b[2] + vec4f(0.0, 0.0, 0.0, a[i].w);
    }
    return rows;
}

fn apply(rows: Rows, point: vec4f) -> vec3f {
    return vec3f(dot(rows[0], point), dot(rows[1], point), dot(rows[2], point));
}

// J with the part of the joint's roll at the vertex instead of all of it.
fn spread(joint: u32, vertex: vec3f) -> Rows {
    let fraction = saturate(dot(joints[joint].along, vec4f(vertex, 1.0)));
    let angle = -(1.0 - fraction) * joints[joint].roll.x;
    let turned = plus(times(joints[joint].turn, sin(angle)), times(joints[joint].turn_twice, 1.0 - cos(angle)));
    return plus(joints[joint].matrix, turned);
}

// Rows of the rigid motion of a dual quaternion that need not have unit length.
fn motion(sum_real: vec4f, sum_dual: vec4f) -> Rows {
    let size = length(sum_real);
    let real = select(sum_real / size, vec4f(0.0, 0.0, 0.0, 1.0), size == 0.0);
    let dual = select(sum_dual / size, vec4f(0.0), size == 0.0);
    let at = 2.0 * (real.w * dual.xyz - dual.w * real.xyz + cross(real.xyz, dual.xyz));
    let q = real.xyz;
    let twice = 2.0 * q;
    return Rows(
        vec4f(1.0 - twice.y * q.y - twice.z * q.z, twice.x * q.y - twice.z * real.w, twice.x * q.z + twice.y * real.w, at.x),
        vec4f(twice.x * q.y + twice.z * real.w, 1.0 - twice.x * q.x - twice.z * q.z, twice.y * q.z - twice.x * real.w, at.y),
        vec4f(twice.x * q.z - twice.y * real.w, twice.y * q.z + twice.x * real.w, 1.0 - twice.x * q.x - twice.y * q.y, at.z),
    );
}

// Normal under the linear part of a transform, by its cofactors.
fn moved_normal(rows: Rows, normal: vec3f) -> vec3f {
    let cofactors = vec3f(
        dot(cross(rows[1].xyz, rows[2].xyz), normal),
        dot(cross(rows[2].xyz, rows[0].xyz), normal),
        dot(cross(rows[0].xyz, rows[1].xyz), normal),
    );
    let mirror = select(1.0, -1.0, dot(rows[0].xyz, cross(rows[1].xyz, rows[2].xyz)) < 0.0);
    // Scaled first, so that the square of a small vector does not underflow.
    let size = max(abs(cofactors.x), max(abs(cofactors.y), abs(cofactors.z)));
    return select(normalize(cofactors / size) * mirror, normal, size == 0.0);
}

@compute @workgroup_size(256)
fn compute(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= skin.vertices {
        return;
    }
    let vertex = vertices[id.x];
    let influences = vec4u(
        vertex.joints_low & 0xffffu,
        vertex.joints_low >> 16u,
        vertex.joints_high & 0xffffu,
        vertex.joints_high >> 16u,
    );
    let zero = Rows(vec4f(0.0), vec4f(0.0), vec4f(0.0));
    var blend = zero;
    var scale = zero;
    var real = vec4f(0.0);
    var dual = vec4f(0.0);
    var chosen = 0.0;
    for (var i = 0; i < 4; i++) {
        let weight = vertex.weights[i];
        if weight == 0.0 {
            break;
        }
        let joint = influences[i];
        chosen += select(0.0, weight, i32(joint % skin.joints) == skin.weights_of);
        if skin.skinning == LINEAR {
            blend = plus(blend, times(joints[joint].matrix, weight));
        } else if skin.skinning == DUAL_QUATERNION {
            let side = dot(joints[joint].real, joints[influences.x].real);
            let signed = select(weight, -weight, side < 0.0);
            scale = plus(scale, times(joints[joint].scale, weight));
            real += joints[joint].real * signed;
            dual += joints[joint].dual * signed;
        } else {
            blend = plus(blend, times(spread(joint, vertex.position), weight));
        }
    }
    if skin.skinning == DUAL_QUATERNION {
        blend = product(motion(real, dual), scale);
    }
    let to_world = product(skin.to_world, blend);
    deformed[id.x] = Deformed(
        vec4f(apply(to_world, vec4f(vertex.position, 1.0)), chosen),
        vec4f(moved_normal(to_world, vertex.normal), 0.0),
    );
}
