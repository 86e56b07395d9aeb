#include "stability/random_scenes.h"

#include "harness/penetration.h"
#include "harness/random.h"
#include "harness/shapes.h"

#include <algorithm>
#include <cstdio>
#include <exception>

namespace tumble::bench {
namespace {

// Mirror images are compared until rounding becomes visible: some two to five impacts.
constexpr double mirror_seconds = 0.75, mirror_tolerance = 1e-3;  // s, m
constexpr double scene_seconds = 1.5, half_width = 3.0, pit_height = 14.0;

Body any_body(Random& random, const Vector& place, double speed) {
    const double density = random.between(1.0, 10.0);
    Body body;
    if (random.unit() < 0.4) {
        const double r = random.between(0.15, 0.5);
        body = sphere(r, density * 4.18879 * r * r * r, place);
    } else {
        const Vector size{random.between(0.2, 1.0), random.between(0.2, 1.0), random.between(0.2, 1.0)};
        body = box(size, density * size.x * size.y * size.z, place);
        body.orientation = random.turned(std::numbers::pi);
    }
    body.velocity = {speed * random.both(), speed * random.both(), speed * random.both()};
    body.angular_velocity = {3.0 * random.both(), 3.0 * random.both(), 3.0 * random.both()};
    body.friction = random.unit();
    body.restitution = random.unit() < 0.3 ? 0.0 : random.unit();
    return body;
}

// A point on a sphere.
Vector direction(Random& random) {
    for (;;) {
        const Vector v{random.both(), random.both(), random.both()};
        if (dot(v, v) > 0.01 && dot(v, v) < 1.0) return 1.0 / norm(v) * v;
    }
}

Scene random_scene(Kin kin, Random& random) {
    Scene scene;
    const bool free = kin == Kin::pair || kin == Kin::crowd;
    const int count = kin == Kin::pair     ? 2
                      : kin == Kin::crowd  ? 3 + int(8.0 * random.unit())
                      : kin == Kin::mirror ? 1 + int(2.0 * random.unit())
                                           : 3 + int(10.0 * random.unit());
    for (int i = 0; i < count; ++i) {
        if (free) {  // towards the origin, each from a shell of its own: no overlap at the start
            const Vector away = direction(random);
            Body body = any_body(random, (2.0 * (i + 1)) * away, 0.2);
            if (kin == Kin::pair) body.friction = 0.0;
            body.velocity = body.velocity - (2.0 * (i + 1) * random.between(0.8, 1.2)) * away;
            scene.bodies.push_back(body);
        } else {  // layers 2 m apart
            const Vector place{1.2 * random.both(), 1.2 * random.both(),
                               1.2 + (kin == Kin::pit ? 0.0 : 0.5) + 2.0 * (i / 4)};
            const Vector corner{i % 2 ? 1.0 : -1.0, i / 2 % 2 ? 1.0 : -1.0, 0.0};
            const Vector apart{0.3 * place.x + 1.25 * corner.x, 0.3 * place.y + 1.25 * corner.y, place.z};
            scene.bodies.push_back(any_body(random, apart, 4.0));
        }
    }
    if (free) {
        scene.gravity = 0.0;
        return scene;
    }
    add_pit(scene, half_width, pit_height);
    for (Body& body : scene.bodies)
        if (!body.moves()) {
            body.friction = 0.5;
            body.restitution = 0.0;
        }
    return scene;
}

Scene mirrored(Scene scene) {  // x to -x; the pit is its own image
    for (Body& b : scene.bodies) {
        b.position.x = -b.position.x;
        b.velocity.x = -b.velocity.x;
        b.orientation.y = -b.orientation.y;
        b.orientation.z = -b.orientation.z;
        b.angular_velocity.y = -b.angular_velocity.y;
        b.angular_velocity.z = -b.angular_velocity.z;
    }
    return scene;
}

struct Momentum {
    Vector linear, angular;                  // the latter about the origin
    double linear_sum = 0, angular_sum = 0;  // sums of the bodies' magnitudes: errors are relative to them
};

Momentum momentum(const Scene& scene, const std::vector<Motion>& motions) {
    Momentum sum;
    for (std::size_t i = 0; i < motions.size(); ++i) {
        const Body& body = scene.bodies[i];
        if (!body.moves()) continue;
        const Vector p = body.mass * motions[i].velocity;
        const Vector l = angular_momentum(body, motions[i]) + cross(motions[i].position, p);
        sum.linear = sum.linear + p;
        sum.angular = sum.angular + l;
        sum.linear_sum += norm(p);
        sum.angular_sum += norm(l);
    }
    return sum;
}

enum Invariant { finite_, energy_, momentum_, walls_, normals_, mirror_, invariants };

// Runs one scene to its end; true where the invariant was broken.
std::vector<bool> broken(Kin kin, long seed, const StabilityWay& way, double rate) {
    std::vector<bool> bad(invariants, false);
    Random random(std::uint64_t(seed) + 1000);
    const Scene scene = random_scene(kin, random);
    const std::size_t n = scene.bodies.size();
    const auto world = way.make(scene, rate);
    const auto image = kin == Kin::mirror ? way.make(mirrored(scene), rate) : nullptr;
    std::vector<Motion> now(n), before;
    const auto look = [&](const Simulator& w) {
        for (std::size_t i = 0; i < n; ++i)
            if (scene.bodies[i].moves()) now[i] = w.motion(i);
    };
    look(*world);
    const double start = energy(scene, now);
    const Momentum first = momentum(scene, now);
    double least = start;
    for (long step = 0; step < std::lround(scene_seconds * rate); ++step) {
        before = now;
        world->step();
        look(*world);
        for (std::size_t i = 0; i < n; ++i) bad[finite_] = bad[finite_] || (scene.bodies[i].moves() && !finite(now[i]));
        if (bad[finite_]) return bad;
        const double e = energy(scene, now);
        bad[energy_] = bad[energy_] || e > least + 0.01 * start;
        least = std::min(least, e);
        if (kin == Kin::pair || kin == Kin::crowd) {
            const Momentum m = momentum(scene, now);
            bad[momentum_] = bad[momentum_] || norm(m.linear - first.linear) > 1e-6 * first.linear_sum ||
                             norm(m.angular - first.angular) > 1e-3 * first.angular_sum;
        }
        if (kin == Kin::pair) {
            const Vector change = now[0].velocity - before[0].velocity;
            bad[normals_] = bad[normals_] || dot(change, before[0].position - before[1].position) < -1e-6;
        }
        if (kin == Kin::pit || kin == Kin::mirror)
            for (std::size_t i = 0; i < n; ++i)
                if (scene.bodies[i].moves()) {
                    const Vector& p = now[i].position;
                    bad[walls_] = bad[walls_] || p.z < 0.0 || std::max(std::abs(p.x), std::abs(p.y)) > half_width;
                }
        if (!image || double(step + 1) / rate > mirror_seconds) continue;
        image->step();
        for (std::size_t i = 0; i < n; ++i)
            if (scene.bodies[i].moves()) {
                const Vector p = image->motion(i).position, q{-now[i].position.x, now[i].position.y, now[i].position.z};
                bad[mirror_] = bad[mirror_] || !(norm(p - q) < mirror_tolerance);
            }
    }
    return bad;
}

}  // namespace

std::vector<Count> run_random_scenes(const StabilityWay& way, double rate, long first, long stride, long last) {
    std::vector<Count> counts(invariants);
    counts[finite_] = {"finite", "all states are finite numbers", {}, {}};
    counts[energy_] = {"energy", "at most 1 % of the initial energy above the minimum so far", {}, {}};
    counts[momentum_] = {"momentum", "constant to 1e-6, angular momentum to 1e-3 of the bodies' sums", {}, {}};
    counts[walls_] = {"walls", "no center of mass passes a wall or the floor", {}, {}};
    counts[normals_] = {"normals", "no contact of two smooth bodies pulls", {}, {}};
    counts[mirror_] = {"mirror", "a mirrored scene moves as the mirror image to 1 mm for 0.75 s", {}, {}};
    for (Count& c : counts) c.failed = c.scenes = std::vector<long>(4, 0);
    constexpr bool applies[4][invariants] = {{true, true, true, false, true, false},
                                             {true, true, true, false, false, false},
                                             {true, true, false, true, false, false},
                                             {true, true, false, true, false, true}};
    for (long seed = first; seed < last; seed += stride) {
        const std::size_t kin = std::size_t(seed % 4);
        std::vector<bool> bad(invariants, false);
        try {
            bad = broken(Kin(kin), seed, way, rate);
        } catch (const std::exception& e) {
            std::fprintf(stderr, "random scene %ld at 1/%g: %s\n", seed, rate, e.what());
            bad[finite_] = true;
        }
        for (std::size_t k = 0; k < invariants; ++k) {
            if (!applies[kin][k]) continue;
            ++counts[k].scenes[kin];
            if (!bad[k]) continue;
            ++counts[k].failed[kin];
            std::fprintf(stderr, "%s: random scene %ld (%s) at 1/%g breaks %s\n", way.name.c_str(), seed,
                         kin_names[kin], rate, counts[k].invariant.c_str());
        }
    }
    return counts;
}

}  // namespace tumble::bench
