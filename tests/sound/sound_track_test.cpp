// Sound of runs: clicks at the times of the impacts, louder for larger impulses, at the frequencies of the modes.
#include "sound/sound_track.h"

#include "core/deterministic_math.h"
#include "scene/load.h"
#include "sim/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

namespace tumble::sound_track_test {
namespace {

struct Heard {
    SoundTrack track;
    std::vector<ImpactRecord> impacts;
};

Heard run(const std::string& bodies, double duration = 1.0) {
    const std::string text = R"(
format = 1
[simulation]
integrator = "exact"
impacts = "exact"
duration = )" + std::to_string(duration) +
                             R"(
[[body]]
type = "fixed"
shape = { type = "plane" }
)" + bodies;
    const SceneDescription scene = parse_scene(text, "test.toml");
    World world(scene);
    world.record_contacts();
    Heard made{SoundTrack(scene), {}};
    made.track.see(world.snapshot(), world.contact_records());
    for (std::int64_t n = 1; n < scene.timing().frame_count(duration); ++n) {
        world.advance_frame();
        const ContactRecords& records = world.contact_records();
        made.impacts.insert(made.impacts.end(), records.impacts.begin(), records.impacts.end());
        made.track.see(world.snapshot(), records);
    }
    return made;
}

std::string ball(double height, const std::string& more = "") {
    return "[[body]]\nshape = { type = \"sphere\", radius = 0.05 }\nposition = [0, " + std::to_string(height) +
           ", 0]\n" + more;
}

double energy(const std::vector<double>& samples) {
    double sum = 0.0;
    for (const double value : samples) sum += value * value;
    return sum;
}

/// The first sample that is not silent, from `first` on.
std::int64_t onset(const std::vector<double>& samples, std::size_t first = 0) {
    while (first < samples.size() && samples[first] == 0.0) ++first;
    return std::int64_t(first);
}

/// Power at a frequency (Goertzel).
double power(const std::vector<double>& samples, double frequency) {
    double re = 0.0, im = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const SinCos turn = sincos(2.0 * pi * frequency * double(i) / sound_rate);
        re += samples[i] * turn.cos;
        im += samples[i] * turn.sin;
    }
    return re * re + im * im;
}

/// Frequency of the largest power among multiples of `step`.
double loudest(const std::vector<double>& samples, double from, double to, double step) {
    double best = 0.0, found = 0.0;
    for (double f = from; f <= to; f += step)
        if (const double p = power(samples, f); p > best) best = p, found = f;
    return found;
}

TEST(SoundTrack, AClickBeginsInTheSampleOfItsImpact) {
    const Heard r = run(ball(0.6, "restitution = 0.8\n"), 1.2);
    ASSERT_GE(r.impacts.size(), 2u);
    const std::vector<double> samples = r.track.pressure({0.0, 1.2, 1.0});
    EXPECT_LE(std::abs(onset(samples) - std::llround(r.impacts[0].when.time * sound_rate)), 1);
    // From a start after the first impact, whose ring is over: the second one alone.
    const double start = 0.5 * (r.impacts[0].when.time + r.impacts[1].when.time);
    const std::vector<double> later = r.track.pressure({start, 0.4, 1.0});
    EXPECT_LE(std::abs(onset(later) - std::llround((r.impacts[1].when.time - start) * sound_rate)), 1);
}

TEST(SoundTrack, TheEnergyOfAClickGrowsWithTheImpulse) {
    double last = 0.0;
    for (const double height : {0.1, 0.2, 0.4, 0.8}) {
        const Heard r = run(ball(height, "restitution = 0\n"), 0.6);
        const double now = energy(r.track.pressure({0.0, 0.6, 1.0}));
        EXPECT_GT(now, 1.5 * last) << height;
        last = now;
    }
}

TEST(SoundTrack, SlowMotionIsLaterAndLower) {
    const std::string bar =
        "[[body]]\nshape = { type = \"box\", size = [0.5, 0.02, 0.02] }\nposition = [0, 0.2, 0]\nrotation = { axis = "
        "[0, 0, 1], "
        "angle = 5 }\nmaterial = \"steel\"\n[materials.steel]\nsound = \"metal\"\ndensity = 7800\nrestitution = 0\n";
    const Heard r = run(bar, 0.4);
    ASSERT_FALSE(r.impacts.empty());
    const std::vector<double> normal = r.track.pressure({0.0, 0.4, 1.0}), slow = r.track.pressure({0.0, 0.8, 0.5});
    EXPECT_EQ(slow.size(), 2 * normal.size());
    EXPECT_LE(std::abs(onset(slow) - 2 * onset(normal)), 2);
    // The lowest mode of the free bar: 1.028 c h / l^2 = 415 Hz, at half speed 208 Hz.
    EXPECT_NEAR(loudest(normal, 350, 480, 2.0), 415.0, 6.0);
    EXPECT_NEAR(loudest(slow, 175, 240, 1.0), 207.5, 3.0);
}

TEST(SoundTrack, TheLowestModeOfABallIsLambs) {
    const Heard r = run(ball(0.3, "material = \"steel\"\n[materials.steel]\nsound = \"metal\"\ndensity = 7800\n"), 0.5);
    // 2.64 c_s / (2 pi R) with c_s = 3200 m/s: 26.9 kHz, inaudible. At a tenth of the speed 2.69 kHz.
    const std::vector<double> slow = r.track.pressure({0.2, 3.0, 0.1});
    EXPECT_NEAR(loudest(slow, 2200, 3200, 10.0), 2690.0, 0.05 * 2690.0);
}

TEST(SoundTrack, SilentBodiesAndSilentMaterialsGiveZeros) {
    const Heard r = run(ball(0.3, "material = \"quiet\"\n[materials.quiet]\nsound = \"none\"\n"), 0.5);
    ASSERT_FALSE(r.impacts.empty());
    const std::vector<double> samples = r.track.pressure({0.0, 0.5, 1.0});
    EXPECT_EQ(energy(samples), 0.0);
    EXPECT_EQ(mix({&samples, 1}), std::vector<std::int16_t>(samples.size(), 0));
}

TEST(SoundTrack, ASlidingBoxHissesUntilItRests) {
    const Heard r =
        run("[[body]]\nshape = { type = \"box\", size = [0.2, 0.1, 0.2] }\nposition = [0, 0.05, 0]\n"
            "velocity = [2, 0, 0]\nfriction = 0.5\n",
            1.0);  // for v / (mu g) = 0.41 s
    const std::vector<double> samples = r.track.pressure({0.0, 1.0, 1.0});
    const std::vector<double> sliding(samples.begin(), samples.begin() + 12000);
    const std::vector<double> resting(samples.begin() + 36000, samples.end());
    EXPECT_GT(energy(sliding), 0.0);
    EXPECT_LT(energy(resting), 1e-6 * energy(sliding));
}

TEST(SoundTrack, TheLoudestSampleIsAtHalfOfTheRange) {
    const std::vector<std::vector<double>> tracks = {{0.0, 0.5, -1.0}, {0.0, -0.5, -1.0, 0.25}};
    EXPECT_EQ(mix(tracks), (std::vector<std::int16_t>{0, 0, -16383, 2048}));
}

TEST(SoundTrack, AWavFileHasItsLengthsInTheHead) {
    const std::vector<std::int16_t> samples = {1, -2};
    const std::vector<std::byte> bytes = wav_bytes(samples);
    ASSERT_EQ(bytes.size(), 48u);
    EXPECT_EQ(int(bytes[4]), 40);  // of the rest of the file
    EXPECT_EQ(int(bytes[40]), 4);  // of the samples
    EXPECT_EQ(int(bytes[44]), 1);
    EXPECT_EQ(int(bytes[46]), 0xfe);
}

}  // namespace
}  // namespace tumble::sound_track_test
