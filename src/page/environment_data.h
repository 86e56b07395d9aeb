// The environment of a scene for pages: its light, and its background.
#pragma once

#include "page/array_store.h"
#include "scene/description/environment.h"

namespace tumble {

ArrayStore::Json make_environment(const EnvironmentDescription& environment, ArrayStore& arrays);

}  // namespace tumble
