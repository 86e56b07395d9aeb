// A scene that is built in code: the tables of a scene file as plain structs. Fields have the names, defaults, units
// and ranges of docs/reference/scene-format.md; a Scene made from a SceneSpec passes the same checks as a file. SI
// units, world frame unless a comment says otherwise, y is up.
#pragma once

#include "joint_spec.h"
#include "vector.h"

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

TUMBLE_BEGIN

// Names of the scene file: '-' becomes '_'.
enum class Integrator { explicit_euler, symplectic_euler, splitting, rk4, exact };
enum class Method { tumble, notes };  // notes: the course notes to the letter, for teaching
enum class ImpactMode { stepped, exact };
enum class ImpactLaw { propagating, simultaneous };
enum class ContactSolver { by_island, soft, direct };
enum class RotationForm { quaternion, matrix };
enum class BodyType { dynamic, fixed, kinematic };
/// panel: the grooves of a box and the octants of a sphere.
enum class Pattern { panel, grid, checker, plain, stripes, dots, noise, wood, marble };
enum class TextureFilter { linear, nearest };  // magnified texels: blended, or squares
/// The material that a body sounds of; none: silent.
enum class SoundMaterial { wood, metal, glass, stone, plastic, rubber, none };
/// The matter that gives a mesh its mass and inertia: the volume that it encloses, its convex hull, or its surface.
enum class MassFrom { solid, hull, shell };

struct SimulationSettings {
    double duration = 5.0;          // s
    int steps_per_frame = 16;       // the fixed step is 1 / (fps * steps_per_frame) s
    std::optional<double> step;     // s, in place of steps_per_frame; divides 1 / fps to within 1e-9 s
    Vec3 gravity{0.0, -9.81, 0.0};  // m/s^2
    Method method = Method::tumble;
    bool push_out = false;  // with Method::notes only: overlapping bodies are moved apart in each step
    Integrator integrator = Integrator::symplectic_euler;
    ImpactMode impacts = ImpactMode::stepped;
    ImpactLaw impact_law = ImpactLaw::propagating;
    ContactSolver contact_solver = ContactSolver::by_island;
    RotationForm rotation = RotationForm::quaternion;
    bool sleep = true;       // islands at rest are not simulated until something touches them
    std::uint64_t seed = 1;  // below 2^63
};

/// From linear light to the screen.
enum class ToneCurve { filmic, linear };

struct OutputSettings {
    int width = 1280, height = 720;       // pixels
    double fps = 60.0;                    // frames per second; 24000.0 / 1001.0 is exact in clips
    int samples = 4;                      // per pixel: 1, 2 or 4
    std::optional<double> exposure = {};  // stops, a factor of two each on all light; 0 where not given
    std::optional<ToneCurve> tone = {};   // filmic where not given
};

enum class CameraFit { motion, start };

struct CameraKeyframe {
    double time = 0.0;                   // s, later than the keyframe before
    std::optional<Vec3> eye, target;     // m; the camera's where not given
    std::optional<double> vertical_fov;  // degrees; the camera's where not given
};

struct Camera {
    std::optional<Vec3> eye, target;  // m; chosen to show the motion where not given
    Vec3 up{0.0, 1.0, 0.0};
    double vertical_fov = 40.0;  // degrees
    std::vector<CameraKeyframe> keyframes;
    Interpolation interpolation = Interpolation::smooth;  // between keyframes
    double orbit = 0.0;                                   // degrees/s about the target
    std::string follow;                                   // the name of a body; empty: none
    CameraFit fit = CameraFit::motion;                    // which motion a camera without eye or target shows
    std::optional<double> follow_time = {};               // s, in which it comes up with that body
};

/// A span of time in which a clip is seen by one of SceneSpec::cameras.
struct Shot {
    std::string camera;                                    // its name
    double start = 0.0;                                    // s
    double end = std::numeric_limits<double>::infinity();  // s; infinity: the next shot, or the end of the clip
    double move = 0.0;                                     // s, in which the view goes over from the one before
};

enum class SpeedEasing { smooth, linear, step };

/// The speed of a clip, as seconds of the scene's motion in a second of the clip.
struct Speed {
    double time = 0.0;                         // s; later than that of the one before. With an impact: after it
    std::array<std::string, 2> impact = {};    // the names of two bodies; empty: at that time of the scene
    double factor = 1.0;                       // 0.25 is slow motion
    double hold = 0.0;                         // s of the clip in which the motion stands still
    SpeedEasing easing = SpeedEasing::smooth;  // up to the next one
};

struct Light {
    Vec3 direction{-0.4, -1.0, -0.3};  // in which the light travels; its length is ignored
    bool shadows = true;
};

enum class LightType { sun, point, spot };

/// One of several lights.
struct Lamp {
    LightType type = LightType::sun;
    std::optional<Vec3> direction = {};  // in which the light of a sun or spot travels
    std::optional<Vec3> position = {};   // m, of a point or spot
    Color color{0xff, 0xf7, 0xe9};
    double intensity = 1.0;            // 1: that of Light; of a point or spot at a distance of 1 m
    std::optional<double> angle = {};  // degrees, of the whole cone of a spot
    std::optional<bool> shadows = {};  // of at most two suns and spots; the first sun by default
};

/// Light from all sides, and the background.
struct Environment {
    std::string preset;      // "studio", "overcast" or "dusk"; empty: none
    std::string image;       // .hdr, .exr, PNG or JPEG file, relative to SceneSpec::folder
    std::string background;  // "sky", "image" or a color, "#rrggbb"; empty: of the preset or the image
    std::optional<std::array<Color, 2>> gradient;  // in its place: of the horizon and straight up
    std::optional<double> rotation;                // degrees about y
    std::optional<double> intensity;               // factor on the light of the image
    std::optional<double> blur;                    // of the image as background, 0 to 1
    bool ground_shadow = false;                    // planes show shadows only
};

struct Wind {
    Vec3 velocity;         // m/s
    double density = 1.2;  // kg/m^3
    double drag = 1.0;     // drag coefficient
};

enum class PairRule { average, minimum, multiply, maximum, geometric };

/// The rules by which the restitution and the friction of two bodies make those of the pair. A fixed or kinematic body
/// without a value takes that of the other body.
struct PairRules {
    PairRule restitution_rule = PairRule::maximum;
    PairRule friction_rule = PairRule::geometric;  // the square root of the product
};

/// A half-space: the points p with normal . p <= offset. Not for dynamic bodies.
struct Plane {
    Vec3 normal{0.0, 1.0, 0.0};  // body frame; its length is ignored
    double offset = 0.0;         // m
};

struct Box {
    Vec3 size{1.0, 1.0, 1.0};  // m, full edge lengths
};

struct Sphere {
    double radius = 0.5;  // m
};

/// A cylinder with half balls at its ends, about the y axis.
struct Capsule {
    double radius = 0.5;  // m
    double height = 1.0;  // m, between the centers of the half balls
};

/// About the y axis.
struct Cylinder {
    double radius = 0.5;  // m
    double height = 1.0;  // m
};

/// About the y axis, with its origin at half its height.
struct Cone {
    double radius = 0.5;      // m, of the base at the lower end
    double height = 1.0;      // m
    double top_radius = 0.0;  // m; 0: a tip
};

struct Ellipsoid {
    Vec3 radii{0.5, 0.5, 0.5};  // m
};

/// The triangle mesh of a file.
struct Mesh {
    std::string file;  // relative to SceneSpec::folder
    double scale = 1.0;
    bool objects_are_parts = false;  // each object of the file is a part with a convex hull of its own
    std::optional<MassFrom> mass_from =
        {};  // by default solid if it encloses a volume, a shell if it is flat, and its hull
    std::optional<double> thickness = {};  // m, of a shell
    std::string unit = {};                 // of a file that states none: "m", "cm", "mm", "um", "km", "in", "ft", "yd"
    std::string up = {};                   // axis of such a file that points upward: "y", "z", "x"
};

/// Indices of three vertices from 0, counterclockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// A triangle mesh from memory, with the repairs and the normals of a mesh file. The arrays are copied once, and copies
/// of the struct share them: bodies with one mesh take the memory of one.
struct TriangleMesh {
    struct Arrays {
        std::vector<Vec3> vertices;  // m at scale 1, body frame
        std::vector<Triangle> triangles;
    };

    TriangleMesh() = default;  // no mesh: an error of the scene
    TriangleMesh(Span<const Vec3> vertices, Span<const Triangle> triangles, double scaled_by = 1.0)
        : arrays(std::make_shared<const Arrays>(
              Arrays{{vertices.begin(), vertices.end()}, {triangles.begin(), triangles.end()}})),
          scale(scaled_by) {}

    std::shared_ptr<const Arrays> arrays;
    double scale = 1.0;
    std::optional<MassFrom> mass_from = {};  // as in Mesh
    std::optional<double> thickness = {};    // m, of a shell
};

/// The convex hull of points, which do not lie in one plane.
struct Hull {
    std::vector<Vec3> points;  // m, body frame
};

/// Ground over a rectangle, solid below, from a gray PNG file or a CSV file of heights. Only for fixed bodies.
struct HeightField {
    std::string file;              // relative to SceneSpec::folder
    double size_x = 1.0;           // m
    double size_z = 1.0;           // m
    double height = 1.0;           // m, of white in a PNG file; of the number 1 in a CSV file
    std::optional<double> base{};  // m, thickness below the lowest height
};

struct CompoundPart;

/// Several shapes that form one body.
struct Compound {
    std::vector<CompoundPart> parts;
};

using Shape = std::variant<Plane, Box, Sphere, Mesh, Compound, TriangleMesh, Hull, HeightField, Capsule, Cylinder, Cone,
                           Ellipsoid>;

struct CompoundPart {
    Shape shape;                    // not a plane
    Vec3 position;                  // m, of the part's origin, body frame
    Rotation rotation;              // body frame
    std::optional<double> density;  // kg/m^3; the body's where not given
    std::optional<Color> color;     // the body's where not given
    bool collide = true;            // false: nothing touches the part, which has its mass all the same
    bool visible = true;
};

/// Physical and visual properties. A field that is not given has the default of the scene format.
struct Material {
    std::optional<Color> color;
    std::optional<double> density;      // kg/m^3
    std::optional<double> restitution;  // 0 to 1; see PairRules
    std::optional<double> friction;     // Coulomb's coefficient; see PairRules
    std::optional<double> roughness;    // 0: mirror, 1: matte
    std::optional<double> metallic;     // 0 to 1
    std::optional<Pattern> pattern;
    std::optional<double> rolling_friction{};   // torque against rolling, over the load times the radius; see PairRules
    std::optional<double> spinning_friction{};  // m: torque about the normal, over the load; see PairRules
    std::optional<Color> pattern_color = {};    // the color, darker, where not given
    std::optional<double> pattern_scale = {};   // m, of a cell of the pattern
    std::optional<std::string> texture = {};    // PNG or JPEG file, relative to SceneSpec::folder
    std::optional<double> texture_scale = {};   // m that the image covers once
    std::optional<TextureFilter> texture_filter = {};
    std::optional<std::string> normal_map = {};       // image file: bumps
    std::optional<std::string> roughness_map = {};    // image file, multiplies the roughness
    std::optional<double> opacity = {};               // 0 to 1
    std::optional<Color> emission = {};               // own light
    std::optional<double> reflection = {};            // of a plane: share of what it mirrors, 0 to 1
    std::optional<SoundMaterial> sound = {};          // of the body with --sound; wood where not given
    std::optional<double> strength = {};              // Pa, in tension, of a body that breaks
    std::optional<double> shear_strength = {};        // Pa
    std::optional<double> compressive_strength = {};  // Pa; 0: pressure breaks nothing
    std::optional<double> stiffness = {};             // Pa, Young's modulus
    std::optional<double> toughness = {};             // J/m^2 of new crack
    std::optional<double> blow_time = {};             // s; 0: by the size and the speed of sound
    std::optional<Color> inner_color = {};            // of new faces
};

/// A pose of a kinematic body's origin.
struct Keyframe {
    double time = 0.0;  // s, later than the keyframe before
    Vec3 position;      // m
    Rotation rotation;
};

/// Copies of a body in a regular grid, centered on its position in x and z and upward from it along y. The index of a
/// copy runs along x first, then z, then y.
struct Grid {
    std::array<int, 3> count{1, 1, 1};  // along x, y, z
    Vec3 spacing{1.0, 1.0, 1.0};        // m, between the origins of neighbors
    Vec3 jitter;                        // m, largest random displacement of a copy, in both directions
    double tilt = 0.0;                  // degrees, largest random rotation of a copy, about a random axis
};

/// Copies of a body at random places in a box around its position; their bounding spheres do not touch.
struct Scatter {
    int count = 1;
    Vec3 size{1.0, 1.0, 1.0};     // m, of the box that contains the copies' origins
    bool random_rotation = true;  // false: the body's rotation
    double clearance = 0.0;       // m, between the bounding spheres
};

/// Random factors of the copies' sizes, both from 0.001 to 1000.
struct ScaleRange {
    double smallest = 1.0, largest = 1.0;
};

enum class FracturePattern { voronoi, radial, slabs, bricks };

/// How a body is cut into cells, whose bonds can break.
struct Fracture {
    int cells = 20;
    FracturePattern pattern = FracturePattern::voronoi;
    std::uint64_t seed = 1;
    std::optional<Vec3> focus = {};       // m, body frame: radial and voronoi
    bool focus_at_impact = false;         // in place of a focus: where the first blow breaks the body
    std::optional<Vec3> axis = {};        // slabs
    std::optional<int> depth = {};        // times that a piece may break again; not given: down to single cells
    std::optional<double> smallest = {};  // m: cells of less than its cube are merged
    std::vector<std::string> held = {};   // sides of the bounds ("-y") that hold a fixed body; empty: "-y"
};

/// One body; or many, with a grid or a scatter. Dynamic and fixed bodies of finite size may have copies.
struct Body {
    std::string name;  // unique; the index as text where empty; of copies NAME.0, NAME.1 ...
    BodyType type = BodyType::dynamic;
    Shape shape;
    Material material;
    std::optional<double> mass;  // kg, in place of the density; dynamic bodies
    bool visible = true;
    Vec3 position;  // m, of the body's origin
    Rotation rotation;
    Vec3 velocity;                                        // m/s, of the center of mass, at time 0; dynamic bodies
    Vec3 angular_velocity;                                // rad/s, world frame, at time 0; dynamic bodies
    std::optional<Integrator> integrator;                 // in place of the simulation's
    std::vector<Keyframe> keyframes;                      // kinematic bodies
    Interpolation interpolation = Interpolation::smooth;  // between keyframes
    std::optional<Grid> grid;                             // not together with a scatter
    std::optional<Scatter> scatter;
    std::optional<ScaleRange> scale;                       // of the copies
    std::vector<Color> colors;                             // each copy takes one at random; empty: the material's
    double gravity_scale = 1.0;                            // the weight is that times m g
    std::optional<Vec3> center_of_mass;                    // m, body frame, in place of the shape's; dynamic bodies
    std::optional<std::array<double, 6>> inertia;          // kg m^2, about the center of mass: xx, yy, zz, xy, xz, yz
    std::vector<std::string> layers;                       // that the body belongs to
    std::optional<std::vector<std::string>> collide_with;  // layers; not given: all bodies
    std::optional<double> water_drag;                      // drag coefficient, in place of the water's
    std::optional<Fracture> fracture = {};
};

/// A force at a point of a dynamic body over a time span.
struct Force {
    std::string body;         // its name, or its index as text
    Vec3 point;               // m, body frame, from the body's origin
    Vec3 force;               // N
    bool body_frame = false;  // the force turns with the body; otherwise it is in the world frame
    double start = 0.0;       // s
    double end = std::numeric_limits<double>::infinity();  // s
};

enum class FieldType { uniform, point, vortex, drag };

/// Where a field acts: on bodies whose center of mass is inside. A box or a ball.
struct FieldRegion {
    std::optional<Vec3> box;       // m, edge lengths
    std::optional<double> sphere;  // m, radius
    Vec3 center;                   // m
};

/// A force that depends on the place of a body. Which values it has depends on its type.
struct Field {
    FieldType type = FieldType::uniform;
    std::optional<Vec3> acceleration = {};                 // m/s^2: uniform
    std::optional<Vec3> center = {};                       // m: point, vortex
    std::optional<Vec3> axis = {};                         // vortex
    std::optional<double> strength = {};                   // m^3/s^2; m^2/s^2 of a vortex
    std::optional<double> softening = {};                  // m: point, vortex
    std::optional<Vec3> velocity = {};                     // m/s, of the medium: drag
    std::optional<double> linear = {};                     // N s/m: drag
    std::optional<double> quadratic = {};                  // N s^2/m^2: drag
    std::optional<FieldRegion> region = {};                // everywhere where not given
    double start = 0.0;                                    // s
    double end = std::numeric_limits<double>::infinity();  // s
};

enum class PairForceType { gravity, coulomb, spring, inverse_square, dipole };

/// A force between each two of the bodies.
struct PairForce {
    PairForceType type = PairForceType::gravity;
    std::vector<std::string> bodies;                       // two or more
    std::optional<double> strength = {};                   // not of springs; that of nature where not given
    std::optional<double> softening = {};                  // m; not of springs
    std::vector<double> charges = {};                      // C, one of each body: coulomb
    std::optional<double> stiffness = {};                  // N/m: spring
    std::optional<double> damping = {};                    // N s/m: spring
    std::optional<double> length = {};                     // m: spring
    std::vector<Vec3> moments = {};                        // A m^2, body frame, one of each body: dipole
    double start = 0.0;                                    // s
    double end = std::numeric_limits<double>::infinity();  // s
};

/// An impulse on all dynamic bodies that a point sees.
struct Explosion {
    Vec3 center;                        // m
    std::optional<double> time = {};    // s
    double impulse = 0.0;               // N s, sum of the lengths over all directions
    std::optional<double> radius = {};  // m; bodies farther away feel nothing
};

/// A wave on deep water.
struct WaterWave {
    double height = 0.0, length = 1.0;  // m, trough to crest, crest to crest
    Vec3 direction{1.0, 0.0, 0.0};      // in which it travels, horizontal
    double phase = 0.0;                 // degrees; 0: a crest at the origin of the world at time 0
};

/// Water below a level, in which bodies float.
struct Water {
    double level = 0.0;       // m, y
    double density = 1000.0;  // kg/m^3
    double drag = 1.0;        // drag coefficient
    double viscosity = 0.0;   // Pa s
    bool added_mass = true;   // a body that speeds up sets water in motion with it
    Vec3 current;             // m/s, horizontal
    Color color{0x2a, 0x6f, 0x8f};
    bool visible_in_aov = true;
    std::vector<WaterWave> waves = {};  // 16 at most
};

/// A cosmetic rope from a fixed point to a point of a body, or between the anchors of a joint.
struct Cord {
    std::string body;      // its name, or its index as text
    Vec3 point;            // m, body frame, from the body's origin
    Vec3 anchor;           // m
    double radius = 0.01;  // m
    Color color{0x3c, 0x3c, 0x3c};
    std::string joint = {};  // its name, in place of body, point and anchor
};

struct SceneSpec {
    std::string title;
    SimulationSettings simulation;
    OutputSettings output;
    Camera camera;
    Light light;
    std::optional<Wind> wind;  // not given: no air
    PairRules contact;
    std::vector<Body> bodies;
    std::vector<Joint> joints;
    std::vector<Force> forces;
    std::vector<Cord> cords;
    std::vector<Lamp> lights = {};  // in place of `light`, if there are any
    std::optional<Environment> environment = {};
    std::vector<Field> fields = {};
    std::vector<PairForce> pair_forces = {};
    std::vector<Explosion> explosions = {};
    std::optional<Water> water = {};
    std::vector<Speed> speed = {};               // of clips
    std::map<std::string, Camera> cameras = {};  // by name, for shots
    std::vector<Shot> shots = {};
    std::string folder;                 // where relative mesh files start; empty: the current folder
    bool allow_import_process = false;  // for mesh files other than OBJ, STL, PLY and glTF: see load_scene()

    /// Appends a body. The reference is valid until the next call.
    Body& add(Shape shape, BodyType type = BodyType::dynamic) {
        bodies.emplace_back();
        bodies.back().shape = static_cast<Shape&&>(shape);
        bodies.back().type = type;
        return bodies.back();
    }

    /// Appends a joint of two bodies. The reference is valid until the next call.
    Joint& add_joint(JointType type, const std::string& first, const std::string& second) {
        joints.emplace_back();
        joints.back().type = type;
        joints.back().bodies = {first, second};
        return joints.back();
    }
};

/// The text of a scene file that describes the same scene; relative mesh files start from the folder of that file.
/// Throws Error (input) with the element of a TriangleMesh, which has no file, and for an enum without a name.
std::string to_toml(const SceneSpec& spec);

TUMBLE_END
