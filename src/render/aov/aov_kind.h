// What a frame can hold beside its colors: "arbitrary output variables", one value a pixel. docs/reference/aovs.md tells users
// their units, frames and signs.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace tumble {

/// depth: m along the view axis, infinity: nothing. normal: unit, world frame, 0: nothing. segmentation: 0: nothing,
/// then bodies from 1 in scene order, then cords. motion: pixels to where the surface's point is in the next frame.
/// albedo: the material's color, sRGB, 0: nothing.
enum class Aov { depth, normal, segmentation, motion, albedo };

inline constexpr std::array all_aovs = {Aov::depth, Aov::normal, Aov::segmentation, Aov::motion, Aov::albedo};

std::string_view name_of(Aov aov);
std::optional<Aov> aov_named(std::string_view name);

/// Some of them.
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
