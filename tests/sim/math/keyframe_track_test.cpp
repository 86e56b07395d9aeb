// Paths of kinematic bodies: they pass through their keys, their velocities are the derivatives of their poses, and
// unusual key lists (one, two, equal, half turns, nonuniform times) are valid.
#include "sim/math/keyframe_track.h"
#include "sim/random_shapes.h"

#include <gtest/gtest.h>

#include <numbers>

namespace tumble::keyframe_track_test {
using namespace tumble::testing;

namespace {

constexpr double pi = std::numbers::pi;

Quat about(const Vec3& axis, double angle) { return Quat(Eigen::AngleAxisd(angle, axis.normalized())); }

double angle_between(const Quat& p, const Quat& q) { return rotation_vector(p * q.conjugate()).norm(); }

std::vector<Keyframe> random_keys(Random& random, int n) {
    std::vector<Keyframe> keys;
    double time = random(-1.0, 1.0);
    for (int i = 0; i < n; ++i) {
        keys.push_back({time, random.vector(2.0), random.turn()});
        time += i % 3 == 0 ? random(0.01, 0.05) : random(0.5, 2.0);  // nonuniform
    }
    return keys;
}

const Interpolation both[] = {Interpolation::smooth, Interpolation::linear};

}  // namespace

TEST(KeyframeTrack, PassesThroughItsKeys) {
    Random random(91);
    for (const Interpolation kind : both)
        for (int trial = 0; trial < 50; ++trial) {
            const auto keys = random_keys(random, 2 + trial % 6);
            const KeyframeTrack track(keys, kind);
            for (const Keyframe& key : keys) {
                const auto m = track.at(key.time);
                EXPECT_LT((m.position - key.position).norm(), 1e-13);
                EXPECT_LT(angle_between(m.rotation, key.rotation), 1e-13);
                EXPECT_NEAR(m.rotation.norm(), 1.0, 1e-14);
            }
        }
}

TEST(KeyframeTrack, VelocitiesAreTheDerivatives) {
    Random random(92);
    for (const Interpolation kind : both)
        for (int trial = 0; trial < 100; ++trial) {
            const auto keys = random_keys(random, 2 + trial % 6);
            const KeyframeTrack track(keys, kind);
            for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
                const double span = keys[i + 1].time - keys[i].time, t = keys[i].time + random(0.1, 0.9) * span;
                const double d = 1e-4 * span;
                const auto before = track.at(t - d), now = track.at(t), after_it = track.at(t + d);
                const Vec3 v = (after_it.position - before.position) / (2.0 * d);
                const Vec3 w = rotation_vector(after_it.rotation * before.rotation.conjugate()) / (2.0 * d);
                EXPECT_LT((now.velocity - v).norm(), 1e-6 * (1.0 + v.norm()));
                EXPECT_LT((now.angular_velocity - w).norm(), 1e-6 * (1.0 + w.norm()));
            }
        }
}

// Smooth: position, rotation and both velocities are continuous at the keys; at rest at both ends.
TEST(KeyframeTrack, SmoothPathsHaveNoKinks) {
    Random random(93);
    for (int trial = 0; trial < 50; ++trial) {
        const auto keys = random_keys(random, 3 + trial % 5);
        const KeyframeTrack track(keys, Interpolation::smooth);
        for (std::size_t i = 0; i < keys.size(); ++i) {
            const double eps = 1e-9;
            const auto before = track.at(keys[i].time - eps), now = track.at(keys[i].time),
                       later = track.at(keys[i].time + eps);
            for (const auto& m : {before, later}) {
                EXPECT_LT((m.velocity - now.velocity).norm(), 1e-3);
                EXPECT_LT((m.angular_velocity - now.angular_velocity).norm(), 1e-3) << "key " << i;
            }
            if (i > 0 && i + 1 < keys.size()) continue;
            EXPECT_LT(now.velocity.norm() + now.angular_velocity.norm(), 1e-12);
        }
    }
}

// Half turns have no shorter arc: both are valid, but it must be a half turn, finite, from key to key.
TEST(KeyframeTrack, HalfTurns) {
    for (const Interpolation kind : both)
        for (const Vec3& axis : {Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(1, 2, -3)})
            for (const double slack : {0.0, 1e-15, -1e-15, 1e-9, -1e-9}) {
                std::vector<Keyframe> keys;
                for (int i = 0; i < 5; ++i) keys.push_back({double(i), Vec3::Zero(), about(axis, (pi + slack) * i)});
                const KeyframeTrack track(keys, kind);
                for (int i = 0; i < 5; ++i)
                    EXPECT_LT(angle_between(track.at(i).rotation, keys[std::size_t(i)].rotation), 1e-7);
                for (double t = 0.05; t < 4.0; t += 0.1) {
                    const auto m = track.at(t);
                    EXPECT_TRUE(m.rotation.coeffs().allFinite() && m.angular_velocity.allFinite());
                    EXPECT_LT(m.angular_velocity.norm(), 4.0 * pi);
                    EXPECT_LT(m.angular_velocity.cross(axis.normalized()).norm(), 1e-6);  // about the axis alone
                }
                if (kind == Interpolation::linear) {
                    EXPECT_NEAR(track.at(0.5).angular_velocity.norm(), pi, 1e-8);
                }
            }
}

// Uniformly spaced keys of a steady motion: steady between the inner keys.
TEST(KeyframeTrack, SteadyRotationStaysSteady) {
    std::vector<Keyframe> keys;
    for (int i = 0; i < 9; ++i) keys.push_back({0.5 * i, Vec3(0.2 * i, 0.0, 1.0), about({0.0, 0.0, 1.0}, 1.0 * i)});
    const KeyframeTrack track(keys, Interpolation::smooth);
    for (double t = 0.5; t < 3.5; t += 0.03) {
        EXPECT_LT((track.at(t).angular_velocity - Vec3(0.0, 0.0, 2.0)).norm(), 1e-12);
        EXPECT_LT((track.at(t).velocity - Vec3(0.4, 0.0, 0.0)).norm(), 1e-12);
    }
}

// A lift that waits, rises suddenly and waits again: it neither swings while it waits nor overshoots.
TEST(KeyframeTrack, NothingOvershoots) {
    const Vec3 up = Vec3(0.0, 0.6, 0.8);
    std::vector<Keyframe> keys;
    for (const auto& [time, height] :
         {std::pair{0.0, 0.0}, {3.0, 0.0}, {3.2, 5.0}, {7.0, 5.0}, {7.5, 4.0}, {11.0, 4.5}})
        keys.push_back({time, height * up, about(up, 0.3 * height)});
    const KeyframeTrack track(keys, Interpolation::smooth);
    for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
        const double low = std::min(up.dot(keys[i].position), up.dot(keys[i + 1].position));
        const double high = std::max(up.dot(keys[i].position), up.dot(keys[i + 1].position));
        for (double t = keys[i].time; t < keys[i + 1].time; t += 0.01) {
            const KeyframeTrack::Motion m = track.at(t);
            EXPECT_GE(up.dot(m.position), low - 1e-12) << t;
            EXPECT_LE(up.dot(m.position), high + 1e-12) << t;
            EXPECT_LT(angle_between(m.rotation, about(up, 0.3 * up.dot(m.position))), 1e-12) << t;
        }
    }
}

TEST(KeyframeTrack, OneKeyStandsStill) {
    const Keyframe key{0.7, Vec3(1, 2, 3), about({1, 1, 0}, 0.4)};
    for (const Interpolation kind : both)
        for (const double t : {-5.0, 0.0, 0.7, 0.7000001, 100.0}) {
            const auto m = KeyframeTrack({key}, kind).at(t);
            EXPECT_EQ(m.position, key.position);
            EXPECT_EQ(m.rotation.coeffs(), key.rotation.coeffs());
            EXPECT_TRUE(m.velocity.isZero(0.0) && m.angular_velocity.isZero(0.0));
        }
}

TEST(KeyframeTrack, TwoKeysStartAndStopAtRestOrMoveEvenly) {
    const Keyframe first{1.0, Vec3::Zero(), Quat::Identity()}, last{3.0, Vec3(4, 0, 0), about({0, 0, 1}, 1.0)};
    const KeyframeTrack smooth({first, last}, Interpolation::smooth), linear({first, last}, Interpolation::linear);
    for (const KeyframeTrack* track : {&smooth, &linear}) {
        EXPECT_LT((track->at(2.0).position - Vec3(2, 0, 0)).norm(), 1e-13);
        EXPECT_LT(angle_between(track->at(2.0).rotation, about({0, 0, 1}, 0.5)), 1e-13);
        EXPECT_EQ(track->at(0.0).position, first.position);
        EXPECT_EQ(track->at(9.0).position, last.position);
    }
    EXPECT_NEAR(smooth.at(2.0).velocity.x(), 1.5 * 2.0, 1e-13);  // u^2 (3 - 2u) has slope 3/2 in the middle
    EXPECT_NEAR(linear.at(1.1).velocity.x(), 2.0, 1e-13);
    EXPECT_NEAR(linear.at(2.9).angular_velocity.z(), 0.5, 1e-13);
}

// Keys that repeat a pose, quaternions of either sign, nearly equal times.
TEST(KeyframeTrack, EqualPosesAndSigns) {
    const Quat q = about({1, 2, 3}, 2.0);
    const std::vector<Keyframe> keys = {{0.0, Vec3::Ones(), q},
                                        {1.0, Vec3::Ones(), Quat(-q.coeffs())},
                                        {1.0 + 1e-9, Vec3::Ones(), q},
                                        {2.0, Vec3::Ones(), Quat(-q.coeffs())}};
    for (const Interpolation kind : both) {
        const KeyframeTrack track(keys, kind);
        for (double t = -0.5; t < 2.5; t += 0.01) {
            const auto m = track.at(t);
            EXPECT_LT((m.position - Vec3::Ones()).norm(), 1e-14);
            EXPECT_LT(angle_between(m.rotation, q), 1e-14);
            EXPECT_LT(m.velocity.norm() + m.angular_velocity.norm(), 1e-6);
        }
    }
}

TEST(RotationVector, ThereAndBack) {
    Random random(94);
    for (int trial = 0; trial < 2000; ++trial) {
        const double size = trial % 4 == 0 ? 1e-9 : trial % 4 == 1 ? 1e-4 : trial % 4 == 2 ? 1.0 : pi - 1e-9;
        const Vec3 v = size * random(0.5, 1.0) * random.direction();
        const Quat q = from_rotation_vector(v);
        EXPECT_LT(angle_between(q, Quat(Eigen::AngleAxisd(v.norm(), v.normalized()))), 1e-15 + 1e-15 * v.norm());
        EXPECT_LT((rotation_vector(q) - v).norm(), 2e-15 + 1e-14 * v.norm());
        EXPECT_LT((rotation_vector(Quat(-q.coeffs())) - v).norm(), 2e-15 + 1e-14 * v.norm());
    }
    EXPECT_TRUE(rotation_vector(Quat::Identity()).isZero(0.0));
    EXPECT_NEAR(rotation_vector(Quat(0.0, 0.0, 1.0, 0.0)).norm(), pi, 1e-15);
}

}  // namespace tumble::keyframe_track_test
