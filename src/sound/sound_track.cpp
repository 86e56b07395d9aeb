#include "sound/sound_track.h"

#include "core/check.h"
#include "core/deterministic_math.h"
#include "sim/geometry/shapes/shape.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

namespace tumble {
namespace {

constexpr double air_density = 1.2;       // kg/m^3
constexpr double speed_of_sound = 343.0;  // m/s

struct Elasticity {
    double wave_speed;   // m/s, of longitudinal waves in a bar: sqrt(E / density)
    double modulus;      // Pa, E
    double loss_factor;  // part of the energy lost in a radian
};

// Handbook values of oak, steel, window glass, granite, PVC and soft rubber.
Elasticity elasticity(SoundMaterial material) {
    switch (material) {
        case SoundMaterial::metal:
            return {5050.0, 2.0e11, 0.0008};
        case SoundMaterial::glass:
            return {5300.0, 7.0e10, 0.002};
        case SoundMaterial::stone:
            return {4300.0, 5.0e10, 0.006};
        case SoundMaterial::plastic:
            return {1500.0, 3.0e9, 0.04};
        case SoundMaterial::rubber:
            return {70.0, 5.0e6, 0.2};
        default:
            return {3900.0, 1.1e10, 0.02};
    }
}

struct Mode {
    double frequency;   // Hz
    int along, across;  // axes of the body: of the wave, and of its displacement
    int half_waves;
};

// Bending of a free bar of length l and thickness h: f = b^2 / (2 pi sqrt(12)) c h / l^2 with the roots b of
// cos b cosh b = 1 (Euler and Bernoulli); short bars shear, at (k + 1) / 2 times the shear wave's speed over l. Both
// together by 1/f^2 = 1/f_bend^2 + 1/f_shear^2. For a ball of diameter l that is within 5 % of its lowest mode (Lamb).
constexpr std::array<double, 4> bar_roots = {4.730040744862704, 7.853204624095838, 10.995607838001671,
                                             14.137165491257464};
constexpr double shear_speed = 0.6;  // of the longitudinal waves, for Poisson's ratio 0.3 with the bar's shear factor

std::vector<Mode> modes_of(const SoundTrack::Body& body) {
    const double c = elasticity(body.material).wave_speed;
    std::array<int, 3> axes = {0, 1, 2};
    std::ranges::stable_sort(axes, [&](int l, int r) { return body.size[l] > body.size[r]; });
    const std::array<std::array<int, 2>, 3> families = {{{axes[0], axes[2]}, {axes[1], axes[2]}, {axes[0], axes[1]}}};
    std::vector<Mode> modes;
    for (const auto& [along, across] : families) {
        const double length = body.size[along], thickness = body.size[across];
        if (!(length > 0.0 && thickness > 0.0)) continue;
        for (std::size_t k = 0; k < bar_roots.size(); ++k) {
            const double bending =
                bar_roots[k] * bar_roots[k] / (2.0 * pi * std::sqrt(12.0)) * c * thickness / (length * length);
            const double shear = double(k + 2) / 2.0 * shear_speed * c / length;
            modes.push_back(
                {bending * shear / std::sqrt(bending * bending + shear * shear), along, across, int(k) + 2});
        }
    }
    return modes;
}

/// A number in [-1, 1) from a counter: white noise with the same values for every run (splitmix64 by Vigna).
double noise(std::uint64_t counter) {
    std::uint64_t z = counter * 0x9e3779b97f4a7c15ull + 0x9e3779b97f4a7c15ull;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return double(std::int64_t(z ^ (z >> 31)) >> 11) * 0x1p-52;
}

double area_of(const Vec3& size) { return 2.0 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x()); }

/// Spectrum of a half-sine pulse of that duration at a frequency, 1 at 0: its envelope, for only an exact half-sine has
/// zeros between.
double pulse_spectrum(double frequency, double duration) {
    const double x = 2.0 * frequency * duration;
    return 1.0 / (1.0 + x * x);
}

/// The displacement of a mode at a point, for a force along a direction. A tenth of the modes' motion is in the other
/// directions, as in real bodies, whose edges are not free of each other.
double coupling(const Mode& mode, const SoundTrack::Body& body, const SoundTrack::Strike& strike) {
    const double position = std::clamp(strike.point[mode.along] / body.size[mode.along] + 0.5, 0.0, 1.0);
    const double along = strike.impulse[mode.across];
    return std::sqrt(2.0) * sincos(pi * mode.half_waves * position).cos *
           std::sqrt(along * along + 0.1 * strike.impulse.squaredNorm());
}

/// Radiation of a body that is small against the wavelength is weak: k a / sqrt(1 + (k a)^2).
double radiation(double frequency, const Vec3& size) {
    const double ka = 2.0 * pi * frequency / speed_of_sound * 0.5 * size.maxCoeff();
    return ka / std::sqrt(1.0 + ka * ka);
}

/// A mode as a resonator: y = 2 r cos(w) y1 - r^2 y2 + drive sin(w) answers an impulse by r^n sin(w (n + 1)).
class Resonator {
public:
    Resonator(double frequency, double decay, double speed) {
        const double step = speed / sound_rate;  // s of the scene
        const SinCos turn = sincos(2.0 * pi * frequency * step);
        const double r = exponential(-decay * step);
        feedback_ = 2.0 * r * turn.cos;
        decay_ = r * r;
        gain_ = turn.sin;
    }
    /// Adds the mode's pressure to the samples. `drive`: an impulse for each sample; empty: none.
    void run(std::span<double> samples, std::span<const double> drive) {
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const double y = feedback_ * y1_ - decay_ * y2_ + (drive.empty() ? 0.0 : drive[i]) * gain_;
            y2_ = y1_;
            y1_ = y;
            samples[i] += y;
        }
    }
    bool silent() const { return std::abs(y1_) + std::abs(y2_) < 1e-9; }  // Pa; the threshold of hearing is 2e-5

private:
    double feedback_ = 0.0, decay_ = 0.0, gain_ = 0.0;
    double y1_ = 0.0, y2_ = 0.0;
};

/// Samples that are made at a time; a block in which a mode is silent costs nothing.
constexpr std::size_t block = 1024;

class BodyVoice {
public:
    BodyVoice(const SoundTrack::Body& body, std::size_t index, const SoundSpan& span, std::vector<double>& out)
        : body_(body), index_(index), span_(span), out_(out), drive_(block) {}

    void ring(std::span<const SoundTrack::Strike> strikes, std::span<const SoundTrack::Rub> rubs) {
        const double loss = elasticity(body_.material).loss_factor;
        for (const Mode& mode : modes_of(body_)) {
            if (mode.frequency * span_.speed > 0.45 * sound_rate) continue;  // inaudible
            // Amplitude of the surface's acceleration by an impulse J: 4 w J / m, for a modal mass of a quarter.
            const double w = 2.0 * pi * mode.frequency;
            const double loudness =
                air_density * area_of(body_.size) * w / (pi * body_.mass) * radiation(mode.frequency, body_.size);
            Resonator resonator(mode.frequency, 0.5 * w * loss + 5.0, span_.speed);
            std::size_t next = 0, rub = 0;
            for (std::size_t first = 0; first < out_.size(); first += block) {
                const std::size_t end = std::min(first + block, out_.size());
                std::ranges::fill(drive_, 0.0);
                bool driven = false;
                for (; next < strikes.size() && sample(strikes[next].time) < std::int64_t(end); ++next) {
                    const std::int64_t at = sample(strikes[next].time);
                    if (at < std::int64_t(first)) continue;  // before the track
                    drive_[std::size_t(at) - first] += loudness * coupling(mode, body_, strikes[next]) *
                                                       pulse_spectrum(mode.frequency, strikes[next].contact_time);
                    driven = true;
                }
                driven |= rub_block(mode, loudness, rubs, rub, first, end);
                if (!driven && resonator.silent()) continue;
                resonator.run(std::span(out_).subspan(first, end - first),
                              driven ? std::span<const double>(drive_).first(end - first) : std::span<const double>());
            }
        }
    }

    // Sound of the acceleration of the rigid body during the contact (Koss and Alfredson 1973; here a compact dipole):
    // p = air density * volume * jerk / (4 pi c) at 1 m; of a half-sine force, jerk = J (pi / t)^2 cos(pi s / t) / 2m.
    void thud(std::span<const SoundTrack::Strike> strikes) {
        const double volume = body_.size.prod();
        for (const SoundTrack::Strike& strike : strikes) {
            const double duration = std::max(strike.contact_time / span_.speed, 2.0 / sound_rate);  // s of the track
            const double rate = pi / (duration * span_.speed);
            const double peak = air_density * volume * strike.impulse.norm() / body_.mass * 0.5 * rate * rate /
                                (4.0 * pi * speed_of_sound);
            const auto count = std::int64_t(duration * sound_rate);
            const std::int64_t at = sample(strike.time);
            for (std::int64_t i = std::max<std::int64_t>(0, -at); i < count && at + i < std::int64_t(out_.size()); ++i)
                out_[std::size_t(at + i)] += peak * sincos(pi * (double(i) + 0.5) / double(count)).cos;
        }
    }

private:
    std::int64_t sample(double time) const {
        return std::int64_t(std::floor((time - span_.start) / span_.speed * sound_rate + 0.5));
    }

    // Bumps of length b under a force F, at a speed v: v / b of them in a second, each of an impulse F b / v.
    // Their sum is white noise below v / b, of a deviation F sqrt(b / (v rate)) a sample; above, a mode feels it less.
    bool rub_block(const Mode& mode, double loudness, std::span<const SoundTrack::Rub> rubs, std::size_t& rub,
                   std::size_t first, std::size_t end) {
        bool driven = false;
        while (rub < rubs.size() && sample(rubs[rub].to) <= std::int64_t(first)) ++rub;
        for (std::size_t r = rub; r < rubs.size() && sample(rubs[r].from) < std::int64_t(end); ++r) {
            const SoundTrack::Rub& one = rubs[r];
            const double rate = sound_rate / span_.speed;  // samples in a second of the scene
            const double ratio = mode.frequency * one.bump / one.speed;
            const double drive =
                loudness * one.force * std::sqrt(one.bump / (one.speed * rate)) / (1.0 + ratio * ratio);
            if (!(drive > 0.0)) continue;
            const std::int64_t from = std::max(sample(one.from), std::int64_t(first));
            const std::int64_t to = std::min(sample(one.to), std::int64_t(end));
            for (std::int64_t i = from; i < to; ++i)
                drive_[std::size_t(i) - first] += drive * noise((std::uint64_t(index_) << 40) + std::uint64_t(i));
            driven = driven || from < to;
        }
        return driven;
    }

    const SoundTrack::Body& body_;
    std::size_t index_;
    SoundSpan span_;
    std::vector<double>& out_;
    std::vector<double> drive_;
};

}  // namespace

SoundTrack::SoundTrack(const SceneDescription& scene) {
    for (const BodyDescription& body : scene.bodies) {
        Body& made = bodies_.emplace_back();
        if (body.type == BodyType::fixed || endless(body.shape)) continue;
        const Bounds bounds = local_bounds(body.shape);
        const MassProperties matter = mass_properties(body);
        if (!(matter.mass > 0.0 && bounds.extent().minCoeff() > 0.0)) continue;
        made = {bounds.extent(), bounds.center() - matter.center_of_mass, matter.mass, body.sound};
    }
    strikes_.resize(bodies_.size());
    rubs_.resize(bodies_.size());
}

// Hertz: t = 2.87 (m^2 / (R E^2 v))^(1/5), with the reduced mass m, the effective modulus 1/E = 0.91/E1 + 0.91/E2 and a
// radius of curvature of a quarter of the smaller body (Johnson 1985, "Contact Mechanics", 11.24).
double SoundTrack::contact_time(const ImpactRecord& impact) const {
    const Body &a = bodies_[impact.a], &b = bodies_[impact.b];
    double inverse_mass = 0.0, inverse_modulus = 0.0, radius = infinity;
    for (const Body* body : {&a, &b}) {
        if (!(body->mass > 0.0)) continue;
        inverse_mass += 1.0 / body->mass;
        inverse_modulus += 0.91 / elasticity(body->material).modulus;
        radius = std::min(radius, 0.25 * body->size.minCoeff());
    }
    const double speed = std::max(std::abs(impact.speed_before), 1e-3);
    if (!(inverse_mass > 0.0)) return 1.0 / sound_rate;
    const double m = 1.0 / inverse_mass;
    return 2.87 * exponential(0.2 * logarithm(m * m * inverse_modulus * inverse_modulus / (radius * speed)));
}

void SoundTrack::add_strike(const ImpactRecord& impact, std::size_t body, const StruckBody& struck, double sign,
                            double contact_time) {
    if (!(bodies_[body].mass > 0.0) || bodies_[body].material == SoundMaterial::none) return;
    const Vec3 impulse = sign * (impact.impulse * impact.normal + impact.friction);
    strikes_[body].push_back({impact.when.time,
                              struck.rotation.conjugate() * (impact.point - struck.position) - bodies_[body].center,
                              struck.rotation.conjugate() * impulse, contact_time});
}

void SoundTrack::add_rubs(const Snapshot& snapshot, std::span<const ContactRecord> contacts) {
    constexpr double slide_bump = 0.001, roll_bump = 0.004;  // m, grain of a sawn board; waviness of a ball
    constexpr double slide_part = 0.1, roll_part = 0.01;     // of the normal force
    constexpr double slowest = 0.005;                        // m/s
    for (const ContactRecord& contact : contacts) {
        if (contact.a == ContactRecord::nobody || !(contact.normal_force > 0.0)) continue;
        const BodyState &a = snapshot.bodies[contact.a], &b = snapshot.bodies[contact.b];
        const Vec3 spin = b.angular_velocity - a.angular_velocity;
        const Vec3 rolling = spin - spin.dot(contact.normal) * contact.normal;
        for (const std::size_t body : {contact.a, contact.b}) {
            if (!(bodies_[body].mass > 0.0) || bodies_[body].material == SoundMaterial::none) continue;
            const double slip = contact.slip.norm();
            const double roll = rolling.norm() * 0.5 * bodies_[body].size.minCoeff();
            if (slip > slowest)
                rubs_[body].push_back({last_time_, snapshot.time, slide_part * contact.normal_force, slip, slide_bump});
            else if (roll > slowest)
                rubs_[body].push_back({last_time_, snapshot.time, roll_part * contact.normal_force, roll, roll_bump});
        }
    }
}

void SoundTrack::see(const Snapshot& snapshot, const ContactRecords& records) {
    TUMBLE_CHECK_EQ(snapshot.bodies.size(), bodies_.size());
    for (const ImpactRecord& impact : records.impacts) {
        const double duration = contact_time(impact);
        add_strike(impact, impact.a, records.struck[impact.struck_a], -1.0, duration);
        add_strike(impact, impact.b, records.struck[impact.struck_b], 1.0, duration);
    }
    if (snapshot.frame > 0) add_rubs(snapshot, records.contacts);
    last_time_ = snapshot.time;
}

std::vector<double> SoundTrack::pressure(const SoundSpan& span) const {
    std::vector<double> out(std::size_t(span.duration * sound_rate + 0.5), 0.0);
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        if (strikes_[i].empty() && rubs_[i].empty()) continue;
        BodyVoice voice(bodies_[i], i, span, out);
        voice.ring(strikes_[i], rubs_[i]);
        voice.thud(strikes_[i]);
    }
    return out;
}

std::vector<std::int16_t> mix(std::span<const std::vector<double>> tracks) {
    std::vector<double> sum;
    for (const std::vector<double>& track : tracks) {
        sum.resize(std::max(sum.size(), track.size()), 0.0);
        for (std::size_t i = 0; i < track.size(); ++i) sum[i] += track[i];
    }
    double loudest = 0.0;
    for (const double value : sum) loudest = std::max(loudest, std::abs(value));
    std::vector<std::int16_t> samples(sum.size(), 0);
    if (!(loudest > 0.0)) return samples;
    const double scale = 0.5 * 32767.0 / loudest;
    for (std::size_t i = 0; i < sum.size(); ++i) samples[i] = std::int16_t(std::floor(sum[i] * scale + 0.5));
    return samples;
}

std::vector<std::byte> wav_bytes(std::span<const std::int16_t> samples) {
    std::vector<std::byte> bytes;
    const auto text = [&](const char* four) {
        for (int i = 0; i < 4; ++i) bytes.push_back(std::byte(four[i]));
    };
    const auto number = [&](std::uint32_t value, int count) {
        for (int i = 0; i < count; ++i) bytes.push_back(std::byte(value >> (8 * i)));
    };
    const auto size = std::uint32_t(2 * samples.size());
    text("RIFF"), number(36 + size, 4), text("WAVE");
    text("fmt "), number(16, 4), number(1, 2), number(1, 2), number(sound_rate, 4), number(2 * sound_rate, 4);
    number(2, 2), number(16, 2);
    text("data"), number(size, 4);
    for (const std::int16_t sample : samples) number(std::uint16_t(sample), 2);
    return bytes;
}

}  // namespace tumble
