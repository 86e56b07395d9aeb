// Sound of a run by modal synthesis: each body that moves rings in its vibration modes where impacts strike it, and is
// driven by noise where it slides or rolls. The frequencies follow from the body's size and the speed of waves in its
// material, the decay from the material's loss factor.
#pragma once

#include "core/vector.h"
#include "scene/description/description.h"
#include "sim/snapshot/contact_records.h"
#include "sim/snapshot/snapshot.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// Samples per second of a track.
inline constexpr int sound_rate = 48000;

/// Part of the scene's time that a track covers, and the speed at which it is heard. At half speed each tone is an
/// octave lower: the track is that of the scene's time, played slowly.
struct SoundSpan {
    double start = 0.0;     // s, scene time of the first sample
    double duration = 0.0;  // s, of the track
    double speed = 1.0;     // seconds of the scene in a second of the track
};

/// Collects the impacts and contacts of a run, frame by frame, and makes the sound of them.
class SoundTrack {
public:
    explicit SoundTrack(const SceneDescription& scene);

    /// The next frame: its impacts and contacts since the frame before. Frames are in order.
    void see(const Snapshot& snapshot, const ContactRecords& records);

    /// Pressure in Pa at 1 m from each body, one value a sample, before any scaling. The same bytes on every x86-64.
    std::vector<double> pressure(const SoundSpan& span) const;

    /// Edges and material of a body that sounds.
    struct Body {
        Vec3 size = Vec3::Zero();    // m, edges of the bounds in the body's frame
        Vec3 center = Vec3::Zero();  // m, of the bounds, from the center of mass
        double mass = 0.0;           // kg; 0: silent
        SoundMaterial material = SoundMaterial::none;
    };
    /// An impulse on a body.
    struct Strike {
        double time = 0.0;            // s
        Vec3 point = Vec3::Zero();    // m, from the center of the bounds, in the body's frame
        Vec3 impulse = Vec3::Zero();  // N s, in the body's frame
        double contact_time = 0.0;    // s, for which the bodies touch (Hertz)
    };
    /// Contact with a rough surface during a frame: on average a force on bumps that pass at a speed.
    struct Rub {
        double from = 0.0, to = 0.0;  // s
        double force = 0.0;           // N, that the bumps modulate
        double speed = 0.0;           // m/s
        double bump = 0.0;            // m, length of a bump
    };

private:
    void add_strike(const ImpactRecord& impact, std::size_t body, const StruckBody& struck, double sign,
                    double contact_time);
    void add_rubs(const Snapshot& snapshot, std::span<const ContactRecord> contacts);
    double contact_time(const ImpactRecord& impact) const;

    std::vector<Body> bodies_;
    std::vector<std::vector<Strike>> strikes_;  // by body, in order of time
    std::vector<std::vector<Rub>> rubs_;
    double last_time_ = 0.0;  // s, of the frame before
};

/// Sums tracks and scales them so that the loudest sample is at half of the range; silence stays silent.
std::vector<std::int16_t> mix(std::span<const std::vector<double>> tracks);

/// A WAV file of one channel, 16 bits, at sound_rate.
std::vector<std::byte> wav_bytes(std::span<const std::int16_t> samples);

}  // namespace tumble
