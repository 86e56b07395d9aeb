// Overlay frames as bytes: the same after a round trip, and different when a shape differs.
#include "overlay/overlay_frame.h"

#include <gtest/gtest.h>

namespace tumble::overlay_frame_test {
namespace {

OverlayFrame full_frame() {
    OverlayFrame frame;
    frame.surfaces.push_back({3, {1, 2, 3}, Quat(0.5, 0.5, -0.5, 0.5), {{1, 2, 3}, 0.25f, true}, true});
    frame.lines.push_back({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {{9, 8, 7}, 1.0f, false}, 2.5f});
    frame.arrows.push_back({{0, 0, 0}, {0, 2, 0}, {{255, 0, 0}, 1.0f, true}, 3.0f, true});
    frame.markers.push_back({{4, 5, 6}, {{0, 255, 0}, 0.5f, true}, MarkerShape::cross, 4.0f});
    frame.labels.push_back({{7, 8, 9}, {{0, 0, 255}, 1.0f, false}, "crate", 15.0f});
    frame.legend = true;
    frame.damage = 42;
    return frame;
}

std::vector<std::byte> bytes_of(const OverlayFrame& frame) {
    std::vector<std::byte> bytes;
    write_bytes(frame, bytes);
    return bytes;
}

TEST(OverlayFrame, RoundTripKeepsEveryMember) {
    const OverlayFrame frame = full_frame();
    OverlayFrame read;
    read.markers.resize(5);  // of the frame before
    read_bytes(bytes_of(frame), read);
    EXPECT_EQ(bytes_of(read), bytes_of(frame));
    ASSERT_EQ(read.lines.size(), 1u);
    EXPECT_EQ(read.lines[0].points, frame.lines[0].points);
    ASSERT_EQ(read.markers.size(), 1u);
    EXPECT_EQ(read.markers[0].shape, MarkerShape::cross);
    EXPECT_EQ(read.labels[0].text, "crate");
    EXPECT_EQ(read.surfaces[0].orientation.coeffs(), frame.surfaces[0].orientation.coeffs());
    EXPECT_TRUE(read.arrows[0].double_head);
    EXPECT_EQ(read.damage, 42);
}

TEST(OverlayFrame, EveryMemberChangesTheBytes) {
    const std::vector<std::byte> whole = bytes_of(full_frame());
    const auto differs = [&](auto change) {
        OverlayFrame frame = full_frame();
        change(frame);
        return bytes_of(frame) != whole;
    };
    EXPECT_TRUE(differs([](OverlayFrame& f) { f.surfaces[0].body = 4; }));
    EXPECT_TRUE(differs([](OverlayFrame& f) { f.surfaces[0].shaded = false; }));
    EXPECT_TRUE(differs([](OverlayFrame& f) { f.lines[0].points[1].x() = 1.5; }));
    EXPECT_TRUE(differs([](OverlayFrame& f) { f.arrows[0].to.y() = 2.1; }));
    EXPECT_TRUE(differs([](OverlayFrame& f) { f.arrows[0].paint.color.g = 1; }));
    EXPECT_TRUE(differs([](OverlayFrame& f) { f.markers[0].radius = 5.0f; }));
    EXPECT_TRUE(differs([](OverlayFrame& f) { f.labels[0].text = "crates"; }));
    EXPECT_TRUE(differs([](OverlayFrame& f) { f.legend = false; }));
    EXPECT_TRUE(differs([](OverlayFrame& f) { f.damage = 43; }));
    EXPECT_TRUE(differs([](OverlayFrame& f) { f.damage.reset(); }));
}

}  // namespace
}  // namespace tumble::overlay_frame_test
