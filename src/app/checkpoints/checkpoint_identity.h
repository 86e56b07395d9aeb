// The clip that checkpoints belong to: by name, all that the state of a clip depends on. A run of another clip is refused
// with the first value that differs.
#pragma once

#include "app/files/named_values.h"

#include <string>

namespace tumble {

/// Scene and settings, as in ("the size", "1280x720"), the most telling ones first. The last one is a sum over all of the
/// scene.
using CheckpointIdentity = NamedValues;

/// "the size: 640x360 there, 1280x720 here" of the first value that differs; empty if all are equal.
std::string difference(const CheckpointIdentity& there, const CheckpointIdentity& here);

}  // namespace tumble
