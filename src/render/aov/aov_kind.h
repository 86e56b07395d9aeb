// The arbitrary output variables (AOVs) of a frame: one value per pixel. Units, frames and signs for users are in
// docs/reference/aovs.md.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace tumble {

/// depth: m along the view axis, infinity for the background. normal: unit, world frame, 0 for the background.
/// segmentation: 0 for the background, then bodies from 1 in scene order, then cords. motion: pixels to the place of
/// the surface point in the next frame. albedo: the material's color, sRGB, 0 for the background.
enum class Aov { depth, normal, segmentation, motion, albedo };

inline constexpr std::array all_aovs = {Aov::depth, Aov::normal, Aov::segmentation, Aov::motion, Aov::albedo};

std::string_view name_of(Aov aov);
std::optional<Aov> aov_named(std::string_view name);

/// A set of AOVs.
class AovSet {
public:
    void add(Aov aov) { bits_ |= bit(aov); }
    bool has(Aov aov) const { return (bits_ & bit(aov)) != 0; }
    bool empty() const { return bits_ == 0; }
    friend bool operator==(const AovSet&, const AovSet&) = default;

private:
    static unsigned bit(Aov aov) { return 1u << static_cast<unsigned>(aov); }
    unsigned bits_ = 0;
};

/// "depth, normal"
std::string names_of(const AovSet& aovs);

}  // namespace tumble
