// Friction where several faces of two bodies meet in one plane: floors of tiles, of parts, of triangles, and plates of
// parts move as on one box.
#include "support/compounds.h"
#include "support/meshes.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace tumble::shared_area_test {
using namespace tumble::testing;

namespace {

constexpr double mu = 0.3;

enum class Floor { box, tiles, compound, mesh };

// A square floor of 6 m in n x n pieces, its top at y = 0, around a point that no piece has in its middle.
void add_floor(SceneDescription& scene, Floor floor, int n) {
    const double side = 6.0, piece = side / n;
    const Vec3 middle(0.7, 0.0, 0.1);
    const auto at = [&](int i, int k) {
        return Vec3((i + 0.5) * piece - 0.5 * side, -0.5, (k + 0.5) * piece - 0.5 * side);
    };
    const BoxShape box{{piece, 1.0, piece}};
    std::vector<CompoundPart> parts;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            if (floor == Floor::tiles || floor == Floor::box) add_body(scene, box, middle + at(i, k));
            if (floor == Floor::compound) parts.push_back(part(box, at(i, k)));
        }
    if (floor == Floor::compound) add_body(scene, compound_of(parts), middle);
    if (floor == Floor::mesh) add_body(scene, MeshShape{asset_of(grid_mesh(n, 0.5 * side, 0.0))}, middle);
    for (BodyDescription& body : scene.bodies) {
        body.type = BodyType::fixed;
        body.restitution = 0.0;
        body.friction = mu;
    }
}

// A plate of 1 x 0.05 x 1 m of n x m parts.
Shape plate(int n, int m) {
    if (n * m == 1) return BoxShape{{1.0, 0.05, 1.0}};
    std::vector<CompoundPart> parts;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < m; ++k)
            parts.push_back(part(BoxShape{{1.0 / n, 0.05, 1.0 / m}}, {(i + 0.5) / n - 0.5, 0.0, (k + 0.5) / m - 0.5}));
    return compound_of(parts);
}

struct Way {
    ContactSolverChoice solver = ContactSolverChoice::by_island;
    ImpactMode impacts = ImpactMode::stepped;
    int steps = 1;
};
struct Start {
    Vec3 velocity;
    double spin;  // rad/s
};

struct Path {
    std::vector<Vec3> places;  // by frame
    double time = 0.0;         // s, until it stands
};
Path slide(Floor floor, int pieces, const Shape& shape, const Start& start, const Way& way) {
    SceneDescription scene;
    scene.simulation.steps_per_frame = way.steps;
    scene.simulation.contact_solver = way.solver;
    scene.simulation.impacts = way.impacts;
    scene.simulation.sleep = false;
    add_floor(scene, floor, pieces);
    BodyDescription& body = add_body(scene, shape, {0.013, 0.025, 0.017});
    body.mass = 1.0;
    body.restitution = 0.0;
    body.friction = mu;
    body.velocity = start.velocity;
    body.angular_velocity = {0.0, start.spin, 0.0};
    World world(scene);
    Path path;
    for (int still = 0; still < 10;) {
        world.advance_frame();
        const BodyState b = world.snapshot().bodies.back();
        path.places.push_back(b.center_of_mass);
        ++still;
        if (b.velocity.norm() + b.angular_velocity.norm() > 0.02) still = 0;
        if (still == 0) path.time = double(path.places.size()) / 60.0;
    }
    return path;
}

double length_of(const Path& path) { return (path.places.back() - path.places.front()).norm(); }

double apart(const Path& one, const Path& other) {
    double most = 0.0;
    for (std::size_t i = 0; i < std::min(one.places.size(), other.places.size()); ++i)
        most = std::max(most, (one.places[i] - other.places[i]).norm());
    return most;
}

std::vector<Way> ways() {
    return {{ContactSolverChoice::by_island, ImpactMode::stepped, 16},
            {ContactSolverChoice::soft, ImpactMode::stepped, 4},
            {ContactSolverChoice::direct, ImpactMode::stepped, 8},
            {ContactSolverChoice::by_island, ImpactMode::exact, 4}};
}
std::string name(const Way& way) {
    return "solver " + std::to_string(int(way.solver)) + " impacts " + std::to_string(int(way.impacts));
}

// Compares with the path of one box on one box: within 2 % of its length, or of the plate's side for a spin on the
// spot.
void compare(const Path& one, const Path& other, const Start& start, const Way& way, const std::string& what) {
    const double scale = start.velocity.isZero() ? 1.0 : length_of(one);
    EXPECT_LT(apart(one, other), 0.02 * scale) << what << ", " << name(way);
    EXPECT_NEAR(other.time, one.time, 0.02 * one.time + 1.0 / 60.0) << what << ", " << name(way);
}

const Start both{{1.5, 0.0, 0.0}, 6.0}, spin{Vec3::Zero(), 8.0}, askew{{1.0, 0.0, 0.8}, -3.0};

}  // namespace

TEST(SharedArea, AFloorInPiecesIsAsOneBox) {
    for (const Way& way : ways())
        for (const Start& start : {both, spin}) {
            const Path one = slide(Floor::box, 1, plate(1, 1), start, way);
            for (const Floor floor : {Floor::tiles, Floor::compound, Floor::mesh})
                for (const int pieces : {2, 4, 8})
                    compare(one, slide(floor, pieces, plate(1, 1), start, way), start, way,
                            "floor " + std::to_string(int(floor)) + " of " + std::to_string(pieces));
        }
}

TEST(SharedArea, APlateOfPartsIsAsOneBox) {
    for (const Way& way : ways())
        for (const Start& start : {both, spin, askew}) {
            const Path one = slide(Floor::box, 1, plate(1, 1), start, way);
            for (const auto& [n, m] : {std::pair(2, 1), {2, 2}, {3, 3}})
                for (const Floor floor : {Floor::box, Floor::tiles, Floor::mesh})
                    compare(one, slide(floor, floor == Floor::box ? 1 : 4, plate(n, m), start, way), start, way,
                            std::to_string(n * m) + " parts, floor " + std::to_string(int(floor)));
        }
}

}  // namespace tumble::shared_area_test
