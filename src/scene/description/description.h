// A scene as plain values: the content of the file, checked, with all defaults filled in and all meshes loaded. Made by
// load_scene(), and immutable after that. The simulation reads the bodies, the renderer their appearance. SI units,
// world frame unless said otherwise, y up; colors sRGB.
#pragma once

#include "core/color.h"
#include "core/triangle_mesh.h"
#include "core/vector.h"
#include "scene/description/environment.h"
#include "scene/description/force_fields.h"
#include "scene/description/fracture.h"
#include "scene/description/joint.h"
#include "scene/description/mesh_paint.h"
#include "scene/description/overlay.h"
#include "scene/description/water.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace tumble {

// Restitution and friction of two bodies that touch, from the values of both.

enum class PairRule : std::uint8_t { average, minimum, multiply, maximum, geometric };

/// The rules of a scene.
struct PairRules {
    PairRule restitution = PairRule::maximum, friction = PairRule::geometric;
    bool operator==(const PairRules&) const = default;
};

/// Instead of a value: the body takes the value of the other one.
inline constexpr double value_of_other = -1.0;

inline double pair_value(PairRule rule, double a, double b) {
    if (a < 0.0 || b < 0.0) return std::max({a, b, 0.0});
    switch (rule) {
        case PairRule::average:
            return 0.5 * (a + b);
        case PairRule::minimum:
            return std::min(a, b);
        case PairRule::multiply:
            return a * b;
        case PairRule::maximum:
            return std::max(a, b);
        case PairRule::geometric:
            break;
    }
    return a == b ? a : std::sqrt(a * b);
}

enum class IntegratorKind { explicit_euler, symplectic_euler, splitting, runge_kutta_4, exact };
/// tumble: the whole simulation. notes: the course notes to the letter, for teaching (sim/notes/notes_method.h).
enum class SimulationMethod { tumble, notes };
/// stepped: impacts are resolved at the step that finds them. exact: each impact at its own time, with exact motion in
/// between.
enum class ImpactMode { stepped, exact };
/// Impacts of several touching bodies. propagating: impulses pass from contact to contact, as in a real cradle;
/// simultaneous: Newton's law, v_rel+ >= -e v_rel- (notes eq. 14), for all contacts at once.
enum class ImpactLaw { propagating, simultaneous };
/// Solver of resting contact. by_island: the suitable one for each island; the others are for comparisons.
enum class ContactSolverChoice { by_island, soft, direct };
/// Storage of a rotation in the state (notes sections 1 and 3.1).
enum class RotationForm { quaternion, matrix };

struct SimulationSettings {
    double duration = 5.0;          // s
    int steps_per_frame = 16;       // the fixed step is h = 1 / (fps * steps_per_frame)
    Vec3 gravity{0.0, -9.81, 0.0};  // m/s^2
    SimulationMethod method = SimulationMethod::tumble;
    bool push_out = false;  // with the method of the notes: overlapping bodies are moved apart in each step
    IntegratorKind integrator = IntegratorKind::symplectic_euler;
    ImpactMode impacts = ImpactMode::stepped;
    ImpactLaw impact_law = ImpactLaw::propagating;
    ContactSolverChoice contact_solver = ContactSolverChoice::by_island;
    RotationForm rotation = RotationForm::quaternion;
    bool sleep = true;  // resting bodies leave the loop until another body touches them
    std::uint64_t seed = 1;
};

struct OutputSettings {
    int width = 1280, height = 720;  // pixels
    double fps = 60.0;               // frames per second
    int samples = 4;                 // samples per pixel
    std::optional<double> exposure;  // stops, a factor of two each on all light; empty: 0
    std::optional<ToneCurve> tone;   // empty: filmic
};

struct CameraKeyframe {
    double time = 0.0;  // s, increasing
    Vec3 eye = Vec3::Zero(), target = Vec3::Zero();
    double vertical_fov = 40.0;  // degrees
};

/// The motion that a camera without an eye or a target of its own shows: the simulated one, or a guess from the start.
enum class CameraFit { motion, start };

/// A lens that is wider than a point: sharp at the distance of its focus only.
struct DepthOfField {
    double aperture = 0.0;            // m, the diameter of the lens
    double focus = 0.0;               // m, from the eye along the view
    std::optional<std::size_t> body;  // index into bodies: instead, the distance of its center of mass
    int samples = 16;                 // points of the lens that a frame is the mean of
    bool operator==(const DepthOfField&) const = default;
};

struct CameraShot;
struct CameraInset;

/// The camera at the start. A moving one follows its keyframes, then orbits its target, then moves with a body
/// (render/camera/camera_animation.h).
struct CameraDescription {
    Vec3 eye = Vec3::Zero(), target = Vec3::Zero(), up{0.0, 1.0, 0.0};
    double vertical_fov = 40.0;             // degrees
    std::vector<CameraKeyframe> keyframes;  // empty: it stands still
    Interpolation interpolation = Interpolation::smooth;
    double orbit = 0.0;                 // degrees/s about the target, counter-clockwise seen from the tip of `up`
    std::optional<std::size_t> follow;  // index into bodies
    std::optional<double> follow_time;  // s, in which it comes up with the body; empty: it moves as the body does
    Vec3 follow_start = Vec3::Zero();   // pose of that body's origin at the start
    Quat follow_start_rotation = Quat::Identity();
    CameraFit fit = CameraFit::motion;
    bool own_eye = false, own_target = false;  // given, not chosen
    double fitted_time = 0.0;                  // s: the duration in the file
    std::optional<DepthOfField> dof;           // empty: a pinhole
    std::vector<CameraShot> shots;             // in which other cameras take its place, by their start
    std::vector<CameraInset> insets;           // pictures of other cameras over its own

    /// True if the simulated motion decides its place (presimulation/motion_camera.h). Until then it shows the start.
    bool fits_motion() const {
        return fit == CameraFit::motion && !(own_eye && own_target) && keyframes.empty() && !follow;
    }
    /// The same of this camera, or of one of its shots and insets.
    bool any_fits_motion() const;
    /// True if it comes up with a body in time. Its path follows from the motion (presimulation/follow_path.h); until
    /// it is known, the camera moves as the body does.
    bool lags() const { return follow && follow_time.value_or(0.0) > 0.0; }
    /// The same of this camera, or of one of its shots and insets.
    bool any_lags() const;
    /// True if the view changes during a clip.
    bool moves() const { return !keyframes.empty() || orbit != 0.0 || follow || !shots.empty(); }
    /// This camera and those of its shots. The pointers are valid as long as it is.
    std::vector<const CameraDescription*> all() const;
    /// Those of its insets too.
    std::vector<const CameraDescription*> with_insets() const;
};

/// A span of time, in s of the scene, in which a clip is seen by another camera, which has no shots.
struct CameraShot {
    double start = 0.0, end = 0.0;  // infinity: up to the end of the clip
    double move = 0.0;              // s, in which the view goes over from the one before; 0: a cut
    CameraDescription camera;
};

/// A panel over the picture that shows the scene by another camera, which has no shots and no insets.
struct CameraInset {
    FrameCorner corner = FrameCorner::top_right;
    double size = 0.3;     // share of the frame's width and height
    double margin = 0.03;  // to the edges of the frame, share of its height
    /// Left, top, width and height as shares of the frame, in place of the corner, the size and the margin.
    std::optional<std::array<double, 4>> rectangle;
    double border = 2.0;  // pixels of a picture 720 pixels high
    Color border_color{245, 246, 248};
    double start = 0.0, end = 0.0;  // s of the scene; infinity: up to the end of the clip
    CameraDescription camera;
};

struct LightDescription {
    Vec3 direction{-0.4, -1.0, -0.3};  // direction in which the light travels; any length
    bool shadows = true;
};

enum class LightType { sun, point, spot };

/// One of several lights.
struct LampDescription {
    static constexpr Color daylight{0xff, 0xf7, 0xe9};
    LightType type = LightType::sun;
    Vec3 direction{-0.4, -1.0, -0.3};  // unit; of a sun or spot
    Vec3 position = Vec3::Zero();      // m, of a point or spot
    Color color = daylight;
    double intensity = 1.0;  // 1: the light of [light]; of a point or spot at a distance of 1 m
    double angle = 45.0;     // degrees, of the whole cone of a spot
    bool shadows = false;    // of two at most: suns and spots
};

/// A uniform wind and the moving air: F = 1/2 density drag A |w - v| (w - v) at the center of mass, where A is the
/// body's mean projected area (a quarter of its hull's surface, Cauchy 1832). Without a wind table there is no air.
struct WindDescription {
    Vec3 velocity = Vec3::Zero();  // m/s
    double density = 1.2;          // kg/m^3
    double drag = 1.0;             // drag coefficient
};

/// A force at a point of a body over a time span [start, end) in s (notes eq. 6).
struct ForceDescription {
    std::size_t body = 0;       // index into bodies
    Vec3 point = Vec3::Zero();  // body frame, from the body's origin
    Vec3 force = Vec3::Zero();  // N
    bool body_frame = false;    // true: the force rotates with the body; false: a world vector
    double start = 0.0;
    double end = 0.0;  // infinity: forever
};

enum class BodyType { dynamic, fixed, kinematic };

/// Content of a mesh file, in the file's frame times the body's scale. Shared by the bodies that use it.
struct MeshAsset {
    std::string file;               // resolved path
    std::size_t doubled_faces = 0;  // dropped: listed twice, or once for each side
    TriangleMesh mesh;              // welded: for masses, hulls and contact
    struct Vertex {
        float position[3];
        float normal[3];  // unit; computed if the file has none
    };
    std::vector<Vertex> vertices;  // for drawing
    std::vector<std::uint32_t> indices;
    std::shared_ptr<const MeshPaint> paint = nullptr;  // colors of the file; null: it has none
    bool convex = false;  // a piece of a body: it collides as it is, without a search for its hull
};

struct PlaneShape {
    Vec3 normal{0.0, 1.0, 0.0};  // unit, body frame
    double offset = 0.0;         // m: points p with normal . p = offset; solid below
};
struct BoxShape {
    Vec3 size;  // full edge lengths, m
};
struct SphereShape {
    double radius;  // m
};
/// The matter that gives a mesh its mass and inertia: the volume that it encloses, its convex hull, or its surface.
enum class MassFrom : std::uint8_t { solid, hull, shell };
struct MeshShape {
    std::shared_ptr<const MeshAsset> asset;
    MassFrom mass_from = MassFrom::solid;
    double thickness = 0.0;  // m, of a shell
    bool chosen = true;      // false: mass_from follows from the mesh, which has no volume of its own
    bool painted = false;    // drawn with the colors of its file, which has some; otherwise in the color of the body

    const MeshPaint* paint() const { return painted ? asset->paint.get() : nullptr; }
};
enum class CurvedKind : std::uint8_t { capsule, cylinder, cone, ellipsoid };
/// A solid with a curved surface, about the y axis and centered at half its height. Its surface is exact in contacts,
/// masses and rays; frames draw it as triangles.
struct CurvedShape {
    CurvedKind kind = CurvedKind::cylinder;
    double radius = 0.0;                               // m; of a cone that of its base, at the lower end
    double top_radius = 0.0;                           // m, of a cone: 0 for a tip; of a cylinder the same as `radius`
    double height = 0.0;                               // m; of a capsule between the centers of its caps
    Vec3 radii = Vec3::Zero();                         // m, of an ellipsoid
    std::shared_ptr<const MeshAsset> drawn = nullptr;  // scene/mesh/curved_mesh.h
};
struct CompoundPart;
/// Several shapes that form one body, such as a table, a ring or an L. Shared by the bodies that use it.
struct CompoundShape {
    std::shared_ptr<const std::vector<CompoundPart>> parts;  // at least one
};
using Shape = std::variant<PlaneShape, BoxShape, SphereShape, MeshShape, CompoundShape, CurvedShape>;

/// True for a plane, which has no bounds and no mass.
inline bool endless(const Shape& shape) { return std::holds_alternative<PlaneShape>(shape); }

struct CompoundPart {
    Shape shape;                       // not a plane or a compound; a mesh collides as its convex hull
    Vec3 position = Vec3::Zero();      // of the part's origin, body frame, m
    Quat rotation = Quat::Identity();  // of the part, body frame
    std::optional<double> density;     // kg/m^3, overrides the body's
    std::optional<Color> color;        // overrides the body's
    bool collide = true;               // false: it has mass, and nothing touches it
    bool visible = true;
};

/// The one color that stands for a shape where only one can be shown.
inline Color plain_color(const Shape& shape, Color of_body) {
    const auto* mesh = std::get_if<MeshShape>(&shape);
    return mesh != nullptr && mesh->painted ? mesh->asset->paint->mean : of_body;
}

/// The material that a body sounds of (sound/sound_track.h).
enum class SoundMaterial { wood, metal, glass, stone, plastic, rubber, none };

/// panel: the look of the shape itself, which are grooves on a box and paler octants on a sphere. Other shapes have
/// none, so that for them it stands for plain too.
enum class Pattern { panel, grid, checker, plain, stripes, dots, noise, wood, marble };

/// Magnified texels: blended with their neighbors, or squares.
enum class TextureFilter { linear, nearest };

/// Appearance of a body.
struct Appearance {
    Color color{200, 200, 200};        // multiplies the texture
    double roughness = 0.6;            // 0 mirror .. 1 chalk
    double metallic = 0.0;             // 0 or 1, or between
    Pattern pattern = Pattern::panel;  // planes default to grid
    bool visible = true;
    std::optional<Color> pattern_color;      // second color; none: a darker one, see scene/description/looks.h
    double pattern_scale = 0.0;              // m, of a cell; 0: by the size of the shape
    std::shared_ptr<const Texture> texture;  // null: none. A mesh has its own in its paint
    double texture_scale = 0.0;              // m that the image covers; 0: a face, or the way around
    TextureFilter texture_filter = TextureFilter::linear;
    std::shared_ptr<const Texture> normal_map, roughness_map;  // SurfaceMaps: normal, and surface
    double opacity = 1.0;                                      // below 1 the background shows through; not of planes
    Color emission{0, 0, 0};                                   // own light, in addition to that of lights
    double reflection = 0.0;                                   // of a plane: share of mirrored bodies in what it shows

    bool has_image() const { return texture || normal_map || roughness_map; }
};

/// A pose of a kinematic body's origin at a time.
struct Keyframe {
    double time = 0.0;  // s, increasing
    Vec3 position = Vec3::Zero();
    Quat rotation = Quat::Identity();
};

struct BodyDescription {
    std::string name;  // given, or the index in the expanded list
    BodyType type = BodyType::dynamic;
    Shape shape;
    Appearance appearance;
    double density = 1000.0;  // kg/m^3, of the volume; with a given mass, only its ratio to densities of parts counts
    std::optional<double> mass;               // kg
    std::optional<double> restitution;        // 0..1
    std::optional<double> friction;           // >= 0
    std::optional<double> rolling_friction;   // resisting torque over (load times radius of the rounded surface)
    std::optional<double> spinning_friction;  // m, torque about the normal over the load
    double gravity_scale = 1.0;               // the body's weight over m g
    std::optional<Vec3> center_of_mass;       // m, body frame, from the body's origin; empty: that of the shape
    /// kg m^2, about the center of mass, body frame: xx, yy, zz, xy, xz, yz. Empty: that of the shape.
    std::optional<std::array<double, 6>> inertia;
    std::vector<std::string> layers;  // that the body belongs to
    /// Layers of the bodies that it collides with; empty optional: all bodies. Both bodies of a pair must accept.
    std::optional<std::vector<std::string>> collide_with;
    Vec3 position = Vec3::Zero();  // of the body's origin
    Quat rotation = Quat::Identity();
    Vec3 velocity = Vec3::Zero();              // m/s, of the center of mass
    Vec3 angular_velocity = Vec3::Zero();      // rad/s
    std::optional<IntegratorKind> integrator;  // overrides the simulation's, to compare two in one scene
    std::vector<Keyframe> keyframes;           // kinematic bodies only; empty: it stands still
    Interpolation interpolation = Interpolation::smooth;
    SoundMaterial sound = SoundMaterial::wood;
    std::optional<double> water_drag;  // drag coefficient in water; empty: that of the water
    std::shared_ptr<const FractureDescription> fracture = nullptr;  // null: it never breaks
    std::optional<std::size_t> piece_of = std::nullopt;             // index into bodies: the one that it is a cell of

    /// Restitution and friction of the body in a pair (PairRule): a dynamic body without values has these.
    static constexpr double default_restitution = 0.5, default_friction = 0.0;
    double restitution_in_pair() const {
        return restitution.value_or(dynamic() ? default_restitution : value_of_other);
    }
    double friction_in_pair() const { return friction.value_or(dynamic() ? default_friction : value_of_other); }
    /// Without effect by default.
    double rolling_friction_in_pair() const { return rolling_friction.value_or(dynamic() ? 0.0 : value_of_other); }
    double spinning_friction_in_pair() const { return spinning_friction.value_or(dynamic() ? 0.0 : value_of_other); }
    bool dynamic() const { return type == BodyType::dynamic; }
};

/// A thin cord without effect on the simulation: from a fixed point to a point of a body, or between the anchors of a
/// joint, whose places it has then.
struct CordDescription {
    std::size_t body = 0;
    Vec3 point = Vec3::Zero();   // body frame, from the body's origin
    Vec3 anchor = Vec3::Zero();  // world frame; with an anchor_body in its frame, from its origin
    double radius = 0.01;        // m
    Color color{60, 60, 60};
    std::optional<std::size_t> joint = std::nullopt;        // index into joints
    std::optional<std::size_t> anchor_body = std::nullopt;  // index into bodies: the anchor moves with it
};

/// When a simulation makes frames: frame n shows n / fps.
struct FrameTiming {
    double fps = 60.0;  // frames in a second of the scene's motion
    int steps_per_frame = 1;

    double step() const { return 1.0 / (fps * steps_per_frame); }  // s
    /// Frames up to `duration` (s), which is forgiven its rounding: 4.35 s at 100 fps have 436.
    std::int64_t frame_count(double duration) const;
};

enum class SpeedEasing { smooth, linear, step };

/// The speed of a clip, as seconds of the scene's motion in a second of the clip: the factor at the keyframe's time,
/// and up to the next one by the easing. Before the first one it is 1.
struct SpeedKeyframe {
    double time = 0.0;                                 // s; after the impact, if there is one
    std::optional<std::array<std::size_t, 2>> impact;  // bodies: their first impact is at time 0
    double factor = 1.0;
    double hold = 0.0;  // s of the clip in which the motion stands still
    SpeedEasing easing = SpeedEasing::smooth;
};

struct SceneDescription {
    std::string file;  // path of the scene file, for messages
    std::string title;
    SimulationSettings simulation;
    OutputSettings output;
    CameraDescription camera;            // the file's, or the default camera
    LightDescription light;              // with several lights, the sun that has shadows, or else the first one
    std::vector<LampDescription> lamps;  // [[light]]; empty: the light alone
    std::optional<EnvironmentDescription> environment;
    std::optional<WindDescription> wind;
    PairRules contact;
    std::vector<ForceDescription> forces;
    std::vector<FieldDescription> fields;
    std::vector<PairForceDescription> pair_forces;
    std::vector<ExplosionDescription> explosions;
    std::vector<BodyDescription> bodies;  // with grids and scatters expanded
    std::vector<JointDescription> joints;
    std::vector<CordDescription> cords;
    OverlayDescription overlay;
    std::vector<SpeedKeyframe> speed;  // of clips; empty: the scene's own
    std::optional<WaterDescription> water;

    FrameTiming timing() const { return {output.fps, simulation.steps_per_frame}; }
    double step() const { return timing().step(); }  // s
    std::int64_t frame_count() const { return timing().frame_count(simulation.duration); }
};

}  // namespace tumble
