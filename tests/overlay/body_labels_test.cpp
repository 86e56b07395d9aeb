// Labels: their texts, and their places in the picture.
#include "overlay/body_labels.h"

#include "core/deterministic_math.h"
#include "overlay/callout_painter.h"
#include "scene/load.h"
#include "sim/world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace tumble::body_labels_test {
namespace {

std::string text_of(std::string_view text, const BodyState& body = {}, double time = 0.0) {
    const LabelText label = parse_label(text);
    EXPECT_EQ(label.fault, "") << text;
    return label_text(label.pieces, body, "ball", time);
}

BodyState moving() {
    BodyState body{};
    body.center_of_mass = {1.0, -2.5, 0.25};
    body.velocity = {3.0, 4.0, 0.0};
    body.angular_velocity = {0.0, 2.0, 0.0};
    body.mass = 0.4;
    body.momentum = 0.4 * body.velocity;
    body.angular_momentum = {0.0, 0.5, 0.0};
    return body;
}

TEST(LabelText, HasTheValuesOfTheBody) {
    const BodyState body = moving();
    EXPECT_EQ(text_of("m = {mass} kg", body), "m = 0.4 kg");
    EXPECT_EQ(text_of("{name}: {speed} m/s", body), "ball: 5.00 m/s");
    EXPECT_EQ(text_of("{position:.1}", body), "(1.0, -2.5, 0.2)");
    EXPECT_EQ(text_of("{x:.0f} {y:.2g} {z:.1e}", body), "1 -2.5 2.5e-01");
    EXPECT_EQ(text_of("{omega} {momentum} {kinetic}", body), "2.00 2.00 5.50");  // 0.4 25 / 2 + 0.5 2 / 2
    EXPECT_EQ(text_of("{{{time:.1f}}}", body, 1.25), "{1.2}");
}

TEST(LabelText, HasNoNegativeZero) {
    BodyState body = moving();
    body.center_of_mass = {-1e-9, -0.004, -0.006};
    EXPECT_EQ(text_of("{position}", body), "(0.00, 0.00, -0.01)");
}

TEST(LabelText, NamesFaults) {
    EXPECT_NE(parse_label("{spede}").fault.find("unknown placeholder (known: name, mass, speed"), std::string::npos);
    EXPECT_NE(parse_label("{speed").fault.find("write {{"), std::string::npos);
    EXPECT_NE(parse_label("speed}").fault.find("write }}"), std::string::npos);
    EXPECT_NE(parse_label("{name:.2f}").fault.find("a name has no digits"), std::string::npos);
    for (const char* form : {"{x:}", "{x:2}", "{x:.}", "{x:.2d}", "{x:.16}", "{x:.2ff}", "{x:.123}"})
        EXPECT_EQ(parse_label(form).fault.empty(), std::string_view(form) == "{x:}") << form;
}

TEST(BodyLabels, StandAboveTheBodyInTheirSpanOfTime) {
    SceneDescription scene = parse_scene(R"(
format = 1
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.5 }
position = [1, 2, 3]
[[label]]
body = "ball"
text = "{name}"
from = 1
to = 2
[[label]]
body = "ball"
text = "beside"
offset = [1, 0, 0]
leader = false
)",
                                         "scene.toml");
    const BodyLabels labels(scene);
    World world(scene);
    Snapshot snapshot = world.snapshot();
    const auto at = [&](double time) {
        snapshot.time = time;
        std::vector<OverlayCallout> callouts;
        labels.add(snapshot, callouts);
        return callouts;
    };
    EXPECT_EQ(at(0.5).size(), 1u);
    ASSERT_EQ(at(1.0).size(), 2u);
    EXPECT_EQ(at(2.0).size(), 1u);
    const std::vector<OverlayCallout> both = at(1.0);
    EXPECT_EQ(both[0].text, "ball");
    EXPECT_NEAR((both[0].at - Vec3(1.0, 2.5, 3.0)).norm(), 0.0, 1e-12);
    EXPECT_GT(both[0].lift, 0.0f);
    EXPECT_NEAR((both[1].at - Vec3(2.0, 2.0, 3.0)).norm(), 0.0, 1e-12);
    EXPECT_FALSE(both[1].leader);
    SceneOverrides none;
    none.overlay = "none";
    const std::string labeled =
        "format = 1\n[[body]]\nshape = { type = \"sphere\", radius = 1 }\n[[label]]\nbody = \"0\"\ntext = \"a\"";
    EXPECT_EQ(parse_scene(labeled, "scene.toml").overlay.labels.size(), 1u);
    EXPECT_TRUE(parse_scene(labeled, "scene.toml", none).overlay.labels.empty());
}

CameraDescription from_the_front() {
    CameraDescription camera;
    camera.eye = {0.0, 0.0, 10.0};
    return camera;
}

OverlayCallout callout(const Vec3& of) {
    OverlayCallout one;
    one.of = one.at = of;
    one.text = "a label";
    return one;
}

TEST(CalloutPainter, KeepsTextsInThePictureAndOffEachOther) {
    CalloutPainter painter(640, 360, 1.0);
    const Camera camera(from_the_front(), 640, 360);
    std::vector<OverlayCallout> callouts;
    for (int i = 0; i < 6; ++i) callouts.push_back(callout({0.02 * i, 0.0, 0.0}));
    callouts.push_back(callout({6.2, 3.4, 0.0}));  // in a corner
    const std::vector<PlacedCallout> placed = painter.place(camera, callouts);
    ASSERT_EQ(placed.size(), 7u);
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const Rectangle& box = placed[i].box;
        EXPECT_GE(box.x, 0);
        EXPECT_GE(box.y, 0);
        EXPECT_LE(box.x + box.width, 640);
        EXPECT_LE(box.y + box.height, 360);
        for (std::size_t k = 0; k < i; ++k) {
            const Rectangle& other = placed[k].box;
            EXPECT_TRUE(box.x >= other.x + other.width || other.x >= box.x + box.width ||
                        box.y >= other.y + other.height || other.y >= box.y + box.height)
                << i << ' ' << k;
        }
    }
    // The first one stands where it is asked to.
    EXPECT_NEAR(placed[0].box.x + 0.5 * placed[0].box.width, 320.0, 1.0);
    EXPECT_NEAR(placed[0].box.y + placed[0].box.height, 180.0, 1.0);
}

TEST(CalloutPainter, HidesPointsOutsideAndFadesNearTheEdge) {
    CalloutPainter painter(640, 360, 1.0);
    const Camera camera(from_the_front(), 640, 360);
    const double edge = 10.0 * std::tan(20.0 * pi / 180.0) * 640.0 / 360.0;  // m, of the picture's right side
    const auto opacity = [&](const Vec3& of) {
        const std::vector<PlacedCallout> placed = painter.place(camera, {callout(of)});
        return placed.empty() ? 0.0 : placed.front().opacity;
    };
    EXPECT_EQ(opacity({0.0, 0.0, 0.0}), 1.0);
    EXPECT_EQ(opacity({0.0, 0.0, 20.0}), 0.0);  // behind the camera
    EXPECT_EQ(opacity({1.01 * edge, 0.0, 0.0}), 0.0);
    EXPECT_NEAR(opacity({edge * (1.0 - 12.0 / 320.0), 0.0, 0.0}), 0.5, 0.02);
}

}  // namespace
}  // namespace tumble::body_labels_test
