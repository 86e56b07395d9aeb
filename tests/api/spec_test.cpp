// A scene that is built in code is the scene of the file with the same values.
#include "scenes.h"
#include "support/folder.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <sstream>
#include <vector>

namespace tumble {
namespace {

/// Every table and every shape of the format.
SceneSpec everything() {
    SceneSpec spec = crate_and_ball();
    spec.title = "All \"tables\"\n";
    spec.folder = TUMBLE_SOURCE_DIR "/assets/meshes";
    spec.simulation.step = 1.0 / 80.0;
    spec.simulation.gravity = {0.1, -9.7, -1e-300};
    spec.simulation.integrator = Integrator::splitting;
    spec.simulation.impact_law = ImpactLaw::simultaneous;
    spec.simulation.sleep = false;
    spec.camera.eye = Vec3{2.0, 3.0, 12.0};
    spec.camera.keyframes = {{0.0, {}, {}, {}}, {1.0, Vec3{3.0, 3.0, 9.0}, Vec3{0.0, 1.0, 0.0}, 30.0}};
    spec.camera.interpolation = Interpolation::linear;
    spec.camera.orbit = 12.0;
    spec.camera.follow = "crate";
    spec.light = {{0.1, -1.0, 0.2}, false};
    spec.wind = Wind{{3.0, 0.0, 1.0}, 1.3, 0.9};
    spec.contact = {PairRule::average, PairRule::multiply};
    spec.bodies[0].material.friction = 0.4;
    spec.bodies[0].material.pattern = Pattern::checker;
    spec.bodies[1].material = {Color{1, 2, 254}, 600.0, 0.3, 0.2, 0.1, 1.0, Pattern::grid};
    spec.bodies[1].material.pattern_color = Color{3, 4, 5};
    spec.bodies[1].material.pattern_scale = 0.25;
    spec.bodies[1].mass = 12.5;
    spec.bodies[1].rotation = AxisAngle{{1.0, 2.0, 3.0}, 40.0};
    spec.bodies[2].rotation = Quat{0.8, 0.6, 0.0, 0.0};
    spec.bodies[2].velocity = {-1.0 / 3.0, 0.0, 0.0};
    spec.bodies[2].integrator = Integrator::rk4;
    spec.bodies[2].visible = false;
    spec.bodies[1].material.rolling_friction = 0.02;
    spec.bodies[1].material.spinning_friction = 0.003;
    spec.bodies[1].layers = {"crates", "all \"wood\""};
    spec.bodies[2].gravity_scale = 0.7;
    spec.bodies[2].center_of_mass = Vec3{0.01, 0.0, -0.02};
    spec.bodies[2].inertia = {0.5, 0.6, 0.7, 0.01, 0.0, 0.02};
    spec.bodies[2].collide_with = {"crates"};
    spec.add(Hull{{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 0.7}}}).position = {0.0, 9.0, 5.0};
    spec.add(Mesh{"torus.obj", 0.5, false}).position = {-3.0, 4.0, 0.0};
    spec.add(Mesh{"hoop.obj", 1.0, true}).position = {-3.0, 7.0, 0.0};
    CompoundPart leg{Box{{0.2, 1.0, 0.2}}, {0.0, -0.5, 0.0}, {}, 700.0, Color{9, 9, 9}};
    CompoundPart knob{Compound{{leg}}, {0.5, 0.0, 0.0}, AxisAngle{{0.0, 0.0, 1.0}, 90.0}, {}, {}};
    spec.add(Compound{{{Sphere{0.3}, {}, {}, {}, {}}, leg, knob}}).position = {4.0, 4.0, 1.0};
    Body& paddle = spec.add(Box{{2.0, 0.2, 1.0}}, BodyType::kinematic);
    paddle.keyframes = {{0.0, {0.0, 1.0, 0.0}, {}}, {1.0, {0.0, 2.0, 0.0}, AxisAngle{{0.0, 0.0, 1.0}, 30.0}}};
    paddle.interpolation = Interpolation::linear;
    Body& blocks = spec.add(Box{{0.3, 0.3, 0.3}});
    blocks.name = "block";
    blocks.position = {8.0, 1.0, 0.0};
    blocks.grid = Grid{{2, 3, 1}, {0.5, 0.6, 0.7}, {0.01, 0.0, 0.02}, 5.0};
    blocks.colors = {Color{200, 0, 0}, Color{0, 200, 0}};
    Body& stones = spec.add(Mesh{"torus.obj", 0.5, false});
    stones.position = {-8.0, 5.0, 0.0};
    stones.scatter = Scatter{5, {3.0, 4.0, 3.0}, false, 0.1};
    stones.scale = ScaleRange{0.3, 0.9};
    spec.forces.push_back({"crate", {0.0, 0.5, 0.0}, {10.0, 0.0, 0.0}, true, 0.2, 0.7});
    spec.forces.push_back({"2", {}, {0.0, 1.0, 0.0}});
    spec.cords.push_back({"crate", {}, {0.0, 6.0, 0.0}, 0.02, {7, 8, 9}});
    return spec;
}

TEST(Spec, MovesLikeTheFileWithTheSameValues) {
    const SceneSpec spec = everything();
    const TestFolder folder;
    const std::string file = folder / "scene.toml";
    std::filesystem::create_symlink(spec.folder + "/torus.obj", folder / "torus.obj");
    std::filesystem::create_symlink(spec.folder + "/hoop.obj", folder / "hoop.obj");
    write_text(file, to_toml(spec));
    const Scene built(spec), loaded = load_scene(file);
    EXPECT_EQ(built.title(), spec.title);
    EXPECT_EQ(loaded.title(), spec.title);
    ASSERT_EQ(built.body_count(), spec.bodies.size() - 2 + 6 + 5);
    EXPECT_EQ(built.body_name(built.find_body("block.5").value()), "block.5");
    EXPECT_TRUE(same(after(built, 12), after(loaded, 12)));
    EXPECT_EQ(Renderer(built).render(after(built, 2)), Renderer(loaded).render(after(loaded, 2)));
    EXPECT_EQ(built.files().size(), 2u);
    EXPECT_EQ(loaded.files().size(), 3u);
}

/// Lights, place, direction, and forces at a distance.
SceneSpec everything_directed() {
    SceneSpec spec = crate_and_ball();
    spec.bodies[2].name = "ball";
    spec.output.exposure = 0.5;
    spec.output.tone = ToneCurve::linear;
    spec.camera.follow = "crate";
    spec.camera.follow_time = 0.25;
    spec.lights.emplace_back();
    spec.lights[0].direction = Vec3{0.2, -1.0, 0.1};
    spec.lights.emplace_back();
    spec.lights[1].type = LightType::spot;
    spec.lights[1].position = Vec3{1.0, 4.0, 1.0};
    spec.lights[1].angle = 50.0;
    spec.environment = Environment{};
    spec.environment->preset = "dusk";
    spec.environment->gradient = {Color{10, 20, 30}, Color{40, 50, 60}};
    spec.environment->blur = 0.3;
    spec.fields.emplace_back();
    spec.fields[0].acceleration = Vec3{1.0, 0.0, 0.0};
    spec.fields[0].region = FieldRegion{Vec3{9.0, 9.0, 9.0}, {}, {0.0, 2.0, 0.0}};
    spec.fields[0].start = 0.1;
    spec.fields.emplace_back();
    spec.fields[1].type = FieldType::drag;
    spec.fields[1].linear = 0.5;
    spec.pair_forces.emplace_back();
    spec.pair_forces[0].type = PairForceType::coulomb;
    spec.pair_forces[0].bodies = {"crate", "ball"};
    spec.pair_forces[0].charges = {1e-3, -2e-3};
    spec.pair_forces[0].end = 1.0;
    spec.pair_forces.emplace_back();
    spec.pair_forces[1].type = PairForceType::dipole;
    spec.pair_forces[1].bodies = {"crate", "ball"};
    spec.pair_forces[1].moments = {{1e3, 0.0, 0.0}, {0.0, 2e3, 0.0}};
    spec.explosions.push_back({{0.0, 0.1, 0.0}, 0.2, 3.0, 4.0});
    spec.water =
        Water{-0.5, 1025.0, 0.9, 0.001, false, {0.1, 0.0, 0.2}, {1, 2, 3}, false, {{0.1, 2.0, {0.0, 0.0, 1.0}, 30.0}}};
    spec.bodies[2].water_drag = 0.4;
    spec.bodies[1].fracture = Fracture{};
    spec.bodies[1].fracture->cells = 4;
    spec.bodies[1].fracture->pattern = FracturePattern::slabs;
    spec.bodies[1].fracture->axis = Vec3{0.0, 1.0, 0.0};
    spec.bodies[1].material.strength = 1e9;
    spec.bodies[1].material.inner_color = Color{9, 8, 7};
    spec.speed.push_back({0.1, {"crate", "0"}, 0.5, 0.2, SpeedEasing::linear});
    spec.cameras["from above"].eye = Vec3{0.0, 9.0, 0.1};
    spec.cameras["from above"].keyframes = {{0.0, {}, {}, 30.0}, {1.0, {}, {}, 40.0}};
    spec.shots.push_back({"from above", 0.5, 1.5, 0.25});
    return spec;
}

TEST(Spec, FocusOfAFractureIsAPointOrTheImpact) {
    SceneSpec spec = everything_directed();
    Fracture& fracture = *spec.bodies[1].fracture;
    fracture.pattern = FracturePattern::radial;
    fracture.axis.reset();
    fracture.focus = Vec3{0.1, 0.0, 0.0};
    EXPECT_NE(to_toml(spec).find("focus = [0.1"), std::string::npos) << to_toml(spec);
    fracture.focus.reset();
    fracture.focus_at_impact = true;
    EXPECT_NE(to_toml(spec).find("focus = \"impact\""), std::string::npos);
    EXPECT_NO_THROW(Scene{spec});
}

TEST(Spec, HasLightsDirectionAndForcesOfTheFile) {
    const SceneSpec spec = everything_directed();
    const TestFolder folder;
    const std::string file = folder / "scene.toml";
    write_text(file, to_toml(spec));
    const Scene built(spec), loaded = load_scene(file);
    EXPECT_TRUE(same(after(built, 12), after(loaded, 12)));
    EXPECT_FALSE(same(after(built, 12), after(Scene(crate_and_ball()), 12)));
    EXPECT_EQ(Renderer(built).render(after(built, 8)), Renderer(loaded).render(after(loaded, 8)));
    const auto blamed = [](const auto& change) {
        SceneSpec wrong = everything_directed();
        change(wrong);
        try {
            Scene scene(wrong);
        } catch (const Error& error) {
            return error.where().element;
        }
        return std::string();
    };
    EXPECT_EQ(blamed([](SceneSpec& s) { s.lights[1].angle = 500.0; }), "lights[1].angle");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.fields[1].linear = -1.0; }), "fields[1].linear");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.pair_forces[0].bodies[1] = "bal"; }), "pair_forces[0].bodies");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.pair_forces[1].moments.pop_back(); }), "pair_forces[1].moments");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.speed[0].factor = 0.0; }), "speed[0].factor");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.shots[0].camera = "top"; }), "shots[0].camera");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.cameras["from above"].vertical_fov = 0.0; }),
              "cameras[\"from above\"].vertical_fov");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.environment->preset = "noon"; }), "environment.preset");
}

/// Bodies joined by each type of joint, with every field at least once.
SceneSpec everything_joined() {
    SceneSpec spec = crate_and_ball();
    spec.simulation.sleep = false;
    for (int i = 0; i < 12; ++i) {
        Body& box = spec.add(Box{{0.5, 0.4, 0.3}});
        box.name = "box " + std::to_string(i);
        box.position = {double(i), 8.0, 0.0};
    }
    const auto box = [](int i) { return "box " + std::to_string(i); };
    Joint& hinge = spec.add_joint(JointType::hinge, "world", box(0));
    hinge.name = "wheel";
    hinge.anchor = {0.0, 0.2, 0.0};
    hinge.axis = Vec3{0.0, 0.0, 1.0};
    hinge.frame = JointFrame::second;
    hinge.start_angle = 5.0;
    hinge.limits = {-3000.0, 3000.0};
    hinge.limit_restitution = 0.5;
    hinge.friction_coefficient = 0.1;
    hinge.bearing_radius = 0.02;
    hinge.armature = 0.003;
    hinge.motor = JointMotor{};
    hinge.motor->keyframes = {{0.0, 0.0}, {0.1, 50.0}, {0.3, 80.0}};
    hinge.motor->interpolation = Interpolation::linear;
    hinge.motor->stiffness = 100.0;
    hinge.motor->damping = 10.0;
    hinge.motor->max_torque = 7.0;
    Joint& slider = spec.add_joint(JointType::slider, "world", box(1));
    slider.name = "rack";
    slider.axis = Vec3{0.0, 1.0, 0.0};
    slider.start_position = 0.1;
    slider.spring = JointSpring{};
    slider.spring->frequency = 2.0;
    slider.spring->damping_ratio = 0.1;
    slider.spring->rest = 0.2;
    slider.friction = 0.5;
    Joint& gear = spec.add_joint(JointType::gear, "", "");
    gear.joints = {"wheel", "rack"};
    gear.ratio = 4.0;
    gear.break_torque = 1e7;
    gear.start = 0.05;
    gear.end = 20.0;
    Joint& ball = spec.add_joint(JointType::ball, box(2), box(3));
    ball.anchors = {Vec3{0.5, 0.0, 0.0}, Vec3{-0.5, 0.0, 0.0}};
    ball.axes = {Vec3{1.0, 0.0, 0.0}, Vec3{1.0, 0.1, 0.0}};
    ball.swing = {60.0, 30.0};
    ball.twist = {-20.0, 30.0};
    Joint& universal = spec.add_joint(JointType::universal, box(3), box(4));
    universal.anchor = Vec3{3.5, 8.0, 0.0};
    universal.axis = Vec3{0.0, 1.0, 0.0};
    universal.second_axis = Vec3{0.0, 0.0, 1.0};
    universal.second_limits = {-40.0, 40.0};
    universal.collide = true;
    Joint& cylindrical = spec.add_joint(JointType::cylindrical, "world", box(5));
    cylindrical.anchor = Vec3{5.0, 8.0, 0.0};
    cylindrical.axis = Vec3{0.0, 1.0, 0.0};
    cylindrical.limits = {-0.2, 0.3};
    cylindrical.turn_limits = {-10.0, 90.0};
    cylindrical.turn_spring = JointSpring{};
    cylindrical.turn_spring->stiffness = 3.0;
    cylindrical.turn_spring->damping = 0.3;
    cylindrical.turn_motor = JointMotor{};
    cylindrical.turn_motor->speed = 2.0;
    cylindrical.turn_motor->max_torque = 1.0;
    cylindrical.turn_friction = 0.1;
    Joint& planar = spec.add_joint(JointType::planar, "world", box(6));
    planar.axis = Vec3{0.0, 0.0, 1.0};
    Joint& rope = spec.add_joint(JointType::distance, box(6), box(7));
    rope.anchors = {Vec3{}, Vec3{}};
    rope.min_length = 0.5;
    rope.max_length = 1.5;
    rope.break_force = 500.0;
    rope.break_impulse = 30.0;
    rope.visible = true;
    rope.motor = JointMotor{};
    rope.motor->target = 0.9;
    rope.motor->stiffness = 20.0;
    rope.motor->max_force = 5.0;
    Joint& rod = spec.add_joint(JointType::distance, box(7), box(8));
    rod.name = "rod";
    rod.anchors = {Vec3{}, Vec3{}};
    rod.length = 1.1;
    rod.snap = true;
    Joint& six = spec.add_joint(JointType::six_dof, box(8), box(9));
    six.anchor = Vec3{8.5, 8.0, 0.0};
    six.move[1] = JointCoordinate{};
    six.move[1]->limits = {-0.1, 0.1};
    six.move[1]->limit_restitution = 0.3;
    six.move[1]->spring = JointSpring{};
    six.move[1]->spring->stiffness = 40.0;
    six.turn[2] = JointCoordinate{};
    six.turn[2]->friction = 0.2;
    six.turn[2]->motor = JointMotor{};
    six.turn[2]->motor->speed = 1.0;
    spec.add_joint(JointType::fixed, box(10), box(11));
    Cord cord;
    cord.joint = "rod";
    spec.cords.push_back(cord);
    return spec;
}

TEST(Spec, JointsMoveLikeThoseOfTheFile) {
    const SceneSpec spec = everything_joined();
    const TestFolder folder;
    const std::string file = folder / "scene.toml";
    write_text(file, to_toml(spec));
    const Scene built(spec), loaded = load_scene(file);
    ASSERT_EQ(built.joint_count(), spec.joints.size());
    EXPECT_EQ(built.joint_name(0), "wheel");
    EXPECT_TRUE(same(after(built, 30), after(loaded, 30)));
    EXPECT_EQ(Renderer(built).render(after(built, 2)), Renderer(loaded).render(after(loaded, 2)));
    World world(built);
    for (int n = 0; n < 30; ++n) world.advance_frame();
    const std::vector<JointState> joints = world.joints();
    EXPECT_NEAR(joints[0].speed[3] + 4.0 * joints[1].speed[0], 0.0, 1e-9);
    EXPECT_LT(std::abs(joints[2].gap), 1e-9);
    EXPECT_TRUE(joints[2].active);
}

/// A cube as a file writes it.
struct Cube {
    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles;

    explicit Cube(const std::string& obj) {
        std::istringstream lines(obj);
        for (std::string kind; lines >> kind;) {
            double x, y, z;
            lines >> x >> y >> z;
            if (kind == "v")
                vertices.push_back({x, y, z});
            else
                triangles.push_back({std::uint32_t(x) - 1, std::uint32_t(y) - 1, std::uint32_t(z) - 1});
        }
    }
};

// The reader numbers the vertices by their first use, which is their order here.
constexpr const char* cube_obj =
    "v 0 0 0\nv 0 1 0\nv 1 1 0\nv 1 0 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 1 2 3\nf 1 3 4\nf 5 6 7\nf 5 7 8\nf 1 4 6\nf 1 6 5\nf 2 8 7\nf 2 7 3\nf 1 5 8\nf 1 8 2\nf 4 3 7\nf 4 7 6\n";

TEST(Spec, AMeshFromMemoryMovesLikeTheOneOfAFile) {
    const TestFolder folder;
    write_text(folder / "cube.obj", cube_obj);
    const Cube cube(cube_obj);
    ASSERT_EQ(cube.triangles.size(), 12u);
    const TriangleMesh mesh(cube.vertices, cube.triangles, 0.7);
    const auto fill = [](SceneSpec& spec, const Shape& shape) {
        spec.add(shape).position = {-2.0, 3.0, 0.0};
        spec.add(Compound{{{shape, {}, {}, {}, {}}, {Sphere{0.4}, {0.0, 1.0, 0.0}, {}, {}, {}}}}).position.y = 6.0;
        Body& copies = spec.add(shape);
        copies.position = {4.0, 5.0, 0.0};
        copies.scatter = Scatter{4, {3.0, 4.0, 3.0}, true, 0.0};
        copies.scale = ScaleRange{0.5, 1.5};
        spec.add(shape, BodyType::fixed).position = {0.0, 0.0, -2.0};
    };
    SceneSpec from_memory = crate_and_ball(), from_file = crate_and_ball();
    from_file.folder = folder.path();
    fill(from_memory, mesh);
    fill(from_file, Mesh{"cube.obj", 0.7, false});
    const Scene ours(from_memory), theirs(from_file);
    EXPECT_TRUE(ours.files().empty());
    EXPECT_TRUE(same(after(ours, 12), after(theirs, 12)));
    EXPECT_EQ(Renderer(ours).render(after(ours, 2)), Renderer(theirs).render(after(theirs, 2)));
    EXPECT_DOUBLE_EQ(World(ours).properties(3).mass, 1000.0 * 0.7 * 0.7 * 0.7);
}

TEST(Spec, AMeshFromMemoryTakesAnyArrays) {
    const Vec3 vertices[] = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    const std::array<Triangle, 4> triangles{{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
    SceneSpec spec;
    spec.add(TriangleMesh({vertices, 4}, triangles));
    EXPECT_NEAR(World(Scene(spec)).properties(0).mass, 1000.0 / 6.0, 1e-9);
}

TEST(Spec, AMeshFromMemoryHasNoFile) {
    const Cube cube(cube_obj);
    SceneSpec spec;
    spec.add(TriangleMesh(cube.vertices, cube.triangles));
    try {
        to_toml(spec);
        ADD_FAILURE() << "a text was made";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_EQ(error.where().element, "bodies[0].shape");
    }
}

// The key by which such a scene passes the checks is not one of the format.
TEST(Spec, AFileCannotNameAMeshInMemory) {
    const TestFolder folder;
    write_text(folder / "a.toml", "format = 1\n[[body]]\nshape = { type = \"mesh\", memory = 0 }\n");
    try {
        load_scene(folder / "a.toml");
        ADD_FAILURE() << "it was read";
    } catch (const Error& error) {
        EXPECT_NE(error.message().find("unknown key"), std::string::npos) << error.what();
    }
}

TEST(Spec, HasTheMethodOfTheNotes) {
    SceneSpec spec = crate_and_ball();
    const Snapshot standard = after(Scene(spec), 15);
    spec.simulation.method = Method::notes;
    const Snapshot notes = after(Scene(spec), 15);
    spec.simulation.push_out = true;
    const Snapshot pushed = after(Scene(spec), 15);
    EXPECT_FALSE(same(standard, notes));
    EXPECT_FALSE(same(notes, pushed));
    spec.simulation.method = Method::tumble;
    try {
        const Scene scene(spec);
        FAIL() << "push_out has no effect with this method";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_NE(std::string(error.what()).find("push_out"), std::string::npos) << error.what();
    }
}

TEST(Spec, HasTheDefaultsOfTheFormat) {
    const TestFolder folder;
    const std::string file = folder / "scene.toml";
    write_text(file, "format = 1\n[[body]]\nshape = { type = \"box\", size = [1, 1, 1] }\nposition = [0, 3, 0]\n");
    SceneSpec spec;
    spec.add(Box{{1.0, 1.0, 1.0}}).position = {0.0, 3.0, 0.0};
    const Scene built(spec), loaded = load_scene(file);
    EXPECT_EQ(built.frame_count(), loaded.frame_count());
    EXPECT_EQ(built.step(), loaded.step());
    EXPECT_EQ(built.output().width, loaded.output().width);
    EXPECT_EQ(Renderer(built).render(after(built, 5)), Renderer(loaded).render(after(loaded, 5)));
}

TEST(Spec, OptionsReplaceTheValuesOfTheFile) {
    const TestFolder folder;
    const std::string file = folder / "scene.toml";
    write_text(file, to_toml(crate_and_ball()));
    LoadOptions options;
    options.duration = 1.0;
    options.fps = 30.0;
    options.steps_per_frame = 2;
    options.width = 64;
    options.integrator = Integrator::exact;
    const Scene scene = load_scene(file, options);
    EXPECT_EQ(scene.frame_count(), 31);
    EXPECT_EQ(scene.duration(), 1.0);
    EXPECT_EQ(scene.step(), 1.0 / 60.0);
    EXPECT_EQ(scene.steps_per_frame(), 2);
    EXPECT_EQ(scene.output().width, 64);
    EXPECT_EQ(scene.output().height, 32);
}

TEST(Spec, BodiesHaveNamesAndTypes) {
    const Scene scene(crate_and_ball());
    EXPECT_EQ(scene.body_count(), 3u);
    EXPECT_EQ(scene.body_name(0), "0");
    EXPECT_EQ(scene.body_name(1), "crate");
    EXPECT_EQ(scene.find_body("crate"), 1u);
    EXPECT_EQ(scene.find_body("2"), 2u);
    EXPECT_FALSE(scene.find_body("none"));
    EXPECT_EQ(scene.body_type(0), BodyType::fixed);
    EXPECT_EQ(scene.body_type(1), BodyType::dynamic);
}

}  // namespace
}  // namespace tumble
