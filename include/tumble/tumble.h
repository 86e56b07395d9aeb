// The whole interface of the library. docs/tutorials/from-cpp.md shows its use.
#pragma once

#include "aov.h"
#include "error.h"
#include "frames.h"
#include "image.h"
#include "output.h"
#include "renderer.h"
#include "scene.h"
#include "snapshot.h"
#include "spec.h"
#include "vector.h"
#include "version.h"
#include "world.h"
