// Analytic antialiasing compared with exact areas.
#include "drawing.h"
#include "example_scenes.h"

#include "render/antialiasing/analytic_aa.h"
#include "render/antialiasing/surface_ids.h"
#include "render/camera/convex_hull_2d.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::edge_test {
namespace {

constexpr std::uint8_t inner = 7, outer = 9;

TEST(ShareBefore, IsTheMeanOfAClampedRamp) {
    for (const double half : {0.0, 0.1, 0.35, 0.5})
        for (double t = -0.8; t < 1.8; t += 0.07) {
            double sum = 0.0;
            for (int i = 0; i < 1000; ++i) sum += std::clamp(t - half * ((i + 0.5) / 500.0 - 1.0), 0.0, 1.0);
            EXPECT_NEAR(share_before(t, half), sum / 1000.0, 1e-3) << t << ", " << half;
        }
}

// White below a line through the center at this angle, black above, with one sample per pixel.
struct HalfPlane {
    static constexpr int size = 48;
    Vec3 normal;  // in pixels: inside where normal . (x, y, 1) > 0
    Image drawn{size, size};
    ScreenEdge edge;

    explicit HalfPlane(double angle)
        : normal(-std::sin(angle), std::cos(angle), 24.3 * std::sin(angle) - 23.9 * std::cos(angle)),
          edge{float(24.3 - 60.0 * std::cos(angle)),
               float(23.9 - 60.0 * std::sin(angle)),
               float(24.3 + 60.0 * std::cos(angle)),
               float(23.9 + 60.0 * std::sin(angle)),
               inner,
               outer} {
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const bool inside = normal.dot(Vec3(x + 0.5, y + 0.5, 1.0)) > 0.0;
                std::uint8_t* p = drawn.at(x, y);
                p[0] = p[1] = p[2] = inside ? 255 : 0;
                p[3] = inside ? inner : outer;
            }
    }
    double area(int x, int y) const {  // of the pixel inside the half-plane
        int count = 0;
        for (int i = 0; i < 32; ++i)
            for (int j = 0; j < 32; ++j)
                count += normal.dot(Vec3(x + (i + 0.5) / 32.0, y + (j + 0.5) / 32.0, 1.0)) > 0.0 ? 1 : 0;
        return count / 1024.0;
    }
};

DirtyTiles all_marked(const Camera& view) {
    DirtyTiles marks(view);
    marks.mark_all();
    return marks;
}

Image blended(const Image& drawn, const ScreenEdge& edge) {
    const Camera view(empty_scene().camera, drawn.width, drawn.height);
    Image frame(drawn.width, drawn.height);
    copy_opaque(drawn, {{0, 0, drawn.width, drawn.height}}, frame);
    blend_analytic_edges(drawn, {edge}, all_marked(view), frame);
    return frame;
}

TEST(BlendAnalyticEdges, GivesEveryPixelOfALineItsArea) {
    for (double angle = 0.0; angle < 6.28; angle += 0.13) {
        const HalfPlane half(angle);
        for (const bool outline : {false, true}) {
            ScreenEdge edge = half.edge;
            if (outline) edge.outer = 0;
            const Image frame = blended(half.drawn, edge);
            for (int y = 2; y < HalfPlane::size - 2; ++y)
                for (int x = 2; x < HalfPlane::size - 2; ++x) {
                    EXPECT_NEAR(frame.at(x, y)[1] / 255.0, half.area(x, y), 0.016) << angle << ": " << x << ", " << y;
                    EXPECT_EQ(frame.at(x, y)[3], 255);
                }
        }
    }
}

TEST(BlendAnalyticEdges, LeavesHiddenEdgesAlone) {
    const HalfPlane half(0.4);
    for (const ScreenEdge& edge : {ScreenEdge{half.edge.x0, half.edge.y0, half.edge.x1, half.edge.y1, 3, 4},
                                   ScreenEdge{half.edge.x0, half.edge.y0, half.edge.x1, half.edge.y1, 3, 0},
                                   ScreenEdge{half.edge.x0, half.edge.y0, half.edge.x1, half.edge.y1, inner, 4}}) {
        const Image frame = blended(half.drawn, edge);
        for (int y = 0; y < HalfPlane::size; ++y)
            for (int x = 0; x < HalfPlane::size; ++x) EXPECT_EQ(frame.at(x, y)[0], half.drawn.at(x, y)[0]);
    }
}

// The far rim of a ring is hidden by its near side.
TEST(BlendAnalyticEdges, LeavesEdgesAloneThatAreHiddenByTheirSurface) {
    for (double angle = 0.0; angle < 6.28; angle += 0.13) {
        const HalfPlane half(angle);
        const double x = -1.5 * std::sin(angle), y = 1.5 * std::cos(angle);  // pixels inwards
        const ScreenEdge& e = half.edge;
        const Image frame =
            blended(half.drawn, {float(e.x0 + x), float(e.y0 + y), float(e.x1 + x), float(e.y1 + y), inner, 0});
        for (int i = 0; i < HalfPlane::size * HalfPlane::size; ++i)
            ASSERT_EQ(frame.pixels[std::size_t(4 * i)], half.drawn.pixels[std::size_t(4 * i)]) << angle;
    }
}

// White bodies before a black sky: the value of a pixel is its coverage.
class Silhouettes {
public:
    Silhouettes() {
        for (const char* file : {"box.frag", "ball.frag", "mesh.frag"})
            shaders_.replace(file, "pixel = ", "pixel = vec4(vec3(1.0), v_rough.w); // ");
        shaders_.replace("sky.frag", "pixel = ", "pixel = vec4(0.0, 0.0, 0.0, 1.0); // ");
    }
    // Root mean square error over the partly covered pixels. `inside`: true for a covered point.
    template <class Inside>
    double error(const SceneDescription& scene, bool multisample, Inside inside) const {
        RenderSwitches options = shaders_.options();
        options.multisample = multisample;
        const Image image = drawn(scene, options);
        double sum = 0.0;
        int count = 0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) {
                int covered = 0;
                for (int i = 0; i < 64; ++i)
                    covered += inside(ScreenPoint(x + (i % 8 + 0.5) / 8.0, y + (i / 8 + 0.5) / 8.0));
                if (covered == 0 || covered == 64) continue;
                const double off = image.at(x, y)[0] / 255.0 - covered / 64.0;
                sum += off * off;
                ++count;
            }
        EXPECT_GT(count, 50);
        return std::sqrt(sum / count);
    }

    // The darkest pixel that is, with all its neighbors, within the area drawn with one sample.
    int darkest_within(SceneDescription scene) const {
        const Image smooth = drawn(scene, shaders_.options());
        scene.output.samples = 1;
        const Image plain = drawn(scene, shaders_.options());
        int darkest = 255, count = 0;
        for (int y = 1; y + 1 < plain.height; ++y)
            for (int x = 1; x + 1 < plain.width; ++x) {
                bool within = true;
                for (int i = 0; i < 9; ++i) within = within && plain.at(x + i % 3 - 1, y + i / 3 - 1)[0] == 255;
                if (!within) continue;
                ++count;
                darkest = std::min(darkest, int(smooth.at(x, y)[0]));
            }
        EXPECT_GT(count, 5);
        return darkest;
    }

private:
    ShaderCopy shaders_;
};

// True if a point of the screen is on the box.
auto shown_box(const Camera& view, const BodyDescription& box, const Vec3& half_size) {
    FewPoints corners;
    for (const Vec3& p : box_corners(view.relative(box.position), box.rotation.toRotationMatrix(), half_size))
        corners.push_back(view.pixel(p));
    return [corners = convex_hull(corners)](const ScreenPoint& p) {
        for (std::size_t i = 0; i < corners.size(); ++i)
            if (turn(corners[i], corners[(i + 1) % corners.size()], p) < 0.0) return false;
        return true;
    };
}

TEST(AnalyticAntialiasing, OfABoxAndABallAreFinerThanFourSamples) {
    const Silhouettes silhouettes;
    SceneDescription scene = empty_scene();
    scene.light.shadows = false;
    const Camera view(scene.camera, 320, 180);
    for (double angle = 0.1; angle < 1.5; angle += 0.45) {
        const Quat turned(Eigen::AngleAxisd(angle, Vec3(1.0, 2.0, 0.5).normalized()));
        scene.bodies = {box_body(Vec3(0.3, 1.1, 0.0), Vec3(2.0, 1.4, 1.0), {255, 255, 255}, turned)};
        const auto inside = shown_box(view, scene.bodies[0], Vec3(1.0, 0.7, 0.5));
        EXPECT_LT(silhouettes.error(scene, false, inside), 0.055);  // corners have several edges
        EXPECT_GT(silhouettes.error(scene, true, inside), 0.06) << "four samples know five shades";
    }
    scene.bodies = {ball_body(Vec3(0.3, 1.1, 0.0), 1.2, {255, 255, 255})};
    const Vec3 center = view.relative(scene.bodies[0].position);
    const auto inside = [&](const ScreenPoint& p) {
        const Vec3 ray = view.ray(p.x(), p.y()).normalized();
        return center.cross(ray).norm() < 1.2;
    };
    EXPECT_LT(silhouettes.error(scene, false, inside), 0.06);  // the ball is drawn as a mesh within 0.15 pixels
}

// One color inside and outside: only the outline of the ring is visible, with its hole.
TEST(AnalyticAntialiasing, OfAMeshHaveManyShades) {
    const Silhouettes silhouettes;
    SceneDescription scene = empty_scene();
    scene.bodies = {mesh_body(Vec3(0.0, 1.0, 0.0), torus_asset(1.2, 0.4), {255, 255, 255},
                              Quat(Eigen::AngleAxisd(1.1, Vec3::UnitX())))};
    const Camera view(scene.camera, 320, 180);
    const Quat back = scene.bodies[0].rotation.conjugate();
    const Vec3 eye = back * (scene.camera.eye - scene.bodies[0].position);
    const auto inside = [&](const ScreenPoint& p) {  // march along the ray to the exact torus
        const Vec3 ray = back * view.ray(p.x(), p.y()).normalized();
        double at = 4.0;
        for (int i = 0; i < 100 && at < 12.0; ++i) {
            const Vec3 q = eye + at * ray;
            const double distance = std::hypot(std::hypot(q.x(), q.z()) - 1.2, q.y()) - 0.4;
            if (distance < 1e-3) return true;
            at += distance;
        }
        return false;
    };
    const double smooth = silhouettes.error(scene, false, inside);
    EXPECT_LT(smooth, 0.1);  // the mesh itself is a little thinner than the torus
    EXPECT_LT(smooth, silhouettes.error(scene, true, inside) + 0.02);
}

// The far rim of the hole, which the near tube hides, must not take color from beyond the ring.
TEST(AnalyticAntialiasing, EdgesHiddenByTheirMeshAreNotBlended) {
    const Silhouettes silhouettes;
    SceneDescription scene = empty_scene();
    for (double angle = 0.0; angle < 1.6; angle += 0.2) {
        scene.bodies = {mesh_body(Vec3(0.0, 1.0, 0.0), torus_asset(0.3, 0.1), {255, 255, 255},
                                  Quat(Eigen::AngleAxisd(angle, Vec3(1.0, 0.3, 0.5).normalized())))};
        EXPECT_GT(silhouettes.darkest_within(scene), 250) << angle;
    }
}

// Large receivers that extend behind the eye have smooth edges.
TEST(AnalyticAntialiasing, OfGroundsThatReachBehindTheEye) {
    const Silhouettes silhouettes;
    SceneDescription scene = empty_scene();
    scene.light.shadows = false;
    scene.camera.eye = Vec3(1.0, 2.0, 3.0);
    scene.camera.target = Vec3(0.0, 1.5, -7.0);
    scene.camera.up = Vec3(0.3, 1.0, 0.0);
    const Camera view(scene.camera, 320, 180);
    const Vec3 half_size(30.0, 0.5, 30.0), low(-30.0, -1.0, -30.0), high(30.0, 0.0, 30.0);
    const auto on_box = [&](const ScreenPoint& p) {
        const Vec3 ray = view.ray(p.x(), p.y());
        double enter = 0.0, leave = 1e9;
        for (int k = 0; k < 3; ++k) {
            const double a = (low[k] - view.eye()[k]) / ray[k], b = (high[k] - view.eye()[k]) / ray[k];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        return enter < leave;
    };
    scene.bodies = {box_body(Vec3(0.0, -0.5, 0.0), 2.0 * half_size, {255, 255, 255})};
    EXPECT_LT(silhouettes.error(scene, false, on_box), 0.03);
    const auto on_sheet = [&](const ScreenPoint& p) {
        const Vec3 ray = view.ray(p.x(), p.y()), at = view.eye() + ray * (view.eye().y() / -ray.y());
        return ray.y() < 0.0 && std::abs(at.x()) < 30.0 && std::abs(at.z()) < 30.0;
    };
    scene.bodies = {mesh_body(Vec3::Zero(), sheet_asset(60.0, 12), {255, 255, 255})};
    EXPECT_LT(silhouettes.error(scene, false, on_sheet), 0.03);
    const Vec3 center = view.relative(Vec3(0.0, -20.0, 0.0));
    const auto on_ball = [&](const ScreenPoint& p) {
        const Vec3 ray = view.ray(p.x(), p.y()).normalized();
        return center.cross(ray).norm() < 20.0 && center.dot(ray) > 0.0;
    };
    scene.bodies = {ball_body(Vec3(0.0, -20.0, 0.0), 20.0, {255, 255, 255})};
    EXPECT_LT(silhouettes.error(scene, false, on_ball), 0.06);  // it is drawn as a mesh within 0.15 pixels
}

// A rod of three pixels or less: its narrow sides may cover no pixel center along a part of the outline.
TEST(AnalyticAntialiasing, OfThinBoxesAreStraight) {
    const Silhouettes silhouettes;
    SceneDescription scene = empty_scene();
    scene.light.shadows = false;
    const Camera view(scene.camera, 320, 180);
    for (double angle = 0.07; angle < 1.5; angle += 0.3) {
        const Quat turned(Eigen::AngleAxisd(angle, Vec3(0.2, -0.1, 1.0).normalized()) *
                          Eigen::AngleAxisd(0.5, Vec3::UnitX()));
        const Vec3 half_size(1.5, 0.03, 0.03);
        scene.bodies = {box_body(Vec3(0.3, 1.1, 0.0), 2.0 * half_size, {255, 255, 255}, turned)};
        const auto inside = shown_box(view, scene.bodies[0], half_size);
        EXPECT_LT(silhouettes.error(scene, false, inside), 0.04) << angle;
    }
}

// A rounded edge a pixel wide would be hit irregularly by pixel centers, like a string of beads.
TEST(AnalyticAntialiasing, ThinBoxesLookAsInALargerPicture) {
    SceneDescription scene = empty_scene();
    scene.light.shadows = false;
    for (double angle = 0.37; angle < 1.5; angle += 0.3) {
        const Quat turned(Eigen::AngleAxisd(angle, Vec3(0.2, -0.1, 1.0).normalized()) *
                          Eigen::AngleAxisd(0.5, Vec3::UnitX()));
        scene.bodies = {box_body(Vec3(0.0, 1.0, 0.0), Vec3(3.0, 0.06, 0.06), {216, 192, 112}, turned)};
        constexpr int times = 8;
        SceneDescription larger = scene;
        larger.output.width *= times;
        larger.output.height *= times;
        const Image image = drawn(scene), large = drawn(larger);
        scene.bodies.clear();
        const Image sky = drawn(scene);
        double sum = 0.0;
        int count = 0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) {
                if (std::equal(image.at(x, y), image.at(x, y) + 3, sky.at(x, y))) continue;
                for (int channel = 0; channel < 3; ++channel) {
                    double mean = 0.0;
                    for (int i = 0; i < times * times; ++i)
                        mean += large.at(times * x + i % times, times * y + i / times)[channel];
                    const double off = image.at(x, y)[channel] - mean / (times * times);
                    sum += off * off;
                    ++count;
                }
            }
        EXPECT_GT(count, 500);
        EXPECT_LT(std::sqrt(sum / count), 2.05) << "levels, " << angle;
    }
}

}  // namespace
}  // namespace tumble::edge_test
