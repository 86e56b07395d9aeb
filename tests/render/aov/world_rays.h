// The rays of a frame in the world, by the formula of render/camera/camera.h; and the nearest surface on a ray by a
// method independent of the program: shape by shape, triangle by triangle.
#pragma once

#include "example_scenes.h"

#include "render/aov/aov_renderer.h"

#include <cmath>
#include <limits>

namespace tumble {

struct WorldRay {
    Vec3 eye, direction;  // direction . forward = 1
    Vec3 at(double depth) const { return eye + depth * direction; }
};

struct WorldView {
    explicit WorldView(const SceneDescription& scene, const CameraDescription& camera)
        : eye(camera.eye), width(scene.output.width), height(scene.output.height) {
        forward = (camera.target - camera.eye).normalized();
        right = forward.cross(camera.up).normalized();
        up = right.cross(forward);
        tangent = std::tan(0.5 * camera.vertical_fov * M_PI / 180.0);
    }
    explicit WorldView(const SceneDescription& scene) : WorldView(scene, scene.camera) {}

    /// Through the center of a pixel.
    WorldRay ray(int column, int row) const {
        const double x = tangent * width / height * (2.0 * (column + 0.5) / width - 1.0);
        const double y = tangent * (1.0 - 2.0 * (row + 0.5) / height);
        return {eye, forward + x * right + y * up};
    }

    /// Screen position of a point; pixel centers are integers.
    Eigen::Vector2d place(const Vec3& point) const {
        const Vec3 p = point - eye;
        const double scale = 0.5 * height / (tangent * p.dot(forward));
        return {0.5 * width - 0.5 + scale * p.dot(right), 0.5 * height - 0.5 - scale * p.dot(up)};
    }

    Vec3 eye, forward, right, up;
    double tangent;
    int width, height;
};

/// First and second intersection of a ray in the world (to detect a tie): depths, and the body's number.
struct WorldHit {
    double first = std::numeric_limits<double>::infinity(), second = first;
    std::size_t body = ~std::size_t(0);

    void add(double depth, std::size_t of) {
        if (!(depth > 0.0)) return;
        if (depth < first) {
            second = body == of ? second : first;
            first = depth;
            body = of;
        } else if (of != body && depth < second) {
            second = depth;
        }
    }
};

/// Boxes, balls, planes and closed meshes in any order, without compounds.
WorldHit nearest_in_world(const SceneDescription& scene, const Snapshot& snapshot, const WorldRay& ray);

}  // namespace tumble
