// The lengths of arrows: one scale for each quantity, the same for the whole clip.
#pragma once

#include "scene/description/description.h"
#include "sim/snapshot/contact_records.h"
#include "sim/snapshot/snapshot.h"

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace tumble {

/// Meters in the scene for a unit of each quantity; 0: there was nothing to show.
using OverlayScales = std::array<double, arrow_quantity_count>;

/// Marks that occur in a clip, for its legend.
struct OverlayMarks {
    std::uint32_t states = 0, features = 0;  // a bit for each ContactRecord::State, and for each ContactFeatures
    bool friction = false;                   // of contact forces
    void add(const OverlayMarks& others);
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [states, features, friction] = self;
        archive.any(states, features);
        archive.keep(friction);
    }
};

/// True if the friction part of a contact force is drawn as an arrow of its own.
bool shows_friction(const Vec3& normal, const Vec3& tangential);

/// Quantities that the arrows of these overlays show.
bool shows(const OverlayDescription& overlay, ArrowQuantity quantity);
/// True if anything but text is drawn.
bool draws_shapes(const OverlayDescription& overlay);
/// True if a scale has to be found from a run of the simulation.
bool needs_survey(const OverlayDescription& overlay);
/// True if contacts and impacts have to be recorded.
bool needs_records(const OverlayDescription& overlay);
/// By body: 1 if the overlay shows it, otherwise 0.
std::vector<char> shown_bodies(const SceneDescription& scene);

/// The vector of a record that an arrow shows: on B, or on A where only A is dynamic.
struct RecordVector {
    std::size_t body = 0;
    Vec3 normal = Vec3::Zero(), tangential = Vec3::Zero();  // N, or N s of an impact
    Vec3 total() const { return normal + tangential; }
};
RecordVector vector_of(const ContactRecord& record, const SceneDescription& scene);
RecordVector vector_of(const ImpactRecord& record, const SceneDescription& scene);

/// Chooses the scales from all frames of a run: half of the arrows get at least a tenth of the picture's height, if
/// the longest then fits into the picture; rounded to 1, 2 or 5 times a power of ten.
class ScaleSurvey {
public:
    /// `scene` must outlive it.
    explicit ScaleSurvey(const SceneDescription& scene);
    void add(const Snapshot& snapshot, const ContactRecords* records);
    /// Counts the arrows of another panel as well, so that both have the same scales.
    void add(const ScaleSurvey& other);
    /// Takes the counts of another panel instead of its own.
    void take(const ScaleSurvey& other) { sizes_ = other.sizes_, marks_ = other.marks_; }
    const OverlayMarks& marks() const { return marks_; }
    /// The scene's scales where given, otherwise by the height that the camera sees.
    OverlayScales scales(const CameraDescription& camera) const;
    OverlayScales scales() const { return scales(scene_->camera); }

private:
    void add(ArrowQuantity quantity, double size);
    struct Sizes {
        double most = 0.0;
        std::map<int, std::int64_t> counts;  // by bin: eight in each factor of two
    };
    const SceneDescription* scene_;
    std::vector<char> shown_;  // by body
    std::array<Sizes, arrow_quantity_count> sizes_;
    OverlayMarks marks_;
};

}  // namespace tumble
