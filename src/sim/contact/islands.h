// Groups of dynamic bodies that hang together through contacts. What happens in one cannot reach another within a step,
// so islands are solved independently, on any thread, and fall asleep as one.
#pragma once

#include "sim/contact/contact.h"

#include <cstdint>
#include <vector>

namespace tumble {

struct Island {
    std::vector<std::uint32_t> bodies;     // dynamic ones, ascending
    std::vector<std::uint32_t> contacts;   // ascending
};

/// Islands of the contacts given, ordered by their lowest body. Fixed and kinematic bodies belong to none and join nothing.
/// Bodies without contacts are left out.
std::vector<Island> find_islands(const std::vector<Contact>& contacts, const std::vector<Body>& bodies);

}  // namespace tumble
