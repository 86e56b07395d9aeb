// Touching bodies that forces press together without gravity: a load passes through bodies that have no force of their
// own, in both modes, and makes no impacts.
#include "scene/load.h"
#include "sim/world.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

namespace tumble::pressed_row_test {
namespace {

struct Load {
    std::size_t impacts = 0, late = 0;  // rows; those of the second half
    // N, of the contacts between touching bodies, means over the frames of the second half.
    double least = std::numeric_limits<double>::infinity(), most = 0.0;
    double fastest = 0.0;  // m/s, at the end
};

/// Between bodies whose contacts carry more than a thousandth of the largest.
Load measure(const std::string& text) {
    World world(parse_scene("format = 1\n" + text, "scene.toml"));
    world.record_contacts();
    Load load;
    constexpr int frames = 60;
    std::map<std::pair<std::size_t, std::size_t>, double> forces;
    for (int frame = 0; frame < frames; ++frame) {
        world.advance_frame();
        load.impacts += world.contact_records().impacts.size();
        if (2 * frame < frames) continue;
        load.late += world.contact_records().impacts.size();
        for (const ContactRecord& r : world.contact_records().contacts)
            forces[{r.a, r.b}] += r.normal_force / (0.5 * frames);
    }
    for (const auto& [pair, force] : forces) load.most = std::max(load.most, force);
    for (const auto& [pair, force] : forces)
        if (force > 1e-3 * load.most) load.least = std::min(load.least, force);
    for (const BodyState& body : world.snapshot().bodies) load.fastest = std::max(load.fastest, body.velocity.norm());
    return load;
}

const char* const modes[] = {"stepped", "exact"};
const char* const box = R"({ type = "box", size = [0.4, 0.4, 0.4] })";
const char* const sphere = R"({ type = "sphere", radius = 0.2 })";

std::string settings(const std::string& mode, const std::string& gravity = "[0, 0, 0]") {
    return fmt::format("[simulation]\nduration = 1\ngravity = {}\nimpacts = \"{}\"\n", gravity, mode);
}

/// Bodies of 1 kg in a row along x, from 0 on, without gaps.
std::string row(int count, const char* shape, double e, double friction = 0.5) {
    std::string text;
    for (int i = 0; i < count; ++i)
        text += fmt::format(
            "[[body]]\nname = \"b{}\"\nmass = 1\nshape = {}\nposition = [{}, 0, 0]\nrestitution = {}\n"
            "friction = {}\n",
            i, shape, 0.4 * i, e, friction);
    return text;
}

const char* const wall = R"([[body]]
type = "fixed"
shape = { type = "box", size = [0.2, 4, 4] }
position = [-0.3, 0, 0]
)";

std::string force(int body, double x, double start = 0.0) {
    return fmt::format("[[force]]\nbody = \"b{}\"\nforce = [{}, 0, 0]\nstart = {}\n", body, x, start);
}

std::string which(const char* mode, const char* shape, int count, double e) {
    return fmt::format("{}, {} of {}, e = {}", mode, count, shape, e);
}

TEST(PressedRow, AForceAgainstAWall) {
    for (const char* mode : modes)
        for (const char* shape : {box, sphere})
            for (const int count : {4, 7})
                for (const double e : {0.0, 0.2, 0.8}) {
                    const Load load = measure(settings(mode) + wall + row(count, shape, e) + force(count - 1, -100.0));
                    EXPECT_EQ(load.impacts, 0u) << which(mode, shape, count, e);
                    EXPECT_NEAR(load.least, 100.0, 0.1) << which(mode, shape, count, e);
                    EXPECT_NEAR(load.most, 100.0, 0.1) << which(mode, shape, count, e);
                }
}

TEST(PressedRow, ForcesFromBothEnds) {
    for (const char* mode : modes)
        for (const char* shape : {box, sphere})
            for (const int count : {4, 7})
                for (const double e : {0.0, 0.2, 0.8}) {
                    const Load load =
                        measure(settings(mode) + row(count, shape, e) + force(0, 100.0) + force(count - 1, -100.0));
                    EXPECT_EQ(load.impacts, 0u) << which(mode, shape, count, e);
                    EXPECT_NEAR(load.least, 100.0, 0.1) << which(mode, shape, count, e);
                    EXPECT_NEAR(load.most, 100.0, 0.1) << which(mode, shape, count, e);
                }
}

// They float before: the first contacts close within a step.
TEST(PressedRow, ForcesThatBeginLater) {
    for (const char* mode : modes)
        for (const bool at_wall : {false, true})
            for (const double e : {0.0, 0.2, 0.8}) {
                if (at_wall && e > 0.5) continue;  // they bounce between the wall and the pressed one for some steps
                const std::string other = at_wall ? wall : force(0, 100.0, 0.203);
                const Load load = measure(settings(mode) + row(4, box, e) + force(3, -100.0, 0.203) + other);
                const std::string name = fmt::format("{}, e = {}, at a wall: {}", mode, e, at_wall);
                // At a wall they bounce for one to seven steps, by rounding, with some 900 impacts each.
                EXPECT_LT(load.impacts, at_wall ? 10000u : 1000u) << name;
                EXPECT_EQ(load.late, 0u) << name;
                EXPECT_NEAR(load.least, 100.0, 0.1) << name;
                EXPECT_NEAR(load.most, 100.0, 0.1) << name;
                EXPECT_LT(load.fastest, 1e-5) << name;
            }
}

// 100 N move four boxes: 75, 50 and 25 N.
TEST(PressedRow, AForceThatMovesTheRow) {
    for (const char* mode : modes)
        for (const double e : {0.0, 0.2, 0.8}) {
            const Load load = measure(settings(mode) + row(4, box, e) + force(0, 100.0));
            EXPECT_EQ(load.impacts, 0u) << mode << ' ' << e;
            EXPECT_NEAR(load.most, 75.0, 0.75) << mode << ' ' << e;
            EXPECT_NEAR(load.least, 25.0, 0.25) << mode << ' ' << e;
            EXPECT_NEAR(load.fastest, 25.0, 0.25) << mode << ' ' << e;
        }
}

// Pressed to a wall under gravity: held by friction, or falling along it without.
TEST(PressedRow, BooksPressedToAWall) {
    for (const char* mode : modes)
        for (const double e : {0.0, 0.2, 0.8})
            for (const double friction : {0.0, 0.8}) {
                const Load load = measure(settings(mode, "[0, -9.81, 0]") + wall + row(4, box, e, friction) +
                                          force(3, -200.0) + (friction > 0.0 ? "" : "[output]\nfps = 120\n"));
                EXPECT_EQ(load.impacts, 0u) << mode << ' ' << e << ' ' << friction;
                EXPECT_NEAR(load.least, 200.0, 0.2) << mode << ' ' << e << ' ' << friction;
                EXPECT_NEAR(load.fastest, friction > 0.0 ? 0.0 : 0.5 * 9.81, 1e-6) << mode << ' ' << e;
            }
}

// The middle row of a grid is pressed; the others touch it without a load, at which no rounding may bounce.
TEST(PressedRow, AGridWhoseMiddleIsPressed) {
    for (const double e : {0.2, 0.8}) {
        std::string text = settings("stepped");
        for (int i = 0; i < 9; ++i)
            text += fmt::format(
                "[[body]]\nname = \"b{}\"\nmass = 1\nshape = {}\nposition = [{}, {}, 0]\n"
                "restitution = {}\n",
                i, box, 0.4 * (i % 3), 0.4 * (i / 3), e);
        const Load load = measure(text + force(3, 100.0) + force(5, -100.0));
        EXPECT_EQ(load.impacts, 0u) << e;
    }
}

}  // namespace
}  // namespace tumble::pressed_row_test
