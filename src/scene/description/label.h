// Text that stands in the scene, tied to a body.
#pragma once

#include "core/color.h"
#include "core/vector.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tumble {

/// A value of the body that a label shows. SI units.
enum class LabelValue : std::uint8_t {
    name,
    mass,
    speed,
    velocity,  // vector
    position,  // of the center of mass, vector
    x,
    y,
    z,
    omega,  // angular speed
    momentum,
    kinetic,  // energy
    time,
};

/// A placeholder: the value, and how its digits are written.
struct LabelField {
    LabelValue value = LabelValue::name;
    int digits = 2;   // behind the point; significant ones of the general form
    char form = 'f';  // as of printf: f, g or e
    bool operator==(const LabelField&) const = default;
};

using LabelPiece = std::variant<std::string, LabelField>;

/// The pieces of "m = {mass:.2f} kg", or its fault, to follow the text in a message.
struct LabelText {
    std::vector<LabelPiece> pieces;
    std::string fault;
};
LabelText parse_label(std::string_view text);

struct LabelDescription {
    std::string text;  // for parse_label(), without faults
    std::size_t body = 0;
    std::optional<Vec3> offset;  // m, world frame, from the center of mass to the label; empty: above the body
    double size = 20.0;          // of the letters, pixels of a picture 720 pixels high
    Color color{250, 251, 253};
    bool leader = true;  // a line to the center of mass
    double start = 0.0;  // s: it is shown in [start, end)
    double end = std::numeric_limits<double>::infinity();
};

}  // namespace tumble
