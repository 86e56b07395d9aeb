#include "accumulated.h"

#include "compare/metrics/flip.h"
#include "core/image_mean.h"
#include "render/gl/gl_device.h"
#include "render/render_switches.h"

#include <algorithm>
#include <cstdlib>

namespace tumble {

Image accumulated(const SceneDescription& scene, const Snapshot& snapshot, int side) {
    SceneDescription sampled = scene;
    sampled.output.samples = 1;
    GlDevice device(GlBackend::software);  // its shaders are compiled once
    RenderSwitches switches;
    switches.device = &device;
    ImageMean mean;
    for (int i = 0; i < side * side; ++i) {
        switches.shift_x = (i % side + 0.5) / side - 0.5;
        switches.shift_y = (i / side + 0.5) / side - 0.5;
        mean.add(Renderer(sampled, switches).render(snapshot));
    }
    Image image;
    mean.take(image);
    return image;
}

Unlikeness unlikeness(const Image& reference, const Image& picture) {
    Unlikeness found;
    found.mean_flip = flip(reference, picture).mean;
    for (std::size_t i = 0; i < reference.pixels.size(); i += 4) {
        int most = 0;
        for (std::size_t c = 0; c < 3; ++c)
            most = std::max(most, std::abs(int(reference.pixels[i + c]) - int(picture.pixels[i + c])));
        found.largest = std::max(found.largest, most);
        for (std::size_t k = 0; k < found.above.size(); ++k)
            if (most > Unlikeness::limits[k]) ++found.above[k];
    }
    return found;
}

}  // namespace tumble
