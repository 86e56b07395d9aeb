// The settings beside the scenes that decide the pixels of a clip, as named values for its identity.
#pragma once

#include "app/clip/clip_request.h"
#include "app/composition/composition.h"
#include "app/files/named_values.h"
#include "app/resume/frame_identity.h"
#include "render/gl/gl_context.h"

namespace tumble {

/// How the frames are drawn.
struct DrawingChoices {
    double shutter = 0.0;  // degrees
    int blur_samples = 1;  // while it is open
    bool transparent = false;
    GlBackend backend = GlBackend::software;
};

NamedValues drawing_settings(const ClipRequest& request, const DrawingChoices& choices, const Composition& composition);

/// The identity of the AOVs of a clip with that identity.
FrameIdentity identity_of_aovs(FrameIdentity pictures, const AovSet& aovs);

}  // namespace tumble
