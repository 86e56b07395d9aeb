// A body with `fracture`, cut into pieces and the bonds between them.
#pragma once

#include "scene/description/description.h"

#include <cstdint>
#include <vector>

namespace tumble {

struct CutBody {
    std::vector<BodyDescription> pieces;  // with the frame, the motion and the matter of the whole; without piece_of
    std::vector<Bond> bonds;
};

/// `seed`: of the scene. Throws InputError, with the remedy, for a body that cannot be cut.
CutBody cut_body(const BodyDescription& whole, std::uint64_t seed);

}  // namespace tumble
